//! A photometric registration from its initial pose to its report: annealing, then instrumental variables.

use super::phase::Phase;
use super::points::Sampling;
use super::problem::{PhotometricOptions, PhotometricProblem, PhotometricReport, PhotometricTermination};
pub use super::solver::Photometric;
use super::solver::coarsest;
use super::state::State;
use super::weighting::{Weighting, final_robust_scale};
use crate::error::Result;
use crate::pose::increment::{PoseMatrix, SCALE, TRANSLATION_Z, clear_unknowns};
use crate::pose::residuals::{FIRST_SCALE, SHRINKING};
use crate::pose::similarity::Similarity;
use crate::pose::uncertainty::{describe, weakest_of};

impl Photometric {
    /// The pose from `start`: [`begin`](Self::begin), [`step`](Self::step) to the end, [`report`](Self::report).
    ///
    /// # Errors
    /// [`Size`](crate::ErrorKind::Size) if lengths disagree, [`Range`](crate::ErrorKind::Range) if the initial pose is
    /// invalid, [`Degenerate`](crate::ErrorKind::Degenerate) if fewer than 14 points are visible or they do not
    /// determine the pose.
    pub fn register(
        &mut self,
        problem: &PhotometricProblem<'_>,
        start: &Similarity,
        options: &PhotometricOptions,
    ) -> Result<PhotometricReport> {
        self.begin(problem, start, options)?;
        while !self.step(problem)? {}
        self.report(problem)
    }

    /// Begins a registration.
    ///
    /// # Errors
    /// Those of [`register`](Self::register).
    pub fn begin(
        &mut self,
        problem: &PhotometricProblem<'_>,
        start: &Similarity,
        options: &PhotometricOptions,
    ) -> Result<()> {
        problem.check(self.sizes)?;
        start.validate("start")?;
        self.prepare_near(problem);
        self.pose_prior_weight = None;
        let level = options.first_level.min(coarsest(problem)).min(self.levels.len() - 1);
        // Starts from the image's own brightness, so that a change of exposure has no effect on the rest.
        let brightness = problem.image.log_mean();
        self.state = match problem.light {
            Some(light) => State { pose: *start, light: *light, exposure: brightness },
            None => State { pose: *start, light: problem.prior.mean().exposed(brightness), exposure: 0.0 },
        };
        (self.phase, self.rounds, self.iterations) = (Phase::AnnealingRound { level, fine_rounds: 0 }, 0, 0);
        self.options = PhotometricOptions {
            most_rounds: options.most_rounds.max(1),
            annealed_points: options.annealed_points.min(options.most_points),
            ..*options
        };
        (self.thinned, self.settled_step) = (false, None);
        self.choose_points(problem, Sampling { level, most: self.options.annealed_points })?;
        self.weighting = Weighting::FIRST;
        self.noise.residuals = f64::INFINITY;
        self.fit_light(problem, level)?;
        self.measure_noise(problem, level);
        let tolerance = if options.annealing { FIRST_SCALE / SHRINKING } else { 1.0 };
        self.weigh(problem, tolerance * final_robust_scale(self.noise.residuals));
        Ok(())
    }

    /// Runs a part of a round, at most one Gauss-Newton step, so that a page stays responsive. Returns whether it was
    /// the last.
    ///
    /// # Errors
    /// [`Degenerate`](crate::ErrorKind::Degenerate) if too few points are visible or they do not determine the pose.
    pub fn step(&mut self, problem: &PhotometricProblem<'_>) -> Result<bool> {
        self.phase = match self.phase {
            Phase::AnnealingStep(descent) => self.descend(problem, descent)?,
            Phase::InstrumentalStep { round, frame, steps, last } => {
                self.step_by_instruments(problem, round, &frame, steps, last)?
            }
            Phase::Done(_) => self.phase,
            _ if self.rounds >= self.options.most_rounds => Phase::Done(PhotometricTermination::MostRounds),
            Phase::AnnealingRound { level, fine_rounds } => self.begin_annealing(problem, level, fine_rounds)?,
            Phase::InstrumentalRound { round } => self.begin_instrumental(problem, round)?,
        };
        Ok(self.is_done())
    }

    /// Whether nothing is left to [`step`](Self::step).
    #[must_use]
    pub const fn is_done(&self) -> bool {
        matches!(self.phase, Phase::Done(_))
    }

    /// The result of a registration of this problem, from any initial pose, with the covariance that
    /// [`PhotometricOptions::jackknife`] adds.
    ///
    /// # Errors
    /// Those of [`report`](Self::report).
    pub fn with_jackknife(
        &mut self,
        problem: &PhotometricProblem<'_>,
        found: &PhotometricReport,
    ) -> Result<PhotometricReport> {
        self.state = State { pose: found.pose, light: found.light, exposure: found.exposure };
        (self.phase, self.iterations) = (Phase::Done(found.termination), found.iterations);
        (self.options, self.pose_prior_weight) = (PhotometricOptions::default(), None);
        self.report(problem)
    }

    /// The result so far.
    ///
    /// # Errors
    /// [`Degenerate`](crate::ErrorKind::Degenerate) if the visible points do not determine the pose.
    pub fn report(&mut self, problem: &PhotometricProblem<'_>) -> Result<PhotometricReport> {
        let frame = self.evaluate_end(problem, self.options.most_points)?;
        if self.options.jackknife && self.pose_prior_weight.is_none() {
            self.weigh_near(problem, &frame)?;
        }
        let by_sectors = if self.options.jackknife { self.jackknife(problem, &frame)? } else { PoseMatrix::zeros() };
        let reduced = self.reduce_by_instruments(problem, &frame)?;
        let held = problem.held();
        let mut covariance = self.covariance(problem, &frame, &reduced) + by_sectors;
        // The prior may keep the pose from the optimum of the residuals. That distance also counts as an error.
        if let Some(step) = problem.near.and_then(|_| reduced.step(0.0, &held)) {
            covariance.ger(1.0, &step.pose, &step.pose, 1.0);
        }
        let mut information =
            0.5 * (reduced.matrix + reduced.matrix.transpose()) / (self.noise.residuals * self.noise.residuals);
        clear_unknowns(&mut information, &held);
        let weakest = weakest_of(&covariance);
        let evaluation = self.evaluation(problem, 0, &self.state);
        let largest = self.weighting.robust_scale * self.weighting.robust_scale * self.points.weight();
        Ok(PhotometricReport {
            pose: self.state.pose,
            light: self.state.light,
            exposure: self.state.exposure,
            objective: evaluation.data_term() / largest,
            noise: self.noise.residuals,
            spatial_covariance: self.tiles.spatial_covariance(),
            visible: self.points.len(),
            sampled: self.points.are_sampled(),
            inliers: evaluation.inlier_share(),
            iterations: self.iterations,
            termination: match self.phase {
                Phase::Done(termination) => termination,
                _ => PhotometricTermination::MostRounds,
            },
            information,
            covariance,
            uncertainty: describe(&covariance, &frame, &self.state.pose, [held[TRANSLATION_Z], held[SCALE]], weakest),
        })
    }
}
