//! The native build against the numbers that the .wasm is held against as well.

#[path = "../common/agreement.rs"]
mod ends;

#[test]
fn this_build_ends_where_the_others_do() {
    ends::check();
}
