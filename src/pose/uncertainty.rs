//! The information of matched surfaces about the pose, and one sigma of each number of the pose.
//!
//! The information is that of point-to-plane distances. A point that slides along its surface costs nothing, so a
//! plane, a sphere or a cylinder has no information in the directions in which it slides onto itself. The matrix is
//! J_n^T J_m, with the normal of the image on one side and that of the depth view on the other, instead of J_n^T J_n.
//! The errors of two independent normals do not multiply, whereas squared noise would pass for shape.
//!
//! One sigma covers the errors that residuals show, including correlated ones. It does not cover errors that leave no
//! residual, such as a surface that is tilted as a whole or another local optimum that fits as well. See
//! docs/method/uncertainty.md.

use std::fmt;

use nalgebra::Vector3;

use super::increment::{
    Frame, PoseMatrix, PoseVector, SCALE, TRANSLATION_Z, UNKNOWN, UNKNOWNS, clear_unknowns, fix_unknowns,
    rotation_vector,
};
use super::similarity::Similarity;
use crate::numeric::eigen::{Eigen, symmetric_eigen};
use crate::view::Camera;

/// Eigenvalues of the information, divided by its weight, count as zero below this squared cosine between normals and
/// motion. Faces and busts are above it, smooth surfaces of revolution below (docs/lab/thresholds.md).
const LEAST_INFORMATION: f64 = 1e-4;
/// Largest reported sigma of a rotation, degrees.
const LARGEST_SIGMA: f64 = 180.0;
/// Relative sigma of the focal lengths in files. Set on random pinhole pairs, with focal lengths wrong by 1 to 5 %, so
/// that three sigmas cover the rotations (docs/lab/thresholds.md).
const FOCAL_LENGTH_SIGMA: f64 = 0.005;
/// A second direction is named if its part is at least this share of the largest one.
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
    /// Points to the right.
    X,
    /// Points down.
    Y,
    /// Points forward.
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

/// A direction in which a pose may change, given by its one or two largest parts. [`Display`](fmt::Display) writes them
/// in words.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Direction {
    /// The largest part; `None` if the direction is unknown.
    pub first: Option<Unknown>,
    /// A second part of nearly the same size.
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
    /// Translation along x, y, z in units of the colour view; `None` if it is a gauge.
    pub translation: [Option<f64>; 3],
    /// Scale; `None` if it is held.
    pub scale: Option<f64>,
    /// The least certain direction.
    pub weakest: Direction,
}

impl Uncertainty {
    /// Sigma of the rotation about its least certain axis, degrees; NaN if one is not a number.
    pub(crate) fn largest_rotation(&self) -> f64 {
        let larger = |a: f64, b: f64| if a >= b || a.is_nan() { a } else { b };
        self.rotation_degrees.into_iter().fold(0.0, larger)
    }

    /// Adds the mean square distance of `ends` from `pose`. They are the poses at which registrations from several initial
    /// poses ended, and they fit the image about equally well.
    pub(crate) fn add_spread(&mut self, pose: &Similarity, ends: &[Similarity]) {
        let count = ends.len().max(1) as f64;
        let spread =
            |off: &dyn Fn(&Similarity) -> f64| (ends.iter().map(|end| off(end).powi(2)).sum::<f64>() / count).sqrt();
        let turned = |axis: usize| spread(&|end| rotation_vector(&(end.rotation * pose.rotation.transpose()))[axis]);
        let moved = |axis: usize| spread(&|end| end.translation[axis] - pose.translation[axis]);
        for axis in 0..3 {
            let sigma = &mut self.rotation_degrees[axis];
            *sigma = sigma.hypot(turned(axis).to_degrees()).min(LARGEST_SIGMA);
            self.translation[axis] = self.translation[axis].map(|sigma| sigma.hypot(moved(axis)));
        }
        self.scale = self.scale.map(|sigma| sigma.hypot(spread(&|end| end.scale - pose.scale)));
    }

    /// Adds the uncertainty of the focal lengths. Stretching a relief by some share turns its normals by at most half
    /// of that share, share sin(2 slope) / 2, and moves an object by that share of its distance.
    pub(crate) fn add_focal_length(&mut self, distance: f64) {
        let turned = (0.5 * FOCAL_LENGTH_SIGMA).to_degrees();
        self.rotation_degrees = self.rotation_degrees.map(|sigma| sigma.hypot(turned).min(LARGEST_SIGMA));
        self.translation[2] = self.translation[2].map(|sigma| sigma.hypot(FOCAL_LENGTH_SIGMA * distance));
    }
}

/// Information of a registration about its seven unknowns: rotation about x, y, z (radians), translation along x, y, z
/// (in object sizes) and the logarithm of the scale, all in the colour view's frame about the centroid of the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Information {
    /// The 7x7 matrix, dimensionless; its last row and column are zero if the scale is held.
    pub matrix: PoseMatrix,
    /// Sum of the weights in the matrix.
    pub weight: f64,
    /// Centroid of the matched points in the colour view.
    pub centre: Vector3<f64>,
    /// Object size: root mean square distance of the points from the centroid, in units of the colour view.
    pub length: f64,
    /// Root mean square difference |n - R n_R| of the matched normals.
    pub normal_noise: f64,
    /// Number of pairs.
    pub pairs: usize,
    /// Share of the pairs that count as independent, 0 .. 1, because errors of neighbouring points on a surface
    /// correlate.
    pub independent: f64,
    /// Whether the scale was held.
    pub scale_is_held: bool,
}

impl Information {
    /// The smallest eigenvalue over the weight, 0 .. 1/3. It belongs to the least determined direction.
    #[must_use]
    pub fn weakest(&self) -> f64 {
        self.eigen(false).map_or(0.0, |eigen| eigen.eigenvalues.min())
    }

    /// Whether some direction has no information, so that the geometry does not determine the pose.
    #[must_use]
    pub fn is_degenerate(&self) -> bool {
        // This comparison also treats NaN as degenerate.
        !matches!(self.weakest().partial_cmp(&self.floor()), Some(std::cmp::Ordering::Greater))
    }

    /// One sigma of `pose` for distances with standard deviation `sigma` (units of the colour view). Rotations are
    /// capped at 180 degrees, which means unknown. For an orthographic image the z of the translation is a gauge:
    /// `None`.
    #[must_use]
    pub fn uncertainty(&self, sigma: f64, pose: &Similarity, camera: &Camera) -> Uncertainty {
        let gauge = camera.is_orthographic();
        let (covariance, weakest) = self.covariance(sigma, gauge);
        let frame = Frame { centre: self.centre, length: self.length };
        describe(&covariance, &frame, pose, [gauge, self.scale_is_held], weakest)
    }

    /// Covariance of the seven unknowns, and the weakest direction. Held and gauge unknowns have no variance.
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

    /// Eigenvalues over the weight, with the gauge projected out. Unknowns that are not estimated get the eigenvalue
    /// one, so that they are never the weakest direction: the eigenvalues of the three translations sum to one.
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

    /// Which of the seven unknowns are not estimated: the gauge, and a held scale.
    fn without_variance(&self, gauge: bool) -> [bool; UNKNOWNS] {
        std::array::from_fn(|k| (k == TRANSLATION_Z && gauge) || (k == SCALE && self.scale_is_held))
    }

    /// The eigenvalues that J_n^T J_m would have without any shape, by chance: from the noise of the normals, averaged over the pairs.
    fn floor(&self) -> f64 {
        LEAST_INFORMATION.max(self.normal_noise.powi(2) / (self.pairs.max(1) as f64).sqrt())
    }
}

/// One sigma of each number of `pose` from the covariance of the seven unknowns about a centre. The two flags of
/// `fixed` mark the z of the translation and the scale as numbers without a sigma.
pub(super) fn describe(
    covariance: &PoseMatrix,
    frame: &Frame,
    pose: &Similarity,
    fixed: [bool; 2],
    weakest: Direction,
) -> Uncertainty {
    // t is the image of the depth view's origin, which is rotated and scaled about the centre with everything else.
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
        // The bounds are a quarter of a percent, and four millimetres at 0.8 m.
        assert!((found.rotation_degrees[0] - 0.1432).abs() < 1e-4, "{found:?}");
        assert_eq!(found.rotation_degrees[2], LARGEST_SIGMA);
        assert_eq!(found.translation[..2], sure.translation[..2]);
        assert!((found.translation[2].unwrap() - 0.004).abs() < 1e-12, "{found:?}");
    }
}
