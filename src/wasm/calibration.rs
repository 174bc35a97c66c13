//! The calibration check for JavaScript.

use js_sys::{Float32Array, Object};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::wasm_bindgen;

use super::error::Thrown;
use super::input::{JsDepth, JsImage, JsPinhole, pinhole, samples_of_depth, samples_of_image};
use super::output::{plain, set};
use super::pose::pose;
use crate::calibration::{self, Cue, RigView};
use crate::error::{Error, Result};
use crate::view::Transfer;

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

    #[wasm_bindgen(typescript_type = "CheckReport")]
    pub type JsReport;
}

/// A check in progress.
#[wasm_bindgen(js_name = "CalibrationCheck")]
pub struct Check(calibration::CalibrationCheck);

#[wasm_bindgen(js_class = "CalibrationCheck")]
impl Check {
    /// Takes twelve numbers for each candidate: its rotation row by row and its translation.
    ///
    /// # Errors
    /// Those of the native constructor.
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

    /// Runs one slice of the work; returns whether the report is complete.
    pub fn step(&mut self) -> bool {
        self.0.step()
    }

    /// Share of the work done.
    #[must_use]
    pub fn share(&self) -> f64 {
        self.0.progress().0
    }

    /// The current activity.
    #[must_use]
    pub fn message(&self) -> String {
        self.0.progress().1.to_owned()
    }

    /// The report so far, once the candidates have been judged.
    #[must_use]
    pub fn report(&self) -> Option<JsReport> {
        self.0.report().map(|report| plain(report).unchecked_into())
    }
}

/// Visible points and depth edges of a frame on its image: `{ points, positions, edges }`.
///
/// # Errors
/// Those of the constructor of [`Check`].
#[wasm_bindgen(js_name = "overlay")]
pub fn overlay(frame: &JsFrame, numbers: &[f64]) -> std::result::Result<Object, Thrown> {
    let overlay = calibration::overlay(view(0, frame)?, &pose(numbers))?;
    let object = Object::new();
    set(&object, "points", Float32Array::from(overlay.points.as_slice()));
    set(&object, "positions", Float32Array::from(overlay.positions.as_slice()));
    set(&object, "edges", Float32Array::from(overlay.edges.as_slice()));
    Ok(object)
}

fn view(index: usize, js: &JsFrame) -> Result<RigView> {
    let (image, depth) = (js.image(), js.depth());
    let below = |error: Error| error.below(&format!("frames[{index}]"));
    let camera_of =
        |js: Option<JsPinhole>, field: &str| js.map(|camera| pinhole(&camera, field)).transpose().map_err(below);
    Ok(RigView {
        name: js.name().unwrap_or_else(|| format!("frame {}", index + 1)),
        image_size: [image.width() as usize, image.height() as usize],
        image: samples_of_image(&image),
        transfer: image.transfer().map(|name| if name == "linear" { Transfer::Linear } else { Transfer::Srgb }),
        image_mask: image.mask().map(|mask| mask.to_vec()),
        image_camera: camera_of(image.camera(), "image.camera")?,
        depth_size: [depth.width() as usize, depth.height() as usize],
        depth: samples_of_depth(&depth).map_err(below)?,
        unit: depth.unit(),
        intensity: depth.intensity().map(|intensity| intensity.to_vec()),
        depth_mask: depth.mask().map(|mask| mask.to_vec()),
        depth_camera: camera_of(depth.camera(), "depth.camera")?,
    })
}
