//! Procedural surfaces on the 256 grid, which need no licence and have a known true shape.

use std::f64::consts::TAU;

use super::bust;
use super::profiles::{bell, bump, overhang, round, step, union, window};
use super::relief::Relief;
use crate::error::{Error, ErrorKind, Result};

/// Names of the built-in surfaces.
pub const NAMES: [&str; 3] = ["bust", "vase", "ripples"];

/// Side of the grid of every built-in surface in samples: that of the protocol (docs/lab/protocols.md).
const SIDE: usize = 256;

/// The built-in surface with this name, one of [`NAMES`], as heights on a 256 x 256 grid.
///
/// # Errors
/// [`ErrorKind::Range`] for any other name.
pub fn surface(name: &str) -> Result<Relief> {
    let height: fn(f64, f64) -> f64 = match name {
        "bust" => bust::height,
        "vase" => vase,
        "ripples" => ripples,
        _ => {
            let message = format!("no surface is named {name:?}; there are {}", NAMES.join(", "));
            return Err(Error::new(ErrorKind::Range, "surface", message));
        }
    };
    Ok(Relief::from_function(SIDE, height))
}

/// (y, radius) of the vase where its radius is largest or smallest, from lip to foot.
const PROFILE: [[f64; 2]; 5] = [[-108.0, 41.0], [-72.0, 25.0], [10.0, 66.0], [86.0, 24.0], [110.0, 38.0]];

/// A vase like one from a potter's wheel. Flutes that wind around its belly, a medallion left of the middle and two
/// different handles make the rotation about its axis observable.
fn vase(x: f64, y: f64) -> f64 {
    let radius = profile(y);
    let shell = round(x / radius, radius);
    let angle = (x / radius).clamp(-1.0, 1.0).asin();
    let flutes = 1.6 * (9.0 * angle + 0.06 * y).sin() * window(y, 28.0, 56.0);
    let collar = 3.0 * bell(y, -50.0, 2.5) + 2.5 * bell(y, -41.0, 2.5) + 3.0 * bell(y, 74.0, 2.5);
    let [u, v] = [(x + 20.0) / 15.0, (y + 6.0) / 17.0];
    let medallion = 4.0 * step((1.0 - u.hypot(v)) * 9.0) + 3.0 * bell(u, 0.1, 0.25) * bell(v, -0.1, 0.4);
    let body = shell + (flutes + collar + medallion) * step((radius - x.abs()) / 3.0);
    let handles = handle(x, y, [-47.0, -44.0], [25.0, 30.0]).max(handle(x, y, [49.0, -36.0], [29.0, 37.0]));
    let ends = overhang(y + 103.0, -6.0) + overhang(y - 106.0, 6.0);
    // Cuts off the last samples before the border, where a round body is seen edge on.
    union(0.95 * body - 14.0 * ends, handles, 2.0) - 4.0
}

fn profile(y: f64) -> f64 {
    let last = PROFILE.len() - 1;
    let next = PROFILE.iter().position(|&[knot, _]| y < knot).unwrap_or(last).max(1);
    let [[y0, r0], [y1, r1]] = [PROFILE[next - 1], PROFILE[next]];
    let share = ((y - y0) / (y1 - y0)).clamp(0.0, 1.0);
    r0 + (r1 - r0) * share * share * (3.0 - 2.0 * share)
}

/// A tube along an ellipse about `centre`.
fn handle(x: f64, y: f64, centre: [f64; 2], radii: [f64; 2]) -> f64 {
    let ring = ((x - centre[0]) / radii[0]).hypot((y - centre[1]) / radii[1]) - 1.0;
    let thickness = 7.5;
    8.0 + round(ring * radii[0].midpoint(radii[1]) / thickness, 12.0)
}

/// A shallow dome with an irregular, smooth border, crossed by two systems of waves.
fn ripples(x: f64, y: f64) -> f64 {
    let bearing = y.atan2(x);
    let border = 104.0 + 5.0 * (3.0 * bearing + 0.6).sin() + 3.0 * (5.0 * bearing).cos();
    let inside = 1.0 - (x.hypot(y) / border).powi(2);
    let calm = (2.2 * inside).clamp(0.0, 1.0);
    let near = (x + 48.0).hypot(y + 30.0);
    let far = (x - 170.0).hypot(y - 60.0);
    let waves = 4.2 * (TAU * near / 38.0).cos() * (-near / 120.0).exp() + 2.6 * (TAU * far / 47.0).sin();
    4.0 + 46.0 * inside + 5.0 * bump(x, y, [38.0, -28.0], [26.0, 18.0]) + waves * calm * calm * (3.0 - 2.0 * calm)
}
