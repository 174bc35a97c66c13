//! The stages of the image's shape: normals of its pixels (Eq. 6 to 9), then the surface.

use crate::error::Result;
use crate::estimator::pair::ViewPair;
use crate::estimator::solution::{ExposedLight, Shape};
use crate::light::Light;
use crate::options::Shading;
use crate::pose::Similarity;
use crate::shape::{HeightDomain, ImageShapeProblem, ImageShapeSolver, Scratch};
use crate::view::Normals;

use super::light::Inputs;

/// Solves of normals and exposure in the first iteration, which starts from a look at the colours alone.
const FIRST_EXPOSURE_ROUNDS: usize = 4;

/// Changes of light (log units, root mean square) and rotation (degrees) from which on a large image's shape is found from
/// nothing again: under the wrong light another surface explains the colours best. From the end of a search to that of the
/// registration by all pixels the light changes by 0.0005 to 0.0014, from a start told 8 degrees off by 0.05 to 0.2.
const OTHER_LIGHT: f64 = 0.01;
const OTHER_ROTATION: f64 = 1.0;

/// Finds the normals and the surface of the image.
pub struct ShapeStage {
    solver: ImageShapeSolver,
    /// The light and the pose under which the shape was found from nothing.
    opened: Option<(Light, Similarity)>,
}

impl ShapeStage {
    /// Memory for the surface that the options ask for.
    pub fn new(pair: &ViewPair) -> Result<Self> {
        let solver = match pair.options.shading {
            Shading::Surface => ImageShapeSolver::as_a_whole(&pair.image)?,
            Shading::Pixel => ImageShapeSolver::by_integration(),
        };
        Ok(Self { solver, opened: None })
    }

    /// Where the heights of the image are unknown, if they are solved as a whole.
    pub fn domain(&self) -> Option<&HeightDomain> {
        self.solver.domain()
    }

    /// Normals of the image (Eq. 6 to 9), and the exposure of a known light where `exposure_is_free`: in turn, several
    /// times in the first iteration.
    pub fn find_normals(
        &mut self,
        inputs: Inputs<'_>,
        exposure_is_free: bool,
        pose: &Similarity,
        light: &mut ExposedLight,
        scratch: &mut Scratch,
        normals: &mut Normals,
    ) -> Result<()> {
        let total = light.total();
        let stays = |(light, found): &(Light, Similarity)| {
            light.distance(&total) < OTHER_LIGHT && found.degrees_to(pose) < OTHER_ROTATION
        };
        if !self.opened.as_ref().is_some_and(stays) {
            self.solver.open(scratch, &problem(inputs, &total), normals)?;
            self.opened = Some((total, *pose));
        }
        let is_known = inputs.pair.known_light().is_some();
        for _ in 0..if is_known && inputs.is_first { FIRST_EXPOSURE_ROUNDS } else { 1 } {
            let total = light.total();
            let problem = problem(inputs, &total);
            self.solver.solve_normals(&problem, normals);
            if exposure_is_free {
                let moved = inputs.fitted.exposure_change(light.exposure);
                light.exposure += ImageShapeSolver::exposure_step(&problem, normals, moved);
            }
        }
        Ok(())
    }

    /// Depth of the image from its normals and colours; the normals become those of the surface where it is solved as a
    /// whole. The gauge of the depth is left to the caller.
    pub fn find_surface(
        &mut self,
        inputs: Inputs<'_>,
        light: &Light,
        scratch: &mut Scratch,
        Shape { normals, points }: &mut Shape,
    ) -> Result<()> {
        self.solver.solve_surface(scratch, &problem(inputs, light), normals, &mut points.z)
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
