//! Errors of an input, as values.

use std::borrow::Cow;
use std::fmt;

use crate::text::Brief;

/// The family of an [`Error`]. Its [`code`](ErrorKind::code) is stable and appears in JavaScript.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::IntoStaticStr, strum::VariantNames)]
#[strum(serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum ErrorKind {
    /// Two sizes do not agree, or a size is outside its bounds.
    Size,
    /// A number lies outside its allowed range or is not finite.
    Range,
    /// A required value is missing, or two values exclude each other.
    Missing,
    /// The input is well formed but contains nothing usable (no usable pixel, no valid depth).
    Empty,
    /// The geometry does not determine the answer (a plane, a sphere, fewer than four pairs).
    Degenerate,
    /// The input would take more memory than a page may use.
    Memory,
    /// The build lacks a documented feature.
    Unsupported,
}

impl ErrorKind {
    /// The codes of all kinds.
    pub const CODES: &'static [&'static str] = <Self as strum::VariantNames>::VARIANTS;

    /// Stable, lower-case name of the kind.
    #[must_use]
    pub fn code(self) -> &'static str {
        self.into()
    }
}

/// An error with the field that caused it and, if helpful, the index and the value.
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

    /// The same error, with its field as a member of `parent`.
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

    /// Index into the field's array, if a single element is invalid.
    #[must_use]
    pub const fn index(&self) -> Option<usize> {
        self.index
    }

    /// The invalid value, if it is a number.
    #[must_use]
    pub const fn bad_value(&self) -> Option<f64> {
        self.value
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

/// Serialised as in the JavaScript contract: code, message, field and, if helpful, index and value.
#[cfg(feature = "serde")]
impl serde::Serialize for Error {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        use serde::ser::SerializeMap;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("code", self.kind.code())?;
        map.serialize_entry("message", &self.to_string())?;
        map.serialize_entry("field", self.field())?;
        if let Some(index) = self.index {
            map.serialize_entry("index", &index)?;
        }
        if let Some(value) = self.value {
            map.serialize_entry("value", &value)?;
        }
        map.end()
    }
}
