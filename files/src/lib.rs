//! Readers for the files of a colour camera and a depth camera, as input of [`bimodal_stereo`].
//!
//! [`read_rig_folder`] reads a whole folder of frames with their cameras, [`read_calibration`] the cameras and poses of
//! one text: matrices, JSON, YAML and XML by the names of their members (OpenCV, ROS, Kalibr, Open3D), and the formats
//! of RealSense and COLMAP. Pictures are PNG, JPEG and `.npy`; any other file gives an error that names it. A guess of
//! a reader gives a [`Warning`].
//!
//! Every size that a file declares is checked before memory is allocated for it.

mod assign;
pub mod colour;
#[cfg(feature = "command")]
pub mod command;
mod depth;
pub mod pairs;
mod problem;
pub mod read;
mod rig;
mod text;
pub mod unit;
mod warning;
pub mod write;

pub use assign::assigned;
pub use depth::{Depth, depth_of};
pub use problem::{Problem, Result, plain, shown};
pub use rig::{FolderOptions, Reading, RigFolder, read_calibration, read_corner, read_rig_folder, says};
pub use text::{Calibration, NamedCamera, NamedPose, Names};
pub use warning::{Warning, Warnings};
