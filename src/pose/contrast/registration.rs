//! The rounds of a registration by local contrast.

use super::equations::Lights;
use super::local_means::LocalMeans;
use super::objective::{Level, Objective, State};
use super::problem::ContrastProblem;
use super::samples::Samples;
use super::seen::Seen;
use super::uncertainty::{covariance, described};
use crate::pose::increment::Frame;
use crate::pose::silhouette::Silhouette;
use crate::pose::similarity::Similarity;
use crate::pose::spline_image::SplineImage;
use crate::pose::uncertainty::Uncertainty;

/// Sharp, and blurred: by so many pixels ..
const LEVELS: usize = 2;
const BLURS: [f64; LEVELS] = [0.0, 1.5];
/// .. with local means over a Gaussian of this sigma, depth pixels; that of 2 to 5 serve alike. All three for objects as
/// large as those that they were measured on, views of 96x96; on larger ones they grow with it.
const MEANS: [f64; LEVELS] = [3.0, 5.0];
/// Depth pixels of such an object, root of their number.
const MEASURED_SIDE: f64 = 64.0;
/// Blur of the sharp image in strides beyond the first: what lies between samples would be noise.
const BLUR_OF_STRIDE: f64 = 0.4;
/// v = log(I + 0.1 median I).
const LIFT: f32 = 0.1;
/// The noise whose robust scale a registration starts with, over that of the residuals; it shrinks by 0.6 a round.
const FIRST_SCALE: f64 = 2.0;
const SHRINKING: f64 = 0.6;
/// Gauss-Newton steps of a round, and attempts to find the damping of each.
const MOST_STEPS: usize = 4;
const MOST_ATTEMPTS: usize = 6;
/// Damping at the start of a round, as a share of the diagonal; its factors after a success and a failure; its least.
const FIRST_DAMPING: f64 = 1e-3;
const DAMPING_AFTER_SUCCESS: f64 = 0.2;
const DAMPING_AFTER_FAILURE: f64 = 8.0;
const LEAST_DAMPING: f64 = 1e-9;
/// A step below this, in radians and object sizes, changes nothing that matters: a thousandth of a degree.
const SETTLED_STEP: f64 = 2e-5;
/// A level is done when a round rotates by less, degrees.
const SETTLED_ROUND: [f64; LEVELS] = [0.02, 0.3];

/// How much work a registration may be.
#[derive(Clone, Copy, Debug)]
pub struct ContrastEffort {
    /// The first level: 1 from afar, 0 from nearby.
    pub first_level: usize,
    /// The last level: 1 to end with the blurred image.
    pub last_level: usize,
    /// Rounds of each level at most.
    pub rounds: usize,
}

impl ContrastEffort {
    /// Down to the sharp image.
    pub const FULL: Self = Self { first_level: 1, last_level: 0, rounds: 14 };
    /// On the blurred image alone: enough to see whether a start is worth more.
    pub const COARSE: Self = Self { first_level: 1, last_level: 1, rounds: 3 };
}

/// A registration under way.
struct Course {
    state: State,
    effort: ContrastEffort,
    level: usize,
    round: usize,
    /// Whose robust scale the present round has; infinite before the first.
    noise: f64,
}

/// Registers one depth view to one image again and again; owns all memory.
pub struct ContrastRegistration {
    levels: [Level; LEVELS],
    objective: Objective,
    course: Option<Course>,
}

impl ContrastRegistration {
    /// By every `stride`-th depth pixel.
    #[must_use]
    pub fn new(problem: &ContrastProblem<'_>, stride: usize) -> Self {
        let samples = Samples::new(problem, stride.max(1));
        let unit = ((problem.depth.valid() as f64).sqrt() / MEASURED_SIDE).max(1.0);
        let lifted = problem.image.lifted(LIFT);
        let between = BLUR_OF_STRIDE * (samples.stride as f64 / unit - 1.0).max(0.0);
        let sharp = SplineImage::new(&lifted, unit * BLURS[0].max(if unit > 1.0 { between } else { 0.0 }));
        let blurred = sharp.blurred(&lifted, unit * BLURS[1]);
        let means =
            |sigma: f64| LocalMeans::new(samples.grid.width, samples.grid.len(), unit * sigma / samples.stride as f64);
        let mut blur = means(BLURS[1]);
        let shades = [samples.shades.clone(), blur.smoothed(&samples.weight, &samples.shades)];
        let [sharp_shades, blurred_shades] = shades;
        let levels = [
            Level { image: sharp, means: means(MEANS[0]), shades: sharp_shades },
            Level { image: blurred, means: means(MEANS[1]), shades: blurred_shades },
        ];
        let silhouette = Silhouette::new(problem.image.size, problem.object);
        let seen = Seen::new(problem.image.size, &samples, samples.stride as f64);
        Self { levels, objective: Objective::new(problem, samples, silhouette, seen, unit), course: None }
    }

    /// Starts anew.
    pub fn begin(&mut self, problem: &ContrastProblem<'_>, start: &Similarity, effort: ContrastEffort) {
        self.objective.expect_size(problem, start);
        let state = State { pose: *start, light: Lights::default() };
        self.course = Some(Course { state, effort, level: effort.first_level, round: 0, noise: f64::INFINITY });
    }

    /// One round; whether it was the last.
    pub fn step(&mut self, problem: &ContrastProblem<'_>) -> bool {
        let Some(mut course) = self.course.take() else { return true };
        let Course { level, effort, .. } = course;
        let before = course.state.pose;
        let Some(frame) = self.objective.begin(problem, &mut self.levels[level], &mut course.state) else {
            return true;
        };
        let target = self.objective.noise(&course.state.light);
        course.noise = match course.noise.is_finite() {
            true => (SHRINKING * course.noise).max(target),
            false => FIRST_SCALE * target,
        };
        self.objective.set_noise(course.noise);
        self.descend(problem, level, &frame, &mut course.state);
        course.round += 1;
        let settled = course.noise <= target && before.degrees_to(&course.state.pose) < SETTLED_ROUND[level];
        let ends = settled || course.round >= effort.rounds;
        let last = ends && level <= effort.last_level;
        if ends && !last {
            (course.level, course.round) = (level - 1, 0);
        }
        self.course = Some(course);
        last
    }

    /// The present pose, where enough is seen from it.
    #[must_use]
    pub fn pose(&self) -> Option<Similarity> {
        self.course.as_ref().map(|course| course.state.pose)
    }

    /// One sigma of a pose, by what its contrast leaves; `None` where too little is seen.
    pub fn uncertainty(&mut self, problem: &ContrastProblem<'_>, pose: &Similarity) -> Option<Uncertainty> {
        let mut state = State { pose: *pose, light: Lights::default() };
        self.objective.expect_size(problem, pose);
        let frame = self.look(problem, &mut state, None)?;
        let reduced = self.objective.linearise(problem, &mut self.levels[0], &frame, &state)?;
        let covariance = covariance(&self.objective, &state.light, &reduced, &problem.held());
        Some(described(problem, &covariance, &frame, pose))
    }

    /// E of a pose on the sharp image at the robust scale of a noise, its light at its best.
    pub fn evaluate(&mut self, problem: &ContrastProblem<'_>, pose: &Similarity, noise: f64) -> Option<f64> {
        let mut state = State { pose: *pose, light: Lights::default() };
        self.look(problem, &mut state, Some(noise))?;
        Some(self.objective.compared(problem, &mut self.levels[0], &state))
    }

    fn look(&mut self, problem: &ContrastProblem<'_>, state: &mut State, noise: Option<f64>) -> Option<Frame> {
        let frame = self.objective.begin(problem, &mut self.levels[0], state)?;
        let noise = noise.unwrap_or_else(|| self.objective.noise(&state.light));
        self.objective.set_noise(noise);
        Some(frame)
    }

    /// Damped Gauss-Newton steps that lower E.
    fn descend(&mut self, problem: &ContrastProblem<'_>, level: usize, frame: &Frame, state: &mut State) {
        let (held, level) = (problem.held(), &mut self.levels[level]);
        let mut damping = FIRST_DAMPING;
        let mut value = self.objective.value(problem, level, state);
        for _ in 0..MOST_STEPS {
            let Some(reduced) = self.objective.linearise(problem, level, frame, state) else { return };
            let mut size = 0.0;
            for _ in 0..MOST_ATTEMPTS {
                if let Some((change, light)) = reduced.step(damping, &held) {
                    let mut next = *state;
                    next.pose = frame.change(&change).after(&state.pose).orthonormal();
                    next.light.iter_mut().zip(light).for_each(|(light, step)| *light += step);
                    let next_value = self.objective.value(problem, level, &next);
                    if next_value <= value {
                        (*state, value, size) = (next, next_value, change.norm());
                        damping = (DAMPING_AFTER_SUCCESS * damping).max(LEAST_DAMPING);
                        break;
                    }
                }
                damping *= DAMPING_AFTER_FAILURE;
            }
            if size < SETTLED_STEP {
                return;
            }
        }
    }
}
