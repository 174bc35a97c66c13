//! The rendered rigs and pairs for JavaScript, and the suggestion of a mask: what the page shows before a run.

use js_sys::{Object, Uint8Array, Uint16Array};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};

use super::error::Thrown;
use super::output::{mask, pinhole, plain, set};
use super::pose::pose;
use crate::error::{Error, ErrorKind};
use crate::scenes::rig::{PairKind, RigKind, RigRequest, render, render_pair};
use crate::view::{Pinhole, Segmentation, SegmentationReport, Size};

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(typescript_type = "RigSample")]
    pub type JsRigSample;
    #[wasm_bindgen(typescript_type = "PairSample")]
    pub type JsPairSample;
}

/// One frame of a rendered rig. `motion`: the twelve numbers of a pose, its rotation row by row and its translation.
///
/// # Errors
/// Those of the native renderer.
#[wasm_bindgen(js_name = "sampleRig")]
pub fn sample_rig(
    name: &str,
    seed: f64,
    frame: f64,
    noise: Option<f64>,
    motion: Option<Vec<f64>>,
) -> std::result::Result<JsRigSample, Thrown> {
    let kind = RigKind::ALL.into_iter().find(|kind| kind.name() == name);
    let Some(kind) = kind else {
        let known = RigKind::ALL.map(RigKind::name).join(", ");
        return Err(Error::new(ErrorKind::Missing, "kind", format!("\"{name}\" is unknown; known: {known}")).into());
    };
    let mut native = RigRequest::new(kind, seed as u64, frame as u32);
    native.noise = noise.unwrap_or(native.noise);
    native.motion = motion.map_or(native.motion, |numbers| pose(&numbers));
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

/// A pair of the gallery.
///
/// # Errors
/// Those of the native renderer.
#[wasm_bindgen(js_name = "samplePair")]
pub fn sample_pair(name: &str) -> std::result::Result<JsPairSample, Thrown> {
    let kind = PairKind::ALL.into_iter().find(|kind| kind.name() == name);
    let Some(kind) = kind else {
        let known = PairKind::ALL.map(PairKind::name).join(", ");
        return Err(Error::new(ErrorKind::Missing, "kind", format!("\"{name}\" is unknown; known: {known}")).into());
    };
    let pair = render_pair(kind)?;
    let image = raster(pair.colour_size, &pair.colour_camera);
    set(&image, "data", Uint8Array::from(pair.colour.as_slice()));
    set(&image, "mask", mask(&pair.colour_mask));
    let depth = raster(pair.depth_size, &pair.depth_camera);
    set(&depth, "unit", 0.001);
    set(&depth, "data", Uint16Array::from(pair.depth.as_slice()));
    set(&depth, "mask", mask(&pair.depth_mask));
    let sample =
        object([("name", name.into()), ("image", image.into()), ("depth", depth.into()), ("pose", plain(&pair.pose))]);
    Ok(sample.unchecked_into())
}

/// A segmentation, whose rounds the facade runs one at a time.
#[wasm_bindgen(js_name = "Segmentation")]
pub struct JsSegmentation(Segmentation);

#[wasm_bindgen(js_class = "Segmentation")]
impl JsSegmentation {
    /// # Errors
    /// Those of the native segmentation.
    #[wasm_bindgen(constructor)]
    pub fn new(width: u32, height: u32, colours: &[u8], marks: &[u8]) -> std::result::Result<Self, Thrown> {
        let size = Size { width: width as usize, height: height as usize };
        Ok(Self(Segmentation::new(size, colours, marks)?))
    }

    /// Runs a round. Returns the rounds so far, the share of changed pixels, the share of the object, and whether the
    /// round was the last.
    pub fn step(&mut self) -> Vec<f64> {
        let SegmentationReport { rounds, changed, share, is_done } = self.0.step();
        vec![f64::from(rounds), changed, share, f64::from(u8::from(is_done))]
    }

    /// The mask: 255 on the object.
    #[must_use]
    pub fn mask(&self) -> Vec<u8> {
        self.0.mask()
    }
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
