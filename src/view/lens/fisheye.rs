//! The fisheye of Kannala and Brandt (2006) with OpenCV's four coefficients: the radius as a function of the angle to
//! the optical axis.

use std::f64::consts::PI;

use super::inverse::{FOLD_SAMPLES, LARGEST_SLOPE, RETURN_DISTANCE, inverse, pixels};

/// A distorted point, and its derivative by x, y, z.
pub type Projection = ([f64; 2], [[f64; 3]; 2]);

/// A point this close to the axis, relative to its distance, gets the derivative on the axis, because rounding loses
/// its squared radius.
const ON_AXIS: f64 = 1e-8;

/// The distorted position of a point before the first fold of the lens.
pub fn project(coefficients: &[f64; 4], point: [f64; 3]) -> Option<[f64; 2]> {
    let [radius, angle] = polar(point)?;
    grows(coefficients, angle).then_some(())?;
    let [distorted, _] = distort(coefficients, angle);
    let share = if radius > 0.0 { distorted / radius } else { 0.0 };
    Some([share * point[0], share * point[1]])
}

/// [`project`] with its derivative.
pub fn project_with_gradient(coefficients: &[f64; 4], point: [f64; 3]) -> Option<Projection> {
    let [x, y, z] = point;
    let [radius, angle] = polar(point)?;
    grows(coefficients, angle).then_some(())?;
    let [distorted, slope] = distort(coefficients, angle);
    if z > 0.0 && radius < ON_AXIS * z {
        let inverse = 1.0 / z;
        let at = [x * inverse, y * inverse];
        return Some((at, [[inverse, 0.0, -inverse * at[0]], [0.0, inverse, -inverse * at[1]]]));
    }
    let [cos, sin] = [x / radius, y / radius];
    let square = radius * radius + z * z;
    // Along the radius and perpendicular to it.
    let (along, across) = (slope * z / square, distorted / radius);
    let mixed = cos * sin * (along - across);
    let by_z = -slope * radius / square;
    let gradient = [
        [along * cos * cos + across * sin * sin, mixed, by_z * cos],
        [mixed, along * sin * sin + across * cos * cos, by_z * sin],
    ];
    Some(([distorted * cos, distorted * sin], gradient))
}

/// Direction of the ray that the lens maps to `target`, if there is one: with z = 1 if it points forward, a unit vector
/// if it points sideways or backward.
pub fn ray(coefficients: &[f64; 4], target: [f64; 2], focal: [f64; 2]) -> Option<[f64; 3]> {
    let radius = target[0].hypot(target[1]);
    let radial = |angle: f64| {
        let [distorted, slope] = distort(coefficients, angle);
        (distorted, slope, grows(coefficients, angle))
    };
    let angle = inverse(radial, radius, PI);
    if radius <= 0.0 {
        return Some([0.0, 0.0, 1.0]);
    }
    let [distorted, _] = distort(coefficients, angle);
    let off = (distorted - radius) / radius;
    let returns = pixels(focal, target.map(|part| part * off)) < RETURN_DISTANCE;
    (returns && grows(coefficients, angle)).then_some(())?;
    // The slope of rays that point sideways is infinite.
    let (sin, cos) = angle.sin_cos();
    let [aside, ahead] = if cos > 1.0 / LARGEST_SLOPE { [sin / cos, 1.0] } else { [sin, cos] };
    Some([aside / radius * target[0], aside / radius * target[1], ahead])
}

/// Distance from the axis and angle to it; `None` at the camera's centre and on the axis behind it.
fn polar([x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    let radius = x.hypot(y);
    (radius > 0.0 || z > 0.0).then(|| [radius, radius.atan2(z)])
}

/// The distorted radius at an angle to the axis, and its derivative.
fn distort([k1, k2, k3, k4]: &[f64; 4], angle: f64) -> [f64; 2] {
    let square = angle * angle;
    [
        angle * (1.0 + square * (k1 + square * (k2 + square * (k3 + square * k4)))),
        1.0 + square * (3.0 * k1 + square * (5.0 * k2 + square * (7.0 * k3 + square * 9.0 * k4))),
    ]
}

/// Whether the distorted radius grows monotonically up to this angle. It does with small coefficients; otherwise angles
/// in between are sampled.
fn grows(coefficients: &[f64; 4], angle: f64) -> bool {
    let shrinking = distort(&coefficients.map(|value| -value.abs()), angle);
    let limit = angle < PI;
    limit
        && (shrinking[1] > 0.0
            || (1..=FOLD_SAMPLES).all(|k| {
                let angle = angle * (k as f64 / FOLD_SAMPLES as f64).sqrt();
                distort(coefficients, angle)[1] > 0.0
            }))
}
