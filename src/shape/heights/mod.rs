//! Heights from shading: the surface itself is the unknown.

mod cell_terms;
mod domain;
mod image_surface;
mod normal_operator;
mod problem;
mod rasters;
mod ray_frames;
mod scratch;
mod solver;
mod starts;

pub use domain::HeightDomain;
pub use image_surface::ImageSurfaceSolver;
pub use problem::{Bending, COLOUR_SCALES, Effort, FAR_DAMPING, HALVING_CONFIDENCE, HeightProblem, LAST_SCALE};
pub use scratch::Scratch;
pub use starts::{ImageSurfaceProblem, STARTS};
