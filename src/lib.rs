//! Shape, light and camera pose from one colour image and one depth map of the same object.

mod error;
mod light;
mod options;
mod pose;
mod report;
mod scenes;
mod shape;
mod view;

pub use error::{Error, ErrorKind, Result};
pub use light::Light;
pub use options::{LightSource, Options, Registration, Shading, Start, Weights};
pub use pose::Similarity;
pub use report::{Energy, Stage, Status, StepReport, Uncertainty};
pub use view::{Camera, Normals, Pinhole, Points, Size};
