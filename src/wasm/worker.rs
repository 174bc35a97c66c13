//! A worker for JavaScript. Tasks and findings are plain numbers, and rasters are concatenated.

use js_sys::{Float32Array, Float64Array};
use wasm_bindgen::prelude::wasm_bindgen;

use super::error::Thrown;
use super::input::{self, JsDepth, JsImage, JsOptions};
use super::output;
use crate::estimator::{Task, Worker as Native};

#[wasm_bindgen]
pub struct Worker(Native);

#[wasm_bindgen]
impl Worker {
    #[wasm_bindgen(constructor)]
    pub fn new(image: &JsImage, depth: &JsDepth, options: &JsOptions) -> Result<Self, Thrown> {
        Ok(Self(Native::new(input::image(image)?, &input::depth(depth)?, input::options(options)?)?))
    }

    /// The result of a task; `undefined` for numbers that are not a task.
    pub fn perform(&mut self, task: &Float64Array) -> Option<Float64Array> {
        let finding = self.0.perform(&Task::from_numbers(&task.to_vec())?).ok()?;
        Some(Float64Array::from(finding.to_numbers().as_slice()))
    }

    /// The refined shape of a task; `undefined` for numbers that are not a task.
    pub fn refine(&mut self, numbers: &Float64Array, planes: &Float32Array) -> Option<Float32Array> {
        let mut whole = false;
        let refined = self.0.refine(&numbers.to_vec(), |own| whole = input::planes(planes, own)).ok()?;
        whole.then(|| output::planes(&refined))
    }
}
