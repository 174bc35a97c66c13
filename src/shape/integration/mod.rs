//! Integration: the surface with given gradients in the least-squares sense, and the gradients of normals.

mod components;
mod gradients_to_heights;
mod normals_to_gradients;
mod poisson;
mod terms;

pub use gradients_to_heights::{IntegrationOptions, IntegrationReport, Integrator, Robustness};
pub use normals_to_gradients::{find_slopes, gradients};
pub use poisson::IntegrationTermination;
pub(super) use terms::Edges;
pub use terms::{AnchorWeight, Anchors};
