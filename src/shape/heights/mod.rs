//! Heights from shading: the surface itself is the unknown.

mod cell_terms;
mod domain;
mod image_surface;
mod normal_operator;
mod ray_frames;
mod scratch;
mod solver;

pub use domain::HeightDomain;
pub use image_surface::{ReliefProblem, ReliefSolver, STARTS};
pub use scratch::Workbench;
pub use solver::{Effort, HeightProblem, HeightReport, HeightSolver};
