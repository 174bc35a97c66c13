//! h(L) = (L - mu)^T Sigma^-1 (L - mu), minimised over the exposure (Eq. 2; docs/method/image-model.md).
//!
//! A common offset of log S is the exposure and carries no information about the light. It moves L1 of all three
//! channels alike, along e = (1 at R1, G1, B1). Minimising h along that direction leaves the precision P = W^T (I - w
//! w^T / w^T w) W with the whitening W = C^-1 of Sigma = C C^T and w = W e. In whitened coordinates the prior is a unit
//! ball flattened along w.

use nalgebra::{SMatrix, SVector};

use crate::error::{Error, ErrorKind, Result};
use crate::light::harmonics::HARMONICS;
use crate::light::{Light, environments};

/// Number of coefficients of a light over all channels.
pub const COEFFICIENTS: usize = 3 * HARMONICS;

/// A vector of 27 coefficients R1..9, G1..9, B1..9.
pub type Coefficients = SVector<f64, COEFFICIENTS>;
/// A matrix over these coefficients.
pub type CoefficientMatrix = SMatrix<f64, COEFFICIENTS, COEFFICIENTS>;

/// Largest difference of a covariance from its transpose, as a share of its largest entry, which allows for rounding to
/// six digits.
const ASYMMETRY: f64 = 1e-5;
/// Largest precision: a standard deviation of one millionth, far below what any image determines.
const MOST_PRECISION: f64 = 1e12;

/// Mean and covariance of lights from the caller, in the order R1..9, G1..9, B1..9.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(deny_unknown_fields))]
pub struct LightGaussian {
    /// 27 numbers.
    pub mean: Vec<f64>,
    /// 27x27 numbers, row after row; symmetric and positive definite.
    #[cfg_attr(feature = "serde", serde(deserialize_with = "row_after_row"))]
    pub covariance: Vec<f64>,
}

/// Reads a matrix from one list or from a list of rows.
#[cfg(feature = "serde")]
fn row_after_row<'de, D: serde::Deserializer<'de>>(deserializer: D) -> std::result::Result<Vec<f64>, D::Error> {
    #[derive(serde::Deserialize)]
    #[serde(untagged, expecting = "must be a list of numbers or of rows of numbers")]
    enum Given {
        List(Vec<f64>),
        Rows(Vec<Vec<f64>>),
    }
    serde::Deserialize::deserialize(deserializer).map(|given| match given {
        Given::List(numbers) => numbers,
        Given::Rows(rows) => rows.concat(),
    })
}

/// A Gaussian over lights that does not depend on the exposure.
#[derive(Clone, Debug, PartialEq)]
pub struct LightPrior {
    mean: Coefficients,
    precision: CoefficientMatrix,
}

impl LightPrior {
    /// A prior from a mean and a symmetric positive definite covariance in the order R1..9, G1..9, B1..9.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] for `prior.mean` if a number is not finite or larger than that of any real light, and for
    /// `prior.covariance` if it is not symmetric and positive definite or a standard deviation is below one millionth.
    pub fn new(mean: &[f64; COEFFICIENTS], covariance: &CoefficientMatrix) -> Result<Self> {
        Light::from_slice("prior.mean", mean)?;
        let bad = |message| Error::new(ErrorKind::Range, "prior.covariance", message);
        let largest = covariance.amax();
        if !covariance.iter().all(|value| value.is_finite()) {
            return Err(bad("must be finite"));
        }
        if (covariance - covariance.transpose()).amax() > ASYMMETRY * largest {
            return Err(bad("must be symmetric"));
        }
        let indefinite = || bad("must be positive definite");
        let lower = covariance.cholesky().ok_or_else(indefinite)?.unpack();
        let whitening = lower.solve_lower_triangular(&CoefficientMatrix::identity()).ok_or_else(indefinite)?;
        let exposure = whitening * exposure_direction();
        let flattened = CoefficientMatrix::identity() - exposure * exposure.transpose() / exposure.norm_squared();
        let precision = whitening.transpose() * flattened * whitening;
        if !precision.iter().all(|value| value.abs() <= MOST_PRECISION) {
            return Err(bad("must not have a standard deviation under a millionth"));
        }
        Ok(Self { mean: Coefficients::from(*mean), precision })
    }

    /// A prior from lists: 27 numbers, and 729 row after row.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] for any other count, and the errors of [`new`](Self::new).
    pub fn from_slices(mean: &[f64], covariance: &[f64]) -> Result<Self> {
        let wrong =
            |field, needed, given| Error::new(ErrorKind::Size, field, format!("needs {needed} numbers, not {given}"));
        let given = mean.try_into().map_err(|_| wrong("prior.mean", COEFFICIENTS, mean.len()))?;
        let most = COEFFICIENTS * COEFFICIENTS;
        if covariance.len() != most {
            return Err(wrong("prior.covariance", most, covariance.len()));
        }
        Self::new(given, &CoefficientMatrix::from_row_slice(covariance))
    }

    /// Natural lights: 18 photographed environments, indoors and outdoors, at every azimuth.
    #[must_use]
    pub fn natural() -> Self {
        let Ok(prior) = Self::new(&environments::MEAN.map(f64::from), &natural_covariance()) else {
            unreachable!("the kept covariance is positive definite, as a test shows")
        };
        prior
    }

    /// h(L): squared Mahalanobis distance from the mean, minimised over the exposure.
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

/// The covariance stored in `environments`.
fn natural_covariance() -> CoefficientMatrix {
    CoefficientMatrix::from_fn(|row, column| {
        let (long, short) = (row.max(column), row.min(column));
        f64::from(environments::COVARIANCE[long * (long + 1) / 2 + short])
    })
}

/// e: the change of the coefficients with the exposure, up to a factor.
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
    fn the_distance_is_mahalanobis_with_the_exposure_left_free() {
        let prior = LightPrior::new(&[0.0; COEFFICIENTS], &(4.0 * CoefficientMatrix::identity())).unwrap();
        let mut light = Light([[0.0; HARMONICS]; 3]);
        light.0[1][4] = 3.0;
        assert!((prior.squared_distance(&light) - 9.0 / 4.0).abs() < 1e-12);
        // A third of the change of red is exposure.
        light.0[0][0] = 3.0;
        assert!((prior.squared_distance(&light) - (9.0 + 6.0) / 4.0).abs() < 1e-12);
    }

    #[test]
    fn the_kept_covariance_is_positive_definite_and_that_of_a_mirrored_world() {
        let covariance = natural_covariance();
        let eigenvalues = covariance.symmetric_eigenvalues();
        assert!(eigenvalues.min() > 1e-3 && eigenvalues.max() < 10.0, "{eigenvalues}");
        let is_odd = |index: usize| matches!(index % HARMONICS, 3 | 4 | 7);
        for row in 0..COEFFICIENTS {
            assert!(!is_odd(row) || environments::MEAN[row] == 0.0, "{row}");
            for column in 0..COEFFICIENTS {
                assert!(is_odd(row) == is_odd(column) || covariance[(row, column)] == 0.0, "{row} {column}");
            }
        }
    }

    #[test]
    fn light_from_above_and_without_a_hue_is_likelier() {
        let prior = LightPrior::natural();
        let distance = |red: [f64; HARMONICS], blue: [f64; HARMONICS]| prior.squared_distance(&Light([red, red, blue]));
        // y is down, so a negative second coefficient is light from above.
        let (above, below) =
            ([-1.0, -0.8, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [-1.0, 0.8, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        assert!(distance(above, above) < 10.0 && distance(below, below) > 2.0 * distance(above, above));
        let mut blue = above;
        blue[0] += 2.0;
        assert!(distance(above, blue) > 2.0 * distance(above, above));
        let (mut left, mut right) = (above, above);
        (left[3], right[3]) = (-0.5, 0.5);
        assert!((distance(left, left) - distance(right, right)).abs() < 1e-9);
    }

    #[test]
    fn a_gaussian_that_is_none_is_refused_with_its_field() {
        let refused = |mean: f64, change: fn(&mut CoefficientMatrix)| {
            let mut covariance = CoefficientMatrix::identity();
            change(&mut covariance);
            LightPrior::new(&[mean; COEFFICIENTS], &covariance).unwrap_err().to_string()
        };
        assert_eq!(refused(f64::NAN, |_| ()), "prior.mean[0]: must be a number from -100 to 100 (got NaN)");
        assert_eq!(refused(0.0, |c| c[(1, 1)] = f64::INFINITY), "prior.covariance: must be finite");
        assert_eq!(refused(0.0, |c| c[(0, 1)] = 0.1), "prior.covariance: must be symmetric");
        assert_eq!(refused(0.0, |c| c[(2, 2)] = -1.0), "prior.covariance: must be positive definite");
        assert_eq!(refused(0.0, |c| c.fill(0.0)), "prior.covariance: must be positive definite");
        let narrow = refused(0.0, |c| c[(2, 2)] = 1e-14);
        assert_eq!(narrow, "prior.covariance: must not have a standard deviation under a millionth");
    }

    #[test]
    fn lists_of_another_length_are_refused() {
        let (mean, covariance) = ([0.0; COEFFICIENTS], CoefficientMatrix::identity());
        assert_eq!(
            LightPrior::from_slices(&mean, covariance.as_slice()).unwrap(),
            LightPrior::new(&mean, &covariance).unwrap()
        );
        let short = LightPrior::from_slices(&mean[1..], covariance.as_slice()).unwrap_err();
        assert_eq!(short.to_string(), "prior.mean: needs 27 numbers, not 26");
        let short = LightPrior::from_slices(&mean, &covariance.as_slice()[1..]).unwrap_err();
        assert_eq!((short.field(), short.kind()), ("prior.covariance", ErrorKind::Size));
    }
}
