//! Search from many initial poses to one pose and its rivals, coarse to fine, in slices. All begin with few samples and
//! rounds. The best get more, and the last stages use up to 10000 samples.
//!
//! At each stage the ends are ranked by E on the sharp image at one robust scale, with the contrast term relative to
//! that without light, so that they are comparable. Noisy depth has no details to compare with the sharp image. The
//! stages then blur image and prediction by the sigma that the noise requires. In an additional stage only the best end
//! is registered to the sharp image.

use super::problem::{ContrastProblem, ContrastReport};
use super::registration::{ContrastEffort, ContrastRegistration};
use super::uncertainty::PoseCovariance;
use crate::pose::similarity::Similarity;

/// A stage: number of samples, limits of a registration, number of ends that go on, and their least distance in
/// degrees.
struct Stage {
    samples: f64,
    effort: ContrastEffort,
    kept: usize,
    apart: f64,
}

const STAGES: [Stage; 5] = [
    Stage { samples: 350.0, effort: ContrastEffort { rounds: 1, ..ContrastEffort::COARSE }, kept: 48, apart: 6.0 },
    Stage { samples: 350.0, effort: ContrastEffort::COARSE, kept: 12, apart: 6.0 },
    Stage {
        samples: 1400.0,
        effort: ContrastEffort { rounds: 5, instrument_rounds: 6, ..ContrastEffort::FULL },
        kept: 6,
        apart: RIVAL_APART,
    },
    LAST,
    LAST,
];
/// The last stage registers to the sharp image if noisy depth required blurring; the one before it finds the rivals.
const SHARP_STAGE: usize = STAGES.len() - 1;
const LAST: Stage = Stage {
    samples: 10_000.0,
    effort: ContrastEffort { first_level: 0, rounds: 6, instrument_rounds: 20, ..ContrastEffort::FULL },
    kept: 6,
    apart: RIVAL_APART,
};
/// Noise, in log units, whose robust scale ranks the ends. It is below the residuals of photographs, so that details
/// decide, and far above those of renders.
const RANKING_NOISE: f64 = 0.05;
/// An end whose rank exceeds the lowest one by less than this is a rival (docs/lab/thresholds.md).
const RIVAL_MARGIN: f64 = 0.1;
/// Smallest distance of a rival, degrees.
const RIVAL_APART: f64 = 3.0;
/// Two ends with the same rotation are both kept if their log sizes differ by more than this, half a step between the
/// initial sizes. Otherwise a wrong size that ranks better at first would hide the right one.
const SIZE_APART: f64 = 0.1;

/// An end of a registration, with its rank.
type End = (f64, Similarity);

/// The best pose, and those that E hardly distinguishes from it, best first.
#[derive(Clone, Debug)]
pub struct ContrastOutcome {
    /// The best end.
    pub best: ContrastReport,
    /// Poses that fit the contrast equally well.
    pub rivals: Vec<Similarity>,
}

/// The search in slices; owns its memory.
pub struct ContrastSearch {
    stage: usize,
    starts: Vec<Similarity>,
    next: usize,
    ends: Vec<End>,
    rivals: Vec<Similarity>,
    registration: ContrastRegistration,
    under_way: bool,
}

impl ContrastSearch {
    /// A search from these initial poses.
    #[must_use]
    pub fn new(problem: &ContrastProblem<'_>, starts: Vec<Similarity>) -> Self {
        let registration = registration(problem, &STAGES[0], problem.depth.noise.window());
        Self { stage: 0, starts, next: 0, ends: Vec::new(), rivals: Vec::new(), registration, under_way: false }
    }

    /// Runs one round of one registration. Returns whether all are done.
    pub fn advance(&mut self, problem: &ContrastProblem<'_>) -> bool {
        let Some(stage) = STAGES.get(self.stage) else { return true };
        let Some(start) = self.starts.get(self.next) else {
            self.begin_next_stage(problem, stage);
            return self.stage >= STAGES.len();
        };
        if !self.under_way {
            self.registration.begin(start, stage.effort);
            self.under_way = true;
        }
        if self.registration.step(problem) {
            let pose = self.registration.pose();
            let end = pose.and_then(|pose| Some((self.registration.rank(problem, &pose, RANKING_NOISE)?, pose)));
            self.ends.extend(end.filter(|(value, _)| value.is_finite()));
            (self.next, self.under_way) = (self.next + 1, false);
        }
        false
    }

    /// Approximate share of the work that is done.
    #[must_use]
    pub fn share(&self) -> f64 {
        let within = self.next as f64 / self.starts.len().max(1) as f64;
        // The sharp stage, if any, is a single registration, hardly any work beside the others.
        ((self.stage as f64 + within) / SHARP_STAGE as f64).min(1.0)
    }

    fn begin_next_stage(&mut self, problem: &ContrastProblem<'_>, done: &Stage) {
        if self.stage == SHARP_STAGE {
            self.stay_near(problem);
        }
        let mut kept = best_apart(std::mem::take(&mut self.ends), done);
        self.stage += 1;
        let window = problem.depth.noise.window();
        if self.stage == SHARP_STAGE {
            self.rivals = rivals(&kept);
            kept.truncate(1);
            self.stage += usize::from(window == 0.0);
        }
        let Some(stage) = STAGES.get(self.stage) else {
            self.ends = kept;
            return;
        };
        self.registration = registration(problem, stage, if self.stage == SHARP_STAGE { 0.0 } else { window });
        self.starts = kept.iter().map(|(_, pose)| *pose).collect();
        self.next = 0;
    }

    /// Keeps the initial pose of the sharp stage if the end of the stage is as far away as a rival, because the
    /// registration then slid into another optimum.
    fn stay_near(&mut self, problem: &ContrastProblem<'_>) {
        let Some(&start) = self.starts.first() else { return };
        self.ends.retain(|(_, end)| end.degrees_to(&start) <= RIVAL_APART);
        if self.ends.is_empty() {
            self.ends.extend(self.registration.rank(problem, &start, RANKING_NOISE).map(|value| (value, start)));
        }
    }

    /// Whether another pose fits the contrast as well as the best end.
    pub fn is_explained_by(&mut self, problem: &ContrastProblem<'_>, pose: &Similarity) -> bool {
        let value = self.registration.rank(problem, pose, RANKING_NOISE);
        self.ends.first().is_some_and(|(best, _)| value.is_some_and(|value| value <= best + RIVAL_MARGIN))
    }

    /// The result, once all is done; `None` if no registration saw enough of the object.
    pub fn outcome(&mut self, problem: &ContrastProblem<'_>) -> Option<ContrastOutcome> {
        let &(_, pose) = self.ends.first()?;
        let objective = self.registration.evaluate(problem, &pose, RANKING_NOISE)?;
        let PoseCovariance { uncertainty, covariance, frame } = self.registration.uncertainty(problem, &pose)?;
        let best = ContrastReport { pose, objective, uncertainty, covariance, frame };
        Some(ContrastOutcome { best, rivals: self.rivals.clone() })
    }
}

/// Registers to another version of the image from `start`, which is already close, as the last stage of the search
/// does. Returns the pose and its E.
#[must_use]
pub fn register_again(problem: &ContrastProblem<'_>, start: &Similarity) -> Option<(Similarity, f64)> {
    let mut registration = registration(problem, &LAST, 0.0);
    registration.begin(start, LAST.effort);
    while !registration.step(problem) {}
    let pose = registration.pose()?;
    Some((pose, registration.evaluate(problem, &pose, RANKING_NOISE)?))
}

/// The best ends of a stage, best first, without duplicates.
fn best_apart(mut ends: Vec<End>, stage: &Stage) -> Vec<End> {
    ends.sort_by(|(a, _), (b, _)| a.total_cmp(b));
    let mut kept: Vec<End> = Vec::with_capacity(stage.kept);
    for end in ends {
        let is_apart = |(_, other): &End| {
            other.degrees_to(&end.1) >= stage.apart || (other.scale / end.1.scale).ln().abs() > SIZE_APART
        };
        if kept.len() < stage.kept && kept.iter().all(is_apart) {
            kept.push(end);
        }
    }
    kept
}

/// Ends that fit the contrast as well as the first one and do not belong to its optimum.
fn rivals(ends: &[End]) -> Vec<Similarity> {
    let Some((&(value, pose), others)) = ends.split_first() else { return Vec::new() };
    let is_rival = |end: &&End| end.0 <= value + RIVAL_MARGIN && end.1.degrees_to(&pose) >= RIVAL_APART;
    others.iter().filter(is_rival).map(|(_, pose)| *pose).collect()
}

/// The registration of a stage: by about `stage.samples` samples, blurred by `blur` depth pixels on the finest level.
fn registration(problem: &ContrastProblem<'_>, stage: &Stage, blur: f64) -> ContrastRegistration {
    let stride = (problem.depth.valid() as f64 / stage.samples).sqrt().round();
    ContrastRegistration::new(problem, stride as usize, blur)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::*;
    use crate::pose::Angles;
    use crate::scenes::{SampleRequest, Scene, light, surface};
    use crate::view::{ColourView, DepthView, Size};

    #[test]
    fn by_noisy_depth_the_end_is_that_of_the_sharp_image() {
        let request = SampleRequest {
            light: light("window").unwrap(),
            size: Size { width: 80, height: 80 },
            rotation: Angles { beta: 20.0, ..Angles::default() }.rotation(),
            noise: 0.01,
            depth_noise: 0.4,
            ..SampleRequest::default()
        };
        let sample = Scene::new(&surface("bust").unwrap()).unwrap().sample(&request).unwrap();
        let image = ColourView::new(sample.colour_image()).unwrap();
        let depth = DepthView::new(&sample.depth_map(), true).unwrap();
        let normal_error = vec![0.0; depth.size.len()];
        let problem =
            ContrastProblem { scale_is_held: true, ..ContrastProblem::of_views(&image, &depth, &normal_error) };
        let turned = |off: f64| {
            let turn = Rotation3::new(Vector3::new(off, -off, 0.5 * off)).into_inner();
            sample.pose.turned_about(depth.points.centroid(), 1.0, turn * sample.pose.rotation)
        };
        let mut search = ContrastSearch::new(&problem, [-0.2, 0.05, 0.1, 0.3].map(turned).to_vec());
        while !search.advance(&problem) {}
        let found = search.outcome(&problem).unwrap().best.pose;
        let [from_sharp, from_soft] = [0.0, depth.noise.window()].map(|blur| {
            let mut registration = registration(&problem, &LAST, blur);
            registration.begin(&found, LAST.effort);
            while !registration.step(&problem) {}
            registration.pose().unwrap().degrees_to(&found)
        });
        assert!(from_sharp < 0.2 * from_soft, "{from_sharp} instead of {from_soft}");
        assert!(found.degrees_to(&sample.pose) < RIVAL_APART, "{found:?}");
    }
}
