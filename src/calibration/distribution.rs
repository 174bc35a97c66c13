//! The distribution of the estimate: a mixture over the optima that the frames do not exclude.
//!
//! Each optimum contributes Student's distribution about its pose, with few degrees of freedom, in proportion to the
//! probability that it fits as well as the best one. All quantities are in the units of the best optimum, relative to its
//! pose.

use nalgebra::{SMatrix, SVector};

use super::unknowns::POSE;
use crate::numeric::random::Random;

/// Number of draws. Their quantiles have an error of about a twentieth of their sigma.
const DRAWS: usize = 2000;
const SEED: u64 = 1;
/// Degrees of freedom of Student's t; no other number of the distribution was fitted (docs/lab/thresholds.md). Errors
/// that a whole silhouette shares move its tiles alike, so their scatter only estimates the size of the error. In some
/// scenes it is far too small. Three is the smallest whole number with a finite covariance.
pub(super) const DEGREES: f64 = 3.0;
/// Ratio of the covariance of Student's distribution to its scale.
pub(super) const VARIANCE: f64 = DEGREES / (DEGREES - 2.0);

pub(super) type PoseVector = SVector<f64, POSE>;
pub(super) type PoseMatrix = SMatrix<f64, POSE, POSE>;

/// The distribution about one optimum.
pub(super) struct Part {
    /// Weight relative to those of the other parts.
    pub weight: f64,
    /// Pose of the optimum.
    pub middle: PoseVector,
    pub scale: PoseMatrix,
}

/// Draws from the distribution, with their densities.
pub(super) struct Distribution {
    parts: Vec<(Part, PoseMatrix, f64)>,
    pub draws: Vec<PoseVector>,
    densities: Vec<f64>,
}

impl Distribution {
    /// Not inlined: each copy would add a kilobyte to the .wasm file.
    #[inline(never)]
    pub fn new(parts: Vec<Part>) -> Self {
        let total: f64 = parts.iter().map(|part| part.weight).sum();
        let mut random = Random::new(SEED, 0);
        let mut normal = || (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0;
        let mut draws = Vec::with_capacity(DRAWS);
        let known = |part: Part| {
            let root = part.scale.cholesky().map_or_else(PoseMatrix::zeros, |c| c.l());
            let count = (DRAWS as f64 * part.weight / total).round() as usize;
            draws.extend((0..count).map(|_| {
                // Student's t: a normal vector over the root of a mean square; chi-square by Wilson and Hilferty (1931).
                let h = 2.0 / (9.0 * DEGREES);
                let mean_square = (1.0 - h + h.sqrt() * normal()).powi(3).max(1e-3);
                part.middle + root * PoseVector::from_fn(|_, _| normal()) / mean_square.sqrt()
            }));
            let inverse = part.scale.try_inverse().unwrap_or_else(PoseMatrix::zeros);
            let height = part.weight / total / root.diagonal().product().max(f64::MIN_POSITIVE);
            (part, inverse, height)
        };
        let parts = parts.into_iter().map(known).collect();
        let mut distribution = Self { parts, draws, densities: vec![] };
        distribution.densities = distribution.draws.iter().map(|draw| distribution.density(draw)).collect();
        distribution
    }

    /// Density at a pose, up to a factor that all distributions share.
    pub fn density(&self, at: &PoseVector) -> f64 {
        let part = |(part, inverse, height): &(Part, PoseMatrix, f64)| {
            let off = at - part.middle;
            height * (1.0 + off.dot(&(inverse * off)) / DEGREES).powf(-0.5 * (DEGREES + POSE as f64))
        };
        self.parts.iter().map(part).sum()
    }

    /// Probability that a draw is no more likely than this pose.
    pub fn probability(&self, at: &PoseVector) -> f64 {
        let density = self.density(at);
        let count = self.densities.iter().filter(|other| **other < density).count();
        count as f64 / self.draws.len().max(1) as f64
    }

    /// Second moments about the pose of the best optimum.
    pub fn covariance(&self) -> PoseMatrix {
        let total: f64 = self.parts.iter().map(|(part, ..)| part.weight).sum();
        let moments = |(part, ..): &(Part, PoseMatrix, f64)| {
            (part.scale * VARIANCE + part.middle * part.middle.transpose()) * (part.weight / total)
        };
        self.parts.iter().map(moments).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(weight: f64, at: f64, scale: f64) -> Part {
        Part { weight, middle: PoseVector::repeat(at), scale: PoseMatrix::identity() * scale }
    }

    #[test]
    fn one_optimum_is_a_student_distribution() {
        let one = Distribution::new(vec![part(1.0, 0.0, 4.0)]);
        assert_eq!(one.covariance(), PoseMatrix::identity() * 12.0);
        // The expected value is six times an F distribution of six and three degrees of freedom, whose 95 % quantile is
        // 8.94.
        let at = |square: f64| PoseVector::from([(4.0 * square).sqrt(), 0.0, 0.0, 0.0, 0.0, 0.0]);
        let tail = one.probability(&at(6.0 * 8.94));
        assert!((tail - 0.05).abs() < 0.015, "{tail}");
        assert_eq!(one.probability(&PoseVector::zeros()), 1.0);
    }

    #[test]
    fn a_second_optimum_is_as_probable_as_its_weight() {
        let two = Distribution::new(vec![part(3.0, 0.0, 1.0), part(1.0, 100.0, 1.0)]);
        let there = two.draws.iter().filter(|draw| (*draw - PoseVector::repeat(100.0)).norm() < 50.0).count();
        assert!((there as f64 / two.draws.len() as f64 - 0.25).abs() < 0.01, "{there}");
        // Both poses are likely, but a pose between them is not, although it is nearer to the first one.
        assert!(two.probability(&PoseVector::repeat(100.0)) > 0.2);
        assert!(two.probability(&PoseVector::repeat(50.0)) < 0.01);
        let variance = two.covariance()[(0, 0)];
        assert!((variance - (3.0 + 0.25 * 100.0 * 100.0)).abs() < 1e-9, "{variance}");
    }

    #[test]
    fn a_scale_that_is_singular_gives_no_motion() {
        let flat = Distribution::new(vec![Part { scale: PoseMatrix::zeros(), ..part(1.0, 0.0, 1.0) }]);
        assert!(flat.draws.iter().all(|draw| *draw == PoseVector::zeros()));
    }
}
