//! Detects a distortion of the colour camera that was left out: with some radial term, depth edges lie much nearer to
//! image edges than without any.
//!
//! Only cameras without distortion are examined. A pose is registered for each of a few terms k1, and the mean log
//! likelihoods of the depth discontinuities are compared.

use super::planes::Planes;
use super::registration::{Round, Scene, Start};
use crate::view::Lens;

/// Terms k1 that are tried. The smallest move the corner of a common image by ten pixels, and the largest belong to
/// wide lenses.
const TERMS: [f64; 6] = [-0.3, -0.15, -0.06, 0.06, 0.15, 0.3];
/// Windows of edges, sigma in pixels of an image 640 wide. The first ones are wide, because a lens and its pose move
/// together.
const SIGMAS: [f64; 3] = [5.0, 2.5, 1.3];
/// Smallest gain in the mean log likelihood of a depth discontinuity for which a lens is reported: six times
/// `SCORE_PRIOR`, the value of one sigma of the prior. A silhouette that fits badly fits some lens better, so small
/// objects without distortion may exceed it as well (docs/lab/thresholds.md).
pub(super) const GAIN: f64 = 0.06;

/// One in this many trials goes on to the next level of registration.
const ONE_IN: usize = 3;

/// A registration behind a lens with one radial term.
struct Trial {
    term: f64,
    start: Start,
}

/// The term k1 that fits the edges clearly better than a camera without distortion.
pub(super) fn left_out(scene: &mut Scene, round: &Round) -> Option<f64> {
    if scene.frames.iter().any(|frame| frame.camera.lens != Lens::None) {
        return None;
    }
    // From the estimate and from the initial pose, because a missing lens biases the estimate.
    let rounds = [*round, Round { state: round.initial, ..*round }];
    let trials_of = |term: f64| rounds.map(|round| Trial { term, start: Start::at(round) });
    let (mut without, mut trials) = (trials_of(0.0), TERMS.into_iter().flat_map(trials_of).collect::<Vec<_>>());
    for sigma in SIGMAS.map(|sigma| sigma * scene.scale) {
        let planes = scene.planes(sigma);
        without.iter_mut().chain(&mut trials).for_each(|trial| trial.register(scene, sigma, &planes));
        trials.sort_by(|a, b| b.start.score.total_cmp(&a.start.score));
        trials.truncate(trials.len().div_ceil(ONE_IN));
    }
    let best = trials.first()?;
    let score = without.iter().map(|trial| trial.start.score).fold(f64::NEG_INFINITY, f64::max);
    (best.start.score > score + GAIN).then_some(best.term)
}

impl Trial {
    /// Registers the pose by its edges at one level, behind this lens.
    fn register(&mut self, scene: &mut Scene, sigma: f64, planes: &[Planes]) {
        let lens =
            if self.term == 0.0 { Lens::None } else { Lens::Brown([self.term, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) };
        scene.frames.iter_mut().for_each(|frame| frame.camera.lens = lens);
        scene.find_anew(&mut self.start);
        scene.approach(&mut self.start, sigma, planes);
        scene.frames.iter_mut().for_each(|frame| frame.camera.lens = Lens::None);
    }
}
