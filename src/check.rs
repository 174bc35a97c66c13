//! Checks of single numbers, shared by all inputs.

use crate::error::{Error, ErrorKind, Result};

/// Refuses anything but a finite number above zero.
pub(crate) fn positive(field: &'static str, value: f64) -> Result<()> {
    if value.is_finite() && value > 0.0 {
        return Ok(());
    }
    Err(Error::new(ErrorKind::Range, field, "must be a finite number above zero").value(value))
}

/// Refuses anything but a finite number, zero or above.
pub(crate) fn not_negative(field: &'static str, value: f64) -> Result<()> {
    if value.is_finite() && value >= 0.0 {
        return Ok(());
    }
    Err(Error::new(ErrorKind::Range, field, "must be a finite number, zero or above").value(value))
}
