//! P_colour = s R P_depth + t.

use nalgebra::{Matrix3, Vector3};

use crate::error::{Error, ErrorKind, Result};
use crate::options::positive;

/// How far R^T R may be from one: rotations typed with five digits pass, anything else is a mistake.
const ROTATION_TOLERANCE: f64 = 1e-4;

/// An active, right-handed similarity that carries points of the depth view into the colour view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    /// s > 0.
    pub scale: f64,
    /// R, orthonormal with determinant one.
    pub rotation: Matrix3<f64>,
    /// t in units of the colour view.
    pub translation: Vector3<f64>,
}

impl Similarity {
    /// The pose that changes nothing.
    #[must_use]
    pub fn identity() -> Self {
        Self { scale: 1.0, rotation: Matrix3::identity(), translation: Vector3::zeros() }
    }

    /// # Errors
    /// [`ErrorKind::Range`] naming the member of `field` that is not finite, not positive or no rotation.
    pub fn validate(&self, field: &'static str) -> Result<()> {
        positive("scale", self.scale).map_err(|error| error.below(field))?;
        if let Some(index) = self.translation.iter().position(|value| !value.is_finite()) {
            return Err(Error::new(ErrorKind::Range, "translation", "must be finite").at(index).below(field));
        }
        let off = (self.rotation.transpose() * self.rotation - Matrix3::identity()).abs().max();
        if off.is_nan() || off > ROTATION_TOLERANCE || self.rotation.determinant() < 0.0 {
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

    /// The similarity that undoes this one.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        let scale = 1.0 / self.scale;
        Self { scale, rotation, translation: -scale * (rotation * self.translation) }
    }

    /// Angle between the rotations of two poses in degrees.
    #[must_use]
    pub fn degrees_to(&self, other: &Self) -> f64 {
        // 2 asin(|R - R'|_F / (2 sqrt 2)) keeps its digits for small angles, where acos loses half of them.
        let chord = (self.rotation - other.rotation).norm() / 8.0_f64.sqrt();
        2.0 * chord.min(1.0).asin().to_degrees()
    }
}
