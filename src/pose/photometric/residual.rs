//! Residuals of depth points, two side by side: r = log S(pi(T P)) - B(R n) L and its derivatives.
//!
//! The unknowns are those of every registration here: P' -> c + e^u exp([w]) (P' - c) + l v of the carried point P' = T
//! P, n' -> exp([w]) n' of its normal. With g = d log S / d P' and b = d (B L) / d n', both of one channel, dr/dw = (P'
//! - c) x g - n' x b, dr/dv = l g, dr/du = (P' - c) . g, and dr/dL = -B.

use super::image::{ImagePoint, SplineImage};
use crate::light::{HARMONICS, Light, Polynomial, basis};
use crate::numeric::{DOUBLE_LANES, Doubles, Real, dot};
use crate::pose::increment::{Frame, UNKNOWNS};
use crate::view::Camera;

/// A derivative by the unknowns.
pub(super) type Motion = [Doubles; UNKNOWNS];

/// Where residuals are taken: one image under one light.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    image: &'a SplineImage,
    slopes: Option<&'a SplineImage>,
    camera: &'a Camera,
    light: [Polynomial<f64>; 3],
}

/// What the image shows of points side by side, zero where it does not show them.
#[derive(Clone, Copy)]
pub(super) struct Seen {
    /// One where the image shows the point.
    pub shown: Doubles,
    /// log S of the three channels.
    pub log: [Doubles; 3],
}

/// Residuals of points side by side with what the equations need of them.
pub(super) struct Linear {
    pub shown: Doubles,
    /// One for each channel.
    pub residual: [Doubles; 3],
    /// d r / d unknowns, a row for each channel.
    pub jacobian: [Motion; 3],
    /// The same by the slopes of another image, where the scene has one.
    listener: Option<[Motion; 3]>,
    /// d column, d row / d unknowns.
    pub motion: [Motion; 2],
    /// Harmonics of the carried normal.
    pub basis: [Doubles; HARMONICS],
}

impl Linear {
    /// The rows by which the pose listens to the residuals.
    pub fn listener(&self) -> &[Motion; 3] {
        self.listener.as_ref().unwrap_or(&self.jacobian)
    }
}

impl<'a> Scene<'a> {
    /// `light` with its exposure; slopes of the listening rows come from `slopes`, where that is another image.
    pub fn new(image: &'a SplineImage, slopes: Option<&'a SplineImage>, camera: &'a Camera, light: &Light) -> Self {
        Self { image, slopes, camera, light: Polynomial::of(light) }
    }

    /// Whether the pose listens by rows of its own.
    pub fn listens(&self) -> bool {
        self.slopes.is_some()
    }

    /// r of carried points with their carried normals.
    #[inline(always)]
    pub fn residual(&self, seen: &Seen, normals: [Doubles; 3]) -> [Doubles; 3] {
        let [red, green, blue] = &self.light;
        [seen.log[0] - red.shade(normals), seen.log[1] - green.shade(normals), seen.log[2] - blue.shade(normals)]
    }

    /// log S where carried points are seen.
    // One copy of it: visitors download each.
    #[inline(never)]
    pub fn seen(&self, points: [Doubles; 3]) -> Seen {
        let (mut shown, mut log) = ([0.0; DOUBLE_LANES], [[0.0; DOUBLE_LANES]; 3]);
        for (lane, shown) in shown.iter_mut().enumerate() {
            let pixel = self.camera.project(self.image.size(), of_lane(points, lane));
            let Some(colours) = pixel.and_then(|pixel| self.image.value(pixel)) else { continue };
            *shown = 1.0;
            (0..3).for_each(|channel| log[channel][lane] = colours[channel]);
        }
        Seen { shown: Doubles::from(shown), log: triple(&log) }
    }

    /// r and its derivatives.
    // As above.
    #[inline(never)]
    pub fn linear(&self, points: [Doubles; 3], normals: [Doubles; 3], frame: &Frame) -> Linear {
        let mut look = Look::default();
        for lane in 0..DOUBLE_LANES {
            self.look(of_lane(points, lane), lane, &mut look);
        }
        let motion = motion(points, &look, frame);
        let (mut residual, mut turns) = (triple(&look.log), [normals; 3]);
        for (channel, light) in self.light.iter().enumerate() {
            let (shade, by_normal) = light.expand(normals);
            turns[channel] = cross(normals, by_normal);
            residual[channel] = residual[channel] - shade;
        }
        let rows = |gradient: &[[[f64; DOUBLE_LANES]; 2]; 3]| {
            let row = |channel: usize| row(&motion, &gradient[channel], turns[channel]);
            [row(0), row(1), row(2)]
        };
        Linear {
            shown: Doubles::from(look.shown),
            residual,
            jacobian: rows(&look.gradient),
            listener: self.slopes.map(|_| rows(&look.slopes)),
            motion,
            basis: basis(normals),
        }
    }

    /// Looks a point up, for its lane.
    fn look(&self, point: [f64; 3], lane: usize, look: &mut Look) {
        let Some((pixel, by_point)) = self.camera.project_with_gradient(self.image.size(), point) else { return };
        let Some(ImagePoint { log, gradient }) = self.image.at(pixel) else { return };
        let slopes = self.slopes.and_then(|image| image.at(pixel)).map_or(gradient, |point| point.gradient);
        look.shown[lane] = 1.0;
        for channel in 0..3 {
            look.log[channel][lane] = log[channel];
            for along in 0..2 {
                look.gradient[channel][along][lane] = gradient[channel][along];
                look.slopes[channel][along][lane] = slopes[channel][along];
            }
        }
        for along in 0..2 {
            (0..3).for_each(|axis| look.by_point[along][axis][lane] = by_point[along][axis]);
        }
    }
}

/// What the image says of points side by side, zero where they are not shown.
#[derive(Default)]
struct Look {
    shown: [f64; DOUBLE_LANES],
    log: [[f64; DOUBLE_LANES]; 3],
    /// d log S / d (column, row) of each channel, and what the listening rows take for it.
    gradient: [[[f64; DOUBLE_LANES]; 2]; 3],
    slopes: [[[f64; DOUBLE_LANES]; 2]; 3],
    /// d (column, row) / d point.
    by_point: [[[f64; DOUBLE_LANES]; 3]; 2],
}

/// d column and d row / d unknowns.
#[inline(always)]
fn motion(points: [Doubles; 3], look: &Look, frame: &Frame) -> [Motion; 2] {
    let arm = |axis: usize| points[axis] - Doubles::splat(frame.centre[axis]);
    let arm = [arm(0), arm(1), arm(2)];
    let length = Doubles::splat(frame.length);
    let by = |along: usize| {
        let slope = triple(&look.by_point[along]);
        let [x, y, z] = cross(arm, slope);
        [x, y, z, length * slope[0], length * slope[1], length * slope[2], dot(arm, slope)]
    };
    [by(0), by(1)]
}

/// d r / d unknowns of one channel.
#[inline(always)]
fn row(motion: &[Motion; 2], gradient: &[[f64; DOUBLE_LANES]; 2], turn: [Doubles; 3]) -> Motion {
    let [by_column, by_row] = [Doubles::from(gradient[0]), Doubles::from(gradient[1])];
    let mut row = motion[0];
    for (entry, &below) in row.iter_mut().zip(&motion[1]) {
        *entry = *entry * by_column + below * by_row;
    }
    (0..3).for_each(|axis| row[axis] = row[axis] - turn[axis]);
    row
}

#[inline(always)]
fn triple(numbers: &[[f64; DOUBLE_LANES]; 3]) -> [Doubles; 3] {
    [Doubles::from(numbers[0]), Doubles::from(numbers[1]), Doubles::from(numbers[2])]
}

#[inline(always)]
fn cross(a: [Doubles; 3], b: [Doubles; 3]) -> [Doubles; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

#[inline(always)]
fn of_lane(vector: [Doubles; 3], lane: usize) -> [f64; 3] {
    let [x, y, z] = vector;
    [x.array()[lane], y.array()[lane], z.array()[lane]]
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::pose::increment::Row;
    use crate::scenes::lights::COLOURFUL;
    use crate::view::{ColourImage, ColourSamples, ColourView, Pinhole};

    fn image() -> SplineImage {
        let (width, height) = (40, 32);
        let colour = |index: usize| {
            let [x, y] = [(index % width) as f64, (index / width) as f64];
            [(0.3 * x).sin() + 0.02 * y, (0.2 * x + 0.25 * y).cos(), 0.1 * x - 0.05 * y].map(|v: f64| v.exp() as f32)
        };
        let samples = ColourSamples::RgbLinear((0..width * height).flat_map(colour).collect());
        let input = ColourImage { width, height, samples, transfer: None, mask: None, camera: None };
        SplineImage::new(&ColourView::new(input).unwrap(), 0.0)
    }

    #[test]
    fn derivatives_are_the_central_differences() {
        let image = image();
        let distortion = [0.1, -0.05, 0.003, -0.002, 0.0];
        let pinhole = Camera::Pinhole(Pinhole { fx: 50.0, fy: 48.0, cx: 19.0, cy: 15.0, distortion });
        let normal = Vector3::new(0.36, -0.48, -0.8);
        // Colours are those of f32: a difference of smaller steps would be their rounding.
        let small = 3e-3;
        for (camera, point, length) in
            [(Camera::Orthographic, Vector3::new(3.3, -4.2, 7.0), 9.0), (pinhole, Vector3::new(0.21, -0.13, 1.2), 0.2)]
        {
            let scene = Scene::new(&image, None, &camera, &COLOURFUL);
            let frame = Frame { centre: 0.7 * point, length };
            // The point itself in the last lane, another one beside it.
            let lanes = |vector: Vector3<f64>| {
                [0, 1, 2].map(|axis: usize| {
                    let mut numbers = [0.9 * vector[axis]; DOUBLE_LANES];
                    numbers[DOUBLE_LANES - 1] = vector[axis];
                    Doubles::from(numbers)
                })
            };
            let last = |numbers: Doubles| numbers.array()[DOUBLE_LANES - 1];
            let linear = scene.linear(lanes(point), lanes(normal), &frame);
            assert!(last(linear.shown) > 0.0);
            for k in 0..UNKNOWNS {
                let moved = |by: f64| {
                    let change = frame.change(&Row::ith(k, by));
                    let seen = scene.seen(lanes(change.apply(point)));
                    Vector3::from(scene.residual(&seen, lanes(change.rotation * normal)).map(last))
                };
                let difference = (moved(small) - moved(-small)) / (2.0 * small);
                for channel in 0..3 {
                    let jacobian = Row::from(linear.jacobian[channel].map(last));
                    // Relative to the row: a single entry may be zero.
                    let error = (jacobian[k] - difference[channel]).abs() / jacobian.norm();
                    assert!(error <= 1e-4, "{k}: {} {difference} {error}", jacobian[k]);
                }
            }
        }
    }
}
