//! Conversion between pixels and rays (docs/method/frames.md: x right, y down, z forward).

use super::pinhole::Pinhole;
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::{Lanes, Real};
use crate::view::Size;

/// The mapping from points to pixels of a view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// Without intrinsics: x = column - (W-1)/2, y = row - (H-1)/2, depth in pixels.
    Orthographic,
    /// Known intrinsics: points are metric.
    Pinhole(Pinhole),
}

impl Camera {
    /// Continuous pixel coordinates (column, row) of a point; `None` behind a pinhole camera or beyond the fold of its
    /// lens.
    #[must_use]
    pub fn project(&self, size: Size, point: [f64; 3]) -> Option<[f64; 2]> {
        let [x, y, z] = point;
        match self {
            Self::Orthographic => Some([x + centre(size.width), y + centre(size.height)]),
            // Depth is measured along z, so points beside and behind a fisheye have no depth.
            Self::Pinhole(pinhole) => pinhole.project(point).filter(|_| z > 0.0),
        }
    }

    /// Columns and rows of four points; NaN behind a pinhole camera or beyond the fold of its lens.
    #[inline(always)]
    pub(crate) fn project_lanes(&self, size: Size, [x, y, z]: [Lanes; 3]) -> [Lanes; 2] {
        let splat = |value: f64| Lanes::splat(value as f32);
        match self {
            Self::Orthographic => [x + splat(centre(size.width)), y + splat(centre(size.height))],
            Self::Pinhole(pinhole) => pinhole.project_lanes([x, y, z]),
        }
    }

    /// [`project`](Self::project) with the derivatives of column and row by x, y, z of the point.
    #[must_use]
    pub fn project_with_gradient(&self, size: Size, point: [f64; 3]) -> Option<([f64; 2], [[f64; 3]; 2])> {
        let [x, y, z] = point;
        match self {
            Self::Orthographic => Some((self.project(size, point)?, [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])),
            Self::Pinhole(pinhole) => {
                let pixel = self.project(size, point)?;
                // In front of the camera the pixel depends only on the ray, so the derivative by its slopes suffices.
                let [u, v] = [x / z, y / z];
                let (_, [column, row]) = pinhole.lens.project_with_gradient([u, v, 1.0])?;
                let gradient = [(pinhole.fx, column), (pinhole.fy, row)].map(|(focal_length, [by_u, by_v, _])| {
                    let share = focal_length / z;
                    [share * by_u, share * by_v, -share * (by_u * u + by_v * v)]
                });
                Some((pixel, gradient))
            }
        }
    }

    /// Direction through a pixel, with z = 1, for a pinhole camera; NaN if the lens has no ray there or the ray does
    /// not point forward. For an orthographic camera, the x and y of every point on the ray.
    #[must_use]
    pub fn ray(&self, size: Size, [column, row]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Orthographic => [column - centre(size.width), row - centre(size.height)],
            Self::Pinhole(pinhole) if pinhole.lens.is_straight() => pinhole.straight([column, row]),
            Self::Pinhole(pinhole) => match pinhole.ray([column, row]) {
                Some([x, y, 1.0]) => [x, y],
                _ => [f64::NAN; 2],
            },
        }
    }

    /// Whether a ray's x depends only on the pixel's column, and its y only on the row.
    pub(crate) fn is_straight(&self) -> bool {
        match self {
            Self::Orthographic => true,
            Self::Pinhole(pinhole) => pinhole.lens.is_straight(),
        }
    }

    /// Removes pixels from `mask` that have no ray, or no ray through the points half a pixel away, where slopes are
    /// evaluated.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] with `field` if most pixels of the mask are removed, not counting those whose `values` are
    /// NaN.
    pub(super) fn keep_pixels_with_rays(
        &self,
        field: &'static str,
        size: Size,
        values: &[f32],
        mask: &mut [bool],
    ) -> Result<()> {
        if self.is_straight() {
            return Ok(());
        }
        // Number of kept pixels minus removed ones.
        let mut balance = 0;
        for (index, inside) in mask.iter_mut().enumerate().filter(|(_, inside)| **inside) {
            let (column, row) = size.position(index);
            *inside = [[0.0, 0.0], [0.5, 0.0], [-0.5, 0.0], [0.0, 0.5], [0.0, -0.5]]
                .into_iter()
                .all(|[right, down]| !self.ray(size, [column as f64 + right, row as f64 + down])[0].is_nan());
            if !values[index].is_nan() {
                balance += if *inside { 1 } else { -1 };
            }
        }
        if balance >= 0 {
            return Ok(());
        }
        let message = "cannot be inverted: most of the object's pixels have no ray";
        Err(Error::new(ErrorKind::Range, field, message))
    }

    /// The point at `depth` seen through a pixel.
    #[must_use]
    pub fn point(&self, size: Size, pixel: [f64; 2], depth: f64) -> [f64; 3] {
        let [x, y] = self.ray(size, pixel);
        match self {
            Self::Orthographic => [x, y, depth],
            Self::Pinhole(_) => [x * depth, y * depth, depth],
        }
    }

    /// Mean focal length in pixels; `None` for an orthographic camera.
    #[must_use]
    pub fn focal_length(&self) -> Option<f64> {
        match self {
            Self::Orthographic => None,
            Self::Pinhole(pinhole) => Some((pinhole.fx * pinhole.fy).sqrt()),
        }
    }

    /// The intrinsics; `None` for an orthographic camera.
    #[must_use]
    pub const fn pinhole(&self) -> Option<Pinhole> {
        match self {
            Self::Orthographic => None,
            Self::Pinhole(pinhole) => Some(*pinhole),
        }
    }

    /// Whether the camera is orthographic.
    #[must_use]
    pub const fn is_orthographic(&self) -> bool {
        matches!(self, Self::Orthographic)
    }
}

fn centre(side: usize) -> f64 {
    (side as f64 - 1.0) / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Lens;

    /// Largest distance between a pixel and the projection of its ray, pixels, far below the rounding of points in f32.
    const RETURN_DISTANCE: f64 = 1e-6;

    #[test]
    fn rays_return_to_their_pixels_and_end_where_the_lens_folds() {
        let size = Size { width: 64, height: 64 };
        let camera = |distortion: [f64; 5]| {
            let lens = Lens::brown(&distortion).unwrap();
            Camera::Pinhole(Pinhole { fx: 60.0, fy: 60.0, cx: 32.0, cy: 32.0, lens })
        };
        // A barrel, a strong pincushion for which a fixed-point iteration would diverge, and all terms together.
        for lens in [[-0.2, 0.0, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0, 0.0, 0.0], [0.1, -0.05, 0.003, -0.002, 0.01]] {
            let camera = camera(lens);
            for pixel in [[0.0, 0.0], [63.0, 10.0], [31.5, 32.5]] {
                let [x, y] = camera.ray(size, pixel);
                let [column, row] = camera.project(size, [x, y, 1.0]).unwrap();
                assert!((column - pixel[0]).hypot(row - pixel[1]) < RETURN_DISTANCE, "{lens:?} {pixel:?}");
            }
        }
        // r - r^3 grows to at most 0.385, or 23 pixels from the centre; beyond it, only mirrored solutions exist.
        let folding = camera([-1.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(folding.ray(size, [54.5, 32.0])[0].is_finite() && folding.ray(size, [55.5, 32.0])[0].is_nan());
        let mut middle: Vec<bool> = (0..size.len()).map(|index| size.position(index).0 == 32).collect();
        folding.keep_pixels_with_rays("lens", size, &[1.0; 64 * 64], &mut middle).unwrap();
        assert!(middle[size.index(32, 32)] && !middle[size.index(32, 2)]);
        let error = folding.keep_pixels_with_rays("lens", size, &[1.0; 64 * 64], &mut [true; 64 * 64]).unwrap_err();
        assert_eq!((error.kind(), error.field()), (ErrorKind::Range, "lens"));
    }

    #[test]
    fn the_gradient_of_the_projection_is_the_difference_quotient() {
        let lens = Lens::brown(&[0.1, -0.05, 0.003, -0.002, 0.01]).unwrap();
        let pinhole = Camera::Pinhole(Pinhole { fx: 500.0, fy: 510.0, cx: 320.0, cy: 240.0, lens });
        let size = Size { width: 640, height: 480 };
        let point = [0.3, -0.2, 1.1];
        for camera in [pinhole, Camera::Orthographic] {
            let (pixel, gradient) = camera.project_with_gradient(size, point).unwrap();
            assert_eq!(Some(pixel), camera.project(size, point));
            for axis in 0..3 {
                let (mut up, mut down) = (point, point);
                up[axis] += 1e-6;
                down[axis] -= 1e-6;
                let (up, down) = (camera.project(size, up).unwrap(), camera.project(size, down).unwrap());
                for k in 0..2 {
                    assert!((gradient[k][axis] - (up[k] - down[k]) / 2e-6).abs() < 1e-5);
                }
            }
        }
    }
}
