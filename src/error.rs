//! What can be wrong with an input, said as a value.

use std::borrow::Cow;
use std::fmt;

use crate::text::Brief;

/// The family an [`Error`] belongs to. Its [`code`](ErrorKind::code) is stable and is what JavaScript sees.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ErrorKind {
    /// Two sizes that must agree do not, or a size is outside its bounds.
    Size,
    /// A number lies outside its allowed range or is not finite.
    Range,
    /// Something required is absent, or two exclusive things are both present.
    Missing,
    /// The input is well formed but holds nothing to work on (no usable pixel, no valid depth).
    Empty,
    /// The geometry does not determine the answer (a plane, a sphere, fewer than four pairs).
    Degenerate,
    /// The input would take more memory than a page is granted.
    Memory,
    /// A documented feature that this build does not offer.
    Unsupported,
}

impl ErrorKind {
    /// Stable, lower-case name of the kind.
    #[must_use]
    pub const fn code(self) -> &'static str {
        match self {
            Self::Size => "size",
            Self::Range => "range",
            Self::Missing => "missing",
            Self::Empty => "empty",
            Self::Degenerate => "degenerate",
            Self::Memory => "memory",
            Self::Unsupported => "unsupported",
        }
    }
}

/// An error that names the field, and where it helps the index and the value, that caused it.
#[derive(Clone, Debug, PartialEq)]
pub struct Error {
    kind: ErrorKind,
    field: Cow<'static, str>,
    index: Option<usize>,
    value: Option<f64>,
    message: Cow<'static, str>,
}

/// Result of every fallible call of this crate.
pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    pub(crate) fn new(
        kind: ErrorKind,
        field: impl Into<Cow<'static, str>>,
        message: impl Into<Cow<'static, str>>,
    ) -> Self {
        Self { kind, field: field.into(), index: None, value: None, message: message.into() }
    }

    pub(crate) fn at(mut self, index: usize) -> Self {
        self.index = Some(index);
        self
    }

    pub(crate) fn value(mut self, value: f64) -> Self {
        self.value = Some(value);
        self
    }

    /// The same error with its field named as a member of `parent`.
    pub(crate) fn below(mut self, parent: &str) -> Self {
        self.field = format!("{parent}.{}", self.field).into();
        self
    }

    /// The family of the error.
    #[must_use]
    pub const fn kind(&self) -> ErrorKind {
        self.kind
    }

    /// The input field, as a path in the JavaScript contract, e.g. `depth.camera.fx`.
    #[must_use]
    pub fn field(&self) -> &str {
        &self.field
    }

    /// Index into the field's array, where one element is at fault.
    #[must_use]
    pub const fn index(&self) -> Option<usize> {
        self.index
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}", self.field)?;
        if let Some(index) = self.index {
            write!(f, "[{index}]")?;
        }
        write!(f, ": {}", self.message)?;
        if let Some(value) = self.value {
            write!(f, " (got {})", Brief(value))?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}
