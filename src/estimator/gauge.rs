//! Units and gauges: fixes what the data cannot determine (`docs/method/frames.md`).
//!
//! - Scale: for a metric cloud and a pixel image, s is near s0 = focal length / median Z. For pixels and pixels, and
//!   for any image with known intrinsics, s0 = 1.
//! - An orthographic image does not depend on t_z: the median depth difference of the correspondences is set to zero.
//! - A pinhole image does not determine the size of its surface: s is held and the surface is scaled instead.

use super::pair::ViewPair;
use super::solution::Solution;
use crate::numeric::quantile;
use crate::pose::{Correspondences, Similarity};
use crate::view::{Camera, ColourView, DepthView, Points};

/// Factor of the apparent size, or its inverse, beyond which a pose is not plausible beside a given one. The search covers
/// 0.7 to 1.4, and a single registration may change the size by `photometric::COLLAPSE`.
const LARGEST_SIZE_RATIO: f64 = 2.0;

/// s0: length of one unit of the depth view in the colour view.
pub fn unit_scale(pair: &ViewPair) -> f64 {
    let ViewPair { image, depth, .. } = pair;
    let focal_length = image.camera.focal_length().or_else(|| depth.camera.focal_length());
    match (image.camera, focal_length) {
        (Camera::Orthographic, Some(focal_length)) => focal_length / median_depth(depth),
        _ => 1.0,
    }
}

/// The scale that the registration holds; `None` if it is free.
///
/// Behind a pinhole, a change of scale equals a change of the surface's size, so the pose keeps its scale.
pub fn held_scale(pair: &ViewPair) -> Option<f64> {
    pair.options.scale.or_else(|| (!pair.image.camera.is_orthographic()).then_some(1.0))
}

/// Difference of the object's apparent size between two poses: |ln(s / s')| for an orthographic image, and
/// |ln((s / z) / (s' / z'))| with the distances z of its centre behind a pinhole, which holds s. Infinite behind the
/// camera.
pub fn growth(pair: &ViewPair, pose: &Similarity, other: &Similarity) -> f64 {
    if pair.image.camera.is_orthographic() {
        return pose.growth_from(other);
    }
    let middle = pair.depth.points.centroid();
    let size = |pose: &Similarity| pose.scale / pose.apply(middle).z;
    let growth = (size(pose) / size(other)).ln().abs();
    if growth.is_finite() { growth } else { f64::INFINITY }
}

/// Whether the apparent size stays within [`LARGEST_SIZE_RATIO`] of the other pose's.
pub fn keeps_size(pair: &ViewPair, pose: &Similarity, other: &Similarity) -> bool {
    growth(pair, pose, other) <= LARGEST_SIZE_RATIO.ln()
}

/// Length of an image pixel at the object under the solution's pose, in units of the colour view.
pub fn pixel_length(image: &ColourView, solution: &Solution) -> f64 {
    let distance = || solution.pose.apply(solution.depth.points.centroid()).z;
    image.camera.focal_length().map_or(1.0, |focal_length| distance() / focal_length)
}

fn median_depth(depth: &DepthView) -> f64 {
    let mut values: Vec<f32> = depth.depth().iter().copied().filter(|value| !value.is_nan()).collect();
    f64::from(quantile(&mut values, 0.5))
}

/// Fixes the depth of the image's surface where neither view determines it: an orthographic one gets median depth zero,
/// a pinhole's is scaled to meet the corresponding depth points. Writes the image's points, and the pose's t_z.
pub fn fix_depth_of_surface(
    pair: &ViewPair,
    correspondences: &Correspondences,
    spare: &mut Vec<f32>,
    solution: &mut Solution,
) {
    if pair.image.camera.is_orthographic() {
        solution.image.centre_depth(spare);
    } else {
        let ratio = median_gap(solution, correspondences, spare, |image, depth| depth / image);
        if let Some(ratio) = ratio.filter(|ratio| *ratio > 0.0) {
            solution.image.scale_depth(ratio);
        }
    }
    solution.image.place_image_points(&pair.image);
    fix_depth_of_pose(pair, correspondences, spare, solution);
}

/// Sets the pose's t_z for an orthographic image, so that the median depth difference of the overlap is zero.
pub fn fix_depth_of_pose(
    pair: &ViewPair,
    correspondences: &Correspondences,
    spare: &mut Vec<f32>,
    solution: &mut Solution,
) {
    if pair.image.camera.is_orthographic()
        && let Some(difference) = median_gap(solution, correspondences, spare, |image, depth| image - depth)
    {
        solution.pose.translation.z += difference;
    }
}

/// Median over the correspondences of a function of the image surface's depth and the depth point's.
fn median_gap(
    solution: &Solution,
    correspondences: &Correspondences,
    spare: &mut Vec<f32>,
    gap: impl Fn(f64, f64) -> f64,
) -> Option<f64> {
    let Solution { pose, image, depth, .. } = solution;
    let (row, shift) = (pose.scale * pose.rotation.row(2), pose.translation.z);
    let Points { x, y, z } = &depth.points;
    spare.clear();
    for (&index, &depth) in correspondences.depth_of_pixel().iter().zip(&image.points.z) {
        let Ok(index) = usize::try_from(index) else { continue };
        if !depth.is_nan() {
            let [x, y, z] = [f64::from(x[index]), f64::from(y[index]), f64::from(z[index])];
            spare.push(gap(f64::from(depth), row[0] * x + row[1] * y + row[2] * z + shift) as f32);
        }
    }
    (!spare.is_empty()).then(|| f64::from(quantile(spare, 0.5)))
}
