//! Residuals of depth points, several side by side: r = log S(pi(T P)) - B(R n) L and its derivatives.
//!
//! The unknowns are those of every registration here: P' -> c + e^u exp([w]) (P' - c) + l v for the transformed point
//! P' = T P, and n' -> exp([w]) n' for its rotated normal. With g = d log S / d P' and b = d (B L) / d n' of one
//! channel, the derivatives are dr/dw = (P' - c) x g - n' x b, dr/dv = l g, dr/du = (P' - c) . g and dr/dL = -B.

use crate::light::{HARMONICS, Light, Polynomial, basis};
use crate::numeric::{DOUBLE_LANES, Doubles, Real, dot};
use crate::pose::increment::{Frame, UNKNOWNS};
use crate::pose::spline_image::{ImagePoint, SplineImage};
use crate::view::Camera;

/// Derivative by the unknowns of the pose.
pub(super) type Derivative = [Doubles; UNKNOWNS];

/// The colours of one image, and those that one light predicts (Eq. 3 and 5).
#[derive(Clone, Copy)]
pub(super) struct ColourModel<'a> {
    image: &'a SplineImage,
    /// The image whose gradients are the instrumental variables; none for least squares.
    instruments: Option<&'a SplineImage>,
    camera: &'a Camera,
    light: [Polynomial<f64>; 3],
}

/// log S at points side by side, zero where the image does not show them.
#[derive(Clone, Copy)]
pub(super) struct Samples {
    /// One if the image shows the point, otherwise zero.
    pub shown: Doubles,
    /// log S of the three channels.
    pub log: [Doubles; 3],
}

/// Residuals of points side by side, with the quantities that the equations need.
pub(super) struct LinearisedPoints {
    pub shown: Doubles,
    /// A number for each channel.
    pub residual: [Doubles; 3],
    /// d r / d unknowns, one row for each channel.
    pub jacobian: [Derivative; 3],
    /// Z: derivatives that use the gradients of another image, if the model has one.
    instruments: Option<[Derivative; 3]>,
    /// d column, d row / d unknowns.
    pub pixel_derivatives: [Derivative; 2],
    /// Harmonics of the rotated normal.
    pub basis: [Doubles; HARMONICS],
}

impl LinearisedPoints {
    /// Z: the instrumental variables, or the Jacobian for least squares.
    pub fn instruments(&self) -> &[Derivative; 3] {
        self.instruments.as_ref().unwrap_or(&self.jacobian)
    }
}

impl<'a> ColourModel<'a> {
    /// A model for least squares; `light` includes its exposure.
    pub fn new(image: &'a SplineImage, camera: &'a Camera, light: &Light) -> Self {
        Self { image, instruments: None, camera, light: Polynomial::of(light) }
    }

    /// This model with the gradients of another image as instrumental variables.
    pub fn with_instruments(self, image: &'a SplineImage) -> Self {
        Self { instruments: Some(image), ..self }
    }

    /// Whether there are instrumental variables.
    pub fn has_instruments(&self) -> bool {
        self.instruments.is_some()
    }

    /// r of sampled points, given their rotated normals.
    #[inline(always)]
    pub fn residual(&self, samples: &Samples, normals: [Doubles; 3]) -> [Doubles; 3] {
        let [red, green, blue] = &self.light;
        let [log_red, log_green, log_blue] = samples.log;
        [log_red - red.shade(normals), log_green - green.shade(normals), log_blue - blue.shade(normals)]
    }

    /// log S at the image positions of transformed points.
    // Not inlined, because every copy adds to the download.
    #[inline(never)]
    pub fn sample(&self, points: [Doubles; 3]) -> Samples {
        let (mut shown, mut log) = ([0.0; DOUBLE_LANES], [[0.0; DOUBLE_LANES]; 3]);
        for (lane, shown) in shown.iter_mut().enumerate() {
            let pixel = self.camera.project(self.image.size(), of_lane(points, lane));
            let Some(colours) = pixel.and_then(|pixel| self.image.value(pixel)) else { continue };
            *shown = 1.0;
            (0..3).for_each(|channel| log[channel][lane] = colours[channel]);
        }
        Samples { shown: Doubles::from(shown), log: triple(&log) }
    }

    /// r and its derivatives.
    // Not inlined, like `sample`.
    #[inline(never)]
    pub fn linearise(&self, points: [Doubles; 3], normals: [Doubles; 3], frame: &Frame) -> LinearisedPoints {
        let mut sampled = SampledGradients::default();
        for lane in 0..DOUBLE_LANES {
            self.sample_gradients(of_lane(points, lane), lane, &mut sampled);
        }
        let pixel_derivatives = pixel_derivatives(points, &sampled, frame);
        let (mut residual, mut by_rotation) = (triple(&sampled.log), [normals; 3]);
        for (channel, light) in self.light.iter().enumerate() {
            let (shade, by_normal) = light.expand(normals);
            by_rotation[channel] = cross(normals, by_normal);
            residual[channel] = residual[channel] - shade;
        }
        let rows = |gradient: &[[[f64; DOUBLE_LANES]; 2]; 3]| {
            let row = |channel: usize| row(&pixel_derivatives, &gradient[channel], by_rotation[channel]);
            [row(0), row(1), row(2)]
        };
        LinearisedPoints {
            shown: Doubles::from(sampled.shown),
            residual,
            jacobian: rows(&sampled.gradient),
            instruments: self.instruments.map(|_| rows(&sampled.instruments)),
            pixel_derivatives,
            basis: basis(normals),
        }
    }

    /// Samples the image at one point for its lane.
    fn sample_gradients(&self, point: [f64; 3], lane: usize, sampled: &mut SampledGradients) {
        let Some((pixel, by_point)) = self.camera.project_with_gradient(self.image.size(), point) else { return };
        let Some(ImagePoint { log, gradient }) = self.image.at(pixel) else { return };
        let other = self.instruments.and_then(|image| image.at(pixel));
        let instruments = other.map_or(gradient, |point| point.gradient);
        sampled.shown[lane] = 1.0;
        for channel in 0..3 {
            sampled.log[channel][lane] = log[channel];
            for along in 0..2 {
                sampled.gradient[channel][along][lane] = gradient[channel][along];
                sampled.instruments[channel][along][lane] = instruments[channel][along];
            }
        }
        for along in 0..2 {
            (0..3).for_each(|axis| sampled.by_point[along][axis][lane] = by_point[along][axis]);
        }
    }
}

/// Values and gradients of the image at one point for each lane, zero for points that the image does not show.
#[derive(Default)]
struct SampledGradients {
    shown: [f64; DOUBLE_LANES],
    log: [[f64; DOUBLE_LANES]; 3],
    /// d log S / d (column, row) of each channel, and the same for the image of the instruments.
    gradient: [[[f64; DOUBLE_LANES]; 2]; 3],
    instruments: [[[f64; DOUBLE_LANES]; 2]; 3],
    /// d (column, row) / d point.
    by_point: [[[f64; DOUBLE_LANES]; 3]; 2],
}

/// d column and d row / d unknowns.
#[inline(always)]
fn pixel_derivatives(points: [Doubles; 3], sampled: &SampledGradients, frame: &Frame) -> [Derivative; 2] {
    let arm = |axis: usize| points[axis] - Doubles::splat(frame.centre[axis]);
    let arm = [arm(0), arm(1), arm(2)];
    let length = Doubles::splat(frame.length);
    let by = |along: usize| {
        let gradient = triple(&sampled.by_point[along]);
        let [x, y, z] = cross(arm, gradient);
        [x, y, z, length * gradient[0], length * gradient[1], length * gradient[2], dot(arm, gradient)]
    };
    [by(0), by(1)]
}

/// d r / d unknowns of one channel: the part that follows from the pixel minus the part that follows from the rotated normal.
#[inline(always)]
fn row(pixel: &[Derivative; 2], gradient: &[[f64; DOUBLE_LANES]; 2], by_rotation: [Doubles; 3]) -> Derivative {
    let [by_column, by_row] = [Doubles::from(gradient[0]), Doubles::from(gradient[1])];
    let mut row = pixel[0];
    for (entry, &below) in row.iter_mut().zip(&pixel[1]) {
        *entry = *entry * by_column + below * by_row;
    }
    (0..3).for_each(|axis| row[axis] = row[axis] - by_rotation[axis]);
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
    use crate::pose::increment::PoseVector;
    use crate::scenes::lights::COLOURFUL;
    use crate::view::{ColourImage, ColourSamples, ColourView, Lens, Pinhole};

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
        let lens = Lens::brown(&[0.1, -0.05, 0.003, -0.002, 0.0]).unwrap();
        let pinhole = Camera::Pinhole(Pinhole { fx: 50.0, fy: 48.0, cx: 19.0, cy: 15.0, lens });
        let normal = Vector3::new(0.36, -0.48, -0.8);
        // Colours are rounded to f32, so a difference over a smaller step would show only rounding.
        let small = 3e-3;
        for (camera, point, length) in
            [(Camera::Orthographic, Vector3::new(3.3, -4.2, 7.0), 9.0), (pinhole, Vector3::new(0.21, -0.13, 1.2), 0.2)]
        {
            let model = ColourModel::new(&image, &camera, &COLOURFUL);
            let frame = Frame { centre: 0.7 * point, length };
            // The point itself in the last lane, other points beside it.
            let lanes = |vector: Vector3<f64>| {
                [0, 1, 2].map(|axis: usize| {
                    let mut numbers = [0.9 * vector[axis]; DOUBLE_LANES];
                    numbers[DOUBLE_LANES - 1] = vector[axis];
                    Doubles::from(numbers)
                })
            };
            let last = |numbers: Doubles| numbers.array()[DOUBLE_LANES - 1];
            let linearised = model.linearise(lanes(point), lanes(normal), &frame);
            assert!(last(linearised.shown) > 0.0);
            for k in 0..UNKNOWNS {
                let moved = |by: f64| {
                    let change = frame.change(&PoseVector::ith(k, by));
                    let samples = model.sample(lanes(change.apply(point)));
                    Vector3::from(model.residual(&samples, lanes(change.rotation * normal)).map(last))
                };
                let difference = (moved(small) - moved(-small)) / (2.0 * small);
                for channel in 0..3 {
                    let jacobian = PoseVector::from(linearised.jacobian[channel].map(last));
                    // The tolerance is relative to the row, because a single entry may be zero.
                    let error = (jacobian[k] - difference[channel]).abs() / jacobian.norm();
                    assert!(error <= 1e-4, "{k}: {} {difference} {error}", jacobian[k]);
                }
            }
        }
    }
}
