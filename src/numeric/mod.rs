//! The ground floor: arithmetic that knows nothing of images, lights or poses.

#[macro_use]
mod elementwise;

pub(crate) mod cosine;
mod doubles;
pub(crate) mod fourier;
mod lanes;
pub(crate) mod noise;
mod order;
#[allow(dead_code, reason = "adopted room by room")]
pub(crate) mod robust;
pub(crate) mod vector;

pub(crate) use doubles::{DOUBLE_LANES, Doubles};
pub(crate) use lanes::{LANES, Lanes, Mask, Real, dot};
pub(crate) use order::{evenly_spread, quantile, sort_descending};
