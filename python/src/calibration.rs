//! The check of a calibration for Python, and the rendered rigs on which it is tested.

use bimodal_stereo::scenes::rig::{RigKind, RigRequest, render};
use bimodal_stereo::{CalibrationCheck, Cue, RigView, Size, overlay};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};

use crate::arrays::{array, triples};
use crate::cameras::{pinhole, plain};
use crate::error::{failure, outcome, unbroken};
use crate::guard::{Guarded, guarded};
use crate::input::{Raster, extrinsics};
use crate::members::{Members, unknown};
use crate::report;

type Dict<'py> = PyResult<Bound<'py, PyDict>>;

/// Runs the check. Between its slices it calls `on_progress(share, message)` and handles the interpreter's signals.
#[pyfunction]
pub fn check_calibration<'py>(
    py: Python<'py>,
    frames: Vec<Bound<'py, PyAny>>,
    candidates: Vec<(String, Bound<'py, PyAny>)>,
    cues: Vec<String>,
    on_progress: Option<Bound<'py, PyAny>>,
) -> Dict<'py> {
    let views = frames.iter().enumerate().map(|(index, frame)| view(index, frame)).collect::<PyResult<Vec<_>>>()?;
    let pose = |(name, pose): (String, Bound<'py, PyAny>)| {
        let own = extrinsics(&pose, &format!("candidates.{name}"))?;
        Ok::<_, PyErr>((name, own))
    };
    let candidates = candidates.into_iter().map(pose).collect::<PyResult<Vec<_>>>()?;
    let cues = cues.iter().map(|name| cue(name)).collect::<PyResult<Vec<_>>>()?;
    let check = Guarded::new(outcome(py.detach(|| guarded(|| CalibrationCheck::new(views, candidates, &cues))))?);
    loop {
        py.check_signals()?;
        let (is_done, progress) = unbroken(py.detach(|| check.call(|check| (check.step(), check.progress()))))?;
        if let Some(tell) = &on_progress {
            tell.call1(progress)?;
        }
        if is_done {
            break;
        }
    }
    let report = unbroken(check.call(|check| check.report().cloned()))?;
    report::plain(py, &report.ok_or_else(|| failure("internal", "check_calibration", "ended without a report"))?)
}

/// Projects the visible points and the depth edges of a frame onto its image under a pose.
#[pyfunction]
pub fn project_frame<'py>(py: Python<'py>, frame: &Bound<'py, PyAny>, pose: &Bound<'py, PyAny>) -> Dict<'py> {
    let (view, pose) = (view(0, frame)?, extrinsics(pose, "pose")?);
    let found = outcome(py.detach(|| guarded(|| overlay(view, &pose))))?;
    let count = found.edges.len() / 2;
    let dict = PyDict::new(py);
    dict.set_item("points", triples(py, found.points)?)?;
    dict.set_item("positions", triples(py, found.positions)?)?;
    dict.set_item("edges", array(py, found.edges, [count, 2])?)?;
    Ok(dict)
}

fn cue(name: &str) -> PyResult<Cue> {
    let found = Cue::ALL.into_iter().find(|cue| cue.name() == name);
    found.ok_or_else(|| unknown("cues", name, Cue::ALL.iter().map(|cue| cue.name())))
}

fn view(index: usize, frame: &Bound<'_, PyAny>) -> PyResult<RigView> {
    let path = format!("frames[{index}]");
    let frame = Members::new(frame, &path, &["image", "depth", "name"])?;
    let member = |name| frame.needed(name, frame.get(name)?);
    let image = Raster::image(&member("image")?, &frame.at("image"))?;
    let depth = Raster::depth(&member("depth")?, &frame.at("depth"))?;
    if depth.members.get("normals")?.is_some() {
        return Err(failure("option", &depth.members.at("normals"), "a check does not use normals"));
    }
    Ok(RigView {
        name: frame.text("name")?.unwrap_or_else(|| format!("frame {}", index + 1)),
        image_size: image.size,
        image: image.colours()?,
        transfer: image.transfer()?,
        image_camera: pinhole(&image.members)?,
        image_mask: image.mask,
        depth_size: depth.size,
        depth: depth.depths()?,
        unit: depth.members.number("unit")?,
        intensity: depth.members.array("intensity")?,
        depth_camera: pinhole(&depth.members)?,
        depth_mask: depth.mask,
    })
}

/// One frame of a rendered rig.
#[pyfunction]
pub fn sample_rig<'py>(py: Python<'py>, keywords: &Bound<'py, PyAny>) -> Dict<'py> {
    let given = Members::new(keywords, "", &["kind", "seed", "frame", "noise", "motion"])?;
    let kind = given.needed("kind", given.word("kind", &RigKind::ALL.map(|kind| (kind.name(), kind)))?)?;
    let mut request =
        RigRequest::new(kind, given.whole("seed")?.unwrap_or_default(), given.whole("frame")?.unwrap_or_default());
    request.noise = given.number("noise")?.unwrap_or(request.noise);
    if let Some(motion) = given.get("motion")? {
        request.motion = extrinsics(&motion, "motion")?;
    }
    let made = outcome(py.detach(|| guarded(|| render(&request))))?;
    let image = [("camera", plain(py, &made.colour_camera)?)].into_py_dict(py)?;
    let Size { width, height } = made.colour_size;
    image.set_item("data", array(py, made.colour, [height, width, 4])?)?;
    let depth = [("camera", plain(py, &made.depth_camera)?)].into_py_dict(py)?;
    let Size { width, height } = made.depth_size;
    depth.set_item("data", array(py, made.depth, [height, width])?)?;
    depth.set_item("unit", 0.001)?;
    let dict = [("image", image), ("depth", depth), ("pose", report::plain(py, &made.pose)?)].into_py_dict(py)?;
    dict.set_item("name", format!("{} {}", kind.name(), u64::from(request.frame) + 1))?;
    Ok(dict)
}
