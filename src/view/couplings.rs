//! The quadratic objective of a segmentation: each pixel's own evidence, and links between neighbours of similar
//! colour.

use crate::numeric::conjugate_gradient::System;
use crate::view::Size;

/// Distance in pixels over which neighbours of equal colour share their evidence. It is the width of the details that a
/// mask keeps.
pub const REACH: f32 = 5.0;
/// Weight of a mark relative to that of a colour, so large that a marked pixel keeps its mark.
pub const MARKED: f32 = 1e4;

/// The matrix of the quadratic sum.
pub struct Couplings {
    size: Size,
    /// Weights of each pixel's links to the right and downwards; 0 at the border.
    links: [Vec<f32>; 2],
    /// Weight of each pixel's own evidence.
    own: Vec<f32>,
    diagonal: Vec<f32>,
}

impl Couplings {
    pub fn new(size: Size, colours: &[[f32; 3]]) -> Self {
        let square = |a: usize, b: usize| (0..3).map(|k| (colours[a][k] - colours[b][k]).powi(2)).sum::<f32>();
        let ahead = |index: usize| {
            let (column, row) = size.position(index);
            [(column + 1 < size.width).then(|| index + 1), (row + 1 < size.height).then(|| index + size.width)]
        };
        let (mut sum, mut count) = (0.0, 0_usize);
        for (index, next) in (0..size.len()).flat_map(|index| ahead(index).map(|next| (index, next))) {
            if let Some(next) = next {
                sum += f64::from(square(index, next));
                count += 1;
            }
        }
        // A picture of one colour has no differences, so all its links have the weight one.
        let mean = (sum / count.max(1) as f64).max(f64::from(f32::MIN_POSITIVE)) as f32;
        let link = |axis: usize| {
            (0..size.len())
                .map(|index| ahead(index)[axis].map_or(0.0, |next| (-square(index, next) / (2.0 * mean)).exp()))
                .collect()
        };
        Self { size, links: [link(0), link(1)], own: vec![0.0; size.len()], diagonal: vec![0.0; size.len()] }
    }

    /// Sets the weight of each pixel's own evidence: a pixel whose mark is certain keeps it.
    pub fn weigh(&mut self, is_certain: impl Fn(usize) -> bool) {
        let [right, down] = &self.links;
        for index in 0..self.size.len() {
            self.own[index] = if is_certain(index) { MARKED } else { 1.0 } / (REACH * REACH);
            let left = index.checked_sub(1).map_or(0.0, |near| right[near]);
            let up = index.checked_sub(self.size.width).map_or(0.0, |near| down[near]);
            self.diagonal[index] = self.own[index] + left + up + right[index] + down[index];
        }
    }
}

impl System for Couplings {
    fn apply(&mut self, direction: &[f32], product: &mut [f32]) {
        for ((product, diagonal), direction) in product.iter_mut().zip(&self.diagonal).zip(direction) {
            *product = diagonal * direction;
        }
        for (links, stride) in self.links.iter().zip([1, self.size.width]) {
            for index in 0..direction.len().saturating_sub(stride) {
                let next = index + stride;
                product[index] -= links[index] * direction[next];
                product[next] -= links[index] * direction[index];
            }
        }
    }

    fn precondition(&mut self, residual: &[f32], solution: &mut [f32]) {
        for ((solution, residual), diagonal) in solution.iter_mut().zip(residual).zip(&self.diagonal) {
            *solution = residual / diagonal;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::conjugate_gradient::{Limits, Vectors, solve};
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// The share x of a one-dimensional picture without differences falls off as exp(-distance / REACH).
    #[test]
    fn evidence_reaches_as_far_as_its_constant_says() {
        let size = Size { width: 101, height: 1 };
        let mut couplings = Couplings::new(size, &[[50.0; 3]; 101]);
        couplings.weigh(|index| index == 50);
        let mut residual = [0.0; 101];
        residual[50] = MARKED / (REACH * REACH);
        let (mut shares, mut direction, mut product) = ([0.0; 101], [0.0; 101], [0.0; 101]);
        let limits = Limits { iterations: 1000, error: 0.0, relative_error: 1e-12, decrease: 0.0 };
        let vectors = Vectors {
            solution: &mut shares,
            residual: &mut residual,
            direction: &mut direction,
            product: &mut product,
        };
        solve(&mut couplings, limits, vectors);
        // The shares satisfy x_(k-1) - (2 + 1 / REACH^2) x_k + x_(k+1) = 0.
        let half = 0.5 / (REACH * REACH);
        let ratio = 1.0 + half - (half * (2.0 + half)).sqrt();
        for step in 0..12 {
            let found = shares[51 + step] / shares[50 + step];
            assert!((found - ratio).abs() < 1e-3, "{step}: {found} {ratio}");
        }
    }
}
