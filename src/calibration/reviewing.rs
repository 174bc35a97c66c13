//! The search over other readings of the views, for a candidate that does not pass: first over those that the input itself
//! suggests, and after the conventions of poses over the others.
//!
//! In each reading the candidate is registered by its edges, level by level. The reading with the best mean log
//! likelihood of a depth discontinuity is taken if it is better than the estimate with the views as they are, clearly
//! and significantly: in a sparse map a few edges change the mean. Its frames then replace those of the check, and the
//! candidate is refined in them with all cues.

use super::cue::Cue;
use super::distortion::GAIN;
use super::frame::Frame;
use super::optima::{SIGNIFICANT, scatter};
use super::planes::Planes;
use super::readings::Reading;
use super::registration::{ARRIVED, Kept, MOST_SETTLING, Round, SIGMAS, Scene};
use super::unknowns::State;

/// Maximum number of frames in which readings are compared. All frames of a rig are stored alike.
const MOST_FRAMES: usize = 2;

/// The readings under way.
pub(super) struct Reviewing {
    readings: &'static [Reading],
    /// Frames as they are.
    frames: Vec<Frame>,
    /// Their images, blurred for each level.
    planes: Vec<Vec<Planes>>,
    candidate: State,
    /// Index of the next reading.
    index: usize,
    /// The fit of the estimate.
    own: EdgeFit,
    /// The best reading so far, and its score.
    best: Option<(f64, Reading)>,
    /// The candidate in the frames of the best reading, after all have been compared.
    refining: Option<Refining>,
}

/// All frames in another reading, and the candidate under refinement in them.
pub(super) struct Refining {
    pub reading: Reading,
    pub scene: Scene,
    pub round: Round,
    pub planes: Vec<Planes>,
    kept: Option<Kept>,
    done: usize,
}

impl Reviewing {
    pub fn new(readings: &'static [Reading], scene: &Scene, candidate: &State, estimate: &Round) -> Self {
        let frames = scene.frames[..scene.frames.len().min(MOST_FRAMES)].to_vec();
        let given = of_edges(frames.clone(), scene);
        let planes: Vec<Vec<Planes>> = SIGMAS.iter().map(|sigma| given.planes(sigma * scene.scale)).collect();
        let [of_estimate, of_candidate] = [&estimate.state, candidate].map(|state| EdgeFit::of(&given, state, &planes));
        let own = if of_candidate.score > of_estimate.score { of_candidate } else { of_estimate };
        Self { readings, frames, planes, candidate: *candidate, index: 0, own, best: None, refining: None }
    }

    /// Compares one reading, or refines the candidate in the best one by a round. Returns whether the search is over.
    pub fn step(&mut self, scene: &Scene) -> bool {
        if let Some(refining) = &mut self.refining {
            return refining.step();
        }
        if let Some(reading) = self.readings.get(self.index) {
            self.compare(*reading, scene);
            self.index += 1;
            return false;
        }
        self.refining = self.best.and_then(|(_, reading)| Refining::new(reading, scene, &self.candidate));
        self.refining.is_none()
    }

    /// The frames of the best reading, and the candidate refined in them; `None` if no reading is clearly better.
    pub fn end(self) -> Option<Refining> {
        self.refining
    }

    fn compare(&mut self, reading: Reading, scene: &Scene) {
        let frames: Option<Vec<Frame>> = self.frames.iter().map(|frame| reading.frame(frame)).collect();
        let Some(frames) = frames else { return };
        let read = of_edges(frames, scene);
        if !read.is_seen(&self.candidate) {
            return;
        }
        let planes: Vec<Vec<Planes>> =
            self.planes.iter().map(|level| level.iter().map(|planes| reading.planes(planes)).collect()).collect();
        let fit = EdgeFit::of(&read, &self.candidate, &planes);
        if fit.is_clearly_better(&self.own) && self.best.is_none_or(|(score, _)| fit.score > score) {
            self.best = Some((fit.score, reading));
        }
    }
}

impl Refining {
    fn new(reading: Reading, scene: &Scene, candidate: &State) -> Option<Self> {
        let frames: Option<Vec<Frame>> = scene.frames.iter().map(|frame| reading.frame(frame)).collect();
        let read = Scene::new(frames?, scene.cues.clone(), scene.focal_is_free);
        let mut start = read.start(*candidate, *candidate);
        let mut planes = vec![];
        for sigma in SIGMAS {
            planes = read.planes(sigma * read.scale);
            read.find_anew(&mut start);
            read.approach(&mut start, sigma * read.scale, &planes);
        }
        Some(Self { reading, scene: read, round: start.round, planes, kept: None, done: 0 })
    }

    fn step(&mut self) -> bool {
        self.done += 1;
        self.scene.settle(&mut self.round, &mut self.kept, &self.planes) < ARRIVED || self.done == MOST_SETTLING
    }
}

/// A scene of these frames in which only edges are compared.
fn of_edges(frames: Vec<Frame>, scene: &Scene) -> Scene {
    Scene::new(frames, vec![Cue::Edges], scene.focal_is_free)
}

/// How well the edges fit at the end of a registration.
struct EdgeFit {
    /// Mean log likelihood of a depth discontinuity.
    score: f64,
    /// The share of each tile in this mean.
    by_tile: Vec<f64>,
}

impl EdgeFit {
    fn of(scene: &Scene, from: &State, planes: &[Vec<Planes>]) -> Self {
        let start = scene.registered(Round { seen_from: *from, ..Round::from(*from, *from) }, &SIGMAS, planes);
        let by_tile = planes.last().map_or(vec![], |finest| scene.mean_by_tile(&start, finest));
        Self { score: start.score, by_tile }
    }

    fn is_clearly_better(&self, other: &Self) -> bool {
        self.score - other.score > GAIN.max(SIGNIFICANT * scatter(&self.by_tile, &other.by_tile))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reading_is_clearly_better_only_if_most_tiles_agree() {
        let fit = |by_tile: Vec<f64>| EdgeFit { score: by_tile.iter().sum(), by_tile };
        let own = fit(vec![0.1; 10]);
        assert!(fit(vec![0.11; 10]).is_clearly_better(&own));
        assert!(!fit(vec![0.105; 10]).is_clearly_better(&own), "a gain of .05");
        // One tile gains .2, the others nothing or a little less.
        let few: Vec<f64> =
            (0..10).map(|tile| if tile == 0 { 0.3 } else { 0.09 + 0.02 * f64::from(tile % 2) }).collect();
        assert!(!fit(few).is_clearly_better(&own));
    }
}
