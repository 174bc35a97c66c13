//! The loop for JavaScript.

use std::collections::BTreeMap;

use js_sys::{Float32Array, Float64Array, Int32Array};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::wasm_bindgen;

use super::error::Thrown;
use super::input::{self, JsDepth, JsImage, JsOptions};
use super::output;
use crate::estimator::{Estimator as Native, Finding, Surface};
use crate::options::Options;
use crate::report::Status;

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;

    #[wasm_bindgen(typescript_type = "StepReport")]
    pub type JsReport;
}

type Result<T> = std::result::Result<T, Thrown>;

/// An estimator, the options a reset without options goes back to, and the wall time of the stages that ran last: the
/// numerics have no clock.
#[wasm_bindgen]
pub struct Estimator {
    native: Native,
    options: Options,
    milliseconds: BTreeMap<&'static str, f64>,
}

#[wasm_bindgen]
impl Estimator {
    #[wasm_bindgen(constructor)]
    pub fn new(image: &JsImage, depth: &JsDepth, options: &JsOptions) -> Result<Self> {
        let options = input::options(options)?;
        let native = Native::new(input::image(image)?, &input::depth(depth)?, options.clone())?;
        Ok(Self { native, options, milliseconds: BTreeMap::new() })
    }

    pub fn step(&mut self) -> JsReport {
        self.milliseconds.clear();
        let before = self.native.report().iteration;
        loop {
            let searching = self.native.is_searching();
            self.timed_stage();
            let report = self.native.report();
            if searching || report.iteration != before || report.status != Status::Running {
                return self.report();
            }
        }
    }

    #[wasm_bindgen(js_name = "stepStage")]
    pub fn step_stage(&mut self) -> JsReport {
        self.milliseconds.clear();
        self.timed_stage();
        self.report()
    }

    fn timed_stage(&mut self) {
        let start = now();
        let stage = self.native.step_stage().stage.name();
        *self.milliseconds.entry(stage).or_default() += now() - start;
    }

    pub fn report(&self) -> JsReport {
        output::report(self.native.report(), &self.milliseconds).unchecked_into()
    }

    pub fn reset(&mut self, options: Option<JsOptions>) -> Result<()> {
        let options = options.map_or_else(|| Ok(self.options.clone()), |options| input::options(&options))?;
        self.native.reset(options.clone())?;
        self.options = options;
        self.milliseconds.clear();
        Ok(())
    }

    /// How many scouts the memory of a pair leaves room for.
    #[wasm_bindgen(js_name = "scoutsAfforded")]
    pub fn scouts_afforded(&self) -> u32 {
        self.native.scouts_afforded()
    }

    /// A part of the opening search for a scout in another thread, as plain numbers.
    #[wasm_bindgen(js_name = "takeTask")]
    pub fn take_task(&mut self) -> Option<Float64Array> {
        self.native.take_task().map(|task| Float64Array::from(task.to_numbers().as_slice()))
    }

    /// What a scout has found.
    pub fn accept(&mut self, finding: &Float64Array) {
        if let Some(finding) = Finding::from_numbers(&finding.to_vec()) {
            self.native.accept(finding);
        }
    }

    #[wasm_bindgen(js_name = "imageNormals")]
    pub fn image_normals(&self) -> Float32Array {
        Float32Array::from(self.native.image_normals().interleaved().as_slice())
    }

    #[wasm_bindgen(js_name = "imageDepth")]
    pub fn image_depth(&self) -> Float32Array {
        Float32Array::from(self.native.image_depth())
    }

    #[wasm_bindgen(js_name = "depthNormals")]
    pub fn depth_normals(&self) -> Float32Array {
        Float32Array::from(self.native.depth_normals().interleaved().as_slice())
    }

    #[wasm_bindgen(js_name = "refinedDepth")]
    pub fn refined_depth(&self) -> Float32Array {
        Float32Array::from(self.native.refined_depth())
    }

    pub fn correspondence(&self) -> Int32Array {
        Int32Array::from(self.native.correspondence())
    }

    pub fn residual(&self) -> Float32Array {
        Float32Array::from(self.native.residual())
    }

    pub fn light(&self) -> Float64Array {
        Float64Array::from(self.native.light().flat().as_slice())
    }

    /// Points of the "image" or the "depth" view; the facade has checked the word.
    pub fn points(&self, view: &str) -> Float32Array {
        let surface = if view == "depth" { Surface::Depth } else { Surface::Image };
        Float32Array::from(self.native.points(surface).as_slice())
    }
}
