//! Arithmetic. This lowest module knows nothing of images, lights or poses.
//!
//! [`lanes`] and [`doubles`] process several pixels side by side, with the macros of `elementwise`. [`vector`] sums
//! over long vectors, [`eigen`] computes eigenvalues, [`order`] quantiles, sorting and thinning, [`robust`] robust weights,
//! [`noise`] the noise of a raster, and [`random`] numbers from a seed. [`fourier`] holds Fourier transforms,
//! [`cosine`] the Poisson solver built on them, [`conjugate_gradient`] an iterative solver.

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
pub(crate) use order::{descending, evenly_spread, quantile, sort_descending, thin};
