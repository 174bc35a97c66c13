//! Functions for the lessons: one lamp and its strips, the objective of one pixel, a surface from given normals. Numbers arrive in plain
//! rows, checked and ordered by the facade, because objects would add to the download.

use js_sys::{Array, Float32Array, Float64Array};
use wasm_bindgen::JsCast;
use wasm_bindgen::prelude::wasm_bindgen;

use super::error::Thrown;
use crate::lessons::{
    BasRelief, Form, Lamp, Minimum, PixelLandscape, ShadedImage, characteristic_strips, second_order,
    surface_of_normals,
};
use crate::light::Light;
use crate::shape::ShadingWeights;
use crate::view::{Normals, Size};

type Result<T> = std::result::Result<T, Thrown>;

#[wasm_bindgen]
extern "C" {
    /// Objective, minima and path.
    #[wasm_bindgen(typescript_type = "[Float32Array, Float32Array, Float32Array]")]
    pub type JsLandscape;
    /// Normals, albedo, lamp.
    #[wasm_bindgen(typescript_type = "[Float32Array, Float32Array, Float64Array]")]
    pub type JsRelieved;
}

/// A lamp from three numbers; NaN where one is missing.
#[inline(never)]
fn lamp(numbers: &[f64]) -> Lamp {
    Lamp([0, 1, 2].map(|axis| numbers.get(axis).copied().unwrap_or(f64::NAN)).into())
}

/// Intensity of each normal, three numbers each, under one lamp.
#[wasm_bindgen(js_name = "shadeLamp")]
#[must_use]
pub fn shade_lamp(toward: &[f64], normals: &[f32]) -> Float32Array {
    let lamp = lamp(toward);
    let shaded: Vec<f32> = normals.as_chunks().0.iter().map(|&normal| lamp.shade(normal)).collect();
    Float32Array::from(shaded.as_slice())
}

/// A surface that looks the same from the front: its normals, its albedo and its lamp.
#[wasm_bindgen(js_name = "basRelief")]
#[must_use]
pub fn bas_relief(stretch: f64, right: f64, down: f64, toward: &[f64], normals: &[f32]) -> JsRelieved {
    let relief = BasRelief { stretch, slopes: [right, down] };
    let (changed, albedo): (Vec<[f32; 3]>, Vec<f32>) =
        normals.as_chunks().0.iter().map(|&normal| relief.normal(normal)).unzip();
    let Lamp(moved) = relief.lamp(lamp(toward));
    let [changed, albedo] = [changed.as_flattened(), albedo.as_slice()].map(Float32Array::from);
    Array::of3(&changed, &albedo, &Float64Array::from(moved.as_slice())).unchecked_into()
}

/// The approximation of second order of an intensity that depends on one component of the normal.
#[wasm_bindgen(js_name = "secondOrder")]
#[must_use]
pub fn second_order_of(values: &[f32]) -> Float32Array {
    Float32Array::from(second_order(values).as_slice())
}

/// Strips from a bright spot, three numbers per point, with a point of NaN after each strip.
#[wasm_bindgen(js_name = "characteristicStrips")]
pub fn strips(
    values: &[f32],
    width: u32,
    height: u32,
    toward: &[f64],
    centre: &[f64],
    dent: bool,
    count: u32,
) -> Result<Float32Array> {
    let size = Size { width: width as usize, height: height as usize };
    let form = if dent { Form::Dent } else { Form::Bump };
    let centre = [0, 1].map(|axis| centre.get(axis).copied().unwrap_or(f64::NAN));
    let image = ShadedImage { size, values, lamp: lamp(toward) };
    let found = characteristic_strips(image, centre, form, count as usize)?;
    let mut points = Vec::new();
    for strip in found {
        points.extend(strip);
        points.push([f32::NAN; 3]);
    }
    Ok(Float32Array::from(points.as_flattened()))
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

/// Three numbers that begin at an index; NaN beyond the end.
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
