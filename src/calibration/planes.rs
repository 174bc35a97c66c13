//! The colour image as a check of a calibration sees it: three channels in the encoding of a display, blurred as much as
//! a level asks for, and their values between pixels.
//!
//! Encoded intensities, not linear ones: their noise is about the same everywhere, and an edge in shadow counts as one
//! in light does.

use crate::view::Size;

/// Reach of a Gaussian in sigmas; what lies beyond weighs 1 %.
const REACH: f32 = 2.6;

/// Three channels side by side, 0 .. 1.
#[derive(Clone, Debug)]
pub(super) struct Planes {
    pub size: Size,
    pub pixels: Vec<[f32; 3]>,
}

impl Planes {
    /// The Gaussian mean, sigma in pixels; at the border of those pixels that exist.
    pub fn blurred(&self, sigma: f32) -> Self {
        if sigma <= 0.0 {
            return self.clone();
        }
        let Size { width, height } = self.size;
        // A pose that is far off asks for any width.
        let reach = ((REACH * sigma).ceil() as usize).min(width.max(height));
        let weights: Vec<f32> = (0..=reach).map(|k| (-0.5 * (k as f32 / sigma).powi(2)).exp()).collect();
        let rows = blur_lines(&self.pixels, &weights, (width, 1), (height, width));
        Self { size: self.size, pixels: blur_lines(&rows, &weights, (height, width), (width, 1)) }
    }

    /// Means of two by two pixels.
    pub fn halved(&self) -> Self {
        let size = Size { width: self.size.width / 2, height: self.size.height / 2 };
        let mean = |index: usize| {
            let (column, row) = size.position(index);
            let at = self.size.index(2 * column, 2 * row);
            let four = [at, at + 1, at + self.size.width, at + self.size.width + 1].map(|index| self.pixels[index]);
            std::array::from_fn(|k| four.iter().map(|pixel| pixel[k]).sum::<f32>() / 4.0)
        };
        Self { size, pixels: (0..size.len()).map(mean).collect() }
    }

    /// Bilinear values at a position, `None` outside.
    pub fn at(&self, [column, row]: [f64; 2]) -> Option<[f32; 3]> {
        let Size { width, height } = self.size;
        let inside = column >= 0.0 && row >= 0.0 && column <= (width - 1) as f64 && row <= (height - 1) as f64;
        if !inside {
            return None;
        }
        let (left, top) = ((column as usize).min(width - 2), (row as usize).min(height - 2));
        let (u, v) = ((column - left as f64) as f32, (row - top as f64) as f32);
        let at = top * width + left;
        let [a, b, c, d] = [at, at + 1, at + width, at + width + 1].map(|index| self.pixels[index]);
        Some(std::array::from_fn(|k| (1.0 - v) * ((1.0 - u) * a[k] + u * b[k]) + v * ((1.0 - u) * c[k] + u * d[k])))
    }
}

/// The weighted mean along lines: `along` is how many samples a line has and their distance in memory, `across` the same
/// of the lines.
fn blur_lines(pixels: &[[f32; 3]], weights: &[f32], along: (usize, usize), across: (usize, usize)) -> Vec<[f32; 3]> {
    let mut blurred = vec![[0.0; 3]; pixels.len()];
    let ((count, stride), reach) = (along, weights.len() - 1);
    for line in 0..across.0 {
        let start = line * across.1;
        for k in 0..count {
            let (mut sum, mut total) = ([0.0; 3], 0.0);
            for other in k.saturating_sub(reach)..=(k + reach).min(count - 1) {
                let weight = weights[other.abs_diff(k)];
                let pixel = &pixels[start + other * stride];
                (0..3).for_each(|channel| sum[channel] += weight * pixel[channel]);
                total += weight;
            }
            blurred[start + k * stride] = sum.map(|value| value / total);
        }
    }
    blurred
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Found by the fuzzer: candidates that lie far off ask for any width, and its weights would not have fitted into memory.
    #[test]
    fn a_blur_of_any_width_is_the_mean() {
        let size = Size { width: 5, height: 3 };
        let pixels: Vec<[f32; 3]> = (0..size.len()).map(|k| [k as f32, 1.0, 0.0]).collect();
        for sigma in [1e4, 1e30, f32::INFINITY] {
            let blurred = Planes { size, pixels: pixels.clone() }.blurred(sigma);
            assert!(blurred.pixels.iter().all(|pixel| (pixel[0] - 7.0).abs() < 1e-3 && pixel[1] == 1.0), "{sigma}");
        }
    }
}
