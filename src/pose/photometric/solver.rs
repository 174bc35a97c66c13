//! The state of a photometric registration, and the operations that its rounds share.

use super::covariance::{Noise, Tiles};
use super::equations::ReducedSystem;
use super::evaluation::Evaluation;
use super::near::{MaskAndPrior, MaskAndPriorWeights};
use super::phase::Phase;
use super::points::{Sampling, VisiblePoints};
use super::problem::{COARSEST, COARSEST_NEAR, PhotometricOptions, PhotometricProblem, PhotometricTermination};
use super::relief::Relief;
use super::residual::{ColourModel, Samples};
use super::state::State;
use super::weighting::{Weighting, final_robust_scale, prior_weight};
use crate::error::{Error, ErrorKind, Result};
use crate::pose::increment::{Frame, PoseMatrix, PoseVector, product};
use crate::pose::residuals::LEAST_NOISE;
use crate::pose::similarity::Similarity;
use crate::pose::spline_image::SplineImage;
use crate::pose::sums::Sums;
use crate::view::Size;

/// Gaussian blur of each level's image, pixels; a level takes every 2^level-th point.
const BLURS: [f64; COARSEST_NEAR + 1] = [0.0, 1.5, 3.0, 6.0];
/// Coarsest level under an unknown light. A light that follows the pose fits strongly blurred colours under any pose
/// (docs/lab/thresholds.md).
const COARSEST_UNKNOWN: usize = 1;
/// Blur of the image whose gradients are the instrumental variables, pixels (docs/lab/thresholds.md).
pub(super) const INSTRUMENT_BLUR: f64 = 1.0;
/// Number of reweighted fits of the light at the start of a round.
const LIGHT_ROUNDS: usize = 6;
/// Minimum number of points: two for each unknown of the pose.
const FEWEST_POINTS: usize = 14;

/// Terms and albedo for a problem with an initial pose.
struct HeldNear {
    terms: MaskAndPrior,
    relief: Relief,
}

/// Registers one depth view to one image repeatedly; owns all memory.
pub struct Photometric {
    pub(super) sizes: [Size; 2],
    /// The image sharp and blurred, down to the coarsest level in use.
    pub(super) levels: Vec<SplineImage>,
    /// The image whose gradients are the instrumental variables.
    instruments: SplineImage,
    pub(super) points: VisiblePoints,
    /// M C, the weight of the prior about an initial pose at the end of a registration (see `near`).
    pub(super) pose_prior_weight: Option<PoseMatrix>,
    /// The terms about an initial pose, once a problem has one.
    near: Option<Box<HeldNear>>,
    pub(super) tiles: Tiles,
    /// log S at the points, as long as the pose does not change.
    samples: Vec<Samples>,
    magnitudes: Vec<f32>,
    pub(super) state: State,
    /// The state at the end of the annealing.
    pub(super) annealed: State,
    pub(super) noise: Noise,
    pub(super) weighting: Weighting,
    pub(super) phase: Phase,
    pub(super) rounds: usize,
    pub(super) options: PhotometricOptions,
    pub(super) iterations: usize,
    /// Whether the rounds with instrumental variables still run on the points that annealing took from all.
    pub(super) thinned: bool,
    /// Negligible steps of each unknown, if there are more points than annealing needs.
    pub(super) settled_step: Option<PoseVector>,
}

impl Photometric {
    /// Prepares the splines of the image's levels, as many as a known or unknown light requires, and the memory for
    /// both views.
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
            pose_prior_weight: None,
            near: None,
            tiles: Tiles::new(problem.depth_size),
            state,
            annealed: state,
            noise: Noise { residuals: f64::INFINITY, image: problem.image.log_noise().max(LEAST_NOISE) },
            weighting: Weighting::FIRST,
            phase: Phase::Done(PhotometricTermination::MostRounds),
            rounds: 0,
            options: PhotometricOptions::default(),
            iterations: 0,
            thinned: false,
            settled_step: None,
        }
    }

    /// Depth pixels of the present points.
    pub fn points(&self) -> impl Iterator<Item = usize> {
        self.points.indices()
    }

    /// The present pose.
    #[must_use]
    pub const fn pose(&self) -> &Similarity {
        &self.state.pose
    }

    /// Chooses the visible points of a round.
    pub(super) fn choose_points(&mut self, problem: &PhotometricProblem<'_>, sampling: Sampling) -> Result<Frame> {
        if !self.options.points_stay {
            self.points.update(problem, &self.state.pose, &self.levels[0], sampling);
        }
        if self.points.len() < FEWEST_POINTS {
            return Err(degenerate("the image shows too few of the depth points").value(self.points.len() as f64));
        }
        Ok(self.points.frame(problem, &self.state.pose))
    }

    /// Chooses the final points, at most `most`, with their noise and weights.
    pub(super) fn evaluate_end(&mut self, problem: &PhotometricProblem<'_>, most: usize) -> Result<Frame> {
        let frame = self.choose_points(problem, Sampling { level: 0, most })?;
        self.measure_noise(problem, 0);
        self.weigh(problem, final_robust_scale(self.noise.residuals));
        Ok(frame)
    }

    /// Fits the light under a fixed pose, with reweighting.
    pub(super) fn fit_light(&mut self, problem: &PhotometricProblem<'_>, level: usize) -> Result<()> {
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

    /// Prepares the terms about an initial pose, and the coarser levels of the image that it permits.
    pub(super) fn prepare_near(&mut self, problem: &PhotometricProblem<'_>) {
        if problem.near.is_none() {
            return;
        }
        for &blur in &BLURS[self.levels.len().min(coarsest(problem) + 1)..=coarsest(problem)] {
            self.levels.push(self.levels[0].blurred(problem.image, blur));
        }
        match &mut self.near {
            Some(near) => near.relief.clear(),
            none => {
                *none = Some(Box::new(HeldNear { terms: MaskAndPrior::new(problem), relief: Relief::new(problem) }))
            }
        }
    }

    /// Fits the albedo that follows the relief, if there is an initial pose and the noise is known.
    pub(super) fn fit_relief(&mut self, problem: &PhotometricProblem<'_>, level: usize, samples: &[Samples]) {
        if problem.near.is_none() || !self.noise.residuals.is_finite() {
            return;
        }
        let sums = self.evaluation(problem, level, &self.state).relief_sums(samples);
        if let Some(near) = &mut self.near {
            near.relief.step(sums, self.noise.residuals);
        }
    }

    /// Measures the noise of the residuals.
    pub(super) fn measure_noise(&mut self, problem: &PhotometricProblem<'_>, level: usize) {
        let mut magnitudes = std::mem::take(&mut self.magnitudes);
        let noise = self.evaluation(problem, level, &self.state).noise(&mut magnitudes);
        self.noise.residuals = noise.max(LEAST_NOISE);
        self.magnitudes = magnitudes;
    }

    /// Sets a robust scale, and the prior's weight at the present light.
    pub(super) fn weigh(&mut self, problem: &PhotometricProblem<'_>, robust_scale: f64) {
        let prior = prior_weight(problem, &self.state.light, self.noise.residuals);
        self.weighting = Weighting { robust_scale, prior };
    }

    /// The terms about an initial pose, if there are any.
    pub(super) fn near_terms(
        &self,
        problem: &PhotometricProblem<'_>,
        level: usize,
        frame: &Frame,
        pose: &Similarity,
    ) -> Option<Sums> {
        let (prior, near) = problem.near.as_ref().zip(self.near.as_ref())?;
        Some(near.terms.sums(problem, prior, pose, frame, self.near_weights(level)))
    }

    fn near_weights(&self, level: usize) -> MaskAndPriorWeights {
        let (points, robust_scale) = (self.points.weight(), self.weighting.robust_scale);
        MaskAndPriorWeights { points, robust_scale, noise: self.noise.residuals, level }
    }

    /// Weighs the prior about an initial pose, if there is one, against the equations of the present points. Their
    /// covariance includes the jackknife where the report's does, but not for a sample, which is only compared.
    pub(super) fn weigh_near(&mut self, problem: &PhotometricProblem<'_>, frame: &Frame) -> Result<()> {
        if problem.near.is_none() {
            return Ok(());
        }
        let reduced = self.reduce_by_instruments(problem, frame)?;
        let by_tiles = self.covariance(problem, frame, &reduced);
        self.pose_prior_weight = Some(product(&reduced.matrix, &by_tiles));
        if self.options.jackknife && !self.points.are_sampled() {
            let by_sectors = self.jackknife(problem, frame)?;
            self.pose_prior_weight = Some(product(&reduced.matrix, &(by_tiles + by_sectors)));
        }
        Ok(())
    }

    /// The equations by instrumental variables, with the terms about an initial pose if there is one.
    pub(super) fn reduce_near(&self, problem: &PhotometricProblem<'_>, frame: &Frame) -> Result<ReducedSystem> {
        let mut reduced = self.reduce_by_instruments(problem, frame)?;
        let near = problem.near.as_ref().zip(self.near.as_ref()).zip(self.pose_prior_weight.as_ref());
        if let Some(((prior, near), weight)) = near {
            let pose = &self.state.pose;
            reduced.add(&near.terms.mask(problem, pose, frame, self.near_weights(0)));
            reduced.add_weighted(weight, &near.terms.prior(prior, pose, frame));
        }
        Ok(reduced)
    }

    /// The objective of a state.
    pub(super) fn objective(
        &self,
        problem: &PhotometricProblem<'_>,
        level: usize,
        frame: &Frame,
        state: &State,
    ) -> f64 {
        let near_terms = self.near_terms(problem, level, frame, &state.pose).map_or(0.0, |sums| sums.cost);
        self.evaluation(problem, level, state).objective() + near_terms
    }

    /// The points at one level of the image under a state, with derivatives for least squares.
    pub(super) fn evaluation<'a>(
        &'a self,
        problem: &'a PhotometricProblem<'a>,
        level: usize,
        state: &'a State,
    ) -> Evaluation<'a> {
        let model = ColourModel::new(&self.levels[level], &problem.image.camera, &state.exposed_light());
        let relief = self.near.as_ref().filter(|_| problem.near.is_some()).map(|near| &near.relief);
        Evaluation { problem, points: &self.points, relief, model, state, weighting: self.weighting }
    }

    /// The points on the sharp image under the present state, with instrumental variables.
    pub(super) fn evaluation_by_instruments<'a>(&'a self, problem: &'a PhotometricProblem<'a>) -> Evaluation<'a> {
        let evaluation = self.evaluation(problem, 0, &self.state);
        Evaluation { model: evaluation.model.with_instruments(&self.instruments), ..evaluation }
    }

    pub(super) fn reduce_by_instruments(
        &self,
        problem: &PhotometricProblem<'_>,
        frame: &Frame,
    ) -> Result<ReducedSystem> {
        self.evaluation_by_instruments(problem).unbiased_system(frame).ok_or_else(undetermined_light)
    }

    pub(super) fn covariance(
        &mut self,
        problem: &PhotometricProblem<'_>,
        frame: &Frame,
        reduced: &ReducedSystem,
    ) -> PoseMatrix {
        let mut tiles = std::mem::take(&mut self.tiles);
        let covariance = tiles.covariance(&self.evaluation_by_instruments(problem), frame, reduced, self.noise);
        self.tiles = tiles;
        covariance
    }
}

/// The coarsest level that a problem permits.
pub(super) const fn coarsest(problem: &PhotometricProblem<'_>) -> usize {
    match (problem.near, problem.light) {
        (Some(_), _) => COARSEST_NEAR,
        (None, Some(_)) => COARSEST,
        (None, None) => COARSEST_UNKNOWN,
    }
}

pub(super) fn undetermined_light() -> Error {
    degenerate("the visible points do not determine the light")
}

fn degenerate(message: &'static str) -> Error {
    Error::new(ErrorKind::Degenerate, "registration", message)
}
