//! What leaving out each sector of the object in turn moves the pose by: errors that reach across tiles, such as albedo that varies
//! slowly, ambient shadow and normals that lean, fit a part of the object otherwise than the rest (docs/method.md, section 14).
//!
//! M. Quenouille: "Notes on bias in estimation", Biometrika 43, 1956. J. Tukey: "Bias and confidence in not-quite large samples", Annals of
//! Mathematical Statistics 29, 1958.

use nalgebra::Vector3;

use super::fit::Photometric;
use super::points::Sampling;
use super::problem::PhotometricProblem;
use super::weighting::final_robust_scale;
use crate::error::Result;
use crate::pose::increment::{Frame, PoseMatrix, PoseVector};
use crate::pose::similarity::Similarity;

/// Sectors of the object, equal in points: the fewest that tell the spread of six unknowns.
const SECTORS: usize = 6;
/// Points that take part at most, spread evenly: they are enough for errors of the model, which many points do not average.
const MOST_POINTS: usize = 20_000;
/// Steps without a sector, from the end.
const STEPS: usize = 5;
/// A step shorter than this, radians and object sizes, ends them: 0.02 degrees.
const SMALL_STEP: f64 = 3e-4;

impl Photometric {
    /// Covariance of the pose by the jackknife, zero where it cannot be told. The points that take part are others afterwards.
    pub(super) fn jackknife(&mut self, problem: &PhotometricProblem<'_>) -> Result<PoseMatrix> {
        let end = self.state;
        let frame = self.choose_points(problem, Sampling { level: 0, most: self.most_points.min(MOST_POINTS) })?;
        self.measure_noise(problem, 0);
        self.weigh(problem, final_robust_scale(self.noise.residuals));
        let sectors = sectors(problem, &end.pose, &frame, self.points.indices());
        let weights = self.points.weights().to_vec();
        let mut moves = [PoseVector::zeros(); SECTORS];
        for (sector, moved) in moves.iter_mut().enumerate() {
            let kept = sectors.iter().zip(&weights).map(|(&other, &weight)| if other == sector { 0.0 } else { weight });
            self.points.reweigh(kept);
            self.state = end;
            *moved = self.settle(problem, &frame);
        }
        self.points.reweigh(weights.into_iter());
        self.state = end;
        Ok(spread(&moves))
    }

    /// A few steps from the present state; their sum.
    fn settle(&mut self, problem: &PhotometricProblem<'_>, frame: &Frame) -> PoseVector {
        let mut moved = PoseVector::zeros();
        for _ in 0..STEPS {
            let Ok(mut reduced) = self.reduce_by_instruments(problem, frame) else { break };
            if let Some(sums) = self.near_terms(problem, 0, frame, &self.state.pose) {
                reduced.add(&sums);
            }
            let Some(step) = reduced.step(0.0, &problem.held()) else { break };
            self.state = self.state.stepped(frame, &step, problem.light.is_some());
            moved += step.pose;
            if step.pose.norm() < SMALL_STEP {
                break;
            }
        }
        moved
    }
}

/// The sector of each point: its angle about the middle, in the image.
fn sectors(
    problem: &PhotometricProblem<'_>,
    pose: &Similarity,
    frame: &Frame,
    points: impl Iterator<Item = usize>,
) -> Vec<usize> {
    let angle = |index: usize| {
        let arm = pose.apply(Vector3::from(problem.points.get(index).map(f64::from))) - frame.centre;
        arm.y.atan2(arm.x)
    };
    let angles: Vec<f64> = points.map(angle).collect();
    let mut order: Vec<usize> = (0..angles.len()).collect();
    order.sort_by(|&a, &b| angles[a].total_cmp(&angles[b]));
    let mut sectors = vec![0; angles.len()];
    for (place, point) in order.into_iter().enumerate() {
        sectors[point] = SECTORS * place / angles.len();
    }
    sectors
}

/// (n - 1) / n times the sum of squares about the mean.
fn spread(moves: &[PoseVector; SECTORS]) -> PoseMatrix {
    let count = SECTORS as f64;
    let mean = moves.iter().sum::<PoseVector>() / count;
    let mut spread = PoseMatrix::zeros();
    for moved in moves {
        let off = moved - mean;
        spread.ger((count - 1.0) / count, &off, &off, 1.0);
    }
    if spread.norm().is_finite() { spread } else { PoseMatrix::zeros() }
}
