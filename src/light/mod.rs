//! The image model and its light (Eq. 2, 3, 5).

mod harmonics;

pub use harmonics::Light;
