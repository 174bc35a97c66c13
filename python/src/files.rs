//! Files of a rig for Python: the whole command `check`, and the readers of calibrations and folders.

use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use bimodal_stereo::{ColourSamples, DepthSamples, RigView, Transfer};
use bimodal_stereo_files::command::{self, Terminal};
use bimodal_stereo_files::read::{self, Raster};
use bimodal_stereo_files::{self as files, FolderOptions, NamedCamera, NamedPose, Problem, Warning, colour};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

use crate::arrays::array;
use crate::cameras;
use crate::error::{BimodalError, unbroken};
use crate::guard::guarded;
use crate::report;

type Dict<'py> = PyResult<Bound<'py, PyDict>>;

/// A Python function that takes text.
struct Text(Py<PyAny>);

impl Write for Text {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let text = String::from_utf8_lossy(bytes);
        let written = Python::attach(|py| self.0.call1(py, (text,)).map(drop));
        written.map(|()| bytes.len()).map_err(|_| io::Error::from(io::ErrorKind::BrokenPipe))
    }

    /// Writes each text in one call.
    fn write_fmt(&mut self, words: std::fmt::Arguments<'_>) -> io::Result<()> {
        self.write_all(words.to_string().as_bytes())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// Runs `check` with these arguments; returns the exit code.
#[pyfunction]
pub fn check_command(
    py: Python<'_>,
    arguments: Vec<OsString>,
    write: Py<PyAny>,
    write_error: Py<PyAny>,
    is_terminal: bool,
) -> PyResult<u8> {
    let run = || {
        command::run(
            arguments,
            &mut Terminal {
                out: &mut Text(write),
                err: &mut Text(write_error),
                is_terminal,
                is_interrupted: &mut || Python::attach(|py| py.check_signals().is_err()),
            },
        )
    };
    unbroken(py.detach(|| guarded(run)))
}

/// The error of a file that cannot be read or written.
pub fn refused(problem: &Problem) -> PyErr {
    BimodalError::new_err((problem.code, problem.to_string(), problem.field.clone()))
}

/// The cameras and poses of one file.
#[pyfunction]
pub fn read_calibration(py: Python<'_>, path: PathBuf) -> Dict<'_> {
    let read = unbroken(py.detach(|| guarded(|| files::read_calibration(&path))))?;
    let found = read.map_err(|problem| refused(&problem))?;
    let dict = PyDict::new(py);
    dict.set_item("cameras", named_cameras(py, &found.cameras)?)?;
    dict.set_item("poses", poses(py, &found.poses)?)?;
    dict.set_item("says", files::says(&found))?;
    dict.set_item("warnings", warnings(py, &found.warnings.0)?)?;
    Ok(dict)
}

/// The frames of a folder, and the other content of its files.
#[pyfunction]
pub fn read_rig_folder(
    py: Python<'_>,
    path: PathBuf,
    unit: Option<f64>,
    frames: Option<usize>,
    camera_files: Vec<PathBuf>,
) -> Dict<'_> {
    let options = FolderOptions { unit, frames, cameras: camera_files, except: Vec::new() };
    let read = unbroken(py.detach(|| guarded(|| files::read_rig_folder(&path, &options))))?;
    let found = read.map_err(|problem| refused(&problem))?;
    let dict = PyDict::new(py);
    dict.set_item("frames", found.frames.into_iter().map(|view| frame(py, view)).collect::<PyResult<Vec<_>>>()?)?;
    dict.set_item("cameras", named_cameras(py, &found.cameras)?)?;
    dict.set_item("poses", poses(py, &found.poses)?)?;
    dict.set_item("warnings", warnings(py, &found.warnings)?)?;
    Ok(dict)
}

/// A file's raster, read without the interpreter's lock.
fn raster(py: Python<'_>, path: &Path) -> PyResult<Raster> {
    unbroken(py.detach(|| guarded(|| read::raster(path))))?.map_err(|problem| refused(&problem))
}

/// A colour image.
#[pyfunction]
pub fn read_image(py: Python<'_>, path: PathBuf) -> Dict<'_> {
    let raster = raster(py, &path)?;
    let dict = PyDict::new(py);
    dict.set_item("data", samples(py, colour::colours(&raster), [raster.height, raster.width])?)?;
    dict.set_item("transfer", colour::transfer(&raster).map(transfer_name))?;
    dict.set_item("warnings", warnings(py, &raster.warnings)?)?;
    Ok(dict)
}

/// A depth map or an organised cloud. If `is_metric`, it is in metres, and the metres per stored unit are guessed unless
/// given; otherwise its unit is the pixel.
#[pyfunction]
pub fn read_depth(py: Python<'_>, path: PathBuf, unit: Option<f64>, is_metric: bool) -> Dict<'_> {
    let raster = raster(py, &path)?;
    let size = [raster.height, raster.width];
    let of_file = raster.warnings.clone();
    let given = if is_metric { unit } else { Some(unit.unwrap_or(1.0)) };
    let read = unbroken(py.detach(|| guarded(|| files::depth_of(raster, given))))?;
    let found = read.map_err(|reason| refused(&Problem::file(&path, reason)))?;
    let dict = depths(py, found.samples, size)?;
    dict.set_item("unit", found.unit)?;
    // Warnings about metres do not apply to pixels, and around a single object most of a depth map is often empty.
    let mut told = if is_metric { found.warnings.0 } else { of_file };
    told.retain(|warning| warning.code != "many-holes");
    dict.set_item("warnings", warnings(py, &told)?)?;
    Ok(dict)
}

/// A mask that is true where a picture is neither zero nor transparent.
#[pyfunction]
pub fn read_mask(py: Python<'_>, path: PathBuf) -> PyResult<Bound<'_, PyAny>> {
    let raster = raster(py, &path)?;
    let inside = colour::mask(&raster).into_iter().map(|value| value != 0).collect();
    array(py, inside, [raster.height, raster.width])
}

fn transfer_name(transfer: Transfer) -> &'static str {
    if transfer == Transfer::Linear { "linear" } else { "srgb" }
}

fn samples(py: Python<'_>, all: ColourSamples, [height, width]: [usize; 2]) -> PyResult<Bound<'_, PyAny>> {
    match all {
        ColourSamples::Rgba8(data) => array(py, data, [height, width, 4]),
        ColourSamples::Rgba16(data) => array(py, data, [height, width, 4]),
        ColourSamples::RgbLinear(data) => array(py, data, [height, width, 3]),
    }
}

fn depths(py: Python<'_>, all: DepthSamples, [height, width]: [usize; 2]) -> Dict<'_> {
    let dict = PyDict::new(py);
    match all {
        DepthSamples::Integer(data) => dict.set_item("data", array(py, data, [height, width])?)?,
        DepthSamples::Float(data) => dict.set_item("data", array(py, data, [height, width])?)?,
        DepthSamples::Cloud(data) => dict.set_item("points", array(py, data, [height, width, 3])?)?,
    }
    Ok(dict)
}

fn warnings<'py>(py: Python<'py>, all: &[Warning]) -> PyResult<Bound<'py, PyList>> {
    let plain = |one: &Warning| {
        let dict = PyDict::new(py);
        dict.set_item("code", one.code)?;
        dict.set_item("message", &one.message)?;
        dict.set_item("field", &one.field)?;
        Ok(dict)
    };
    PyList::new(py, all.iter().map(plain).collect::<PyResult<Vec<_>>>()?)
}

fn named_cameras<'py>(py: Python<'py>, all: &[NamedCamera]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let plain = |one: &NamedCamera| {
        let dict = PyDict::new(py);
        dict.set_item("name", &one.name)?;
        dict.set_item("camera", cameras::plain(py, &one.camera)?)?;
        dict.set_item("size", one.size.map(<(usize, usize)>::from))?;
        Ok(dict)
    };
    all.iter().map(plain).collect()
}

fn poses<'py>(py: Python<'py>, all: &[NamedPose]) -> PyResult<Vec<Bound<'py, PyDict>>> {
    let plain = |one: &NamedPose| {
        let dict = PyDict::new(py);
        dict.set_item("name", &one.names.name)?;
        dict.set_item("source", &one.names.from)?;
        dict.set_item("target", &one.names.to)?;
        dict.set_item("pose", report::plain(py, &one.pose)?)?;
        Ok(dict)
    };
    all.iter().map(plain).collect()
}

fn frame(py: Python<'_>, view: RigView) -> Dict<'_> {
    let image = PyDict::new(py);
    let [width, height] = view.image_size;
    image.set_item("data", samples(py, view.image, [height, width])?)?;
    image.set_item("transfer", view.transfer.map(transfer_name))?;
    image.set_item("mask", view.image_mask.map(|mask| array(py, mask, [height, width])).transpose()?)?;
    image.set_item("camera", view.image_camera.map(|own| cameras::plain(py, &own)).transpose()?)?;
    let [width, height] = view.depth_size;
    let depth = depths(py, view.depth, [height, width])?;
    depth.set_item("unit", view.unit)?;
    depth.set_item("mask", view.depth_mask.map(|mask| array(py, mask, [height, width])).transpose()?)?;
    depth.set_item("camera", view.depth_camera.map(|own| cameras::plain(py, &own)).transpose()?)?;
    let dict = PyDict::new(py);
    dict.set_item("image", image)?;
    dict.set_item("depth", depth)?;
    dict.set_item("name", view.name)?;
    Ok(dict)
}
