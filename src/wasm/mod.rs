//! Bindings for JavaScript: thin newtypes over the native API, without mathematics.
//!
//! The facade in `js/` has checked names and types before anything arrives here; values are checked by the native API,
//! as for every other caller. Arrays are copied both ways, because a view on wasm memory dies when that memory grows.

mod error;
#[cfg(not(feature = "bindings-rigs"))]
#[cfg_attr(feature = "bindings-check", allow(dead_code, reason = "options are the loop's"))]
mod input;
#[cfg_attr(any(feature = "bindings-check", feature = "bindings-rigs"), allow(dead_code, reason = "so are its reports"))]
mod output;

// A file of its own for each: visitors who don't check a rig don't download the check, and the other way round.
#[cfg(feature = "bindings-check")]
mod calibration;
#[cfg(not(any(feature = "bindings-check", feature = "bindings-rigs")))]
mod estimator;
#[cfg(not(any(feature = "bindings-check", feature = "bindings-rigs")))]
mod lessons;
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
import type { RigSample } from "../../../js/types/index.js";
"#;

/// Runs once, when the module has been loaded: a panic then says in the console where it happened.
#[wasm_bindgen(start)]
fn start() {
    console_error_panic_hook::set_once();
}
