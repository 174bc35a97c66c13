//! Errors cross as plain data; the facade makes a `BimodalError` of them.

use js_sys::Object;
use wasm_bindgen::JsValue;

use super::output::set;
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
        let object = Object::new();
        set(&object, "code", error.kind().code());
        set(&object, "field", error.field());
        set(&object, "message", error.to_string());
        object.into()
    }
}
