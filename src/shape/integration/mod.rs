//! Integration: the surface with given gradients in the least-squares sense, and the gradients of normals.

mod components;
mod gradients_to_heights;
mod normals_to_gradients;
mod poisson;
mod surface_of_normals;
mod terms;

pub use gradients_to_heights::{IntegrationOptions, IntegrationReport, Integrator, Robustness};
pub use normals_to_gradients::{find_slopes, gradients};
pub use poisson::IntegrationTermination;
pub use surface_of_normals::surface_of_normals;
pub(super) use terms::Edges;
pub use terms::{AnchorWeight, Anchors};
