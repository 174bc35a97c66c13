//! What comes in: sizes, masks, cameras, one colour image and one depth map, checked once.

mod camera;
mod grid;

pub use camera::{Camera, Pinhole};
pub use grid::{Normals, Points, Size};
