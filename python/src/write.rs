//! Results as files.

use std::path::Path;

use bimodal_stereo::Similarity;
use bimodal_stereo_files::Problem;
use bimodal_stereo_files::write::{self, Length};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::error::{self, failure, unbroken};
use crate::files::refused;
use crate::guard::guarded;
use crate::input::{POSE, pose};
use crate::members::Members;

/// Depth as a 16-bit PNG, and its step in words.
#[pyfunction]
pub fn depth_png<'py>(
    py: Python<'py>,
    keywords: &Bound<'py, PyAny>,
    is_metric: bool,
) -> PyResult<(Bound<'py, PyBytes>, &'static str)> {
    let given = Members::new(keywords, "", &["depth", "width"])?;
    let depth: Vec<f32> = given.needed("depth", given.array("depth")?)?;
    let width = given.needed("width", given.whole("width")?)?;
    if depth.is_empty() {
        return Err(failure("size", "depth", "holds no pixel"));
    }
    let made = unbroken(py.detach(|| guarded(|| write::depth_png(&depth, width, Length::of(is_metric)))))?;
    let (bytes, says) = made.map_err(|error| refused(&Problem::file(Path::new("depth"), error)))?;
    Ok((PyBytes::new(py, &bytes), says))
}

/// The 4x4 matrix of a pose as four lines of text.
#[pyfunction]
pub fn matrix_text(value: &Bound<'_, PyAny>) -> PyResult<String> {
    let members = Members::new(value, "pose", &POSE)?;
    let given = pose(&members)?;
    let whole = Similarity {
        scale: given.scale.unwrap_or(1.0),
        rotation: members.needed("rotation", given.rotation)?,
        translation: members.needed("translation", given.translation)?,
    };
    whole.validate("pose").map_err(|error| error::refused(&error))?;
    Ok(write::matrix_text(&whole))
}
