//! The three angles of a rotation (Eq. 15 and 16): R = Rx(alpha) Ry(beta) Rz(gamma).
//!
//! Eq. 16 seeks the scale and the angles for which s Rx Ry Rz is nearest to a 3x3 matrix A in least squares; the paper
//! finds them by Levenberg-Marquardt. They have a closed form: over all rotations the minimum is the polar factor of A
//! ([`Similarity::nearest`](super::Similarity::nearest)), and every rotation has such angles exactly.
//! `tests/library/pose_angles.rs` solves Eq. 16 as in the paper and finds the same angles.

use nalgebra::Matrix3;

/// Value of cos beta below which alpha and gamma turn about the same axis, so that only their sum is determined. Beta
/// is then this many radians from +-90 degrees. By convention alpha is then zero.
const POLE: f64 = 1e-6;

/// Angles in degrees of R = Rx(alpha) Ry(beta) Rz(gamma), active and right-handed, in the colour view's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default))]
pub struct Angles {
    /// About x (right), degrees, in (-180, 180]; zero where beta is at a pole.
    pub alpha: f64,
    /// About y (down), degrees, in [-90, 90].
    pub beta: f64,
    /// About z (forward), degrees, in (-180, 180].
    pub gamma: f64,
}

impl Angles {
    /// R = Rx(alpha) Ry(beta) Rz(gamma).
    #[must_use]
    pub fn rotation(&self) -> Matrix3<f64> {
        let (sx, cx) = self.alpha.to_radians().sin_cos();
        let (sy, cy) = self.beta.to_radians().sin_cos();
        let (sz, cz) = self.gamma.to_radians().sin_cos();
        let x = Matrix3::new(1.0, 0.0, 0.0, 0.0, cx, -sx, 0.0, sx, cx);
        let y = Matrix3::new(cy, 0.0, sy, 0.0, 1.0, 0.0, -sy, 0.0, cy);
        let z = Matrix3::new(cz, -sz, 0.0, sz, cz, 0.0, 0.0, 0.0, 1.0);
        x * y * z
    }

    /// The angles of a rotation, in closed form; the residual of Eq. 16 is zero for them.
    #[must_use]
    pub fn of(rotation: &Matrix3<f64>) -> Self {
        let r = rotation;
        let cosine = r[(0, 0)].hypot(r[(0, 1)]);
        let beta = r[(0, 2)].atan2(cosine);
        let alpha = if cosine < POLE { 0.0 } else { (-r[(1, 2)]).atan2(r[(2, 2)]) };
        // The second row of Rx(-alpha) R is (sin gamma, cos gamma, 0) for every beta, so near the pole gamma absorbs
        // what alpha loses.
        let (sine, cosine) = alpha.sin_cos();
        let gamma = (cosine * r[(1, 0)] + sine * r[(2, 0)]).atan2(cosine * r[(1, 1)] + sine * r[(2, 1)]);
        // Adding zero turns negative zero into zero, because a minus sign would look like a result.
        let degrees = |radians: f64| radians.to_degrees() + 0.0;
        Self { alpha: degrees(alpha), beta: degrees(beta), gamma: degrees(gamma) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poles_have_no_alpha() {
        for beta in [90.0, -90.0] {
            let angles = Angles::of(&Angles { alpha: 30.0, beta, gamma: 10.0 }.rotation());
            assert_eq!(angles.alpha, 0.0);
            let sum = if beta > 0.0 { 40.0 } else { -20.0 };
            assert!((angles.beta - beta).abs() < 1e-6 && (angles.gamma - sum).abs() < 1e-9, "{angles:?}");
        }
    }
}
