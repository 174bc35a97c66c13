//! One normal for each pixel (Eq. 6 to 9), and the exposure, the only unknown that all pixels share.

mod exposure;
mod shading;

pub use exposure::{exposure_step, first_exposure};
pub(crate) use shading::{LinearisedPixels, MOST_DESCENT_STEPS, Pixels, STEEPEST_N_Z, normalise};
pub use shading::{ShadingProblem, ShadingReport, ShadingSolver, ShadingWeights};
