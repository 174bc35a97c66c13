//! The calibration check and its rendered rigs for JavaScript.

use js_sys::{Array, Float32Array, Object, Uint8Array, Uint16Array};
use nalgebra::{Matrix3, Vector3};
use serde::Serialize;
use std::collections::BTreeMap;
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};

use super::error::Thrown;
use super::input::{JsDepth, JsImage, numbers, samples_of_depth, samples_of_image};
use super::output::{PlainPose, plain, plain_pose, set};
use crate::calibration::{self, CheckReport, CheckVerdict, Cue, Lens, RigCamera, RigView};
use crate::error::{Error, ErrorKind, Result};
use crate::pose::Similarity;
use crate::scenes::rig::{RigKind, RigRequest, render};
use crate::view::{Size, Transfer};

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(typescript_type = "CheckFrame")]
    pub type JsFrame;
    #[wasm_bindgen(method, getter)]
    fn image(this: &JsFrame) -> JsImage;
    #[wasm_bindgen(method, getter)]
    fn depth(this: &JsFrame) -> JsDepth;
    #[wasm_bindgen(method, getter)]
    fn name(this: &JsFrame) -> Option<String>;

    pub type JsCamera;
    #[wasm_bindgen(method, getter)]
    fn fx(this: &JsCamera) -> f64;
    #[wasm_bindgen(method, getter)]
    fn fy(this: &JsCamera) -> f64;
    #[wasm_bindgen(method, getter)]
    fn cx(this: &JsCamera) -> f64;
    #[wasm_bindgen(method, getter)]
    fn cy(this: &JsCamera) -> f64;
    #[wasm_bindgen(method, getter)]
    fn model(this: &JsCamera) -> Option<String>;
    #[wasm_bindgen(method, getter)]
    fn distortion(this: &JsCamera) -> JsValue;

    #[wasm_bindgen(typescript_type = "CheckReport")]
    pub type JsReport;
    #[wasm_bindgen(typescript_type = "RigRequest")]
    pub type JsRigRequest;
    #[wasm_bindgen(method, getter)]
    fn kind(this: &JsRigRequest) -> String;
    #[wasm_bindgen(method, getter)]
    fn seed(this: &JsRigRequest) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn frame(this: &JsRigRequest) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn noise(this: &JsRigRequest) -> Option<f64>;
    #[wasm_bindgen(typescript_type = "RigSample")]
    pub type JsRigSample;
}

/// A check under way.
#[wasm_bindgen(js_name = "CalibrationCheck")]
pub struct Check(calibration::CalibrationCheck);

#[wasm_bindgen(js_class = "CalibrationCheck")]
impl Check {
    /// Twelve numbers for each candidate: its rotation row by row and its translation.
    ///
    /// # Errors
    /// As the native constructor.
    #[wasm_bindgen(constructor)]
    pub fn new(
        frames: Vec<JsFrame>,
        names: Vec<String>,
        poses: &[f64],
        cues: Vec<String>,
    ) -> std::result::Result<Check, Thrown> {
        let views = frames.iter().enumerate().map(|(index, frame)| view(index, frame)).collect::<Result<Vec<_>>>()?;
        let candidates =
            names.into_iter().zip(poses.chunks_exact(12)).map(|(name, numbers)| (name, pose(numbers))).collect();
        let cues: Vec<Cue> = Cue::ALL.into_iter().filter(|cue| cues.iter().any(|name| name == cue.name())).collect();
        Ok(Self(calibration::CalibrationCheck::new(views, candidates, &cues)?))
    }

    /// One slice of the work; whether the report is complete.
    pub fn step(&mut self) -> bool {
        self.0.step()
    }

    /// Share of the work that is done.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.0.progress().0
    }

    /// What is being done.
    #[must_use]
    pub fn message(&self) -> String {
        self.0.progress().1.to_owned()
    }

    /// The report so far, once the candidates are judged.
    #[must_use]
    pub fn report(&self) -> Option<JsReport> {
        self.0.report().map(|report| plain_report(report).unchecked_into())
    }
}

/// Visible points and depth edges of a frame on its image: `{ points, edges }`.
///
/// # Errors
/// As the constructor of [`Check`].
#[wasm_bindgen(js_name = "overlay")]
pub fn overlay(frame: &JsFrame, numbers: &[f64]) -> std::result::Result<Object, Thrown> {
    let overlay = calibration::overlay(view(0, frame)?, &pose(numbers))?;
    let object = Object::new();
    set(&object, "points", Float32Array::from(overlay.points.as_slice()));
    set(&object, "edges", Float32Array::from(overlay.edges.as_slice()));
    Ok(object)
}

/// One frame of a rendered rig.
///
/// # Errors
/// As the native renderer.
#[wasm_bindgen(js_name = "sampleRig")]
pub fn sample_rig(request: &JsRigRequest) -> std::result::Result<JsRigSample, Thrown> {
    let name = request.kind();
    let kind = RigKind::ALL.into_iter().find(|kind| kind.name() == name);
    let Some(kind) = kind else {
        let known = RigKind::ALL.map(RigKind::name).join(", ");
        return Err(Error::new(ErrorKind::Missing, "kind", format!("\"{name}\" is unknown; known: {known}")).into());
    };
    let mut native =
        RigRequest::new(kind, request.seed().unwrap_or_default() as u64, request.frame().unwrap_or_default() as u32);
    native.noise = request.noise().unwrap_or(native.noise);
    let frame = render(&native)?;
    let (image, depth, object) = (Object::new(), Object::new(), Object::new());
    size(&image, frame.colour_size);
    set(&image, "camera", camera_object(&frame.colour_camera));
    set(&image, "data", Uint8Array::from(frame.colour.as_slice()));
    size(&depth, frame.depth_size);
    set(&depth, "camera", camera_object(&frame.depth_camera));
    set(&depth, "unit", 0.001);
    set(&depth, "data", Uint16Array::from(frame.depth.as_slice()));
    set(&object, "name", format!("{name} {}", native.frame + 1));
    set(&object, "image", image);
    set(&object, "depth", depth);
    set(&object, "pose", super::output::pose(&frame.pose));
    Ok(object.unchecked_into())
}

fn size(object: &Object, size: Size) {
    set(object, "width", size.width as f64);
    set(object, "height", size.height as f64);
}

fn camera_object(camera: &RigCamera) -> Object {
    let object = Object::new();
    for (key, value) in [("fx", camera.fx), ("fy", camera.fy), ("cx", camera.cx), ("cy", camera.cy)] {
        set(&object, key, value);
    }
    set(&object, "model", if matches!(camera.lens, Lens::Fisheye(_)) { "fisheye" } else { "brown" });
    set(&object, "distortion", camera.lens.coefficients().iter().map(|value| JsValue::from(*value)).collect::<Array>());
    object
}

fn pose(numbers: &[f64]) -> Similarity {
    let (rotation, translation) = numbers.split_at(9);
    Similarity {
        scale: 1.0,
        rotation: Matrix3::from_row_slice(rotation),
        translation: Vector3::from_column_slice(translation),
    }
}

fn view(index: usize, js: &JsFrame) -> Result<RigView> {
    let (image, depth) = (js.image(), js.depth());
    let below = |error: Error| error.below(&format!("frames[{index}]"));
    let camera_of = |value: JsValue, field: &str| {
        let camera: Option<JsCamera> = value.is_object().then(|| value.unchecked_into());
        camera.map(|camera| rig_camera(&camera, field)).transpose().map_err(below)
    };
    Ok(RigView {
        name: js.name().unwrap_or_else(|| format!("frame {}", index + 1)),
        image_size: [image.width() as usize, image.height() as usize],
        image: samples_of_image(&image),
        transfer: image.transfer().map(|name| if name == "linear" { Transfer::Linear } else { Transfer::Srgb }),
        image_mask: image.mask().map(|mask| mask.to_vec()),
        image_camera: camera_of(image.camera().into(), "image.camera")?,
        depth_size: [depth.width() as usize, depth.height() as usize],
        depth: samples_of_depth(&depth).map_err(below)?,
        unit: depth.unit(),
        depth_mask: depth.mask().map(|mask| mask.to_vec()),
        depth_camera: camera_of(depth.camera().into(), "depth.camera")?,
    })
}

fn rig_camera(js: &JsCamera, field: &str) -> Result<RigCamera> {
    let given = numbers(&js.distortion()).unwrap_or_default();
    let wrong = |needs: &str| {
        Error::new(ErrorKind::Size, "distortion", format!("needs {needs} numbers, not {}", given.len())).below(field)
    };
    let lens = if js.model().as_deref() == Some("fisheye") {
        Lens::Fisheye(<[f64; 4]>::try_from(given.clone()).map_err(|_| wrong("4"))?)
    } else if given.iter().all(|value| *value == 0.0) {
        Lens::None
    } else if matches!(given.len(), 4 | 5 | 8) {
        let mut all = [0.0; 8];
        all[..given.len()].copy_from_slice(&given);
        Lens::Brown(all)
    } else {
        return Err(wrong("4, 5 or 8"));
    };
    Ok(RigCamera { fx: js.fx(), fy: js.fy(), cx: js.cx(), cy: js.cy(), lens })
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PlainCandidate {
    verdict: &'static str,
    reason: String,
    off_degrees: f64,
    off_millimetres: f64,
    pixels: f64,
    interval: [f64; 2],
    probability: f64,
}

#[derive(Serialize)]
struct PlainHealth {
    pixels: f64,
    interval: [f64; 2],
}

#[derive(Serialize)]
struct PlainCue {
    share: f64,
    sharpness: f64,
}

#[derive(Serialize)]
struct PlainFrame<'a> {
    name: &'a str,
    share: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    note: Option<&'a str>,
}

#[derive(Serialize)]
struct PlainCurve<'a> {
    cue: &'a str,
    axis: &'a str,
    offsets: &'a [f64],
    values: &'a [f64],
}

#[derive(Serialize)]
struct PlainReport<'a> {
    verdict: &'a str,
    reason: &'a str,
    warnings: &'a [String],
    estimate: PlainPose,
    middle: [f64; 3],
    covariance: Vec<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    focal: Option<[f64; 2]>,
    health: PlainHealth,
    candidates: BTreeMap<&'a str, PlainCandidate>,
    cues: BTreeMap<&'a str, PlainCue>,
    frames: Vec<PlainFrame<'a>>,
    sensitivity: Vec<PlainCurve<'a>>,
}

const fn word(verdict: CheckVerdict) -> &'static str {
    match verdict {
        CheckVerdict::Consistent => "consistent",
        CheckVerdict::Off => "off",
        CheckVerdict::Undecided => "undecided",
    }
}

fn plain_report(report: &CheckReport) -> JsValue {
    let candidate = |one: &'_ calibration::CandidateReport| PlainCandidate {
        verdict: word(one.verdict),
        reason: one.reason.clone(),
        off_degrees: one.off_degrees,
        off_millimetres: one.off_millimetres,
        pixels: one.health.pixels,
        interval: one.health.interval,
        probability: one.probability,
    };
    plain(&PlainReport {
        verdict: word(report.verdict),
        reason: &report.reason,
        warnings: &report.warnings,
        estimate: plain_pose(&report.estimate),
        middle: report.middle,
        covariance: report.covariance.transpose().as_slice().to_vec(),
        focal: report.focal,
        health: PlainHealth { pixels: report.health.pixels, interval: report.health.interval },
        candidates: report.candidates.iter().map(|one| (one.name.as_str(), candidate(one))).collect(),
        cues: report
            .cues
            .iter()
            .map(|cue| (cue.cue.name(), PlainCue { share: cue.share, sharpness: cue.sharpness }))
            .collect(),
        frames: report
            .frames
            .iter()
            .map(|frame| PlainFrame { name: &frame.name, share: frame.share, note: frame.note.as_deref() })
            .collect(),
        sensitivity: report
            .sensitivity
            .iter()
            .map(|curve| PlainCurve {
                cue: curve.cue.name(),
                axis: curve.axis,
                offsets: &curve.offsets,
                values: &curve.values,
            })
            .collect(),
    })
}
