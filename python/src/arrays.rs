//! Numbers as arrays in their natural shapes.

use numpy::ndarray::IntoDimension;
use numpy::{Element, IntoPyArray, PyArrayMethods};
use pyo3::prelude::*;

/// A new array, row by row.
pub fn array<T: Element>(py: Python<'_>, values: Vec<T>, shape: impl IntoDimension) -> PyResult<Bound<'_, PyAny>> {
    Ok(values.into_pyarray(py).reshape(shape)?.into_any())
}

/// An array of three numbers for each point.
pub fn triples<T: Element>(py: Python<'_>, values: Vec<T>) -> PyResult<Bound<'_, PyAny>> {
    let count = values.len() / 3;
    array(py, values, [count, 3])
}
