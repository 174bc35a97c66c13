//! Conversion of native reports and rasters to the objects of the JavaScript contract.

use js_sys::{Array, Float32Array, Object, Reflect, Uint8Array};
use serde::Serialize;
use serde_wasm_bindgen::Serializer;
use wasm_bindgen::{JsCast, JsValue, UnwrapThrowExt};

use crate::report::StepReport;
use crate::view::Pinhole;

/// Sets a property of a plain object, which can't fail.
pub fn set(object: &Object, key: &str, value: impl Into<JsValue>) {
    Reflect::set(object, &key.into(), &value.into()).unwrap_throw();
}

pub fn numbers(values: impl IntoIterator<Item = f64>) -> JsValue {
    values.into_iter().map(JsValue::from_f64).collect::<Array>().into()
}

/// A value in the contract's shape, as serialised by serde. None of this crate's values can fail.
pub fn plain(value: &impl Serialize) -> JsValue {
    value.serialize(&Serializer::json_compatible()).unwrap_throw()
}

pub fn report(report: &StepReport, milliseconds: &[(&'static str, f64)]) -> JsValue {
    let object: Object = plain(report).unchecked_into();
    let times = Object::new();
    milliseconds.iter().for_each(|&(stage, time)| set(&times, stage, time));
    set(&object, "milliseconds", times);
    object.into()
}

/// A camera as in the contract.
pub fn pinhole(camera: &Pinhole) -> Object {
    let Pinhole { fx, fy, cx, cy, lens } = camera;
    let object = Object::new();
    for (key, value) in [("fx", fx), ("fy", fy), ("cx", cx), ("cy", cy)] {
        set(&object, key, *value);
    }
    set(&object, "model", lens.model());
    let coefficients = if lens.coefficients().is_empty() { &[0.0; 5] } else { lens.coefficients() };
    set(&object, "distortion", numbers(coefficients.iter().copied()));
    object
}

/// A mask as in the contract: 255 inside.
pub fn mask(mask: &[bool]) -> Uint8Array {
    let bytes: Vec<u8> = mask.iter().map(|&inside| if inside { u8::MAX } else { 0 }).collect();
    Uint8Array::from(bytes.as_slice())
}

/// Concatenated rasters.
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
