//! Lens distortion between a pinhole and its pixels, in focal lengths off the principal point.
//!
//! Points are distorted in closed form; rays are found by Newton's method within a bracket along the radius.
//!
//! A lens model folds: beyond some radius the distorted radius shrinks, and perhaps grows again farther out. No lens
//! sees points beyond the first fold, so these have no pixels and no rays. Limits: a fold between the sixteen sampled
//! radii can be missed; it is then so shallow that it hardly moves a pixel.

mod brown;
mod fisheye;
mod inverse;

use crate::error::{Error, ErrorKind, Result};
use crate::numeric::{LANES, Lanes};
use brown::Distorted;
use fisheye::Projection;

/// The lens of a camera, as calibration tools define it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Straight lines stay straight.
    None,
    /// OpenCV's k1, k2, p1, p2, k3, k4, k5, k6; models of five coefficients have zeros for the last three.
    Brown([f64; 8]),
    /// OpenCV's fisheye, k1 to k4: the radius as a function of the angle to the optical axis.
    Fisheye([f64; 4]),
}

impl Lens {
    /// Brown's lens from 4, 5 or 8 coefficients in OpenCV's order. No coefficients, or only zeros, mean no lens.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] of `distortion` for any other number of coefficients.
    pub fn brown(coefficients: &[f64]) -> Result<Self> {
        match coefficients.len() {
            0 => Ok(Self::None),
            // OpenCV defines up to 14 coefficients; those of thin prisms and tilted sensors are not supported here.
            4.. if coefficients.iter().all(|value| *value == 0.0) => Ok(Self::None),
            4 | 5 | 8 => Ok(Self::Brown(std::array::from_fn(|k| coefficients.get(k).copied().unwrap_or(0.0)))),
            count => Err(wrong_size("4, 5 or 8", count)),
        }
    }

    /// A fisheye from its 4 coefficients in OpenCV's order. Without any, the radius equals the angle.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] of `distortion` for any other number of coefficients.
    pub fn fisheye(coefficients: &[f64]) -> Result<Self> {
        let given = if coefficients.is_empty() { &[0.0; 4] } else { coefficients };
        given.try_into().map(Self::Fisheye).map_err(|_| wrong_size("4", coefficients.len()))
    }

    /// The coefficients in OpenCV's order.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        match self {
            Self::None => &[],
            Self::Brown(coefficients) => coefficients,
            Self::Fisheye(coefficients) => coefficients,
        }
    }

    /// The name of the model, "brown" or "fisheye"; no lens counts as Brown's.
    #[must_use]
    pub const fn model(&self) -> &'static str {
        if matches!(self, Self::Fisheye(_)) { "fisheye" } else { "brown" }
    }

    /// Whether rays are straight.
    pub(crate) fn is_straight(&self) -> bool {
        match self {
            Self::None => true,
            Self::Brown(coefficients) => *coefficients == [0.0; 8],
            Self::Fisheye(_) => false,
        }
    }

    /// The distorted position of a point; `None` behind the camera, beyond the fold, and at the camera's centre. A
    /// fisheye also sees points beside and behind it, up to the angle at which it folds.
    #[inline(always)]
    pub(super) fn project(&self, point: [f64; 3]) -> Option<[f64; 2]> {
        match self {
            Self::None => slopes(point),
            Self::Brown(coefficients) => brown::project(coefficients, slopes(point)?),
            Self::Fisheye(coefficients) => fisheye::project(coefficients, point),
        }
    }

    /// [`project`](Self::project) with the derivatives by x, y, z of the point.
    pub(super) fn project_with_gradient(&self, point: [f64; 3]) -> Option<Projection> {
        match self {
            Self::None => through_slopes(point, |ray| Some((ray, [[1.0, 0.0], [0.0, 1.0]]))),
            Self::Brown(coefficients) => through_slopes(point, |ray| brown::project_with_gradient(coefficients, ray)),
            Self::Fisheye(coefficients) => fisheye::project_with_gradient(coefficients, point),
        }
    }

    /// Direction of the ray that the lens maps to `target`, accurate to a ten-millionth of a pixel at these focal
    /// lengths. It has z = 1 if it points forward; for a fisheye it is a unit vector (z below 0.01) if it points
    /// sideways or backward.
    pub(super) fn ray(&self, target: [f64; 2], focal: [f64; 2]) -> Option<[f64; 3]> {
        match self {
            Self::None => Some([target[0], target[1], 1.0]),
            Self::Brown(coefficients) => brown::ray(coefficients, target, focal).map(|[x, y]| [x, y, 1.0]),
            Self::Fisheye(coefficients) => fisheye::ray(coefficients, target, focal),
        }
    }

    /// Distorted positions of the points with four slopes; NaN beyond the fold.
    #[inline(always)]
    pub(super) fn distort_lanes(&self, ray: [Lanes; 2]) -> [Lanes; 2] {
        match *self {
            Self::None => ray,
            Self::Brown([k1, k2, p1, p2, k3, 0.0, 0.0, 0.0]) => brown::distort_lanes([k1, k2, p1, p2, k3], ray),
            _ => self.distort_each(ray),
        }
    }

    #[inline(never)]
    fn distort_each(&self, ray: [Lanes; 2]) -> [Lanes; 2] {
        let [mut x, mut y] = ray.map(Lanes::array);
        for lane in 0..LANES {
            let ahead = [f64::from(x[lane]), f64::from(y[lane]), 1.0];
            let distorted = self.project(ahead).unwrap_or([f64::NAN; 2]);
            (x[lane], y[lane]) = (distorted[0] as f32, distorted[1] as f32);
        }
        [Lanes::from(x), Lanes::from(y)]
    }
}

fn wrong_size(needed: &str, count: usize) -> Error {
    Error::new(ErrorKind::Size, "distortion", format!("needs {needed} numbers, not {count}"))
}

/// x / z and y / z of a point in front of the camera.
fn slopes([x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    (z > 0.0).then(|| [x / z, y / z])
}

fn through_slopes(point: [f64; 3], distort: impl Fn([f64; 2]) -> Option<Distorted>) -> Option<Projection> {
    let [u, v] = slopes(point)?;
    let (distorted, gradient) = distort([u, v])?;
    let inverse = 1.0 / point[2];
    let by_point = gradient.map(|[by_u, by_v]| [inverse * by_u, inverse * by_v, -inverse * (by_u * u + by_v * v)]);
    Some((distorted, by_point))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn coefficients_are_as_many_as_a_model_has() {
        let [k1, k2, p1, p2] = [0.1, -0.05, 0.003, -0.002];
        assert_eq!(Lens::brown(&[k1, k2, p1, p2]), Ok(Lens::Brown([k1, k2, p1, p2, 0.0, 0.0, 0.0, 0.0])));
        assert_eq!(Lens::brown(&[k1, k2, p1, p2, 0.2]), Ok(Lens::Brown([k1, k2, p1, p2, 0.2, 0.0, 0.0, 0.0])));
        assert_eq!(Lens::brown(&[k1; 8]), Ok(Lens::Brown([k1; 8])));
        for none in [&[][..], &[0.0; 4], &[0.0; 5], &[0.0; 8], &[0.0; 14]] {
            assert_eq!(Lens::brown(none), Ok(Lens::None));
        }
        assert_eq!(Lens::fisheye(&[k1, k2, p1, p2]), Ok(Lens::Fisheye([k1, k2, p1, p2])));
        assert_eq!(Lens::fisheye(&[]), Ok(Lens::Fisheye([0.0; 4])));
        let brown = [&[0.0; 3][..], &[k1; 3], &[k1; 6], &[k1; 14]].map(Lens::brown);
        let fisheye = [&[0.0; 1][..], &[0.0; 5], &[k1; 8]].map(Lens::fisheye);
        for refused in brown.into_iter().chain(fisheye) {
            let error = refused.unwrap_err();
            assert_eq!((error.kind(), error.field()), (ErrorKind::Size, "distortion"));
        }
    }

    #[test]
    fn four_rays_are_distorted_as_one_is() {
        let lenses = [
            Lens::None,
            Lens::Brown([0.1, -0.05, 0.003, -0.002, 0.01, 0.0, 0.0, 0.0]),
            Lens::Brown([-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]),
            Lens::Brown([0.5, -0.9, 2e-4, -1e-4, 0.4, 0.45, -0.9, 0.4]),
            Lens::Fisheye([0.01, -0.02, 0.003, 0.0]),
            Lens::Fisheye([-0.9, 0.0, 0.0, 0.0]),
        ];
        let [x, y]: [[f32; LANES]; 2] =
            [[0.0, -0.3, 0.4, 0.9], [0.1, 0.0, -0.5, 0.3]].map(|row| std::array::from_fn(|k| row[k]));
        for lens in lenses {
            let [right, down] = lens.distort_lanes([x, y].map(Lanes::from)).map(Lanes::array);
            for lane in 0..LANES {
                match lens.project([f64::from(x[lane]), f64::from(y[lane]), 1.0]) {
                    Some([u, v]) => {
                        let off = (f64::from(right[lane]) - u).hypot(f64::from(down[lane]) - v);
                        assert!(off < 1e-6, "{lens:?} {lane}: {off}");
                    }
                    None => assert!(right[lane].is_nan() && down[lane].is_nan(), "{lens:?} {lane}"),
                }
            }
        }
    }
}
