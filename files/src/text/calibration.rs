//! Content of a text with cameras and poses.

use bimodal_stereo::{Pinhole, Similarity};

use crate::warning::Warnings;

/// Why a file is not read, without its name.
pub type Reason = String;

/// A camera with the size of its images, if the file states it.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedCamera {
    pub name: Option<String>,
    pub camera: Pinhole,
    /// Columns and rows.
    pub size: Option<[usize; 2]>,
}

/// Name of a motion in its file, and its two frames.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Names {
    pub name: Option<String>,
    pub from: Option<String>,
    pub to: Option<String>,
}

impl Names {
    pub fn between(name: Option<String>, from: &str, to: &str) -> Self {
        Self { name, from: Some(from.into()), to: Some(to.into()) }
    }
}

/// P_to = R P_from + t, metres.
#[derive(Clone, Debug, PartialEq)]
pub struct NamedPose {
    pub names: Names,
    pub pose: Similarity,
}

/// Content of a text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Calibration {
    pub cameras: Vec<NamedCamera>,
    pub poses: Vec<NamedPose>,
    pub warnings: Warnings,
    /// Kind of the text.
    pub format: String,
}
