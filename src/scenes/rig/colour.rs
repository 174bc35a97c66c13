//! The colour sensor: box-filtered light, noise that grows with the signal, 8-bit sRGB.

use super::illumination::Illumination;
use super::raster::{Hits, NOTHING, Rays};
use super::stage::Stage;
use crate::pose::Similarity;
use crate::scenes::flaws::Chance;
use crate::view::{Size, to_srgb};

/// Rays along a side of a pixel.
pub const SAMPLES: usize = 2;
/// The exposure maps this quantile of the green values to this value (1 is white).
const EXPOSED_QUANTILE: f64 = 0.97;
const EXPOSED: f64 = 0.8;
/// Stride of the values from which the exposure is computed.
const EXPOSURE_STRIDE: usize = 7;
/// Noise of a value v has the variance READ^2 + SHOT^2 v, that of a typical camera at ISO 400.
const READ: f64 = 0.002;
const SHOT: f64 = 0.012;
/// Light of a ray that meets nothing.
const BACKGROUND: f64 = 0.02;

/// Linear light of each pixel, R, G, B interleaved, before exposure.
pub fn radiance(
    stage: &Stage,
    light: &Illumination,
    placement: &Similarity,
    rays: &Rays,
    hits: &Hits,
    size: Size,
) -> Vec<f32> {
    let mut values = vec![0.0; 3 * size.len()];
    for (index, value) in values.chunks_exact_mut(3).enumerate() {
        let (column, row) = size.position(index);
        let mut sum = [0.0; 3];
        // The sky changes little over a pixel, so it is evaluated only when the triangle changes.
        let mut sky = (NOTHING, [0.0; 3]);
        for part in 0..SAMPLES * SAMPLES {
            let sample = rays.size.index(SAMPLES * column + part % SAMPLES, SAMPLES * row + part / SAMPLES);
            let Some(hit) = rays.hit(stage, placement, hits, sample) else {
                sum.iter_mut().for_each(|sum| *sum += BACKGROUND);
                continue;
            };
            let triangle = hit.triangle as u32;
            if sky.0 != triangle {
                sky = (triangle, light.sky(hit.normal));
            }
            let mut arriving = sky.1;
            light.add_lamps(hit.point, hit.normal, &mut arriving);
            let albedo = stage.albedos[stage.triangles[hit.triangle].albedo as usize].albedo(hit.point);
            (0..3).for_each(|k| sum[k] += arriving[k] * albedo[k]);
        }
        (0..3).for_each(|k| value[k] = (sum[k] / (SAMPLES * SAMPLES) as f64) as f32);
    }
    values
}

/// RGBA with 8 bits of sRGB, with `noise` times the typical noise.
pub fn develop(radiance: &[f32], noise: f64, chance: &mut Chance) -> Vec<u8> {
    let mut greens: Vec<f32> = radiance.iter().skip(1).step_by(3 * EXPOSURE_STRIDE).copied().collect();
    greens.sort_by(f32::total_cmp);
    let bright = greens.get((EXPOSED_QUANTILE * greens.len() as f64) as usize).map_or(1.0, |&value| f64::from(value));
    let gain = EXPOSED / bright.max(f64::MIN_POSITIVE);
    let mut bytes = Vec::with_capacity(radiance.len() / 3 * 4);
    for pixel in radiance.chunks_exact(3) {
        for &value in pixel {
            let value = gain * f64::from(value);
            let sigma = noise * (READ * READ + SHOT * SHOT * value).sqrt();
            let measured = if sigma > 0.0 { value + sigma * chance.gaussian() } else { value };
            bytes.push((255.0 * to_srgb(measured.clamp(0.0, 1.0))).round() as u8);
        }
        bytes.push(u8::MAX);
    }
    bytes
}
