//! From the crate's reports to dictionaries, of which the package makes its objects.

use bimodal_stereo::{Angles, Objective, Similarity, StepReport, Uncertainty};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::arrays::array;
use crate::error::spelled;

type Dict<'py> = PyResult<Bound<'py, PyDict>>;

pub fn pose<'py>(py: Python<'py>, pose: &Similarity) -> Dict<'py> {
    let Angles { alpha, beta, gamma } = Angles::of(&pose.rotation);
    let dict = PyDict::new(py);
    dict.set_item("scale", pose.scale)?;
    dict.set_item("rotation", array(py, pose.rotation.transpose().as_slice().to_vec(), [3, 3])?)?;
    dict.set_item("translation", array(py, pose.translation.as_slice().to_vec(), [3])?)?;
    dict.set_item("angles", [("alpha", alpha), ("beta", beta), ("gamma", gamma)].into_py_dict(py)?)?;
    Ok(dict)
}

fn objective<'py>(py: Python<'py>, terms: &Objective) -> Dict<'py> {
    let Objective { shading, prior, registration, refinement } = *terms;
    let total = terms.total();
    [
        ("shading", shading),
        ("prior", prior),
        ("registration", registration),
        ("refinement", refinement),
        ("total", total),
    ]
    .into_py_dict(py)
}

fn uncertainty<'py>(py: Python<'py>, sigma: &Uncertainty) -> Dict<'py> {
    let dict = PyDict::new(py);
    dict.set_item("rotation_degrees", array(py, sigma.rotation_degrees.to_vec(), [3])?)?;
    // NaN where the views cannot see it.
    let translation = sigma.translation.map(|sigma| sigma.unwrap_or(f64::NAN));
    dict.set_item("translation", array(py, translation.to_vec(), [3])?)?;
    dict.set_item("scale", sigma.scale)?;
    dict.set_item("weakest", &sigma.weakest)?;
    Ok(dict)
}

pub fn step<'py>(py: Python<'py>, report: &StepReport, milliseconds: &[(&'static str, f64)]) -> Dict<'py> {
    let dict = PyDict::new(py);
    dict.set_item("iteration", report.iteration)?;
    dict.set_item("stage", report.stage.name())?;
    dict.set_item("pose", pose(py, &report.pose)?)?;
    dict.set_item("rotation_change", report.rotation_change)?;
    dict.set_item("energy", objective(py, &report.objective)?)?;
    dict.set_item("overlap", report.overlap)?;
    dict.set_item("inliers", report.inliers)?;
    dict.set_item("residual", report.residual)?;
    dict.set_item("status", report.status.name())?;
    dict.set_item("message", report.message.as_deref().map(spelled))?;
    let rivals = report.rivals.iter().map(|rival| pose(py, rival)).collect::<PyResult<Vec<_>>>()?;
    dict.set_item("rivals", rivals)?;
    dict.set_item("uncertainty", report.uncertainty.as_ref().map(|sigma| uncertainty(py, sigma)).transpose()?)?;
    dict.set_item("milliseconds", milliseconds.to_vec().into_py_dict(py)?)?;
    Ok(dict)
}
