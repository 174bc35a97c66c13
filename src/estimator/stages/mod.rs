//! The stages of an iteration. Each owns what it remembers from one iteration to the next, reads the [`ViewPair`] and
//! parts of the [`Solution`], and writes nothing but what its signature lends it mutably or what it returns.
//!
//! [`ViewPair`]: super::pair::ViewPair
//! [`Solution`]: super::solution::Solution

mod colours;
mod contrasted;
mod correspondences;
mod light;
mod paint;
mod refinement;
mod registration;
mod shape;
mod surfaces;

pub use colours::{Attempt, COLLAPSE, ColourRegistration, FIRST_LEVEL_NEAR};
pub use correspondences::correspondence_problem;
pub use light::{Inputs, LightStage};
pub use paint::PaintStage;
pub use refinement::{RefinementStage, RefinementTask, terms_from_numbers};
pub use registration::{Registered, Registering, RegistrationStage};
pub use shape::ShapeStage;

/// All stages of an iteration, in their order but for paint, which is looked for under a pose that has settled.
pub struct Stages {
    pub light: LightStage,
    pub paint: PaintStage,
    pub shape: ShapeStage,
    pub registration: RegistrationStage,
    pub refinement: RefinementStage,
}
