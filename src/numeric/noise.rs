//! Noise of a raster, estimated by the fourth differences of neighbours (docs/method/views.md).
//!
//! Fourth differences of a cubic vanish, so whatever deviates from a cubic through five neighbours counts as noise.
//! Limits: texture that is as fine also counts as noise.

use super::quantile;

/// Number of collinear neighbours in a fourth difference.
pub const NEIGHBOURS: usize = 5;
/// Standard deviation of the fourth differences of white noise of variance one: 70^(1/2), as 1 + 16 + 36 + 16 + 1 = 70.
const FOURTH_DIFFERENCE: f64 = 8.366_600_265_340_756;
/// Median of |x| for a normal x of variance one.
const MEDIAN_ABSOLUTE: f64 = 0.674_489_750_196_082;

/// Fourth difference of five neighbours.
pub fn fourth_difference<T>(line: [T; NEIGHBOURS]) -> T
where
    T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
{
    let [a, b, c, d, e] = line;
    a + b * -4.0 + c * 6.0 + d * -4.0 + e
}

/// Standard deviation of the noise whose fourth differences have these sizes. There are at most `most` of them; without
/// any, the result is zero.
pub fn of_fourth_differences(sizes: &mut dyn Iterator<Item = f32>, most: usize) -> f64 {
    // A list that grows step by step takes up to three times the memory.
    let mut known = Vec::with_capacity(most);
    known.extend(sizes.filter(|size| size.is_finite()).map(f32::abs));
    if known.is_empty() {
        return 0.0;
    }
    f64::from(quantile(&mut known, 0.5)) / (FOURTH_DIFFERENCE * MEDIAN_ABSOLUTE)
}

/// White noise of variance one for tests: a sum of twelve uniform numbers is nearly normal.
#[cfg(test)]
pub fn white_noise(seed: u64) -> impl FnMut() -> f64 {
    let mut random = super::random::Random::new(seed, 0);
    move || (0..12).map(|_| f64::from(random.word()) / f64::from(u32::MAX)).sum::<f64>() - 6.0
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn cubics_have_no_noise_and_white_noise_its_own() {
        let cubic = |x: f64| 0.3 * x.powi(3) - 2.0 * x * x + x - 7.0;
        assert!(fourth_difference([0.0, 1.0, 2.0, 3.0, 4.0].map(cubic)).abs() < 1e-12);
        let mut normal = white_noise(5);
        let line: Vec<f64> = (0..20_000).map(|_| 0.2 * normal()).collect();
        let mut fourths =
            line.windows(NEIGHBOURS).map(|row| fourth_difference([row[0], row[1], row[2], row[3], row[4]]) as f32);
        let noise = of_fourth_differences(&mut fourths, line.len());
        assert!((noise - 0.2).abs() < 0.01, "{noise}");
    }
}
