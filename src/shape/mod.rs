//! Shape of both views: normals from shading, heights from normals, refinement of the depth map.

mod components;
mod cosine;
mod exposure;
mod fourier;
mod gradients;
mod height_domain;
mod heights;
mod normal_operator;
mod poisson;
mod ray_frames;
mod refine;
mod relief;
mod shading;
mod slopes;
mod surface;
mod workbench;

pub use exposure::{exposure_step, first_exposure};
pub use gradients::gradients;
pub use height_domain::HeightDomain;
pub use heights::{Effort, HeightProblem, HeightReport, HeightSolver};
pub use poisson::Termination;
pub use refine::{RefinementProblem, RefinementTerms, Refiner};
pub use relief::{ReliefProblem, ReliefSolver, STARTS};
pub use shading::{ShadingProblem, ShadingSolver, ShadingWeights, Terminations};
pub use surface::{AnchorWeight, Anchors, IntegrationOptions, IntegrationReport, Integrator, Robust};
pub use workbench::Workbench;
