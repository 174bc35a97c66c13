//! Several starts at one resolution, of which the local optimum with the lowest objective is kept
//! (docs/method/heights.md).

use nalgebra::Matrix3;

use super::domain::HeightDomain;
use super::problem::{Bending, COLOUR_SCALES, Effort, FAR_DAMPING, HeightProblem, LAST_SCALE};
use super::solver::HeightSolver;
use crate::error::Result;
use crate::light::Light;
use crate::shape::integration::{IntegrationOptions, Integrator};
use crate::view::{ColourView, Size};

/// Work on a start at each scale.
const FROM_START: Effort = Effort { steps: 15, iterations: 40, tolerance: 0.03, damping: FAR_DAMPING };
/// Work on a surface whose resolution has changed, or on the best surface while other starts are still to come.
pub const INTERMEDIATE: Effort = Effort { steps: 5, iterations: 20, tolerance: 0.03, damping: FAR_DAMPING };
/// Work on a large surface that stays the best while other starts are still to come. It is close to its optimum, so two
/// steps with little damping achieve as much as [`INTERMEDIATE`] in less time. With a single step, shapes would count
/// as settled too early.
pub const EARLY_CALL: Effort = Effort { steps: 2, iterations: 30, tolerance: 0.03, damping: 1e-3 };
/// Work on a surface that every call improves a little. The next call linearises again, so a few iterations achieve
/// most of the gain. Set by the gain per round at 64x64 to 640x480 (docs/lab/thresholds.md).
pub const EVERY_CALL: Effort = Effort { steps: 1, iterations: 4, tolerance: 0.1, damping: FAR_DAMPING };

/// A start has found another optimum if its objective is lower than the best one's by this share. Two ends in the same
/// optimum differ by about a tenth of this share, and adopting the second one would refine a large image again, level
/// by level.
const LEAST_GAIN: f64 = 0.01;
/// Number of calls after which all starts have been tried.
pub const STARTS: u32 = 3;

/// The data of the surface.
#[derive(Clone, Copy)]
pub struct ImageSurfaceProblem<'a> {
    /// The colour view.
    pub image: &'a ColourView,
    /// The light, with exposure.
    pub light: &'a Light,
    /// Slopes of the pixels' own normals, pixels of height per pixel, NaN where unknown.
    pub slopes: [&'a [f32]; 2],
    /// Weight of each pixel's prior normal, squared log residual.
    pub normal_weight: &'a [f32],
}

impl<'a> ImageSurfaceProblem<'a> {
    /// Improves the heights `z`; returns their objective.
    #[inline(never)]
    pub fn improve(
        &self,
        solver: &mut HeightSolver,
        domain: &mut HeightDomain,
        (colour_scale, effort): (f32, Effort),
        z: &mut [f32],
    ) -> f64 {
        let problem = HeightProblem {
            log: self.image.log.each_ref().map(Vec::as_slice),
            light: self.light,
            rotation: &Matrix3::identity(),
            slopes: self.slopes,
            normal_weight: Some(self.normal_weight),
            bending: Bending::FREE,
            anchors: None,
            colour_scale,
            effort,
        };
        solver.solve(domain, problem, z)
    }
}

/// The starts of one level and the best of their local optima.
pub struct MultiStart {
    /// The integrated surface, a flat one and a dome over the mask.
    starts: [Vec<f32>; STARTS as usize],
    surface: Vec<f32>,
    /// Number of starts tried, and the lowest objective of their optima.
    tried: usize,
    least: f64,
}

impl MultiStart {
    pub fn new(size: Size, mask: &[bool]) -> Self {
        let zeros = || vec![0.0; size.len()];
        Self { starts: [zeros(), zeros(), dome(size, mask)], surface: zeros(), tried: 0, least: f64::INFINITY }
    }

    /// The best surface so far.
    pub fn surface(&self) -> &[f32] {
        &self.surface
    }

    /// Whether any starts are left.
    pub const fn has_next(&self) -> bool {
        self.tried < STARTS as usize
    }

    /// Improves the best surface so far and tries the next start; returns whether the best surface has changed to that
    /// of the new start.
    ///
    /// # Errors
    /// The errors of the integration, which computes the first start.
    pub fn advance(
        &mut self,
        solver: &mut HeightSolver,
        domain: &mut HeightDomain,
        problem: ImageSurfaceProblem<'_>,
    ) -> Result<bool> {
        if self.tried > 0 {
            let effort = if self.has_next() { INTERMEDIATE } else { EVERY_CALL };
            self.least = problem.improve(solver, domain, (LAST_SCALE, effort), &mut self.surface);
        }
        let Some(start) = self.starts.get_mut(self.tried) else { return Ok(false) };
        if self.tried == 0 {
            let [p, q] = problem.slopes;
            let mut integrator = Integrator::new(problem.image.size, &problem.image.mask)?;
            integrator.integrate(p, q, None, &IntegrationOptions::ROBUST, start)?;
            start.iter_mut().filter(|height| height.is_nan()).for_each(|height| *height = 0.0);
        }
        self.tried += 1;
        let mut objective = f64::INFINITY;
        for scale in COLOUR_SCALES {
            objective = problem.improve(solver, domain, (scale, FROM_START), start);
        }
        let is_best = objective < (1.0 - LEAST_GAIN) * self.least;
        if is_best {
            self.least = objective;
            self.surface.copy_from_slice(start);
        }
        Ok(is_best)
    }
}

/// A dome over the mask. Its profile is a circle in the distance to the border, as high as the largest distance.
fn dome(size: Size, mask: &[bool]) -> Vec<f32> {
    let distance = distance_to_border(size, mask);
    let radius = distance.iter().copied().fold(0.0, f32::max);
    distance.iter().map(|&d| -(d * (2.0 * radius - d)).max(0.0).sqrt()).collect()
}

/// City-block distance of each pixel to the outside of the mask, in two sweeps.
fn distance_to_border(size: Size, mask: &[bool]) -> Vec<f32> {
    let mut distance: Vec<f32> = mask.iter().map(|&inside| if inside { f32::INFINITY } else { 0.0 }).collect();
    let mut sweep = |indices: &mut dyn Iterator<Item = usize>| {
        for index in indices {
            let (column, row) = size.position(index);
            let border = column == 0 || row == 0 || column + 1 == size.width || row + 1 == size.height;
            let nearest = size.neighbours(index).map(|neighbour| distance[neighbour]).fold(f32::INFINITY, f32::min);
            let nearest = if border { nearest.min(0.0) } else { nearest };
            distance[index] = distance[index].min(nearest + 1.0);
        }
    };
    sweep(&mut (0..size.len()));
    sweep(&mut (0..size.len()).rev());
    distance
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_dome_is_highest_in_the_middle_and_flat_outside() {
        let size = Size { width: 9, height: 9 };
        let mask: Vec<bool> = (0..81).map(|index| index / 9 > 1).collect();
        let dome = dome(size, &mask);
        // Seven rows and nine columns are inside; z points away from the camera.
        let highest = dome.iter().copied().fold(0.0, f32::min);
        assert_eq!((highest, dome[5 * 9 + 4]), (-4.0, -4.0));
        assert!(dome[..18].iter().all(|&z| z == 0.0) && dome[18..].iter().all(|&z| z < 0.0));
    }
}
