//! The ground floor: arithmetic that knows nothing of images, lights or poses.
//!
//! [`lanes`] and [`doubles`] are numbers of several pixels side by side, `elementwise` the macros that define them;
//! [`vector`] holds sums over long vectors, [`eigen`] eigenvalues, [`order`] quantiles and thinning, [`robust`] robust weights,
//! [`noise`] the noise of a raster, [`random`] numbers that follow from a seed, [`fourier`] and [`cosine`] transforms and the Poisson solver made of them.

#[macro_use]
mod elementwise;

pub(crate) mod conjugate_gradient;
pub(crate) mod cosine;
mod doubles;
pub(crate) mod eigen;
pub(crate) mod fourier;
mod lanes;
pub(crate) mod noise;
mod order;
pub(crate) mod random;
pub(crate) mod robust;
pub(crate) mod vector;

pub(crate) use doubles::{DOUBLE_LANES, Doubles};
pub(crate) use lanes::{LANES, Lanes, Mask, Real, dot};
pub(crate) use order::{evenly_spread, quantile, thin};
