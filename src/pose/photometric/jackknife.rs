//! The [jackknife](crate::pose::jackknife) of a photometric registration.

use nalgebra::Vector3;

use super::problem::PhotometricProblem;
use super::solver::Photometric;
use crate::error::Result;
use crate::pose::increment::{Frame, PoseMatrix, PoseVector};
use crate::pose::jackknife::{covariance, sectors};

/// Maximum number of points, evenly spread. Model errors do not average out over more points.
const MOST_POINTS: usize = 20_000;
/// Number of sectors of the jackknife. With fewer, each holds a larger share of the information, and the moves without
/// it are too long; set on random scenes (docs/lab/thresholds.md).
const SECTORS: usize = 12;
/// Number of Gauss-Newton steps that start from the final pose and leave out a sector; set on random scenes
/// (docs/lab/thresholds.md).
const STEPS: usize = 3;

impl Photometric {
    /// The covariance of the sectors at the end of the registration, whose points have been chosen.
    pub(super) fn jackknife(&mut self, problem: &PhotometricProblem<'_>, frame: &Frame) -> Result<PoseMatrix> {
        if self.points.len() <= MOST_POINTS {
            return Ok(self.leave_sectors_out(problem, frame));
        }
        let sample = self.evaluate_end(problem, MOST_POINTS)?;
        let covariance = self.leave_sectors_out(problem, &sample);
        self.evaluate_end(problem, self.options.most_points)?;
        Ok(covariance)
    }

    /// Refits the pose without each sector in turn.
    fn leave_sectors_out(&mut self, problem: &PhotometricProblem<'_>, frame: &Frame) -> PoseMatrix {
        let end = self.state;
        let point = |index| end.pose.apply(Vector3::from(problem.points.get(index).map(f64::from)));
        let sectors = sectors(self.points.indices().map(point), frame.centre, SECTORS);
        let weights = self.points.weights().to_vec();
        let mut moves = [PoseVector::zeros(); SECTORS];
        for (sector, moved) in moves.iter_mut().enumerate() {
            let kept = sectors.iter().zip(&weights).map(|(&other, &weight)| if other == sector { 0.0 } else { weight });
            self.points.reweigh(kept);
            *moved = self.refit(problem, frame);
            self.state = end;
        }
        self.points.reweigh(weights.into_iter());
        covariance(&moves)
    }

    /// Takes a few steps. Returns their sum.
    fn refit(&mut self, problem: &PhotometricProblem<'_>, frame: &Frame) -> PoseVector {
        let mut moved = PoseVector::zeros();
        for _ in 0..STEPS {
            let Ok(reduced) = self.reduce_near(problem, frame) else { break };
            let Some(step) = reduced.step(0.0, &problem.held()) else { break };
            self.state = self.state.stepped(frame, &step, problem.light.is_some());
            moved += step.pose;
        }
        moved
    }
}
