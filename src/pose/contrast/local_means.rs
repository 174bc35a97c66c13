//! H, the difference of values on a raster from the weighted mean around them,
//!
//! (H a)_p = a_p - sum_q g(p - q) w_q a_q / sum_q g(p - q) w_q,
//!
//! with a Gaussian g. It removes slow changes over the surface, such as the slopes of an imprecise light and most of
//! the varying albedo; edges and small relief remain. H is linear for fixed weights, so it applies to derivatives in
//! the same way as to values.

/// Reach of the Gaussian in sigmas. Its weight has fallen to 4 % there. With any reach, H of a constant is exactly
/// zero.
const REACH: f64 = 2.5;

/// Maximum number of values of a pixel.
const MOST: usize = 21;

/// The operator on one raster; owns its memory. The values of a pixel lie side by side, so that all are processed at
/// once.
pub(in crate::pose) struct LocalMeans {
    width: usize,
    /// The Gaussian from -reach to reach.
    kernel: Vec<f32>,
    weights: Vec<f32>,
    /// Inverse of the sum of the weights around each pixel; zero where the pixel itself has no weight.
    normaliser: Vec<f32>,
    /// Sums along rows.
    along: Vec<f32>,
}

impl LocalMeans {
    /// Prepares a raster of `length` pixels with `width` columns; sigma is in pixels.
    pub fn new(width: usize, length: usize, sigma: f64) -> Self {
        let reach = (REACH * sigma).ceil() as usize;
        let bell = |k: usize| (-0.5 * (k.abs_diff(reach) as f64 / sigma).powi(2)).exp() as f32;
        Self {
            width,
            kernel: (0..=2 * reach).map(bell).collect(),
            weights: vec![0.0; length],
            normaliser: vec![0.0; length],
            along: vec![0.0; length * MOST],
        }
    }

    /// Sets other weights.
    pub fn weigh(&mut self, weights: &[f32]) {
        self.weights.copy_from_slice(weights);
        self.normaliser.fill(1.0);
        self.sum_along(weights.len(), |_| [1.0]);
        for pixel in 0..weights.len() {
            let [sum] = self.sum_down(pixel);
            self.normaliser[pixel] = if weights[pixel] > 0.0 && sum > 0.0 { 1.0 / sum } else { 0.0 };
        }
    }

    /// Applies H to the values in place. Values of pixels without weight have no influence and do not change.
    pub fn remove<const N: usize>(&mut self, values: &mut [[f32; N]]) {
        self.sum_along(values.len(), |pixel| values[pixel]);
        for pixel in 0..values.len() {
            let normaliser = self.normaliser[pixel];
            if normaliser > 0.0 {
                let sums: [f32; N] = self.sum_down(pixel);
                for (value, sum) in values[pixel].iter_mut().zip(sums) {
                    *value -= normaliser * sum;
                }
            }
        }
    }

    /// The weighted means themselves, that is the blurred values, at pixels with a weight.
    pub fn smoothed<const N: usize>(&mut self, weights: &[f32], values: &[[f32; N]]) -> Vec<[f32; N]> {
        self.weigh(weights);
        let mut off = values.to_vec();
        self.remove(&mut off);
        values.iter().zip(off).map(|(value, off)| std::array::from_fn(|k| value[k] - off[k])).collect()
    }

    /// Computes the weighted sums along rows.
    fn sum_along<const N: usize>(&mut self, length: usize, value: impl Fn(usize) -> [f32; N]) {
        let reach = self.kernel.len() / 2;
        let (sums, _) = self.along.as_chunks_mut::<N>();
        for (row, sums) in sums[..length].chunks_mut(self.width).enumerate() {
            let start = row * self.width;
            sums.fill([0.0; N]);
            for source in 0..sums.len() {
                let weight = self.weights[start + source];
                if weight == 0.0 {
                    continue;
                }
                let values = value(start + source);
                let first = source.saturating_sub(reach);
                let last = (source + reach).min(sums.len() - 1);
                for (sum, &share) in sums[first..=last].iter_mut().zip(&self.kernel[first + reach - source..]) {
                    let share = share * weight;
                    sum.iter_mut().zip(values).for_each(|(sum, value)| *sum += share * value);
                }
            }
        }
    }

    /// Sum down the column of a pixel over the sums along rows.
    fn sum_down<const N: usize>(&self, pixel: usize) -> [f32; N] {
        let reach = self.kernel.len() / 2;
        let (row, column) = (pixel / self.width, pixel % self.width);
        let (along, _) = self.along.as_chunks::<N>();
        let first = row.saturating_sub(reach);
        let last = (row + reach).min(self.weights.len() / self.width - 1);
        let mut sums = [0.0; N];
        for (row, &share) in (first..=last).zip(&self.kernel[first + reach - row..]) {
            let values = &along[row * self.width + column];
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += share * value);
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WIDTH: usize = 24;

    fn values(value: impl Fn(f32, f32) -> [f32; 2]) -> Vec<[f32; 2]> {
        (0..WIDTH * WIDTH).map(|k| value((k % WIDTH) as f32, (k / WIDTH) as f32)).collect()
    }

    #[test]
    fn constants_go_slopes_go_inside_and_edges_stay() {
        let mut means = LocalMeans::new(WIDTH, WIDTH * WIDTH, 2.0);
        // Pixels without weight have no influence, whatever their values.
        let hole = |k: usize| k.is_multiple_of(7);
        let weights: Vec<f32> = (0..WIDTH * WIDTH).map(|k| if hole(k) { 0.0 } else { 0.5 }).collect();
        means.weigh(&weights);
        let mut constant = values(|_, _| [4.0, -3.0]);
        (0..constant.len()).filter(|&k| hole(k)).for_each(|k| constant[k] = [1e6, 1e6]);
        means.remove(&mut constant);
        assert!((0..constant.len()).filter(|&k| !hole(k)).all(|k| constant[k].iter().all(|value| value.abs() < 1e-5)));

        means.weigh(&[1.0; WIDTH * WIDTH]);
        let mut slopes = values(|x, y| [x, 2.0 * y]);
        means.remove(&mut slopes);
        let inside = 12 * WIDTH + 12;
        assert!(slopes[inside].iter().all(|value| value.abs() < 1e-4));
        assert!(slopes[0][0] < -0.5, "one-sided at the border: {:?}", slopes[0]);
        let mut edge = values(|x, _| [f32::from(x >= 12.0), 0.0]);
        means.remove(&mut edge);
        assert!(edge[inside][0] > 0.3 && edge[inside - 1][0] < -0.3 && edge[inside + 8][0].abs() < 1e-5);
    }

    #[test]
    fn it_is_what_the_definition_says() {
        let sigma = 1.5;
        let mut means = LocalMeans::new(WIDTH, WIDTH * WIDTH, sigma);
        let weights: Vec<f32> = (0..WIDTH * WIDTH).map(|k| (k % 5) as f32).collect();
        let original = values(|x, y| [(0.7 * x).sin() + y, x * y]);
        let mut removed = original.clone();
        means.weigh(&weights);
        means.remove(&mut removed);
        let reach = (REACH * sigma).ceil();
        for pixel in [3, WIDTH * WIDTH / 2 + 6, WIDTH * WIDTH - 2] {
            let (mut sum, mut total) = (0.0, 0.0);
            for other in 0..weights.len() {
                let off =
                    [(pixel % WIDTH, other % WIDTH), (pixel / WIDTH, other / WIDTH)].map(|(a, b)| a.abs_diff(b) as f64);
                if off.iter().all(|&off| off <= reach) {
                    let share =
                        (-0.5 * (off[0].powi(2) + off[1].powi(2)) / sigma.powi(2)).exp() * f64::from(weights[other]);
                    sum += share * f64::from(original[other][1]);
                    total += share;
                }
            }
            let expected = f64::from(original[pixel][1]) - sum / total;
            assert!((f64::from(removed[pixel][1]) - expected).abs() < 1e-3, "{pixel}");
        }
    }
}
