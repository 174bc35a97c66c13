//! The stages of the image's shape: normals of its pixels (Eq. 6 to 9), then the surface.

use crate::error::Result;
use crate::estimator::pair::Pair;
use crate::estimator::solution::{ExposedLight, Shape};
use crate::light::Light;
use crate::options::Shading;
use crate::shape::{
    HeightDomain, IntegrationOptions, Integrator, ReliefProblem, ReliefSolver, Robust, ShadingProblem, ShadingSolver,
    Workbench, exposure_step, gradients,
};
use crate::view::{Normals, normals};

use super::light::Inputs;

/// Least weight of the surface's own normals: the surface says more than a pixel's colours under natural light.
/// Measured on Mozart under the lights A, B, C without a depth view: 0.1 is better than 0.05 in five cases of six, 0.03
/// in none.
const LEAST_SURFACE_PRIOR: f64 = 0.1;
/// Solves of normals and exposure in the first iteration, which starts from a look at the colours alone.
const FIRST_EXPOSURE_ROUNDS: usize = 4;

/// Finds the normals and the surface of the image.
pub struct ShapeStage {
    pixels: ShadingSolver,
    /// Made when it is first needed; a surface that is solved as a whole needs it once.
    integrator: Option<Integrator>,
    /// Only where the image surface is solved as a whole.
    surface: Option<ReliefSolver>,
}

impl ShapeStage {
    /// Memory for the surface that the options ask for.
    pub fn new(pair: &Pair) -> Result<Self> {
        let surface = match pair.options.shading {
            Shading::Surface => Some(ReliefSolver::new(&pair.image)?),
            Shading::Pixel => None,
        };
        Ok(Self { pixels: ShadingSolver::new(), integrator: None, surface })
    }

    /// Where the heights of the image are unknown, if they are solved as a whole.
    pub fn domain(&self) -> Option<&HeightDomain> {
        self.surface.as_ref().map(ReliefSolver::domain)
    }

    /// Normals of the image (Eq. 6 to 9), and the exposure of a known light where `exposure_is_free`.
    pub fn find_normals(
        &mut self,
        Inputs { pair, fitted, .. }: Inputs<'_>,
        exposure_is_free: bool,
        light: &mut ExposedLight,
        normals: &mut Normals,
    ) {
        let weights = fitted.weights(pair, pair.options.weights.prior);
        let problem = ShadingProblem { log: pair.log(), prior: fitted.depth_normals(), light: &light.total() };
        self.pixels.solve(problem, weights, normals);
        if exposure_is_free {
            let moved = fitted.exposure_change(light.exposure);
            light.exposure += exposure_step(problem, weights, normals, moved);
        }
    }

    /// Heights of the image from its normals and colours, as depth; the normals become those of the surface where it is
    /// solved as a whole. The gauge of the depth is left to the caller.
    pub fn find_surface(
        &mut self,
        inputs: Inputs<'_>,
        light: &Light,
        scratch: &mut Workbench,
        shape: &mut Shape,
    ) -> Result<()> {
        let pair = inputs.pair;
        find_slopes(pair, &shape.normals, scratch);
        if self.surface.as_ref().is_none_or(ReliefSolver::wants_integrated) {
            self.integrate(pair, scratch, &mut shape.points.z)?;
        }
        self.solve_heights(inputs, light, scratch, &mut shape.points.z);
        if let Some(focal_length) = pair.image.camera.focal_length() {
            let depth_of = |height: f32| (f64::from(height) / focal_length).exp() as f32;
            shape.points.z.iter_mut().for_each(|height| *height = depth_of(*height));
        }
        if self.surface.is_some() {
            self.sharpen_normals(inputs, light, scratch, shape);
        }
        Ok(())
    }

    /// The surface that has the slopes of the scratch, in heights.
    fn integrate(&mut self, pair: &Pair, scratch: &Workbench, heights: &mut [f32]) -> Result<()> {
        let mut integrator = match self.integrator.take() {
            Some(integrator) => integrator,
            None => Integrator::new(pair.image.size, &pair.image.mask)?,
        };
        let options = IntegrationOptions { robust: Robust::Estimated, ..IntegrationOptions::default() };
        let [p, q] = &scratch.slopes;
        integrator.integrate(p, q, None, &options, heights)?;
        // A surface that is solved as a whole starts from it once.
        self.integrator = self.surface.is_none().then_some(integrator);
        Ok(())
    }

    /// Heights of the image surface as a whole, at first from the integrated one.
    fn solve_heights(
        &mut self,
        Inputs { pair, fitted, .. }: Inputs<'_>,
        light: &Light,
        scratch: &mut Workbench,
        heights: &mut [f32],
    ) {
        let Some(surface) = &mut self.surface else { return };
        let prior = fitted.weights(pair, pair.options.weights.prior).prior;
        let Workbench { slopes: [p, q], weight: firmness, heights: solver, .. } = scratch;
        for (pixel, firmness) in firmness.iter_mut().enumerate() {
            *firmness = if fitted.depth_normals().is_valid(pixel) { prior } else { 0.0 };
        }
        let problem = ReliefProblem { image: &pair.image, light, slopes: [p, q], firmness };
        surface.solve(solver, problem, heights);
    }

    /// Normals of the pixels once more, each drawn to the depth view's normal, where that has a say, or else to that of
    /// the surface: differences of heights lack the detail of a pixel, which its colours have.
    fn sharpen_normals(
        &mut self,
        Inputs { pair, fitted, .. }: Inputs<'_>,
        light: &Light,
        scratch: &mut Workbench,
        shape: &mut Shape,
    ) {
        let Pair { image, options, .. } = pair;
        let depth_counts = options.weights.prior > 0.0;
        let weights = fitted.weights(pair, options.weights.prior.max(LEAST_SURFACE_PRIOR));
        for band in Workbench::bands(image.size) {
            scratch.fit_band(&band);
            let Workbench { prior, found, .. } = &mut *scratch;
            let first = band.start / image.size.width;
            normals::of_depth_rows(image.size, image.camera, &shape.points.z, first, prior);
            for (place, pixel) in band.clone().enumerate() {
                if depth_counts && fitted.depth_normals().is_valid(pixel) {
                    prior.set(place, fitted.depth_normals().get(pixel));
                }
            }
            found.copy_range(0, &shape.normals, &band);
            let log = image.log.each_ref().map(|channel| &channel[band.clone()]);
            self.pixels.solve(ShadingProblem { log, prior, light }, weights, found);
            shape.normals.copy_range(band.start, found, &(0..band.len()));
        }
    }
}

/// How often normals and exposure are solved in turn.
pub const fn exposure_rounds(pair: &Pair, iteration: u32) -> usize {
    if pair.known_light().is_some() && iteration == 0 { FIRST_EXPOSURE_ROUNDS } else { 1 }
}

/// Slopes of the pixels' own normals, pixels of height per pixel.
fn find_slopes(pair: &Pair, normals: &Normals, scratch: &mut Workbench) {
    let image = &pair.image;
    scratch.fit(image.size.len());
    let [p, q] = &mut scratch.slopes;
    gradients(image.size, &image.camera, normals, &image.mask, p, q);
    // Pinhole gradients are of log Z: times f they are pixels of height per pixel, too.
    let focal_length = image.camera.focal_length().unwrap_or(1.0) as f32;
    p.iter_mut().chain(q.iter_mut()).for_each(|slope| *slope *= focal_length);
}
