//! The input: sizes, masks, cameras, one colour image and one depth map, checked once (docs/method/views.md).

mod albedo_steps;
mod camera;
mod chroma;
mod colour;
mod couplings;
mod cubic_moments;
pub mod cubic_normals;
mod depth;
pub(crate) mod depth_noise;
#[cfg(feature = "image")]
mod dynamic_image;
mod flying_pixels;
mod gaussian;
mod half_resolution;
mod heights;
mod lens;
mod mask;
pub mod normals;
mod pinhole;
mod raster;
mod segmentation;
mod smoothing;
mod vectors;
mod working_size;

pub use camera::Camera;
pub use colour::{ColourImage, ColourSamples, ColourView, Transfer};
pub(crate) use colour::{to_srgb, transfer_of};
pub use depth::{DepthMap, DepthSamples, DepthView};
pub use depth_noise::DepthNoise;
pub(crate) use gaussian::Gaussian;
pub use lens::Lens;
pub(crate) use pinhole::FARTHEST;
pub use pinhole::Pinhole;
pub use raster::Size;
pub use segmentation::{Mark, Segmentation, SegmentationReport};
pub(crate) use vectors::extent;
pub use vectors::{Normals, Points};
pub(crate) use working_size::WorkingSize;
