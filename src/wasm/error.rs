//! Errors cross as plain data; the facade turns them into a `BimodalError`.

use wasm_bindgen::JsValue;

use super::output::plain;
use crate::error::Error;

/// An [`Error`] to be thrown.
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
