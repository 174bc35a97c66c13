//! Cameras of a rig: a pinhole behind one of the lenses that calibration tools write.
//!
//! Brown's model is OpenCV's rational one of eight coefficients, of which the usual five are a part; the fisheye is
//! that of Kannala and Brandt (2006) with OpenCV's four coefficients. Points become pixels in closed form; rays are
//! found by Newton's method inside a bracket along the radius, then in two dimensions for what is not radial.
//!
//! A lens model folds: from some radius on the distorted one shrinks, and perhaps grows again further out. What lies
//! beyond the first fold is seen by no lens, so it has neither pixel nor ray. Limits: between [`FOLD_SAMPLES`] radii
//! a fold can be missed; it is then so shallow that it moves no pixel by much.

use crate::check::positive;
use crate::error::{Error, ErrorKind, Result};

/// What bends the rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lens {
    /// Straight lines stay straight.
    None,
    /// OpenCV's k1, k2, p1, p2, k3, k4, k5, k6; models of five coefficients have zeros for the last three.
    Brown([f64; 8]),
    /// OpenCV's fisheye, k1 to k4: the radius by the angle to the optical axis.
    Fisheye([f64; 4]),
}

/// A camera of a rig. Pixel centres are whole numbers; frame: x right, y down, z forward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigCamera {
    /// Focal length along x in pixels.
    pub fx: f64,
    /// Focal length along y in pixels.
    pub fy: f64,
    /// Column of the principal point.
    pub cx: f64,
    /// Row of the principal point.
    pub cy: f64,
    /// Between pinhole and pixels.
    pub lens: Lens,
}

/// Most rounds of Newton's method; usual lenses take three, halving the bracket down to rounding takes fifty.
const MOST_ROUNDS: usize = 60;
/// A ray has been found when its pixel is this near, in pixels: a hundredth of the step between coordinates in f32.
const RETURN_DISTANCE: f64 = 1e-7;
/// .. or so near relative to its distance from the middle: what 64 bits leave of pixels millions beyond the picture.
const ROUNDING: f64 = 1e-13;
/// Largest slope of a ray behind Brown's lens, 89.4 degrees off the axis: the model knows no ray at 90.
const LARGEST_SLOPE: f64 = 100.0;
/// Radii at which the growth of the distorted radius is asked, evenly spread in their squares.
const FOLD_SAMPLES: usize = 16;
/// A point this near to the axis, relative to its distance, has the axis' own derivative: its square is lost in
/// rounding.
const ON_AXIS: f64 = 1e-8;

/// Pixels and slopes from here on, whose squares f64 cannot hold, have no ray: rounding would send some to infinity and back.
const FARTHEST: f64 = 1e150;

impl RigCamera {
    /// # Errors
    /// [`ErrorKind::Range`] naming the number at fault below `field`.
    pub fn validate(&self, field: &str) -> Result<()> {
        positive("fx", self.fx).and(positive("fy", self.fy)).map_err(|error| error.below(field))?;
        for (name, value) in [("cx", self.cx), ("cy", self.cy)] {
            if !value.is_finite() {
                return Err(Error::new(ErrorKind::Range, name, "must be finite").value(value).below(field));
            }
        }
        if let Some((index, &value)) = self.lens.coefficients().iter().enumerate().find(|(_, value)| !value.is_finite())
        {
            return Err(Error::new(ErrorKind::Range, "distortion", "must be finite")
                .at(index)
                .value(value)
                .below(field));
        }
        Ok(())
    }

    /// Column and row of a point; `None` behind the camera, beyond the fold of its lens, and in the camera itself. A
    /// fisheye sees points beside and behind it as far as its lens does not fold.
    #[must_use]
    pub fn project(&self, point: [f64; 3]) -> Option<[f64; 2]> {
        let [x, y] = match &self.lens {
            Lens::None => slopes(point)?,
            Lens::Brown(coefficients) => {
                let ray = slopes(point)?;
                let (distorted, gradient) = brown(coefficients, ray);
                is_unfolded(coefficients, ray, gradient).then_some(distorted)?
            }
            Lens::Fisheye(coefficients) => {
                let [radius, angle] = polar(point)?;
                let [distorted, _] = fisheye(coefficients, angle);
                fisheye_grows(coefficients, angle).then_some(())?;
                let share = if radius > 0.0 { distorted / radius } else { 0.0 };
                [share * point[0], share * point[1]]
            }
        };
        Some([self.fx * x + self.cx, self.fy * y + self.cy])
    }

    /// [`project`](Self::project) with its derivative: d column and d row, each by x, y, z of the point.
    #[must_use]
    pub fn project_with_gradient(&self, point: [f64; 3]) -> Option<([f64; 2], [[f64; 3]; 2])> {
        let ([x, y], [by_x, by_y]) = match &self.lens {
            Lens::None => through_slopes(point, |ray| Some((ray, [[1.0, 0.0], [0.0, 1.0]])))?,
            Lens::Brown(coefficients) => through_slopes(point, |ray| {
                let (distorted, gradient) = brown(coefficients, ray);
                is_unfolded(coefficients, ray, gradient).then_some((distorted, gradient))
            })?,
            Lens::Fisheye(coefficients) => fisheye_with_gradient(coefficients, point)?,
        };
        let pixel = [self.fx * x + self.cx, self.fy * y + self.cy];
        Some((pixel, [by_x.map(|slope| self.fx * slope), by_y.map(|slope| self.fy * slope)]))
    }

    /// Direction of the ray through a pixel: with z = 1 where it runs ahead, so that depth times it is the point; a
    /// unit vector (z below 0.01) where a fisheye looks aside or back. `None` where the lens lets no ray through, and where
    /// the square of pixel or slope is beyond all numbers.
    #[must_use]
    pub fn ray(&self, [column, row]: [f64; 2]) -> Option<[f64; 3]> {
        let target = [(column - self.cx) / self.fx, (row - self.cy) / self.fy];
        if ![column, row, target[0], target[1]].iter().all(|number| number.abs() < FARTHEST) {
            return None;
        }
        match &self.lens {
            Lens::None => Some([target[0], target[1], 1.0]),
            Lens::Brown(coefficients) => self.brown_ray(coefficients, target),
            Lens::Fisheye(coefficients) => self.fisheye_ray(coefficients, target),
        }
    }

    /// How far a step in the plane of the slopes is in pixels.
    fn pixels(&self, [right, down]: [f64; 2]) -> f64 {
        (self.fx * right).hypot(self.fy * down)
    }

    fn brown_ray(&self, coefficients: &[f64; 8], target: [f64; 2]) -> Option<[f64; 3]> {
        let radius = target[0].hypot(target[1]);
        let radial = |radius: f64| {
            let square = radius * radius;
            let [factor, slope] = radial(coefficients, square);
            let grows = brown_grows(coefficients, square);
            (radius * factor, factor + 2.0 * square * slope, grows)
        };
        let start = inverse(radial, radius, LARGEST_SLOPE);
        let share = if radius > 0.0 { start / radius } else { 0.0 };
        let mut ray = target.map(|part| share * part);
        for _ in 0..MOST_ROUNDS {
            let (distorted, gradient) = brown(coefficients, ray);
            let [right, down] = [target[0] - distorted[0], target[1] - distorted[1]];
            if self.pixels([right, down]) < RETURN_DISTANCE + ROUNDING * self.pixels(target) {
                return is_unfolded(coefficients, ray, gradient).then_some([ray[0], ray[1], 1.0]);
            }
            let [[a, b], [c, d]] = gradient;
            let determinant = a * d - b * c;
            ray[0] += (d * right - b * down) / determinant;
            ray[1] += (a * down - c * right) / determinant;
        }
        None
    }

    fn fisheye_ray(&self, coefficients: &[f64; 4], target: [f64; 2]) -> Option<[f64; 3]> {
        let radius = target[0].hypot(target[1]);
        let radial = |angle: f64| {
            let [distorted, slope] = fisheye(coefficients, angle);
            (distorted, slope, fisheye_grows(coefficients, angle))
        };
        let angle = inverse(radial, radius, std::f64::consts::PI);
        if radius <= 0.0 {
            return Some([0.0, 0.0, 1.0]);
        }
        let [distorted, _] = fisheye(coefficients, angle);
        let off = (distorted - radius) / radius;
        let returns = self.pixels(target.map(|part| part * off)) < RETURN_DISTANCE;
        (returns && fisheye_grows(coefficients, angle)).then_some(())?;
        // Where rays run aside the slope is infinite.
        let (sin, cos) = angle.sin_cos();
        let [aside, ahead] = if cos > 1.0 / LARGEST_SLOPE { [sin / cos, 1.0] } else { [sin, cos] };
        Some([aside / radius * target[0], aside / radius * target[1], ahead])
    }
}

impl Lens {
    /// The coefficients in OpenCV's order.
    #[must_use]
    pub fn coefficients(&self) -> &[f64] {
        match self {
            Self::None => &[],
            Self::Brown(coefficients) => coefficients,
            Self::Fisheye(coefficients) => coefficients,
        }
    }
}

/// x / z and y / z of a point in front of the camera.
fn slopes([x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    (z > 0.0).then(|| [x / z, y / z])
}

/// Distance from the axis and angle to it; `None` in the camera and on the axis behind it.
fn polar([x, y, z]: [f64; 3]) -> Option<[f64; 2]> {
    let radius = x.hypot(y);
    (radius > 0.0 || z > 0.0).then(|| [radius, radius.atan2(z)])
}

/// A distorted point, and its derivative by x, y, z.
type Projection = ([f64; 2], [[f64; 3]; 2]);
/// A distorted point, and its derivative by the slopes of the ray.
type Distorted = ([f64; 2], [[f64; 2]; 2]);

fn through_slopes(point: [f64; 3], distort: impl Fn([f64; 2]) -> Option<Distorted>) -> Option<Projection> {
    let [u, v] = slopes(point)?;
    let (distorted, gradient) = distort([u, v])?;
    let inverse = 1.0 / point[2];
    let by_point = gradient.map(|[by_u, by_v]| [inverse * by_u, inverse * by_v, -inverse * (by_u * u + by_v * v)]);
    Some((distorted, by_point))
}

/// Factor of the radius by its square, and the derivative of that.
fn radial([k1, k2, _, _, k3, k4, k5, k6]: &[f64; 8], square: f64) -> [f64; 2] {
    let above = 1.0 + square * (k1 + square * (k2 + square * k3));
    let above_slope = k1 + square * (2.0 * k2 + 3.0 * square * k3);
    // The usual five coefficients need no division, which takes as long as all the rest.
    if *k4 == 0.0 && *k5 == 0.0 && *k6 == 0.0 {
        return [above, above_slope];
    }
    let below = 1.0 + square * (k4 + square * (k5 + square * k6));
    let below_slope = k4 + square * (2.0 * k5 + 3.0 * square * k6);
    let factor = above / below;
    [factor, (above_slope - factor * below_slope) / below]
}

/// The distorted slopes of a ray and their derivative by them.
fn brown(coefficients: &[f64; 8], [x, y]: [f64; 2]) -> Distorted {
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

/// Whether a ray lies before the first fold of the lens: its image is not mirrored, and its radius has grown all the
/// way.
fn is_unfolded(coefficients: &[f64; 8], [x, y]: [f64; 2], [[a, b], [c, d]]: [[f64; 2]; 2]) -> bool {
    let square = x * x + y * y;
    let bends = square < LARGEST_SLOPE * LARGEST_SLOPE && a * d - b * c > 0.0 && a + d > 0.0;
    bends && brown_grows(coefficients, square)
}

/// Whether the distorted radius grows up to the radius of that square. Small coefficients cannot keep it from that;
/// where they could, radii in between are asked.
fn brown_grows(coefficients: &[f64; 8], square: f64) -> bool {
    let [k1, k2, _, _, k3, k4, k5, k6] = coefficients.map(f64::abs);
    let below = square * (k4 + square * (k5 + square * k6));
    let below_slope = 2.0 * square * (k4 + square * (2.0 * k5 + 3.0 * square * k6));
    let above = square * (k1 + square * (k2 + square * k3));
    let shrinking = square * (3.0 * k1 + square * (5.0 * k2 + 7.0 * square * k3));
    if below < 1.0 && (1.0 - shrinking) * (1.0 - below) > (1.0 + above) * below_slope {
        return true;
    }
    (1..=FOLD_SAMPLES).all(|k| {
        let square = square * k as f64 / FOLD_SAMPLES as f64;
        let [factor, slope] = radial(coefficients, square);
        // A pole between two samples turns the sign of the factor.
        factor > 0.0 && factor + 2.0 * square * slope > 0.0
    })
}

/// The distorted radius by the angle to the axis, and its derivative.
fn fisheye([k1, k2, k3, k4]: &[f64; 4], angle: f64) -> [f64; 2] {
    let square = angle * angle;
    [
        angle * (1.0 + square * (k1 + square * (k2 + square * (k3 + square * k4)))),
        1.0 + square * (3.0 * k1 + square * (5.0 * k2 + square * (7.0 * k3 + square * 9.0 * k4))),
    ]
}

/// Whether the distorted radius grows up to that angle; as [`brown_grows`].
fn fisheye_grows(coefficients: &[f64; 4], angle: f64) -> bool {
    let shrinking = fisheye(&coefficients.map(|value| -value.abs()), angle);
    let limit = angle < std::f64::consts::PI;
    limit
        && (shrinking[1] > 0.0
            || (1..=FOLD_SAMPLES).all(|k| {
                let angle = angle * (k as f64 / FOLD_SAMPLES as f64).sqrt();
                fisheye(coefficients, angle)[1] > 0.0
            }))
}

fn fisheye_with_gradient(coefficients: &[f64; 4], point: [f64; 3]) -> Option<Projection> {
    let [x, y, z] = point;
    let [radius, angle] = polar(point)?;
    fisheye_grows(coefficients, angle).then_some(())?;
    let [distorted, slope] = fisheye(coefficients, angle);
    if z > 0.0 && radius < ON_AXIS * z {
        let inverse = 1.0 / z;
        let at = [x * inverse, y * inverse];
        return Some((at, [[inverse, 0.0, -inverse * at[0]], [0.0, inverse, -inverse * at[1]]]));
    }
    let [cos, sin] = [x / radius, y / radius];
    let square = radius * radius + z * z;
    // Along the radius and across it.
    let (along, across) = (slope * z / square, distorted / radius);
    let mixed = cos * sin * (along - across);
    let by_z = -slope * radius / square;
    let gradient = [
        [along * cos * cos + across * sin * sin, mixed, by_z * cos],
        [mixed, along * sin * sin + across * cos * cos, by_z * sin],
    ];
    Some(([distorted * cos, distorted * sin], gradient))
}

/// Where a function that grows from zero, up to its first fold, reaches `target`: Newton's method inside a bracket.
/// `function` gives value, derivative, and whether it has grown all the way. Beyond its reach: the fold, or `most`.
fn inverse(function: impl Fn(f64) -> (f64, f64, bool), target: f64, most: f64) -> f64 {
    let (mut low, mut high) = (0.0, most);
    let mut at = target.min(0.5 * most);
    for _ in 0..MOST_ROUNDS {
        let (value, slope, grows) = function(at);
        if grows && value <= target {
            low = at;
        } else {
            high = at;
        }
        let step = (target - value) / slope;
        if grows && step.abs() <= 2.0 * f64::EPSILON * at {
            return at;
        }
        at = if grows && at + step > low && at + step < high { at + step } else { 0.5 * (low + high) };
    }
    low
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const MIDDLE: [f64; 4] = [520.0, 515.0, 322.5, 236.5];

    fn camera(lens: Lens) -> RigCamera {
        let [fx, fy, cx, cy] = MIDDLE;
        RigCamera { fx, fy, cx, cy, lens }
    }

    /// Usual lenses, among them an action camera's and a depth sensor's whose eight coefficients nearly cancel.
    fn lenses() -> impl Strategy<Value = Lens> {
        let plain = (-0.3..0.3, -0.1..0.1, -0.005..0.005, -0.005..0.005, -0.05..0.05);
        let rational = (0.0..1.0_f64, -0.1..0.1);
        prop_oneof![
            Just(Lens::None),
            plain.prop_map(|(k1, k2, p1, p2, k3)| Lens::Brown([k1, k2, p1, p2, k3, 0.0, 0.0, 0.0])),
            rational.prop_map(|(k, off)| Lens::Brown([k + off, -2.0 * k, 2e-4, -1e-4, k, k, -2.0 * k, 0.9 * k])),
            (-0.1..0.1, -0.05..0.05, -0.02..0.02, -0.01..0.01)
                .prop_map(|(k1, k2, k3, k4)| Lens::Fisheye([k1, k2, k3, k4])),
        ]
    }

    fn difference(camera: &RigCamera, point: [f64; 3], axis: usize) -> Option<[f64; 2]> {
        let [up, down] = [1e-6, -1e-6].map(|step| {
            let mut moved = point;
            moved[axis] += step;
            camera.project(moved)
        });
        let (up, down) = (up?, down?);
        Some([0, 1].map(|k| (up[k] - down[k]) / 2e-6))
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn a_ray_returns_to_its_pixel(lens in lenses(), column in 0.0..639.0, row in 0.0..479.0) {
            let camera = camera(lens);
            let ray = camera.ray([column, row]);
            // A few of these lenses fold within the picture; pixels beyond have no ray.
            prop_assume!(ray.is_some());
            let [x, y, z] = ray.unwrap();
            prop_assert_eq!(z, 1.0);
            let [back, down] = camera.project([2.5 * x, 2.5 * y, 2.5]).unwrap();
            prop_assert!((back - column).hypot(down - row) < 2.0 * RETURN_DISTANCE, "{} {}", back, down);
        }

        #[test]
        fn a_point_returns_to_its_ray(lens in lenses(), x in -3.0..3.0, y in -3.0..3.0, z in -1.0..4.0) {
            let camera = camera(lens);
            if let Some(pixel) = camera.project([x, y, z]) {
                let [u, v, w] = camera.ray(pixel).unwrap();
                // A pixel of a millionth may be far in space where the lens is about to fold: there the pixel counts.
                let back = camera.project([u, v, w]).unwrap();
                let far = pixel[0].hypot(pixel[1]);
                prop_assert!((back[0] - pixel[0]).hypot(back[1] - pixel[1]) < 2.0 * RETURN_DISTANCE + 1e-11 * far);
                prop_assert!(w > 0.0 || (u * u + v * v + w * w - 1.0).abs() < 1e-12);
                let (_, [a, b]) = camera.project_with_gradient([x, y, z]).unwrap();
                let across = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                let squares = [a, b].map(|row| row.iter().map(|part| part * part).sum::<f64>());
                let size = across.iter().map(|part| part * part).sum::<f64>();
                if size > 1e-4 * squares[0].max(squares[1]).powi(2) {
                    let [point, ray] = [[x, y, z], [u, v, w]].map(|[x, y, z]| {
                        let length = (x * x + y * y + z * z).sqrt();
                        [x / length, y / length, z / length]
                    });
                    prop_assert!((0..3).all(|k| (point[k] - ray[k]).abs() < 1e-6), "{:?} {:?}", point, ray);
                }
            }
        }

        #[test]
        fn the_gradient_is_the_difference_quotient(lens in lenses(), x in -0.6..0.6, y in -0.5..0.5, z in -0.2..2.0) {
            let camera = camera(lens);
            let point: [f64; 3] = [x, y, z];
            prop_assume!(z > 0.3 || matches!(lens, Lens::Fisheye(_)) && x.hypot(y).hypot(z) > 0.3 && x.hypot(y) > 0.05);
            let projected = camera.project_with_gradient(point);
            prop_assert_eq!(projected.map(|(pixel, _)| pixel.map(|part| (1e9 * part).round())),
                camera.project(point).map(|pixel| pixel.map(|part| (1e9 * part).round())));
            let Some((_, gradient)) = projected else { return Ok(()) };
            for axis in 0..3 {
                let Some(slopes) = difference(&camera, point, axis) else { continue };
                for k in 0..2 {
                    let off = (gradient[k][axis] - slopes[k]).abs();
                    prop_assert!(off < 1e-4 + 1e-6 * slopes[k].abs(), "{:?}[{}][{}]: {}", gradient, k, axis, off);
                }
            }
        }
    }

    #[test]
    fn nothing_is_seen_beyond_the_fold() {
        // r - r^3 grows to r = 0.577; r (1 - 0.5 r^2 + 0.1 r^4) falls from r = 1 on and grows again from 1.41 on.
        let once = camera(Lens::Brown([-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
        let twice = camera(Lens::Brown([-0.5, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
        for (camera, seen, unseen) in [(once, 0.57, [0.585, 3.0]), (twice, 0.99, [1.02, 1.5])] {
            for turn in [0.0_f64, 1.0, 2.0, 4.0] {
                let point = |slope: f64| [slope * turn.cos(), slope * turn.sin(), 1.0];
                let pixel = camera.project(point(seen)).unwrap();
                let [x, y, _] = camera.ray(pixel).unwrap();
                assert!((x.hypot(y) - seen).abs() < 1e-6, "{x} {y}");
                assert_eq!(unseen.map(|slope| camera.project(point(slope))), [None; 2]);
                assert_eq!(unseen.map(|slope| camera.project_with_gradient(point(slope))), [None; 2]);
            }
        }
        // 0.385 focal lengths are the most that the first shows; the second shows 0.6.
        let [fx, _, cx, cy] = MIDDLE;
        assert!(once.ray([cx + 0.384 * fx, cy]).is_some() && once.ray([cx + 0.386 * fx, cy]).is_none());
        assert!(twice.ray([cx + 0.599 * fx, cy]).is_some() && twice.ray([cx + 0.601 * fx, cy]).is_none());
        // A pole of the rational model: 1 - r^2 below the line.
        let pole = camera(Lens::Brown([0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0]));
        assert!(pole.project([0.9, 0.0, 1.0]).is_some() && pole.project([1.1, 0.0, 1.0]).is_none());
        // theta - 0.2 theta^3 grows up to 1.29 rad.
        let fisheye = camera(Lens::Fisheye([-0.2, 0.0, 0.0, 0.0]));
        let at = |angle: f64| fisheye.project([0.0, angle.sin(), angle.cos()]);
        assert!(at(1.28).is_some() && at(1.30).is_none() && at(3.0).is_none());
    }

    #[test]
    fn a_fisheye_sees_beside_and_behind_itself_and_a_pinhole_does_not() {
        let wide = camera(Lens::Fisheye([0.01, -0.002, 0.0, 0.0]));
        for point in [[1.0, 0.5, 0.0], [1.0, -0.5, -0.4]] {
            let [u, v, w] = wide.ray(wide.project(point).unwrap()).unwrap();
            let length = point.iter().map(|part: &f64| part * part).sum::<f64>().sqrt();
            for (part, expected) in [u, v, w].into_iter().zip(point) {
                assert!((part - expected / length).abs() < 1e-9);
            }
        }
        for point in [[0.0, 0.0, -1.0], [0.0; 3]] {
            assert_eq!(wide.project(point), None);
            assert_eq!(camera(Lens::None).project(point), None);
        }
        let [_, _, cx, cy] = MIDDLE;
        assert_eq!(wide.project([0.0, 0.0, 2.0]), Some([cx, cy]));
        assert_eq!(wide.ray([cx, cy]), Some([0.0, 0.0, 1.0]));
        let (_, gradient) = wide.project_with_gradient([0.0, 0.0, 2.0]).unwrap();
        assert_eq!(gradient, [[260.0, 0.0, 0.0], [0.0, 257.5, 0.0]]);
    }

    #[test]
    fn numbers_that_are_no_camera_are_named() {
        let good = camera(Lens::Fisheye([0.1, 0.0, 0.0, 0.0]));
        assert_eq!(good.validate("camera"), Ok(()));
        let cases = [
            (RigCamera { fx: 0.0, ..good }, "camera.fx", None),
            (RigCamera { fy: f64::INFINITY, ..good }, "camera.fy", None),
            (RigCamera { cy: f64::NAN, ..good }, "camera.cy", None),
            (RigCamera { lens: Lens::Fisheye([0.0, 0.0, f64::NAN, 0.0]), ..good }, "camera.distortion", Some(2)),
        ];
        for (camera, field, index) in cases {
            let error = camera.validate("camera").unwrap_err();
            assert_eq!((error.kind(), error.field(), error.index()), (ErrorKind::Range, field, index));
        }
    }
}
