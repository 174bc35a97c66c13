//! A pose as nalgebra's transformations and as a 4x4 matrix, and back.
//!
//! All of them are active and map points of the depth view into the frame of the colour view: x right, y down, z
//! forward, in metres behind a camera and in pixels without one. None of them is the pose of a camera in the world; the
//! pose of the colour camera in the frame of the depth camera is the inverse.
//!
//! ```
//! use bimodal_stereo::Similarity;
//! use bimodal_stereo::nalgebra::{Isometry3, Matrix4, Similarity3, Translation3, UnitQuaternion};
//!
//! // A colour camera 10 cm to the right of the depth camera sees everything 10 cm further left.
//! let rig = Isometry3::from_parts(Translation3::new(-0.1, 0.0, 0.0), UnitQuaternion::identity());
//! let pose = Similarity::from(rig);
//! assert_eq!(pose.matrix()[(0, 3)], -0.1);
//!
//! let matrix: Matrix4<f64> = pose.into();
//! assert_eq!(Similarity::try_from(matrix)?, pose);
//! assert_eq!(Isometry3::try_from(pose)?, rig);
//! assert_eq!(Similarity3::try_from(pose)?.scaling(), 1.0);
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```

use nalgebra::{Isometry3, Matrix4, Rotation3, Similarity3, Translation3, UnitQuaternion};

use super::similarity::Similarity;
use crate::error::{Error, ErrorKind, Result};

/// Largest difference of a scale from one in a rigid motion, the rounding error of a few products.
const UNIT_TOLERANCE: f64 = 1e-9;
/// Largest difference of the last row of a matrix from 0, 0, 0, 1.
const ROW_TOLERANCE: f64 = 1e-9;

impl Similarity {
    /// The homogeneous 4x4 matrix of the pose,
    ///
    /// > | s R  t |
    /// > |  0   1 |
    ///
    /// The matrix maps (x, y, z, 1) of the depth view into the colour view.
    #[must_use]
    pub fn matrix(&self) -> Matrix4<f64> {
        let mut matrix = (self.scale * self.rotation).to_homogeneous();
        matrix.fixed_view_mut::<3, 1>(0, 3).copy_from(&self.translation);
        matrix
    }
}

impl From<Similarity> for Matrix4<f64> {
    /// [`Similarity::matrix`].
    fn from(pose: Similarity) -> Self {
        pose.matrix()
    }
}

impl TryFrom<Matrix4<f64>> for Similarity {
    type Error = Error;

    /// The pose of a homogeneous matrix; its rotation is made orthonormal to the last digit.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] if the last row is not 0, 0, 0, 1, the upper left 3x3 block is not a rotation times a
    /// positive scale, or a number is not finite. The field is `matrix` or a member of it.
    fn try_from(matrix: Matrix4<f64>) -> Result<Self> {
        let refused = |message: &'static str| Error::new(ErrorKind::Range, "matrix", message);
        // This comparison also rejects NaN.
        let is_row = |column: usize, wanted: f64| (matrix[(3, column)] - wanted).abs() <= ROW_TOLERANCE;
        if !(is_row(0, 0.0) && is_row(1, 0.0) && is_row(2, 0.0) && is_row(3, 1.0)) {
            return Err(refused("must have the last row 0, 0, 0, 1"));
        }
        let block = matrix.fixed_view::<3, 3>(0, 0).into_owned();
        let scale = block.determinant().cbrt();
        if !(scale.is_finite() && scale > 0.0) {
            return Err(refused("must be a rotation times a positive scale in its upper left block").value(scale));
        }
        let translation = matrix.fixed_view::<3, 1>(0, 3).into_owned();
        let pose = Self { scale, rotation: block / scale, translation };
        pose.validate("matrix")?;
        Ok(pose.orthonormal())
    }
}

impl From<Isometry3<f64>> for Similarity {
    /// A rigid motion has a scale of one.
    fn from(motion: Isometry3<f64>) -> Self {
        let rotation = motion.rotation.to_rotation_matrix().into_inner();
        Self { scale: 1.0, rotation, translation: motion.translation.vector }
    }
}

impl TryFrom<Similarity> for Isometry3<f64> {
    type Error = Error;

    /// The pose as a rigid motion. To drop the scale, set it to one: `Similarity { scale: 1.0, ..pose }`.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] with the invalid member of `pose`, or `pose.scale` if it is not one.
    fn try_from(pose: Similarity) -> Result<Self> {
        pose.validate("pose")?;
        if (pose.scale - 1.0).abs() > UNIT_TOLERANCE {
            let error = Error::new(ErrorKind::Range, "pose.scale", "must be one in a rigid motion");
            return Err(error.value(pose.scale));
        }
        Ok(Self::from_parts(Translation3::from(pose.translation), quaternion(&pose)))
    }
}

impl TryFrom<Similarity3<f64>> for Similarity {
    type Error = Error;

    /// The same transformation.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] if the scaling is not positive, which nalgebra permits, or a number is not finite. The
    /// field is a member of `similarity`.
    fn try_from(similarity: Similarity3<f64>) -> Result<Self> {
        let pose = Self { scale: similarity.scaling(), ..Self::from(similarity.isometry) };
        pose.validate("similarity")?;
        Ok(pose)
    }
}

impl TryFrom<Similarity> for Similarity3<f64> {
    type Error = Error;

    /// The same transformation.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] with the invalid member of `pose`.
    fn try_from(pose: Similarity) -> Result<Self> {
        pose.validate("pose")?;
        Ok(Self::from_parts(Translation3::from(pose.translation), quaternion(&pose), pose.scale))
    }
}

fn quaternion(pose: &Similarity) -> UnitQuaternion<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(pose.rotation))
}
