//! Shape of both views: normals of single pixels, integration of gradients, heights from shading, refinement of the
//! depth map.

mod heights;
mod integration;
mod pixels;
mod refinement;

pub use heights::{ImageSurfaceProblem, ImageSurfaceSolver, STARTS, Scratch};
pub use integration::{
    AnchorWeight, Anchors, IntegrationOptions, IntegrationReport, IntegrationTermination, Integrator, Robustness,
    find_slopes, gradients,
};
pub use pixels::{ShadingProblem, ShadingReport, ShadingSolver, ShadingWeights, exposure_step, first_exposure};
pub use refinement::{RefinementProblem, RefinementTerms, Refiner};
