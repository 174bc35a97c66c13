//! Roots of unity.

use std::f64::consts::TAU;

/// cos and -sin of an angle.
pub(super) type Root = [f32; 2];

/// exp(-2 pi i step / length).
pub(super) fn root(step: usize, length: usize) -> Root {
    let (sin, cos) = (TAU * step as f64 / length as f64).sin_cos();
    [cos as f32, -sin as f32]
}
