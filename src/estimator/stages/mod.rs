//! The stages of an iteration. Each owns what it remembers between iterations, reads the [`ViewPair`] and parts of the
//! [`Solution`], and writes only what its signature borrows mutably or returns.
//!
//! [`ViewPair`]: super::pair::ViewPair
//! [`Solution`]: super::solution::Solution

mod albedo;
mod correspondences;
mod light;
mod refinement;
mod registration;
mod shape;
mod surfaces;

pub use albedo::AlbedoStage;
pub use correspondences::correspondence_problem;
pub use light::{Inputs, LightStage};
pub use refinement::{RefinementStage, RefinementTask, terms_from_numbers};
pub use registration::{Registered, Registering, RegistrationStage};
pub use shape::ShapeStage;

/// All stages of an iteration, in order, except that the albedo is fitted only under a settled pose.
pub struct Stages {
    pub light: LightStage,
    pub albedo: AlbedoStage,
    pub shape: ShapeStage,
    pub registration: RegistrationStage,
    pub refinement: RefinementStage,
}
