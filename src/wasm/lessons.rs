//! Functions for the lessons: the objective of one pixel, and a surface from given normals. Numbers arrive in plain
//! rows, checked and ordered by the facade, because objects would add to the download.

use js_sys::{Array, Float32Array};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::wasm_bindgen;

use super::error::Thrown;
use crate::light::Light;
use crate::shape::{Minimum, PixelLandscape, ShadingWeights, surface_of_normals};
use crate::view::{Normals, Size};

type Result<T> = std::result::Result<T, Thrown>;

#[wasm_bindgen]
extern "C" {
    /// Objective, minima and path.
    #[wasm_bindgen(typescript_type = "[Float32Array, Float32Array, Float32Array]")]
    pub type JsLandscape;
}

#[inline(never)]
fn light(values: &[f64]) -> Result<Light> {
    Ok(Light::from_slice("light", values)?)
}

/// Normals from all x, then all y, then all z.
fn normals(planes: &[f32]) -> Normals {
    let (x, rest) = planes.split_at(planes.len() / 3);
    let (y, z) = rest.split_at(x.len());
    Normals { x: x.to_vec(), y: y.to_vec(), z: z[..x.len()].to_vec() }
}

/// Three numbers from an index on; NaN beyond the end.
#[inline(never)]
fn three(numbers: &[f64], place: usize) -> [f32; 3] {
    [0, 1, 2].map(|axis| numbers.get(place + axis).map_or(f32::NAN, |&value| value as f32))
}

/// Depth of the surface with these normals.
#[wasm_bindgen(js_name = "integrateNormals")]
pub fn integrate_normals(planes: &[f32], width: u32, height: u32, robust: bool) -> Result<Float32Array> {
    let size = Size { width: width as usize, height: height as usize };
    Ok(Float32Array::from(surface_of_normals(size, &normals(planes), robust)?.as_slice()))
}

/// The objective of one pixel over the visible hemisphere. The numbers: log S, prior (NaN if there is no prior), start,
/// lambda_2.
#[wasm_bindgen(js_name = "pixelLandscape")]
pub fn pixel_landscape(coefficients: &[f64], numbers: &[f64], robust: bool, side: u32) -> Result<JsLandscape> {
    let mut weights = ShadingWeights::with_robust_prior(three(numbers, 9)[0], 1.0);
    if !robust {
        weights.robust = None;
    }
    let [log, prior, start] = [0, 3, 6].map(|place| three(numbers, place));
    let found = PixelLandscape::new(log, prior, &light(coefficients)?, weights, start, side as usize);
    let mut minima = Vec::with_capacity(found.minima.len());
    for &Minimum { normal: [x, y, z], objective, share } in &found.minima {
        minima.push([x, y, z, objective, share]);
    }
    let [objective, minima, path] =
        [found.objective.as_slice(), minima.as_flattened(), found.path.as_flattened()].map(Float32Array::from);
    Ok(Array::of3(&objective, &minima, &path).unchecked_into())
}
