//! Eq. 16 as the paper solves it, by Levenberg-Marquardt over scale and angles: the closed form finds the same.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::common::laws;
use bimodal_stereo::{Angles, Similarity};
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt, differentiate_numerically};
use nalgebra::storage::Owned;
use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, U4, U9, Vector3, Vector4};
use proptest::prelude::*;

/// Nine residuals s Rx Ry Rz - A in four unknowns: s and three angles in radians.
struct Equation16 {
    parameters: Vector4<f64>,
    target: Matrix3<f64>,
}

impl Equation16 {
    /// Starts at a scale and at angles.
    fn new(scale: f64, angles: Angles, target: Matrix3<f64>) -> Self {
        let Angles { alpha, beta, gamma } = angles;
        let parameters = Vector4::new(scale, alpha.to_radians(), beta.to_radians(), gamma.to_radians());
        Self { parameters, target }
    }

    fn scale(&self) -> f64 {
        self.parameters[0]
    }

    /// Rx, Ry, Rz.
    fn factors(&self) -> [Matrix3<f64>; 3] {
        let [alpha, beta, gamma] = [1, 2, 3].map(|index| self.parameters[index].to_degrees());
        let none = Angles::default();
        [Angles { alpha, ..none }, Angles { beta, ..none }, Angles { gamma, ..none }].map(|angles| angles.rotation())
    }

    fn rotation(&self) -> Matrix3<f64> {
        let [x, y, z] = self.factors();
        x * y * z
    }

    fn solved(self) -> Self {
        let (problem, report) = LevenbergMarquardt::new().minimize(self);
        assert!(report.termination.was_successful(), "{:?}", report.termination);
        problem
    }
}

impl LeastSquaresProblem<f64, U9, U4> for Equation16 {
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
        let difference = self.rotation() * self.scale() - self.target;
        Some(SVector::from_column_slice(difference.as_slice()))
    }

    fn jacobian(&self) -> Option<SMatrix<f64, 9, 4>> {
        let [x, y, z] = self.factors();
        let s = self.scale();
        // d Rx / d alpha = [e_x] Rx with the cross-product matrix of the axis, and so on.
        let [ex, ey, ez] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| axis.cross_matrix());
        let columns = [x * y * z, ex * x * y * z * s, x * ey * y * z * s, x * y * ez * z * s];
        Some(SMatrix::from_columns(&columns.map(|column| SVector::<f64, 9>::from_column_slice(column.as_slice()))))
    }
}

#[test]
fn jacobian_agrees_with_finite_differences() {
    let target = Angles { alpha: 20.0, beta: -35.0, gamma: 110.0 }.rotation() * 0.8;
    let mut problem = Equation16::new(1.3, Angles { alpha: 23.0, beta: -40.0, gamma: 115.0 }, target);
    let numerical = differentiate_numerically(&mut problem).unwrap();
    let analytic = problem.jacobian().unwrap();
    assert!((numerical - analytic).abs().max() < 1e-6, "{}", numerical - analytic);
}

#[test]
fn finds_a_rotation_from_far_off() {
    let angles = Angles { alpha: 12.0, beta: 50.0, gamma: -70.0 };
    let start = Angles { alpha: 35.0, beta: 25.0, gamma: -45.0 };
    let found = Equation16::new(0.5, start, angles.rotation() * 2.0).solved();
    assert!((found.rotation() - angles.rotation()).norm() < 1e-9);
    assert!((found.scale() - 2.0).abs() < 1e-9);
}

proptest! {
    #![proptest_config(laws(128))]

    /// The solver starts off the closed form, so that it has a way to go.
    #[test]
    fn least_squares_agrees_with_the_closed_form(
        turn in prop::array::uniform3(-3.0..3.0), scale in 0.1..10.0_f64, bend in prop::array::uniform9(-0.05..0.05),
        off in prop::array::uniform3(-5.0..5.0),
    ) {
        let rotation = Rotation3::new(Vector3::from(turn)).into_inner();
        let matrix = (rotation + Matrix3::from_row_slice(&bend)) * scale;
        let closed = Similarity::nearest(&matrix, Vector3::zeros()).unwrap();
        let angles = Angles::of(&closed.rotation);
        let [alpha, beta, gamma] = [angles.alpha + off[0], angles.beta + off[1], angles.gamma + off[2]];
        // The size of A is taken out, so that the solver's tolerances are relative.
        let found = Equation16::new(1.0, Angles { alpha, beta, gamma }, matrix / scale).solved();
        prop_assert!((found.scale() * scale / closed.scale - 1.0).abs() < 1e-6);
        prop_assert!((found.rotation() - angles.rotation()).norm() < 1e-5);
    }

    #[test]
    fn least_squares_agrees_near_the_poles(
        alpha in -180.0..180.0, sign in prop::sample::select(vec![-1.0, 1.0]), power in -12.0..-2.0, gamma in -180.0..180.0,
    ) {
        let rotation = Angles { alpha, beta: sign * (90.0 - 10.0_f64.powf(power)), gamma }.rotation();
        let found = Equation16::new(1.0, Angles::of(&rotation), rotation).solved();
        prop_assert!((found.rotation() - rotation).norm() < 4e-6);
    }
}
