//! Compares the native build with the recorded results that also apply to the .wasm.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

#[path = "../common/agreement.rs"]
mod ends;

#[test]
fn this_build_ends_where_the_others_do() {
    ends::check();
}
