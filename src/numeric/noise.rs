//! The noise of a raster by the fourth differences of its rows: what no cubic follows counts as noise.

use super::quantile;

/// Neighbours in a row that a fourth difference takes.
pub const REACH: usize = 5;
/// Fourth differences of white noise in standard deviations of it, 70^(1/2), and the median of |x| in those of x.
const FOURTH_DIFFERENCE: f64 = 8.366_600_265_340_756;
const MEDIAN_ABSOLUTE: f64 = 0.674_489_750_196_082;

/// The fourth difference of five neighbours.
pub fn bend<T>(row: [T; REACH]) -> T
where
    T: std::ops::Mul<f64, Output = T> + std::ops::Add<Output = T>,
{
    let [a, b, c, d, e] = row;
    a + b * -4.0 + c * 6.0 + d * -4.0 + e
}

/// Standard deviation of the noise whose fourth differences have these sizes, `most` of them at most; zero without any.
pub fn of_bends(sizes: impl Iterator<Item = f32>, most: usize) -> f64 {
    // A list that grows takes three times the memory.
    let mut known = Vec::with_capacity(most);
    known.extend(sizes.filter(|size| size.is_finite()).map(f32::abs));
    if known.is_empty() {
        return 0.0;
    }
    f64::from(quantile(&mut known, 0.5)) / (FOURTH_DIFFERENCE * MEDIAN_ABSOLUTE)
}

/// White noise of variance one for tests: sums of twelve uniform numbers are nearly normal.
#[cfg(test)]
pub fn dice(seed: u64) -> impl FnMut() -> f64 {
    use rand_chacha::rand_core::{Rng, SeedableRng};
    let mut dice = rand_chacha::ChaCha8Rng::seed_from_u64(seed);
    move || (0..12).map(|_| f64::from(dice.next_u32()) / f64::from(u32::MAX)).sum::<f64>() - 6.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cubics_have_none_and_white_noise_its_own() {
        let cubic = |x: f64| 0.3 * x.powi(3) - 2.0 * x * x + x - 7.0;
        assert!(bend([0.0, 1.0, 2.0, 3.0, 4.0].map(cubic)).abs() < 1e-12);
        let mut normal = dice(5);
        let line: Vec<f64> = (0..20_000).map(|_| 0.2 * normal()).collect();
        let bends = line.windows(REACH).map(|row| bend([row[0], row[1], row[2], row[3], row[4]]) as f32);
        let noise = of_bends(bends, line.len());
        assert!((noise - 0.2).abs() < 0.01, "{noise}");
    }
}
