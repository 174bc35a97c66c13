//! Rounds with instrumental variables: sum w Z^T r = 0 instead of sum w J^T r = 0, because the gradients J of a noisy
//! image are noisy as well (docs/method/registration.md).

use super::phase::Phase;
use super::points::Sampling;
use super::problem::{PhotometricProblem, PhotometricTermination};
use super::solver::Photometric;
use super::state::State;
use crate::error::Result;
use crate::pose::increment::Frame;

/// A step below this, in radians and object sizes, is negligible: 1e-5 degrees.
const SETTLED_STEP: f64 = 1e-7;
/// Maximum number of rounds with instrumental variables. The first chooses the visible points; the others keep them.
const INSTRUMENTAL_ROUNDS: usize = 3;
const MOST_INSTRUMENTAL_STEPS: usize = 12;
/// The instrumental rounds end when no unknown moves by more than this share of its sigma. Steps halve, so about as
/// much error remains. If there are more points than annealing needs, the rounds run first on the points of the
/// annealing and then on all of them.
const SETTLED_SIGMAS: f64 = 0.02;
/// The instrumental rounds are undone if they raise the objective by more than this share, because they should only trade noise.
/// Least squares favours positions between pixels, where a cubic spline leaves 0.572 of the variance of white noise (0.756 along either
/// axis). The rounds may give up this gain, but no more.
const LARGEST_RISE: f64 = 1.0 / 0.572 - 1.0;

impl Photometric {
    /// Begins a round of sum w Z^T r = 0; the first round chooses the visible points.
    pub(super) fn begin_instrumental(&mut self, problem: &PhotometricProblem<'_>, round: usize) -> Result<Phase> {
        self.rounds += 1;
        let frame = match round {
            0 if !self.thinned => self.choose_points(problem, Sampling { level: 0, most: self.options.most_points })?,
            _ => self.points.frame(problem, &self.state.pose),
        };
        self.weigh_near(problem, &frame)?;
        if self.thinned {
            let reduced = self.reduce_by_instruments(problem, &frame)?;
            let variances = self.covariance(problem, &frame, &reduced).diagonal();
            self.settled_step = Some(variances.map(|variance| SETTLED_SIGMAS * variance.sqrt()));
        }
        Ok(Phase::InstrumentalStep { round, frame, steps: 0, last: f64::INFINITY })
    }

    /// Takes a step of such a round. The step is not damped, because there is no objective to lower. Steps of the first
    /// round may grow. Later rounds reject a step that is longer than the previous one, because the solution may be an unstable fixed point
    /// of these steps, from which rounding errors grow by a third in each step.
    pub(super) fn step_by_instruments(
        &mut self,
        problem: &PhotometricProblem<'_>,
        round: usize,
        frame: &Frame,
        steps: usize,
        last: f64,
    ) -> Result<Phase> {
        self.iterations += 1;
        let reduced = self.reduce_near(problem, frame)?;
        let mut settled = true;
        if let Some(step) = reduced.step(0.0, &problem.held()).filter(|step| round == 0 || step.pose.norm() <= last) {
            self.state = self.state.stepped(frame, &step, problem.light.is_some());
            settled = match &self.settled_step {
                Some(least) => step.pose.iter().zip(least).all(|(step, least)| step.abs() <= *least),
                None => step.pose.norm() < SETTLED_STEP,
            };
            if !settled && steps + 1 < MOST_INSTRUMENTAL_STEPS {
                return Ok(Phase::InstrumentalStep { round, frame: *frame, steps: steps + 1, last: step.pose.norm() });
            }
        }
        let objective = |state: &State| self.evaluation(problem, 0, state).objective();
        let rise = objective(&self.state) / objective(&self.annealed);
        if rise.is_nan() || rise > 1.0 + LARGEST_RISE {
            self.state = self.annealed;
            return Ok(Phase::Done(PhotometricTermination::Annealed));
        }
        if std::mem::take(&mut self.thinned) {
            return Ok(Phase::InstrumentalRound { round });
        }
        let last = round + 1 >= INSTRUMENTAL_ROUNDS || (settled && (round > 0 || self.settled_step.is_some()));
        Ok(if last {
            Phase::Done(PhotometricTermination::Settled)
        } else {
            Phase::InstrumentalRound { round: round + 1 }
        })
    }
}
