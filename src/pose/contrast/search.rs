//! From many starts to one pose and its rivals, coarse to fine, in slices: few samples and rounds for all of them, then
//! more for the best, at last by as many as there are.
//!
//! At each stage the ends are ranked by E on the sharp image at one robust scale, the contrast's part of it as a share of
//! what there is without light, so that they can be compared. On ten photographed objects seen from 0 to 60 degrees off an
//! end near the right one was among the first eight after the first stages wherever it was found at all. Noisy depth tells no
//! details that the sharp image could be compared with: there both are blurred as widely as the noise asks for, and the best
//! end alone is registered on the sharp image.

use super::problem::{ContrastProblem, ContrastReport};
use super::registration::{ContrastEffort, ContrastRegistration};
use crate::numeric::sort_descending;
use crate::pose::similarity::Similarity;

/// A stage: samples, what a registration may take, how many ends go on and how far apart they are, degrees.
struct Stage {
    samples: f64,
    effort: ContrastEffort,
    kept: usize,
    apart: f64,
}

const STAGES: [Stage; 4] = [
    Stage { samples: 350.0, effort: ContrastEffort { rounds: 1, ..ContrastEffort::COARSE }, kept: 48, apart: 6.0 },
    Stage { samples: 350.0, effort: ContrastEffort::COARSE, kept: 12, apart: 6.0 },
    Stage {
        samples: 1400.0,
        effort: ContrastEffort { rounds: 5, instrument_rounds: 6, ..ContrastEffort::FULL },
        kept: 6,
        apart: RIVAL_APART,
    },
    LAST,
];
const LAST: Stage = Stage {
    samples: 10_000.0,
    effort: ContrastEffort { first_level: 0, rounds: 6, instrument_rounds: 20, ..ContrastEffort::FULL },
    kept: 6,
    apart: RIVAL_APART,
};
/// Noise, in log units, whose robust scale ends are ranked at: sharper than photographs leave, so that the details
/// decide, and far above that of renders.
const RANKING_NOISE: f64 = 0.05;
/// An end whose rank is larger by less than this is a rival: 0.03 of E, by which found poses of photographs had none but for
/// one or two and lost ones mostly one, over a contrast of 0.3 without light.
const RIVAL_MARGIN: f64 = 0.1;
/// A rival is at least so far away, degrees.
const RIVAL_APART: f64 = 3.0;
/// Ends of one rotation and unlike sizes are two: so much in log size, half a step between the sizes of the starts. A wrong
/// size that looks better at first would hide the right one.
const SIZE_APART: f64 = 0.1;

/// An end of a registration with its rank.
type End = (f64, Similarity);

/// The pose found and those that E hardly tells from it, best first.
#[derive(Clone, Debug)]
pub struct ContrastOutcome {
    /// The best end.
    pub best: ContrastReport,
    /// Poses that explain the contrast as well.
    pub rivals: Vec<Similarity>,
}

/// The search in slices; owns its memory.
pub struct ContrastSearch {
    stage: usize,
    starts: Vec<Similarity>,
    next: usize,
    ends: Vec<End>,
    registration: ContrastRegistration,
    under_way: bool,
}

impl ContrastSearch {
    /// From these starts.
    #[must_use]
    pub fn new(problem: &ContrastProblem<'_>, starts: Vec<Similarity>) -> Self {
        let registration = registration(problem, &STAGES[0], problem.depth.noise.window());
        Self { stage: 0, starts, next: 0, ends: Vec::new(), registration, under_way: false }
    }

    /// One round of one registration; whether all are done.
    pub fn advance(&mut self, problem: &ContrastProblem<'_>) -> bool {
        let Some(stage) = STAGES.get(self.stage) else { return true };
        let Some(start) = self.starts.get(self.next) else {
            self.begin_next_stage(problem, stage);
            return self.stage >= STAGES.len();
        };
        if !self.under_way {
            self.registration.begin(problem, start, stage.effort);
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

    /// Share of the work that is done, more or less.
    #[must_use]
    pub fn share(&self) -> f64 {
        let within = self.next as f64 / self.starts.len().max(1) as f64;
        ((self.stage as f64 + within) / STAGES.len() as f64).min(1.0)
    }

    fn begin_next_stage(&mut self, problem: &ContrastProblem<'_>, done: &Stage) {
        sort_descending(&mut self.ends, |(value, _)| -value);
        let mut kept: Vec<End> = Vec::with_capacity(done.kept);
        for end in &self.ends {
            let is_apart = |(_, other): &End| {
                other.degrees_to(&end.1) >= done.apart || (other.scale / end.1.scale).ln().abs() > SIZE_APART
            };
            if kept.len() < done.kept && kept.iter().all(is_apart) {
                kept.push(*end);
            }
        }
        self.stage += 1;
        if let Some(stage) = STAGES.get(self.stage) {
            self.registration = registration(problem, stage, problem.depth.noise.window());
            self.starts = kept.iter().map(|(_, pose)| *pose).collect();
            (self.next, self.ends) = (0, Vec::new());
        } else {
            self.ends = kept;
        }
    }

    /// Whether another pose explains the contrast as well as the best end.
    pub fn is_explained_by(&mut self, problem: &ContrastProblem<'_>, pose: &Similarity) -> bool {
        let value = self.registration.rank(problem, pose, RANKING_NOISE);
        self.ends.first().is_some_and(|(best, _)| value.is_some_and(|value| value <= best + RIVAL_MARGIN))
    }

    /// What was found, once all is done; `None` where no registration saw enough of the object.
    pub fn outcome(&mut self, problem: &ContrastProblem<'_>) -> Option<ContrastOutcome> {
        let &(value, mut pose) = self.ends.first()?;
        let is_rival = |end: &&End| end.0 <= value + RIVAL_MARGIN && end.1.degrees_to(&pose) >= RIVAL_APART;
        let rivals = self.ends[1..].iter().filter(is_rival).map(|(_, pose)| *pose).collect();
        if problem.depth.noise.window() > 0.0 {
            self.registration = registration(problem, &LAST, 0.0);
            // Further off it has slid into another optimum.
            let end = registered(&mut self.registration, problem, &pose);
            pose = end.filter(|end| end.degrees_to(&pose) <= RIVAL_APART).unwrap_or(pose);
            self.ends[0] = (self.registration.rank(problem, &pose, RANKING_NOISE)?, pose);
        }
        let objective = self.registration.evaluate(problem, &pose, RANKING_NOISE)?;
        let uncertainty = self.registration.uncertainty(problem, &pose)?;
        Some(ContrastOutcome { best: ContrastReport { pose, objective, uncertainty }, rivals })
    }
}

/// Registers from `start`, which is near the end already, as the last stage of the search does, by another version of the image; the
/// pose and its E.
#[must_use]
pub fn settle(problem: &ContrastProblem<'_>, start: &Similarity) -> Option<(Similarity, f64)> {
    let mut registration = registration(problem, &LAST, 0.0);
    let pose = registered(&mut registration, problem, start)?;
    Some((pose, registration.evaluate(problem, &pose, RANKING_NOISE)?))
}

/// The end of the last stage's registration from `start`.
fn registered(
    registration: &mut ContrastRegistration,
    problem: &ContrastProblem<'_>,
    start: &Similarity,
) -> Option<Similarity> {
    registration.begin(problem, start, LAST.effort);
    while !registration.step(problem) {}
    registration.pose()
}

/// The registration of a stage: by about so many samples, blurred by so many pixels on the finest level.
fn registration(problem: &ContrastProblem<'_>, stage: &Stage, blur: f64) -> ContrastRegistration {
    let stride = (problem.depth.valid() as f64 / stage.samples).sqrt().round();
    ContrastRegistration::new(problem, stride as usize, blur)
}
