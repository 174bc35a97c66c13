//! The result of a check over files, with the warnings of their readers.

use bimodal_stereo::{CandidateReport, CheckReport, CheckVerdict};
use serde_json::Value;

/// A file that was read, with a hash that identifies it.
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

/// The result of a check, with the additions of the readers.
pub struct Checked {
    pub report: CheckReport,
    pub verdict: CheckVerdict,
    pub code: &'static str,
    pub reason: String,
    pub warnings: Vec<Said>,
    pub inputs: Vec<Input>,
}

impl Checked {
    /// Guesses of the readers cap the verdict, as the check's own warnings do.
    pub fn capped(report: CheckReport, warnings: Vec<Said>, inputs: Vec<Input>) -> Self {
        /// The code of a verdict capped by the check's own warnings.
        const DOUBTFUL: &str = "doubtful";
        let (mut verdict, mut code, mut reason) = (report.verdict, report.reason.code(), report.reason.to_string());
        if let (CheckVerdict::Consistent, Some(first)) = (verdict, warnings.iter().find(|warning| warning.is_doubt)) {
            reason = format!("It would be consistent without this warning: {} {reason}", first.message);
            (verdict, code) = (CheckVerdict::Undecided, DOUBTFUL);
        }
        Self { report, verdict, code, reason, warnings, inputs }
    }

    /// The verdict on a candidate with its reason. Warnings cap those on the first one, so that its row says the same as
    /// the line above.
    pub fn result(&self, one: &CandidateReport) -> (CheckVerdict, String) {
        let is_first = self.report.candidates.first().is_some_and(|first| first.name == one.name);
        let own = one.reason.to_string();
        if is_first && one.verdict == CheckVerdict::Consistent && self.verdict == CheckVerdict::Undecided {
            return (self.verdict, format!("It would be consistent without the warnings. {own}"));
        }
        (one.verdict, own)
    }

    /// The reason for the verdict, for a place beside the list of warnings.
    pub fn sentence(&self) -> String {
        let first = self.report.candidates.first().map(|first| (first.verdict, self.result(first)));
        match first {
            Some((CheckVerdict::Consistent, (CheckVerdict::Undecided, sentence))) => sentence,
            _ => self.reason.clone(),
        }
    }
}
