//! Whether the colour camera's distortion was left out: some radial term then brings depth edges much nearer to image
//! edges than none does.
//!
//! Only a camera that came without any is asked. A few terms k1 are tried, each with a pose of its own, and the mean log
//! likelihoods of their rims compared.

use super::planes::Planes;
use super::registration::{MOST_RIMS_OF_STARTS, Round, Scene, Start};
use crate::view::Lens;

/// Terms that are tried: from what moves a usual image's corner by ten pixels to a wide lens.
const TERMS: [f64; 6] = [-0.3, -0.15, -0.06, 0.06, 0.15, 0.3];
/// Windows of edges, sigma in pixels of an image 640 wide: wide ones first, as a lens and its pose move together.
const SIGMAS: [f64; 3] = [5.0, 2.5, 1.3];
/// Mean log likelihood of a rim that a lens has to gain: six times what a sigma of the prior is worth. One rig of boxes
/// without its lens of k1 = -0.08 passes it, and so do four or five of 13 captures of small objects without any: outlines that do not
/// fit anyhow fit some lens better. That tiles agree by three of their sigmas was tried, and lost the boxes.
const GAIN: f64 = 0.06;

/// The term k1 that explains the edges better than a camera without distortion.
pub(super) fn left_out(scene: &mut Scene, round: &Round) -> Option<f64> {
    if scene.frames.iter().any(|frame| frame.camera.lens != Lens::None) {
        return None;
    }
    let planes: Vec<Vec<Planes>> = SIGMAS.iter().map(|sigma| scene.planes(sigma * scene.scale)).collect();
    let without = score(scene, round, Lens::None, &planes);
    let scores = TERMS.map(|term| score(scene, round, Lens::Brown([term, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]), &planes));
    let best = (0..TERMS.len()).max_by(|&a, &b| scores[a].total_cmp(&scores[b]))?;
    (scores[best] > without + GAIN).then_some(TERMS[best])
}

/// From the estimate, or from what was told if that ends better: a lens that is left out leads the estimate astray.
fn score(scene: &mut Scene, round: &Round, lens: Lens, planes: &[Vec<Planes>]) -> f64 {
    let told = Round { state: round.told, ..*round };
    score_from(scene, round, lens, planes).max(score_from(scene, &told, lens, planes))
}

fn score_from(scene: &mut Scene, round: &Round, lens: Lens, planes: &[Vec<Planes>]) -> f64 {
    scene.frames.iter_mut().for_each(|frame| frame.camera.lens = lens);
    let mut start = Start { round: *round, found: round.state, rims: vec![], score: 0.0 };
    for (sigma, planes) in SIGMAS.iter().zip(planes) {
        start.found = start.round.state;
        start.rims = scene.rims(&start.found, MOST_RIMS_OF_STARTS);
        scene.approach(&mut start, sigma * scene.scale, planes);
    }
    scene.frames.iter_mut().for_each(|frame| frame.camera.lens = Lens::None);
    start.score
}
