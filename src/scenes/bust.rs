//! A bust: head with hair, face, ears, neck and shoulders turned to one side. No part is quite symmetric, so the pose
//! is observable.

use super::profiles::{bell, bump, dome, overhang, step, union};

/// Size of the head relative to the samples in which its parts below are measured.
const HEAD_SCALE: f64 = 1.13;
/// Row about which the head is scaled, from the centre of the grid, so that its crown stays in place.
const CROWN: f64 = -108.0;
/// Column of the parting, left of the middle.
const PARTING: f64 = -15.0;

/// One bell-shaped feature of the face: centre, sigmas across and down, height; all in samples.
type Feature = ([f64; 2], [f64; 2], f64);

const FEATURES: [Feature; 15] = [
    // Brows.
    ([-17.0, -55.0], [12.0, 4.2], 4.4),
    ([18.0, -56.0], [12.0, 4.2], 4.4),
    // Eye sockets, and the eyes in them.
    ([-17.0, -44.0], [8.5, 6.0], -8.5),
    ([18.0, -44.5], [8.5, 6.0], -8.5),
    ([-17.0, -43.0], [5.8, 4.2], 6.8),
    ([18.0, -43.5], [5.8, 4.2], 6.8),
    // Cheekbones.
    ([-23.0, -22.0], [10.0, 9.0], 3.0),
    ([24.0, -23.0], [10.0, 9.0], 3.0),
    // Wings of the nose.
    ([-6.5, -17.5], [3.2, 3.4], 4.5),
    ([8.0, -17.7], [3.2, 3.4], 4.5),
    // Folds between nose and mouth, around the mouth, and under the lip.
    ([0.8, -8.0], [2.2, 3.4], -1.4),
    ([0.5, 0.0], [12.0, 9.0], 3.2),
    ([0.5, 12.5], [9.0, 2.6], -3.4),
    // Chin, larger to the right.
    ([1.0, 22.0], [11.0, 7.5], 6.5),
    ([9.0, 18.0], [6.0, 8.0], 0.8),
];

/// Height in samples at x (right) and y (down) from the centre of the grid.
pub(super) fn height(x: f64, y: f64) -> f64 {
    let [u, v] = [x / HEAD_SCALE, (y - CROWN) / HEAD_SCALE + CROWN];
    let face =
        skull(u, v) + FEATURES.iter().map(|&(c, s, h)| h * bump(u, v, c, s)).sum::<f64>() + nose(u, v) + lips(u, v);
    let head = union(face, ears(u, v), 3.0);
    let body = union(neck(x, y), shoulders(x, y), 6.0);
    let cut = overhang(y - 96.0, 14.5) + overhang(x.abs() - 98.0, 14.0);
    0.99 * (union(head, body, 2.5) - 18.0 * cut) - 2.0
}

fn skull(x: f64, y: f64) -> f64 {
    let cranium = dome(x, y, [0.0, -52.0], [49.0, 54.0], 62.0);
    let jaw = dome(x, y, [1.0, -18.0], [39.0, 56.0], 64.0);
    let skin = union(cranium, jaw, 5.0);

    // The hair is a larger shell above a hairline that falls from the parting to both ears.
    let side = x - PARTING;
    let slope = if side < 0.0 { 0.034 } else { 0.0085 };
    let hairline = -84.0 + slope * side * side + 4.0 * step(side / 5.0);
    let strands = 0.9 * (side * (0.55 + 0.0063 * (y + 70.0))).sin();
    let parting = 6.0 * bump(x, y, [PARTING, -98.0], [2.6, 22.0]);
    let hair = dome(x, y, [1.0, -56.0], [54.0, 57.0], 68.0) + strands - parting;
    skin + step((hairline - y) / 2.2) * (hair - skin).max(0.0)
}

/// A slightly bent ridge that grows from the bridge to the tip.
fn nose(x: f64, y: f64) -> f64 {
    let along = ((y + 52.0) / 36.0).clamp(0.0, 1.0);
    let growth = along * along * (3.0 - 2.0 * along);
    let ends = step((-13.5 - y) / 1.7) * step((y + 56.0) / 4.0);
    (3.0 + 13.0 * growth) * ends * bell(x, 0.5 + 0.03 * (y + 40.0), 3.6 + 2.4 * growth)
}

fn lips(x: f64, y: f64) -> f64 {
    let width = (-0.5 * ((x - 1.0) / 9.5).powi(4)).exp();
    width * (3.0 * bell(y, -1.2, 2.3) + 3.6 * bell(y, 5.8, 2.7) - 2.8 * bell(y, 2.1, 1.1))
}

fn ears(x: f64, y: f64) -> f64 {
    let ear = |centre: [f64; 2]| 4.0 + dome(x, y, centre, [7.0, 14.0], 20.0);
    let hollow = |centre: [f64; 2]| 5.0 * bump(x, y, centre, [2.6, 7.0]);
    union(ear([-50.0, -38.0]), ear([51.0, -39.0]), 2.0) - hollow([-51.0, -38.0]) - hollow([52.0, -39.0])
}

fn neck(x: f64, y: f64) -> f64 {
    let column = dome(x, 0.0, [2.0, 0.0], [37.0, 1.0], 44.0) - 4.0;
    let sinews = 3.0 * (bump(x, y, [-12.0, 60.0], [5.0, 14.0]) + bump(x, y, [16.0, 60.0], [5.0, 14.0]));
    column + sinews - 80.0 * (step((y - 78.0) / 4.0) + step(-y / 4.0))
}

/// The right shoulder comes forward.
fn shoulders(x: f64, y: f64) -> f64 {
    let turn = 0.14 * (x - 4.0);
    let collarbones = 4.0 * bump(x, y, [-36.0, 70.0], [24.0, 4.0]) + 2.5 * bump(x, y, [38.0, 73.0], [20.0, 4.0]);
    let hollow = 6.0 * bump(x, y, [4.0, 71.0], [7.0, 6.0]);
    dome(x, y, [4.0, 116.0], [112.0, 58.0], 58.0) + turn + collarbones - hollow
}
