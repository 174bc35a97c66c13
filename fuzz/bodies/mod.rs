//! What the fuzz targets do with a fuzzer's bytes: they make inputs of them, call the library, and check what must hold
//! whatever the input. The targets of this crate and `tests/library/fuzz_corpus.rs`, which replays the committed corpus, share it.
//!
//! Bytes that have run out read as zeros, and zero is the plainest choice everywhere: an empty input is a good pair of
//! views with the default options, and each byte makes it stranger.

#![allow(dead_code, reason = "each target uses a part of them")]

pub mod calibration;
pub mod estimator;
pub mod functions;
mod numbers;
mod views;
pub mod worker;

use bimodal_stereo::Error;

/// What every error owes: the name of the field, and words.
fn named(error: &Error) {
    assert!(!error.field().is_empty(), "an error without a field: {error}");
    let words = error.to_string();
    assert!(words.len() > error.field().len() + 2, "an error without words: {words}");
}
