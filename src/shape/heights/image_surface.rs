//! The image surface from shading as a whole: heights with integrability built in, from several starts, coarse to fine
//! (docs/method.md, section 7).
//!
//! Under natural light three colours hardly tell one normal from another, but the normals of one surface are not free.
//! The heights of [`HeightSolver`] are solved at falling robust scales from several starts: the surface integrated from
//! the pixels' own normals, a flat one and a dome over the mask. Shading is ambiguous and not convex; of the local
//! optima the one of least objective was the best one each time it was measured (Mozart at 64x64 under the lights A, B
//! and C), so that one is taken. Each call tries one start more, so that none lasts long, and goes on from the best
//! surface so far.
//!
//! A large image is halved until a level is small. There its shape is found as that of a small image is
//! (`image_shape`), and this surface goes up from level to level, a few steps at each. Limits: orthographic or pinhole
//! alike, but parts of the mask that are not joined are solved on their own, each at any level; detail whose shading is
//! ambiguous is decided where it is coarse.

use super::domain::HeightDomain;
use super::problem::LAST_SCALE;
use super::solver::HeightSolver;
use super::starts::{EVERY_CALL, INTERMEDIATE, ImageSurfaceProblem, MultiStart};
use crate::error::Result;
use crate::light::Light;
use crate::view::ColourView;

/// Object pixels up to which all starts are tried at full resolution: an object that fills half of 96x96 is solved as
/// it is.
const MOST_PIXELS: usize = 6000;

/// Object pixels up to which the finest level gets as much work as those between when a surface arrives there: on half of
/// 640x480 five steps take 0.15 to 0.4 s, for 0.1 degrees of the normals that the depth view does not reach.
const MOST_INTERMEDIATE: usize = 1 << 16;

/// Solves one image again and again. Owns what lasts from call to call; the memory of a solve is the caller's.
pub struct ImageSurfaceSolver {
    domain: HeightDomain,
    /// Where the starts compete: of a small image.
    starts: Option<MultiStart>,
    /// Of a large image its heights, and those of the smallest level where they are not yet worked on.
    surface: Vec<f32>,
    smallest: Option<Vec<f32>>,
    /// The levels between a large image and its smallest one.
    between: Vec<Level>,
}

impl ImageSurfaceSolver {
    /// A solver for one colour view; with a large one comes its smallest level, from whose surface it
    /// [starts](Self::start_from).
    ///
    /// # Errors
    /// [`crate::ErrorKind::Empty`] where the view's mask is empty.
    pub fn new(image: &ColourView) -> Result<(Self, Option<ColourView>)> {
        let mut between = Vec::new();
        let mut smallest: Option<ColourView> = None;
        loop {
            let finest = smallest.as_ref().unwrap_or(image);
            if finest.mask.iter().filter(|&&inside| inside).count() <= MOST_PIXELS {
                break;
            }
            let halved = finest.halved();
            if let Some(view) = smallest.replace(halved) {
                between.push(Level::new(view)?);
            }
        }
        let is_large = smallest.is_some();
        let solver = Self {
            starts: (!is_large).then(|| MultiStart::new(image.size, &image.mask)),
            domain: HeightDomain::new(image.size, image.camera, &image.mask)?,
            surface: if is_large { vec![0.0; image.size.len()] } else { Vec::new() },
            smallest: None,
            between,
        };
        Ok((solver, smallest))
    }

    /// The largest domain.
    pub const fn domain(&self) -> &HeightDomain {
        &self.domain
    }

    /// Goes on from the heights of the smallest level, NaN off its mask; the same over the pixels of `image`, zero off
    /// its mask.
    pub fn start_from(&mut self, smallest: Vec<f32>, image: &ColourView) -> &[f32] {
        let mut below = &smallest;
        for Level { view, surface, .. } in self.between.iter_mut().rev() {
            upsample(below, &view.image, surface);
            below = surface;
        }
        upsample(below, image, &mut self.surface);
        self.smallest = Some(smallest);
        &self.surface
    }

    /// Heights (pixels, or f log Z) of the image surface, NaN off the mask.
    ///
    /// # Errors
    /// Those of the integration, from whose surface the first call starts.
    pub fn solve(
        &mut self,
        solver: &mut HeightSolver,
        problem: ImageSurfaceProblem<'_>,
        heights: &mut [f32],
    ) -> Result<()> {
        let surface = if let Some(starts) = &mut self.starts {
            if starts.needs_integrated() {
                problem.integrate(heights)?;
            }
            starts.advance(solver, &mut self.domain, problem, heights);
            starts.surface()
        } else {
            let mut effort = EVERY_CALL;
            if let Some(smallest) = self.smallest.take() {
                self.climb(solver, problem, &smallest);
                // What reaches far is settled below; what is fine is settled by the calls that follow.
                effort = if self.domain.pixels > MOST_INTERMEDIATE { EVERY_CALL } else { INTERMEDIATE };
            }
            problem.improve(solver, &mut self.domain, (LAST_SCALE, effort), &mut self.surface);
            &self.surface
        };
        for ((height, &surface), &inside) in heights.iter_mut().zip(surface).zip(&problem.image.mask) {
            *height = if inside { surface } else { f32::NAN };
        }
        Ok(())
    }

    /// Goes up from the smallest level.
    fn climb(&mut self, solver: &mut HeightSolver, problem: ImageSurfaceProblem<'_>, smallest: &[f32]) {
        for index in 0..self.between.len() {
            let (finer, level) = self.between.split_at_mut(index);
            level[0].view.load(finer.last().map_or(problem, |finer| finer.view.problem(problem.light)));
        }
        let mut below = smallest;
        for level in self.between.iter_mut().rev() {
            upsample(below, &level.view.image, &mut level.surface);
            level.improve(solver, problem.light);
            below = &level.surface;
        }
        upsample(below, problem.image, &mut self.surface);
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

/// What a surface of half the resolution has to explain.
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

/// A surface of half the resolution over the pixels of `image`, zero off its mask.
fn upsample(coarse: &[f32], image: &ColourView, fine: &mut [f32]) {
    image.size.double(coarse, fine);
    for (height, &inside) in fine.iter_mut().zip(&image.mask) {
        *height = if inside { 2.0 * *height } else { 0.0 };
    }
}
