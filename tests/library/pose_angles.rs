//! Eq. 16, solved as in the paper by Levenberg-Marquardt over scale and angles: the closed form finds the same.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::common::laws;
use bimodal_stereo::{Angles, Similarity};
use nalgebra::{Matrix3, Rotation3, Vector3};
use proptest::prelude::*;
use rmpfit::{MPConfig, MPFitter, MPPar, MPResult, MPSide, MPSuccess};

/// The unknowns: s and three angles in radians.
type Parameters = [f64; 4];

/// Nine residuals s Rx Ry Rz - A in four unknowns.
struct Equation16 {
    parameters: Parameters,
    target: Matrix3<f64>,
    settings: [MPPar; 4],
}

/// The smallest tolerances that rounding permits.
const PRECISE: MPConfig = MPConfig { ftol: 1e-15, xtol: 1e-15, gtol: 1e-15, ..MPConfig::new() };

fn scale_of(parameters: &[f64]) -> f64 {
    parameters[0]
}

/// Rx, Ry, Rz.
fn factors_of(parameters: &[f64]) -> [Matrix3<f64>; 3] {
    let [alpha, beta, gamma] = [1, 2, 3].map(|index| parameters[index].to_degrees());
    let none = Angles::default();
    [Angles { alpha, ..none }, Angles { beta, ..none }, Angles { gamma, ..none }].map(|angles| angles.rotation())
}

fn rotation_of(parameters: &[f64]) -> Matrix3<f64> {
    let [x, y, z] = factors_of(parameters);
    x * y * z
}

/// The derivatives of s Rx Ry Rz with respect to each unknown.
fn derivatives(parameters: &[f64]) -> [Matrix3<f64>; 4] {
    let [x, y, z] = factors_of(parameters);
    let s = scale_of(parameters);
    // d Rx / d alpha = [e_x] Rx with the cross-product matrix of the axis, and likewise for the other axes.
    let [ex, ey, ez] = [Vector3::x(), Vector3::y(), Vector3::z()].map(|axis| axis.cross_matrix());
    [x * y * z, ex * x * y * z * s, x * ey * y * z * s, x * y * ez * z * s]
}

impl Equation16 {
    /// Starts at a scale and angles.
    fn new(scale: f64, angles: Angles, target: Matrix3<f64>) -> Self {
        let Angles { alpha, beta, gamma } = angles;
        let parameters = [scale, alpha.to_radians(), beta.to_radians(), gamma.to_radians()];
        let settings = [(); 4].map(|()| MPPar { side: MPSide::User, ..MPPar::default() });
        Self { parameters, target, settings }
    }

    fn scale(&self) -> f64 {
        scale_of(&self.parameters)
    }

    fn rotation(&self) -> Matrix3<f64> {
        rotation_of(&self.parameters)
    }

    fn solved(mut self) -> Self {
        let mut parameters = self.parameters;
        let status = self.mpfit(&mut parameters).unwrap();
        assert!(!matches!(status.success, MPSuccess::NotDone | MPSuccess::MaxIter), "{} iterations", status.n_iter);
        Self { parameters, ..self }
    }
}

impl MPFitter for Equation16 {
    fn eval(&mut self, parameters: &[f64], deviates: &mut [f64]) -> MPResult<()> {
        let difference = rotation_of(parameters) * scale_of(parameters) - self.target;
        deviates.copy_from_slice(difference.as_slice());
        Ok(())
    }

    fn jacobian(&mut self, parameters: &[f64], deviates: &mut [f64], columns: &mut [Option<Vec<f64>>]) -> MPResult<()> {
        for (column, derivative) in columns.iter_mut().flatten().zip(&derivatives(parameters)) {
            column.copy_from_slice(derivative.as_slice());
        }
        self.eval(parameters, deviates)
    }

    fn number_of_points(&self) -> usize {
        self.target.len()
    }

    fn config(&self) -> &MPConfig {
        &PRECISE
    }

    fn parameters(&self) -> &[MPPar] {
        &self.settings
    }
}

#[test]
fn jacobian_agrees_with_finite_differences() {
    const STEP: f64 = 1e-6;
    let angles = Angles { alpha: 23.0, beta: -40.0, gamma: 115.0 };
    let Equation16 { parameters, .. } = Equation16::new(1.3, angles, Matrix3::zeros());
    for (index, analytic) in derivatives(&parameters).into_iter().enumerate() {
        let moved = |step: f64| {
            let mut moved = parameters;
            moved[index] += step;
            rotation_of(&moved) * scale_of(&moved)
        };
        let numerical = (moved(STEP) - moved(-STEP)) / (2.0 * STEP);
        assert!((numerical - analytic).abs().max() < 1e-6, "{index}: {}", numerical - analytic);
    }
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

    /// The solver starts away from the closed form, so that it has to iterate.
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
        // The size of A is divided out, so that the solver's tolerances are relative.
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
