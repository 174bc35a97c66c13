//! Serialisation of values that leave the crate: names and shapes are those of the JavaScript contract.

use serde::{Serialize, Serializer};

/// A number, or null if it is not finite.
pub(crate) fn finite<S: Serializer>(value: &f64, serializer: S) -> Result<S::Ok, S::Error> {
    value.is_finite().then_some(*value).serialize(serializer)
}
