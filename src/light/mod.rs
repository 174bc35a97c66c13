//! The image model and its light (Eq. 2, 3, 5; docs/method/image-model.md).

mod colour_axes;
mod environments;
mod fit;
mod harmonics;
mod mixture;
mod prior;
mod varying_albedo;

pub use fit::{LightFit, LightFitter};
pub use harmonics::Light;
pub(crate) use harmonics::{HARMONICS, Polynomial, basis, basis_gradient, falling_by_turns};
pub(crate) use prior::Coefficients;
pub use prior::{COEFFICIENTS, CoefficientMatrix, LightGaussian, LightPrior};
pub use varying_albedo::{AlbedoFitter, VaryingAlbedo};
