//! Finite differences of a log likelihood that is evaluated tile by tile.

use super::evidence::{Share, positive};
use super::unknowns::{POSE, State, Units, Vector};

/// Step in pixels, wide compared with the raster and narrow enough for a curvature.
const STEP: f64 = 1.0;

/// Values and gradients of the tiles. Each used tile gets an equal part of the total curvature, because the curvature of
/// a single tile is too uncertain.
pub(super) fn differences(
    units: &Units,
    state: &State,
    tiles: usize,
    evaluate: impl Fn(&State, &mut [f64]),
) -> Vec<Share> {
    let at = |moves: &[(usize, f64)]| {
        let mut step = Vector::zeros();
        moves.iter().for_each(|&(k, by)| step[k] += by);
        let mut out = vec![0.0; tiles];
        evaluate(&units.step(state, &step), &mut out);
        out
    };
    let sum = |values: &[f64]| values.iter().sum::<f64>();
    let middle = at(&[]);
    let up: Vec<Vec<f64>> = (0..POSE).map(|k| at(&[(k, STEP)])).collect();
    let down: Vec<Vec<f64>> = (0..POSE).map(|k| at(&[(k, -STEP)])).collect();
    let mut curvature = super::unknowns::Matrix::zeros();
    for i in 0..POSE {
        let both = sum(&up[i]) + sum(&down[i]);
        curvature[(i, i)] = (2.0 * sum(&middle) - both) / (STEP * STEP);
        for j in 0..i {
            let mixed = sum(&at(&[(i, STEP), (j, STEP)])) + sum(&at(&[(i, -STEP), (j, -STEP)]));
            let single = both + sum(&up[j]) + sum(&down[j]);
            let value = (single - mixed - 2.0 * sum(&middle)) / (2.0 * STEP * STEP);
            (curvature[(i, j)], curvature[(j, i)]) = (value, value);
        }
    }
    let is_used: Vec<bool> = (0..tiles).map(|tile| up.iter().any(|values| values[tile] != middle[tile])).collect();
    let part = positive(&curvature) / is_used.iter().filter(|used| **used).count().max(1) as f64;
    let share = |tile: usize| {
        if !is_used[tile] {
            return Share::none();
        }
        let gradient =
            Vector::from_fn(|k, _| if k < POSE { (up[k][tile] - down[k][tile]) / (2.0 * STEP) } else { 0.0 });
        Share { value: middle[tile], gradient, curvature: part }
    };
    (0..tiles).map(share).collect()
}
