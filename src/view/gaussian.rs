//! Gaussian-weighted means on a raster.

use super::Size;

/// A truncated Gaussian; its sums treat everything outside the raster as zero.
pub(crate) struct Gaussian {
    size: Size,
    /// Weights from minus to plus the reach.
    kernel: Vec<f64>,
}

impl Gaussian {
    /// Reach in sigmas beyond which weights are below 1.2 %.
    pub const REACH: f64 = 3.0;

    /// A kernel of `sigma` pixels, above zero, truncated at `reach` sigmas or at the raster's longer side.
    pub fn new(size: Size, sigma: f64, reach: f64) -> Self {
        let reach = ((reach * sigma).ceil() as usize).min(size.width.max(size.height));
        let weight = |k: usize| (-0.5 * (k.abs_diff(reach) as f64 / sigma).powi(2)).exp();
        Self { size, kernel: (0..=2 * reach).map(weight).collect() }
    }

    /// Means of fields around each pixel over the pixels inside; NaN if the pixel itself is outside.
    pub fn means<const N: usize>(
        &self,
        inside: impl Fn(usize) -> bool,
        value: impl Fn(usize, usize) -> f32,
    ) -> [Vec<f64>; N] {
        let pixels = || 0..self.size.len();
        let weights = self.sums(pixels().map(|index| f64::from(inside(index))).collect());
        std::array::from_fn(|field| {
            let masked = |index| if inside(index) { f64::from(value(field, index)) } else { 0.0 };
            let sums = self.sums(pixels().map(masked).collect());
            let mean = |index: usize| if inside(index) { sums[index] / weights[index] } else { f64::NAN };
            pixels().map(mean).collect()
        })
    }

    /// Sums of the values around each pixel, weighted along rows, then along columns.
    fn sums(&self, mut values: Vec<f64>) -> Vec<f64> {
        let width = self.size.width;
        let reach = self.kernel.len() / 2;
        let mut sums = vec![0.0; values.len()];
        for (sums, values) in sums.chunks_exact_mut(width).zip(values.chunks_exact(width)) {
            for (k, &share) in self.kernel.iter().enumerate() {
                let (first, source) = (reach.saturating_sub(k), k.saturating_sub(reach));
                add(sums.get_mut(first..), share, values.get(source..));
            }
        }
        values.fill(0.0);
        for (row, values) in values.chunks_exact_mut(width).enumerate() {
            for (k, &share) in self.kernel.iter().enumerate() {
                let source = (row + k).checked_sub(reach).and_then(|row| sums.chunks_exact(width).nth(row));
                add(Some(&mut *values), share, source);
            }
        }
        values
    }
}

/// Adds a share of the values to the sums pairwise, if both exist.
fn add(sums: Option<&mut [f64]>, share: f64, values: Option<&[f64]>) {
    let (Some(sums), Some(values)) = (sums, values) else { return };
    sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += share * value);
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Size = Size { width: 5, height: 3 };

    /// Candidates far away can require any width, and the weights must still fit into memory.
    #[test]
    fn a_blur_of_any_width_is_the_mean() {
        for sigma in [1e4, 1e30, f64::INFINITY] {
            let [means] = Gaussian::new(SIZE, sigma, 2.6).means(|_| true, |_, index| index as f32);
            assert!(means.iter().all(|mean| (mean - 7.0).abs() < 1e-3), "{sigma}: {means:?}");
        }
    }

    #[test]
    fn a_plane_stays_and_pixels_outside_count_for_nothing() {
        let size = Size { width: 21, height: 21 };
        let slope = |_, index: usize| (index % 21 + 2 * (index / 21)) as f32;
        let [means] = Gaussian::new(size, 2.0, 3.0).means(|_| true, slope);
        let middle = size.index(10, 10);
        assert!((means[middle] - f64::from(slope(0, middle))).abs() < 1e-5);
        let inside = |index: usize| index.is_multiple_of(2);
        let value = |_, index: usize| if inside(index) { 3.0 } else { f32::MAX };
        let [means] = Gaussian::new(size, 1.0, 3.0).means(inside, value);
        assert!((0..size.len()).all(|index| if inside(index) {
            (means[index] - 3.0).abs() < 1e-5
        } else {
            means[index].is_nan()
        }));
    }
}
