//! Errors as the package's `BimodalError`, with names in Python's spelling.

use pyo3::{PyErr, PyResult, import_exception, pyfunction};

use crate::guard::BrokenOff;

import_exception!(bimodal_stereo._errors, BimodalError);

/// An error with its code and the path of the field that caused it.
pub fn failure(code: &str, field: &str, message: &str) -> PyErr {
    BimodalError::new_err((code.to_owned(), format!("{field}: {message}"), field.to_owned()))
}

/// A name of the contract, or a path of names, in Python's spelling.
#[pyfunction]
pub fn spelled(name: &str) -> String {
    // The names of candidates belong to the caller.
    if name.starts_with("candidates.") {
        return name.to_owned();
    }
    // Options are arguments here, not members of an object.
    let name = name.strip_prefix("options.").unwrap_or(name);
    let mut own = String::with_capacity(name.len());
    for letter in name.chars() {
        if letter.is_ascii_uppercase() {
            own.push('_');
        }
        own.push(letter.to_ascii_lowercase());
    }
    // A keyword of Python.
    let segments = own.split('.').map(|name| if name == "lambda" { "lambda_" } else { name });
    segments.collect::<Vec<_>>().join(".")
}

/// An error of the crate.
pub fn refused(error: &bimodal_stereo::Error) -> PyErr {
    refused_at(spelled(error.field()), error)
}

/// An error of the crate, with another path of the field.
pub fn refused_at(field: String, error: &bimodal_stereo::Error) -> PyErr {
    let message = error.to_string();
    let message = message.strip_prefix(error.field()).map_or(message.clone(), |rest| format!("{field}{rest}"));
    BimodalError::new_err((error.kind().code(), message, field, error.index(), error.bad_value()))
}

/// The result of a guarded call of the crate.
pub fn outcome<R>(result: Result<bimodal_stereo::Result<R>, BrokenOff>) -> PyResult<R> {
    unbroken(result)?.map_err(|error| refused(&error))
}

/// The result of a guarded call that cannot be refused.
pub fn unbroken<R>(result: Result<R, BrokenOff>) -> PyResult<R> {
    let of = |code: &str, message: String| BimodalError::new_err((code.to_owned(), message, None::<String>));
    result.map_err(|broken| match broken {
        BrokenOff::Now(said) => {
            of("panic", format!("the numerics crashed, which is a bug ({said}). Create another estimator"))
        }
        BrokenOff::Earlier => {
            of("poisoned", "this estimator crashed in an earlier call; create another one".to_owned())
        }
    })
}
