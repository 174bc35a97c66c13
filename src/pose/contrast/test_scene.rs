//! A scene for the tests of this registration and of that in the gradient domain.

use crate::light::basis;
use crate::numeric::noise;
use crate::view::{ColourImage, ColourSamples, ColourView, DepthMap, DepthSamples, DepthView};

/// Side of both views, pixels.
pub(in crate::pose) const SIDE: usize = 64;
/// Blur of a texture, pixels, that is as soft as shading, and sharper than the local means.
pub(in crate::pose) const TEXTURE_BLUR: usize = 2;

/// A dome with bumps, and its gradient, pixels.
fn relief(x: f64, y: f64) -> (f64, [f64; 2]) {
    let (k, bump) = (0.35, 1.6);
    let [sx, cx] = [(k * x).sin(), (k * x).cos()];
    let [sy, cy] = [(0.8 * k * y).sin(), (0.8 * k * y).cos()];
    let height = -0.012 * (x * x + y * y) + bump * sx * cy;
    (-height, [0.024 * x - bump * k * cx * cy, 0.024 * y + bump * 0.8 * k * sx * sy])
}

fn is_object(x: f64, y: f64) -> bool {
    x * x + y * y < 27.0 * 27.0
}

/// Noise of this amplitude, log units, blurred three times by a box.
pub(in crate::pose) fn texture(seed: u64, amplitude: f64, blur: usize) -> Vec<f64> {
    let mut dice = noise::white_noise(seed);
    let mut field: Vec<f64> = (0..SIDE * SIDE).map(|_| dice()).collect();
    for _ in 0..3 {
        for stride in [1, SIDE] {
            let source = field.clone();
            for (index, value) in field.iter_mut().enumerate() {
                let near = |k: usize| source[(index + SIDE * SIDE + k * stride - stride) % (SIDE * SIDE)];
                *value = (0..=blur).map(near).sum::<f64>() / (blur + 1) as f64;
            }
        }
    }
    let spread = (field.iter().map(|value| value * value).sum::<f64>() / field.len() as f64).sqrt();
    field.iter().map(|value| amplitude * value / spread).collect()
}

/// Image and depth of one view; the pose between them is the identity.
pub(in crate::pose) fn views(texture: &[f64]) -> (ColourView, DepthView) {
    let (mut data, mut depth, mut mask) = (Vec::new(), Vec::new(), Vec::new());
    for index in 0..SIDE * SIDE {
        let [x, y] = [index % SIDE, index / SIDE].map(|place| place as f64 - (SIDE - 1) as f64 / 2.0);
        let (z, [p, q]) = relief(x, y);
        let length = (1.0 + p * p + q * q).sqrt();
        let shades = basis([p / length, q / length, -1.0 / length]);
        let light = |tint: f64| -1.0 + 0.5 * shades[1] - 0.4 * tint * shades[3] - 0.3 * shades[2] / tint;
        data.extend([0.8, 1.0, 1.3].map(|tint| (light(tint) + texture[index]).exp() as f32));
        depth.push(if is_object(x, y) { z as f32 + 50.0 } else { 0.0 });
        mask.push(u8::from(is_object(x, y)));
    }
    let samples = ColourSamples::RgbLinear(data);
    let mask = Some(mask);
    let image = ColourImage { width: SIDE, height: SIDE, samples, transfer: None, mask, camera: None };
    let samples = DepthSamples::Float(depth);
    let map = DepthMap { width: SIDE, height: SIDE, samples, unit: None, mask: None, camera: None, normals: None };
    (ColourView::new(image).unwrap(), DepthView::new(&map, true).unwrap())
}
