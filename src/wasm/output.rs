//! From native reports and rasters to the objects of the JavaScript contract.

use js_sys::{Array, Float32Array, Object, Reflect, Uint8Array};
use wasm_bindgen::{JsValue, UnwrapThrowExt};

use crate::pose::{Angles, Similarity, Uncertainty};
use crate::report::{Objective, StepReport};
use crate::view::{Camera, Pinhole};

/// Sets a property of a plain object, which can't fail.
pub fn set(object: &Object, key: &str, value: impl Into<JsValue>) {
    Reflect::set(object, &key.into(), &value.into()).unwrap_throw();
}

/// A plain object of these properties, in this order.
pub fn object<const COUNT: usize>(properties: [(&str, JsValue); COUNT]) -> Object {
    let object = Object::new();
    properties.into_iter().for_each(|(key, value)| set(&object, key, value));
    object
}

pub fn numbers(values: impl IntoIterator<Item = f64>) -> JsValue {
    values.into_iter().map(JsValue::from_f64).collect::<Array>().into()
}

pub fn pose(pose: &Similarity) -> JsValue {
    let Angles { alpha, beta, gamma } = Angles::of(&pose.rotation);
    object([
        ("scale", pose.scale.into()),
        ("rotation", numbers(pose.rotation.transpose().iter().copied())),
        ("translation", numbers(pose.translation.iter().copied())),
        ("angles", object([("alpha", alpha.into()), ("beta", beta.into()), ("gamma", gamma.into())]).into()),
    ])
    .into()
}

fn objective(terms: &Objective) -> JsValue {
    object([
        ("shading", terms.shading.into()),
        ("prior", terms.prior.into()),
        ("registration", terms.registration.into()),
        ("refinement", terms.refinement.into()),
        ("total", terms.total().into()),
    ])
    .into()
}

/// A sigma that does not exist is null, as the contract says.
fn uncertainty(sigma: &Uncertainty) -> JsValue {
    let known = |value: Option<f64>| value.map_or(JsValue::NULL, JsValue::from_f64);
    object([
        ("rotationDegrees", numbers(sigma.rotation_degrees)),
        ("translation", sigma.translation.map(known).into_iter().collect::<Array>().into()),
        ("scale", known(sigma.scale)),
        ("weakest", sigma.weakest.as_str().into()),
    ])
    .into()
}

pub fn report(report: &StepReport, milliseconds: &[(&'static str, f64)]) -> JsValue {
    let plain = object([
        ("iteration", report.iteration.into()),
        ("stage", report.stage.name().into()),
        ("pose", pose(&report.pose)),
        ("rotationChange", report.rotation_change.into()),
        ("energy", objective(&report.objective)),
        ("overlap", report.overlap.into()),
        ("inliers", report.inliers.into()),
        ("residual", report.residual.into()),
        ("status", report.status.name().into()),
    ]);
    if let Some(message) = &report.message {
        set(&plain, "message", message.as_str());
    }
    if !report.rivals.is_empty() {
        set(&plain, "rivals", report.rivals.iter().map(pose).collect::<Array>());
    }
    if let Some(sigma) = &report.uncertainty {
        set(&plain, "uncertainty", uncertainty(sigma));
    }
    let times = Object::new();
    milliseconds.iter().for_each(|&(stage, time)| set(&times, stage, time));
    set(&plain, "milliseconds", times);
    plain.into()
}

/// A camera of the contract; an orthographic one is the absence of one.
pub fn camera(camera: &Camera) -> JsValue {
    let Camera::Pinhole(Pinhole { fx, fy, cx, cy, distortion }) = camera else { return JsValue::UNDEFINED };
    let object = Object::new();
    for (key, value) in [("fx", fx), ("fy", fy), ("cx", cx), ("cy", cy)] {
        set(&object, key, *value);
    }
    set(&object, "distortion", numbers(*distortion));
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
