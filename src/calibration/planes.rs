//! The colour image as the check uses it: three channels in the encoding of a display, blurred as each level requires,
//! and interpolated between pixels.
//!
//! Intensities are encoded rather than linear: their noise is about the same everywhere, and an edge in shadow counts as
//! much as one in light.

use crate::pose::Silhouette;
use crate::view::{Gaussian, Size};

/// Reach of a Gaussian in sigmas, beyond which 1 % of its weight lies.
const REACH: f64 = 2.6;

/// Width of the margin around the mask that is still used, pixels of an image 640 wide, because the object's own edges
/// lie on the mask's border.
const MARGIN: f64 = 4.0;

/// Three interleaved channels, 0 .. 1; NaN where the image is not used.
#[derive(Clone, Debug)]
pub(super) struct Planes {
    pub size: Size,
    pub pixels: Vec<[f32; 3]>,
}

impl Planes {
    /// The image blurred by a Gaussian of this sigma, pixels. At the border only the part of the Gaussian that lies on
    /// the image counts.
    pub fn blurred(&self, sigma: f32) -> Self {
        if sigma <= 0.0 {
            return self.clone();
        }
        let gaussian = Gaussian::new(self.size, f64::from(sigma), REACH);
        let is_used = |index: usize| !self.pixels[index][0].is_nan();
        let [red, green, blue] = gaussian.means(is_used, |channel, index| self.pixels[index][channel]);
        let pixel = |((red, green), blue)| [red, green, blue].map(|mean: f64| mean as f32);
        let pixels = red.into_iter().zip(green).zip(blue).map(pixel).collect();
        Self { size: self.size, pixels }
    }

    /// Excludes the pixels beyond a margin around the mask.
    pub fn keep_near(&mut self, mask: &[bool]) {
        let margin = (MARGIN * self.size.width as f64 / 640.0).max(1.0);
        let mask = Silhouette::new(self.size, mask);
        for (index, pixel) in self.pixels.iter_mut().enumerate() {
            let (column, row) = self.size.position(index);
            if mask.at([column as f64, row as f64]).0 > margin {
                *pixel = [f32::NAN; 3];
            }
        }
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

    /// Bilinear values at a position; NaN outside the image and the part of it that is used.
    pub fn at(&self, [column, row]: [f64; 2]) -> [f32; 3] {
        let Size { width, height } = self.size;
        let inside = column >= 0.0 && row >= 0.0 && column <= (width - 1) as f64 && row <= (height - 1) as f64;
        if !inside {
            return [f32::NAN; 3];
        }
        let (left, top) = ((column as usize).min(width - 2), (row as usize).min(height - 2));
        let (u, v) = ((column - left as f64) as f32, (row - top as f64) as f32);
        let at = top * width + left;
        let [a, b, c, d] = [at, at + 1, at + width, at + width + 1].map(|index| self.pixels[index]);
        let mean = |k: usize| (1.0 - v) * ((1.0 - u) * a[k] + u * b[k]) + v * ((1.0 - u) * c[k] + u * d[k]);
        [0, 1, 2].map(mean)
    }
}
