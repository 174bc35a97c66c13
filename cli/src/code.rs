//! Exit codes, in the order of those of the command `check`.

use std::process::ExitCode;

use bimodal_stereo::Status;

/// From best to worst, so that the worst code of a folder is the largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Code {
    Converged,
    Undecided,
    Wrong,
    BadInput,
}

impl Code {
    pub fn of(status: Status) -> Self {
        match status {
            Status::Converged => Self::Converged,
            Status::Ambiguous | Status::Lost => Self::Wrong,
            Status::MaxIterations | Status::Running => Self::Undecided,
        }
    }
}

impl From<Code> for ExitCode {
    fn from(code: Code) -> Self {
        Self::from(match code {
            Code::Converged => 0,
            Code::Wrong => 1,
            Code::Undecided => 2,
            Code::BadInput => 3,
        })
    }
}
