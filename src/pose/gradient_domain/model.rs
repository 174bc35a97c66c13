//! Light, noise and channels under a pose.

use nalgebra::{Matrix3, SVector, Vector3};

use super::equations::{LightProducts, Lights};
use super::field::{CHANNELS, Field, Pair};
use super::harmonics::{LOW, SHADES};
use crate::numeric::eigen::symmetric_eigen;

/// Degrees of freedom of the t distribution of a pair, set on photographs (docs/lab/thresholds.md).
const NU: f32 = 1.0;
/// The same for the covariance of the channels, and the number of reweighted estimates of it.
const NU_OF_CHANNELS: f64 = 4.0;
const CHANNEL_FITS: usize = 4;
/// Error of a normal, radians, which neighbours do not share, set on photographs (docs/lab/thresholds.md). It limits the
/// weight of the finest shading.
const DELTA: f32 = 0.05;
/// Each pixel belongs to pairs in four directions, which count it twice.
const COUNTED: f32 = 2.0;
/// Smallest variance of a channel's differences and of a coefficient of the light.
const LEAST_VARIANCE: f64 = 1e-9;

/// Light, noise and channels; the light is that of the rotated channels.
#[derive(Clone)]
pub(super) struct Model {
    /// Axes of the rotated channels as columns.
    axes: Matrix3<f64>,
    pub lights: Lights,
    variance: [f64; CHANNELS],
    /// Inverse variances of the coefficients of the light.
    pub prior: [SVector<f64, SHADES>; CHANNELS],
}

/// A pair under a model.
pub(super) struct Fitted {
    pub difference: [f32; SHADES],
    pub residual: [f32; CHANNELS],
    variance: [f32; CHANNELS],
    weight: f32,
}

impl Fitted {
    /// Weight of a channel's squared residual in the equations.
    #[inline(always)]
    pub fn weight(&self, channel: usize) -> f32 {
        self.weight / (COUNTED * self.variance[channel])
    }
}

impl Model {
    pub fn new() -> Self {
        let (lights, prior) = (Lights::default(), [SVector::repeat(1.0); CHANNELS]);
        Self { axes: Matrix3::identity(), lights, variance: [1.0; CHANNELS], prior }
    }

    /// Rotates the values of all hits.
    pub fn rotate(&self, field: &mut Field) {
        let axes = self.axes.map(|value| value as f32);
        for value in &mut field.values {
            *value = axes.tr_mul(&nalgebra::Vector3::from(*value)).into();
        }
    }

    /// Chooses the channels as the principal axes of the differences that the light leaves, the greatest first, and
    /// rotates the values, which must not be rotated yet.
    pub fn rotate_channels(&mut self, field: &mut Field) {
        let lights: Lights =
            std::array::from_fn(|channel| (0..CHANNELS).map(|k| self.lights[k] * self.axes[(channel, k)]).sum());
        if let Some(eigen) = symmetric_eigen(&covariance(field, &lights)) {
            let mut order = [0, 1, 2];
            order.sort_by(|&a: &usize, &b| eigen.eigenvalues[b].total_cmp(&eigen.eigenvalues[a]));
            let axes = Matrix3::from_fn(|row, column| eigen.eigenvectors[(row, order[column])]);
            self.lights = std::array::from_fn(|channel| (0..CHANNELS).map(|k| lights[k] * axes[(k, channel)]).sum());
            self.axes = axes;
            self.variance = order.map(|k| eigen.eigenvalues[k].max(LEAST_VARIANCE));
        }
        self.rotate(field);
    }

    /// Residual, variance and weight of a pair.
    #[inline(always)]
    pub fn of_pair(&self, field: &Field, pair: &Pair) -> Fitted {
        let (difference, residual) = residual(field, pair, &self.lights);
        let [a, b] = [pair.first, pair.second].map(|k| &field.sensitivity[k as usize]);
        let variance: [f32; CHANNELS] =
            std::array::from_fn(|c| self.variance[c] as f32 + DELTA * DELTA * (a[c] + b[c]));
        let square: f32 = (0..CHANNELS).map(|c| residual[c] * residual[c] / variance[c]).sum();
        let weight = pair.weight * (NU + CHANNELS as f32) / (NU + square);
        Fitted { difference, residual, variance, weight }
    }

    /// One round: variances and light under new weights. `None` if the pairs do not determine the light.
    pub fn fit(&mut self, field: &mut Field) -> Option<()> {
        field.sense(&self.lights);
        let mut products = [LightProducts::ZERO; CHANNELS];
        let (mut squares, mut weights) = ([0.0_f64; CHANNELS], [0.0_f64; CHANNELS]);
        for pair in &field.pairs {
            let fitted = self.of_pair(field, pair);
            let [a, b] = [pair.first, pair.second].map(|k| &field.values[k as usize]);
            let mut numbers = [0.0; SHADES + 1];
            numbers[..SHADES].copy_from_slice(&fitted.difference);
            for c in 0..CHANNELS {
                let share = self.variance[c] as f32 / fitted.variance[c];
                squares[c] += f64::from(fitted.weight * fitted.residual[c] * fitted.residual[c] * share);
                weights[c] += f64::from(pair.weight * share);
                numbers[SHADES] = b[c] - a[c];
                products[c].add(&numbers, fitted.weight(c), 0);
            }
        }
        for (c, products) in products.iter_mut().enumerate() {
            products.flush();
            self.variance[c] = (squares[c] / weights[c].max(f64::MIN_POSITIVE)).max(LEAST_VARIANCE);
            let (inverse, right) = products.light(&self.prior[c])?;
            self.lights[c] = inverse * right;
            let expected = self.lights[c].component_mul(&self.lights[c]) + inverse.diagonal();
            let inverse_mean = |from: usize, count: usize| 1.0 / expected.rows(from, count).mean().max(LEAST_VARIANCE);
            let (low, high) = (inverse_mean(0, LOW), inverse_mean(LOW, SHADES - LOW));
            self.prior[c] = SVector::from_fn(|k, _| if k < LOW { low } else { high });
        }
        Some(())
    }
}

/// The difference of a pair's harmonics, and that of its values less shades.
#[inline(always)]
fn residual(field: &Field, pair: &Pair, lights: &Lights) -> ([f32; SHADES], [f32; CHANNELS]) {
    let [a, b] = [pair.first, pair.second].map(|k| k as usize);
    let difference: [f32; SHADES] = std::array::from_fn(|k| field.shades[b][k] - field.shades[a][k]);
    let residual = std::array::from_fn(|c| {
        let shade: f32 = difference.iter().zip(lights[c].iter()).map(|(d, l)| d * *l as f32).sum();
        field.values[b][c] - field.values[a][c] - shade
    });
    (difference, residual)
}

/// Robust covariance of the channels' differences that a light leaves.
fn covariance(field: &Field, lights: &Lights) -> Matrix3<f64> {
    let mut covariance = Matrix3::identity() * 0.01;
    for _ in 0..CHANNEL_FITS {
        let precision = covariance.try_inverse().unwrap_or_else(Matrix3::identity);
        let (mut sum, mut weights) = (Matrix3::zeros(), 0.0);
        for pair in &field.pairs {
            let residual = Vector3::from(residual(field, pair, lights).1.map(f64::from));
            let square = residual.dot(&(precision * residual));
            let own = f64::from(pair.weight);
            let weight = own * (NU_OF_CHANNELS + CHANNELS as f64) / (NU_OF_CHANNELS + square);
            sum.ger(weight, &residual, &residual, 1.0);
            weights += own;
        }
        covariance = sum / weights.max(f64::MIN_POSITIVE) + Matrix3::identity() * LEAST_VARIANCE;
    }
    covariance
}
