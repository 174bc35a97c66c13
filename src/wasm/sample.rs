//! Rendered scenes for JavaScript.

use js_sys::{Float32Array, Float64Array, Object};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};

use super::error::Thrown;
use super::input::{JsAngles, angles, numbers};
use super::output::{mask, pinhole, plain as shaped, set};
use crate::error::Result;
use crate::light::Light;
use crate::scenes::{DepthData, Relief, Sample, SampleRequest, Scene, bare_grid, bound, lights, surfaces};
use crate::view::{Camera, Size};

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(typescript_type = "SampleRequest")]
    pub type JsRequest;
    #[wasm_bindgen(method, getter)]
    fn surface(this: &JsRequest) -> JsValue;
    #[wasm_bindgen(method, getter)]
    fn light(this: &JsRequest) -> JsValue;
    #[wasm_bindgen(method, getter)]
    fn size(this: &JsRequest) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn height(this: &JsRequest) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn angles(this: &JsRequest) -> Option<JsAngles>;
    #[wasm_bindgen(method, getter)]
    fn protocol(this: &JsRequest) -> Option<String>;
    #[wasm_bindgen(method, getter)]
    fn scale(this: &JsRequest) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn overlap(this: &JsRequest) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn noise(this: &JsRequest) -> Option<f64>;
    #[wasm_bindgen(method, getter, js_name = "depthNoise")]
    fn depth_noise(this: &JsRequest) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn holes(this: &JsRequest) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn seed(this: &JsRequest) -> Option<f64>;

    pub type JsRelief;
    #[wasm_bindgen(method, getter)]
    fn width(this: &JsRelief) -> f64;
    #[wasm_bindgen(method, getter)]
    fn height(this: &JsRelief) -> f64;
    #[wasm_bindgen(method, getter)]
    fn heights(this: &JsRelief) -> Float32Array;

    #[wasm_bindgen(typescript_type = "Sample")]
    pub type JsSample;
}

/// Names of the built-in surfaces.
#[wasm_bindgen(js_name = "sampleSurfaces")]
#[must_use]
pub fn sample_surfaces() -> Vec<String> {
    surfaces::NAMES.map(String::from).to_vec()
}

/// Names of the built-in lights.
#[wasm_bindgen(js_name = "sampleLights")]
#[must_use]
pub fn sample_lights() -> Vec<String> {
    lights::NAMES.map(String::from).to_vec()
}

/// Renders both views of a surface.
#[wasm_bindgen]
pub fn sample(request: &JsRequest) -> std::result::Result<JsSample, Thrown> {
    let made = make(request).map_err(|error| error.below("sample"))?;
    Ok(plain(&made).unchecked_into())
}

/// The lowest rotation error that any estimator can attain on this scene, degrees.
#[wasm_bindgen(js_name = "sampleBound")]
pub fn sample_bound(request: &JsRequest, light_is_known: bool) -> std::result::Result<Option<f64>, Thrown> {
    let made = make(request).map_err(|error| error.below("sample"))?;
    Ok(bound(&made, light_is_known, request.noise().unwrap_or_default()))
}

/// The 27 coefficients of a named or given light, rotated by angles.
#[wasm_bindgen(js_name = "turnLight")]
pub fn turn_light(given: &JsValue, turn: &JsAngles) -> std::result::Result<Float64Array, Thrown> {
    Ok(Float64Array::from(light(given)?.turned(&angles(turn).rotation()).flat().as_slice()))
}

/// log S of each normal; normals and results are sequences of three numbers.
#[wasm_bindgen(js_name = "shadeNormals")]
pub fn shade_normals(given: &JsValue, normals: &Float32Array) -> std::result::Result<Float32Array, Thrown> {
    let light = light(given)?;
    let normals = normals.to_vec();
    let shade = |normal: &[f32; 3]| light.shade(normal.map(f64::from)).map(|log| log as f32);
    let shaded: Vec<f32> = normals.as_chunks().0.iter().flat_map(shade).collect();
    Ok(floats(&shaded))
}

fn light(js: &JsValue) -> Result<Light> {
    match numbers(js) {
        Some(values) => Light::from_slice("light", &values),
        None => lights::light(&js.as_string().unwrap_or_default()),
    }
}

fn make(js: &JsRequest) -> Result<Sample> {
    let relief = relief(&js.surface())?;
    let request = request(js)?;
    match js.protocol().as_deref() {
        Some("grid") => bare_grid(&relief, &request.light, &request.rotation, request.overlap),
        _ => Scene::new(&relief)?.sample(&request),
    }
}

fn relief(js: &JsValue) -> Result<Relief> {
    if let Some(name) = js.as_string() {
        return surfaces::surface(&name);
    }
    let given: &JsRelief = js.unchecked_ref();
    Relief::new(given.width() as usize, given.height() as usize, given.heights().to_vec())
}

fn request(js: &JsRequest) -> Result<SampleRequest> {
    let default = SampleRequest::default();
    let width = js.size().map_or(default.size.width, |size| size as usize);
    let height = js.height().map_or(width, |height| height as usize);
    Ok(SampleRequest {
        light: light(&js.light())?,
        size: Size { width, height },
        rotation: js.angles().map_or(default.rotation, |given| angles(&given).rotation()),
        scale: js.scale().unwrap_or(default.scale),
        overlap: js.overlap().unwrap_or(default.overlap),
        noise: js.noise().unwrap_or(default.noise),
        depth_noise: js.depth_noise().unwrap_or(default.depth_noise),
        holes: js.holes().unwrap_or(default.holes),
        seed: js.seed().map_or(default.seed, |seed| seed as u64),
        ..default
    })
}

fn floats(values: &[f32]) -> Float32Array {
    Float32Array::from(values)
}

fn plain(sample: &Sample) -> Object {
    let image = view(sample.image.size, &sample.image.mask, &sample.image.camera);
    set(&image, "data", floats(&sample.image.colours));

    let depth = view(sample.depth.size, &sample.depth.mask, &sample.depth.camera);
    match &sample.depth.data {
        DepthData::Map(data) => set(&depth, "data", floats(data)),
        DepthData::Cloud { points, normals } => {
            set(&depth, "points", floats(&points.interleaved()));
            set(&depth, "normals", floats(&normals.interleaved()));
        }
    }

    let truth = Object::new();
    set(&truth, "imageNormals", floats(&sample.truth.image_normals.interleaved()));
    set(&truth, "imageDepth", floats(&sample.truth.image_depth));
    set(&truth, "depthNormals", floats(&sample.truth.depth_normals.interleaved()));
    set(&truth, "depth", floats(&sample.truth.depth));

    let object = Object::new();
    set(&object, "image", image);
    set(&object, "depth", depth);
    set(&object, "light", Float64Array::from(sample.light.flat().as_slice()));
    set(&object, "pose", shaped(&sample.pose));
    set(&object, "truth", truth);
    object
}

fn view(size: Size, inside: &[bool], camera: &Camera) -> Object {
    let object = Object::new();
    set(&object, "width", size.width as f64);
    set(&object, "height", size.height as f64);
    set(&object, "mask", mask(inside));
    // An orthographic camera is represented by no camera.
    if let Camera::Pinhole(camera) = camera {
        set(&object, "camera", pinhole(camera));
    }
    object
}
