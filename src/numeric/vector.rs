//! Long vectors of f32 with sums in f64, because nalgebra sums in the precision of its vectors.

/// Computes target += factor * source.
#[inline(never)]
pub(crate) fn add_scaled(target: &mut [f32], factor: f32, source: &[f32]) {
    target.iter_mut().zip(source).for_each(|(t, s)| *t += factor * s);
}

/// Sum of the products.
#[inline(never)]
pub(crate) fn dot(a: &[f32], b: &[f32]) -> f64 {
    sum_of(a, b, |a, b| f64::from(a) * f64::from(b))
}

/// Number of independent partial sums. The compiler may not reorder a single sum, but it may keep eight in vector
/// registers.
const SUMS: usize = 8;

/// Sum of a function of corresponding elements.
pub(crate) fn sum_of(a: &[f32], b: &[f32], term: impl Fn(f32, f32) -> f64) -> f64 {
    let mut sums = [0.0; SUMS];
    let (a, b) = (a.chunks_exact(SUMS), b.chunks_exact(SUMS));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(&a, &b)| term(a, b)).sum();
    for (a, b) in a.zip(b) {
        for ((sum, &a), &b) in sums.iter_mut().zip(a).zip(b) {
            *sum += term(a, b);
        }
    }
    sums.iter().sum::<f64>() + rest
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// Tests lengths around multiples of the number of partial sums, with whole numbers so that no order of summation
    /// rounds.
    #[test]
    fn sums_are_those_of_a_plain_loop() {
        for length in [0, 1, 7, 8, 9, 16, 21] {
            let a: Vec<f32> = (0..length).map(|k| (k * k % 11) as f32 - 4.0).collect();
            let b: Vec<f32> = (0..length).map(|k| (3 * k % 7) as f32 - 2.0).collect();
            let expected: f64 = (0..length).map(|k| f64::from(a[k]) * f64::from(b[k])).sum();
            assert_eq!(dot(&a, &b), expected, "{length}");
            let expected: f64 = (0..length).map(|k| f64::from(a[k]).max(f64::from(b[k]))).sum();
            assert_eq!(sum_of(&a, &b, |a, b| f64::from(a.max(b))), expected, "{length}");
            let mut scaled = a.clone();
            add_scaled(&mut scaled, 0.5, &b);
            assert!((0..length).all(|k| scaled[k] == a[k] + 0.5 * b[k]), "{length}");
        }
    }
}
