//! Sandwich estimator of a pose's covariance: G (sum over clusters of g g^T) G^T (docs/method/uncertainty.md).
//!
//! g is the sum of the scores of a cluster of neighbouring residuals, and G the gain of the equations that the pose
//! solves, normally the inverse of their matrix. Noise, wrong normals and interpolation enter with their actual size
//! and correlation; the only assumption is that clusters are independent.
//!
//! P. Huber: "The behavior of maximum likelihood estimates under nonstandard conditions", Proc. 5th Berkeley Symposium,
//! 1967. K.-Y. Liang, S. Zeger: "Longitudinal data analysis using generalized linear models", Biometrika 73, 1986.

use super::increment::{PoseMatrix, PoseVector, UNKNOWN, UNKNOWNS, clear_unknowns, product};

/// Sum of the outer products of the clusters' scores.
pub(super) struct Scores {
    spread: PoseMatrix,
    count: f64,
}

impl Scores {
    /// The sum over clusters that count as observations. Clusters with a score of zero are empty and do not count.
    pub fn of<'a>(clusters: impl Iterator<Item = &'a PoseVector>) -> Self {
        let mut scores = Self { spread: PoseMatrix::zeros(), count: 0.0 };
        scores.count = scores.add(clusters);
        scores
    }

    /// Adds the spread of further clusters, which do not count as observations. Returns their number.
    pub fn add<'a>(&mut self, clusters: impl Iterator<Item = &'a PoseVector>) -> f64 {
        let mut count = 0.0;
        for score in clusters.filter(|score| score.norm() > 0.0) {
            self.spread.ger(1.0, score, score, 1.0);
            count += 1.0;
        }
        count
    }

    /// Number of observations minus free unknowns. `None` if that is not positive, because so few clusters carry no
    /// information about the spread.
    pub fn degrees_of_freedom(&self, held: &[bool; UNKNOWNS]) -> Option<f64> {
        let free = held.iter().filter(|&&held| !held).count() as f64;
        (self.count > free).then_some(self.count - free)
    }

    /// The covariance, with sigmas enlarged by `growth`. Held unknowns have none. Without a gain, or with too few
    /// clusters, all unknowns are undetermined.
    pub fn covariance(&self, gain: Option<&PoseMatrix>, growth: f64, held: &[bool; UNKNOWNS]) -> PoseMatrix {
        let mut covariance = match (gain, self.degrees_of_freedom(held)) {
            (Some(gain), Some(freedom)) => {
                product(&product(gain, &self.spread), &gain.transpose()) * (growth.powi(2) * self.count / freedom)
            }
            _ => PoseMatrix::identity() * UNKNOWN.powi(2),
        };
        if !covariance.norm().is_finite() {
            covariance = PoseMatrix::identity() * UNKNOWN.powi(2);
        }
        clear_unknowns(&mut covariance, held);
        covariance
    }
}

/// Ratio of three sigmas of Student's distribution to three of the normal one, because a spread estimated from few
/// clusters is itself uncertain. Inverts an approximation of D. Wallace: "Bounds on normal approximations to Student's
/// and the chi-square distributions", Annals of Mathematical Statistics 30, 1959. With four or more degrees of freedom
/// it is within 3 %, and it is never too small.
pub(super) fn student_growth(degrees_of_freedom: f64) -> f64 {
    let sigmas = 3.0 * (8.0 * degrees_of_freedom + 3.0) / (8.0 * degrees_of_freedom + 1.0);
    (degrees_of_freedom * ((sigmas * sigmas / degrees_of_freedom).exp() - 1.0)).sqrt() / 3.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::noise;

    const FREE: [bool; UNKNOWNS] = [false; UNKNOWNS];

    /// The mean of vectors of white noise has the covariance of the noise over their number.
    #[test]
    fn the_covariance_of_a_mean_is_the_variance_over_the_count() {
        let (sigma, count) = (0.3, 4000);
        let mut dice = noise::white_noise(11);
        let clusters: Vec<_> = (0..count).map(|_| PoseVector::from_fn(|_, _| sigma * dice())).collect();
        let gain = PoseMatrix::identity() / f64::from(count);
        let covariance = Scores::of(clusters.iter()).covariance(Some(&gain), 1.0, &FREE);
        let expected = sigma * sigma / f64::from(count);
        for row in 0..UNKNOWNS {
            for column in 0..UNKNOWNS {
                let off = covariance[(row, column)] / expected - if row == column { 1.0 } else { 0.0 };
                assert!(off.abs() < 0.1, "{row} {column}: {off}");
            }
        }
    }

    #[test]
    fn held_unknowns_have_no_variance_and_too_few_clusters_say_nothing() {
        let clusters: Vec<_> = (1..20).map(|k| PoseVector::from_fn(|row, _| f64::from(k) + row as f64)).collect();
        let gain = PoseMatrix::identity();
        let held = std::array::from_fn(|k| k == 6);
        let covariance = Scores::of(clusters.iter()).covariance(Some(&gain), 2.0, &held);
        assert!(covariance[(6, 6)] == 0.0 && covariance[(5, 5)] > 0.0);
        for (clusters, gain) in [(&clusters[..7], Some(&gain)), (&clusters[..], None)] {
            let covariance = Scores::of(clusters.iter()).covariance(gain, 1.0, &FREE);
            assert_eq!(covariance, PoseMatrix::identity() * UNKNOWN.powi(2));
        }
    }

    #[test]
    fn sigmas_that_few_clusters_tell_grow_as_students_distribution_does() {
        // scipy.stats: t.isf(norm.sf(3), degrees) / 3.
        for (degrees, expected) in [(4.0, 2.2067), (6.0, 1.6347), (10.0, 1.3190), (20.0, 1.1407), (100.0, 1.0256)] {
            let growth = student_growth(degrees);
            assert!(growth >= expected - 1e-4 && growth < 1.03 * expected, "{degrees}: {growth}");
        }
        assert!(student_growth(1.0) > 10.0);
    }
}
