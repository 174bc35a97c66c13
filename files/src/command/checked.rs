//! What a check found over files, with what their readers warn of.

use bimodal_stereo::{CheckReport, CheckVerdict};
use serde_json::Value;

/// A file that was read, with the hash by which it can be recognised.
#[derive(Clone, Debug, serde::Serialize)]
pub struct Input {
    pub name: String,
    pub says: String,
    pub sha256: String,
}

/// A warning of the check or of the readers.
pub struct Said {
    pub message: String,
    pub is_doubt: bool,
    pub json: Value,
}

/// What a check found, with what the readers add to it.
pub struct Checked {
    pub report: CheckReport,
    pub verdict: CheckVerdict,
    pub code: &'static str,
    pub reason: String,
    pub warnings: Vec<Said>,
    pub inputs: Vec<Input>,
}

impl Checked {
    /// What the readers guessed keeps the verdict from green, as the check's own warnings do.
    pub fn capped(report: CheckReport, warnings: Vec<Said>, inputs: Vec<Input>) -> Self {
        /// That of the check's own warnings.
        const DOUBTFUL: &str = "doubtful";
        let (mut verdict, mut code, mut reason) = (report.verdict, report.reason.code(), report.reason.to_string());
        if let (CheckVerdict::Consistent, Some(first)) = (verdict, warnings.iter().find(|warning| warning.is_doubt)) {
            reason = format!("Settled, but check: {} {reason}", first.message);
            (verdict, code) = (CheckVerdict::Undecided, DOUBTFUL);
        }
        Self { report, verdict, code, reason, warnings, inputs }
    }
}
