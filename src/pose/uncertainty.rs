//! How well the matched surfaces determine the pose, and one sigma of each of its numbers.
//!
//! The information is that of point-to-plane distances: a point that slides along its surface costs nothing, so a
//! plane, a sphere or a cylinder leave the directions in which they slide onto themselves without information. It is
//! formed from the normal of the image on one side and that of the depth view on the other, J_n^T J_m, instead of J_n^T
//! J_n: errors of two independent normals do not multiply up, where noise squared would pass for shape.
//!
//! One sigma covers what the residuals show, correlated ones included; an error that leaves no residual (a surface that
//! is tilted as a whole, another local optimum that fits as well) is not seen by it. See docs/method/uncertainty.md.

use std::fmt;

use nalgebra::Vector3;

use super::increment::{
    Frame, PoseMatrix, PoseVector, SCALE, TRANSLATION_Z, UNKNOWN, UNKNOWNS, clear_unknowns, fix_unknowns,
};
use super::similarity::Similarity;
use crate::numeric::eigen::{Eigen, symmetric_eigen};
use crate::view::Camera;

/// Eigenvalues of the information, divided by its weight, below this count as zero. Free of units: the squared cosine
/// between normals and motion. A face has 5e-3, a bust with a third of its relief 1e-3; smooth surfaces of revolution
/// stay below 1e-4.
const LEAST_INFORMATION: f64 = 1e-4;
/// Rotations are never more uncertain than this, degrees.
const LARGEST_SIGMA: f64 = 180.0;
/// Sigma of the focal lengths that files state, as a share. Set so that the rotations of random pinhole pairs, one of whose
/// focal lengths is wrong by 1 to 5 %, are held by three sigmas in 95 % on the scenes of odd numbers; those of even ones
/// are as well.
const FOCAL_LENGTH_SIGMA: f64 = 0.005;
/// A second direction is named where it has at least this share of the first one's part.
const WORTH_NAMING: f64 = 0.6;

/// One of the seven numbers of a pose, in the colour view's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unknown {
    /// Rotation about x, y or z.
    Rotation(Axis),
    /// Translation along x, y or z.
    Translation(Axis),
    /// The scale.
    Scale,
}

/// An axis of a view's frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// To the right.
    X,
    /// Down.
    Y,
    /// Forward.
    Z,
}

/// The unknowns in the order of the rows of an information matrix.
const ORDER: [Unknown; UNKNOWNS] = [
    Unknown::Rotation(Axis::X),
    Unknown::Rotation(Axis::Y),
    Unknown::Rotation(Axis::Z),
    Unknown::Translation(Axis::X),
    Unknown::Translation(Axis::Y),
    Unknown::Translation(Axis::Z),
    Unknown::Scale,
];

/// A direction in which a pose may change, by its one or two largest parts. [`Display`](fmt::Display) writes them as words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Direction {
    /// The largest part; `None` where the direction is unknown.
    pub first: Option<Unknown>,
    /// A second part that is nearly as large.
    pub second: Option<Unknown>,
}

impl Direction {
    /// The one or two largest parts of a change.
    pub(crate) fn of(change: &PoseVector) -> Self {
        let first = change.iamax();
        let second = (0..UNKNOWNS)
            .filter(|&k| k != first)
            .max_by(|&a, &b| change[a].abs().total_cmp(&change[b].abs()))
            .filter(|&k| change[k].abs() >= WORTH_NAMING * change[first].abs());
        Self { first: Some(ORDER[first]), second: second.map(|second| ORDER[second]) }
    }
}

impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.first, self.second) {
            (None, _) => f.write_str("unknown"),
            (Some(first), None) => first.fmt(f),
            (Some(first), Some(second)) => write!(f, "{first} with {second}"),
        }
    }
}

impl fmt::Display for Unknown {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Rotation(axis) => write!(f, "rotation about {axis}"),
            Self::Translation(axis) => write!(f, "translation along {axis}"),
            Self::Scale => f.write_str("scale"),
        }
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::X => "x",
            Self::Y => "y",
            Self::Z => "z",
        })
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Direction {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// Uncertainty of the pose, one sigma.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "camelCase"))]
pub struct Uncertainty {
    /// Rotation about the x, y and z axis of the colour view, degrees.
    pub rotation_degrees: [f64; 3],
    /// Translation along x, y, z in units of the colour view; `None` where it is a gauge.
    pub translation: [Option<f64>; 3],
    /// Scale; `None` where it is held.
    pub scale: Option<f64>,
    /// The least certain direction.
    pub weakest: Direction,
}

impl Uncertainty {
    /// Sigma of the rotation about its least certain axis, degrees.
    pub(crate) fn largest_rotation(&self) -> f64 {
        self.rotation_degrees.into_iter().fold(0.0, f64::max)
    }

    /// Adds what the focal lengths are uncertain by. A relief that is stretched by a share of it turns its normals by half of
    /// that share at most, share sin(2 slope) / 2; an object is nearer or farther by that share of its distance.
    pub(crate) fn add_focal_length(&mut self, distance: f64) {
        let turned = (0.5 * FOCAL_LENGTH_SIGMA).to_degrees();
        self.rotation_degrees = self.rotation_degrees.map(|sigma| sigma.hypot(turned).min(LARGEST_SIGMA));
        self.translation[2] = self.translation[2].map(|sigma| sigma.hypot(FOCAL_LENGTH_SIGMA * distance));
    }
}

/// Information of a registration about its seven unknowns: rotation about x, y, z (radians), translation along x, y, z
/// (in object sizes) and the logarithm of the scale, all in the colour view's frame around the centroid of the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Information {
    /// The 7x7 matrix; the last row and column are zero where the scale is held. Free of units.
    pub matrix: PoseMatrix,
    /// Sum of the weights in it.
    pub weight: f64,
    /// Centroid of the matched points in the colour view.
    pub centre: Vector3<f64>,
    /// Object size: root mean square distance of the points from the centroid, in units of the colour view.
    pub length: f64,
    /// Root mean square disagreement |n - R n_R| of the matched normals.
    pub normal_noise: f64,
    /// Number of pairs.
    pub pairs: usize,
    /// Share of the pairs that count as independent, 0 .. 1: errors of neighbouring points of a surface correlate.
    pub independent: f64,
    /// Whether the scale was held.
    pub scale_is_held: bool,
}

impl Information {
    /// The smallest eigenvalue over the weight: what the worst determined direction has, 0 .. 1/3.
    #[must_use]
    pub fn weakest(&self) -> f64 {
        self.eigen(false).map_or(0.0, |eigen| eigen.eigenvalues.min())
    }

    /// Whether some direction has no information: the geometry does not determine the pose.
    #[must_use]
    pub fn is_degenerate(&self) -> bool {
        // Written so that NaN is degenerate.
        !matches!(self.weakest().partial_cmp(&self.floor()), Some(std::cmp::Ordering::Greater))
    }

    /// One sigma of `pose` for distances with standard deviation `sigma` (units of the colour view). Rotation is capped
    /// at 180 degrees, which means unknown. The z of the translation is a gauge for an orthographic image: `None`.
    #[must_use]
    pub fn uncertainty(&self, sigma: f64, pose: &Similarity, camera: &Camera) -> Uncertainty {
        let gauge = camera.is_orthographic();
        let (covariance, weakest) = self.covariance(sigma, gauge);
        let frame = Frame { centre: self.centre, length: self.length };
        describe(&covariance, &frame, pose, [gauge, self.scale_is_held], weakest)
    }

    /// Covariance of the seven unknowns and the weakest direction. Held and gauge unknowns have none.
    fn covariance(&self, sigma: f64, gauge: bool) -> (PoseMatrix, Direction) {
        let Some(eigen) = self.eigen(gauge) else {
            return (PoseMatrix::identity() * UNKNOWN.powi(2), Direction::default());
        };
        let floor = self.floor();
        let mut covariance = PoseMatrix::zeros();
        for (k, &value) in eigen.eigenvalues.iter().enumerate() {
            let variance = if value > floor {
                ((sigma / self.length).powi(2) / (value * self.weight * self.independent)).min(UNKNOWN.powi(2))
            } else {
                UNKNOWN.powi(2)
            };
            let direction = eigen.eigenvectors.column(k);
            covariance += variance * direction * direction.transpose();
        }
        clear_unknowns(&mut covariance, &self.without_variance(gauge));
        (covariance, Direction::of(&eigen.eigenvectors.column(eigen.eigenvalues.imin()).into_owned()))
    }

    /// Eigenvalues over the weight. The gauge is projected out. What is not estimated gets the eigenvalue one, so that
    /// it is never the weakest direction: those of the three translations sum to one.
    fn eigen(&self, gauge: bool) -> Option<Eigen<UNKNOWNS>> {
        let mut matrix = self.matrix / self.weight;
        if gauge && matrix[(TRANSLATION_Z, TRANSLATION_Z)] > 0.0 {
            let column = matrix.column(TRANSLATION_Z).into_owned();
            matrix -= column * column.transpose() / matrix[(TRANSLATION_Z, TRANSLATION_Z)];
        }
        fix_unknowns(&mut matrix, &self.without_variance(gauge));
        if !matrix.norm().is_finite() {
            return None;
        }
        symmetric_eigen(&matrix)
    }

    /// Which of the seven are not estimated: the gauge, a scale that is held.
    fn without_variance(&self, gauge: bool) -> [bool; UNKNOWNS] {
        std::array::from_fn(|k| (k == TRANSLATION_Z && gauge) || (k == SCALE && self.scale_is_held))
    }

    /// What chance leaves of J_n^T J_m where there is no shape: the noise of the normals, averaged over the pairs.
    fn floor(&self) -> f64 {
        LEAST_INFORMATION.max(self.normal_noise.powi(2) / (self.pairs.max(1) as f64).sqrt())
    }
}

/// One sigma of each number of `pose` from the covariance of the seven unknowns about a centre. The z of the
/// translation and the scale have none where the first or the second of `fixed` says so.
pub(super) fn describe(
    covariance: &PoseMatrix,
    frame: &Frame,
    pose: &Similarity,
    fixed: [bool; 2],
    weakest: Direction,
) -> Uncertainty {
    // t is where the origin of the depth view goes; it is rotated and scaled about the centre with everything else.
    let arm = pose.translation - frame.centre;
    let cross = arm.cross_matrix();
    let along = |axis: usize| {
        let mut row = PoseVector::zeros();
        for k in 0..3 {
            row[k] = -cross[(axis, k)];
        }
        row[3 + axis] = frame.length;
        row[SCALE] = arm[axis];
        row.dot(&(covariance * row)).sqrt()
    };
    let degrees = |axis: usize| covariance[(axis, axis)].sqrt().to_degrees().min(LARGEST_SIGMA);
    Uncertainty {
        rotation_degrees: [degrees(0), degrees(1), degrees(2)],
        translation: [Some(along(0)), Some(along(1)), (!fixed[0]).then(|| along(2))],
        scale: (!fixed[1]).then(|| pose.scale * covariance[(SCALE, SCALE)].sqrt()),
        weakest,
    }
}

/// The least certain direction of a covariance.
pub(super) fn weakest_of(covariance: &PoseMatrix) -> Direction {
    let weakest =
        |eigen: Eigen<UNKNOWNS>| Direction::of(&eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned());
    symmetric_eigen(covariance).map(weakest).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn focal_lengths_are_uncertain_beside_all_else() {
        let sure = Uncertainty {
            rotation_degrees: [0.0, 0.0, LARGEST_SIGMA],
            translation: [Some(0.001), None, Some(0.0)],
            scale: None,
            weakest: Direction::default(),
        };
        let mut found = sure.clone();
        found.add_focal_length(0.8);
        // Half of half a percent, and four millimetres in 0.8 m.
        assert!((found.rotation_degrees[0] - 0.1432).abs() < 1e-4, "{found:?}");
        assert_eq!(found.rotation_degrees[2], LARGEST_SIGMA);
        assert_eq!(found.translation[..2], sure.translation[..2]);
        assert!((found.translation[2].unwrap() - 0.004).abs() < 1e-12, "{found:?}");
    }
}
