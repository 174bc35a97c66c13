//! Albedo that follows the relief, because dirt and ambient shadow lie in hollows, and wear on ridges.
//!
//! Curvature of the depth map at two scales, and its squares, are regressors of the log albedo in addition to the
//! light. At the beginning of a round their coefficients are fitted to the residuals in alternation with the light; the
//! resulting albedo stays fixed during the round.

use nalgebra::{SMatrix, SVector};

use super::problem::PhotometricProblem;
use super::weighting::CORRELATED;
use crate::pose::contrast::LocalMeans;
use crate::pose::residuals::MEASURED_SIDE;
use crate::view::{Normals, Size};

/// Number of regressors of a point.
const REGRESSORS: usize = 4;
type Gram = SMatrix<f64, REGRESSORS, REGRESSORS>;
type Coefficients = SVector<f64, REGRESSORS>;

/// Sigmas of the Gaussians, depth pixels of an object of the size of [`MEASURED_SIDE`].
const SCALES: [f64; 2] = [1.5, 4.0];
/// Curvatures are clamped to this many standard deviations.
const LARGEST: f32 = 2.5;
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
        let [fine, coarse] = SCALES.map(|scale| curvature(size, problem.normals, scale));
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

/// Divergence of the normals, smoothed by a Gaussian, in standard deviations; zero where a neighbour is missing.
fn curvature(size: Size, normals: &Normals, scale: f64) -> Vec<f32> {
    let valid: Vec<f32> = (0..size.len()).map(|index| f32::from(u8::from(normals.is_valid(index)))).collect();
    let slope = |index: usize| if valid[index] > 0.0 { [normals.x[index], normals.y[index]] } else { [0.0; 2] };
    let slopes: Vec<[f32; 2]> = (0..size.len()).map(slope).collect();
    let count = valid.iter().sum::<f32>().max(1.0);
    let unit = f64::from(count).sqrt() / MEASURED_SIDE;
    let smooth = LocalMeans::new(size.width, size.len(), scale * unit).smoothed(&valid, &slopes);
    let divergence = |index: usize| {
        let (column, row) = size.position(index);
        let is_inside = column > 0 && row > 0 && column + 1 < size.width && row + 1 < size.height;
        if !is_inside || valid[index] == 0.0 {
            return 0.0;
        }
        let beside = [index - 1, index + 1, index - size.width, index + size.width];
        let [left, right, above, below] = beside.map(|at| smooth[at]);
        let is_whole = beside.iter().all(|&at| valid[at] > 0.0);
        if is_whole { right[0] - left[0] + below[1] - above[1] } else { 0.0 }
    };
    let mut curvature: Vec<f32> = (0..size.len()).map(divergence).collect();
    let square = curvature.iter().map(|value| value * value).sum::<f32>() / count;
    let spread = square.sqrt().max(f32::MIN_POSITIVE);
    curvature.iter_mut().for_each(|value| *value = (*value / spread).clamp(-LARGEST, LARGEST));
    curvature
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Size = Size { width: 60, height: 60 };

    /// Normals of the front of a ball, which face the camera; those of a bowl have the opposite sign of x and y.
    fn ball(sign: f32) -> Normals {
        let mut normals = Normals::missing(SIZE.len());
        for index in 0..SIZE.len() {
            let (column, row) = SIZE.position(index);
            let [x, y] = [column, row].map(|at| (at as f32 - 29.5) / 30.0);
            let square = x * x + y * y;
            if square < 0.9 {
                normals.set(index, [sign * x, sign * y, -(1.0 - square).sqrt()]);
            }
        }
        normals
    }

    #[test]
    fn balls_bulge_and_bowls_are_hollow() {
        let middle = SIZE.index(30, 30);
        let [bulging, hollow] = [1.0, -1.0].map(|sign| curvature(SIZE, &ball(sign), 1.5)[middle]);
        assert!(bulging > 0.5 && hollow < -0.5, "{bulging} {hollow}");
        assert_eq!(curvature(SIZE, &ball(1.0), 1.5)[0], 0.0);
    }

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
