//! Elementary functions that are small to download.

/// `base` to the power of `exponent`, of a base that is not negative: exact to as many digits as the exponential of a product has,
/// without the tables and cases of the library's.
pub(crate) fn power(base: f64, exponent: f64) -> f64 {
    (exponent * base.ln()).exp()
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn powers_are_those_of_the_library() {
        for base in [0.0, 1e-9, 0.04, 0.3, 1.0, 2.5, 1e6] {
            for exponent in [1.0 / 3.0, 0.8, 1.0, 2.4] {
                let expected: f64 = f64::powf(base, exponent);
                assert!((power(base, exponent) - expected).abs() <= 1e-14 * expected, "{base} {exponent}");
            }
        }
    }
}
