//! Shading that a light predicts at the samples, and its gradient in the image.
//!
//! The gradient of the image contains shadows and albedo, which shading does not explain, and so does the residual.
//! Their product has a nonzero mean, which biases the pose. The gradient of the prediction contains neither. As an
//! instrument (the Z of sum w Z^T r = 0, as in the last rounds of photometric registration) it lets only the explained
//! part of the image determine the pose.
//!
//! Limits: the gradient is computed with the fitted light, so it is valid only near the right pose.

use super::equations::{Lights, SHADES};
use super::problem::ContrastProblem;
use super::samples::Samples;
use crate::pose::similarity::Similarity;

/// Smallest area, in the image, of the square between neighbouring samples, relative to that in the depth view. At a
/// more grazing angle the gradient of the surface carries no information.
const LEAST_AREA: f32 = 0.1;

const CHANNELS: usize = 3;

/// Image position of a sample, and its shade in each channel.
type Seen = [f32; 2 + CHANNELS];

/// The prediction on a grid of samples; owns its memory.
pub(super) struct Prediction {
    /// NaN where no sample is visible.
    seen: Vec<Seen>,
    gradients: Vec<[[f32; 2]; CHANNELS]>,
}

impl Prediction {
    /// Allocates memory for a grid of `length` pixels.
    pub fn new(length: usize) -> Self {
        Self { seen: vec![[f32::NAN; 2 + CHANNELS]; length], gradients: vec![[[0.0; 2]; CHANNELS]; length] }
    }

    /// Derivatives of a grid pixel's shades by image column and row; zero where the neighbours do not determine them.
    pub fn gradient(&self, cell: usize) -> [[f64; 2]; CHANNELS] {
        self.gradients[cell].map(|gradient| gradient.map(f64::from))
    }

    /// Predicts the shading of a pose and light; `shades` are the harmonics of each grid pixel.
    pub fn predict(
        &mut self,
        problem: &ContrastProblem<'_>,
        samples: &Samples,
        visible: &[bool],
        shades: &[[f32; SHADES]],
        (pose, light): (&Similarity, &Lights),
    ) {
        self.seen.fill([f32::NAN; 2 + CHANNELS]);
        for (sample, _) in samples.list.iter().zip(visible).filter(|(_, visible)| **visible) {
            let Some([column, row]) = problem.place(pose, &sample.point) else { continue };
            let shade = |light: &nalgebra::SVector<f64, SHADES>| {
                shades[sample.cell].iter().zip(light).map(|(shade, l)| f64::from(*shade) * l).sum::<f64>() as f32
            };
            let [red, green, blue] = light.each_ref().map(shade);
            self.seen[sample.cell] = [column as f32, row as f32, red, green, blue];
        }
        for cell in 0..self.seen.len() {
            self.gradients[cell] = self.gradient_at(samples, cell).unwrap_or_default();
        }
    }

    fn gradient_at(&self, samples: &Samples, cell: usize) -> Option<[[f32; 2]; CHANNELS]> {
        let (column, row) = samples.grid.position(cell);
        let width = samples.grid.width;
        let across = self.difference(cell, column > 0, column + 1 < width, 1)?;
        let down = self.difference(cell, row > 0, row + 1 < samples.grid.height, width)?;
        // `across` and `down` are differences of position and shade per grid step; the chain rule yields the
        // derivatives by position.
        let area = across[0] * down[1] - across[1] * down[0];
        let enough = area.abs() >= LEAST_AREA * (samples.stride * samples.stride) as f32;
        enough.then(|| {
            std::array::from_fn(|channel| {
                let [here, there] = [across[2 + channel], down[2 + channel]];
                [(here * down[1] - there * across[1]) / area, (there * across[0] - here * down[0]) / area]
            })
        })
    }

    /// Central difference per grid step, or a one-sided one if only one neighbour is visible.
    fn difference(&self, cell: usize, has_before: bool, has_after: bool, step: usize) -> Option<Seen> {
        let is_seen = |cell: &usize| !self.seen[*cell][0].is_nan();
        is_seen(&cell).then_some(())?;
        let before = has_before.then(|| cell - step).filter(is_seen);
        let after = has_after.then(|| cell + step).filter(is_seen);
        let share = match (before, after) {
            (Some(_), Some(_)) => 0.5,
            (None, None) => return None,
            _ => 1.0,
        };
        let [before, after] = [before, after].map(|other| &self.seen[other.unwrap_or(cell)]);
        Some(std::array::from_fn(|k| share * (after[k] - before[k])))
    }
}
