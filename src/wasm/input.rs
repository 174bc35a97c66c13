//! Conversion of the JavaScript contract's objects to the native inputs. JavaScript has one type for all numbers; the
//! facade has checked that sides, counts and seeds are whole and fit their types here.

use js_sys::{Float32Array, Float64Array, Uint8Array, Uint8ClampedArray, Uint16Array};
use wasm_bindgen::prelude::wasm_bindgen;
use wasm_bindgen::{JsCast, JsValue};

use crate::error::{Error, ErrorKind, Result};
use crate::options::Options;
use crate::pose::Angles;
use crate::view::{ColourImage, ColourSamples, DepthMap, DepthSamples, Lens, Pinhole, Transfer};

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
    pub fn intensity(this: &JsDepth) -> Option<Float32Array>;
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
    fn model(this: &JsPinhole) -> Option<String>;
    #[wasm_bindgen(method, getter)]
    fn distortion(this: &JsPinhole) -> JsValue;

    #[wasm_bindgen(typescript_type = "Options")]
    pub type JsOptions;

    pub type JsAngles;
    #[wasm_bindgen(method, getter)]
    fn alpha(this: &JsAngles) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn beta(this: &JsAngles) -> Option<f64>;
    #[wasm_bindgen(method, getter)]
    fn gamma(this: &JsAngles) -> Option<f64>;
}

/// Numbers from any list of numbers; `None` if the value is not an object.
pub fn numbers(value: &JsValue) -> Option<Vec<f64>> {
    value.is_object().then(|| Float64Array::new(value).to_vec())
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
        camera: js.camera().map(|camera| pinhole(&camera, "image.camera")).transpose()?,
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
        camera: js.camera().map(|camera| pinhole(&camera, "depth.camera")).transpose()?,
        normals: js.normals().map(|normals| normals.to_vec()),
    })
}

pub fn pinhole(js: &JsPinhole, field: &str) -> Result<Pinhole> {
    let coefficients = numbers(&js.distortion()).unwrap_or_default();
    let is_fisheye = js.model().is_some_and(|name| name == "fisheye");
    let lens = if is_fisheye { Lens::fisheye(&coefficients) } else { Lens::brown(&coefficients) };
    let lens = lens.map_err(|error| error.below(field))?;
    Ok(Pinhole { fx: js.fx(), fy: js.fy(), cx: js.cx(), cy: js.cy(), lens })
}

/// Options of the contract over the native defaults. The facade has checked names and types.
pub fn options(js: &JsOptions) -> Result<Options> {
    serde_path_to_error::deserialize(serde_wasm_bindgen::Deserializer::from(JsValue::from(js))).map_err(|error| {
        let field = format!("options.{}", error.path());
        Error::new(ErrorKind::Range, field, error.into_inner().to_string())
    })
}

/// Missing angles are zero.
pub fn angles(js: &JsAngles) -> Angles {
    Angles {
        alpha: js.alpha().unwrap_or_default(),
        beta: js.beta().unwrap_or_default(),
        gamma: js.gamma().unwrap_or_default(),
    }
}

/// Fills as many rasters as their concatenation holds; returns whether the last one is complete.
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
