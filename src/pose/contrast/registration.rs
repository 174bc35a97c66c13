//! The rounds of a registration by local contrast.

use super::equations::{Lights, Reduced};
use super::local_means::LocalMeans;
use super::objective::{Level, Objective, State};
use super::problem::ContrastProblem;
use super::samples::Samples;
use super::seen::Seen;
use super::uncertainty::{Linearised, PoseCovariance, described};
use crate::pose::descent::{Damping, Lowered};
use crate::pose::increment::{Frame, PoseVector};
use crate::pose::residuals::{FIRST_SCALE, MEASURED_SIDE, SHRINKING};
use crate::pose::silhouette::Silhouette;
use crate::pose::similarity::Similarity;
use crate::pose::spline_image::SplineImage;

/// Number of levels: the finest, whose blur the caller chooses, and one with a blur of this many pixels. Blurs and
/// means are for objects of up to 64x64 depth pixels and grow with larger ones.
const LEVELS: usize = 2;
const BLUR: f64 = 1.5;
/// Sigma of the local means on each level, depth pixels (docs/lab/thresholds.md).
const MEANS: [f64; LEVELS] = [3.0, 5.0];
/// Blur of the sharp image in strides beyond the first, because detail between samples would be noise.
const BLUR_OF_STRIDE: f64 = 0.4;
/// Share of the median intensity that is added before the logarithm, v = log(I + 0.1 median I), which limits the
/// contrast of dark pixels.
const LIFT: f32 = 0.1;
/// Maximum number of Gauss-Newton steps of a round, and of attempts to damp a step.
const MOST_STEPS: usize = 4;
const MOST_ATTEMPTS: usize = 6;
/// A step below this, in radians and object sizes, is negligible: a thousandth of a degree.
const SETTLED_STEP: f64 = 2e-5;
/// Rotation in degrees below which a round is the last of its level.
const SETTLED_ROUND: [f64; LEVELS] = [0.02, 0.3];

/// Damping of an instrumental step, as a share of the diagonal.
const INSTRUMENT_DAMPING: f64 = 1e-3;
/// The instrumental rounds are undone if they raise E by more than this share. They do not descend E, and may lead
/// anywhere from a pose that does not fit.
const LARGEST_RISE: f64 = 0.1;

/// Limits on the work of a registration.
#[derive(Clone, Copy, Debug)]
pub struct ContrastEffort {
    /// The first level: 1 from a distant initial pose, 0 from a close one.
    pub first_level: usize,
    /// The last level: 1 to end with the blurred image.
    pub last_level: usize,
    /// Maximum number of rounds of each level.
    pub rounds: usize,
    /// Maximum number of instrumental rounds after those.
    pub instrument_rounds: usize,
}

impl ContrastEffort {
    /// The limits of a registration that ends with the sharp image.
    pub const FULL: Self = Self { first_level: 1, last_level: 0, rounds: 14, instrument_rounds: 0 };
    /// Registers only on the blurred image, which shows whether an initial pose deserves more work.
    pub const COARSE: Self = Self { first_level: 1, last_level: 1, rounds: 3, instrument_rounds: 0 };
}

/// A registration in progress.
struct Course {
    state: State,
    effort: ContrastEffort,
    level: usize,
    round: usize,
    /// The noise that the robust scale of the present round assumes; infinite before the first round.
    noise: f64,
    /// The end of the descent and its E, once reached.
    descended: Option<(Similarity, f64)>,
}

/// Registers one depth view to one image repeatedly; owns all memory.
pub struct ContrastRegistration {
    levels: [Level; LEVELS],
    pub(super) objective: Objective,
    course: Option<Course>,
}

impl ContrastRegistration {
    /// A registration on every `stride`-th depth pixel. On the finest level a Gaussian with a sigma of `blur` depth
    /// pixels blurs image and prediction; zero leaves them sharp.
    #[must_use]
    pub fn new(problem: &ContrastProblem<'_>, stride: usize, blur: f64) -> Self {
        let samples = Samples::new(problem, stride.max(1));
        let unit = ((problem.depth.valid() as f64).sqrt() / MEASURED_SIDE).max(1.0);
        // The noise of normals has the same reach in large and small views.
        let finest = blur / unit;
        let lifted = problem.image.lifted(LIFT);
        let between = BLUR_OF_STRIDE * (samples.stride as f64 / unit - 1.0).max(0.0);
        let sharp = SplineImage::new(&lifted, unit * finest.max(if unit > 1.0 { between } else { 0.0 }));
        let blurred = sharp.blurred(&lifted, unit * BLUR);
        let means =
            |sigma: f64| LocalMeans::new(samples.grid.width, samples.grid.len(), unit * sigma / samples.stride as f64);
        let smoothed = |sigma: f64| match sigma > 0.0 {
            true => means(sigma).smoothed(&samples.weight, &samples.shades),
            false => samples.shades.clone(),
        };
        let [sharp_shades, blurred_shades] = [finest, BLUR].map(smoothed);
        let levels = [
            Level { image: sharp, means: means(MEANS[0]), shades: sharp_shades },
            Level { image: blurred, means: means(MEANS[1]), shades: blurred_shades },
        ];
        let silhouette = Silhouette::new(problem.image.size, problem.object);
        let seen = Seen::new(problem.image.size, &samples, samples.stride as f64);
        Self { levels, objective: Objective::new(problem, samples, silhouette, seen, unit), course: None }
    }

    /// Begins a registration.
    pub fn begin(&mut self, start: &Similarity, effort: ContrastEffort) {
        self.objective.expect_size(start);
        let state = State { pose: *start, light: Lights::default() };
        self.course =
            Some(Course { state, effort, level: effort.first_level, round: 0, noise: f64::INFINITY, descended: None });
    }

    /// Runs one round. Returns whether it was the last.
    pub fn step(&mut self, problem: &ContrastProblem<'_>) -> bool {
        let Some(mut course) = self.course.take() else { return true };
        let last = match course.descended {
            Some(descended) => self.follow_instruments(problem, &mut course, descended),
            None => match self.descend_a_round(problem, &mut course) {
                Some(last) => last,
                None => return true,
            },
        };
        self.course = Some(course);
        last
    }

    /// Runs one round of descent. Returns whether it was the last, or `None` if too few samples are visible.
    fn descend_a_round(&mut self, problem: &ContrastProblem<'_>, course: &mut Course) -> Option<bool> {
        let Course { level, effort, .. } = *course;
        let before = course.state.pose;
        let frame = self.objective.begin(problem, &mut self.levels[level], &mut course.state)?;
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
        if !ends {
            return Some(false);
        }
        course.round = 0;
        if level > effort.last_level {
            course.level = level - 1;
            return Some(false);
        }
        let pose = course.state.pose;
        if effort.instrument_rounds > 0 {
            course.descended = self.evaluate(problem, &pose, course.noise).map(|value| (pose, value));
        }
        Some(course.descended.is_none())
    }

    /// Runs one instrumental round. Returns whether it was the last.
    fn follow_instruments(
        &mut self,
        problem: &ContrastProblem<'_>,
        course: &mut Course,
        (descended, value): (Similarity, f64),
    ) -> bool {
        let moved = self.step_by_instruments(problem, &mut course.state).map(|step| step.norm());
        course.round += 1;
        if moved.is_some_and(|moved| moved > SETTLED_STEP) && course.round < course.effort.instrument_rounds {
            return false;
        }
        let end = self.evaluate(problem, &course.state.pose, course.noise);
        if end.is_none_or(|end| end.is_nan() || end > (1.0 + LARGEST_RISE) * value) {
            course.state.pose = descended;
        }
        true
    }

    /// Takes one instrumental step; `None` if the equations determine none.
    pub(super) fn step_by_instruments(
        &mut self,
        problem: &ContrastProblem<'_>,
        state: &mut State,
    ) -> Option<PoseVector> {
        let frame = self.look(problem, state, None)?;
        let (change, _) =
            self.linearise_by_instruments(problem, &frame, state)?.step(INSTRUMENT_DAMPING, &problem.held())?;
        state.pose = frame.change(&change).after(&state.pose).orthonormal();
        Some(change)
    }

    fn linearise_by_instruments(
        &mut self,
        problem: &ContrastProblem<'_>,
        frame: &Frame,
        state: &State,
    ) -> Option<Reduced> {
        self.objective.use_instruments(true);
        let reduced = self.objective.linearise(problem, &mut self.levels[0], frame, state);
        self.objective.use_instruments(false);
        reduced
    }

    /// The present pose, if enough samples are visible from it.
    #[must_use]
    pub fn pose(&self) -> Option<Similarity> {
        self.course.as_ref().map(|course| course.state.pose)
    }

    /// The uncertainty of a pose from its residuals; `None` if too few samples are visible.
    pub fn uncertainty(&mut self, problem: &ContrastProblem<'_>, pose: &Similarity) -> Option<PoseCovariance> {
        let mut state = State { pose: *pose, light: Lights::default() };
        self.objective.expect_size(pose);
        let by_sectors = self.jackknife(problem, pose);
        let frame = self.look(problem, &mut state, None)?;
        self.objective.use_instruments(true);
        let reduced = self.objective.linearise(problem, &mut self.levels[0], &frame, &state);
        let (objective, frame, state) = (&self.objective, &frame, &state);
        let uncertainty = reduced
            .map(|reduced| described(&Linearised { problem, objective, reduced: &reduced, frame, state }, by_sectors));
        self.objective.use_instruments(false);
        uncertainty
    }

    /// E of a pose on the sharp image, with its optimal light and the robust scale of a noise.
    pub fn evaluate(&mut self, problem: &ContrastProblem<'_>, pose: &Similarity, noise: f64) -> Option<f64> {
        let mut state = State { pose: *pose, light: Lights::default() };
        self.look(problem, &mut state, Some(noise))?;
        Some(self.objective.compared(problem, &mut self.levels[0], &state))
    }

    /// The value by which poses are ranked, under the same conditions.
    pub fn rank(&mut self, problem: &ContrastProblem<'_>, pose: &Similarity, noise: f64) -> Option<f64> {
        let mut state = State { pose: *pose, light: Lights::default() };
        self.look(problem, &mut state, Some(noise))?;
        Some(self.objective.ranked(problem, &mut self.levels[0], &state))
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
        let mut damping = Damping::FIRST;
        let mut value = self.objective.value(problem, level, state);
        for _ in 0..MOST_STEPS {
            let Some(reduced) = self.objective.linearise(problem, level, frame, state) else { return };
            let lowered = damping.lower(MOST_ATTEMPTS, value, |damping| {
                let (change, light) = reduced.step(damping, &held)?;
                let mut next = *state;
                next.pose = frame.change(&change).after(&state.pose).orthonormal();
                next.light.iter_mut().zip(light).for_each(|(light, step)| *light += step);
                let objective = self.objective.value(problem, level, &next);
                Some(Lowered { state: next, objective, size: change.norm() })
            });
            let Some(Lowered { state: next, objective, size }) = lowered else { return };
            (*state, value) = (next, objective);
            if size < SETTLED_STEP {
                return;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::super::test_scene::{SIDE, TEXTURE_BLUR, texture, views};
    use super::*;
    use crate::numeric::noise;
    use crate::view::{ColourView, DepthView};

    /// Error in degrees at the end of a registration from 3 degrees off.
    fn off((image, depth): &(ColourView, DepthView), instrument_rounds: usize) -> f64 {
        let normal_error = vec![0.0; depth.size.len()];
        let problem = ContrastProblem::of_views(image, depth, &normal_error);
        let rotation = Rotation3::new(Vector3::new(0.03, -0.04, 0.01)).into_inner();
        let start = Similarity::identity().turned_about(depth.points.centroid(), 1.0, rotation);
        let mut registration = ContrastRegistration::new(&problem, 1, 0.0);
        registration.begin(&start, ContrastEffort { instrument_rounds, ..ContrastEffort::FULL });
        while !registration.step(&problem) {}
        registration.pose().unwrap().degrees_to(&Similarity::identity())
    }

    #[test]
    fn instruments_leave_what_shading_explains_at_its_pose() {
        let off = off(&views(&[0.0; SIDE * SIDE]), 20);
        assert!(off < 0.1, "{off}");
    }

    #[test]
    fn smooth_albedo_biases_less_by_instruments() {
        let scenes: Vec<_> = (1..=6).map(|seed| views(&texture(seed, 0.06, TEXTURE_BLUR))).collect();
        let mean = |rounds| scenes.iter().map(|scene| off(scene, rounds)).sum::<f64>() / scenes.len() as f64;
        let (descent, instruments) = (mean(0), mean(20));
        assert!(instruments < 0.8 * descent, "{instruments} instead of {descent}");
    }

    /// One sigma of the rotation about each axis at the true pose, with the given mask.
    fn sigmas((image, depth): &(ColourView, DepthView), object: &[bool]) -> [f64; 3] {
        let normal_error = vec![0.0; depth.size.len()];
        let problem = ContrastProblem { object, ..ContrastProblem::of_views(image, depth, &normal_error) };
        let mut registration = ContrastRegistration::new(&problem, 1, 0.0);
        registration.uncertainty(&problem, &Similarity::identity()).unwrap().uncertainty.rotation_degrees
    }

    #[test]
    fn a_silhouette_that_does_not_fit_widens_sigmas() {
        let views = views(&texture(9, 0.03, TEXTURE_BLUR));
        let mask = &views.0.mask;
        // Four pixels are cut off the mask on two sides, but not off the image. Their effects cancel.
        let cut = |index: usize| (index % SIDE).abs_diff(SIDE / 2) > 22;
        let frayed: Vec<bool> = (0..mask.len()).map(|index| mask[index] && !cut(index)).collect();
        let [clean, frayed] = [mask, &frayed].map(|object| sigmas(&views, object));
        for axis in 0..3 {
            assert!(frayed[axis] > clean[axis], "{clean:?} {frayed:?}");
        }
        assert!(frayed.iter().sum::<f64>() > 1.2 * clean.iter().sum::<f64>(), "{clean:?} {frayed:?}");
    }

    #[test]
    fn a_cloud_that_shrinks_onto_bare_albedo_ranks_behind_one_that_shading_explains() {
        let (centre, bare) = ((SIDE - 1) as f64 / 2.0, 13.0);
        // Shading and soft albedo, except for a label in the middle with hardly any contrast.
        let (mut image, depth) = views(&texture(7, 0.12, TEXTURE_BLUR));
        let grain = texture(8, 0.004, TEXTURE_BLUR);
        for (index, grain) in grain.iter().enumerate() {
            let [x, y] = [index % SIDE, index / SIDE].map(|place| place as f64 - centre);
            if x * x + y * y < bare * bare {
                image.log.iter_mut().for_each(|log| log[index] = *grain as f32 - 1.0);
            }
        }
        let normal_error = vec![0.0; depth.size.len()];
        let problem =
            ContrastProblem { scale_is_held: true, ..ContrastProblem::of_views(&image, &depth, &normal_error) };
        let truth = Similarity::identity();
        let shrunk = truth.turned_about(depth.points.centroid(), 0.4, truth.rotation);
        let mut registration = ContrastRegistration::new(&problem, 1, 0.0);
        let [by_truth, by_shrunk] = [truth, shrunk].map(|pose| {
            let value = registration.evaluate(&problem, &pose, 0.05).unwrap();
            [value, registration.rank(&problem, &pose, 0.05).unwrap()]
        });
        assert!(by_shrunk[0] < by_truth[0], "no temptation: {by_shrunk:?} {by_truth:?}");
        assert!(by_truth[1] + 0.1 < by_shrunk[1], "{by_truth:?} {by_shrunk:?}");
    }

    /// Share of the contrast that shading leaves at the true pose, with normals of this much noise about each axis.
    fn share_left(noise: f64, blur: f64) -> f64 {
        let (image, depth) = views(&[0.0; SIDE * SIDE]);
        let mut dice = noise::white_noise(11);
        let mut normals = depth.normals.clone();
        for (x, (y, z)) in normals.x.iter_mut().zip(normals.y.iter_mut().zip(&mut normals.z)) {
            let noisy = Vector3::new(*x, *y, *z).map(|part| f64::from(part) + noise * dice()).normalize();
            [*x, *y, *z] = noisy.map(|part| part as f32).into();
        }
        let normal_error = vec![0.0; depth.size.len()];
        let problem = ContrastProblem { normals: &normals, ..ContrastProblem::of_views(&image, &depth, &normal_error) };
        ContrastRegistration::new(&problem, 1, blur).rank(&problem, &Similarity::identity(), 0.05).unwrap()
    }

    #[test]
    fn an_image_as_soft_as_noisy_normals_are_is_explained_by_them() {
        let [sharp, soft] = [0.0, 1.0].map(|blur| share_left(0.2, blur));
        assert!(soft < 0.7 * sharp, "{soft} instead of {sharp}");
    }
}
