//! From the objects of the JavaScript contract to the native inputs. JavaScript has one type for all numbers: that
//! sides, counts and seeds are whole and fit their types here has been checked by the facade.

use js_sys::{Float32Array, Float64Array, Uint8Array, Uint8ClampedArray, Uint16Array};
use nalgebra::{Matrix3, Vector3};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};

use crate::error::{Error, ErrorKind, Result};
use crate::light::Light;
use crate::options::{LightSource, Options, Registration, Shading, Start, StartTolerance, Weights};
use crate::pose::Angles;
use crate::view::{ColourImage, ColourSamples, DepthMap, DepthSamples, Pinhole, Transfer};

#[wasm_bindgen]
extern "C" {
    #[wasm_bindgen(typescript_type = "ColorImage")]
    pub type JsImage;
    #[wasm_bindgen(method, getter)]
    pub fn width(this: &JsImage) -> f64;
    #[wasm_bindgen(method, getter)]
    pub fn height(this: &JsImage) -> f64;
    #[wasm_bindgen(method, getter)]
    pub fn mask(this: &JsImage) -> Option<Uint8Array>;
    #[wasm_bindgen(method, getter)]
    pub fn camera(this: &JsImage) -> Option<JsPinhole>;
    #[wasm_bindgen(method, getter)]
    pub fn transfer(this: &JsImage) -> Option<String>;
    #[wasm_bindgen(method, getter)]
    pub fn data(this: &JsImage) -> JsValue;

    #[wasm_bindgen(typescript_type = "DepthMap")]
    pub type JsDepth;
    #[wasm_bindgen(method, getter)]
    pub fn width(this: &JsDepth) -> f64;
    #[wasm_bindgen(method, getter)]
    pub fn height(this: &JsDepth) -> f64;
    #[wasm_bindgen(method, getter)]
    pub fn mask(this: &JsDepth) -> Option<Uint8Array>;
    #[wasm_bindgen(method, getter)]
    pub fn camera(this: &JsDepth) -> Option<JsPinhole>;
    #[wasm_bindgen(method, getter)]
    pub fn unit(this: &JsDepth) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    pub fn data(this: &JsDepth) -> JsValue;
    #[wasm_bindgen(method, getter)]
    pub fn points(this: &JsDepth) -> Option<Float32Array>;
    #[wasm_bindgen(method, getter)]
    pub fn normals(this: &JsDepth) -> Option<Float32Array>;

    pub type JsPinhole;
    #[wasm_bindgen(method, getter)]
    fn fx(this: &JsPinhole) -> f64;
    #[wasm_bindgen(method, getter)]
    fn fy(this: &JsPinhole) -> f64;
    #[wasm_bindgen(method, getter)]
    fn cx(this: &JsPinhole) -> f64;
    #[wasm_bindgen(method, getter)]
    fn cy(this: &JsPinhole) -> f64;
    #[wasm_bindgen(method, getter)]
    fn distortion(this: &JsPinhole) -> JsValue;

    #[wasm_bindgen(typescript_type = "Options")]
    pub type JsOptions;
    #[wasm_bindgen(method, getter)]
    fn light(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter)]
    fn start(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter, js_name = "startTolerance")]
    fn start_tolerance(this: &JsOptions) -> Option<JsTolerance>;
    #[wasm_bindgen(method, getter)]
    fn scale(this: &JsOptions) -> JsValue;
    #[wasm_bindgen(method, getter)]
    fn registration(this: &JsOptions) -> Option<String>;
    #[wasm_bindgen(method, getter)]
    fn shading(this: &JsOptions) -> Option<String>;
    #[wasm_bindgen(method, getter)]
    fn lambda(this: &JsOptions) -> Option<JsLambda>;
    #[wasm_bindgen(method, getter)]
    fn annealing(this: &JsOptions) -> Option<bool>;
    #[wasm_bindgen(method, getter, js_name = "stopDegrees")]
    fn stop_degrees(this: &JsOptions) -> Option<f64>;
    #[wasm_bindgen(method, getter, js_name = "correspondenceDistance")]
    fn correspondence_distance(this: &JsOptions) -> Option<f64>;
    #[wasm_bindgen(method, getter, js_name = "maxIterations")]
    fn max_iterations(this: &JsOptions) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn seed(this: &JsOptions) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn trim(this: &JsOptions) -> Option<bool>;

    pub type JsTolerance;
    #[wasm_bindgen(method, getter)]
    fn degrees(this: &JsTolerance) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn distance(this: &JsTolerance) -> Option<f64>;

    pub type JsLambda;
    #[wasm_bindgen(method, getter)]
    fn prior(this: &JsLambda) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn unit(this: &JsLambda) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn light(this: &JsLambda) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn refinement(this: &JsLambda) -> Option<f64>;

    pub type JsPose;
    #[wasm_bindgen(method, getter)]
    fn scale(this: &JsPose) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn rotation(this: &JsPose) -> JsValue;
    #[wasm_bindgen(method, getter)]
    fn translation(this: &JsPose) -> JsValue;
    #[wasm_bindgen(method, getter)]
    fn angles(this: &JsPose) -> Option<JsAngles>;

    pub type JsAngles;
    #[wasm_bindgen(method, getter)]
    fn alpha(this: &JsAngles) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn beta(this: &JsAngles) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn gamma(this: &JsAngles) -> Option<f64>;
}

/// Numbers from any list of numbers; `None` where there is none.
pub fn numbers(value: &JsValue) -> Option<Vec<f64>> {
    value.is_object().then(|| Float64Array::new(value).to_vec())
}

fn exactly<const N: usize>(field: &'static str, value: &JsValue) -> Result<Option<[f64; N]>> {
    let Some(values) = numbers(value) else { return Ok(None) };
    let length = values.len();
    let wrong = || Error::new(ErrorKind::Size, field, format!("needs {N} numbers, not {length}"));
    values.try_into().map(Some).map_err(|_| wrong())
}

pub fn samples_of_image(js: &JsImage) -> ColourSamples {
    let data = js.data();
    if let Some(linear) = data.dyn_ref::<Float32Array>() {
        ColourSamples::RgbLinear(linear.to_vec())
    } else if let Some(words) = data.dyn_ref::<Uint16Array>() {
        ColourSamples::Rgba16(words.to_vec())
    } else if let Some(clamped) = data.dyn_ref::<Uint8ClampedArray>() {
        ColourSamples::Rgba8(clamped.to_vec())
    } else {
        ColourSamples::Rgba8(Uint8Array::new(&data).to_vec())
    }
}

pub fn image(js: &JsImage) -> Result<ColourImage> {
    Ok(ColourImage {
        width: js.width() as usize,
        height: js.height() as usize,
        samples: samples_of_image(js),
        transfer: js.transfer().map(|name| if name == "linear" { Transfer::Linear } else { Transfer::Srgb }),
        mask: js.mask().map(|mask| mask.to_vec()),
        camera: js.camera().map(|camera| pinhole("image.camera.distortion", &camera)).transpose()?,
    })
}

pub fn samples_of_depth(js: &JsDepth) -> Result<DepthSamples> {
    let data = js.data();
    match (js.points(), data.is_undefined()) {
        (Some(_), false) => {
            Err(Error::new(ErrorKind::Missing, "depth.points", "excludes depth.data: give one of the two"))
        }
        (None, true) => Err(Error::new(ErrorKind::Missing, "depth.data", "or depth.points is required")),
        (Some(points), true) => Ok(DepthSamples::Cloud(points.to_vec())),
        (None, false) => Ok(match data.dyn_ref::<Uint16Array>() {
            Some(words) => DepthSamples::Integer(words.to_vec()),
            None => DepthSamples::Float(Float32Array::new(&data).to_vec()),
        }),
    }
}

pub fn depth(js: &JsDepth) -> Result<DepthMap> {
    Ok(DepthMap {
        width: js.width() as usize,
        height: js.height() as usize,
        samples: samples_of_depth(js)?,
        unit: js.unit(),
        mask: js.mask().map(|mask| mask.to_vec()),
        camera: js.camera().map(|camera| pinhole("depth.camera.distortion", &camera)).transpose()?,
        normals: js.normals().map(|normals| normals.to_vec()),
    })
}

fn pinhole(distortion: &'static str, js: &JsPinhole) -> Result<Pinhole> {
    let distortion = exactly(distortion, &js.distortion())?.unwrap_or_default();
    Ok(Pinhole { fx: js.fx(), fy: js.fy(), cx: js.cx(), cy: js.cy(), distortion })
}

/// Options of the contract over the native defaults.
pub fn options(js: &JsOptions) -> Result<Options> {
    let default = Options::default();
    Ok(Options {
        light: match numbers(&js.light()) {
            Some(values) => LightSource::Known(Light::from_slice("options.light", &values)?),
            None => LightSource::Estimate,
        },
        start: match js.start().as_string().as_deref() {
            Some("identity") => Start::Identity,
            _ if js.start().is_object() => start(js.start().unchecked_ref())?,
            _ => default.start,
        },
        start_tolerance: js.start_tolerance().map_or(default.start_tolerance, |js| StartTolerance {
            degrees: js.degrees().unwrap_or(default.start_tolerance.degrees),
            distance: js.distance(),
        }),
        scale: js.scale().as_f64(),
        registration: match js.registration().as_deref() {
            Some("fixed") => Registration::Fixed,
            Some("icp") => Registration::Icp,
            _ => Registration::Joint,
        },
        shading: match js.shading().as_deref() {
            Some("pixel") => Shading::Pixel,
            _ => Shading::Surface,
        },
        weights: js.lambda().map_or(default.weights, |lambda| weights(&lambda, default.weights)),
        annealing: js.annealing().unwrap_or(default.annealing),
        stop_degrees: js.stop_degrees().unwrap_or(default.stop_degrees),
        correspondence_distance: js.correspondence_distance(),
        max_iterations: js.max_iterations().map_or(default.max_iterations, |most| most as u32),
        seed: js.seed().map_or(default.seed, |seed| seed as u64),
        trim: js.trim().unwrap_or(default.trim),
    })
}

fn weights(js: &JsLambda, default: Weights) -> Weights {
    Weights {
        prior: js.prior().unwrap_or(default.prior),
        unit: js.unit().unwrap_or(default.unit),
        light: js.light().unwrap_or(default.light),
        refinement: js.refinement().unwrap_or(default.refinement),
    }
}

fn start(js: &JsPose) -> Result<Start> {
    let rotation = match exactly::<9>("options.start.rotation", &js.rotation())? {
        Some(rows) => Matrix3::from_row_slice(&rows),
        None => js.angles().map_or_else(Matrix3::identity, |given| angles(&given).rotation()),
    };
    let translation = exactly::<3>("options.start.translation", &js.translation())?.map(Vector3::from);
    Ok(Start::Pose { rotation, scale: js.scale(), translation })
}

/// Missing angles are zero.
pub fn angles(js: &JsAngles) -> Angles {
    Angles {
        alpha: js.alpha().unwrap_or_default(),
        beta: js.beta().unwrap_or_default(),
        gamma: js.gamma().unwrap_or_default(),
    }
}

/// Takes over rasters that stand one after the other, as many as there are; whether they end with a whole one.
pub fn planes<'a>(all: &Float32Array, planes: impl IntoIterator<Item = &'a mut [f32]>) -> bool {
    let mut start = 0;
    for plane in planes {
        let end = start + plane.len() as u32;
        if end > all.length() {
            break;
        }
        all.subarray(start, end).copy_to(plane);
        start = end;
    }
    start == all.length()
}
