//! Albedo that follows the relief, because dirt and ambient shadow lie in hollows, and wear on ridges.
//!
//! Curvature of the depth map at two scales, and its squares, are regressors of the log albedo in addition to the
//! light. At the beginning of a round their coefficients are fitted to the residuals in alternation with the light; the
//! resulting albedo stays fixed during the round.

use nalgebra::{SMatrix, SVector};

use super::problem::PhotometricProblem;
use super::weighting::CORRELATED;
use crate::pose::curvature::curvatures;

/// Number of regressors of a point.
const REGRESSORS: usize = 4;
type Gram = SMatrix<f64, REGRESSORS, REGRESSORS>;
type Coefficients = SVector<f64, REGRESSORS>;

/// One sigma of a coefficient, log units per standard deviation of its regressor.
const PRIOR: f64 = 0.3;

/// Regressors, their coefficients, and the resulting albedo; owns its memory.
pub(super) struct Relief {
    regressors: Vec<[f32; REGRESSORS]>,
    coefficients: [Coefficients; 3],
    albedo: Vec<[f32; 3]>,
}

/// Sums of a fit over points.
pub(super) struct ReliefSums {
    gram: Gram,
    right: [Coefficients; 3],
}

impl Relief {
    /// Built from the normals of a problem.
    pub fn new(problem: &PhotometricProblem<'_>) -> Self {
        let size = problem.depth_size;
        let [fine, coarse] = curvatures(size, problem.normals);
        let regressors = fine.into_iter().zip(coarse).map(|(a, b)| [a, b, a * a, b * b]).collect();
        Self { regressors, coefficients: [Coefficients::zeros(); 3], albedo: vec![[0.0; 3]; size.len()] }
    }

    /// Resets coefficients and albedo.
    pub fn clear(&mut self) {
        self.coefficients = [Coefficients::zeros(); 3];
        self.albedo.fill([0.0; 3]);
    }

    /// Log albedo of a depth pixel.
    pub fn albedo(&self, index: usize) -> [f32; 3] {
        self.albedo[index]
    }

    /// Adds the residual of a point, from which the present albedo has already been subtracted.
    pub fn add(&self, sums: &mut ReliefSums, index: usize, residual: [f64; 3], weight: f64) {
        let regressors = SVector::from(self.regressors[index].map(f64::from));
        sums.gram.ger(weight, &regressors, &regressors, 1.0);
        for (right, residual) in sums.right.iter_mut().zip(residual) {
            right.axpy(weight * residual, &regressors, 1.0);
        }
    }

    /// Takes a step of the coefficients; `noise` is the standard deviation of the residuals, log units.
    pub fn step(&mut self, mut sums: ReliefSums, noise: f64) {
        let ridge = CORRELATED * (noise / PRIOR).powi(2);
        sums.gram += Gram::identity() * ridge;
        let Some(factor) = sums.gram.cholesky() else { return };
        for (coefficients, right) in self.coefficients.iter_mut().zip(sums.right) {
            *coefficients += factor.solve(&(right - *coefficients * ridge));
        }
        for (albedo, regressors) in self.albedo.iter_mut().zip(&self.regressors) {
            let regressors = SVector::from(regressors.map(f64::from));
            *albedo = std::array::from_fn(|channel| self.coefficients[channel].dot(&regressors) as f32);
        }
    }
}

impl ReliefSums {
    pub fn new() -> Self {
        Self { gram: Gram::zeros(), right: [Coefficients::zeros(); 3] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_albedo_that_goes_with_the_relief_is_found() {
        let regressors: Vec<[f32; REGRESSORS]> = (0..400)
            .map(|k| {
                let [a, b] = [0.11, 0.47].map(|pace| (pace * k as f32).sin());
                [a, b, a * a, b * b]
            })
            .collect();
        let count = regressors.len();
        let mut relief = Relief { regressors, coefficients: [Coefficients::zeros(); 3], albedo: vec![[0.0; 3]; count] };
        let truth = [0.2, -0.1, 0.05, 0.0];
        for _ in 0..3 {
            let mut sums = ReliefSums::new();
            for index in 0..count {
                let albedo: f64 = relief.regressors[index].iter().zip(truth).map(|(r, c)| f64::from(*r) * c).sum();
                let left = relief.albedo(index).map(|found| albedo - f64::from(found));
                relief.add(&mut sums, index, left, 1.0);
            }
            relief.step(sums, 1e-3);
        }
        for (found, truth) in relief.coefficients[1].iter().zip(truth) {
            assert!((found - truth).abs() < 2e-3, "{found} {truth}");
        }
        relief.clear();
        assert_eq!(relief.albedo(7), [0.0; 3]);
    }
}
