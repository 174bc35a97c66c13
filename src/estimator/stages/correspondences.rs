//! Correspondences of depth points and pixels under the pose of a solution.

use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::solution::Solution;
use crate::pose::CorrespondenceProblem;

/// Correspondences are accepted within this multiple of the median distance between the surfaces.
const SPREADS: f64 = 3.0;

/// The problem that projects the depth points, hides the occluded ones, and drops those too far from the image surface.
pub fn correspondence_problem<'a>(pair: &'a ViewPair, solution: &'a Solution) -> CorrespondenceProblem<'a> {
    let pixel_length = gauge::pixel_length(&pair.image, solution);
    CorrespondenceProblem {
        image: &pair.image,
        depth: &pair.depth,
        pose: &solution.pose,
        depth_points: &solution.depth.points,
        depth_normals: &solution.depth.normals,
        image_points: &solution.image.points,
        image_normals: &solution.image.normals,
        distance: pair.options.correspondence_distance.map(|distance| distance * pixel_length),
        pixel_length,
        spreads: SPREADS,
    }
}
