//! Rendered scenes for Python.

use bimodal_stereo::scenes::{self, DepthData, Relief, Sample, SampleRequest, Scene, lights, surfaces};
use bimodal_stereo::{Camera, Size};
use numpy::PyReadonlyArray2;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::arrays::array;
use crate::cameras;
use crate::error::{failure, outcome, refused, unbroken};
use crate::guard::guarded;
use crate::input::angles;
use crate::lessons::light;
use crate::members::{Members, wrong};
use crate::report;

const NAMES: [&str; 12] = [
    "surface",
    "light",
    "size",
    "height",
    "protocol",
    "angles",
    "scale",
    "overlap",
    "noise",
    "depth_noise",
    "holes",
    "seed",
];
/// Arguments that the grid protocol does not use and would silently ignore.
const RENDERED_ALONE: [&str; 7] = ["size", "height", "scale", "noise", "depth_noise", "holes", "seed"];

#[pyfunction]
pub fn sample_surfaces() -> Vec<&'static str> {
    surfaces::NAMES.to_vec()
}

#[pyfunction]
pub fn sample_lights() -> Vec<&'static str> {
    lights::NAMES.to_vec()
}

#[pyfunction]
pub fn sample<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
    plain(py, &made(py, &Members::new(keywords, "", &NAMES)?)?)
}

/// The lowest rotation error that any estimator can attain on this scene, degrees.
#[pyfunction]
pub fn sample_bound(py: Python<'_>, keywords: &Bound<'_, PyAny>, light_is_known: bool) -> PyResult<Option<f64>> {
    let given = Members::new(keywords, "", &NAMES)?;
    let (made, noise) = (made(py, &given)?, given.number("noise")?.unwrap_or_default());
    unbroken(py.detach(|| guarded(|| scenes::bound(&made, light_is_known, noise))))
}

fn made(py: Python<'_>, given: &Members<'_>) -> PyResult<Sample> {
    let (relief, request) = (relief(given)?, request(given)?);
    let is_grid = given.word("protocol", &[("rendered", false), ("grid", true)])?.unwrap_or(false);
    if is_grid {
        let surplus = RENDERED_ALONE.into_iter().find(|name| matches!(given.get(name), Ok(Some(_))));
        if let Some(name) = surplus {
            return Err(failure("option", name, "the grid protocol has no such option"));
        }
    }
    let make = || match is_grid {
        true => scenes::bare_grid(&relief, &request.light, &request.rotation, request.overlap),
        false => Scene::new(&relief)?.sample(&request),
    };
    outcome(py.detach(|| guarded(make)))
}

fn relief(given: &Members<'_>) -> PyResult<Relief> {
    let value = given.needed("surface", given.get("surface")?)?;
    if let Ok(name) = value.extract::<String>() {
        return scenes::surface(&name).map_err(|error| refused(&error));
    }
    let heights: PyReadonlyArray2<'_, f32> =
        value.extract().map_err(|_| wrong("surface", "a name or heights (h, w)", &value))?;
    let array = heights.as_array();
    let (height, width) = array.dim();
    Relief::new(width, height, array.iter().copied().collect()).map_err(|error| refused(&error))
}

fn request(given: &Members<'_>) -> PyResult<SampleRequest> {
    let default = SampleRequest::default();
    let number = |name, default| Ok::<f64, PyErr>(given.number(name)?.unwrap_or(default));
    let width = given.whole("size")?.unwrap_or(default.size.width);
    let height = given.whole("height")?.unwrap_or(width);
    Ok(SampleRequest {
        light: light(given)?,
        size: Size { width, height },
        rotation: angles(given)?.map_or(default.rotation, |angles| angles.rotation()),
        scale: number("scale", default.scale)?,
        overlap: number("overlap", default.overlap)?,
        noise: number("noise", default.noise)?,
        depth_noise: number("depth_noise", default.depth_noise)?,
        holes: number("holes", default.holes)?,
        seed: given.whole("seed")?.unwrap_or(default.seed),
        ..default
    })
}

fn plain<'py>(py: Python<'py>, sample: &Sample) -> PyResult<Bound<'py, PyDict>> {
    let shape = |size: Size| [size.height, size.width];
    let vectors = |size: Size| [size.height, size.width, 3];

    let size = sample.image.size;
    let image = view(py, size, &sample.image.mask, &sample.image.camera)?;
    image.set_item("data", array(py, sample.image.colours.clone(), vectors(size))?)?;
    let truth = PyDict::new(py);
    truth.set_item("image_normals", array(py, sample.truth.image_normals.interleaved(), vectors(size))?)?;
    truth.set_item("image_depth", array(py, sample.truth.image_depth.clone(), shape(size))?)?;

    let size = sample.depth.size;
    let depth = view(py, size, &sample.depth.mask, &sample.depth.camera)?;
    match &sample.depth.data {
        DepthData::Map(data) => depth.set_item("data", array(py, data.clone(), shape(size))?)?,
        DepthData::Cloud { points, normals } => {
            depth.set_item("points", array(py, points.interleaved(), vectors(size))?)?;
            depth.set_item("normals", array(py, normals.interleaved(), vectors(size))?)?;
        }
    }
    truth.set_item("depth_normals", array(py, sample.truth.depth_normals.interleaved(), vectors(size))?)?;
    truth.set_item("depth", array(py, sample.truth.depth.clone(), shape(size))?)?;

    let dict = [("image", image), ("depth", depth), ("truth", truth)].into_py_dict(py)?;
    dict.set_item("light", array(py, sample.light.flat().to_vec(), [3, 9])?)?;
    dict.set_item("pose", report::plain(py, &sample.pose)?)?;
    Ok(dict)
}

fn view<'py>(py: Python<'py>, size: Size, mask: &[bool], camera: &Camera) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    dict.set_item("mask", array(py, mask.to_vec(), [size.height, size.width])?)?;
    if let Some(camera) = camera.pinhole() {
        dict.set_item("camera", cameras::plain(py, &camera)?)?;
    }
    Ok(dict)
}
