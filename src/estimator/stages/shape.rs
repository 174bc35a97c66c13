//! The stages of the image's shape: normals of its pixels (Eq. 6 to 9), then the surface.

use crate::error::Result;
use crate::estimator::pair::ViewPair;
use crate::estimator::solution::{ExposedLight, Shape};
use crate::light::Light;
use crate::options::Shading;
use crate::shape::{HeightDomain, ImageShapeProblem, ImageShapeSolver, Scratch};
use crate::view::Normals;

use super::light::Inputs;

/// How often the first iteration solves for normals and exposure. Its exposure comes from the colours alone.
const FIRST_EXPOSURE_ROUNDS: usize = 4;

/// Finds the normals and the surface of the image.
pub struct ShapeStage(ImageShapeSolver);

impl ShapeStage {
    /// Allocates for the surface that the options require.
    pub fn new(pair: &ViewPair) -> Result<Self> {
        Ok(Self(match pair.options.shading {
            Shading::Surface => ImageShapeSolver::as_a_whole(&pair.image)?,
            Shading::Pixel => ImageShapeSolver::by_integration(),
        }))
    }

    /// Domain of the image's unknown heights, if they are solved as a whole.
    pub fn domain(&self) -> Option<&HeightDomain> {
        self.0.domain()
    }

    /// Normals of the image (Eq. 6 to 9), and the exposure of a known light if `exposure_is_free`. They are solved in
    /// turn, several times in the first iteration.
    pub fn find_normals(
        &mut self,
        inputs: Inputs<'_>,
        exposure_is_free: bool,
        light: &mut ExposedLight,
        normals: &mut Normals,
    ) {
        let is_known = inputs.pair.known_light().is_some();
        for _ in 0..if is_known && inputs.is_first { FIRST_EXPOSURE_ROUNDS } else { 1 } {
            let total = light.total();
            let problem = problem(inputs, &total);
            self.0.solve_normals(&problem, normals);
            if exposure_is_free {
                let moved = inputs.fitted.exposure_change(light.exposure);
                light.exposure += ImageShapeSolver::exposure_step(&problem, normals, moved);
            }
        }
    }

    /// Depth of the image from its normals and colours. If the surface is solved as a whole, the normals become those
    /// of the surface. The caller fixes the gauge of the depth.
    pub fn find_surface(
        &mut self,
        inputs: Inputs<'_>,
        light: &Light,
        scratch: &mut Scratch,
        Shape { normals, points }: &mut Shape,
    ) -> Result<()> {
        self.0.solve_surface(scratch, &problem(inputs, light), normals, &mut points.z)
    }
}

fn problem<'a>(Inputs { pair, colours, fitted, .. }: Inputs<'a>, light: &'a Light) -> ImageShapeProblem<'a> {
    ImageShapeProblem {
        image: colours,
        light,
        prior: fitted.depth_normals(),
        prior_weight: pair.options.weights.prior,
        unit_weight: pair.options.weights.unit,
        variance_inflation: fitted.variance_inflation(),
    }
}
