//! The rendered rigs for JavaScript.

use js_sys::{Object, Uint8Array, Uint16Array};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};

use super::error::Thrown;
use super::output::{pinhole, plain, set};
use crate::error::{Error, ErrorKind};
use crate::scenes::rig::{RigKind, RigRequest, render};
use crate::view::{Pinhole, Size};

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(typescript_type = "RigSample")]
    pub type JsRigSample;
}

/// One frame of a rendered rig.
///
/// # Errors
/// Those of the native renderer.
#[wasm_bindgen(js_name = "sampleRig")]
pub fn sample_rig(name: &str, seed: f64, frame: f64, noise: Option<f64>) -> std::result::Result<JsRigSample, Thrown> {
    let kind = RigKind::ALL.into_iter().find(|kind| kind.name() == name);
    let Some(kind) = kind else {
        let known = RigKind::ALL.map(RigKind::name).join(", ");
        return Err(Error::new(ErrorKind::Missing, "kind", format!("\"{name}\" is unknown; known: {known}")).into());
    };
    let mut native = RigRequest::new(kind, seed as u64, frame as u32);
    native.noise = noise.unwrap_or(native.noise);
    let frame = render(&native)?;
    let image = raster(frame.colour_size, &frame.colour_camera);
    set(&image, "data", Uint8Array::from(frame.colour.as_slice()));
    let depth = raster(frame.depth_size, &frame.depth_camera);
    set(&depth, "unit", 0.001);
    set(&depth, "data", Uint16Array::from(frame.depth.as_slice()));
    let sample = object([
        ("name", format!("{name} {}", native.frame + 1).into()),
        ("image", image.into()),
        ("depth", depth.into()),
        ("pose", plain(&frame.pose)),
    ]);
    Ok(sample.unchecked_into())
}

fn raster(size: Size, camera: &Pinhole) -> Object {
    object([
        ("width", JsValue::from(size.width as f64)),
        ("height", JsValue::from(size.height as f64)),
        ("camera", pinhole(camera).into()),
    ])
}

/// A plain object with these properties, in this order.
fn object<const COUNT: usize>(properties: [(&str, JsValue); COUNT]) -> Object {
    let object = Object::new();
    properties.into_iter().for_each(|(key, value)| set(&object, key, value));
    object
}
