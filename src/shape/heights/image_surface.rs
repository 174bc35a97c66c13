//! The image surface from shading as a whole: heights with integrability built in, from several starts, coarse to fine.
//!
//! Under natural light three colours hardly tell one normal from another, but the normals of one surface are not free.
//! The heights of [`HeightSolver`] are solved at falling robust scales from several starts: the surface integrated from
//! the pixels' own normals, a flat one and a dome over the mask. Shading is ambiguous and not convex; of the ends the
//! one of least cost was the best one each time it was measured, so that one is taken. Each call tries one start more,
//! so that none lasts long, and goes on from the best surface so far.
//!
//! A large image is halved until a level is small: the starts compete there, and the best of them is carried up from
//! level to level, a few steps at each. Limits: orthographic or pinhole alike, but parts of the mask that are not
//! joined are solved on their own, each at any level; detail whose shading is ambiguous is decided where it is coarse.

use nalgebra::Matrix3;

use crate::error::Result;
use crate::light::Light;
use crate::shape::{Effort, HeightDomain, HeightProblem, HeightSolver};
use crate::view::{ColourView, Size};

/// Log residuals at which a pixel loses its say, one solve after the other.
const COLOUR_SCALES: [f32; 3] = [0.5, 0.2, 0.06];
const LAST_SCALE: f32 = COLOUR_SCALES[COLOUR_SCALES.len() - 1];
/// Work on a start at each scale.
const START: Effort = Effort { steps: 15, rounds: 40, tolerance: 0.03 };
/// Work on a surface that has come from elsewhere or from other starts.
const ARRIVED: Effort = Effort { steps: 5, rounds: 20, tolerance: 0.03 };
/// Work on one that every call improves a little: four rounds bring four fifths of what ten would, at any size, and the
/// next call linearises anew.
const SETTLING: Effort = Effort { steps: 1, rounds: 4, tolerance: 0.1 };
/// Object pixels up to which a level is small: an object that fills half of 96x96 is solved as it is.
const SMALL: usize = 6000;

/// What the surface has to explain.
#[derive(Clone, Copy)]
pub struct ReliefProblem<'a> {
    /// The colour view.
    pub image: &'a ColourView,
    /// The light, exposure included.
    pub light: &'a Light,
    /// Slopes of the pixels' own normals, pixels of height per pixel, NaN where unknown.
    pub slopes: [&'a [f32]; 2],
    /// Weight of each pixel's prior normal, squared log residual.
    pub firmness: &'a [f32],
}

impl<'a> ReliefProblem<'a> {
    fn heights(&self, rotation: &'a Matrix3<f64>, colour_scale: f32, effort: Effort) -> HeightProblem<'a> {
        HeightProblem {
            log: self.image.log.each_ref().map(Vec::as_slice),
            light: self.light,
            rotation,
            slopes: self.slopes,
            firmness: Some(self.firmness),
            anchors: None,
            colour_scale,
            effort,
        }
    }
}

/// Calls after which all starts have been tried.
pub const STARTS: u32 = 3;

/// Solves one image again and again. Owns what lasts from call to call; the solver is lent.
pub struct ReliefSolver {
    domain: HeightDomain,
    /// Of a large image; that of a small one is the contest's.
    surface: Vec<f32>,
    /// Halved again and again, the smallest last; empty for a small image.
    coarser: Vec<Level>,
    contest: Contest,
}

impl ReliefSolver {
    /// A solver for one colour view.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Empty`] where the view's mask is empty.
    pub fn new(image: &ColourView) -> Result<Self> {
        let mut coarser: Vec<Level> = Vec::new();
        loop {
            let finest = coarser.last().map_or(image, |level| &level.view.image);
            if finest.mask.iter().filter(|&&inside| inside).count() <= SMALL {
                break;
            }
            let level = Level::new(finest.halved())?;
            coarser.push(level);
        }
        let smallest = coarser.last().map_or(image, |level| &level.view.image);
        Ok(Self {
            contest: Contest::new(smallest.size, &smallest.mask),
            domain: HeightDomain::new(image.size, image.camera, &image.mask)?,
            surface: if coarser.is_empty() { Vec::new() } else { vec![0.0; image.size.len()] },
            coarser,
        })
    }

    /// Whether the next call starts from the integrated surface; later ones do not look at it.
    pub const fn wants_integrated(&self) -> bool {
        self.contest.tried == 0
    }

    /// The largest domain.
    pub const fn domain(&self) -> &HeightDomain {
        &self.domain
    }

    /// Heights (pixels, or f log Z) of the image surface, NaN off the mask. Where an integrated surface is
    /// [wanted](Self::wants_integrated), `heights` holds it: it is one of the starts.
    pub fn solve(&mut self, solver: &mut HeightSolver, problem: ReliefProblem<'_>, heights: &mut [f32]) {
        let surface = if self.coarser.is_empty() {
            self.contest.hold(solver, &mut self.domain, problem, heights);
            &self.contest.surface
        } else {
            let arrived = self.contest.is_open() && self.decide_coarse(solver, problem, heights);
            let effort = if arrived { ARRIVED } else { SETTLING };
            let identity = Matrix3::identity();
            let problem = problem.heights(&identity, LAST_SCALE, effort);
            solver.solve(&mut self.domain, problem, &mut self.surface);
            &self.surface
        };
        for ((height, &surface), &inside) in heights.iter_mut().zip(surface).zip(&problem.image.mask) {
            *height = if inside { surface } else { f32::NAN };
        }
    }

    /// The next start at the smallest level; if it is the best so far, its surface goes up. Whether it did.
    fn decide_coarse(&mut self, solver: &mut HeightSolver, problem: ReliefProblem<'_>, integrated: &[f32]) -> bool {
        let wants_integrated = self.wants_integrated();
        for index in 0..self.coarser.len() {
            let (finer, level) = self.coarser.split_at_mut(index);
            let (finer, surface) = match finer.last() {
                None => (problem, integrated),
                Some(finer) => (finer.view.problem(problem.light), &finer.surface[..]),
            };
            level[0].view.load(finer);
            if wants_integrated {
                level[0].carry_down(surface, finer.image.size);
            }
        }
        let Some((smallest, between)) = self.coarser.split_last_mut() else { return false };
        let Level { view, domain, surface } = smallest;
        if !self.contest.hold(solver, domain, view.problem(problem.light), surface) {
            return false;
        }
        surface.copy_from_slice(&self.contest.surface);
        let mut below = &*smallest;
        for level in between.iter_mut().rev() {
            carry_up(&below.surface, &level.view.image, &mut level.surface);
            level.improve(solver, problem.light);
            below = level;
        }
        carry_up(&below.surface, problem.image, &mut self.surface);
        true
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
        Ok(Self { view: HalvedProblem { slopes: [zeros(), zeros()], firmness: zeros(), image }, domain, surface })
    }

    /// Takes over the surface of the next finer level, which has `size`.
    fn carry_down(&mut self, surface: &[f32], size: Size) {
        size.halve(surface, &mut self.surface);
        self.surface.iter_mut().for_each(|height| *height *= 0.5);
    }

    fn improve(&mut self, solver: &mut HeightSolver, light: &Light) {
        let problem = self.view.problem(light);
        let identity = Matrix3::identity();
        let problem = problem.heights(&identity, LAST_SCALE, ARRIVED);
        solver.solve(&mut self.domain, problem, &mut self.surface);
    }
}

/// What a surface of half the resolution has to explain.
struct HalvedProblem {
    image: ColourView,
    slopes: [Vec<f32>; 2],
    firmness: Vec<f32>,
}

impl HalvedProblem {
    fn load(&mut self, finer: ReliefProblem<'_>) {
        let size = finer.image.size;
        for (coarse, fine) in self.slopes.iter_mut().zip(finer.slopes) {
            size.halve(fine, coarse);
        }
        size.halve(finer.firmness, &mut self.firmness);
    }

    fn problem<'a>(&'a self, light: &'a Light) -> ReliefProblem<'a> {
        let [p, q] = &self.slopes;
        ReliefProblem { image: &self.image, light, slopes: [p, q], firmness: &self.firmness }
    }
}

/// A surface of half the resolution over the pixels of `image`, zero off its mask.
fn carry_up(coarse: &[f32], image: &ColourView, fine: &mut [f32]) {
    image.size.double(coarse, fine);
    for (height, &inside) in fine.iter_mut().zip(&image.mask) {
        *height = if inside { 2.0 * *height } else { 0.0 };
    }
}

/// The starts of one level and the best of their ends.
struct Contest {
    starts: [Vec<f32>; STARTS as usize],
    surface: Vec<f32>,
    /// Starts that were tried, and the least cost of their ends.
    tried: usize,
    least: f64,
}

impl Contest {
    fn new(size: Size, mask: &[bool]) -> Self {
        let zeros = || vec![0.0; size.len()];
        Self { starts: [zeros(), zeros(), dome(size, mask)], surface: zeros(), tried: 0, least: f64::INFINITY }
    }

    const fn is_open(&self) -> bool {
        self.tried < STARTS as usize
    }

    /// Improves the best surface so far and tries the next start, the first of which is `integrated`; whether the
    /// surface is now another.
    fn hold(
        &mut self,
        solver: &mut HeightSolver,
        domain: &mut HeightDomain,
        problem: ReliefProblem<'_>,
        integrated: &[f32],
    ) -> bool {
        let identity = Matrix3::identity();
        if self.tried > 0 {
            let effort = if self.is_open() { ARRIVED } else { SETTLING };
            self.least = solver.solve(domain, problem.heights(&identity, LAST_SCALE, effort), &mut self.surface).cost;
        }
        let Some(start) = self.starts.get_mut(self.tried) else { return false };
        if self.tried == 0 {
            for (start, &height) in start.iter_mut().zip(integrated) {
                *start = if height.is_nan() { 0.0 } else { height };
            }
        }
        self.tried += 1;
        let mut cost = f64::INFINITY;
        for scale in COLOUR_SCALES {
            cost = solver.solve(domain, problem.heights(&identity, scale, START), start).cost;
        }
        let is_best = cost < self.least;
        if is_best {
            self.least = cost;
            self.surface.copy_from_slice(start);
        }
        is_best
    }
}

/// A dome over the mask: elliptic across the narrowest way to the border, as high as that way is long.
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
