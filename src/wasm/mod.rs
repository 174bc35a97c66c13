//! Bindings for JavaScript: thin newtypes over the native API, without mathematics.
//!
//! The facade in `js/` has checked names and types before anything arrives here; the native API checks values, as for
//! every other caller. Arrays are copied both ways, because a view on wasm memory becomes invalid when that memory
//! grows.

mod error;
#[cfg(not(feature = "bindings-rigs"))]
#[cfg_attr(feature = "bindings-check", allow(dead_code, reason = "options are the loop's"))]
mod input;
#[cfg_attr(any(feature = "bindings-check", feature = "bindings-rigs"), allow(dead_code, reason = "so are its reports"))]
mod output;

// Each feature builds a separate file, so that visitors download only what they use.
#[cfg(feature = "bindings-check")]
mod calibration;
#[cfg(not(any(feature = "bindings-check", feature = "bindings-rigs")))]
mod estimator;
#[cfg(not(any(feature = "bindings-check", feature = "bindings-rigs")))]
mod lessons;
#[cfg(any(feature = "bindings-check", feature = "bindings-rigs"))]
mod pose;
#[cfg(feature = "bindings-rigs")]
mod rigs;
#[cfg(not(any(feature = "bindings-check", feature = "bindings-rigs")))]
mod sample;
#[cfg(not(any(feature = "bindings-check", feature = "bindings-rigs")))]
mod worker;

use wasm_bindgen::prelude::wasm_bindgen;

#[cfg(not(any(feature = "bindings-check", feature = "bindings-rigs")))]
#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
import type { ColorImage, DepthMap, Options, Sample, SampleRequest, StepReport } from "../../js/types/index.js";
"#;

#[cfg(feature = "bindings-check")]
#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
import type { CheckFrame, CheckReport, ColorImage, DepthMap, Options } from "../../../js/types/index.js";
"#;

#[cfg(feature = "bindings-rigs")]
#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
import type { PairSample, RigSample } from "../../../js/types/index.js";
"#;

/// Runs once after the module has loaded: a panic then shows its location in the console.
#[wasm_bindgen(start)]
fn start() {
    console_error_panic_hook::set_once();
}
