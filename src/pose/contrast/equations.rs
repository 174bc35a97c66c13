//! The equations of a pose whose light follows it: each channel has a light of its own, over the same weights.

use nalgebra::{SMatrix, SVector};

use crate::pose::increment::{PoseMatrix, PoseVector, UNKNOWNS, fix_unknowns};

/// Harmonics of order one and two: the constant one has no contrast.
pub(super) const SHADES: usize = 8;

/// Light of the three channels over the harmonics of the depth view's own normals.
pub(super) type Lights = [SVector<f64, SHADES>; 3];
type Gram = SMatrix<f64, SHADES, SHADES>;

/// A share of the trace that keeps harmonics that the points do not tell apart from growing without bound.
const RIDGE: f64 = 1e-4;

/// Sums over points.
pub(super) struct Equations {
    pose: PoseMatrix,
    gradient: PoseVector,
    gram: Gram,
    /// One for each channel: d r / d pose times the harmonics, and r times the harmonics.
    cross: [SMatrix<f64, UNKNOWNS, SHADES>; 3],
    shade_gradient: Lights,
}

impl Equations {
    pub fn new() -> Self {
        Self {
            pose: PoseMatrix::zeros(),
            gradient: PoseVector::zeros(),
            gram: Gram::zeros(),
            cross: [SMatrix::zeros(); 3],
            shade_gradient: [SVector::zeros(); 3],
        }
    }

    /// Enters a point: its harmonics and, for each channel, residual and derivative by the pose.
    pub fn add(&mut self, shades: &[f32; SHADES], residual: [f64; 3], by_pose: &[[f32; UNKNOWNS]; 3], weight: f64) {
        let shades = SVector::from(shades.map(f64::from));
        self.gram.ger(weight, &shades, &shades, 1.0);
        for channel in 0..3 {
            let row = PoseVector::from(by_pose[channel].map(f64::from));
            self.pose.ger(weight, &row, &row, 1.0);
            self.gradient.axpy(weight * residual[channel], &row, 1.0);
            self.cross[channel].ger(weight, &row, &shades, 1.0);
            self.shade_gradient[channel].axpy(weight * residual[channel], &shades, 1.0);
        }
    }

    /// Enters a point for the light alone.
    pub fn add_shades(&mut self, shades: &[f32; SHADES], residual: [f64; 3], weight: f64) {
        let shades = SVector::from(shades.map(f64::from));
        self.gram.ger(weight, &shades, &shades, 1.0);
        for channel in 0..3 {
            self.shade_gradient[channel].axpy(weight * residual[channel], &shades, 1.0);
        }
    }

    /// Enters a residual that the light has no part in.
    pub fn add_row(&mut self, row: &PoseVector, residual: f64, weight: f64) {
        self.pose.ger(weight, row, row, 1.0);
        self.gradient.axpy(weight * residual, row, 1.0);
    }

    fn inverse_gram(&self) -> Option<Gram> {
        let ridge = Gram::identity() * (RIDGE * self.gram.trace() / SHADES as f64);
        (self.gram + ridge).try_inverse()
    }

    /// The step of the light alone; r = v - B L, so that its derivative is -B.
    pub fn light_step(&self) -> Option<Lights> {
        let inverse = self.inverse_gram()?;
        Some(self.shade_gradient.map(|gradient| inverse * gradient))
    }

    /// The matrix and gradient of the pose once the light follows it.
    pub fn reduced(&self) -> Option<Reduced> {
        let inverse = self.inverse_gram()?;
        let (mut matrix, mut gradient) = (self.pose, self.gradient);
        for (cross, shade_gradient) in self.cross.iter().zip(&self.shade_gradient) {
            let projected = cross * inverse;
            matrix -= projected * cross.transpose();
            gradient -= projected * shade_gradient;
        }
        let projected = self.cross.map(|cross| cross * inverse);
        Some(Reduced { matrix, gradient, inverse_gram: inverse, projected, shade_gradient: self.shade_gradient })
    }
}

/// The pose's own system.
pub(super) struct Reduced {
    pub matrix: PoseMatrix,
    gradient: PoseVector,
    inverse_gram: Gram,
    /// C D^-1 of each channel.
    projected: [SMatrix<f64, UNKNOWNS, SHADES>; 3],
    shade_gradient: Lights,
}

impl Reduced {
    /// The damped step of the pose, and that of the light which follows it.
    pub fn step(&self, damping: f64, held: &[bool; UNKNOWNS]) -> Option<(PoseVector, Lights)> {
        let mut matrix = self.matrix;
        let mut gradient = self.gradient;
        for k in 0..UNKNOWNS {
            matrix[(k, k)] *= 1.0 + damping;
            if held[k] {
                gradient[k] = 0.0;
            }
        }
        fix_unknowns(&mut matrix, held);
        let step = -matrix.cholesky()?.solve(&gradient);
        if !step.norm().is_finite() {
            return None;
        }
        let light = |channel: usize| {
            self.inverse_gram * self.shade_gradient[channel] + self.projected[channel].transpose() * step
        };
        Some((step, [light(0), light(1), light(2)]))
    }

    /// A point's share of the gradient per weight, once the light has followed.
    pub fn score(&self, shades: &[f32; SHADES], residual: [f64; 3], by_pose: &[[f32; UNKNOWNS]]) -> PoseVector {
        let shades = SVector::from(shades.map(f64::from));
        let mut score = PoseVector::zeros();
        for ((row, projected), residual) in by_pose.iter().zip(&self.projected).zip(residual) {
            score += (PoseVector::from(row.map(f64::from)) - projected * shades) * residual;
        }
        score
    }
}
