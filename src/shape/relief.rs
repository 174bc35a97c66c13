//! The image surface from shading as a whole: heights with integrability built in, from several starts.
//!
//! Under natural light three colours hardly tell one normal from another, but the normals of one surface are not free. The
//! heights of [`HeightSolver`] are solved at falling robust scales from several starts: the surface integrated
//! from the pixels' own normals, a flat one and a dome over the mask. Shading is ambiguous and not convex; of the
//! ends the one of least cost was the best one each time it was measured, so that one is taken. Each call tries one
//! start more, so that none lasts long, and goes on from the best surface so far. Limits: orthographic or pinhole alike, but parts of the mask that are not joined are solved on
//! their own, each at any level.

use nalgebra::Matrix3;

use crate::error::Result;
use crate::light::Light;
use crate::shape::{HeightProblem, HeightSolver};
use crate::view::{ColourView, Size};

/// Log residuals at which a pixel loses its say, one solve after the other.
const COLOUR_SCALES: [f32; 3] = [0.5, 0.2, 0.06];
/// Gauss-Newton steps of a start at each scale, and of a later call at the last scale.
const FIRST_STEPS: u32 = 15;
const LATER_STEPS: u32 = 5;

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

/// Calls after which all starts have been tried.
pub const STARTS: u32 = 3;

/// Solves one image again and again; owns all memory.
pub struct ReliefSolver {
    heights: HeightSolver,
    starts: [Vec<f32>; STARTS as usize],
    surface: Vec<f32>,
    /// Starts that were tried, and the least cost of their ends.
    tried: usize,
    least: f64,
}

impl ReliefSolver {
    /// A solver for one colour view.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Empty`] where the view's mask is empty.
    pub fn new(image: &ColourView) -> Result<Self> {
        let length = image.size.len();
        let dome = dome(image.size, &image.mask);
        Ok(Self {
            heights: HeightSolver::new(image.size, image.camera, &image.mask)?,
            starts: [vec![0.0; length], vec![0.0; length], dome],
            surface: vec![0.0; length],
            tried: 0,
            least: f64::INFINITY,
        })
    }

    /// Whether the next call starts from the integrated surface; later ones do not look at it.
    pub const fn wants_integrated(&self) -> bool {
        self.tried == 0
    }

    /// Heights (pixels, or f log Z) of the image surface; `integrated` is one of the starts. NaN off the mask.
    pub fn solve(&mut self, problem: ReliefProblem<'_>, integrated: &[f32], heights: &mut [f32]) {
        let identity = Matrix3::identity();
        let log = &problem.image.log;
        let height_problem = |colour_scale: f32, steps: u32| HeightProblem {
            log: [&log[0], &log[1], &log[2]],
            light: problem.light,
            rotation: &identity,
            slopes: problem.slopes,
            firmness: Some(problem.firmness),
            anchors: None,
            colour_scale,
            steps,
        };
        let last_scale = COLOUR_SCALES[COLOUR_SCALES.len() - 1];
        if self.tried > 0 {
            self.least = self.heights.solve(height_problem(last_scale, LATER_STEPS), &mut self.surface).cost;
        }
        if let Some(start) = self.starts.get_mut(self.tried) {
            if self.tried == 0 {
                for (start, &height) in start.iter_mut().zip(integrated) {
                    *start = if height.is_nan() { 0.0 } else { height };
                }
            }
            let mut cost = f64::INFINITY;
            for scale in COLOUR_SCALES {
                cost = self.heights.solve(height_problem(scale, FIRST_STEPS), start).cost;
            }
            if cost < self.least {
                self.least = cost;
                self.surface.copy_from_slice(start);
            }
            self.tried += 1;
        }
        for ((height, &surface), &inside) in heights.iter_mut().zip(&self.surface).zip(&problem.image.mask) {
            *height = if inside { surface } else { f32::NAN };
        }
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
