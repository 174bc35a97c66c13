//! Single parts of the method, for lessons.

use bimodal_stereo::scenes::lights;
use bimodal_stereo::{
    BasRelief, Form, Lamp, Light, Minimum, Normals, PixelLandscape, ShadedImage, ShadingWeights, Size,
    characteristic_strips as strips, second_order as approximation, surface_of_normals,
};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::arrays::{array, triples};
use crate::error::{outcome, refused, unbroken};
use crate::guard::guarded;
use crate::input::angles;
use crate::members::Members;

type Array<'py> = PyResult<Bound<'py, PyAny>>;

/// Depth of the surface with these normals, given as all x, then all y, then all z.
#[pyfunction]
pub fn integrate_normals<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> Array<'py> {
    let given = Members::new(keywords, "", &["normals", "height", "width", "robust"])?;
    let planes: Vec<f32> = given.needed("normals", given.array("normals")?)?;
    let side = |name| given.needed(name, given.whole::<usize>(name)?);
    let (height, width) = (side("height")?, side("width")?);
    let robust = given.flag("robust")?.unwrap_or(true);
    let (x, rest) = planes.split_at(planes.len() / 3);
    let (y, z) = rest.split_at(x.len());
    let normals = Normals { x: x.to_vec(), y: y.to_vec(), z: z[..x.len()].to_vec() };
    let depth = outcome(py.detach(|| guarded(|| surface_of_normals(Size { width, height }, &normals, robust))))?;
    array(py, depth, [height, width])
}

/// A named or given light.
pub fn light(given: &Members<'_>) -> PyResult<Light> {
    let value = given.needed("light", given.get("light")?)?;
    let made = match value.extract::<String>() {
        Ok(name) => lights::light(&name),
        Err(_) => Light::from_slice("light", &given.list("light")?.unwrap_or_default()),
    };
    made.map_err(|error| refused(&error))
}

#[pyfunction]
pub fn turn_light<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> Array<'py> {
    let given = Members::new(keywords, "", &["light", "angles"])?;
    let light = light(&given)?;
    let turned = match angles(&given)? {
        Some(angles) => light.turned(&angles.rotation()),
        None => light,
    };
    array(py, turned.flat().to_vec(), [3, 9])
}

/// log S of each normal; normals and results are sequences of three numbers.
#[pyfunction]
pub fn shade_normals<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> Array<'py> {
    let given = Members::new(keywords, "", &["light", "normals"])?;
    let light = light(&given)?;
    let normals: Vec<f32> = given.needed("normals", given.array("normals")?)?;
    let shade = |normal: &[f32; 3]| light.shade(normal.map(f64::from)).map(|log| log as f32);
    let shaded: Vec<f32> = normals.as_chunks().0.iter().flat_map(shade).collect();
    let count = shaded.len() / 3;
    array(py, shaded, [count, 3])
}

/// The objective of one pixel over the visible hemisphere, its minima and one descent.
#[pyfunction]
pub fn pixel_landscape<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
    let names = ["log", "light", "prior", "weight", "robust", "start", "side"];
    let given = Members::new(keywords, "", &names)?;
    let three = |name| Ok::<_, PyErr>(given.numbers::<3>(name)?.map(|all| all.map(|value| value as f32)));
    let log = given.needed("log", three("log")?)?;
    let (prior, start) = (three("prior")?.unwrap_or([f32::NAN; 3]), three("start")?.unwrap_or([0.0, 0.0, -1.0]));
    let side: usize = given.needed("side", given.whole("side")?)?;
    let mut weights = ShadingWeights::with_robust_prior(given.number("weight")?.unwrap_or_default() as f32, 1.0);
    if !given.flag("robust")?.unwrap_or(true) {
        weights.robust = None;
    }
    let light = light(&given)?;
    let found = unbroken(py.detach(|| guarded(|| PixelLandscape::new(log, prior, &light, weights, start, side))))?;
    let row = |&Minimum { normal: [x, y, z], objective, share }: &Minimum| [x, y, z, objective, share];
    let minima: Vec<f32> = found.minima.iter().flat_map(row).collect();
    let path = found.path.as_flattened().to_vec();
    let dict = PyDict::new(py);
    dict.set_item("objective", array(py, found.objective, [side, side])?)?;
    dict.set_item("minima", array(py, minima, [found.minima.len(), 5])?)?;
    dict.set_item("path", array(py, path, [found.path.len(), 3])?)?;
    Ok(dict)
}

fn lamp(given: &Members<'_>) -> PyResult<Lamp> {
    Ok(Lamp(given.needed("lamp", given.numbers::<3>("lamp")?)?.into()))
}

/// Intensity of each normal under one lamp.
#[pyfunction]
pub fn shade_lamp<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> Array<'py> {
    let given = Members::new(keywords, "", &["lamp", "normals"])?;
    let lamp = lamp(&given)?;
    let normals: Vec<f32> = given.needed("normals", given.array("normals")?)?;
    let shaded: Vec<f32> = normals.as_chunks().0.iter().map(|&normal| lamp.shade(normal)).collect();
    let count = shaded.len();
    array(py, shaded, [count])
}

/// Normals, albedo and lamp of a surface that looks the same from the front.
#[pyfunction]
pub fn bas_relief<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyDict>> {
    let given = Members::new(keywords, "", &["normals", "lamp", "stretch", "right", "down"])?;
    let number = |name| given.needed(name, given.number(name)?);
    let relief = BasRelief { stretch: number("stretch")?, slopes: [number("right")?, number("down")?] };
    let Lamp(moved) = relief.lamp(lamp(&given)?);
    let normals: Vec<f32> = given.needed("normals", given.array("normals")?)?;
    let (changed, albedo): (Vec<[f32; 3]>, Vec<f32>) =
        normals.as_chunks().0.iter().map(|&normal| relief.normal(normal)).unzip();
    let dict = PyDict::new(py);
    dict.set_item("normals", triples(py, changed.into_flattened())?)?;
    let count = albedo.len();
    dict.set_item("albedo", array(py, albedo, [count])?)?;
    dict.set_item("lamp", array(py, moved.as_slice().to_vec(), [3])?)?;
    Ok(dict)
}

/// The approximation of second order of an intensity that depends on one component of the normal.
#[pyfunction]
pub fn second_order<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> Array<'py> {
    let given = Members::new(keywords, "", &["intensity"])?;
    let values = approximation(&given.needed("intensity", given.array::<f32>("intensity")?)?);
    let count = values.len();
    array(py, values, [count])
}

/// Points of each strip: column, row, depth.
#[pyfunction]
pub fn characteristic_strips<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyList>> {
    let names = ["intensity", "height", "width", "lamp", "centre", "dent", "count"];
    let given = Members::new(keywords, "", &names)?;
    let values: Vec<f32> = given.needed("intensity", given.array("intensity")?)?;
    let side = |name| given.needed(name, given.whole::<usize>(name)?);
    let size = Size { width: side("width")?, height: side("height")? };
    let centre = given.needed("centre", given.numbers::<2>("centre")?)?;
    let form = if given.flag("dent")?.unwrap_or(false) { Form::Dent } else { Form::Bump };
    let (lamp, count) = (lamp(&given)?, side("count")?);
    let found =
        outcome(py.detach(|| guarded(|| strips(ShadedImage { size, values: &values, lamp }, centre, form, count))))?;
    let points = found.into_iter().map(|strip| triples(py, strip.into_flattened()));
    PyList::new(py, points.collect::<PyResult<Vec<_>>>()?)
}
