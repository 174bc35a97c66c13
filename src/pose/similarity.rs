//! The pose, P_colour = s R P_depth + t (Eq. 12 with known pairs, Eq. 15; docs/method/frames.md and
//! docs/method/surfaces.md).

use nalgebra::{Matrix3, Matrix4, Quaternion, Rotation3, UnitQuaternion, Vector3};

use crate::check::positive;
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::eigen::symmetric_eigen;

/// Largest difference of R^T R from the identity. Rotations typed with five digits pass; anything worse is a mistake.
const ROTATION_TOLERANCE: f64 = 1e-4;

/// Smallest eigenvalue gap of a determined rotation: twice the sum of the second and the signed third of the normalised
/// singular values, which is zero for points on a line. Rounding of f32 coordinates leaves at most 1e-7 squared; real
/// objects are above 1e-4.
const RANK_TOLERANCE: f64 = 1e-9;

/// Minimum number of pairs for a similarity. Three pairs are fitted so well that no residual reveals a mistake.
pub(crate) const FEWEST_PAIRS: usize = 4;

/// An active, right-handed similarity that transforms points of the depth view into the colour view.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(into = "serialised::Pose"))]
pub struct Similarity {
    /// s > 0.
    pub scale: f64,
    /// R, orthonormal with determinant one.
    pub rotation: Matrix3<f64>,
    /// t in units of the colour view.
    pub translation: Vector3<f64>,
}

impl Similarity {
    /// The identity.
    #[must_use]
    pub fn identity() -> Self {
        Self { scale: 1.0, rotation: Matrix3::identity(), translation: Vector3::zeros() }
    }

    /// # Errors
    /// [`ErrorKind::Range`] with the member of `field` that is not finite, not positive or not a rotation.
    pub fn validate(&self, field: &'static str) -> Result<()> {
        positive("scale", self.scale).map_err(|error| error.below(field))?;
        if let Some(index) = self.translation.iter().position(|value| !value.is_finite()) {
            return Err(Error::new(ErrorKind::Range, "translation", "must be finite").at(index).below(field));
        }
        let off = (self.rotation.transpose() * self.rotation - Matrix3::identity()).abs().max();
        // The maximum skips NaN entries; the determinant is NaN if one entry is.
        if off > ROTATION_TOLERANCE || !(0.5..2.0).contains(&self.rotation.determinant()) {
            return Err(
                Error::new(ErrorKind::Range, "rotation", "must be orthonormal with determinant one").below(field)
            );
        }
        Ok(())
    }

    /// s R P + t.
    #[must_use]
    pub fn apply(&self, point: Vector3<f64>) -> Vector3<f64> {
        self.scale * (self.rotation * point) + self.translation
    }

    /// The inverse similarity.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        let scale = 1.0 / self.scale;
        Self { scale, rotation, translation: -scale * (rotation * self.translation) }
    }

    /// Angle between the rotations of two poses, degrees.
    #[must_use]
    pub fn degrees_to(&self, other: &Self) -> f64 {
        // 2 asin(|R - R'|_F / (2 sqrt 2)) keeps its digits for small angles, where acos loses half of them.
        let chord = (self.rotation - other.rotation).norm() / 8.0_f64.sqrt();
        2.0 * chord.min(1.0).asin().to_degrees()
    }

    /// Difference of the scales of two poses, |ln(s / s')|.
    #[must_use]
    pub(crate) fn growth_from(&self, other: &Self) -> f64 {
        (self.scale / other.scale).ln().abs()
    }

    /// This similarity after `first`: P -> self(first(P)).
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self {
            scale: self.scale * first.scale,
            rotation: self.rotation * first.rotation,
            translation: self.apply(first.translation),
        }
    }

    /// The pose with another scale and rotation that maps `point` of the depth view to the same place as this one.
    #[must_use]
    pub(crate) fn turned_about(&self, point: Vector3<f64>, scale: f64, rotation: Matrix3<f64>) -> Self {
        Self { scale, rotation, translation: self.apply(point) - scale * (rotation * point) }
    }

    /// The pose a `share` of the way from this one (0) to `other` (1), with constant rotation, constant growth, and a
    /// straight path of `centre`, a point of the depth view. With the centroid as `centre`, the object does not swing
    /// about a distant origin, as it would if the translations were interpolated.
    #[must_use]
    pub fn towards(&self, other: &Self, share: f64, centre: Vector3<f64>) -> Self {
        let change = quaternion(&(other.rotation * self.rotation.transpose())).powf(share);
        let rotation = change.to_rotation_matrix().into_inner() * self.rotation;
        let scale = self.scale * (other.scale / self.scale).powf(share);
        let target = self.apply(centre).lerp(&other.apply(centre), share);
        Self { scale, rotation, translation: target - scale * (rotation * centre) }
    }

    /// The same pose with its rotation made orthonormal again, for use after many products.
    #[must_use]
    pub fn orthonormal(&self) -> Self {
        Self { rotation: quaternion(&self.rotation).to_rotation_matrix().into_inner(), ..*self }
    }

    /// Minimises sum w |image - s R depth - t|^2 (Eq. 12 with known correspondences) in closed form (Umeyama 1991; the
    /// rotation by Horn's quaternion, which is never a reflection). `weights` must not be negative; `None` means equal
    /// weights. `scale` holds s. Units: those of the two views.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] if lengths differ, [`ErrorKind::Range`] if a number is not finite, [`ErrorKind::Degenerate`]
    /// for fewer than four pairs of positive weight and for points on a line.
    pub fn fit(
        depth: &[Vector3<f64>],
        image: &[Vector3<f64>],
        weights: Option<&[f64]>,
        scale: Option<f64>,
    ) -> Result<Self> {
        if depth.len() != image.len() || weights.is_some_and(|weights| weights.len() != depth.len()) {
            return Err(Error::new(
                ErrorKind::Size,
                "pairs",
                "must have the same number of points and weights on both sides",
            ));
        }
        let weight = |index: usize| weights.map_or(1.0, |weights| weights[index]);
        let weighted = || depth.iter().zip(image).enumerate().map(|(index, (p, q))| (weight(index), p, q));
        let (mut count, mut total) = (0, 0.0);
        let (mut from, mut to) = (Vector3::zeros(), Vector3::zeros());
        for (w, p, q) in weighted() {
            count += usize::from(w > 0.0);
            total += w;
            from += w * p;
            to += w * q;
        }
        if count < FEWEST_PAIRS {
            return Err(
                Error::new(ErrorKind::Degenerate, "pairs", "fewer than four correspondences").value(count as f64)
            );
        }
        from /= total;
        to /= total;
        let (mut covariance, mut spread) = (Matrix3::zeros(), 0.0);
        for (w, p, q) in weighted() {
            covariance += w * (q - to) * (p - from).transpose();
            spread += w * (p - from).norm_squared();
        }
        let rotation = nearest_rotation(&covariance)?;
        let scale = scale.unwrap_or_else(|| rotation.dot(&covariance) / spread);
        positive("pairs", scale)
            .map_err(|_| Error::new(ErrorKind::Degenerate, "pairs", "no similarity fits").value(scale))?;
        Ok(Self { scale, rotation, translation: to - scale * (rotation * from) })
    }

    /// The similarity nearest to the linear model P -> A P + t of Eq. 14: minimises |s R - A| (Eq. 15).
    ///
    /// # Errors
    /// [`ErrorKind::Degenerate`] if A has a rank of at most one or no rotation is near it, [`ErrorKind::Range`] if it
    /// is not finite.
    pub fn nearest(matrix: &Matrix3<f64>, translation: Vector3<f64>) -> Result<Self> {
        let rotation = nearest_rotation(matrix)?;
        let scale = rotation.dot(matrix) / 3.0;
        positive("theta", scale).map_err(|_| {
            Error::new(ErrorKind::Degenerate, "theta", "the linear model is not a similarity").value(scale)
        })?;
        Ok(Self { scale, rotation, translation })
    }
}

/// The unit quaternion of a rotation, which is exact also for half turns.
fn quaternion(rotation: &Matrix3<f64>) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*rotation))
}

/// The rotation R with the largest trace of R^T M, from the eigenvector of Horn's 4x4 matrix (1987) for its largest
/// eigenvalue. Unlike nalgebra's 3x3 SVD it does not square the condition number, and its determinant is always one.
fn nearest_rotation(matrix: &Matrix3<f64>) -> Result<Matrix3<f64>> {
    let size = matrix.norm();
    if !size.is_finite() {
        return Err(Error::new(ErrorKind::Range, "pairs", "must be finite"));
    }
    let degenerate = || Error::new(ErrorKind::Degenerate, "pairs", "the points do not determine a rotation");
    if size <= 0.0 {
        return Err(degenerate());
    }
    let m = matrix / size;
    let trace = m.trace();
    let skew = Vector3::new(m[(2, 1)] - m[(1, 2)], m[(0, 2)] - m[(2, 0)], m[(1, 0)] - m[(0, 1)]);
    let mut horn = Matrix4::zeros();
    horn[(0, 0)] = trace;
    horn.fixed_view_mut::<3, 1>(1, 0).copy_from(&skew);
    horn.fixed_view_mut::<1, 3>(0, 1).copy_from(&skew.transpose());
    horn.fixed_view_mut::<3, 3>(1, 1).copy_from(&(m + m.transpose() - Matrix3::identity() * trace));
    let eigen = symmetric_eigen(&horn).ok_or_else(degenerate)?;
    let largest = eigen.eigenvalues.imax();
    let second = (0..4).filter(|&k| k != largest).map(|k| eigen.eigenvalues[k]).fold(f64::MIN, f64::max);
    // The gap is twice the sum of the second and the signed third singular value: zero for points on a line.
    if eigen.eigenvalues[largest] - second <= RANK_TOLERANCE {
        return Err(degenerate());
    }
    let q = eigen.eigenvectors.column(largest);
    Ok(UnitQuaternion::from_quaternion(Quaternion::new(q[0], q[1], q[2], q[3])).to_rotation_matrix().into_inner())
}

/// A pose in the JavaScript contract: its members, and in addition its angles and its matrix.
#[cfg(feature = "serde")]
mod serialised {
    use super::Similarity;
    use crate::pose::angles::Angles;

    #[derive(serde::Serialize)]
    pub struct Pose {
        scale: f64,
        /// Row by row.
        rotation: [f64; 9],
        translation: [f64; 3],
        angles: Angles,
        /// s R and t, as rows.
        matrix: [[f64; 4]; 4],
    }

    impl From<Similarity> for Pose {
        fn from(pose: Similarity) -> Self {
            let Similarity { scale, rotation, translation } = pose;
            let matrix = pose.matrix();
            Self {
                scale,
                rotation: std::array::from_fn(|at| rotation[(at / 3, at % 3)]),
                translation: translation.into(),
                angles: Angles::of(&rotation),
                matrix: std::array::from_fn(|row| std::array::from_fn(|column| matrix[(row, column)])),
            }
        }
    }
}
