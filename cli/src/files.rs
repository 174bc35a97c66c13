//! The files of one pair.

use std::path::PathBuf;

/// The files of a pair.
#[derive(Clone, Debug)]
pub struct Files {
    pub image: PathBuf,
    pub depth: PathBuf,
    pub image_mask: Option<PathBuf>,
    pub depth_mask: Option<PathBuf>,
    /// Belongs to the view whose size it has.
    pub any_mask: Option<PathBuf>,
    /// Metres for each stored number, where the folder tells.
    pub unit: Option<f64>,
}
