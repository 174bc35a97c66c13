//! Registration of both surfaces as a stage of the loop: ICP, then the consensus of its pairs (Eq. 12 to 16).

use nalgebra::Vector3;

use super::light::Inputs;
use crate::error::Result;
use crate::estimator::gauge;
use crate::estimator::objective::{self, Trial};
use crate::estimator::solution::Solution;
use crate::pose::{Icp, IcpOptions, IcpProblem, RansacOptions, Similarity, Uncertainty, ransac};

/// Largest distance of ICP's pairs at first, image pixels, after the first iteration.
const FIRST_DISTANCE: f64 = 8.0;
/// Largest distance of ICP's pairs in the end, image pixels: twice the paper's threshold, weighted robustly.
const FINAL_DISTANCE: f64 = 2.0;
/// Pairs within this distance agree with a pose, image pixels: the paper's threshold.
const CONSENSUS_DISTANCE: f64 = 1.0;
/// Largest number of pairs in the consensus, evenly spread.
const MOST_CONSENSUS_PAIRS: usize = 2000;

/// Result of matching both surfaces.
pub struct Matched {
    pub pose: Similarity,
    /// Whether the pose is better than its start; otherwise it is the start.
    pub improved: bool,
    pub uncertainty: Uncertainty,
}

/// Matches both surfaces; owns its memory.
pub struct SurfaceRegistration {
    icp: Icp,
    /// Points of ICP's pairs: depth view, image.
    paired_points: [Vec<Vector3<f64>>; 2],
}

impl SurfaceRegistration {
    pub fn new() -> Self {
        Self { icp: Icp::new(), paired_points: [Vec::new(), Vec::new()] }
    }

    /// ICP, then the consensus of its pairs: takes the pose with the lower objective over the same points.
    pub fn register(&mut self, inputs: Inputs<'_>, solution: &Solution) -> Result<Matched> {
        let pair = inputs.pair;
        let (start, pixel) = (solution.pose, gauge::pixel_length(&pair.image, solution));
        let problem = IcpProblem {
            depth_points: &solution.depth.points,
            depth_normals: &solution.depth.normals,
            image_points: &solution.image.points,
            image_normals: &solution.image.normals,
            image_size: pair.image.size,
            start,
        };
        let scale_is_held = pair.options.scale.is_some() && pair.image.camera.is_orthographic();
        let options = IcpOptions {
            scale_is_held,
            first_distance: (!inputs.is_first).then_some(FIRST_DISTANCE * pixel),
            final_distance: FINAL_DISTANCE * pixel,
            ..IcpOptions::default()
        };
        let found = self.icp.register(&problem, &options)?;
        let mut uncertainty = found.information.uncertainty(found.rms, &found.pose, &pair.image.camera);
        // Behind a pinhole, the matching frees a scale that belongs to the surface, not to the pose.
        uncertainty.scale = uncertainty.scale.filter(|_| gauge::held_scale(pair).is_none());
        let [depth_points, image_points] = &mut self.paired_points;
        self.icp.paired_points(&problem, depth_points, image_points, MOST_CONSENSUS_PAIRS);
        let consensus = RansacOptions {
            threshold: CONSENSUS_DISTANCE * pixel,
            scale: scale_is_held.then_some(start.scale),
            seed: pair.options.seed,
            ..RansacOptions::default()
        };
        // If the pairs agree on nothing, ICP's pose stays.
        let agreed = ransac(depth_points, image_points, &consensus).map_or(found.pose, |report| report.pose);
        let (pose, improved) = better(inputs, solution, [&agreed, &found.pose]);
        let improved = improved && !found.information.is_degenerate();
        Ok(Matched { pose: if improved { pose } else { start }, improved, uncertainty })
    }
}

/// The better of two poses, and whether it is better than the solution's. All are compared over the points visible in
/// the solution.
fn better(
    Inputs { pair, colours, correspondences, .. }: Inputs<'_>,
    solution: &Solution,
    [agreed, found]: [&Similarity; 2],
) -> (Similarity, bool) {
    let evaluated: Vec<u32> = objective::evaluation_points(pair, correspondences).collect();
    let light = solution.light.total();
    let trial = Trial::of(pair, colours, solution, &light);
    let objective = |pose: &Similarity| objective::evaluate(pair, &evaluated, Trial { pose, ..trial }).total();
    let pose = if objective(agreed) < objective(found) { agreed } else { found };
    let start = &solution.pose;
    (*pose, !objective::worsens(objective(start), objective(pose), start.degrees_to(pose)))
}
