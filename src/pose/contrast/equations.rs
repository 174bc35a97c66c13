//! The equations of a pose with the light eliminated. Each channel has a separate light; all channels share their
//! weights.

use nalgebra::{SMatrix, SVector};

use crate::pose::increment::{PoseMatrix, PoseVector, UNKNOWNS, damped_step};
use crate::pose::products::Products;

/// Number of harmonics of orders one and two; the constant one has no contrast.
pub(super) const SHADES: usize = 8;

/// Light of the three channels over the harmonics of the depth view's own normals.
pub(super) type Lights = [SVector<f64, SHADES>; 3];
type Gram = SMatrix<f64, SHADES, SHADES>;
/// One row for each unknown of the pose, one column for each harmonic.
type Cross = SMatrix<f64, UNKNOWNS, SHADES>;

/// Ridge on the diagonal, as a share of the trace. It bounds combinations of harmonics that the points cannot
/// distinguish.
const RIDGE: f64 = 1e-4;

/// Length of the vector of one channel at a point: derivatives by the pose, harmonics, residual.
const NUMBERS: usize = UNKNOWNS + SHADES + 1;
const RESIDUAL: usize = NUMBERS - 1;
/// Sums over points.
pub(super) struct Equations {
    channels: [Products<NUMBERS>; 3],
    /// Matrix and gradient of the residuals that do not depend on the light.
    pose: PoseMatrix,
    gradient: PoseVector,
}

impl Equations {
    pub fn new() -> Self {
        Self { channels: [Products::ZERO; 3], pose: PoseMatrix::zeros(), gradient: PoseVector::zeros() }
    }

    /// Adds a point: its harmonics, and for each channel its residual and derivative by the pose.
    pub fn add(&mut self, shades: &[f32; SHADES], residual: [f64; 3], by_pose: &[[f32; UNKNOWNS]], weight: f64) {
        for ((products, residual), row) in self.channels.iter_mut().zip(residual).zip(by_pose) {
            let mut numbers = [residual as f32; NUMBERS];
            numbers[..UNKNOWNS].copy_from_slice(row);
            numbers[UNKNOWNS..RESIDUAL].copy_from_slice(shades);
            products.add(&numbers, weight as f32, 0);
        }
    }

    /// Adds a point to the equations of the light without the pose.
    pub fn add_shades(&mut self, shades: &[f32; SHADES], residual: [f64; 3], weight: f64) {
        for (products, residual) in self.channels.iter_mut().zip(residual) {
            let mut numbers = [0.0; NUMBERS];
            numbers[UNKNOWNS..RESIDUAL].copy_from_slice(shades);
            numbers[RESIDUAL] = residual as f32;
            products.add(&numbers, weight as f32, UNKNOWNS);
        }
    }

    /// Adds a residual that does not depend on the light.
    pub fn add_row(&mut self, row: &PoseVector, residual: f64, weight: f64) {
        self.pose.ger(weight, row, row, 1.0);
        self.gradient.axpy(weight * residual, row, 1.0);
    }

    /// D^-1 of a channel; all three have the same weights.
    fn inverse_gram(&mut self) -> Option<Gram> {
        self.channels.iter_mut().for_each(Products::flush);
        let sums = &self.channels[0].sums;
        let gram = Gram::from_fn(|row, column| sums[UNKNOWNS + row][UNKNOWNS + column]);
        let ridge = Gram::identity() * (RIDGE * gram.trace() / SHADES as f64);
        Some((gram + ridge).cholesky()?.inverse())
    }

    fn shade_gradients(&self) -> Lights {
        [0, 1, 2].map(|channel: usize| SVector::from_fn(|k, _| self.channels[channel].sums[RESIDUAL][UNKNOWNS + k]))
    }

    /// The step of the light under a fixed pose. The residual is r = v - B L, so its derivative is -B.
    pub fn light_step(&mut self) -> Option<Lights> {
        let inverse = self.inverse_gram()?;
        Some(self.shade_gradients().map(|gradient| inverse * gradient))
    }

    /// Matrix and gradient of the pose with the light eliminated.
    pub fn reduced(&mut self) -> Option<Reduced> {
        let inverse_gram = self.inverse_gram()?;
        let shade_gradient = self.shade_gradients();
        let (mut matrix, mut gradient) = (self.pose, self.gradient);
        let mut projected = [Cross::zeros(); 3];
        for ((Products { sums, .. }, shade_gradient), projected) in
            self.channels.iter().zip(&shade_gradient).zip(&mut projected)
        {
            let cross = Cross::from_fn(|row, column| sums[row][UNKNOWNS + column]);
            *projected = cross * inverse_gram;
            matrix += PoseMatrix::from_fn(|row, column| sums[row][column]) - *projected * cross.transpose();
            gradient += PoseVector::from_fn(|row, _| sums[RESIDUAL][row]) - *projected * shade_gradient;
        }
        Some(Reduced { matrix, gradient, inverse_gram, projected, shade_gradient })
    }
}

/// The equations of the pose without the light.
pub(super) struct Reduced {
    pub matrix: PoseMatrix,
    gradient: PoseVector,
    inverse_gram: Gram,
    /// C D^-1 of each channel.
    projected: [Cross; 3],
    shade_gradient: Lights,
}

impl Reduced {
    /// The damped step of the pose, and the step of the light that follows from it.
    pub fn step(&self, damping: f64, held: &[bool; UNKNOWNS]) -> Option<(PoseVector, Lights)> {
        let step = damped_step(self.matrix, self.gradient, damping, held)?;
        let light = |channel: usize| {
            self.inverse_gram * self.shade_gradient[channel] + self.projected[channel].transpose() * step
        };
        Some((step, [light(0), light(1), light(2)]))
    }

    /// A point's contribution to the gradient per weight, with the light eliminated.
    pub fn score(&self, shades: &[f32; SHADES], residual: [f64; 3], by_pose: &[[f32; UNKNOWNS]]) -> PoseVector {
        let shades = SVector::from(shades.map(f64::from));
        let mut score = PoseVector::zeros();
        for ((row, projected), residual) in by_pose.iter().zip(&self.projected).zip(residual) {
            score += (PoseVector::from(row.map(f64::from)) - projected * shades) * residual;
        }
        score
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{DMatrix, DVector};

    /// A number between -1 and 1 that looks random.
    fn wild(seed: usize) -> f64 {
        (12.9898 * (seed + 1) as f64).sin() * 43758.5453 % 1.0
    }

    #[test]
    fn the_step_is_that_of_pose_and_light_together() {
        let (light_unknowns, points) = (3 * SHADES, 200);
        let mut equations = Equations::new();
        let mut matrix = DMatrix::<f64>::zeros(UNKNOWNS + light_unknowns, UNKNOWNS + light_unknowns);
        let mut gradient = DVector::<f64>::zeros(UNKNOWNS + light_unknowns);
        for point in 0..points {
            let number = |k: usize| wild(97 * point + k) as f32;
            let shades: [f32; SHADES] = std::array::from_fn(number);
            let rows: [[f32; UNKNOWNS]; 3] = std::array::from_fn(|c| std::array::from_fn(|k| number(10 + 8 * c + k)));
            let residual = std::array::from_fn(|c| f64::from(number(40 + c)));
            let weight = 0.5 + 0.4 * f64::from(number(50));
            equations.add(&shades, residual, &rows, weight);
            for channel in 0..3 {
                let mut row = DVector::<f64>::zeros(UNKNOWNS + light_unknowns);
                (0..UNKNOWNS).for_each(|k| row[k] = f64::from(rows[channel][k]));
                (0..SHADES).for_each(|k| row[UNKNOWNS + channel * SHADES + k] = -f64::from(shades[k]));
                matrix += weight * &row * row.transpose();
                gradient += weight * residual[channel] * row;
            }
        }
        let trace: f64 = (0..SHADES).map(|k| matrix[(UNKNOWNS + k, UNKNOWNS + k)]).sum();
        (UNKNOWNS..UNKNOWNS + light_unknowns).for_each(|k| matrix[(k, k)] += RIDGE * trace / SHADES as f64);
        let whole = -matrix.cholesky().expect("well determined").solve(&gradient);
        let (pose, light) = equations.reduced().and_then(|reduced| reduced.step(0.0, &[false; UNKNOWNS])).unwrap();
        for k in 0..UNKNOWNS {
            assert!((pose[k] - whole[k]).abs() < 1e-4, "{k}: {} {}", pose[k], whole[k]);
        }
        for k in 0..light_unknowns {
            assert!((light[k / SHADES][k % SHADES] - whole[UNKNOWNS + k]).abs() < 1e-4, "{k}");
        }
    }
}
