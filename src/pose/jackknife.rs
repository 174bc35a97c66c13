//! The jackknife of a registration: what leaving out each sector of the object in turn moves the pose by (docs/method.md, section 14).
//!
//! Errors that reach across tiles, such as albedo that varies slowly, ambient shadow and normals that lean, fit one part of the object
//! otherwise than another; neighbouring residuals tell nothing of them.
//!
//! M. Quenouille: "Notes on bias in estimation", Biometrika 43, 1956. J. Tukey: "Bias and confidence in not-quite large samples", Annals of
//! Mathematical Statistics 29, 1958.

use nalgebra::Vector3;

use super::increment::{PoseMatrix, PoseVector};

/// Sectors of the object, equal in points: as few as tell a spread of six unknowns.
pub(super) const SECTORS: usize = 6;
/// The sector of each point by its angle about a middle, seen along the line of sight.
pub(super) fn sectors(points: impl Iterator<Item = Vector3<f64>>, middle: Vector3<f64>) -> Vec<usize> {
    let angles: Vec<f64> = points.map(|point| (point.y - middle.y).atan2(point.x - middle.x)).collect();
    let mut order: Vec<usize> = (0..angles.len()).collect();
    order.sort_by(|&a, &b| angles[a].total_cmp(&angles[b]));
    let mut sectors = vec![0; angles.len()];
    for (place, point) in order.into_iter().enumerate() {
        sectors[point] = SECTORS * place / angles.len();
    }
    sectors
}

/// Covariance of a pose that moved so far without each sector: (n - 1) / n times the sum of squares about the mean. A spread of n is itself
/// uncertain; what it tells of the error follows Student's distribution of n - 1 degrees of freedom, whose variance is larger by
/// (n - 1) / (n - 3). Zero where it cannot be told.
pub(super) fn covariance(moves: &[PoseVector; SECTORS]) -> PoseMatrix {
    let count = SECTORS as f64;
    let growth = (count - 1.0) / (count - 3.0);
    let mean = moves.iter().sum::<PoseVector>() / count;
    let mut spread = PoseMatrix::zeros();
    for moved in moves {
        let off = moved - mean;
        spread.ger(growth * (count - 1.0) / count, &off, &off, 1.0);
    }
    if spread.norm().is_finite() { spread } else { PoseMatrix::zeros() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::noise;

    #[test]
    fn sectors_are_equal_in_points_and_lie_side_by_side() {
        let turn = |k: usize| (k as f64 * 0.37).sin_cos();
        let points: Vec<_> = (0..600).map(|k| Vector3::new(turn(k).1 + 5.0, turn(k).0 - 2.0, k as f64)).collect();
        let middle = Vector3::new(5.0, -2.0, 0.0);
        let found = sectors(points.iter().copied(), middle);
        for sector in 0..SECTORS {
            assert_eq!(found.iter().filter(|&&other| other == sector).count(), 600 / SECTORS);
        }
        let angle = |k: usize| (points[k].y - middle.y).atan2(points[k].x - middle.x);
        for (a, b) in (0..600).zip(1..600) {
            assert!(found[a] == found[b] || (angle(a) < angle(b)) == (found[a] < found[b]), "{a} {b}");
        }
    }

    /// The mean of what six sectors measure, each with its own error: its variance is theirs over six, and over its own sigma it follows
    /// Student's distribution of five degrees of freedom, whose variance is 5 / 3.
    #[test]
    fn the_covariance_of_a_mean_is_that_of_the_sectors_over_their_number() {
        let (sigma, runs) = (0.2, 4000);
        let mut dice = noise::white_noise(5);
        let mut mean = PoseMatrix::zeros();
        for _ in 0..runs {
            let measured: [PoseVector; SECTORS] = std::array::from_fn(|_| PoseVector::from_fn(|_, _| sigma * dice()));
            let sum = measured.iter().sum::<PoseVector>();
            let without = measured.map(|one| (sum - one) / (SECTORS - 1) as f64);
            mean += covariance(&without) / f64::from(runs);
        }
        let expected = 5.0 / 3.0 * sigma * sigma / SECTORS as f64;
        for axis in 0..mean.nrows() {
            assert!((mean[(axis, axis)] / expected - 1.0).abs() < 0.1, "{axis}: {}", mean[(axis, axis)] / expected);
        }
    }

    #[test]
    fn what_cannot_be_told_adds_nothing() {
        let mut moves = [PoseVector::zeros(); SECTORS];
        moves[2][4] = f64::NAN;
        assert_eq!(covariance(&moves), PoseMatrix::zeros());
    }
}
