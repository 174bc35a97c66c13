//! Rendered pairs and suggested masks for Python.

use bimodal_stereo::scenes::rig::{PairKind, render_pair};
use bimodal_stereo::{Pinhole, Segmentation, Size};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::arrays::array;
use crate::error::outcome;
use crate::guard::guarded;
use crate::members::Members;
use crate::{cameras, report};

type Dict<'py> = PyResult<Bound<'py, PyDict>>;

/// A rendered pair of views of one object.
#[pyfunction]
pub fn sample_pair<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> Dict<'py> {
    let given = Members::new(keywords, "", &["kind"])?;
    let kind = given.needed("kind", given.word("kind", &PairKind::ALL.map(|kind| (kind.name(), kind)))?)?;
    let made = outcome(py.detach(|| guarded(|| render_pair(kind))))?;
    let image = view(py, made.colour_size, &made.colour_camera, made.colour_mask)?;
    let Size { width, height } = made.colour_size;
    image.set_item("data", array(py, made.colour, [height, width, 4])?)?;
    let depth = view(py, made.depth_size, &made.depth_camera, made.depth_mask)?;
    let Size { width, height } = made.depth_size;
    depth.set_item("data", array(py, made.depth, [height, width])?)?;
    depth.set_item("unit", 0.001)?;
    let dict = [("image", image), ("depth", depth), ("pose", report::plain(py, &made.pose)?)].into_py_dict(py)?;
    dict.set_item("name", kind.name())?;
    Ok(dict)
}

fn view<'py>(py: Python<'py>, Size { width, height }: Size, camera: &Pinhole, mask: Vec<bool>) -> Dict<'py> {
    let view = [("camera", cameras::plain(py, camera)?)].into_py_dict(py)?;
    view.set_item("mask", array(py, mask, [height, width])?)?;
    Ok(view)
}

/// The mask of an object from marks, with the share of the object, the rounds, and the share that the last one changed.
#[pyfunction]
pub fn suggest_mask<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> Dict<'py> {
    let given = Members::new(keywords, "", &["data", "marks", "height", "width"])?;
    let colours: Vec<u8> = given.needed("image.data", given.array("data")?)?;
    let marks: Vec<u8> = given.needed("marks", given.array("marks")?)?;
    let side = |name| given.needed(name, given.whole::<usize>(name)?);
    let (height, width) = (side("height")?, side("width")?);
    let find = || {
        let mut found = Segmentation::new(Size { width, height }, &colours, &marks)?;
        while !found.step().is_done {}
        Ok((found.mask(), found.report()))
    };
    let (mask, report) = outcome(py.detach(|| guarded(find)))?;
    let dict = PyDict::new(py);
    let mask: Vec<bool> = mask.into_iter().map(|value| value > 0).collect();
    dict.set_item("mask", array(py, mask, [height, width])?)?;
    dict.set_item("share", report.share)?;
    dict.set_item("rounds", report.rounds)?;
    dict.set_item("changed", report.changed)?;
    Ok(dict)
}
