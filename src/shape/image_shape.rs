//! The shape of the colour view: normals of its pixels, a surface with these normals, and the normals once more, with
//! the surface as a prior (docs/method/normals.md and docs/method/heights.md).
//!
//! The surface is found by integration, as in the paper, or as a whole by heights from shading, for which the
//! integrated surface is one of several starts.

use super::heights::{HeightDomain, ImageSurfaceProblem, ImageSurfaceSolver, Scratch};
use super::integration::{IntegrationOptions, Integrator, find_slopes};
use super::pixels::{self, ShadingProblem, ShadingSolver, ShadingWeights};
use crate::error::Result;
use crate::light::Light;
use crate::view::{ColourView, Normals, normals};

/// Least weight of the surface's own normals as a prior, in units of lambda_2. Under natural light, the surface
/// determines more than a pixel's colours. Set on Mozart under the lights A, B, C without a depth view
/// (docs/lab/thresholds.md).
const LEAST_SURFACE_PRIOR: f64 = 0.1;

/// The data from which the shape of the colour view is found.
#[derive(Clone, Copy)]
pub struct ImageShapeProblem<'a> {
    /// The colour view.
    pub image: &'a ColourView,
    /// The light, with exposure.
    pub light: &'a Light,
    /// Normals of the depth view at the image pixels (R n_R of Eq. 9), NaN where no depth point falls.
    pub prior: &'a Normals,
    /// lambda_2 of Eq. 6.
    pub prior_weight: f64,
    /// lambda_3 of Eq. 6.
    pub unit_weight: f64,
    /// Variance of the colours' residuals relative to its usual value. Colours that even the light does not explain
    /// weigh less, so priors weigh more.
    pub variance_inflation: f64,
}

impl<'a> ImageShapeProblem<'a> {
    fn shading(&self) -> ShadingProblem<'a> {
        let [red, green, blue] = &self.image.log;
        ShadingProblem { log: [red, green, blue], prior: self.prior, light: self.light }
    }

    fn weights(&self, prior: f64) -> ShadingWeights {
        ShadingWeights::with_robust_prior((prior * self.variance_inflation) as f32, self.unit_weight as f32)
    }
}

/// Solves one image repeatedly. Owns what persists between calls; intermediate rasters belong to a [`Scratch`].
pub struct ImageShapeSolver {
    pixels: ShadingSolver,
    /// Created by the first integration.
    integrator: Option<Integrator>,
    /// The solver of the surface as a whole, if it is used.
    surface: Option<ImageSurfaceSolver>,
}

impl ImageShapeSolver {
    /// A solver that integrates the pixels' normals.
    pub fn by_integration() -> Self {
        Self { pixels: ShadingSolver::new(), integrator: None, surface: None }
    }

    /// A solver that finds the surface as a whole.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Empty`] if the view's mask is empty.
    pub fn as_a_whole(image: &ColourView) -> Result<Self> {
        Ok(Self { surface: Some(ImageSurfaceSolver::new(image)?), ..Self::by_integration() })
    }

    /// The largest domain of heights, for [`Scratch::new`].
    pub fn domain(&self) -> Option<&HeightDomain> {
        self.surface.as_ref().map(ImageSurfaceSolver::domain)
    }

    /// Normals of the pixels, each by itself (Eq. 6 to 9), starting from the current ones.
    pub fn solve_normals(&mut self, problem: &ImageShapeProblem<'_>, normals: &mut Normals) {
        self.pixels.solve(problem.shading(), problem.weights(problem.prior_weight), normals);
    }

    /// Change of the exposure after [`solve_normals`](Self::solve_normals); `moved` is its distance from the first
    /// exposure.
    pub fn exposure_step(problem: &ImageShapeProblem<'_>, normals: &Normals, moved: f64) -> f64 {
        pixels::exposure_step(problem.shading(), problem.weights(problem.prior_weight), normals, moved)
    }

    /// Computes `depth` of the surface, NaN off the mask, from the normals of the pixels. A surface that is solved as a
    /// whole improves these normals, too. The depth is determined up to a constant (orthographic) or a factor
    /// (pinhole).
    ///
    /// # Errors
    /// The errors of the integration.
    pub fn solve_surface(
        &mut self,
        scratch: &mut Scratch,
        problem: &ImageShapeProblem<'_>,
        normals: &mut Normals,
        depth: &mut [f32],
    ) -> Result<()> {
        let image = problem.image;
        scratch.resize(image.size.len());
        find_slopes(image.size, &image.camera, normals, &image.mask, &mut scratch.slopes);
        if self.surface.is_some() {
            self.solve_heights(scratch, problem, depth)?;
        } else {
            self.integrate(scratch, image, depth)?;
        }
        image.camera.depth_from_heights(depth);
        if self.surface.is_some() {
            self.solve_normals_again(scratch, problem, normals, depth);
        }
        Ok(())
    }

    /// Integrates the slopes in the scratch to heights.
    fn integrate(&mut self, scratch: &Scratch, image: &ColourView, heights: &mut [f32]) -> Result<()> {
        let integrator = match &mut self.integrator {
            Some(integrator) => integrator,
            none => none.insert(Integrator::new(image.size, &image.mask)?),
        };
        let [p, q] = &scratch.slopes;
        integrator.integrate(p, q, None, &IntegrationOptions::ROBUST, heights).map(|_| ())
    }

    /// Solves the heights as a whole.
    fn solve_heights(
        &mut self,
        scratch: &mut Scratch,
        problem: &ImageShapeProblem<'_>,
        heights: &mut [f32],
    ) -> Result<()> {
        let Some(surface) = &mut self.surface else { return Ok(()) };
        let prior = problem.weights(problem.prior_weight).prior;
        let Scratch { slopes: [p, q], weight: normal_weight, heights: solver, .. } = scratch;
        for (pixel, weight) in normal_weight.iter_mut().enumerate() {
            *weight = if problem.prior.is_valid(pixel) { prior } else { 0.0 };
        }
        let problem = ImageSurfaceProblem { image: problem.image, light: problem.light, slopes: [p, q], normal_weight };
        surface.solve(solver, problem, heights)
    }

    /// Normals of the pixels once more. Their prior is the depth view's normal if that has weight, or else that of the
    /// surface: differences of heights lack the detail of a pixel, which its colours have.
    fn solve_normals_again(
        &mut self,
        scratch: &mut Scratch,
        problem: &ImageShapeProblem<'_>,
        normals: &mut Normals,
        depth: &[f32],
    ) {
        let image = problem.image;
        let has_prior = |pixel: usize| problem.prior_weight > 0.0 && problem.prior.is_valid(pixel);
        let weights = problem.weights(problem.prior_weight.max(LEAST_SURFACE_PRIOR));
        for band in Scratch::bands(image.size) {
            scratch.resize_band(&band);
            let Scratch { prior, found, .. } = scratch;
            normals::of_depth_rows(image.size, image.camera, depth, band.start / image.size.width, prior);
            for (place, pixel) in band.clone().enumerate().filter(|&(_, pixel)| has_prior(pixel)) {
                prior.set(place, problem.prior.get(pixel));
            }
            found.copy_range(0, normals, &band);
            let log = image.log.each_ref().map(|channel| &channel[band.clone()]);
            self.pixels.solve(ShadingProblem { log, prior, light: problem.light }, weights, found);
            normals.copy_range(band.start, found, &(0..band.len()));
        }
    }
}
