//! From native reports and rasters to the objects of the JavaScript contract.

use js_sys::{Float32Array, Object, Reflect, Uint8Array};
use serde::{Serialize, Serializer};
use wasm_bindgen::{JsValue, UnwrapThrowExt};

use crate::pose::{Angles, Similarity};
use crate::report::StepReport;
use crate::view::{Camera, Pinhole};

/// Sets a property of a plain object, which can't fail.
pub fn set(object: &Object, key: &str, value: impl Into<JsValue>) {
    Reflect::set(object, &key.into(), &value.into()).unwrap_throw();
}

#[derive(Serialize)]
pub struct PlainPose {
    scale: f64,
    rotation: Vec<f64>,
    translation: [f64; 3],
    angles: PlainAngles,
}

#[derive(Serialize)]
struct PlainAngles {
    alpha: f64,
    beta: f64,
    gamma: f64,
}

#[derive(Serialize)]
struct PlainEnergy {
    shading: f64,
    prior: f64,
    registration: f64,
    refinement: f64,
    total: f64,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PlainUncertainty<'a> {
    rotation_degrees: [f64; 3],
    translation: [Option<f64>; 3],
    scale: Option<f64>,
    weakest: &'a str,
}

#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct PlainReport<'a> {
    iteration: u32,
    stage: &'a str,
    pose: PlainPose,
    rotation_change: f64,
    energy: PlainEnergy,
    overlap: f64,
    inliers: f64,
    residual: f64,
    status: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    message: Option<&'a str>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    rivals: Vec<PlainPose>,
    #[serde(skip_serializing_if = "Option::is_none")]
    uncertainty: Option<PlainUncertainty<'a>>,
    #[serde(serialize_with = "as_map")]
    milliseconds: &'a [(&'static str, f64)],
}

fn as_map<S: Serializer>(entries: &[(&'static str, f64)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(entries.iter().copied())
}

pub fn plain(value: &impl Serialize) -> JsValue {
    // Maps become objects, and a sigma that does not exist becomes null, as the contract says.
    value.serialize(&serde_wasm_bindgen::Serializer::json_compatible()).unwrap_throw()
}

pub fn plain_pose(pose: &Similarity) -> PlainPose {
    let angles = Angles::of(&pose.rotation);
    PlainPose {
        scale: pose.scale,
        rotation: pose.rotation.transpose().as_slice().to_vec(),
        translation: pose.translation.into(),
        angles: PlainAngles { alpha: angles.alpha, beta: angles.beta, gamma: angles.gamma },
    }
}

pub fn pose(pose: &Similarity) -> JsValue {
    plain(&plain_pose(pose))
}

pub fn report(report: &StepReport, milliseconds: &[(&'static str, f64)]) -> JsValue {
    let objective = &report.objective;
    plain(&PlainReport {
        iteration: report.iteration,
        stage: report.stage.name(),
        pose: plain_pose(&report.pose),
        rotation_change: report.rotation_change,
        energy: PlainEnergy {
            shading: objective.shading,
            prior: objective.prior,
            registration: objective.registration,
            refinement: objective.refinement,
            total: objective.total(),
        },
        overlap: report.overlap,
        inliers: report.inliers,
        residual: report.residual,
        status: report.status.name(),
        message: report.message.as_deref(),
        rivals: report.rivals.iter().map(plain_pose).collect(),
        uncertainty: report.uncertainty.as_ref().map(|sigma| PlainUncertainty {
            rotation_degrees: sigma.rotation_degrees,
            translation: sigma.translation,
            scale: sigma.scale,
            weakest: &sigma.weakest,
        }),
        milliseconds,
    })
}

/// A camera of the contract; an orthographic one is the absence of one.
pub fn camera(camera: &Camera) -> JsValue {
    let Camera::Pinhole(Pinhole { fx, fy, cx, cy, distortion }) = camera else { return JsValue::UNDEFINED };
    let object = Object::new();
    for (key, value) in [("fx", fx), ("fy", fy), ("cx", cx), ("cy", cy)] {
        set(&object, key, *value);
    }
    set(&object, "distortion", plain(distortion));
    object.into()
}

/// A mask of the contract: 255 inside.
pub fn mask(mask: &[bool]) -> Uint8Array {
    let bytes: Vec<u8> = mask.iter().map(|&inside| if inside { u8::MAX } else { 0 }).collect();
    Uint8Array::from(bytes.as_slice())
}

/// Rasters one after the other.
pub fn planes(planes: &[&[f32]]) -> Float32Array {
    let length: usize = planes.iter().map(|plane| plane.len()).sum();
    let all = Float32Array::new_with_length(length as u32);
    let mut start = 0;
    for plane in planes {
        let end = start + plane.len() as u32;
        all.subarray(start, end).copy_from(plane);
        start = end;
    }
    all
}
