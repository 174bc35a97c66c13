//! The check of a calibration: cameras with the lenses that calibration tools write.

mod lens;

pub use lens::{Lens, RigCamera};
