//! The rounds of a photometric registration: annealing, then instrumental variables.

mod annealing;
mod instruments;

use annealing::{Descent, SCALE_SHRINKING};

use super::covariance::{Noise, Tiles};
use super::equations::ReducedSystem;
use super::evaluation::Evaluation;
use super::near::{NearTerms, NearWeights};
use super::points::{Sampling, VisiblePoints};
use super::problem::{
    COARSEST, COARSEST_NEAR, PhotometricOptions, PhotometricProblem, PhotometricReport, PhotometricTermination,
};
use super::relief::Relief;
use super::residual::{ColourModel, Samples};
use super::state::State;
use super::weighting::{Weighting, final_robust_scale, prior_weight};
use crate::error::{Error, ErrorKind, Result};
use crate::pose::increment::{Frame, PoseMatrix, PoseVector, SCALE, TRANSLATION_Z, clear_unknowns};
use crate::pose::similarity::Similarity;
use crate::pose::spline_image::SplineImage;
use crate::pose::sums::Sums;
use crate::pose::uncertainty::{describe, weakest_of};
use crate::view::Size;

/// Gaussian blur of each level's image, pixels; a level takes every 2^level-th point.
const BLURS: [f64; COARSEST_NEAR + 1] = [0.0, 1.5, 3.0, 6.0];
/// Coarsest level under an unknown light: a light that follows explains strongly blurred colours in any pose. From 20
/// degrees off level 1 always converged on Mozart at 64x64, level 2 in a third of the cases; a known light converges
/// from 30 by level 2.
const COARSEST_UNKNOWN: usize = 1;
/// Blur of the image whose gradients are the instrumental variables, pixels: 0.7 to 1.5 serve alike.
pub(super) const INSTRUMENT_BLUR: f64 = 1.0;
/// The first robust scale over that of the residuals at the start.
const FIRST_SCALE: f64 = 2.0;
/// Noise of log S that is always allowed for: half a percent of a good 8-bit image's rounding, log units.
const LEAST_NOISE: f64 = 0.002;
/// Reweightings of the light at the start of a round.
const LIGHT_ROUNDS: usize = 6;
/// Fewest points: two for each unknown of the pose.
const FEWEST_POINTS: usize = 14;

/// What the next piece of work is.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// The beginning of a round of annealing: its visible points, their light, its robust scale.
    AnnealingRound {
        level: usize,
        fine_rounds: usize,
    },
    /// A Gauss-Newton step of such a round.
    AnnealingStep(Descent),
    /// The beginning of a round with instrumental variables.
    InstrumentalRound {
        round: usize,
    },
    /// A step of such a round.
    InstrumentalStep {
        round: usize,
        frame: Frame,
        steps: usize,
        /// Length of the step before.
        last: f64,
    },
    Done(PhotometricTermination),
}

/// What an initial pose brings in.
struct Near {
    terms: NearTerms,
    relief: Relief,
}

/// Registers one depth view to one image again and again; owns all memory.
pub struct Photometric {
    sizes: [Size; 2],
    /// The image sharp and blurred, down to the coarsest level that is used.
    levels: Vec<SplineImage>,
    /// The image whose gradients are the instrumental variables.
    instruments: SplineImage,
    points: VisiblePoints,
    /// What an initial pose brings in, once there is one.
    near: Option<Box<Near>>,
    tiles: Tiles,
    /// log S at the points while the pose stays.
    samples: Vec<Samples>,
    magnitudes: Vec<f32>,
    state: State,
    /// The state at the end of the annealing.
    annealed: State,
    noise: Noise,
    weighting: Weighting,
    phase: Phase,
    rounds: usize,
    most_rounds: usize,
    most_points: usize,
    annealed_points: usize,
    annealing: bool,
    points_stay: bool,
    iterations: usize,
    /// Whether the rounds with instrumental variables are those of the annealing's points, of which there are more.
    thinned: bool,
    /// Steps, for each unknown, that change nothing that matters; where there are so many points.
    settled_step: Option<PoseVector>,
}

impl Photometric {
    /// Splines of the image's levels, as many as a light that is known or not asks for, and memory for both views.
    #[must_use]
    pub fn new(problem: &PhotometricProblem<'_>) -> Self {
        let light = problem.prior.mean();
        let state = State { pose: Similarity::identity(), light, exposure: 0.0 };
        let sharp = SplineImage::new(problem.image, BLURS[0]);
        let instruments = sharp.blurred(problem.image, INSTRUMENT_BLUR);
        let mut levels = vec![sharp];
        levels.extend((1..=coarsest(problem)).map(|level| instruments.blurred(problem.image, BLURS[level])));
        let points = VisiblePoints::new(problem);
        Self {
            sizes: [problem.image.size, problem.depth_size],
            instruments,
            levels,
            samples: Vec::new(),
            magnitudes: Vec::with_capacity(points.capacity()),
            points,
            near: None,
            tiles: Tiles::new(problem.depth_size),
            state,
            annealed: state,
            noise: Noise {
                residuals: f64::INFINITY,
                image: problem.image.log_noise().max(LEAST_NOISE),
                depth: problem.depth_noise.sigma,
            },
            weighting: Weighting::FIRST,
            phase: Phase::Done(PhotometricTermination::MostRounds),
            rounds: 0,
            most_rounds: 0,
            most_points: usize::MAX,
            annealed_points: usize::MAX,
            annealing: true,
            points_stay: false,
            iterations: 0,
            thinned: false,
            settled_step: None,
        }
    }

    /// The pose from `start`: [`begin`](Self::begin), [`step`](Self::step) to the end, [`report`](Self::report).
    ///
    /// # Errors
    /// [`ErrorKind::Size`] where lengths disagree, [`ErrorKind::Range`] for a start that is no similarity,
    /// [`ErrorKind::Degenerate`] where fewer than 14 points are visible or they determine nothing.
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

    /// Starts anew.
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
        let level = options.first_level.min(coarsest(problem)).min(self.levels.len() - 1);
        // From the image's own brightness, so that a change of exposure changes nothing that follows.
        let brightness = problem.image.log_mean();
        self.state = match problem.light {
            Some(light) => State { pose: *start, light: *light, exposure: brightness },
            None => State { pose: *start, light: problem.prior.mean().exposed(brightness), exposure: 0.0 },
        };
        (self.phase, self.rounds, self.iterations) = (Phase::AnnealingRound { level, fine_rounds: 0 }, 0, 0);
        self.most_rounds = options.most_rounds.max(1);
        (self.most_points, self.annealing) = (options.most_points, options.annealing);
        self.points_stay = options.points_stay;
        self.annealed_points = options.annealed_points.min(options.most_points);
        (self.thinned, self.settled_step) = (false, None);
        self.choose_points(problem, Sampling { level, most: self.annealed_points })?;
        self.weighting = Weighting::FIRST;
        self.noise.residuals = f64::INFINITY;
        self.fit_light(problem, level)?;
        self.measure_noise(problem, level);
        let tolerance = if options.annealing { FIRST_SCALE / SCALE_SHRINKING } else { 1.0 };
        self.weigh(problem, tolerance * final_robust_scale(self.noise.residuals));
        Ok(())
    }

    /// A piece of a round, one Gauss-Newton step at most, so that a page stays alive; whether it was the last.
    ///
    /// # Errors
    /// [`ErrorKind::Degenerate`] where too few points are visible or they determine nothing.
    pub fn step(&mut self, problem: &PhotometricProblem<'_>) -> Result<bool> {
        self.phase = match self.phase {
            Phase::AnnealingStep(descent) => self.descend(problem, descent)?,
            Phase::InstrumentalStep { round, frame, steps, last } => {
                self.step_by_instruments(problem, round, &frame, steps, last)?
            }
            Phase::Done(_) => self.phase,
            _ if self.rounds >= self.most_rounds => Phase::Done(PhotometricTermination::MostRounds),
            Phase::AnnealingRound { level, fine_rounds } => self.begin_annealing(problem, level, fine_rounds)?,
            Phase::InstrumentalRound { round } => self.begin_instrumental(problem, round)?,
        };
        Ok(self.is_done())
    }

    /// Whether there is nothing left to [`step`](Self::step).
    #[must_use]
    pub const fn is_done(&self) -> bool {
        matches!(self.phase, Phase::Done(_))
    }

    /// Depth pixels of the points that take part at present.
    pub fn points(&self) -> impl Iterator<Item = usize> {
        self.points.indices()
    }

    /// The present pose.
    #[must_use]
    pub const fn pose(&self) -> &Similarity {
        &self.state.pose
    }

    /// What was found so far.
    ///
    /// # Errors
    /// [`ErrorKind::Degenerate`] where the visible points determine nothing.
    pub fn report(&mut self, problem: &PhotometricProblem<'_>) -> Result<PhotometricReport> {
        let frame = self.choose_points(problem, Sampling { level: 0, most: self.most_points })?;
        self.measure_noise(problem, 0);
        self.weigh(problem, final_robust_scale(self.noise.residuals));
        let reduced = self.reduce_by_instruments(problem, &frame)?;
        let covariance = self.covariance(problem, &frame, &reduced);
        let held = problem.held();
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
            structure: self.tiles.structure(),
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

    /// Chooses the visible points of a round.
    fn choose_points(&mut self, problem: &PhotometricProblem<'_>, sampling: Sampling) -> Result<Frame> {
        if !self.points_stay {
            self.points.update(problem, &self.state.pose, &self.levels[0], sampling);
        }
        if self.points.len() < FEWEST_POINTS {
            return Err(degenerate("the image shows too few of the depth points").value(self.points.len() as f64));
        }
        Ok(self.points.frame(problem, &self.state.pose))
    }

    /// The light alone, reweighted.
    fn fit_light(&mut self, problem: &PhotometricProblem<'_>, level: usize) -> Result<()> {
        let mut samples = std::mem::take(&mut self.samples);
        self.evaluation(problem, level, &self.state).sample(&mut samples);
        for _ in 0..LIGHT_ROUNDS {
            let equations = self.evaluation(problem, level, &self.state).light_equations(&samples);
            let step = equations.step().ok_or_else(undetermined_light)?;
            self.state = self.state.relit(&step, problem.light.is_some());
            self.fit_relief(problem, level, &samples);
        }
        self.samples = samples;
        Ok(())
    }

    /// Memory for what an initial pose brings in, and levels of the image that are as coarse as it allows.
    fn prepare_near(&mut self, problem: &PhotometricProblem<'_>) {
        if problem.near.is_none() {
            return;
        }
        for &blur in &BLURS[self.levels.len().min(coarsest(problem) + 1)..=coarsest(problem)] {
            self.levels.push(self.levels[0].blurred(problem.image, blur));
        }
        match &mut self.near {
            Some(near) => near.relief.clear(),
            none => *none = Some(Box::new(Near { terms: NearTerms::new(problem), relief: Relief::new(problem) })),
        }
    }

    /// The albedo that goes with the relief, around an initial pose and once the noise is known.
    fn fit_relief(&mut self, problem: &PhotometricProblem<'_>, level: usize, samples: &[Samples]) {
        if problem.near.is_none() || !self.noise.residuals.is_finite() {
            return;
        }
        let sums = self.evaluation(problem, level, &self.state).relief_sums(samples);
        if let Some(near) = &mut self.near {
            near.relief.step(sums, self.noise.residuals);
        }
    }

    /// The noise of the residuals.
    fn measure_noise(&mut self, problem: &PhotometricProblem<'_>, level: usize) {
        let mut magnitudes = std::mem::take(&mut self.magnitudes);
        let noise = self.evaluation(problem, level, &self.state).noise(&mut magnitudes);
        self.noise.residuals = noise.max(LEAST_NOISE);
        self.magnitudes = magnitudes;
    }

    /// Takes a robust scale, and the prior's weight at the present light.
    fn weigh(&mut self, problem: &PhotometricProblem<'_>, robust_scale: f64) {
        let prior = prior_weight(problem, &self.state.light, self.noise.residuals);
        self.weighting = Weighting { robust_scale, prior };
    }

    /// The terms of the pose alone, where there are any.
    fn near_terms(
        &self,
        problem: &PhotometricProblem<'_>,
        level: usize,
        frame: &Frame,
        pose: &Similarity,
    ) -> Option<Sums> {
        let (prior, near) = problem.near.as_ref().zip(self.near.as_ref())?;
        let (points, robust_scale) = (self.points.weight(), self.weighting.robust_scale);
        let weights = NearWeights { points, robust_scale, noise: self.noise.residuals, level };
        Some(near.terms.sums(problem, prior, pose, frame, weights))
    }

    /// The objective of a state.
    fn objective(&self, problem: &PhotometricProblem<'_>, level: usize, frame: &Frame, state: &State) -> f64 {
        let near_terms = self.near_terms(problem, level, frame, &state.pose).map_or(0.0, |sums| sums.cost);
        self.evaluation(problem, level, state).objective() + near_terms
    }

    /// The points at one level of the image under a state, derivatives for least squares.
    fn evaluation<'a>(&'a self, problem: &'a PhotometricProblem<'a>, level: usize, state: &'a State) -> Evaluation<'a> {
        let model = ColourModel::new(&self.levels[level], &problem.image.camera, &state.exposed_light());
        let relief = self.near.as_ref().filter(|_| problem.near.is_some()).map(|near| &near.relief);
        Evaluation { problem, points: &self.points, relief, model, state, weighting: self.weighting }
    }

    /// The same on the sharp image at the present state, with instrumental variables.
    fn evaluation_by_instruments<'a>(&'a self, problem: &'a PhotometricProblem<'a>) -> Evaluation<'a> {
        let evaluation = self.evaluation(problem, 0, &self.state);
        Evaluation { model: evaluation.model.with_instruments(&self.instruments), ..evaluation }
    }

    fn reduce_by_instruments(&self, problem: &PhotometricProblem<'_>, frame: &Frame) -> Result<ReducedSystem> {
        self.evaluation_by_instruments(problem).unbiased_system(frame).ok_or_else(undetermined_light)
    }

    fn covariance(&mut self, problem: &PhotometricProblem<'_>, frame: &Frame, reduced: &ReducedSystem) -> PoseMatrix {
        let mut tiles = std::mem::take(&mut self.tiles);
        let covariance = tiles.covariance(&self.evaluation_by_instruments(problem), frame, reduced, self.noise);
        self.tiles = tiles;
        covariance
    }
}

/// The coarsest level that serves a problem.
const fn coarsest(problem: &PhotometricProblem<'_>) -> usize {
    match (problem.near, problem.light) {
        (Some(_), _) => COARSEST_NEAR,
        (None, Some(_)) => COARSEST,
        (None, None) => COARSEST_UNKNOWN,
    }
}

fn undetermined_light() -> Error {
    degenerate("the visible points do not determine the light")
}

fn degenerate(message: &'static str) -> Error {
    Error::new(ErrorKind::Degenerate, "registration", message)
}
