//! What comes in: sizes, masks, cameras, one colour image and one depth map, checked once.

#[macro_use]
mod elementwise;

mod camera;
mod colour;
pub mod cubic_normals;
mod depth;
mod doubles;
mod grid;
mod halve;
mod lanes;
mod mask;
pub(crate) mod noise;
pub mod normals;
mod trim;

pub use camera::{Camera, Pinhole};
pub use colour::{ColourImage, ColourSamples, ColourView, Transfer};
pub use depth::{DepthMap, DepthSamples, DepthView};
pub(crate) use doubles::{DOUBLE_LANES, Doubles};
pub use grid::{Normals, Points, Size};
pub(crate) use lanes::{LANES, Lanes, Mask, Real, dot};
pub(crate) use trim::quantile;
