//! What comes in: sizes, masks, cameras, one colour image and one depth map, checked once.

mod camera;
mod colour;
pub mod cubic_normals;
mod depth;
mod grid;
mod halve;
mod heights;
mod mask;
pub mod normals;
mod trim;

pub use camera::{Camera, Pinhole};
pub use colour::{ColourImage, ColourSamples, ColourView, Transfer};
pub use depth::{DepthMap, DepthSamples, DepthView};
pub use grid::{Normals, Points, Size};
