//! The noise of a depth map, distinguished from its surface by how second differences grow with their span
//! (docs/method/views.md).
//!
//! D_k = z(x - k) - 2 z(x) + z(x + k). A surface whose slope wanders, by innovations of variance c^2 per pixel, has var
//! D_k = c^2 k (2 k^2 + 1) / 3. Noise has var D_k = 6 sigma^2 for every span wider than its correlation. Both therefore
//! follow from a few spans by linear least squares, whatever causes the noise. White noise, noise that the sensor has
//! smoothed laterally, and the staircase of a quantised map all stop growing, while a surface never does. Fourth
//! differences of neighbours (`numeric::noise`) see white noise, but not a staircase.
//!
//! All lengths are heights in pixels (`heights`). A depth sensor's noise grows with z^2, so that of f ln Z grows with
//! z. Limits: relief that repeats within a few pixels also stops growing. Relief that grows too slowly over the first
//! two spans counts as noise.

use crate::numeric::{noise, quantile};
use crate::view::Size;

/// Spans of the fit in pixels. A sensor's noise is correlated over two or three pixels, so a span of one pixel shows
/// too little of the noise. Over wider spans the differences of small objects stop growing, like noise. Set on busts of
/// 64x64 with white noise (docs/lab/thresholds.md).
const SPANS: [usize; 3] = [2, 3, 4];
/// Spans whose growth distinguishes noise from a surface.
const GROWTH_SPANS: [usize; 2] = [1, 2];
/// Largest ratio var D_1 / var D_2 of a surface. A surface whose slope is a random walk has this ratio; smoother
/// surfaces have a smaller one, and noise has a larger one.
const SURFACE_GROWTH: f64 = 1.0 / 6.0;
/// Second differences beyond this quantile are excluded as depth discontinuities and creases. The factor corrects the
/// variance of the others if they are normal: 1 - 2 q phi(q) / 0.8 with q = 1.2816.
const KEPT: f64 = 0.8;
const KEPT_VARIANCE: f64 = 0.438;
/// Smallest number of second differences, which determine a variance to 5 %, and the most that are used. An object of
/// 32x32 pixels has fewer: relief of a few pixels cannot be distinguished from noise there.
const FEWEST: usize = 1000;
const MOST: usize = 1 << 16;

/// Noise counts as white if fourth differences of neighbours see at least this share of the noise. They see less of the
/// noise in quantised and laterally smoothed maps. If the steps of a quantised map are as narrow as pixels, its noise
/// is white. Set on ten surfaces (docs/lab/thresholds.md).
const LEAST_WHITE: f64 = 0.75;
/// A map whose noise is not white is smoothed if lambda exceeds this: a window of lambda^(1/4) = 0.8 pixels. Noise with
/// a smaller lambda cannot be distinguished from relief, and a narrower window smooths nothing. Set on busts of 64x64
/// (docs/lab/thresholds.md).
const LEAST_SMOOTHING: f64 = 0.4;
/// Robust scale of the second differences, in units of the roughness: least squares would round off creases. Set on
/// five objects of MIT-Berkeley with quantised depth and a scanned bear (docs/lab/thresholds.md).
const CREASE: f64 = 2.0;

/// Noise and roughness of a depth map, heights in pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DepthNoise {
    /// Standard deviation of the noise at the median depth; zero if the map shows none.
    pub sigma: f64,
    /// Standard deviation of the change of the surface's slope from one pixel to the next.
    pub roughness: f64,
    /// Whether neighbours share no noise. The staircase of a quantised map and laterally smoothed noise are not white.
    pub is_white: bool,
}

impl DepthNoise {
    /// Estimates the noise of a raster of heights, NaN where missing.
    #[must_use]
    pub(crate) fn of(size: Size, heights: &[f32]) -> Self {
        let mut sizes = Vec::with_capacity(MOST);
        let mut variance = |span| variance_of_second_differences(size, heights, span, &mut sizes);
        let [Some(first), Some(second)] = GROWTH_SPANS.map(&mut variance) else { return Self::default() };
        if first <= SURFACE_GROWTH * second {
            return Self::default();
        }
        // Least squares of relative errors, because variances of wide spans are hundreds of times larger.
        let (mut ss, mut sc, mut cc, mut s1, mut c1) = (0.0, 0.0, 0.0, 0.0, 0.0);
        for span in SPANS {
            let Some(variance) = variance(span) else { break };
            let k = span as f64;
            let (s, c) = (6.0 / variance, k * (2.0 * k * k + 1.0) / (3.0 * variance));
            (ss, sc, cc, s1, c1) = (ss + s * s, sc + s * c, cc + c * c, s1 + s, c1 + c);
        }
        let determinant = ss * cc - sc * sc;
        let [variance, wander] = [cc * s1 - sc * c1, ss * c1 - sc * s1].map(|part| part / determinant);
        // This also covers too few spans, for which the determinant is zero.
        if !(variance > 0.0 && wander > 0.0 && variance.is_finite() && wander.is_finite()) {
            return Self::default();
        }
        let white = white_noise(size, heights);
        let all = variance.sqrt();
        let is_white = white > LEAST_WHITE * all;
        let sigma = if is_white { white } else { all };
        let noise = Self { sigma, roughness: wander.sqrt(), is_white };
        // White noise is certain; other noise may be relief unless its window is wide.
        if is_white || noise.smoothing() > LEAST_SMOOTHING { noise } else { Self::default() }
    }

    /// Whether the map shows noise.
    #[must_use]
    pub fn is_visible(&self) -> bool {
        self.sigma > 0.0
    }

    /// Second difference beyond which the surface has a crease, heights in pixels.
    #[must_use]
    pub fn crease(&self) -> f64 {
        CREASE * self.roughness
    }

    /// Reach of the smoothing, lambda^(1/4) pixels: narrower detail cannot be distinguished from noise.
    #[must_use]
    pub fn window(&self) -> f64 {
        self.smoothing().sqrt().sqrt()
    }

    /// sigma^2 / c^2: the weight of a squared second difference relative to a squared offset from the measured height.
    #[must_use]
    pub fn smoothing(&self) -> f64 {
        if self.is_visible() { (self.sigma / self.roughness).powi(2) } else { 0.0 }
    }
}

/// Standard deviation of white noise, from the fourth differences of neighbours along both axes.
pub(crate) fn white_noise(size: Size, heights: &[f32]) -> f64 {
    let fourth =
        |run: [usize; noise::NEIGHBOURS]| noise::fourth_difference(run.map(|index| f64::from(heights[index]))) as f32;
    noise::of_fourth_differences(&mut size.runs().map(fourth), 2 * size.len())
}

/// An upper bound of a raster's noise, in which relief within two pixels counts as noise.
pub(crate) fn most(size: Size, values: &[f32]) -> f64 {
    variance_of_second_differences(size, values, SPANS[0], &mut vec![]).map_or(0.0, |variance| (variance / 6.0).sqrt())
}

/// Variance of the second differences of this span along both axes, without the largest; `None` if there are too few.
fn variance_of_second_differences(size: Size, heights: &[f32], span: usize, sizes: &mut Vec<f32>) -> Option<f64> {
    sizes.clear();
    let every = (2 * size.len()).div_ceil(MOST);
    for row in (0..size.height).step_by(every) {
        for column in 0..size.width {
            let index = size.index(column, row);
            let [across, down] = [(column, size.width, 1), (row, size.height, size.width)].map(|(at, side, stride)| {
                let fits = at >= span && at + span < side;
                let reach = span * stride;
                if fits { heights[index - reach] - 2.0 * heights[index] + heights[index + reach] } else { f32::NAN }
            });
            sizes.extend([across, down].into_iter().filter(|size| size.is_finite()).map(f32::abs));
        }
    }
    if sizes.len() < FEWEST {
        return None;
    }
    let largest = quantile(sizes, KEPT);
    let kept = || sizes.iter().filter(|&&size| size <= largest).map(|&size| f64::from(size));
    let variance = kept().map(|size| size * size).sum::<f64>() / (kept().count() as f64 * KEPT_VARIANCE);
    (variance > 0.0).then_some(variance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::noise::white_noise as normal_numbers;

    const SIZE: Size = Size { width: 96, height: 96 };

    /// A round body with a few waves, heights in pixels.
    fn body() -> Vec<f32> {
        let height = |index: usize| {
            let (column, row) = SIZE.position(index);
            let [x, y] = [column, row].map(|at| (at as f32 - 47.5) / 48.0);
            let square = x * x + y * y;
            if square > 0.9 {
                f32::NAN
            } else {
                -40.0 * (1.0 - square).sqrt() + 2.0 * (7.0 * x).sin() * (5.0 * y).cos()
            }
        };
        (0..SIZE.len()).map(height).collect()
    }

    #[test]
    fn a_body_without_flaws_shows_no_noise() {
        assert_eq!(DepthNoise::of(SIZE, &body()), DepthNoise::default());
    }

    #[test]
    fn white_noise_is_told_and_called_white() {
        let (mut heights, mut normal) = (body(), normal_numbers(4));
        heights.iter_mut().for_each(|height| *height += 0.3 * normal() as f32);
        let noise = DepthNoise::of(SIZE, &heights);
        assert!(noise.is_white && (noise.sigma - 0.3).abs() < 0.03, "{noise:?}");
    }

    /// Rounding errs by the step divided by the root of twelve.
    #[test]
    fn a_staircase_is_not_free_of_noise() {
        for step in [0.8_f32, 1.5] {
            let heights: Vec<f32> = body().iter().map(|height| (height / step).round() * step).collect();
            let noise = DepthNoise::of(SIZE, &heights);
            let truth = f64::from(step) / 12.0_f64.sqrt();
            assert!((0.6..1.7).contains(&(noise.sigma / truth)), "{step}: {noise:?} {truth}");
        }
    }

    /// A box filter of three by three makes neighbours share their noise, so that differences of neighbours do not show
    /// it.
    #[test]
    fn noise_smoothed_sideways_keeps_its_size() {
        let (mut heights, mut normal) = (body(), normal_numbers(9));
        let white: Vec<f64> = (0..SIZE.len()).map(|_| normal()).collect();
        for column in 1..SIZE.width - 1 {
            for row in 1..SIZE.height - 1 {
                let nine = (0..9).map(|k| white[SIZE.index(column + k % 3 - 1, row + k / 3 - 1)]).sum::<f64>();
                heights[SIZE.index(column, row)] += (0.5 * nine / 3.0) as f32;
            }
        }
        let noise = DepthNoise::of(SIZE, &heights);
        assert!(!noise.is_white && (0.35..0.6).contains(&noise.sigma), "{noise:?}");
        // Fourth differences of a sum of three neighbours are 1, -3, 3, -2, 3, -3, 1 times the noise.
        let seen = 0.5 * (42.0_f64 / 3.0 / 70.0).sqrt();
        assert!((white_noise(SIZE, &heights) / seen - 1.0).abs() < 0.1);
    }
}
