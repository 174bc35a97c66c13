//! The image surface from shading as a whole: integrable heights, from several starts, coarse to fine
//! (docs/method/heights.md).
//!
//! Under natural light, three colours hardly distinguish one normal from another, but the normals of a surface are not
//! independent. [`HeightSolver`] solves the heights at falling robust scales from several starts: the surface
//! integrated from the pixels' own normals, a flat one and a dome over the mask. Shading is ambiguous and not convex;
//! the local optimum with the lowest objective is taken, which was the best one on Mozart at 64x64 under the lights A,
//! B and C. Each call tries one more start, so that no call takes long, and continues from the best surface so far.
//!
//! A large image is halved until a level is small. The starts are tried at that level, and the best surface moves up
//! from level to level, with a few steps at each. The solver takes orthographic and pinhole views. Limits: unconnected
//! parts of the mask are solved independently, each at an arbitrary offset; detail with ambiguous shading is decided at
//! the coarsest level.

use super::domain::HeightDomain;
use super::problem::LAST_SCALE;
use super::solver::HeightSolver;
use super::starts::{EARLY_CALL, EVERY_CALL, INTERMEDIATE, ImageSurfaceProblem, MultiStart};
use crate::error::Result;
use crate::light::Light;
use crate::view::ColourView;

/// Largest number of object pixels at which all starts are tried at full resolution. An object that fills half of 96x96
/// is not halved.
const MOST_PIXELS: usize = 6000;

/// Solves one image repeatedly. Owns what persists between calls; the caller owns the memory of a solve.
pub struct ImageSurfaceSolver {
    domain: HeightDomain,
    /// Heights of a large image; those of a small one are in `starts`.
    surface: Vec<f32>,
    /// The image, halved repeatedly, the smallest last; empty for a small image.
    coarser: Vec<Level>,
    /// The starts, which compete at the smallest level.
    starts: MultiStart,
}

impl ImageSurfaceSolver {
    /// A solver for one colour view.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Empty`] if the view's mask is empty.
    pub fn new(image: &ColourView) -> Result<Self> {
        let mut coarser: Vec<Level> = Vec::new();
        loop {
            let finest = coarser.last().map_or(image, |level| &level.view.image);
            if finest.mask.iter().filter(|&&inside| inside).count() <= MOST_PIXELS {
                break;
            }
            let level = Level::new(finest.halved())?;
            coarser.push(level);
        }
        let smallest = coarser.last().map_or(image, |level| &level.view.image);
        Ok(Self {
            starts: MultiStart::new(smallest.size, &smallest.mask),
            domain: HeightDomain::new(image.size, image.camera, &image.mask)?,
            surface: if coarser.is_empty() { Vec::new() } else { vec![0.0; image.size.len()] },
            coarser,
        })
    }

    /// The largest domain.
    pub const fn domain(&self) -> &HeightDomain {
        &self.domain
    }

    /// `heights` (pixels, or f log Z) of the image surface, NaN off the mask.
    ///
    /// # Errors
    /// The errors of the integration, whose surface is one of the starts.
    pub fn solve(
        &mut self,
        solver: &mut HeightSolver,
        problem: ImageSurfaceProblem<'_>,
        heights: &mut [f32],
    ) -> Result<()> {
        let surface = if self.coarser.is_empty() {
            self.starts.advance(solver, &mut self.domain, problem)?;
            self.starts.surface()
        } else {
            let effort = match (self.starts.has_next(), self.solve_coarse(solver, problem)?) {
                (_, true) => INTERMEDIATE,
                (true, false) => EARLY_CALL,
                (false, false) => EVERY_CALL,
            };
            problem.improve(solver, &mut self.domain, (LAST_SCALE, effort), &mut self.surface);
            &self.surface
        };
        for ((height, &surface), &inside) in heights.iter_mut().zip(surface).zip(&problem.image.mask) {
            *height = if inside { surface } else { f32::NAN };
        }
        Ok(())
    }

    /// Tries the next start at the smallest level, if there is one. If it is the best so far, its surface moves up;
    /// returns whether it did.
    fn solve_coarse(&mut self, solver: &mut HeightSolver, problem: ImageSurfaceProblem<'_>) -> Result<bool> {
        if !self.starts.has_next() {
            return Ok(false);
        }
        self.load_coarser(problem);
        let Some((smallest, between)) = self.coarser.split_last_mut() else { return Ok(false) };
        let Level { view, domain, surface } = smallest;
        if !self.starts.advance(solver, domain, view.problem(problem.light))? {
            return Ok(false);
        }
        surface.copy_from_slice(self.starts.surface());
        let mut below = &*smallest;
        for level in between.iter_mut().rev() {
            upsample(&below.surface, &level.view.image, &mut level.surface);
            level.improve(solver, problem.light);
            below = level;
        }
        upsample(&below.surface, problem.image, &mut self.surface);
        Ok(true)
    }

    /// Halves the problem level by level.
    fn load_coarser(&mut self, problem: ImageSurfaceProblem<'_>) {
        for index in 0..self.coarser.len() {
            let (finer, level) = self.coarser.split_at_mut(index);
            let finer = finer.last().map_or(problem, |finer| finer.view.problem(problem.light));
            level[0].view.load(finer);
        }
    }
}

/// One halved image and its surface: heights in this level's pixels.
struct Level {
    view: HalvedProblem,
    domain: HeightDomain,
    surface: Vec<f32>,
}

impl Level {
    fn new(image: ColourView) -> Result<Self> {
        let zeros = || vec![0.0; image.size.len()];
        let domain = HeightDomain::new(image.size, image.camera, &image.mask)?;
        let surface = zeros();
        Ok(Self { view: HalvedProblem { slopes: [zeros(), zeros()], normal_weight: zeros(), image }, domain, surface })
    }

    fn improve(&mut self, solver: &mut HeightSolver, light: &Light) {
        self.view.problem(light).improve(solver, &mut self.domain, (LAST_SCALE, INTERMEDIATE), &mut self.surface);
    }
}

/// The data of a surface at half the resolution.
struct HalvedProblem {
    image: ColourView,
    slopes: [Vec<f32>; 2],
    normal_weight: Vec<f32>,
}

impl HalvedProblem {
    fn load(&mut self, finer: ImageSurfaceProblem<'_>) {
        let size = finer.image.size;
        for (coarse, fine) in self.slopes.iter_mut().zip(finer.slopes) {
            size.halve(fine, coarse);
        }
        size.halve(finer.normal_weight, &mut self.normal_weight);
    }

    fn problem<'a>(&'a self, light: &'a Light) -> ImageSurfaceProblem<'a> {
        let [p, q] = &self.slopes;
        ImageSurfaceProblem { image: &self.image, light, slopes: [p, q], normal_weight: &self.normal_weight }
    }
}

/// A surface of half the resolution, interpolated over the pixels of `image`; zero off its mask.
fn upsample(coarse: &[f32], image: &ColourView, fine: &mut [f32]) {
    image.size.double(coarse, fine);
    for (height, &inside) in fine.iter_mut().zip(&image.mask) {
        *height = if inside { 2.0 * *height } else { 0.0 };
    }
}
