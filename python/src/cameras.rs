//! Cameras from and to the package's dictionaries.

use bimodal_stereo::{Lens, Pinhole};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::error::refused_at;
use crate::members::Members;

/// The camera of a raster.
pub fn pinhole(raster: &Members<'_>) -> PyResult<Option<Pinhole>> {
    let names = ["fx", "fy", "cx", "cy", "model", "distortion"];
    let Some(camera) = raster.below("camera", &names)? else { return Ok(None) };
    let number = |name| camera.needed(name, camera.number(name)?);
    let [fx, fy, cx, cy] = [number("fx")?, number("fy")?, number("cx")?, number("cy")?];
    let is_fisheye = camera.word("model", &[("brown", false), ("fisheye", true)])?.unwrap_or(false);
    let coefficients = camera.list("distortion")?.unwrap_or_default();
    let lens = if is_fisheye { Lens::fisheye(&coefficients) } else { Lens::brown(&coefficients) };
    let lens = lens.map_err(|error| refused_at(camera.at(error.field()), &error))?;
    Ok(Some(Pinhole { fx, fy, cx, cy, lens }))
}

/// A camera as the package's `Pinhole` expects it.
pub fn plain<'py>(py: Python<'py>, camera: &Pinhole) -> PyResult<Bound<'py, PyDict>> {
    let own = [("fx", camera.fx), ("fy", camera.fy), ("cx", camera.cx), ("cy", camera.cy)].into_py_dict(py)?;
    own.set_item("model", camera.lens.model())?;
    let coefficients = camera.lens.coefficients();
    own.set_item("distortion", if coefficients.is_empty() { vec![0.0; 5] } else { coefficients.to_vec() })?;
    Ok(own)
}
