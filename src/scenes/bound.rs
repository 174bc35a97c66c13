//! sqrt(trace of the rotation block of F^-1): the smallest error of the rotation that any estimator can have (Cramer,
//! Rao).
//!
//! F = sum over image pixels of J^T J / sigma^2 at the true pose with the true normals. J is the derivative of log S at
//! a pixel by rotation and translation (scale fixed) and, if it is unknown, by the 27 coefficients of the light. A
//! pixel counts if the depth view sees its point. With the slope g of log S in the image and its slope b by the normal,
//! a rotation about c changes the prediction at a fixed pixel by (P - c) x g - n x b, up to sign.
//!
//! Limits: the bound has no prior of the light and no exposure. Slopes of log S are central differences of the
//! noise-free image, so pixels at its border do not count. Errors of the depth view (noise, normals from differences)
//! are not included.

use nalgebra::{SMatrix, SVector, Vector3};

use super::sample::Sample;
use crate::light::{COEFFICIENTS, HARMONICS, basis, basis_gradient};
use crate::view::{Camera, Size};

const POSE: usize = 6;
const UNKNOWNS: usize = POSE + COEFFICIENTS;
type FisherInformation = SMatrix<f64, UNKNOWNS, UNKNOWNS>;
type Row = SVector<f64, UNKNOWNS>;

/// A point of the image is visible in the depth view if both depths differ by less than this, in steps between
/// neighbouring pixels (at least one pixel length).
const SAME_DEPTH: f64 = 1.0;

/// The bound of a sample's rotation in degrees for noise `sigma` of log S. `None` if the scene determines no rotation
/// or there is no noise.
#[must_use]
pub fn bound(sample: &Sample, light_is_known: bool, sigma: f64) -> Option<f64> {
    let size = sample.image.size;
    let points: Vec<Option<Vector3<f64>>> = (0..size.len()).map(|index| point(sample, index)).collect();
    let seen: Vec<usize> = (0..size.len()).filter(|&index| points[index].is_some_and(|p| is_seen(sample, p))).collect();
    let centre = seen.iter().filter_map(|&index| points[index]).sum::<Vector3<f64>>() / seen.len().max(1) as f64;
    let mut information = FisherInformation::zeros();
    for &index in &seen {
        let (Some(point), Some(slopes)) = (points[index], log_slopes(sample, index)) else { continue };
        let normal = normal(sample, index);
        for (channel, slope) in slopes.into_iter().enumerate() {
            let slope = in_space(&sample.image.camera, size, point, slope)?;
            let by_normal = shade_slope(sample, channel, normal);
            let by_rotation = (point - centre).cross(&slope) - normal.cross(&by_normal);
            let mut row = Row::zeros();
            row.fixed_rows_mut::<3>(0).copy_from(&by_rotation);
            row.fixed_rows_mut::<3>(3).copy_from(&slope);
            if !light_is_known {
                row.fixed_rows_mut::<HARMONICS>(POSE + channel * HARMONICS)
                    .copy_from(&-SVector::<f64, HARMONICS>::from(basis(normal.into())));
            }
            information.syger(1.0 / (sigma * sigma), &row, &row, 1.0);
        }
    }
    information.fill_upper_triangle_with_lower_triangle();
    for k in 0..UNKNOWNS {
        let is_fixed = (k >= POSE && light_is_known) || (k == POSE - 1 && sample.image.camera.is_orthographic());
        if is_fixed {
            information[(k, k)] = 1.0;
        }
    }
    let covariance = information.cholesky()?.inverse();
    let variance = covariance[(0, 0)] + covariance[(1, 1)] + covariance[(2, 2)];
    variance.is_finite().then(|| variance.sqrt().to_degrees())
}

fn normal(sample: &Sample, index: usize) -> Vector3<f64> {
    Vector3::from(sample.truth.image_normals.get(index).map(f64::from))
}

/// The point of an image pixel.
fn point(sample: &Sample, index: usize) -> Option<Vector3<f64>> {
    let (column, row) = sample.image.size.position(index);
    let depth = f64::from(sample.truth.image_depth[index]);
    let point = sample.image.camera.point(sample.image.size, [column as f64, row as f64], depth);
    (sample.image.mask[index] && depth.is_finite()).then(|| point.into())
}

/// Whether the depth view sees a point of the image.
fn is_seen(sample: &Sample, point: Vector3<f64>) -> bool {
    let point = sample.pose.inverse().apply(point);
    let size = sample.depth.size;
    let Some([column, row]) = sample.depth.camera.project(size, point.into()) else { return false };
    let Some(pixel) = size.nearest(column as f32, row as f32) else { return false };
    let depth = &sample.truth.depth;
    let unit = sample.depth.camera.focal_length().map_or(1.0, |focal_length| point.z / focal_length);
    let steps = size.neighbours(pixel).map(|near| f64::from((depth[near] - depth[pixel]).abs()));
    let step = steps.filter(|step| !step.is_nan()).fold(unit, f64::max);
    (f64::from(depth[pixel]) - point.z).abs() < SAME_DEPTH * step
}

/// d log S / d (column, row) of the three channels, without noise; `None` at the border.
fn log_slopes(sample: &Sample, index: usize) -> Option<[[f64; 2]; 3]> {
    let Size { width, height } = sample.image.size;
    let (column, row) = sample.image.size.position(index);
    let inside = column > 0 && row > 0 && column + 1 < width && row + 1 < height;
    let near = inside.then(|| [index - 1, index + 1, index - width, index + width])?;
    if near.iter().any(|&near| !sample.image.mask[near]) {
        return None;
    }
    let [left, right, up, down] = near.map(|near| sample.light.shade(normal(sample, near).into()));
    Some(std::array::from_fn(|c| [(right[c] - left[c]) / 2.0, (down[c] - up[c]) / 2.0]))
}

/// Converts a slope in the image to one in space.
fn in_space(camera: &Camera, size: Size, point: Vector3<f64>, [column, row]: [f64; 2]) -> Option<Vector3<f64>> {
    let (_, by_point) = camera.project_with_gradient(size, point.into())?;
    Some(Vector3::from_fn(|axis, _| column * by_point[0][axis] + row * by_point[1][axis]))
}

/// d log S / d normal of a channel.
fn shade_slope(sample: &Sample, channel: usize, normal: Vector3<f64>) -> Vector3<f64> {
    let gradient = basis_gradient(normal.into());
    Vector3::from_fn(|axis, _| (0..HARMONICS).map(|k| sample.light.0[channel][k] * gradient[k][axis]).sum())
}
