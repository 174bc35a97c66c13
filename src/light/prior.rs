//! h(L) = (L - mu)^T Sigma^-1 (L - mu) with the exposure left free (Eq. 2; docs/method.md, section 3).
//!
//! A common offset of log S is the exposure and says nothing about the light. It moves L1 of all three channels alike,
//! along e = (1 at R1, G1, B1). Minimising h over that direction leaves the precision P = W^T (I - w w^T / w^T w) W
//! with the whitening W = C^-1 of Sigma = C C^T and w = W e: in whitened coordinates the prior is a unit ball flattened
//! along w.

use nalgebra::{SMatrix, SVector};

use crate::error::{Error, ErrorKind, Result};
use crate::light::harmonics::HARMONICS;
use crate::light::{Light, natural};

/// Coefficients of a light in all channels.
pub const COEFFICIENTS: usize = 3 * HARMONICS;

/// Vector of 27 coefficients R1..9, G1..9, B1..9.
pub type Coefficients = SVector<f64, COEFFICIENTS>;
/// Matrix over them.
pub type CoefficientMatrix = SMatrix<f64, COEFFICIENTS, COEFFICIENTS>;

/// A Gaussian over lights that does not depend on the exposure.
#[derive(Clone, Debug, PartialEq)]
pub struct LightPrior {
    mean: Coefficients,
    precision: CoefficientMatrix,
}

impl LightPrior {
    /// From a mean and a symmetric positive definite covariance in the order R1..9, G1..9, B1..9.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] naming `prior.mean` or `prior.covariance` where a number is not finite or the
    /// covariance is not positive definite.
    pub fn new(mean: &[f64; COEFFICIENTS], covariance: &CoefficientMatrix) -> Result<Self> {
        if let Some(index) = mean.iter().position(|value| !value.is_finite()) {
            return Err(Error::new(ErrorKind::Range, "prior.mean", "must be finite").at(index));
        }
        let bad = || Error::new(ErrorKind::Range, "prior.covariance", "must be symmetric positive definite");
        if covariance.iter().any(|value| !value.is_finite()) {
            return Err(bad());
        }
        let lower = covariance.cholesky().ok_or_else(bad)?.unpack();
        let whitening = lower.solve_lower_triangular(&CoefficientMatrix::identity()).ok_or_else(bad)?;
        let exposure = whitening * exposure_direction();
        let flattened = CoefficientMatrix::identity() - exposure * exposure.transpose() / exposure.norm_squared();
        Ok(Self { mean: Coefficients::from(*mean), precision: whitening.transpose() * flattened * whitening })
    }

    /// The natural lights: 1552 augmented environments of the sIBL archive, log shading.
    #[must_use]
    pub fn natural() -> Self {
        let covariance = CoefficientMatrix::from_fn(|row, column| {
            let (long, short) = (row.max(column), row.min(column));
            f64::from(natural::COVARIANCE[long * (long + 1) / 2 + short])
        });
        let Ok(prior) = Self::new(&natural::MEAN.map(f64::from), &covariance) else {
            unreachable!("the kept covariance is positive definite, as a test shows")
        };
        prior
    }

    /// h(L): squared Mahalanobis distance from the mean, least over all exposures.
    #[must_use]
    pub fn squared_distance(&self, light: &Light) -> f64 {
        let off = Coefficients::from(light.flat()) - self.mean;
        (self.precision * off).dot(&off)
    }

    /// The mean light.
    #[must_use]
    pub fn mean(&self) -> Light {
        Light(std::array::from_fn(|channel| std::array::from_fn(|k| self.mean[channel * HARMONICS + k])))
    }

    pub(crate) fn precision(&self) -> &CoefficientMatrix {
        &self.precision
    }

    pub(crate) fn mean_coefficients(&self) -> &Coefficients {
        &self.mean
    }
}

/// e: what one unit of exposure adds to the coefficients, up to a factor.
fn exposure_direction() -> Coefficients {
    Coefficients::from_fn(|row, _| if row % HARMONICS == 0 { 1.0 } else { 0.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_has_distance_zero_at_every_exposure() {
        let prior = LightPrior::natural();
        for offset in [-3.0, 0.0, 2.5] {
            assert!(prior.squared_distance(&prior.mean().exposed(offset)).abs() < 1e-9);
        }
    }

    #[test]
    fn another_light_has_a_distance() {
        let prior = LightPrior::natural();
        let mut light = prior.mean();
        light.0[0][3] += 1.0;
        let distance = prior.squared_distance(&light);
        assert!(distance > 1.0 && distance.is_finite());
    }

    #[test]
    fn a_covariance_that_is_not_positive_definite_is_refused() {
        let error = LightPrior::new(&[0.0; COEFFICIENTS], &CoefficientMatrix::zeros()).unwrap_err();
        assert_eq!(error.field(), "prior.covariance");
    }
}
