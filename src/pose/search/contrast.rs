//! Local contrast on the grid of the search, for varying albedo: H of both views, see
//! [`LocalMeans`](crate::pose::contrast::LocalMeans), and curvatures of the depth map beside the harmonics.
//!
//! Most of the variance of an image with varying albedo is coarse and does not follow from the shape. A wrong pose at
//! which nine harmonics happen to fit it scores higher than the right one. What is left by H is mostly shading of small
//! relief, and albedo that follows the curvature.

use crate::pose::contrast::LocalMeans;
use crate::pose::curvature::curvatures;
use crate::view::{Normals, Size};

use super::values::{RELIEF, Sums};

/// Sigma of the local means in cells. Set on pairs of a statue (docs/lab/thresholds.md).
const MEANS: f64 = 2.0;

/// The regressors of each depth pixel.
pub fn relief(size: Size, normals: &Normals) -> Vec<[f32; RELIEF]> {
    let [fine, coarse] = curvatures(size, normals);
    fine.into_iter().zip(coarse).map(|(fine, coarse)| [fine, coarse, coarse * coarse]).collect()
}

/// H on the grid; owns its memory.
pub struct GridContrast {
    means: LocalMeans,
    weights: Vec<f32>,
}

impl GridContrast {
    pub fn new(side: usize) -> Self {
        let cells = side * side;
        Self { means: LocalMeans::new(side, cells, MEANS), weights: vec![0.0; cells] }
    }

    /// Applies H to the sums of every cell of a template, which are weighted by the first one. Allocates nothing.
    pub fn apply_to_template(&mut self, sums: &mut [Sums], cells: &[u32]) {
        self.weights.fill(0.0);
        for &cell in cells {
            let (weight, sums) = (&mut self.weights[cell as usize], &mut sums[cell as usize]);
            *weight = sums[0];
            sums.iter_mut().for_each(|sum| *sum /= *weight);
        }
        self.means.weigh(&self.weights);
        self.means.remove(sums);
        for &cell in cells {
            let (weight, sums) = (self.weights[cell as usize], &mut sums[cell as usize]);
            sums.iter_mut().for_each(|sum| *sum *= weight);
            sums[0] = weight;
        }
    }

    /// Applies H to the colours of an image, weighted by its mask.
    pub fn apply_to_image(&mut self, mask: &[f32], colour: &mut [Vec<f32>; 3]) {
        self.means.weigh(mask);
        let mut colours: Vec<[f32; 3]> =
            (0..mask.len()).map(|cell| [0, 1, 2].map(|k: usize| colour[k][cell])).collect();
        self.means.remove(&mut colours);
        for (cell, values) in colours.into_iter().enumerate() {
            (0..3).for_each(|k| colour[k][cell] = values[k]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::values::PADDED;
    use super::*;

    const SIDE: usize = 32;

    /// A square of cells, away from the border of the grid.
    fn square() -> Vec<u32> {
        (0..SIDE * SIDE)
            .filter(|cell| [cell % SIDE, cell / SIDE].iter().all(|at| (6..26).contains(at)))
            .map(|cell| cell as u32)
            .collect()
    }

    #[test]
    fn constants_vanish_slow_changes_nearly_and_fast_ones_stay() {
        let cells = square();
        let mut sums = vec![[0.0; PADDED]; SIDE * SIDE];
        for &cell in &cells {
            let (column, row) = (cell as usize % SIDE, cell as usize / SIDE);
            let weight = 0.5 + 0.02 * column as f32;
            let fast = if (column + row) % 2 == 0 { 1.0 } else { -1.0 };
            let values = [1.0, 3.0, 0.1 * row as f32, fast];
            (0..4).for_each(|k| sums[cell as usize][k] = weight * values[k]);
        }
        let before = sums.clone();
        GridContrast::new(SIDE).apply_to_template(&mut sums, &cells);
        let middle = 16 * SIDE + 16;
        let [weight, constant, slow, fast, ..] = sums[middle].map(|sum| sum / before[middle][0]);
        assert_eq!(weight, 1.0);
        assert!(constant.abs() < 1e-5 && slow.abs() < 0.01 && fast.abs() > 0.9, "{constant} {slow} {fast}");
        assert_eq!(sums[0], [0.0; PADDED]);
    }

    #[test]
    fn local_means_of_both_views_are_the_same() {
        let cells = square();
        let (mut mask, mut sums) = (vec![0.0; SIDE * SIDE], vec![[0.0; PADDED]; SIDE * SIDE]);
        let mut colour = [(); 3].map(|()| vec![0.0; SIDE * SIDE]);
        for (k, cell) in cells.iter().map(|&cell| cell as usize).enumerate() {
            let value = (0.37 * k as f32).sin();
            mask[cell] = 0.8;
            colour[1][cell] = value;
            sums[cell][..2].copy_from_slice(&[0.8, 0.8 * value]);
        }
        let mut contrast = GridContrast::new(SIDE);
        contrast.apply_to_template(&mut sums, &cells);
        contrast.apply_to_image(&mask, &mut colour);
        for cell in cells.iter().map(|&cell| cell as usize) {
            assert!((sums[cell][1] / sums[cell][0] - colour[1][cell]).abs() < 1e-5);
        }
    }
}
