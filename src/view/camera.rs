//! From pixels to rays and back (handbook frame: x right, y down, z forward).

use crate::error::{Error, ErrorKind, Result};
use crate::options::positive;
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

impl Pinhole {
    /// # Errors
    /// [`ErrorKind::Range`] naming the number at fault below `field`.
    pub fn validate(&self, field: &str) -> Result<()> {
        positive("fx", self.fx).and(positive("fy", self.fy)).map_err(|error| error.below(field))?;
        for (name, value) in [("cx", self.cx), ("cy", self.cy)] {
            if !value.is_finite() {
                return Err(Error::new(ErrorKind::Range, name, "must be finite").value(value).below(field));
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

/// Fixed-point rounds that undo the distortion; 20 bring usual lenses below 1e-9.
const UNDISTORT_ROUNDS: usize = 20;

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

    /// Direction through a pixel with z = 1 for a pinhole camera; for an orthographic one the x and y of every point on
    /// it.
    #[must_use]
    pub fn ray(&self, size: Size, [column, row]: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Orthographic => [column - centre(size.width), row - centre(size.height)],
            Self::Pinhole(pinhole) => {
                let target = [(column - pinhole.cx) / pinhole.fx, (row - pinhole.cy) / pinhole.fy];
                if pinhole.distortion == [0.0; 5] {
                    return target;
                }
                let mut point = target;
                for _ in 0..UNDISTORT_ROUNDS {
                    let [x, y] = pinhole.distort(point);
                    point = [point[0] + target[0] - x, point[1] + target[1] - y];
                }
                point
            }
        }
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
