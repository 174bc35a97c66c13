//! Shape of both views (docs/method/normals.md and docs/method/heights.md). Four problems, each with its unknowns, objective and solver:
//!
//! | where | unknowns | objective | solver |
//! |---|---|---|---|
//! | `pixels/` | one normal for each pixel | brightness, prior and unit length, Eq. 6 to 9 | the best of 600 directions, then damped Gauss-Newton, four pixels side by side |
//! | `pixels/exposure` | one offset of log S for all pixels | the same | a grid at first, then Gauss-Newton by variable projection |
//! | `integration/` | one height for each pixel of a mask | (differences - gradients)^2, weights of Geman and McClure; anchors | reweighting; conjugate gradients, preconditioned by a cosine transform |
//! | `heights/` | the same | brightness of every cell of four pixels, edges, anchors, smoothness | damped Gauss-Newton; each step as above; several starts, coarse to fine |
//! | `refinement` | normals and depth of the depth view, Eq. 17 to 19 | those of `pixels` and `heights`, anchored to the measured depth | these |
//!
//! Files of the equations:
//!
//! | equation | file |
//! |---|---|
//! | Eq. 6 to 9 (17 and 18 for the depth view): terms and derivatives of one pixel | `pixels/shading` |
//! | the exposure of a known light | `pixels/exposure` |
//! | Eq. 4, 10: gradients and slopes of normals | `integration/normals_to_gradients` |
//! | Eq. 11: a surface from gradients, with robust weights | `integration/gradients_to_heights` |
//! | the weighted Poisson equation and its preconditioner | `integration/poisson` |
//! | brightness of a cell as a function of its slopes | `heights/cell_terms`, its rays in `heights/ray_frames` |
//! | the Gauss-Newton matrix of the heights | `heights/normal_operator` |
//! | Gauss-Newton steps, edges and smoothness | `heights/solver` |
//! | starts and the choice among local optima | `heights/starts`, coarse to fine in `heights/image_surface` |
//! | normals and surface of the colour view, one after the other | `image_shape` |
//! | Eq. 19, anchors and their weights | `refinement` |
//!
//! Data flows one way: `pixels` and `integration` are independent, `heights` takes edges and anchors from
//! `integration`, `image_shape` and `refinement` use all three. Rasters that live for one stage only belong to a
//! [`Scratch`], which the caller lends to one stage after another.

mod heights;
mod image_shape;
mod integration;
mod pixels;
mod refinement;

pub use heights::{HeightDomain, STARTS, Scratch};
pub use image_shape::{ImageShapeProblem, ImageShapeSolver};
pub(crate) use integration::find_slopes;
pub use integration::{
    AnchorWeight, Anchors, IntegrationOptions, IntegrationReport, IntegrationTermination, Integrator, Robustness,
    gradients,
};
pub(crate) use pixels::{LinearisedPixels, MOST_DESCENT_STEPS, Pixels, STEEPEST_N_Z, normalise};
pub use pixels::{ShadingProblem, ShadingReport, ShadingSolver, ShadingWeights, exposure_step, first_exposure};
pub use refinement::{RefinementProblem, RefinementTerms, Refiner};
