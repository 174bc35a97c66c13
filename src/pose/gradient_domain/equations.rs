//! Sums over pairs of neighbours, for pose and light.

use nalgebra::{SMatrix, SVector};

use super::harmonics::SHADES;
use crate::pose::increment::{PoseMatrix, PoseVector, UNKNOWNS};
use crate::pose::products::Products;

/// Light of the three rotated channels over the harmonics of the depth view's own normals.
pub(super) type Lights = [SVector<f64, SHADES>; 3];
pub(super) type Gram = SMatrix<f64, SHADES, SHADES>;
type Cross = SMatrix<f64, UNKNOWNS, SHADES>;

pub(super) const NUMBERS: usize = UNKNOWNS + SHADES + 1;
const RESIDUAL: usize = NUMBERS - 1;
/// The numbers of a pair: derivatives by the pose, harmonics, residual; or without the pose.
pub(super) type PoseProducts = Products<NUMBERS>;
pub(super) type LightProducts = Products<{ SHADES + 1 }>;

impl<const N: usize> Products<N> {
    /// The inverse of the light's matrix with the information of its prior, and the products with the residual.
    pub fn light(&self, prior: &SVector<f64, SHADES>) -> Option<(Gram, SVector<f64, SHADES>)> {
        let first = N - 1 - SHADES;
        let mut gram = Gram::from_fn(|row, column| self.sums[first + row][first + column]);
        for k in 0..SHADES {
            gram[(k, k)] += prior[k];
        }
        let right = SVector::from_fn(|k, _| self.sums[N - 1][first + k]);
        Some((gram.cholesky()?.inverse(), right))
    }
}

impl PoseProducts {
    /// Matrix and gradient of the pose with the light eliminated. `present` is the light at which residuals were
    /// taken, whose prior pulls it to zero.
    pub fn reduced(
        &self,
        prior: &SVector<f64, SHADES>,
        present: &SVector<f64, SHADES>,
    ) -> Option<(PoseMatrix, PoseVector)> {
        let (inverse, right) = self.light(prior)?;
        let cross = Cross::from_fn(|row, column| self.sums[row][UNKNOWNS + column]);
        let projected = cross * inverse;
        let matrix = PoseMatrix::from_fn(|row, column| self.sums[row][column]) - projected * cross.transpose();
        let pull = right - prior.component_mul(present);
        let gradient = PoseVector::from_fn(|row, _| self.sums[RESIDUAL][row]) - projected * pull;
        Some((matrix, gradient))
    }
}
