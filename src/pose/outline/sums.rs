//! Sums of a Gauss-Newton step over robust residuals.

use crate::numeric::robust;
use crate::pose::increment::{PoseMatrix, PoseVector};

/// One residual: how it changes with each unknown.
pub type Row = PoseVector;

/// Sums of a step.
pub struct Sums {
    pub matrix: PoseMatrix,
    pub gradient: PoseVector,
    pub cost: f64,
}

impl Sums {
    pub fn new() -> Self {
        Self { matrix: PoseMatrix::zeros(), gradient: PoseVector::zeros(), cost: 0.0 }
    }

    /// A residual under a robust function.
    pub fn add(&mut self, row: &Row, residual: f64, weight: f64, scale: f64) {
        let square = (residual / scale).powi(2);
        let robust = weight * robust::weight(square);
        self.cost += weight * robust::rho(residual * residual, square);
        self.matrix.syger(robust, row, row, 1.0);
        self.gradient.axpy(robust * residual, row, 1.0);
    }
}
