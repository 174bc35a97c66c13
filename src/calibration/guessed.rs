//! The uncertainty that a guessed colour camera adds.
//!
//! If no intrinsics are given, the focal length is estimated. The principal point and the lens are not, because one frame
//! hardly distinguishes them from a rotation, a shift and the focal length. The estimate compensates for their errors
//! instead, as much as least squares over the scene's points would, and the covariance includes this effect (consider
//! parameters; Bierman 1977, chapter 8).

use nalgebra::Vector3;

use super::unknowns::{Matrix, Units, Vector, add_square, solve};
use crate::view::Pinhole;

/// Sigma of either coordinate of the principal point, as a share of the image's width: typical cameras deviate from the
/// centre by one to three hundredths.
const PRINCIPAL_POINT: f64 = 0.02;
/// Sigma of Brown's k1: webcams and the colour cameras of depth cameras have up to 0.1 or 0.2.
const LENS: f64 = 0.1;
const PARAMETERS: usize = 3;

/// Motion of a scene, in pixels, that a guessed camera can explain: two sigmas of its principal point. A smaller error
/// cannot be distinguished from zero.
pub(super) fn explains(width: f64) -> f64 {
    2.0 * PRINCIPAL_POINT * width
}

/// Covariance of the estimate due to an unknown principal point and lens. `cloud` is in the colour camera's frame,
/// `width` is that of the image in pixels of the units, and `prior` is the information of the prior.
pub(super) fn covariance(
    units: &Units,
    camera: &Pinhole,
    cloud: &[Vector3<f64>],
    width: f64,
    prior: &Matrix,
) -> Matrix {
    let mut information = *prior;
    let mut pulls = [Vector::zeros(); PARAMETERS];
    let shift = PRINCIPAL_POINT * width;
    for (point, (pixel, rows)) in cloud.iter().filter_map(|point| Some((point, units.rows(point, camera)?))) {
        let [x, y] = [point.x / point.z, point.y / point.z];
        let bend = LENS * (x * x + y * y);
        let moved = [[shift, 0.0], [0.0, shift], [bend * (pixel[0] - camera.cx), bend * (pixel[1] - camera.cy)]];
        for (axis, row) in rows.iter().enumerate() {
            add_square(&mut information, row, 1.0);
            for (pull, moved) in pulls.iter_mut().zip(moved) {
                *pull += row * moved[axis];
            }
        }
    }
    let mut covariance = Matrix::zeros();
    for step in pulls.iter().filter_map(|pull| solve(&information, pull)) {
        add_square(&mut covariance, &step, 1.0);
    }
    covariance
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Lens;

    #[test]
    fn before_one_depth_a_principal_point_is_a_shift() {
        let camera = Pinhole { fx: 500.0, fy: 500.0, cx: 320.0, cy: 240.0, lens: Lens::None };
        let cloud: Vec<_> = (0..400)
            .map(|k| Vector3::new((k % 20) as f64 / 100.0 - 0.095, (k / 20) as f64 / 100.0 - 0.095, 1.0))
            .collect();
        let units = Units::new(&cloud, &camera);
        // Rotations about the centre and shifts along the axis are held, so that only shifts across the axis can
        // compensate.
        let mut prior = Matrix::identity() * 1e12;
        (3..5).for_each(|k| prior[(k, k)] = 1e-6);
        let found = covariance(&units, &camera, &cloud, 640.0, &prior);
        let sigma = |k: usize| found[(k, k)].sqrt() * units.of[k];
        let expected = PRINCIPAL_POINT * 640.0 / 500.0;
        assert!((sigma(3) - expected).abs() < 0.02 * expected, "{} for {expected}", sigma(3));
        assert!((sigma(4) - expected).abs() < 0.02 * expected);
        assert!(sigma(5) < 0.01 * expected);
    }
}
