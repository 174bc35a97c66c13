//! One depth point's residual r = log S(pi(T P)) - B(R n) L and its derivatives.
//!
//! The unknowns are those of every registration here: P' -> c + e^u exp([w]) (P' - c) + l v of the carried point P' = T
//! P, n' -> exp([w]) n' of its normal. With g = d log S / d P' and b = d (B L) / d n', both of one channel, dr/dw = (P'
//! - c) x g - n' x b, dr/dv = l g, dr/du = (P' - c) . g, and dr/dL = -B.

use nalgebra::{Matrix3, Vector3};

use super::image::{ImagePoint, SplineImage};
use crate::light::{HARMONICS, Light, basis, basis_gradient};
use crate::pose::increment::{Frame, Row};
use crate::view::Camera;

/// Where residuals are taken: one image under one light.
#[derive(Clone, Copy)]
pub(super) struct Scene<'a> {
    pub image: &'a SplineImage,
    /// Where the slopes of the listening rows come from, when not from the image itself.
    pub slopes: Option<&'a SplineImage>,
    pub camera: &'a Camera,
    /// Exposure included.
    pub light: &'a Light,
}

/// A residual with what the equations need of it.
pub(super) struct Linear {
    pub residual: Vector3<f64>,
    /// d r / d unknowns, a row for each channel.
    pub jacobian: [Row; 3],
    /// The same with the slopes of [`Scene::slopes`].
    pub listener: [Row; 3],
    /// Harmonics of the carried normal.
    pub basis: [f64; HARMONICS],
}

impl Scene<'_> {
    /// r at a carried point with its carried normal; `None` where the image does not show it.
    pub fn residual(&self, point: &Vector3<f64>, normal: &Vector3<f64>) -> Option<Vector3<f64>> {
        let log = self.seen(point)?;
        Some(Vector3::from(log) - Vector3::from(self.light.shade((*normal).into())))
    }

    /// log S where a carried point is seen; `None` where the image does not show it.
    pub fn seen(&self, point: &Vector3<f64>) -> Option<[f64; 3]> {
        self.image.value(self.camera.project(self.image.size(), (*point).into())?)
    }

    /// r and its derivatives.
    pub fn linear(&self, point: &Vector3<f64>, normal: &Vector3<f64>, frame: &Frame) -> Option<Linear> {
        let (pixel, motion) = self.motion(point, frame)?;
        let seen = self.image.at(pixel)?;
        let basis = basis((*normal).into());
        let shade = self.light.of_basis(&basis);
        let by_normal = self.shade_gradient(normal);
        let rows = |seen: &ImagePoint| {
            std::array::from_fn(|channel| {
                let [by_column, by_row] = seen.gradient[channel];
                let mut row = motion[0] * by_column + motion[1] * by_row;
                let turn = normal.cross(&by_normal.row(channel).transpose());
                (0..3).for_each(|axis| row[axis] -= turn[axis]);
                row
            })
        };
        let jacobian = rows(&seen);
        let listener = match self.slopes {
            None => jacobian,
            Some(slopes) => rows(&slopes.at(pixel)?),
        };
        let residual = Vector3::from(seen.log) - Vector3::from(shade);
        Some(Linear { residual, jacobian, listener, basis })
    }

    /// The pixel of a carried point and its derivatives by the unknowns, of the column and of the row.
    pub fn motion(&self, point: &Vector3<f64>, frame: &Frame) -> Option<([f64; 2], [Row; 2])> {
        let (pixel, by_point) = self.camera.project_with_gradient(self.image.size(), (*point).into())?;
        let arm = point - frame.centre;
        let motion = by_point.map(|slope| {
            let slope = Vector3::from(slope);
            let (turn, shift) = (arm.cross(&slope), frame.length * slope);
            Row::from([turn.x, turn.y, turn.z, shift.x, shift.y, shift.z, arm.dot(&slope)])
        });
        Some((pixel, motion))
    }

    /// d (B L) / d n, a row for each channel.
    fn shade_gradient(&self, normal: &Vector3<f64>) -> Matrix3<f64> {
        let gradient = basis_gradient((*normal).into());
        Matrix3::from_fn(|channel, axis| (0..HARMONICS).map(|k| self.light.0[channel][k] * gradient[k][axis]).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pose::increment::UNKNOWNS;
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
        let small = 1e-4;
        for (camera, point, length) in
            [(Camera::Orthographic, Vector3::new(3.3, -4.2, 7.0), 9.0), (pinhole, Vector3::new(0.21, -0.13, 1.2), 0.2)]
        {
            let scene = Scene { image: &image, slopes: None, camera: &camera, light: &COLOURFUL };
            let frame = Frame { centre: 0.7 * point, length };
            let linear = scene.linear(&point, &normal, &frame).unwrap();
            for k in 0..UNKNOWNS {
                let moved = |by: f64| {
                    let change = frame.change(&Row::ith(k, by));
                    scene.residual(&change.apply(point), &(change.rotation * normal)).unwrap()
                };
                let difference = (moved(small) - moved(-small)) / (2.0 * small);
                for channel in 0..3 {
                    let analytic = linear.jacobian[channel][k];
                    // Relative to the row: a single entry may be zero.
                    let size = linear.jacobian[channel].norm();
                    assert!((analytic - difference[channel]).abs() <= 1e-5 * size, "{k}: {analytic} {difference}");
                }
            }
        }
    }
}
