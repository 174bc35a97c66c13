//! Brown's distortion as defined by OpenCV: the rational model of eight coefficients, which includes the usual five.
//!
//! Rays are found by Newton's method: within a bracket along the radius, then in two dimensions for the tangential
//! terms.

use super::inverse::{FOLD_SAMPLES, LARGEST_SLOPE, MOST_ROUNDS, RETURN_DISTANCE, inverse, pixels};
use crate::numeric::{Lanes, Real};

/// A distorted point, and its derivative by the slopes of the ray.
pub type Distorted = ([f64; 2], [[f64; 2]; 2]);

/// A ray has been found when its pixel is within [`RETURN_DISTANCE`] of the target, or within this share of the
/// target's distance from the centre. The share is the rounding of f64, which exceeds that distance for pixels far
/// outside the picture.
const ROUNDING: f64 = 1e-13;

/// The distorted slopes of a ray before the first fold of the lens.
#[inline(always)]
pub fn project(coefficients: &[f64; 8], ray: [f64; 2]) -> Option<[f64; 2]> {
    let (distorted, gradient) = distort(coefficients, ray);
    is_unfolded(coefficients, ray, gradient).then_some(distorted)
}

/// The distorted slopes of a ray and their derivative by the slopes, and whether the ray lies before the first fold of
/// the lens.
#[inline(never)]
fn distorted(coefficients: &[f64; 8], ray: [f64; 2]) -> (Distorted, bool) {
    let (distorted, gradient) = distort(coefficients, ray);
    ((distorted, gradient), is_unfolded(coefficients, ray, gradient))
}

/// [`project`] with the derivative by the slopes.
pub fn project_with_gradient(coefficients: &[f64; 8], ray: [f64; 2]) -> Option<Distorted> {
    let (distorted, is_unfolded) = distorted(coefficients, ray);
    is_unfolded.then_some(distorted)
}

/// The slopes of the ray that is distorted to `target`, if there is one.
pub fn ray(coefficients: &[f64; 8], target: [f64; 2], focal: [f64; 2]) -> Option<[f64; 2]> {
    let radius = target[0].hypot(target[1]);
    let radial = |radius: f64| {
        let square = radius * radius;
        let [factor, slope] = radial(coefficients, square);
        let grows = grows(coefficients, square);
        (radius * factor, factor + 2.0 * square * slope, grows)
    };
    let start = inverse(radial, radius, LARGEST_SLOPE);
    let share = if radius > 0.0 { start / radius } else { 0.0 };
    let mut ray = target.map(|part| share * part);
    for _ in 0..MOST_ROUNDS {
        let ((distorted, gradient), is_unfolded) = distorted(coefficients, ray);
        let [right, down] = [target[0] - distorted[0], target[1] - distorted[1]];
        if pixels(focal, [right, down]) < RETURN_DISTANCE + ROUNDING * pixels(focal, target) {
            return is_unfolded.then_some(ray);
        }
        let [[a, b], [c, d]] = gradient;
        let determinant = a * d - b * c;
        ray[0] += (d * right - b * down) / determinant;
        ray[1] += (a * down - c * right) / determinant;
    }
    None
}

/// The radial factor as a function of the squared radius, and its derivative.
#[inline(always)]
fn radial([k1, k2, _, _, k3, k4, k5, k6]: &[f64; 8], square: f64) -> [f64; 2] {
    let above = 1.0 + square * (k1 + square * (k2 + square * k3));
    let above_slope = k1 + square * (2.0 * k2 + 3.0 * square * k3);
    // The usual five coefficients need no division, which would take as long as everything else.
    if *k4 == 0.0 && *k5 == 0.0 && *k6 == 0.0 {
        return [above, above_slope];
    }
    let below = 1.0 + square * (k4 + square * (k5 + square * k6));
    let below_slope = k4 + square * (2.0 * k5 + 3.0 * square * k6);
    let factor = above / below;
    [factor, (above_slope - factor * below_slope) / below]
}

/// The distorted slopes of a ray and their derivative by the slopes.
#[inline(always)]
fn distort(coefficients: &[f64; 8], [x, y]: [f64; 2]) -> Distorted {
    let [_, _, p1, p2, ..] = coefficients;
    let square = x * x + y * y;
    let [factor, by_square] = radial(coefficients, square);
    // d factor / d x = slope x.
    let slope = 2.0 * by_square;
    let mixed = x * y * slope + 2.0 * (p1 * x + p2 * y);
    let distorted = [
        x * factor + 2.0 * p1 * x * y + p2 * (square + 2.0 * x * x),
        y * factor + p1 * (square + 2.0 * y * y) + 2.0 * p2 * x * y,
    ];
    let gradient = [
        [factor + x * x * slope + 2.0 * p1 * y + 6.0 * p2 * x, mixed],
        [mixed, factor + y * y * slope + 6.0 * p1 * y + 2.0 * p2 * x],
    ];
    (distorted, gradient)
}

/// Whether a ray lies before the first fold of the lens: its image is not mirrored, and the distorted radius has grown
/// all the way.
#[inline(always)]
fn is_unfolded(coefficients: &[f64; 8], [x, y]: [f64; 2], [[a, b], [c, d]]: [[f64; 2]; 2]) -> bool {
    let square = x * x + y * y;
    let bends = square < LARGEST_SLOPE * LARGEST_SLOPE && a * d - b * c > 0.0 && a + d > 0.0;
    bends && grows(coefficients, square)
}

/// Whether the distorted radius grows monotonically up to the radius with this square. It does with small coefficients;
/// otherwise radii in between are sampled.
#[inline(always)]
fn grows(coefficients: &[f64; 8], square: f64) -> bool {
    let [k1, k2, _, _, k3, k4, k5, k6] = coefficients;
    let [k1, k2, k3] = [k1.abs(), k2.abs(), k3.abs()];
    let shrinking = square * (3.0 * k1 + square * (5.0 * k2 + 7.0 * square * k3));
    if *k4 == 0.0 && *k5 == 0.0 && *k6 == 0.0 {
        return shrinking < 1.0 || grows_at_samples(coefficients, square);
    }
    let [k4, k5, k6] = [k4.abs(), k5.abs(), k6.abs()];
    let below = square * (k4 + square * (k5 + square * k6));
    let below_slope = 2.0 * square * (k4 + square * (2.0 * k5 + 3.0 * square * k6));
    let above = square * (k1 + square * (k2 + square * k3));
    if below < 1.0 && (1.0 - shrinking) * (1.0 - below) > (1.0 + above) * below_slope {
        return true;
    }
    grows_at_samples(coefficients, square)
}

#[cold]
#[inline(never)]
fn grows_at_samples(coefficients: &[f64; 8], square: f64) -> bool {
    (1..=FOLD_SAMPLES).all(|k| {
        let square = square * k as f64 / FOLD_SAMPLES as f64;
        let [factor, slope] = radial(coefficients, square);
        // A pole between two samples flips the sign of the factor.
        factor > 0.0 && factor + 2.0 * square * slope > 0.0
    })
}

/// The distorted slopes of four rays under the usual five coefficients; NaN where the radius shrinks, behind the fold,
/// where the image is mirrored.
#[inline(never)]
pub fn distort_lanes(coefficients: [f64; 5], [x, y]: [Lanes; 2]) -> [Lanes; 2] {
    let [k1, k2, p1, p2, k3] = coefficients.map(|value| Lanes::splat(value as f32));
    let (xx, yy, xy) = (x * x, y * y, x * y + x * y);
    let r2 = xx + yy;
    let one = Lanes::splat(1.0);
    let radial = one + r2 * (k1 + r2 * (k2 + r2 * k3));
    let three = Lanes::splat(3.0);
    let growth = one + r2 * (three * k1 + r2 * (Lanes::splat(5.0) * k2 + r2 * (Lanes::splat(7.0) * k3)));
    let radial = Lanes::splat(0.0).less(growth).select(radial, Lanes::splat(f32::NAN));
    [x * radial + p1 * xy + p2 * (r2 + xx + xx), y * radial + p1 * (r2 + yy + yy) + p2 * xy]
}
