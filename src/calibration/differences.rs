//! Finite differences of log likelihoods that are evaluated tile by tile.

use std::ops::Range;

use super::evidence::{Share, positive};
use super::unknowns::{Matrix, POSE, State, Units, Vector};

/// Step in pixels, wide compared with the raster and narrow enough for a curvature.
const STEP: f64 = 1.0;

/// The log likelihoods of some cues at a state and around it: the tiles of one cue after the other.
struct Around {
    middle: Vec<f64>,
    up: Vec<Vec<f64>>,
    down: Vec<Vec<f64>>,
}

/// Values and gradients of the tiles of each cue. Each used tile gets an equal part of the total curvature, because the
/// curvature of a single tile is too uncertain. `curvatures` are those of the cues at a state near this one; an empty list
/// is filled, which takes most of the time.
pub(super) fn differences(
    units: &Units,
    state: &State,
    tiles: usize,
    curvatures: &mut Vec<Matrix>,
    evaluate: impl Fn(&State) -> Vec<f64>,
) -> Vec<Vec<Share>> {
    let at = |moves: &[(usize, f64)]| {
        let mut step = Vector::zeros();
        moves.iter().for_each(|&(k, by)| step[k] += by);
        evaluate(&units.step(state, &step))
    };
    let around = Around {
        middle: at(&[]),
        up: (0..POSE).map(|k| at(&[(k, STEP)])).collect(),
        down: (0..POSE).map(|k| at(&[(k, -STEP)])).collect(),
    };
    let cues = || (0..around.middle.len()).step_by(tiles).map(|first| first..first + tiles);
    if curvatures.is_empty() {
        let mixed = |i: usize| (0..i).map(move |j| [STEP, -STEP].map(|step| [(i, step), (j, step)]));
        let mixed: Vec<[Vec<f64>; 2]> = (0..POSE).flat_map(mixed).map(|both| both.map(|moves| at(&moves))).collect();
        curvatures.extend(cues().map(|cue| around.curvature(&mixed, cue)));
    }
    cues().zip(curvatures).map(|(cue, curvature)| around.shares(cue, curvature)).collect()
}

impl Around {
    /// The total curvature of the cue in this range of values. `mixed` are the values after both steps along i and j, and
    /// after both steps back, for each i and each j below it.
    fn curvature(&self, mixed: &[[Vec<f64>; 2]], cue: Range<usize>) -> Matrix {
        let sum = |values: &[f64]| values[cue.clone()].iter().sum::<f64>();
        let middle = sum(&self.middle);
        let single: [f64; POSE] = std::array::from_fn(|k| sum(&self.up[k]) + sum(&self.down[k]));
        let mut curvature = Matrix::zeros();
        let mut mixed = mixed.iter();
        for i in 0..POSE {
            curvature[(i, i)] = (2.0 * middle - single[i]) / (STEP * STEP);
            for (j, [up, down]) in (0..i).zip(&mut mixed) {
                let mixed = sum(up) + sum(down);
                let value = (single[i] + single[j] - mixed - 2.0 * middle) / (2.0 * STEP * STEP);
                (curvature[(i, j)], curvature[(j, i)]) = (value, value);
            }
        }
        positive(&curvature)
    }

    /// The tiles of the cue in this range of values.
    fn shares(&self, cue: Range<usize>, curvature: &Matrix) -> Vec<Share> {
        let is_used = |tile: &usize| self.up.iter().any(|values| values[*tile] != self.middle[*tile]);
        let part = curvature / cue.clone().filter(is_used).count().max(1) as f64;
        let slope = |k: usize, tile: usize| (self.up[k][tile] - self.down[k][tile]) / (2.0 * STEP);
        let share = |tile: usize| {
            if !is_used(&tile) {
                return Share::none();
            }
            let gradient = Vector::from_fn(|k, _| if k < POSE { slope(k, tile) } else { 0.0 });
            Share { value: self.middle[tile], gradient, curvature: part }
        };
        cue.clone().map(share).collect()
    }
}
