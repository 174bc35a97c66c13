//! The [jackknife](crate::pose::jackknife) of a registration by local contrast.

use super::equations::Lights;
use super::objective::State;
use super::problem::ContrastProblem;
use super::registration::ContrastRegistration;
use crate::pose::increment::{PoseMatrix, PoseVector};
use crate::pose::jackknife::{covariance, sectors};
use crate::pose::similarity::Similarity;

/// Number of sectors of the jackknife.
const SECTORS: usize = 6;
/// Number of steps from the final pose, for each sector that is left out. It is larger than for photometric
/// registration, because the local means converge slowly.
const STEPS: usize = 8;
/// Factor on the weight of samples that are left out. A sample surrounded by weights of zero would have no local mean.
const LEFT_OUT: f32 = 1e-4;

impl ContrastRegistration {
    /// The covariance of a pose from its sectors.
    pub(super) fn jackknife(&mut self, problem: &ContrastProblem<'_>, pose: &Similarity) -> PoseMatrix {
        let samples = &self.objective.samples;
        let points = samples.list.iter().map(|sample| pose.apply(sample.point));
        let sectors = sectors(points, pose.apply(samples.centre), SECTORS);
        let weights = samples.weight.clone();
        let mut moves = [PoseVector::zeros(); SECTORS];
        for (sector, moved) in moves.iter_mut().enumerate() {
            let samples = &mut self.objective.samples;
            samples.weight.copy_from_slice(&weights);
            for (sample, _) in samples.list.iter().zip(&sectors).filter(|(_, other)| **other == sector) {
                samples.weight[sample.cell] *= LEFT_OUT;
            }
            let mut state = State { pose: *pose, light: Lights::default() };
            for _ in 0..STEPS {
                let Some(step) = self.step_by_instruments(problem, &mut state) else { break };
                *moved += step;
            }
        }
        self.objective.samples.weight.copy_from_slice(&weights);
        covariance(&moves)
    }
}
