//! The bias by which white noise of the normals raises sums of products f g of two functions of the normals:
//! sum w var (f_a g_a + f_b g_b), where f_a and f_b are the slopes of f along two tangents of a normal
//! (docs/method/registration.md).
//!
//! Residuals and derivatives depend on the normals through linear functions of the harmonics. One matrix therefore
//! suffices, the same sum over pairs of harmonics.

use nalgebra::SMatrix;

use crate::light::{HARMONICS, basis_gradient};
use crate::numeric::{Doubles, Real, dot};

/// One sum for each pair of harmonics, up to the diagonal.
pub(super) struct NormalNoise([[Doubles; HARMONICS]; HARMONICS]);

impl NormalNoise {
    /// Sums over no normals yet.
    pub fn new() -> Self {
        Self([[Doubles::splat(0.0); HARMONICS]; HARMONICS])
    }

    /// Adds several normals at once; `weight` includes their variance along each tangent.
    // Not inlined, because it would be unrolled into the loop over the points.
    #[inline(never)]
    pub fn add(&mut self, normals: [Doubles; 3], weight: Doubles) {
        let gradient = basis_gradient(normals);
        for (row, sums) in self.0.iter_mut().enumerate() {
            // Only slopes across the normal count, because a normal stays a unit vector.
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
