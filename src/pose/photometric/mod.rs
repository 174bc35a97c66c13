//! min over T, L of sum_h w_h rho(|log S(pi(T P_h)) - B(R n_h) L|^2) + sigma^2 h(L): the pose straight from the
//! colours.
//!
//! Each depth point predicts a colour by its own normal; the pose is right where the image shows it. Unknown are the
//! rotation, the translation, the logarithm of the scale, and the light: all 27 coefficients under the prior h of
//! natural lights, or the exposure alone where the light is known. rho is the cost of Geman and McClure over the three
//! channels together, sigma the noise of log S.
//!
//! Method, in rounds. A round fixes the visible points (z-buffer); points that then leave the mask cost the full price,
//! so that looking away never pays.
//! 1. Annealing: Gauss-Newton with the light eliminated ([`equations`]) and Levenberg-Marquardt damping, steps
//!    accepted on the very same cost. The robust scale shrinks from round to round, from twice what the residuals ask
//!    for down to three sigmas of the noise; blurred images and every fourth, then every second point come first.
//! 2. Listening: the gradient of a noisy image is noise as well, and together with the noise of the residual it pulls
//!    poses: towards half pixels, where interpolation averages noise away (0.4 degrees on Mozart at 128x128 under weak
//!    light, five times the error of the noise itself). So the last rounds solve sum w Z^T r = 0 with Z the jacobian
//!    from a slightly blurred image: its noise is a fifth, and what it loses is a little efficiency, never the mean.
//!
//! One sigma follows from the scores' own spread over tiles of the depth map (a sandwich): noise, wrong normals and
//! interpolation enter as they are, correlated or not. An error that leaves no residual is not seen by it.
//!
//! Limits: Lambertian, one albedo; starts beyond some 20 to 30 degrees may end elsewhere; behind a pinhole image the
//! scale is held, for it cannot be told from the distance.

mod certainty;
mod equations;
mod image;
mod points;
mod problem;
mod residual;

use super::increment::{Frame, Row};
use super::similarity::Similarity;
use crate::error::{Error, ErrorKind, Result};
use crate::light::COEFFICIENTS;

use crate::view::Size;
use equations::Reduced;
use image::SplineImage;
use points::{Robust, State, VisiblePoints};
use problem::COARSEST;
pub use problem::{PhotometricOptions, PhotometricProblem, PhotometricReport, PhotometricTermination};
use residual::Scene;

/// Gaussian blur of each level's image, pixels; a level takes every 2^level-th point.
const BLURS: [f64; COARSEST + 1] = [0.0, 1.5, 3.0];
/// Coarsest level under an unknown light: a light that follows explains strongly blurred colours in any pose. From 20
/// degrees off level 1 always converged on Mozart at 64x64, level 2 in a third of the cases; a known light converges
/// from 30 by level 2.
const COARSEST_UNKNOWN: usize = 1;
/// Blur of the image that the last rounds take slopes from, pixels: 0.7 to 1.5 serve alike.
const SLOPE_BLUR: f64 = 1.0;
/// The robust scale in standard deviations of |r|, handbook section 5: three.
const KERNEL: f64 = 3.0;
/// Noise per channel, log units, from which on the scale grows in proportion, and by how much at most. What is left then
/// is no noise but shadows and paint, and a narrow scale would settle on a part of the object that light and normals
/// happen to explain. Nearly all renders with 1 % noise stay below, photographs in one lamp's light do not.
const ROUGH: f64 = 0.035;
const WIDEST: f64 = 2.0;
/// |r| over three channels in standard deviations of one.
const CHANNELS: f64 = 1.732_050_807_568_877_2;
/// The first robust scale over that of the residuals at the start.
const FIRST_SCALE: f64 = 2.0;
/// The robust scale of a round over the one before, at least.
const ANNEALING: f64 = 0.6;
/// Noise of log S that is always allowed for: half a percent of a good 8-bit image's rounding, log units.
const LEAST_NOISE: f64 = 0.002;
/// Degrees of freedom of the prior's tails: coloured lamps lie far outside the Gaussian, and it would bend them by
/// degrees.
const PRIOR_FREEDOM: f64 = 5.0;
/// Scale and weight of the prior of the very first fit of the light, when nothing is known: all points count.
const FIRST_LOOK: Robust = Robust { scale: 1e3, prior: 1e-2 };
/// Reweightings of the light at the start of a round.
const LIGHT_ROUNDS: usize = 6;
/// Gauss-Newton steps of a round, and attempts to find the damping of each.
const MOST_STEPS: usize = 6;
const MOST_ATTEMPTS: usize = 8;
/// Damping at the start of a round, its factors after a success and a failure, and its least.
const DAMPING: f64 = 1e-3;
const RELAX: f64 = 0.2;
const TIGHTEN: f64 = 8.0;
const LEAST_DAMPING: f64 = 1e-9;
/// A step below this, in radians and object sizes, changes nothing: 1e-5 degrees.
const STILL: f64 = 1e-7;
/// A coarse level is done when a round turns by less, degrees.
const COARSE_DONE: f64 = 0.3;
/// Annealing is done when a round at the final scale turns by less, degrees: points flicker in and out by more than
/// that.
const FINE_DONE: f64 = 3e-3;
/// Rounds at the final scale after which flicker is all that is left.
const MOST_FINE_ROUNDS: usize = 4;
/// Listening rounds: the visible points follow in the first, and stay in the others.
const LISTENING_ROUNDS: usize = 3;
const MOST_LISTENING_STEPS: usize = 12;
/// Listening is undone when it raises the cost by more than this share: it should only trade noise.
const LARGEST_RISE: f64 = 0.1;
/// Fewest points: two for each unknown.
const FEWEST_POINTS: usize = 14;

/// Where the rounds stand: what the next piece of work is.
#[derive(Clone, Copy, Debug)]
enum Phase {
    /// A round of annealing begins: its visible points and their light.
    Annealing {
        level: usize,
        fine_rounds: usize,
    },
    /// A Gauss-Newton step of it.
    Descending(Descent),
    /// A listening round begins.
    Listening {
        round: usize,
    },
    /// A step of it.
    Hearing {
        round: usize,
        frame: Frame,
        steps: usize,
    },
    Done(PhotometricTermination),
}

/// A round of damped Gauss-Newton at one level and one robust scale, between two of its steps.
#[derive(Clone, Copy, Debug)]
struct Descent {
    level: usize,
    fine_rounds: usize,
    frame: Frame,
    /// The pose at the beginning of the round.
    before: Similarity,
    /// Whether the robust scale is that of the noise.
    at_noise: bool,
    damping: f64,
    cost: f64,
    steps: usize,
}

/// Registers one depth view to one image again and again; owns all memory.
pub struct Photometric {
    sizes: [Size; 2],
    /// Down to the coarsest that is looked at.
    levels: Vec<SplineImage>,
    slopes: SplineImage,
    points: VisiblePoints,
    tiles: Vec<Row>,
    state: State,
    /// The state at the end of the annealing.
    annealed: State,
    noise: f64,
    /// That of the image itself, whatever the pose.
    image_noise: f64,
    robust: Robust,
    phase: Phase,
    rounds: usize,
    most_rounds: usize,
    most_points: usize,
    annealed_points: usize,
    annealing: bool,
    iterations: usize,
}

impl Photometric {
    /// Splines of the image's levels, as many as a light that is known or not asks for, and memory for both views.
    #[must_use]
    pub fn new(problem: &PhotometricProblem<'_>) -> Self {
        let light = problem.prior.mean();
        let state = State { pose: Similarity::identity(), light, exposure: 0.0 };
        let sharp = SplineImage::new(problem.image, BLURS[0]);
        let slopes = sharp.blurred(problem.image, SLOPE_BLUR);
        let mut levels = vec![sharp];
        levels.extend((1..=coarsest(problem)).map(|level| slopes.blurred(problem.image, BLURS[level])));
        Self {
            sizes: [problem.image.size, problem.depth.size],
            slopes,
            levels,
            points: VisiblePoints::new(problem),
            tiles: vec![Row::zeros(); certainty::tiles(problem.depth.size)],
            state,
            annealed: state,
            noise: f64::INFINITY,
            image_noise: problem.image.log_noise().max(LEAST_NOISE),
            robust: FIRST_LOOK,
            phase: Phase::Done(PhotometricTermination::MostRounds),
            rounds: 0,
            most_rounds: 0,
            most_points: usize::MAX,
            annealed_points: usize::MAX,
            annealing: true,
            iterations: 0,
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
        let level = options.first_level.min(coarsest(problem)).min(self.levels.len() - 1);
        // From the image's own brightness, so that a change of exposure changes nothing that follows.
        let brightness = problem.image.log_mean();
        self.state = match problem.light {
            Some(light) => State { pose: *start, light: *light, exposure: brightness },
            None => State { pose: *start, light: problem.prior.mean().exposed(brightness), exposure: 0.0 },
        };
        (self.phase, self.rounds, self.iterations) = (Phase::Annealing { level, fine_rounds: 0 }, 0, 0);
        self.most_rounds = options.most_rounds.max(1);
        (self.most_points, self.annealing) = (options.most_points, options.annealing);
        self.annealed_points = options.annealed_points.min(options.most_points);
        self.look(problem, level, self.annealed_points)?;
        self.robust = FIRST_LOOK;
        self.fit_light(problem, level)?;
        self.measure(problem, level);
        let tolerance = if options.annealing { FIRST_SCALE / ANNEALING } else { 1.0 };
        self.robust = Robust { scale: tolerance * self.final_scale(), prior: self.prior(problem) };
        Ok(())
    }

    /// A piece of a round, one Gauss-Newton step at most, so that a page stays alive; whether it was the last.
    ///
    /// # Errors
    /// [`ErrorKind::Degenerate`] where too few points are visible or they determine nothing.
    pub fn step(&mut self, problem: &PhotometricProblem<'_>) -> Result<bool> {
        self.phase = match self.phase {
            Phase::Descending(descent) => self.descend(problem, descent)?,
            Phase::Hearing { round, frame, steps } => self.hear(problem, round, &frame, steps)?,
            Phase::Done(_) => self.phase,
            _ if self.rounds >= self.most_rounds => Phase::Done(PhotometricTermination::MostRounds),
            Phase::Annealing { level, fine_rounds } => self.anneal(problem, level, fine_rounds)?,
            Phase::Listening { round } => self.listen(problem, round)?,
        };
        Ok(self.is_done())
    }

    /// Whether there is nothing left to [`step`](Self::step).
    #[must_use]
    pub const fn is_done(&self) -> bool {
        matches!(self.phase, Phase::Done(_))
    }

    /// The present pose.
    #[must_use]
    pub const fn pose(&self) -> &Similarity {
        &self.state.pose
    }

    /// The beginning of a round: its points, their light, its robust scale.
    fn anneal(&mut self, problem: &PhotometricProblem<'_>, level: usize, fine_rounds: usize) -> Result<Phase> {
        self.rounds += 1;
        let frame = self.look(problem, level, self.annealed_points)?;
        self.fit_light(problem, level)?;
        self.measure(problem, level);
        let target = self.final_scale();
        let tolerated = if self.annealing { ANNEALING * self.robust.scale } else { 0.0 };
        self.robust = Robust { scale: target.max(tolerated), prior: self.prior(problem) };
        Ok(Phase::Descending(Descent {
            level,
            fine_rounds,
            frame,
            before: self.state.pose,
            at_noise: self.robust.scale <= target,
            damping: DAMPING,
            cost: self.cost(problem, level, &self.state),
            steps: 0,
        }))
    }

    /// A step of pose and light that lowers the cost.
    fn descend(&mut self, problem: &PhotometricProblem<'_>, mut descent: Descent) -> Result<Phase> {
        let Descent { level, frame, .. } = descent;
        self.iterations += 1;
        descent.steps += 1;
        let reduced = self.reduced(problem, level, &frame, false)?;
        let mut size = 0.0;
        for _ in 0..MOST_ATTEMPTS {
            if let Some((step, light)) = reduced.step(descent.damping, &problem.held()) {
                let next = self.state.moved(&frame, &step, &light, problem.light.is_some());
                let next_cost = self.cost(problem, level, &next);
                if next_cost <= descent.cost {
                    (self.state, descent.cost, size) = (next, next_cost, step.norm());
                    descent.damping = (RELAX * descent.damping).max(LEAST_DAMPING);
                    break;
                }
            }
            descent.damping *= TIGHTEN;
        }
        let ends = size < STILL || descent.steps >= MOST_STEPS;
        Ok(if ends { self.after(&descent) } else { Phase::Descending(descent) })
    }

    /// What follows a round of annealing.
    fn after(&mut self, &Descent { level, fine_rounds, before, at_noise, .. }: &Descent) -> Phase {
        let change = before.degrees_to(&self.state.pose);
        match level {
            0 if at_noise && (change < FINE_DONE || fine_rounds >= MOST_FINE_ROUNDS) => {
                self.annealed = self.state;
                Phase::Listening { round: 0 }
            }
            0 => Phase::Annealing { level, fine_rounds: fine_rounds + usize::from(at_noise) },
            _ if change < COARSE_DONE || (at_noise && fine_rounds >= MOST_FINE_ROUNDS) => {
                Phase::Annealing { level: level - 1, fine_rounds: 0 }
            }
            _ => Phase::Annealing { level, fine_rounds: fine_rounds + usize::from(at_noise) },
        }
    }

    /// The beginning of a round of sum w Z^T r = 0: the visible points follow in the first.
    fn listen(&mut self, problem: &PhotometricProblem<'_>, round: usize) -> Result<Phase> {
        self.rounds += 1;
        let frame = match round {
            0 => self.look(problem, 0, self.most_points)?,
            _ => self.points.frame(problem, &self.state.pose),
        };
        Ok(Phase::Hearing { round, frame, steps: 0 })
    }

    /// A step of such a round.
    fn hear(&mut self, problem: &PhotometricProblem<'_>, round: usize, frame: &Frame, steps: usize) -> Result<Phase> {
        self.iterations += 1;
        let reduced = self.reduced(problem, 0, frame, true)?;
        let mut still = false;
        if let Some((step, light)) = reduced.step(0.0, &problem.held()) {
            self.state = self.state.moved(frame, &step, &light, problem.light.is_some());
            still = step.norm() < STILL;
            if !still && steps + 1 < MOST_LISTENING_STEPS {
                return Ok(Phase::Hearing { round, frame: *frame, steps: steps + 1 });
            }
        }
        let rise = self.cost(problem, 0, &self.state) / self.cost(problem, 0, &self.annealed);
        if rise.is_nan() || rise > 1.0 + LARGEST_RISE {
            self.state = self.annealed;
            return Ok(Phase::Done(PhotometricTermination::Annealed));
        }
        let last = round + 1 >= LISTENING_ROUNDS || (still && round > 0);
        Ok(if last { Phase::Done(PhotometricTermination::Settled) } else { Phase::Listening { round: round + 1 } })
    }

    /// Chooses the visible points of a round.
    fn look(&mut self, problem: &PhotometricProblem<'_>, level: usize, most: usize) -> Result<Frame> {
        self.points.update(problem, &self.state.pose, &self.levels[0], level, most);
        if self.points.len() < FEWEST_POINTS {
            return Err(degenerate("the image shows too few of the depth points").value(self.points.len() as f64));
        }
        Ok(self.points.frame(problem, &self.state.pose))
    }

    /// The light alone, reweighted.
    fn fit_light(&mut self, problem: &PhotometricProblem<'_>, level: usize) -> Result<()> {
        let camera = &problem.image.camera;
        let scene = |state: &State| Scene::new(&self.levels[level], None, camera, &state.exposed());
        self.points.see(problem, &scene(&self.state), &self.state);
        for _ in 0..LIGHT_ROUNDS {
            let equations = self.points.light_equations(problem, &scene(&self.state), &self.state, self.robust);
            let step = equations.step().ok_or_else(undetermined_light)?;
            self.state = self.state.relit(&step, problem.light.is_some());
        }
        Ok(())
    }

    /// The noise of the residuals.
    fn measure(&mut self, problem: &PhotometricProblem<'_>, level: usize) {
        let scene = Scene::new(&self.levels[level], None, &problem.image.camera, &self.state.exposed());
        self.noise = self.points.noise(problem, &scene, &self.state).max(LEAST_NOISE);
    }

    fn final_scale(&self) -> f64 {
        KERNEL * CHANNELS * self.noise * (self.noise / ROUGH).clamp(1.0, WIDEST)
    }

    /// Weight of the prior: Gaussian near the natural lights, with the tails of Student's t for lights that no
    /// landscape has.
    fn prior(&self, problem: &PhotometricProblem<'_>) -> f64 {
        let energy = problem.prior.squared_distance(&self.state.light);
        let tail = (PRIOR_FREEDOM + COEFFICIENTS as f64) / (PRIOR_FREEDOM + energy);
        problem.prior_weight * tail.min(1.0) * self.noise * self.noise
    }

    fn cost(&self, problem: &PhotometricProblem<'_>, level: usize, state: &State) -> f64 {
        let scene = Scene::new(&self.levels[level], None, &problem.image.camera, &state.exposed());
        self.points.cost(problem, &scene, state, self.robust)
    }

    fn reduced(
        &self,
        problem: &PhotometricProblem<'_>,
        level: usize,
        frame: &Frame,
        listening: bool,
    ) -> Result<Reduced> {
        let slopes = listening.then_some(&self.slopes);
        let scene = Scene::new(&self.levels[level], slopes, &problem.image.camera, &self.state.exposed());
        let equations = self.points.equations(problem, &scene, &self.state, self.robust, frame);
        equations.reduce().ok_or_else(undetermined_light)
    }
}

/// The coarsest level that serves a problem.
const fn coarsest(problem: &PhotometricProblem<'_>) -> usize {
    if problem.light.is_some() { COARSEST } else { COARSEST_UNKNOWN }
}

fn undetermined_light() -> Error {
    degenerate("the visible points do not determine the light")
}

fn degenerate(message: &'static str) -> Error {
    Error::new(ErrorKind::Degenerate, "registration", message)
}
