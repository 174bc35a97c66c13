//! One normal for each pixel (Eq. 6 to 9), and the exposure, the only unknown that all pixels share.

mod exposure;
mod landscape;
mod shading;

pub use exposure::{exposure_step, first_exposure};
pub use landscape::{Minimum, PixelLandscape};
pub use shading::{ShadingProblem, ShadingReport, ShadingSolver, ShadingWeights};
