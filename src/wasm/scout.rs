//! A scout for JavaScript: tasks and findings are plain numbers.

use js_sys::Float64Array;
use wasm_bindgen::prelude::wasm_bindgen;

use super::error::Thrown;
use super::input::{self, JsDepth, JsImage, JsOptions};
use crate::estimator::{Scout as Native, Task};

#[wasm_bindgen]
pub struct Scout(Native);

#[wasm_bindgen]
impl Scout {
    #[wasm_bindgen(constructor)]
    pub fn new(image: &JsImage, depth: &JsDepth, options: &JsOptions) -> Result<Self, Thrown> {
        Ok(Self(Native::new(input::image(image)?, &input::depth(depth)?, input::options(options)?)?))
    }

    /// What became of a task; nothing of what is none.
    pub fn perform(&mut self, task: &Float64Array) -> Option<Float64Array> {
        let task = Task::from_numbers(&task.to_vec())?;
        Some(Float64Array::from(self.0.perform(&task).to_numbers().as_slice()))
    }
}
