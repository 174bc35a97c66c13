//! Registration in the gradient domain: the pose of an object whose albedo varies smoothly
//! (docs/method/registration.md).
//!
//! The data are differences d of neighbouring pixels along rows, columns and both diagonals, so they are fixed, and the
//! pose moves only the prediction. V = log(I + 0.1 median I) in three channels, B are harmonics of orders one to three
//! of the depth view's own normals, and Q rotates the channels to the principal axes of what the light leaves.
//!
//! minimise sum over pairs of g [1/2 sum_c ln V_c + (nu + 3) / 2 ln(1 + e / nu)] / 2 + L^2 / 2p
//!          + silhouette + ln^2(growth) / 2 0.1^2
//! e = sum_c (d v_c - d B L_c)^2 / V_c,   V_c = s_c^2 + delta^2 (|dB_i L_c|^2 + |dB_j L_c|^2)
//!
//! - This is the logarithm of a multivariate t distribution with nu = 1. Small differences are smooth albedo with the
//!   spectrum of a membrane, large ones are edges of albedo. Local means would leave the former in the residuals.
//! - dB L is the derivative of the shade by a rotation of the normal. Wrong normals cost in proportion to the shading,
//!   so the finest shading does not decide alone.
//! - s_c and the prior variances p of the light (one for orders one and two, one for order three) are estimated, p by
//!   expectation and maximisation. The factor 1/2 accounts for four directions that count each pixel twice.
//!
//! Method: Gauss-Newton with the light eliminated. Weights, noise and light are fitted again before each step; without a
//! line search, because the objective of one pose is comparable with that of another only where both see the same
//! pixels. Sigmas are those of the equations plus a jackknife over six sectors.
//!
//! | file | content |
//! |---|---|
//! | `registration` | the steps, one for each slice |
//! | `model` | light, noise and channels: fitted under a pose |
//! | `field` | colours on a raster, and what a pose predicts for them |
//! | `surface` | the z-buffer of the depth view's triangles |
//! | `harmonics` | harmonics of orders one to three and their derivatives |
//! | `equations` | sums over pairs, the light eliminated |
//! | `silhouette_terms` | points off the mask, the occluding contour |
//! | `combination` | one pose from this registration and from local contrast |
//!
//! Limits: the image is orthographic. The start has to lie within about ten degrees. Depth noise that bends normals by
//! far more than delta biases the pose. Order three cannot describe sharp cast shadows.

mod combination;
mod equations;
mod field;
mod harmonics;
mod model;
mod registration;
mod silhouette_terms;
mod surface;

pub use combination::combine;
pub use registration::{GradientRegistration, GradientReport};
