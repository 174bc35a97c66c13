//! The colour image as a check of a calibration sees it: three channels in the encoding of a display, blurred as much as
//! a level asks for, and their values between pixels.
//!
//! Encoded intensities, not linear ones: their noise is about the same everywhere, and an edge in shadow counts as one
//! in light does.

use crate::view::{Gaussian, Size};

/// Reach of a Gaussian in sigmas; what lies beyond weighs 1 %.
const REACH: f64 = 2.6;

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
        let gaussian = Gaussian::new(self.size, f64::from(sigma), REACH);
        let [red, green, blue] = gaussian.means(|_| true, |channel, index| self.pixels[index][channel]);
        let pixel = |((red, green), blue)| [red, green, blue].map(|mean: f64| mean as f32);
        let pixels = red.into_iter().zip(green).zip(blue).map(pixel).collect();
        Self { size: self.size, pixels }
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
