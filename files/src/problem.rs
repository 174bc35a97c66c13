//! An invalid input: the file and the reason, as a value.

use std::fmt;
use std::path::Path;

pub type Result<T> = std::result::Result<T, Problem>;

/// The message names the file; `code` and `field` are those of the JavaScript contract.
#[derive(Debug)]
pub struct Problem {
    pub code: &'static str,
    pub field: String,
    /// Position in the message, after a file's name, at which the reason begins.
    reason: usize,
    message: String,
}

impl Problem {
    /// A file that cannot be read, written or understood.
    pub fn file(path: &Path, reason: impl fmt::Display) -> Self {
        let name = format!("{}: ", shown(path));
        Self { code: "file", field: "file".into(), reason: name.len(), message: format!("{name}{reason}") }
    }

    /// A depth map without its camera.
    pub fn camera(path: &Path, reason: impl fmt::Display) -> Self {
        Self { code: "missing", field: "depth.camera".into(), ..Self::file(path, reason) }
    }

    /// An invalid argument, or a combination of them.
    pub fn option(field: &str, reason: impl fmt::Display) -> Self {
        Self { code: "option", field: field.into(), reason: 0, message: format!("{field}: {reason}") }
    }

    /// An error of the library about a pair, with the file of the view that caused it.
    pub fn of_pair(error: &bimodal_stereo::Error, image: &Path, depth: &Path) -> Self {
        let path = match error.field() {
            field if field.starts_with("image") => Some(image),
            field if field.starts_with("depth") => Some(depth),
            _ => None,
        };
        let message = path.map_or_else(|| error.to_string(), |path| format!("{}: {error}", shown(path)));
        Self { code: error.kind().code(), field: error.field().into(), reason: 0, message }
    }

    /// An error of the library about the inputs of a check.
    pub fn of_check(error: &bimodal_stereo::Error) -> Self {
        Self { code: error.kind().code(), field: error.field().into(), reason: 0, message: error.to_string() }
    }

    /// The message without the file's name.
    pub fn reason(&self) -> &str {
        &self.message[self.reason..]
    }
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.message)
    }
}

/// A path for a terminal, without the control characters that a file's name may hold.
pub fn shown(path: &Path) -> String {
    plain(&path.display().to_string())
}

/// A text for a terminal, with its control characters replaced.
pub fn plain(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() { '\u{fffd}' } else { letter }).collect()
}

/// The last part of a path, for a terminal.
pub fn own_name(path: &Path) -> String {
    path.file_name().map_or_else(|| shown(path), |name| plain(&name.to_string_lossy()))
}
