//! Shared by the fuzz targets of this crate and by `tests/library/fuzz_corpus.rs`, which replays the committed corpus: functions that make
//! inputs from a fuzzer's bytes, call the library, and check what must hold for every input.
//!
//! Exhausted bytes read as zeros, and zero is the plainest choice everywhere: an empty input is a valid pair of views
//! with the default options, and each byte makes it more unusual.

#![allow(dead_code, reason = "each target uses a part of them")]

pub mod calibration;
pub mod estimator;
pub mod functions;
mod numbers;
mod views;
pub mod worker;

use bimodal_stereo::Error;

/// Checks that an error has a field and a message.
fn named(error: &Error) {
    assert!(!error.field().is_empty(), "an error without a field: {error}");
    let words = error.to_string();
    assert!(words.len() > error.field().len() + 2, "an error without words: {words}");
}
