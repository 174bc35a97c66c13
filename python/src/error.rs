//! What goes wrong becomes the package's `BimodalError`, in Python's spelling.

use pyo3::{PyErr, PyResult, import_exception};

use crate::guard::BrokenOff;

import_exception!(bimodal_stereo._errors, BimodalError);

/// An error with its code and the field at fault, as a path.
pub fn failure(code: &str, field: &str, message: &str) -> PyErr {
    BimodalError::new_err((code.to_owned(), format!("{field}: {message}"), field.to_owned()))
}

/// Names of the contract that Python spells otherwise, where they come in fields and sentences of the crate.
const SPELLINGS: [(&str, &str); 6] = [
    ("startTolerance", "start_tolerance"),
    ("correspondenceDistance", "correspondence_distance"),
    ("maxIterations", "max_iterations"),
    ("stopDegrees", "stop_degrees"),
    ("depthNoise", "depth_noise"),
    // A word of the language.
    ("lambda.", "lambda_."),
];

pub fn spelled(text: &str) -> String {
    // Options are arguments here, not members of an object.
    let text = text.strip_prefix("options.").unwrap_or(text);
    SPELLINGS.iter().fold(text.to_owned(), |text, (name, own)| text.replace(name, own))
}

/// An error of the crate.
pub fn refused(error: &bimodal_stereo::Error) -> PyErr {
    BimodalError::new_err((error.kind().code(), spelled(&error.to_string()), spelled(error.field())))
}

/// What a guarded call of the crate came to.
pub fn outcome<R>(result: Result<bimodal_stereo::Result<R>, BrokenOff>) -> PyResult<R> {
    unbroken(result)?.map_err(|error| refused(&error))
}

/// The same of a call that can't be refused.
pub fn unbroken<R>(result: Result<R, BrokenOff>) -> PyResult<R> {
    let of = |code: &str, message: String| BimodalError::new_err((code.to_owned(), message, None::<String>));
    result.map_err(|broken| match broken {
        BrokenOff::Now(said) => {
            of("panic", format!("the numerics broke off; this is a bug ({said}). Make another estimator"))
        }
        BrokenOff::Earlier => {
            of("poisoned", "this estimator broke off in an earlier call; make another one".to_owned())
        }
    })
}
