//! Covariance of a pose from local contrast: the sandwich over tiles (docs/method/uncertainty.md).

use super::equations::Reduced;
use super::objective::{Objective, State};
use super::problem::ContrastProblem;
use crate::pose::increment::{Frame, PoseMatrix, PoseVector, SCALE, TRANSLATION_Z, UNKNOWNS, fix_unknowns, inverse};
use crate::pose::sandwich::Scores;
use crate::pose::uncertainty::{Uncertainty, describe, weakest_of};
use crate::view::Size;

/// Side of the tiles of the depth map whose scores count as one observation, depth pixels: three sigmas of the local
/// means. Like these, it grows with the object. Scores of the silhouette are summed over tiles of the image with the
/// same side.
const TILE: f64 = 9.0;

/// The linearised problem whose covariance is computed.
pub(super) struct Linearised<'a> {
    pub problem: &'a ContrastProblem<'a>,
    pub objective: &'a Objective,
    pub reduced: &'a Reduced,
    pub frame: &'a Frame,
    pub state: &'a State,
}

impl Linearised<'_> {
    /// Sums of the scores of each tile: of the contrast on the depth map, and of the silhouette on the image.
    fn tiles(&self) -> [Vec<PoseVector>; 2] {
        let (samples, size) = (&self.objective.samples, self.problem.image.size);
        let tile = ((TILE * self.objective.unit()).ceil() as usize).div_ceil(samples.stride);
        let tiles = |size: Size, tile: usize| {
            (
                size.width.div_ceil(tile),
                vec![PoseVector::zeros(); size.width.div_ceil(tile) * size.height.div_ceil(tile)],
            )
        };
        let (across, mut contrast) = tiles(samples.grid, tile);
        self.objective.for_each_score(&self.state.light, |cell, residual, weight, rows| {
            let (column, row) = samples.grid.position(cell);
            let score = self.reduced.score(self.objective.shades(cell), residual, rows) * weight;
            contrast[row / tile * across + column / tile] += score;
        });
        let tile = tile * samples.stride;
        let (across, mut silhouette) = tiles(size, tile);
        let inside = |place: f64, length: usize| (place.round().max(0.0) as usize).min(length - 1) / tile;
        self.objective.for_each_silhouette(self.problem, self.frame, &self.state.pose, |place, row, off, weight| {
            let at = inside(place[1], size.height) * across + inside(place[0], size.width);
            silhouette[at].axpy(weight * off, row, 1.0);
        });
        [contrast, silhouette]
    }
}

/// The covariance from the linearised objective, zero for held unknowns. The silhouette contributes to the scores as
/// well as to the information, because it has errors just as the contrast has. Student's correction is omitted, because
/// the jackknife has one.
fn covariance(linearised: &Linearised<'_>, held: &[bool; UNKNOWNS]) -> PoseMatrix {
    let [contrast, silhouette] = linearised.tiles();
    let mut scores = Scores::of(contrast.iter());
    scores.add(silhouette.iter());
    let mut matrix = linearised.reduced.matrix;
    fix_unknowns(&mut matrix, held);
    scores.covariance(inverse(&matrix).as_ref(), 1.0, held)
}

/// The uncertainty of a pose.
pub struct PoseCovariance {
    /// One sigma of each number of the pose.
    pub uncertainty: Uncertainty,
    /// Covariance of the unknowns in this frame, zero for held ones.
    pub covariance: PoseMatrix,
    pub frame: Frame,
}

/// The uncertainty from the tiles and the given covariance of the sectors.
pub(super) fn described(linearised: &Linearised<'_>, by_sectors: PoseMatrix) -> PoseCovariance {
    let held = linearised.problem.held();
    let covariance = covariance(linearised, &held) + by_sectors;
    let frame = *linearised.frame;
    let fixed = [held[TRANSLATION_Z], held[SCALE]];
    let uncertainty = describe(&covariance, &frame, &linearised.state.pose, fixed, weakest_of(&covariance));
    PoseCovariance { uncertainty, covariance, frame }
}
