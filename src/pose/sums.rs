//! Sums over robust residuals for a Gauss-Newton step of the pose.

use crate::numeric::robust;
use crate::pose::increment::{PoseMatrix, PoseVector};

/// Matrix, gradient and cost. If the scale is infinite, a residual costs its square.
pub(super) struct Sums {
    /// Lower triangle of the matrix.
    pub matrix: PoseMatrix,
    pub gradient: PoseVector,
    pub cost: f64,
}

impl Sums {
    pub fn new() -> Self {
        Self { matrix: PoseMatrix::zeros(), gradient: PoseVector::zeros(), cost: 0.0 }
    }

    /// The whole matrix.
    pub fn symmetric(&self) -> PoseMatrix {
        let mut matrix = self.matrix;
        matrix.fill_upper_triangle_with_lower_triangle();
        matrix
    }

    /// Adds a residual under the robust function.
    pub fn add(&mut self, row: &PoseVector, residual: f64, weight: f64, scale: f64) {
        let square = (residual / scale).powi(2);
        let robust = weight * robust::weight(square);
        self.cost += weight * robust::rho(residual * residual, square);
        self.matrix.syger(robust, row, row, 1.0);
        self.gradient.axpy(robust * residual, row, 1.0);
    }
}
