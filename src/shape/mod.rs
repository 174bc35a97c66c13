//! Shape of both views: normals of single pixels, integration of gradients, heights from shading, refinement of the
//! depth map.

mod heights;
mod integration;
mod pixels;
mod refinement;

pub use heights::{
    Effort, HeightDomain, HeightProblem, HeightReport, HeightSolver, ReliefProblem, ReliefSolver, STARTS, Workbench,
};
pub use integration::{
    AnchorWeight, Anchors, IntegrationOptions, IntegrationReport, Integrator, Robust, Termination, gradients,
};
pub use pixels::{ShadingProblem, ShadingSolver, ShadingWeights, Terminations, exposure_step, first_exposure};
pub use refinement::{RefinementProblem, RefinementTerms, Refiner};
