//! The loop for JavaScript.

use js_sys::{Array, Float32Array, Float64Array, Int32Array};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{Clamped, JsCast, UnwrapThrowExt};
use web_sys::{CanvasRenderingContext2d, ImageData, OffscreenCanvasRenderingContext2d};

use super::error::Thrown;
use super::input::{self, JsDepth, JsImage, JsOptions};
use super::output;
use crate::estimator::{Estimator as Native, Finding, RefinementTask, Surface};
use crate::options::Options;
use crate::picture::{ColourMap, Layer};
use crate::report::{Stage, Status};

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(js_namespace = performance)]
    fn now() -> f64;

    #[wasm_bindgen(typescript_type = "StepReport")]
    pub type JsReport;

    /// Number of the shape from which a refinement starts, numbers, and planes in sequence.
    #[wasm_bindgen(typescript_type = "[number, Float64Array, Float32Array]")]
    pub type JsRefinementTask;

    #[wasm_bindgen(typescript_type = "CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D")]
    pub type JsContext;
}

type Result<T> = std::result::Result<T, Thrown>;

/// An estimator, the options for a reset without options, and the wall time of the stages that ran last, because the
/// numerics have no clock.
#[wasm_bindgen]
pub struct Estimator {
    native: Native,
    options: Options,
    milliseconds: Vec<(&'static str, f64)>,
    /// Whether `step_halfway` has begun an iteration: the next step finishes it and adds to these times.
    halfway: bool,
    /// Pixels of the last picture.
    rgba: Vec<u8>,
}

#[wasm_bindgen]
impl Estimator {
    #[wasm_bindgen(constructor)]
    pub fn new(image: &JsImage, depth: &JsDepth, options: &JsOptions) -> Result<Self> {
        let options = input::options(options)?;
        let native = Native::new(input::image(image)?, &input::depth(depth)?, options.clone())?;
        Ok(Self { native, options, milliseconds: Vec::new(), halfway: false, rgba: Vec::new() })
    }

    pub fn step(&mut self) -> JsReport {
        if !std::mem::take(&mut self.halfway) {
            self.milliseconds.clear();
        }
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

    /// Like `step`, but runs a single slice of a search around an initial pose within the first iteration.
    pub fn advance(&mut self) -> JsReport {
        let report = self.native.report();
        if self.halfway || self.native.is_searching() || report.iteration > 0 || report.status != Status::Running {
            return self.step();
        }
        self.milliseconds.clear();
        loop {
            self.timed_stage();
            let report = self.native.report();
            if report.stage == Stage::Search || report.iteration > 0 || report.status != Status::Running {
                return self.report();
            }
        }
    }

    /// Runs the stages before a refinement that a worker may be running.
    #[wasm_bindgen(js_name = "stepHalfway")]
    pub fn step_halfway(&mut self) {
        if !std::mem::replace(&mut self.halfway, true) {
            self.milliseconds.clear();
        }
        while self.native.precedes_refinement() {
            self.timed_stage();
        }
    }

    /// The next refinement, for a worker that holds the shape numbered `held`.
    #[wasm_bindgen(js_name = "refinementTask")]
    pub fn refinement_task(&self, held: Option<u32>) -> Option<JsRefinementTask> {
        let RefinementTask { shape, numbers, planes } = self.native.refinement_task(held)?;
        let numbers = Float64Array::from(numbers.as_slice());
        Some(Array::of3(&shape.into(), &numbers, &output::planes(&planes)).unchecked_into())
    }

    /// Takes a worker's refinement of the shape numbered `shape`; ignores it if it is not needed.
    #[wasm_bindgen(js_name = "acceptRefinement")]
    pub fn accept_refinement(&mut self, shape: u32, planes: &Float32Array) {
        if planes.length() as usize == 4 * self.native.depth().size.len()
            && let Some(own) = self.native.accept_refinement(shape)
        {
            input::planes(planes, own);
        }
    }

    #[wasm_bindgen(js_name = "stepStage")]
    pub fn step_stage(&mut self) -> JsReport {
        self.halfway = false;
        self.milliseconds.clear();
        self.timed_stage();
        self.report()
    }

    fn timed_stage(&mut self) {
        let start = now();
        let stage = self.native.step_stage().stage.name();
        let spent = now() - start;
        match self.milliseconds.iter_mut().find(|(name, _)| *name == stage) {
            Some((_, sum)) => *sum += spent,
            None => self.milliseconds.push((stage, spent)),
        }
    }

    pub fn report(&self) -> JsReport {
        output::report(self.native.report(), &self.milliseconds).unchecked_into()
    }

    pub fn reset(&mut self, options: Option<JsOptions>) -> Result<()> {
        let options = options.map_or_else(|| Ok(self.options.clone()), |options| input::options(&options))?;
        self.native.reset(options.clone())?;
        self.options = options;
        self.halfway = false;
        self.milliseconds.clear();
        Ok(())
    }

    /// Number of workers that fit in the memory of a pair.
    #[wasm_bindgen(js_name = "workersAfforded")]
    pub fn workers_afforded(&self) -> u32 {
        self.native.workers_afforded()
    }

    /// A task of the search for a worker in another thread, as plain numbers.
    #[wasm_bindgen(js_name = "takeTask")]
    pub fn take_task(&mut self) -> Option<Float64Array> {
        self.native.take_task().map(|task| Float64Array::from(task.to_numbers().as_slice()))
    }

    /// Takes a worker's finding.
    pub fn accept(&mut self, finding: &Float64Array) {
        if let Some(finding) = Finding::from_numbers(&finding.to_vec()) {
            self.native.accept_finding(finding);
        }
    }

    #[wasm_bindgen(js_name = "imageNormals")]
    pub fn image_normals(&self) -> Float32Array {
        Float32Array::from(self.native.image_normals().interleaved().as_slice())
    }

    #[wasm_bindgen(js_name = "imageDepth")]
    pub fn image_depth(&self) -> Float32Array {
        Float32Array::from(&*self.native.image_depth())
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
        Int32Array::from(&*self.native.correspondence())
    }

    pub fn residual(&self) -> Float32Array {
        Float32Array::from(&*self.native.residual())
    }

    pub fn albedo(&self) -> Float32Array {
        Float32Array::from(self.native.albedo().as_slice())
    }

    pub fn shading(&self) -> Float32Array {
        Float32Array::from(self.native.shading().as_slice())
    }

    /// Draws a layer into the top left corner of a canvas; the facade has checked the words and the context.
    pub fn draw(&mut self, context: &JsContext, layer: &str, range: Option<Vec<f64>>, map: &str) -> Result<()> {
        let layer = Layer::ALL.into_iter().find(|known| known.name() == layer).unwrap_or(Layer::Depth);
        let map = ColourMap::ALL.into_iter().find(|known| known.name() == map).unwrap_or_default();
        let range = range.and_then(|range| range.try_into().ok());
        let size = self.native.draw(layer, range, map, &mut self.rgba)?;
        let (pixels, width, height) = (Clamped(self.rgba.as_slice()), size.width as u32, size.height as u32);
        // Sides and number of pixels agree, so neither call fails.
        let picture = ImageData::new_with_u8_clamped_array_and_sh(pixels, width, height).unwrap_throw();
        match context.dyn_ref::<OffscreenCanvasRenderingContext2d>() {
            Some(context) => context.put_image_data(&picture, 0.0, 0.0),
            None => context.unchecked_ref::<CanvasRenderingContext2d>().put_image_data(&picture, 0.0, 0.0),
        }
        .unwrap_throw();
        Ok(())
    }

    pub fn light(&self) -> Float64Array {
        Float64Array::from(self.native.light().flat().as_slice())
    }

    #[wasm_bindgen(js_name = "registeredBy")]
    pub fn registered_by(&self) -> String {
        self.native.registered_by().to_owned()
    }

    #[wasm_bindgen(js_name = "searchScores")]
    pub fn search_scores(&self) -> Float32Array {
        Float32Array::from(self.native.search_scores().as_flattened())
    }

    /// Points of the "image" or the "depth" view; the facade has checked the word.
    pub fn points(&self, view: &str) -> Float32Array {
        let surface = if view == "depth" { Surface::Depth } else { Surface::Image };
        Float32Array::from(self.native.points(surface).as_slice())
    }
}
