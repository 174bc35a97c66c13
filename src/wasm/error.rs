//! Errors cross as plain data; the facade makes a `BimodalError` of them.

use wasm_bindgen::JsValue;

use super::output::plain;
use crate::error::Error;

/// An [`Error`] on its way out.
#[derive(Debug)]
pub struct Thrown(Error);

impl From<Error> for Thrown {
    fn from(error: Error) -> Self {
        Self(error)
    }
}

impl From<Thrown> for JsValue {
    fn from(Thrown(error): Thrown) -> Self {
        plain(&error)
    }
}
