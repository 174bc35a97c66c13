//! The three angles of a rotation (Eq. 15 and 16): R = Rx(alpha) Ry(beta) Rz(gamma).
//!
//! Two ways that agree: read off a rotation in closed form, or fitted together with the scale to any 3x3 matrix by
//! Levenberg-Marquardt, as the paper does.

use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{Matrix3, SMatrix, SVector, U4, U9, Vector4};

use crate::error::{Error, ErrorKind, Result};

/// Closer to beta = +-90 degrees than this (as cos beta, that is in radians) alpha and gamma turn about the same axis
/// and only their sum is seen; the convention then is alpha = 0.
const POLE: f64 = 1e-6;

/// Levenberg-Marquardt gives up after PATIENCE * (4 + 1) evaluations; from the closed-form start it needs under ten.
const PATIENCE: usize = 20;

/// Angles in degrees of R = Rx(alpha) Ry(beta) Rz(gamma), active and right-handed, in the colour view's frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Angles {
    /// About x (right), degrees, in (-180, 180]; zero where beta is at a pole.
    pub alpha: f64,
    /// About y (down), degrees, in [-90, 90].
    pub beta: f64,
    /// About z (forward), degrees, in (-180, 180].
    pub gamma: f64,
}

/// What [`Angles::fit`] found: s Rx Ry Rz next to A in the sense of least squares.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnglesFit {
    /// The angles.
    pub angles: Angles,
    /// s > 0.
    pub scale: f64,
    /// |s Rx Ry Rz - A|, Frobenius norm.
    pub residual: f64,
}

impl Angles {
    /// R = Rx(alpha) Ry(beta) Rz(gamma).
    #[must_use]
    pub fn rotation(&self) -> Matrix3<f64> {
        let [x, y, z] = self.factors();
        x * y * z
    }

    /// The angles of a rotation, in closed form.
    #[must_use]
    pub fn of(rotation: &Matrix3<f64>) -> Self {
        let r = rotation;
        let cosine = r[(0, 0)].hypot(r[(0, 1)]);
        let beta = r[(0, 2)].atan2(cosine);
        let alpha = if cosine < POLE { 0.0 } else { (-r[(1, 2)]).atan2(r[(2, 2)]) };
        // The second row of Rx(-alpha) R is (sin gamma, cos gamma, 0) for every beta, so that what alpha loses near
        // the pole gamma takes up.
        let (sine, cosine) = alpha.sin_cos();
        let gamma = (cosine * r[(1, 0)] + sine * r[(2, 0)]).atan2(cosine * r[(1, 1)] + sine * r[(2, 1)]);
        // Adding zero turns a negative zero, which reads like a result, into a plain one.
        let degrees = |radians: f64| radians.to_degrees() + 0.0;
        Self { alpha: degrees(alpha), beta: degrees(beta), gamma: degrees(gamma) }
    }

    /// Minimises |s Rx(alpha) Ry(beta) Rz(gamma) - A|^2 over scale and angles (Eq. 15 and 16) by Levenberg-Marquardt.
    ///
    /// # Errors
    /// [`ErrorKind::Degenerate`] where A is not finite or its determinant is not above zero: no rotation is near it.
    pub fn fit(matrix: &Matrix3<f64>) -> Result<AnglesFit> {
        let determinant = matrix.determinant();
        if determinant.is_nan() || determinant.is_infinite() || determinant <= 0.0 {
            return Err(
                Error::new(ErrorKind::Degenerate, "theta", "the linear model is no similarity").value(determinant)
            );
        }
        // The size of A is taken out, so that tolerances inside the solver are relative.
        let size = determinant.cbrt();
        let target = matrix / size;
        let start = Self::of(&target);
        let parameters = Vector4::new(1.0, start.alpha.to_radians(), start.beta.to_radians(), start.gamma.to_radians());
        let (problem, report) =
            LevenbergMarquardt::new().with_patience(PATIENCE).minimize(AnglesProblem { parameters, target });
        let scale = problem.parameters[0] * size;
        let rotation = problem.angles().rotation();
        let residual = (rotation * scale - matrix).norm();
        if !residual.is_finite() || scale <= 0.0 || report.termination.was_usage_issue() {
            return Err(Error::new(ErrorKind::Degenerate, "theta", "no angles fit the linear model"));
        }
        // Through the matrix and back: the solver's angles may lie beyond the poles or several turns away.
        Ok(AnglesFit { angles: Self::of(&rotation), scale, residual })
    }

    /// Rx, Ry, Rz.
    fn factors(&self) -> [Matrix3<f64>; 3] {
        let (sx, cx) = self.alpha.to_radians().sin_cos();
        let (sy, cy) = self.beta.to_radians().sin_cos();
        let (sz, cz) = self.gamma.to_radians().sin_cos();
        [
            Matrix3::new(1.0, 0.0, 0.0, 0.0, cx, -sx, 0.0, sx, cx),
            Matrix3::new(cy, 0.0, sy, 0.0, 1.0, 0.0, -sy, 0.0, cy),
            Matrix3::new(cz, -sz, 0.0, sz, cz, 0.0, 0.0, 0.0, 1.0),
        ]
    }
}

/// Nine residuals s R - A in four unknowns: s and three angles in radians.
struct AnglesProblem {
    parameters: Vector4<f64>,
    target: Matrix3<f64>,
}

impl AnglesProblem {
    fn angles(&self) -> Angles {
        let [_, alpha, beta, gamma] = self.parameters.into();
        Angles { alpha: alpha.to_degrees(), beta: beta.to_degrees(), gamma: gamma.to_degrees() }
    }
}

impl LeastSquaresProblem<f64, U9, U4> for AnglesProblem {
    type ParameterStorage = Owned<f64, U4>;
    type ResidualStorage = Owned<f64, U9>;
    type JacobianStorage = Owned<f64, U9, U4>;

    fn set_params(&mut self, parameters: &Vector4<f64>) {
        self.parameters.copy_from(parameters);
    }

    fn params(&self) -> Vector4<f64> {
        self.parameters
    }

    fn residuals(&self) -> Option<SVector<f64, 9>> {
        let difference = self.angles().rotation() * self.parameters[0] - self.target;
        Some(SVector::from_column_slice(difference.as_slice()))
    }

    fn jacobian(&self) -> Option<SMatrix<f64, 9, 4>> {
        let [x, y, z] = self.angles().factors();
        let scale = self.parameters[0];
        // d Rx = [e_x] Rx and so on: each derivative turns the factor by another quarter.
        let columns = [
            x * y * z,
            generator(0) * x * y * z * scale,
            x * generator(1) * y * z * scale,
            x * y * generator(2) * z * scale,
        ];
        Some(SMatrix::from_columns(&columns.map(|column| SVector::<f64, 9>::from_column_slice(column.as_slice()))))
    }
}

/// The cross-product matrix of a coordinate axis.
fn generator(axis: usize) -> Matrix3<f64> {
    let mut unit = nalgebra::Vector3::zeros();
    unit[axis] = 1.0;
    unit.cross_matrix()
}

#[cfg(test)]
mod tests {
    use super::*;
    use levenberg_marquardt::differentiate_numerically;

    #[test]
    fn jacobian_agrees_with_finite_differences() {
        let angles = Angles { alpha: 20.0, beta: -35.0, gamma: 110.0 };
        let mut problem =
            AnglesProblem { parameters: Vector4::new(1.3, 0.4, -0.7, 2.0), target: angles.rotation() * 0.8 };
        let numerical = differentiate_numerically(&mut problem).unwrap();
        let analytic = problem.jacobian().unwrap();
        assert!((numerical - analytic).abs().max() < 1e-6, "{}", numerical - analytic);
    }

    #[test]
    fn levenberg_marquardt_finds_the_closed_form_from_far_off() {
        let angles = Angles { alpha: 12.0, beta: 50.0, gamma: -70.0 };
        let parameters = Vector4::new(0.5, 0.6, 0.4, -0.8);
        let problem = AnglesProblem { parameters, target: angles.rotation() * 2.0 };
        let (problem, report) = LevenbergMarquardt::new().minimize(problem);
        assert!(report.termination.was_successful());
        let found = problem.angles();
        assert!((found.rotation() - angles.rotation()).norm() < 1e-9);
        assert!((problem.parameters[0] - 2.0).abs() < 1e-9);
    }

    #[test]
    fn poles_have_no_alpha() {
        for beta in [90.0, -90.0] {
            let angles = Angles::of(&Angles { alpha: 30.0, beta, gamma: 10.0 }.rotation());
            assert_eq!(angles.alpha, 0.0);
            let sum = if beta > 0.0 { 40.0 } else { -20.0 };
            assert!((angles.beta - beta).abs() < 1e-6 && (angles.gamma - sum).abs() < 1e-9, "{angles:?}");
        }
    }

    #[test]
    fn what_is_no_similarity_is_an_error() {
        for matrix in [Matrix3::zeros(), -Matrix3::identity(), Matrix3::identity() * f64::NAN] {
            assert_eq!(Angles::fit(&matrix).unwrap_err().kind(), ErrorKind::Degenerate);
        }
    }
}
