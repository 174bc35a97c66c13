//! Ascent of a hypothesis to the local maximum of its score: coordinate search over rotation and size with halved
//! steps.

use nalgebra::Vector3;

use super::hypothesis::Hypothesis;
use super::matcher::Matcher;

/// Steps of the rotation in degrees, one for each round.
const ROTATION_STEPS: [f64; 2] = [8.0, 4.0];
/// Corresponding steps of the size, natural logarithm.
const GROWTH_STEPS: [f64; 2] = [0.07, 0.035];

/// The local maximum near `start`, over three rotations and, if it varies, the size. Each round tries one step to
/// either side along every unknown, then the vertex of the parabolas through these scores.
pub fn ascend(matcher: &mut Matcher, start: Hypothesis, size_varies: bool) -> Hypothesis {
    let mut best = start;
    for steps in ROTATION_STEPS.into_iter().zip(GROWTH_STEPS) {
        let centre = best;
        let mut vertex = [0.0; 4];
        let unknowns = if size_varies { 4 } else { 3 };
        for (axis, vertex) in vertex.iter_mut().enumerate().take(unknowns) {
            let mut scores = [0.0; 2];
            for (score, sign) in scores.iter_mut().zip([-1.0, 1.0]) {
                let mut step = [0.0; 4];
                step[axis] = sign;
                let tried = matcher.best_shift_nearby(moved(&centre, step, steps));
                *score = tried.score;
                best = best.better(tried);
            }
            *vertex = peak(scores[0], centre.score, scores[1]);
        }
        best = best.better(matcher.best_shift_nearby(moved(&centre, vertex, steps)));
    }
    best
}

/// The hypothesis after these numbers of steps of rotation about x, y and z, and of growth.
fn moved(hypothesis: &Hypothesis, [x, y, z, grown]: [f64; 4], (degrees, growth): (f64, f64)) -> Hypothesis {
    hypothesis.moved(Vector3::new(x, y, z) * degrees.to_radians(), grown * growth)
}

/// Position of the maximum of the parabola through scores at -1, 0 and 1, clamped to these bounds.
fn peak(before: f64, here: f64, after: f64) -> f64 {
    let bend = before - 2.0 * here + after;
    if bend < 0.0 && bend.is_finite() {
        return (0.5 * (before - after) / bend).clamp(-1.0, 1.0);
    }
    if after > before { 1.0 } else { -1.0 }
}
