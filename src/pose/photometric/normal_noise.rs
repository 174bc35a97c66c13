//! What white noise of the normals adds to sums of products of their functions: sum w var (f_a g_a + f_b g_b), f_a and
//! f_b the slopes of f along two tangents of a normal (docs/method/registration.md).
//!
//! Residuals and derivatives owe to the normals linear functions of the harmonics, so that one matrix holds it all: the
//! same sum over the harmonics alone.

use nalgebra::SMatrix;

use crate::light::{HARMONICS, basis_gradient};
use crate::numeric::{Doubles, Real, dot};

/// A product for each two harmonics, up to the diagonal.
pub(super) struct NormalNoise([[Doubles; HARMONICS]; HARMONICS]);

impl NormalNoise {
    /// No normals yet.
    pub fn new() -> Self {
        Self([[Doubles::splat(0.0); HARMONICS]; HARMONICS])
    }

    /// Enters normals side by side, whose variance along each tangent is in their weight.
    // Once for two points: it would be unrolled into their loop.
    #[inline(never)]
    pub fn add(&mut self, normals: [Doubles; 3], weight: Doubles) {
        let gradient = basis_gradient(normals);
        for (row, sums) in self.0.iter_mut().enumerate() {
            // Across the normal, which stays a unit vector.
            let along = dot(gradient[row], normals);
            let across = [0, 1, 2].map(|axis: usize| weight * (gradient[row][axis] - along * normals[axis]));
            for (sum, &other) in sums.iter_mut().zip(&gradient[..=row]) {
                *sum = *sum + dot(across, other);
            }
        }
    }

    pub fn matrix(&self) -> SMatrix<f64, HARMONICS, HARMONICS> {
        SMatrix::from_fn(|row, column| self.0[row.max(column)][row.min(column)].sum())
    }
}
