//! Delete-group jackknife of a registration: the pose without each sector of the object in turn
//! (docs/method/uncertainty.md).
//!
//! Slowly varying albedo, ambient shadow and biased normals correlate over more than a tile, so the scores of tiles do
//! not show these errors. They bias each part of the object differently, so the pose moves when a part is left out.
//!
//! M. Quenouille: "Notes on bias in estimation", Biometrika 43, 1956. J. Tukey: "Bias and confidence in not-quite large samples", Annals of
//! Mathematical Statistics 29, 1958.

use nalgebra::Vector3;

use super::increment::{PoseMatrix, PoseVector};

/// Which of `count` sectors each point lies in, by its angle about the centre as seen along the line of sight. Sectors
/// have the same number of points.
pub(super) fn sectors(points: impl Iterator<Item = Vector3<f64>>, centre: Vector3<f64>, count: usize) -> Vec<usize> {
    let angles: Vec<f64> = points.map(|point| (point.y - centre.y).atan2(point.x - centre.x)).collect();
    let mut order: Vec<usize> = (0..angles.len()).collect();
    order.sort_by(|&a, &b| angles[a].total_cmp(&angles[b]));
    let mut sectors = vec![0; angles.len()];
    for (place, point) in order.into_iter().enumerate() {
        sectors[point] = count * place / angles.len();
    }
    sectors
}

/// Covariance of a pose from its moves without each of n sectors: (n - 1) / n times their sum of squares about the
/// mean. So few moves estimate the variance poorly. The error divided by the estimated sigma follows Student's
/// distribution with n - 1 degrees of freedom, whose variance is (n - 1) / (n - 3). The rank is at most n - 1; the
/// covariance of the tiles, to which this is added, has full rank. Zero if a move is not finite.
pub(super) fn covariance<const SECTORS: usize>(moves: &[PoseVector; SECTORS]) -> PoseMatrix {
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

    const SECTORS: usize = 6;

    #[test]
    fn sectors_are_equal_in_points_and_lie_side_by_side() {
        let turn = |k: usize| (k as f64 * 0.37).sin_cos();
        let points: Vec<_> = (0..600).map(|k| Vector3::new(turn(k).1 + 5.0, turn(k).0 - 2.0, k as f64)).collect();
        let middle = Vector3::new(5.0, -2.0, 0.0);
        let found = sectors(points.iter().copied(), middle, SECTORS);
        for sector in 0..SECTORS {
            assert_eq!(found.iter().filter(|&&other| other == sector).count(), 600 / SECTORS);
        }
        let angle = |k: usize| (points[k].y - middle.y).atan2(points[k].x - middle.x);
        for (a, b) in (0..600).zip(1..600) {
            assert!(found[a] == found[b] || (angle(a) < angle(b)) == (found[a] < found[b]), "{a} {b}");
        }
    }

    /// The pose is the mean of six independent measurements, so its variance is theirs over six, times Student's 5 / 3.
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
    fn a_move_that_is_not_finite_adds_nothing() {
        let mut moves = [PoseVector::zeros(); SECTORS];
        moves[2][4] = f64::NAN;
        assert_eq!(covariance(&moves), PoseMatrix::zeros());
    }
}
