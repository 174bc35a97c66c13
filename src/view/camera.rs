//! From pixels to rays and back (docs/method.md, section 1: x right, y down, z forward).

use crate::check::positive;
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::{Lanes, Real};
use crate::view::Size;

/// A pinhole camera with the five distortion coefficients of OpenCV.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinhole {
    /// Focal length along x in pixels.
    pub fx: f64,
    /// Focal length along y in pixels.
    pub fy: f64,
    /// Column of the principal point; pixel centres are whole numbers.
    pub cx: f64,
    /// Row of the principal point.
    pub cy: f64,
    /// k1, k2, p1, p2, k3 (Brown's model).
    pub distortion: [f64; 5],
}

/// Metres or pixels from which on a depth, or a coordinate of a cloud, counts as missing: some formats write their
/// largest number for a hole, and f32 cannot hold its square.
pub const FARTHEST: f64 = 1e12;
/// Of a ray with a slope that no picture has, and whose points may be beyond all numbers.
const TOO_STEEP: &str = "must be finite, and below 1e12 focal lengths";

impl Pinhole {
    /// # Errors
    /// [`ErrorKind::Range`] naming the number at fault below `field`.
    pub fn validate(&self, field: &str) -> Result<()> {
        positive("fx", self.fx).and(positive("fy", self.fy)).map_err(|error| error.below(field))?;
        for (name, value, focal_length) in [("cx", self.cx, self.fx), ("cy", self.cy, self.fy)] {
            let steepest = (1.0 + value.abs()) / focal_length;
            if steepest.is_nan() || steepest >= FARTHEST {
                return Err(Error::new(ErrorKind::Range, name, TOO_STEEP).value(value).below(field));
            }
        }
        for (index, value) in self.distortion.into_iter().enumerate() {
            if !value.is_finite() {
                return Err(Error::new(ErrorKind::Range, "distortion", "must be finite")
                    .at(index)
                    .value(value)
                    .below(field));
            }
        }
        Ok(())
    }

    /// Brown's distortion of a normalised image point.
    fn distort(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let [k1, k2, p1, p2, k3] = self.distortion;
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        [
            x * radial + 2.0 * p1 * x * y + p2 * (r2 + 2.0 * x * x),
            y * radial + p1 * (r2 + 2.0 * y * y) + 2.0 * p2 * x * y,
        ]
    }

    /// [`distort`](Self::distort) of four points.
    #[inline(never)]
    fn distort_lanes(&self, [x, y]: [Lanes; 2]) -> [Lanes; 2] {
        let [k1, k2, p1, p2, k3] = self.distortion.map(|value| Lanes::splat(value as f32));
        let (xx, yy, xy) = (x * x, y * y, x * y + x * y);
        let r2 = xx + yy;
        let radial = Lanes::splat(1.0) + r2 * (k1 + r2 * (k2 + r2 * k3));
        [x * radial + p1 * xy + p2 * (r2 + xx + xx), y * radial + p1 * (r2 + yy + yy) + p2 * xy]
    }

    /// Whether all coefficients of the distortion are zero.
    pub(crate) fn is_undistorted(&self) -> bool {
        self.distortion == [0.0; 5]
    }

    /// The point that is distorted to `target`, NaN where there is none, by Newton's method. A strong lens folds the
    /// image: from some radius on the distorted one shrinks. Beyond its maximum a target has no point, or one behind
    /// the fold, where the image is mirrored; that one does not count.
    fn undistort(&self, target: [f64; 2]) -> [f64; 2] {
        let mut point = target;
        for _ in 0..UNDISTORT_ROUNDS {
            let [x, y] = self.distort(point);
            let [right, down] = [target[0] - x, target[1] - y];
            let [[a, b], [c, d]] = self.distortion_gradient(point);
            let determinant = a * d - b * c;
            let returns = (self.fx * right).hypot(self.fy * down) < RETURN_DISTANCE;
            if returns && determinant > 0.0 && a + d > 0.0 {
                return point;
            }
            point[0] += (d * right - b * down) / determinant;
            point[1] += (a * down - c * right) / determinant;
        }
        [f64::NAN; 2]
    }

    /// d distorted / d (x, y).
    fn distortion_gradient(&self, [x, y]: [f64; 2]) -> [[f64; 2]; 2] {
        let [k1, k2, p1, p2, k3] = self.distortion;
        let r2 = x * x + y * y;
        let radial = 1.0 + r2 * (k1 + r2 * (k2 + r2 * k3));
        // d radial / d x = slope x.
        let slope = 2.0 * (k1 + r2 * (2.0 * k2 + 3.0 * r2 * k3));
        let mixed = x * y * slope + 2.0 * (p1 * x + p2 * y);
        [
            [radial + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, mixed],
            [mixed, radial + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x],
        ]
    }
}

/// How a view maps points to pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Camera {
    /// No intrinsics: x = column - (W-1)/2, y = row - (H-1)/2, depth in pixels.
    Orthographic,
    /// Known intrinsics: points are metric.
    Pinhole(Pinhole),
}

/// Most rounds of Newton's method that undo the distortion; usual lenses take two or three.
const UNDISTORT_ROUNDS: usize = 20;
/// Newton's method has converged when the ray's pixel is this near, in pixels: far below the rounding of points in f32.
const RETURN_DISTANCE: f64 = 1e-6;

impl Camera {
    /// Continuous pixel coordinates (column, row) of a point, `None` behind a pinhole camera.
    #[must_use]
    pub fn project(&self, size: Size, [x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
        match self {
            Self::Orthographic => Some([x + centre(size.width), y + centre(size.height)]),
            Self::Pinhole(pinhole) => {
                if z <= 0.0 {
                    return None;
                }
                let [x, y] = pinhole.distort([x / z, y / z]);
                Some([pinhole.fx * x + pinhole.cx, pinhole.fy * y + pinhole.cy])
            }
        }
    }

    /// Columns and rows of four points, NaN behind a pinhole camera.
    #[inline(always)]
    pub(crate) fn project_lanes(&self, size: Size, [x, y, z]: [Lanes; 3]) -> [Lanes; 2] {
        let splat = |value: f64| Lanes::splat(value as f32);
        match self {
            Self::Orthographic => [x + splat(centre(size.width)), y + splat(centre(size.height))],
            Self::Pinhole(pinhole) => {
                let inverse = splat(0.0).less(z).select(splat(1.0) / z, splat(f64::NAN));
                let mut ray = [x * inverse, y * inverse];
                if !pinhole.is_undistorted() {
                    ray = pinhole.distort_lanes(ray);
                }
                [splat(pinhole.fx) * ray[0] + splat(pinhole.cx), splat(pinhole.fy) * ray[1] + splat(pinhole.cy)]
            }
        }
    }

    /// [`project`](Self::project) with its derivative: d column and d row, each by x, y, z of the point.
    #[must_use]
    pub fn project_with_gradient(&self, size: Size, [x, y, z]: [f64; 3]) -> Option<([f64; 2], [[f64; 3]; 2])> {
        let pixel = self.project(size, [x, y, z])?;
        let gradient = match self {
            Self::Orthographic => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            Self::Pinhole(pinhole) => {
                let [u, v] = [x / z, y / z];
                let by_ray = pinhole.distortion_gradient([u, v]);
                [(pinhole.fx, by_ray[0]), (pinhole.fy, by_ray[1])].map(|(focal_length, [by_u, by_v])| {
                    let share = focal_length / z;
                    [share * by_u, share * by_v, -share * (by_u * u + by_v * v)]
                })
            }
        };
        Some((pixel, gradient))
    }

    /// Direction through a pixel with z = 1 for a pinhole camera, NaN where the lens lets none through; for an
    /// orthographic camera the x and y of every point on it.
    #[must_use]
    pub fn ray(&self, size: Size, [column, row]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Orthographic => [column - centre(size.width), row - centre(size.height)],
            Self::Pinhole(pinhole) => {
                let target = [(column - pinhole.cx) / pinhole.fx, (row - pinhole.cy) / pinhole.fy];
                if pinhole.is_undistorted() { target } else { pinhole.undistort(target) }
            }
        }
    }

    /// Takes the pixels out of `mask` that no ray runs through, or none through the points half a pixel beside, where
    /// slopes are evaluated.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] naming `field` where that is so of most pixels in the mask whose `values` are not NaN.
    pub(super) fn keep_pixels_with_rays(
        &self,
        field: &'static str,
        size: Size,
        values: &[f32],
        mask: &mut [bool],
    ) -> Result<()> {
        if self.pinhole().is_none_or(|pinhole| pinhole.is_undistorted()) {
            return Ok(());
        }
        // Kept pixels less removed ones.
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
        let message = "can't be undone: no ray runs through most of the object's pixels";
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

    /// Mean focal length in pixels, `None` for an orthographic camera.
    #[must_use]
    pub fn focal_length(&self) -> Option<f64> {
        match self {
            Self::Orthographic => None,
            Self::Pinhole(pinhole) => Some((pinhole.fx * pinhole.fy).sqrt()),
        }
    }

    /// The intrinsics, `None` for an orthographic camera.
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

    #[test]
    fn rays_return_to_their_pixels_and_end_where_the_lens_folds() {
        let size = Size { width: 64, height: 64 };
        let camera = |distortion| Camera::Pinhole(Pinhole { fx: 60.0, fy: 60.0, cx: 32.0, cy: 32.0, distortion });
        // A barrel, a strong pincushion that a fixed point would run away from, and one with everything.
        for lens in [[-0.2, 0.0, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0, 0.0, 0.0], [0.1, -0.05, 0.003, -0.002, 0.01]] {
            let camera = camera(lens);
            for pixel in [[0.0, 0.0], [63.0, 10.0], [31.5, 32.5]] {
                let [x, y] = camera.ray(size, pixel);
                let [column, row] = camera.project(size, [x, y, 1.0]).unwrap();
                assert!((column - pixel[0]).hypot(row - pixel[1]) < RETURN_DISTANCE, "{lens:?} {pixel:?}");
            }
        }
        // r - r^3 grows to 0.385 at most: 23 pixels from the middle. Beyond lie mirrored solutions alone.
        let folding = camera([-1.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(folding.ray(size, [54.5, 32.0])[0].is_finite() && folding.ray(size, [55.5, 32.0])[0].is_nan());
        let mut middle: Vec<bool> = (0..size.len()).map(|index| size.position(index).0 == 32).collect();
        folding.keep_pixels_with_rays("lens", size, &[1.0; 64 * 64], &mut middle).unwrap();
        assert!(middle[size.index(32, 32)] && !middle[size.index(32, 2)]);
        let error = folding.keep_pixels_with_rays("lens", size, &[1.0; 64 * 64], &mut [true; 64 * 64]).unwrap_err();
        assert_eq!((error.kind(), error.field()), (ErrorKind::Range, "lens"));
    }

    /// Found by the fuzzer: the first pose of such a camera was infinite.
    #[test]
    fn rays_as_steep_as_no_picture_has_them_are_refused() {
        let good = Pinhole { fx: 60.0, fy: 60.0, cx: -500.0, cy: 31.5, distortion: [0.0; 5] };
        assert_eq!(good.validate("camera"), Ok(()));
        for (bad, field) in [
            (Pinhole { cx: 1e308, ..good }, "camera.cx"),
            (Pinhole { cx: f64::NAN, ..good }, "camera.cx"),
            (Pinhole { cy: -1e15, ..good }, "camera.cy"),
            (Pinhole { cx: 0.0, fx: 1e-300, ..good }, "camera.cx"),
            (Pinhole { fy: f64::INFINITY, ..good }, "camera.fy"),
        ] {
            let error = bad.validate("camera").unwrap_err();
            assert_eq!((error.kind(), error.field()), (ErrorKind::Range, field));
        }
    }

    #[test]
    fn the_gradient_of_the_projection_is_the_difference_quotient() {
        let distortion = [0.1, -0.05, 0.003, -0.002, 0.01];
        let pinhole = Camera::Pinhole(Pinhole { fx: 500.0, fy: 510.0, cx: 320.0, cy: 240.0, distortion });
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
