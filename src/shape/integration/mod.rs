//! Heights from normals: gradients of the normals, then the surface that has these gradients in the least-squares sense.

mod components;
mod gradients_to_heights;
mod normals_to_gradients;
mod poisson;

pub use gradients_to_heights::{AnchorWeight, Anchors, IntegrationOptions, IntegrationReport, Integrator, Robust};
pub use normals_to_gradients::gradients;
pub(super) use poisson::Edges;
pub use poisson::Termination;
