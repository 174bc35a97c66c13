//! Guesses and suspicious values: a code, a sentence, and the file concerned.

use std::fmt;

/// A guess of a reader, or something that looks wrong.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Warning {
    pub code: &'static str,
    pub message: String,
    /// The message without the file's name, by which equal warnings of several files are merged.
    #[serde(skip)]
    pub reason: String,
    /// The file or input concerned.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub field: Option<String>,
}

/// Codes of warnings that do not cap the verdict.
const HARMLESS: [&str; 11] = [
    "file-left-out",
    "file-alone",
    "names-ambiguous",
    "mask-size",
    "pairs-sampled",
    "frames-alike",
    "transform-missing",
    "pose-left-out",
    "camera-to-world",
    "points-sorted",
    "lidar-axes",
];

impl Warning {
    /// Whether it caps the verdict of a check, because the input may be wrong.
    pub fn is_doubt(&self) -> bool {
        !HARMLESS.contains(&self.code)
    }

    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        let message = message.into();
        Self { code, reason: message.clone(), message, field: None }
    }

    /// The same warning about a named file; its message begins with the name.
    #[must_use]
    pub fn of_file(&self, name: &str) -> Self {
        let message = format!("{name}: {}", self.message);
        Self { code: self.code, reason: self.reason.clone(), message, field: Some(name.into()) }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// Warnings in the order in which they arose, each once.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Warnings(pub Vec<Warning>);

impl Warnings {
    pub fn add(&mut self, code: &'static str, message: impl Into<String>) {
        self.push(Warning::new(code, message));
    }

    pub fn push(&mut self, warning: Warning) {
        if !self.0.contains(&warning) {
            self.0.push(warning);
        }
    }

    pub fn extend(&mut self, others: impl IntoIterator<Item = Warning>) {
        others.into_iter().for_each(|warning| self.push(warning));
    }
}
