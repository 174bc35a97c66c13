//! Log colours on the raster, and what a pose predicts for them: harmonics, their sensitivity to the normal, and the
//! derivative of the shade by the pose.

use super::equations::Lights;
use super::harmonics::{SHADES, by_tangents, harmonics};
use super::surface::Surface;
use crate::pose::contrast::{ContrastProblem, Samples, by_pose};
use crate::pose::increment::{Frame, UNKNOWNS};
use crate::pose::similarity::Similarity;
use crate::view::ColourView;

pub(super) const CHANNELS: usize = 3;
/// Depths of neighbours that differ by more than this many pixels belong to different surfaces.
const JUMP: f32 = 6.0;

/// Two neighbouring pixels of one surface, as indices of hits.
#[derive(Clone, Copy)]
pub(super) struct Pair {
    pub first: u32,
    pub second: u32,
    pub weight: f32,
}

/// The raster of one image.
pub(super) struct Field {
    /// Log colours of each raster pixel, and whether it has some.
    colours: Vec<[f32; CHANNELS]>,
    usable: Vec<bool>,
    pub surface: Surface,
    /// Of each hit: harmonics, their derivatives along two tangents, log colours in the present channels, the squared
    /// derivative of its shade by its normal, its shade, the derivatives of its residual by the pose.
    pub shades: Vec<[f32; SHADES]>,
    tangents: Vec<[[f32; SHADES]; 2]>,
    pub values: Vec<[f32; CHANNELS]>,
    pub sensitivity: Vec<[f32; CHANNELS]>,
    shaded: Vec<[f32; CHANNELS]>,
    pub derivatives: Vec<[[f32; UNKNOWNS]; CHANNELS]>,
    pub pairs: Vec<Pair>,
}

impl Field {
    /// The raster of an image whose dark end is lifted.
    pub fn new(lifted: &ColourView, surface: Surface) -> Self {
        let (size, step) = (surface.size, surface.step);
        let mut colours = vec![[0.0; CHANNELS]; size.len()];
        let mut usable = vec![false; size.len()];
        for cell in 0..size.len() {
            let (column, row) = size.position(cell);
            if let Some(mean) = mean(lifted, [column * step, row * step], step) {
                (colours[cell], usable[cell]) = (mean, true);
            }
        }
        let most = surface.hits.capacity();
        Self {
            colours,
            usable,
            surface,
            shades: Vec::with_capacity(most),
            tangents: Vec::with_capacity(most),
            values: Vec::with_capacity(most),
            sensitivity: Vec::with_capacity(most),
            shaded: Vec::with_capacity(most),
            derivatives: Vec::with_capacity(most),
            pairs: Vec::with_capacity(4 * most),
        }
    }

    /// Updates everything that does not depend on the light, for a pose.
    pub fn look(&mut self, problem: &ContrastProblem<'_>, samples: &Samples, pose: &Similarity) {
        self.surface.look(problem, samples, pose, &self.usable);
        let Self { surface, shades, tangents, values, colours, .. } = self;
        shades.clear();
        tangents.clear();
        values.clear();
        for hit in &surface.hits {
            shades.push(harmonics(hit.normal));
            tangents.push(by_tangents(hit.normal));
            values.push(colours[hit.cell as usize]);
        }
        self.sensitivity.clear();
        self.sensitivity.resize(self.surface.hits.len(), [0.0; CHANNELS]);
        self.join();
    }

    /// Finds the pairs: neighbours to the right, below and on both diagonals.
    fn join(&mut self) {
        self.pairs.clear();
        let Surface { size, hits, place, step, .. } = &self.surface;
        let jump = JUMP * *step as f32;
        for (first, hit) in hits.iter().enumerate() {
            let (column, row) = size.position(hit.cell as usize);
            for (right, down) in [(1_isize, 0), (0, 1), (1, 1), (-1, 1)] {
                let (c, r) = (column as isize + right, row + down);
                if c < 0 || c >= size.width as isize || r >= size.height {
                    continue;
                }
                let second = place[size.index(c as usize, r)];
                let Some(other) = hits.get(second as usize) else { continue };
                if (hit.depth - other.depth).abs() < jump {
                    let weight = hit.weight.min(other.weight);
                    self.pairs.push(Pair { first: first as u32, second, weight });
                }
            }
        }
    }

    /// Updates the squared sensitivity of each hit's shade to its normal.
    pub fn sense(&mut self, lights: &Lights) {
        for (sensitivity, tangents) in self.sensitivity.iter_mut().zip(&self.tangents) {
            for (sensitivity, light) in sensitivity.iter_mut().zip(lights) {
                *sensitivity = tangents
                    .iter()
                    .map(|row| row.iter().zip(light.iter()).map(|(d, l)| d * *l as f32).sum::<f32>().powi(2))
                    .sum();
            }
        }
    }

    /// Updates the derivatives of the residuals by the pose.
    pub fn derive(&mut self, problem: &ContrastProblem<'_>, frame: &Frame, lights: &Lights) {
        let Self { surface, shades, shaded, derivatives, .. } = self;
        shaded.clear();
        shaded.extend(shades.iter().map(|row| {
            std::array::from_fn(|channel| {
                row.iter().zip(lights[channel].iter()).map(|(b, l)| b * *l as f32).sum::<f32>()
            })
        }));
        derivatives.clear();
        for (index, hit) in surface.hits.iter().enumerate() {
            let [across, down] = gradient(surface, shaded, index);
            let rows = by_pose(problem, &hit.point(problem), frame).map(|(_, rows)| rows).unwrap_or_default();
            derivatives.push(std::array::from_fn(|channel| {
                std::array::from_fn(|k| across[channel] * rows[0][k] as f32 + down[channel] * rows[1][k] as f32)
            }));
        }
    }

    /// The first channel's shade at each raster pixel, after [`derive`](Self::derive).
    #[cfg(test)]
    pub fn shades_of_pixels(&self) -> Vec<Option<f32>> {
        let at = |place: &u32| self.shaded.get(*place as usize).map(|shade| shade[0]);
        self.surface.place.iter().map(at).collect()
    }
}

/// Derivatives of the shade of a hit by image column and row.
fn gradient(surface: &Surface, shaded: &[[f32; CHANNELS]], index: usize) -> [[f32; CHANNELS]; 2] {
    let hit = &surface.hits[index];
    let (column, row) = surface.size.position(hit.cell as usize);
    let step = surface.step as f32;
    let near = |inside: bool, cell: usize| {
        let other = inside.then(|| surface.place[cell]).and_then(|at| surface.hits.get(at as usize).map(|o| (at, o)));
        other.filter(|(_, other)| (other.depth - hit.depth).abs() < JUMP * step).map(|(at, _)| at as usize)
    };
    let cell = hit.cell as usize;
    let width = surface.size.width;
    let along = |before: Option<usize>, after: Option<usize>| {
        let share = match (before, after) {
            (Some(_), Some(_)) => 0.5 / step,
            (None, None) => 0.0,
            _ => 1.0 / step,
        };
        let [before, after] = [before, after].map(|other| &shaded[other.unwrap_or(index)]);
        std::array::from_fn(|channel| share * (after[channel] - before[channel]))
    };
    [
        along(near(column > 0, cell.wrapping_sub(1)), near(column + 1 < width, cell + 1)),
        along(near(row > 0, cell.wrapping_sub(width)), near(row + 1 < surface.size.height, cell + width)),
    ]
}

/// Mean of the log colours of a square of image pixels; `None` unless all have colours.
fn mean(image: &ColourView, [left, top]: [usize; 2], step: usize) -> Option<[f32; CHANNELS]> {
    let mut sum = [0.0; CHANNELS];
    for row in top..top + step {
        for column in left..left + step {
            if column >= image.size.width || row >= image.size.height {
                return None;
            }
            let index = image.size.index(column, row);
            if !image.mask[index] {
                return None;
            }
            for (sum, log) in sum.iter_mut().zip(image.log_at(index)) {
                *sum += log;
            }
        }
    }
    let count = (step * step) as f32;
    sum.iter().all(|value| value.is_finite()).then(|| sum.map(|value| value / count))
}
