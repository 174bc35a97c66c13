//! Removes the noise from a depth map: min over z of sum a (z - measured)^2 + lambda sum rho(second differences of z)
//! (docs/method/views.md).
//!
//! lambda = sigma^2 / c^2 is Bayes' rule for the noise and the roughness of the map itself ([`DepthNoise`]), so the
//! window adapts to the map. rho is Geman-McClure with a scale of two c, so that creases and depth discontinuities keep
//! their shape. Second differences run along rows, columns and both (as in a thin plate), between pixels with a depth;
//! holes stay holes.
//!
//! Method: iteratively reweighted least squares, each round by conjugate gradients with the diagonal as preconditioner.
//! Smoothing reaches over lambda^(1/4) pixels, two or three, so few iterations suffice. Limits: noise that reaches
//! farther than the surface's detail, such as the drift of a whole map from frame to frame, stays.

use super::Size;
use super::depth_noise::DepthNoise;
use crate::numeric::conjugate_gradient::{Limits, System, Vectors, solve};
use crate::numeric::robust;

/// Reweighted rounds after the first one, which is plain least squares.
const REWEIGHTED: usize = 3;
/// Limits of each round; this error is about the square of the error of the heights.
const LIMITS: Limits = Limits { iterations: 60, error: 0.0, relative_error: 1e-6, decrease: 0.0 };

/// Removes the noise from a raster of heights, NaN where missing.
pub fn smooth(size: Size, noise: &DepthNoise, heights: &mut [f32]) {
    let mut plate = ThinPlate::new(size, heights);
    let measured: Vec<f32> = heights.iter().map(|height| if height.is_nan() { 0.0 } else { *height }).collect();
    let (mut z, mut residual) = (measured.clone(), vec![0.0; size.len()]);
    let (mut direction, mut product) = (vec![0.0; size.len()], vec![0.0; size.len()]);
    let lambda = noise.smoothing() as f32;
    for round in 0..=REWEIGHTED {
        plate.weigh(lambda, if round == 0 { f64::INFINITY } else { noise.crease() }, &z);
        plate.apply(&z, &mut residual);
        for (index, residual) in residual.iter_mut().enumerate() {
            *residual = if plate.known[index] { measured[index] - *residual } else { 0.0 };
        }
        let (solution, residual) = (&mut z[..], &mut residual[..]);
        solve(&mut plate, LIMITS, Vectors { solution, residual, direction: &mut direction, product: &mut product });
    }
    for (height, z) in heights.iter_mut().zip(z).filter(|(height, _)| !height.is_nan()) {
        *height = z;
    }
}

/// A second difference: four pixel offsets from its first pixel, and their factors.
struct Stencil {
    offsets: [usize; 4],
    factors: [f32; 4],
    /// Weight of the square. The twist counts twice in the energy of a thin plate.
    share: f32,
}

/// 1 + lambda D^T w D on the pixels with a height.
struct ThinPlate {
    known: Vec<bool>,
    stencils: [Stencil; 3],
    /// lambda w of each second difference, at its first pixel; zero where it does not exist.
    weights: [Vec<f32>; 3],
    diagonal: Vec<f32>,
}

impl ThinPlate {
    fn new(size: Size, heights: &[f32]) -> Self {
        let width = size.width;
        let line = |stride: usize| Stencil {
            offsets: [0, stride, 2 * stride, 2 * stride],
            factors: [1.0, -2.0, 1.0, 0.0],
            share: 1.0,
        };
        let twist = Stencil { offsets: [0, 1, width, width + 1], factors: [1.0, -1.0, -1.0, 1.0], share: 2.0 };
        let stencils = [line(1), line(width), twist];
        let known: Vec<bool> = heights.iter().map(|height| !height.is_nan()).collect();
        // One where the second difference exists, otherwise zero.
        let weights = [0, 1, 2].map(|kind: usize| {
            let (Stencil { offsets, .. }, [right, down]) = (&stencils[kind], [[2, 0], [0, 2], [1, 1]][kind]);
            let exists = |index: usize| {
                let (column, row) = size.position(index);
                let fits = column + right < size.width && row + down < size.height;
                fits && offsets.iter().all(|offset| known[index + offset])
            };
            (0..size.len()).map(|index| f32::from(u8::from(exists(index)))).collect()
        });
        Self { known, stencils, weights, diagonal: vec![0.0; size.len()] }
    }

    /// Weights of the second differences of `z` at this scale of rho, and the diagonal.
    fn weigh(&mut self, lambda: f32, scale: f64, z: &[f32]) {
        let inverse_square = (1.0 / (scale * scale)) as f32;
        for (diagonal, known) in self.diagonal.iter_mut().zip(&self.known) {
            *diagonal = f32::from(u8::from(*known));
        }
        for (Stencil { offsets, factors, share }, weights) in self.stencils.iter().zip(&mut self.weights) {
            for (index, weight) in weights.iter_mut().enumerate().filter(|(_, weight)| **weight > 0.0) {
                let difference: f32 = (0..4).map(|k| factors[k] * z[index + offsets[k]]).sum();
                let robust: f32 = robust::weight(difference * difference * inverse_square);
                // The weight is never zero, which would mark a missing second difference.
                *weight = (share * lambda * robust).max(f32::MIN_POSITIVE);
                for k in 0..4 {
                    self.diagonal[index + offsets[k]] += *weight * factors[k] * factors[k];
                }
            }
        }
    }
}

impl System for ThinPlate {
    fn apply(&mut self, direction: &[f32], product: &mut [f32]) {
        for ((product, direction), known) in product.iter_mut().zip(direction).zip(&self.known) {
            *product = if *known { *direction } else { 0.0 };
        }
        for (Stencil { offsets, factors, .. }, weights) in self.stencils.iter().zip(&self.weights) {
            for (index, weight) in weights.iter().enumerate().filter(|(_, weight)| **weight > 0.0) {
                let difference: f32 = (0..4).map(|k| factors[k] * direction[index + offsets[k]]).sum();
                let flux = weight * difference;
                for k in 0..4 {
                    product[index + offsets[k]] += flux * factors[k];
                }
            }
        }
    }

    fn precondition(&mut self, residual: &[f32], solution: &mut [f32]) {
        for ((solution, residual), diagonal) in solution.iter_mut().zip(residual).zip(&self.diagonal) {
            *solution = if *diagonal > 0.0 { residual / diagonal } else { 0.0 };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Smooths a roof with a staircase on it. The planes lose the steps, the ridge stays in place, and the hole stays a
    /// hole.
    #[test]
    fn steps_go_and_a_ridge_stays() {
        let size = Size { width: 64, height: 64 };
        let roof = |index: usize| {
            let (column, row) = size.position(index);
            0.7 * (column as f32 - 31.5).abs() + 0.11 * row as f32
        };
        let mut heights: Vec<f32> = (0..size.len()).map(|index| roof(index).round()).collect();
        heights[size.index(20, 20)] = f32::NAN;
        let rms = |heights: &[f32], counts: &dyn Fn(usize) -> bool| {
            let squares: Vec<f32> = (0..size.len())
                .filter(|&index| counts(index) && !heights[index].is_nan())
                .map(|index| (heights[index] - roof(index)).powi(2))
                .collect();
            (squares.iter().sum::<f32>() / squares.len() as f32).sqrt()
        };
        let ridge = |index: usize| (30..34).contains(&size.position(index).0);
        let before = rms(&heights, &|_| true);
        let noise = DepthNoise { sigma: 0.29, roughness: 0.1, is_white: false };
        smooth(size, &noise, &mut heights);
        assert!(rms(&heights, &|_| true) < 0.4 * before, "{before} {}", rms(&heights, &|_| true));
        assert!(rms(&heights, &ridge) < 0.29, "{}", rms(&heights, &ridge));
        assert!(heights[size.index(20, 20)].is_nan());
    }
}
