//! Bindings for JavaScript: thin newtypes over the native API, without mathematics.
//!
//! The facade in `js/` has checked names and types before anything arrives here; values are checked by the native API,
//! as for every other caller. Arrays are copied both ways, because a view on wasm memory dies when that memory grows.

mod error;
mod estimator;
mod input;
mod output;
mod sample;
mod worker;

use wasm_bindgen::prelude::wasm_bindgen;

#[wasm_bindgen(typescript_custom_section)]
const TYPES: &str = r#"
import type { ColorImage, DepthMap, Options, Sample, SampleRequest, StepReport } from "../../js/types.js";
"#;

/// Runs once, when the module has been loaded: a panic then says in the console where it happened.
#[wasm_bindgen(start)]
fn start() {
    console_error_panic_hook::set_once();
}
