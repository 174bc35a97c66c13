//! Annealing: rounds of damped Gauss-Newton, coarse to fine, whose robust scale shrinks to that of the noise.

use super::phase::{Descent, Phase};
use super::points::Sampling;
use super::problem::PhotometricProblem;
use super::solver::{Photometric, undetermined_light};
use super::weighting::final_robust_scale;
use crate::error::Result;
use crate::pose::descent::{Damping, Lowered};
use crate::pose::residuals::SHRINKING;

/// Maximum number of Gauss-Newton steps of a round, and of attempts to damp a step.
const MOST_STEPS: usize = 6;
const MOST_ATTEMPTS: usize = 8;
/// A round before the final robust scale ends with a step below this, in radians and object sizes, because the next
/// round moves the pose at least as far.
const SMALL_STEP: f64 = 1e-3;
/// A round at the final scale ends with a step below this, 0.002 degrees: less than [`FINE_SETTLED`].
const SMALL_FINE_STEP: f64 = 3e-5;
/// Rotation in degrees below which a round is the last of a coarse level.
const COARSE_SETTLED: f64 = 0.3;
/// Rotation in degrees below which a round at the final scale is the last one. Points that appear and disappear at the
/// occluding contour change the pose by more than that.
const FINE_SETTLED: f64 = 3e-3;
/// Largest number of rounds at the final scale. After these, only points that appear and disappear still change the pose.
const MOST_FINE_ROUNDS: usize = 4;

impl Photometric {
    /// Begins a round of annealing: chooses its points, their light and its robust scale.
    pub(super) fn begin_annealing(
        &mut self,
        problem: &PhotometricProblem<'_>,
        level: usize,
        fine_rounds: usize,
    ) -> Result<Phase> {
        self.rounds += 1;
        let frame = self.choose_points(problem, Sampling { level, most: self.options.annealed_points })?;
        self.fit_light(problem, level)?;
        self.measure_noise(problem, level);
        let target = final_robust_scale(self.noise.residuals);
        let tolerated = if self.options.annealing { SHRINKING * self.weighting.robust_scale } else { 0.0 };
        self.weigh(problem, target.max(tolerated));
        Ok(Phase::AnnealingStep(Descent {
            level,
            fine_rounds,
            frame,
            before: self.state.pose,
            at_noise: self.weighting.robust_scale <= target,
            damping: Damping::FIRST,
            objective: self.objective(problem, level, &frame, &self.state),
            steps: 0,
        }))
    }

    /// Takes a step of pose and light that lowers the objective.
    pub(super) fn descend(&mut self, problem: &PhotometricProblem<'_>, mut descent: Descent) -> Result<Phase> {
        let Descent { level, frame, .. } = descent;
        self.iterations += 1;
        descent.steps += 1;
        let reduced = self.evaluation(problem, level, &self.state).reduced_system(&frame);
        let mut reduced = reduced.ok_or_else(undetermined_light)?;
        if let Some(sums) = self.near_terms(problem, level, &frame, &self.state.pose) {
            reduced.add(&sums);
        }
        let lowered = descent.damping.lower(MOST_ATTEMPTS, descent.objective, |damping| {
            let step = reduced.step(damping, &problem.held())?;
            let state = self.state.stepped(&frame, &step, problem.light.is_some());
            let objective = self.objective(problem, level, &frame, &state);
            Some(Lowered { state, objective, size: step.pose.norm() })
        });
        let size = lowered.as_ref().map_or(0.0, |lowered| lowered.size);
        if let Some(Lowered { state, objective, .. }) = lowered {
            (self.state, descent.objective) = (state, objective);
        }
        let small = if descent.at_noise { SMALL_FINE_STEP } else { SMALL_STEP };
        let ends = size < small || descent.steps >= MOST_STEPS;
        Ok(if ends { self.after_annealing_round(&descent) } else { Phase::AnnealingStep(descent) })
    }

    /// The phase after a round of annealing.
    fn after_annealing_round(&mut self, &Descent { level, fine_rounds, before, at_noise, .. }: &Descent) -> Phase {
        let change = before.degrees_to(&self.state.pose);
        match level {
            0 if at_noise && (change < FINE_SETTLED || fine_rounds >= MOST_FINE_ROUNDS) => {
                self.annealed = self.state;
                self.thinned = self.points.are_sampled() && self.options.annealed_points < self.options.most_points;
                Phase::InstrumentalRound { round: 0 }
            }
            0 => Phase::AnnealingRound { level, fine_rounds: fine_rounds + usize::from(at_noise) },
            _ if change < COARSE_SETTLED || (at_noise && fine_rounds >= MOST_FINE_ROUNDS) => {
                Phase::AnnealingRound { level: level - 1, fine_rounds: 0 }
            }
            _ => Phase::AnnealingRound { level, fine_rounds: fine_rounds + usize::from(at_noise) },
        }
    }
}
