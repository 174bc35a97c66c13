//! Detects a distortion of the colour camera that was left out: with some radial term, depth edges lie much nearer to
//! image edges than without any.
//!
//! Only cameras without distortion are examined. A pose is registered for each of a few terms k1. The best term on a blurred
//! image is compared with none, by the mean log likelihoods of the depth discontinuities.

use super::planes::Planes;
use super::registration::{Round, Scene};
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

/// The term k1 that fits the edges clearly better than a camera without distortion.
pub(super) fn left_out(scene: &mut Scene, round: &Round) -> Option<f64> {
    if scene.frames.iter().any(|frame| frame.camera.lens != Lens::None) {
        return None;
    }
    let planes: Vec<Vec<Planes>> = SIGMAS.iter().map(|sigma| scene.planes(sigma * scene.scale)).collect();
    // Wide windows choose the term.
    let rough = TERMS.map(|term| score(scene, round, term, &planes[..1]));
    let best = TERMS[(0..TERMS.len()).max_by(|&a, &b| rough[a].total_cmp(&rough[b]))?];
    (score(scene, round, best, &planes) > score(scene, round, 0.0, &planes) + GAIN).then_some(best)
}

/// The better score of two registrations, from the estimate and from the initial pose, because a missing lens biases
/// the estimate. The registrations have as many levels as there are `planes`.
fn score(scene: &mut Scene, round: &Round, term: f64, planes: &[Vec<Planes>]) -> f64 {
    let lens = Lens::brown(&[term, 0.0, 0.0, 0.0]).unwrap_or(Lens::None);
    let initial = Round { state: round.initial, ..*round };
    score_from(scene, round, lens, planes).max(score_from(scene, &initial, lens, planes))
}

fn score_from(scene: &mut Scene, round: &Round, lens: Lens, planes: &[Vec<Planes>]) -> f64 {
    scene.frames.iter_mut().for_each(|frame| frame.camera.lens = lens);
    let score = scene.registered(*round, &SIGMAS, planes).score;
    scene.frames.iter_mut().for_each(|frame| frame.camera.lens = Lens::None);
    score
}
