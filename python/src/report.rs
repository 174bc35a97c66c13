//! Conversion of the crate's reports to dictionaries with the names of the JavaScript contract, from which the package
//! makes its objects.

use bimodal_stereo::StepReport;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use pythonize::pythonize;
use serde::Serialize;

/// A report in the shape of its serialisation.
pub fn plain<'py>(py: Python<'py>, report: &impl Serialize) -> PyResult<Bound<'py, PyDict>> {
    Ok(pythonize(py, report)?.cast_into::<PyDict>()?)
}

pub fn step<'py>(
    py: Python<'py>,
    report: &StepReport,
    milliseconds: &[(&'static str, f64)],
) -> PyResult<Bound<'py, PyDict>> {
    let dict = plain(py, report)?;
    dict.set_item("milliseconds", milliseconds.to_vec().into_py_dict(py)?)?;
    Ok(dict)
}
