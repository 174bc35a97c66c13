//! The depth sensor: a camera beside a projector of structured light, with the flaws that such sensors have.
//!
//! Noise of depth grows with its square (Nguyen, Izadi and Lovell 2012), neighbours share a part of it, rims waver by
//! half a pixel, disparities come in steps; nothing is measured in the projector's shadow, where the surface is seen
//! or lit at a grazing angle, and out of range; some pixels at rims lie between both surfaces.

use nalgebra::Vector3;

use super::cameras::Rig;
use super::raster::{Hits, Rays};
use super::stage::Stage;
use crate::pose::Similarity;
use crate::scenes::flaws::Chance;
use crate::view::Size;

/// Range in metres.
const RANGE: [f64; 2] = [0.35, 8.0];
/// Sigma of depth in metres: a + b (z - c)^2 (Nguyen et al., Eq. 3).
const SIGMA: [f64; 3] = [0.0012, 0.0019, 0.4];
/// Sigma in pixels of the smoothing that neighbours' noise has gone through.
const NOISE_SMOOTHING: f64 = 0.8;
/// Sigma in pixels by which rims waver.
const LATERAL: f64 = 0.5;
/// Disparity z = f b / d of the sensor: f b in pixel metres for 640 columns, and its steps in pixels (Kinect).
const DISPARITY: f64 = 580.0 * 0.075;
const DISPARITY_STEP: f64 = 0.125;
/// Cosine between surface and line of sight below which nothing comes back, and that where everything does.
const GRAZING: [f64; 2] = [0.08, 0.18];
/// A jump of depth between neighbours, as a share of it, that is a rim.
const RIM: f64 = 0.03;
/// Shares of the pixels at rims that are lost, and that lie between both surfaces.
const LOST: f64 = 0.25;
const FLYING: f64 = 0.15;
/// A point lies in the projector's shadow of what is nearer by this share.
const SHADOW_BIAS: f64 = 0.008;
/// Samples of the projector's view for each pixel of the camera, and how much wider it looks.
const PROJECTOR_SAMPLES: f64 = 1.5;
const PROJECTOR_REACH: f64 = 1.3;

/// What the depth camera would see without flaws.
pub struct Seen {
    /// Metres, NaN where nothing is.
    pub depth: Vec<f32>,
    /// Cosine between the surface and the line of sight.
    pub cosine: Vec<f32>,
    /// Whether the projector reaches the point.
    pub is_lit: Vec<bool>,
}

/// The depth camera's view of a stage that `placement` puts into its frame.
pub fn look(stage: &Stage, placement: &Similarity, rig: &Rig) -> Seen {
    let size = rig.depth_size;
    let rays = Rays::new(&rig.depth, size, 1);
    let hits = rays.meet(stage, placement);
    let aside = Vector3::new(rig.projector, 0.0, 0.0);
    let projector = Rays::straight(PROJECTOR_SAMPLES * rig.depth.fx, projector_size(size));
    let lit = projector.meet(stage, &Similarity { translation: placement.translation - aside, ..*placement });
    let mut seen = Seen {
        depth: hits.depth.iter().map(|&depth| if depth.is_finite() { depth } else { f32::NAN }).collect(),
        cosine: vec![0.0; size.len()],
        is_lit: vec![false; size.len()],
    };
    for index in 0..size.len() {
        if let Some(hit) = rays.hit(stage, placement, &hits, index) {
            seen.cosine[index] = hit.cosine as f32;
            seen.is_lit[index] = is_lit(placement.apply(hit.point) - aside, &projector, &lit);
        }
    }
    seen
}

fn projector_size(size: Size) -> Size {
    let side = |side: usize| (PROJECTOR_SAMPLES * PROJECTOR_REACH * side as f64) as usize;
    Size { width: side(size.width), height: side(size.height) }
}

fn is_lit(point: Vector3<f64>, projector: &Rays, lit: &Hits) -> bool {
    let position = projector.position(point);
    let index = position.and_then(|[column, row]| projector.size.nearest(column as f32, row as f32));
    index.is_some_and(|index| f64::from(lit.depth[index]) > point.z * (1.0 - SHADOW_BIAS))
}

/// Millimetres as the sensor gives them, 0 where it measures nothing; `noise` times the usual noise. Without any only
/// what has no light or comes back at a grazing angle is lost.
pub fn measure(seen: &Seen, size: Size, noise: f64, chance: &mut Chance) -> Vec<u16> {
    let shared = smooth_noise(size, chance);
    (0..size.len())
        .map(|index| {
            let draws = [chance.uniform(), chance.uniform()];
            let jitter = [chance.gaussian(), chance.gaussian()].map(|part| noise * LATERAL * part);
            let at = displaced(size, index, jitter);
            let depth = f64::from(seen.depth[at]);
            let comes_back = (f64::from(seen.cosine[at]) - GRAZING[0]) / (GRAZING[1] - GRAZING[0]);
            if !(RANGE[0]..RANGE[1]).contains(&depth) || !seen.is_lit[at] || comes_back < draws[0].max(1e-9) {
                return 0;
            }
            if noise <= 0.0 {
                return millimetres(depth);
            }
            let Some(depth) = at_rim(seen, size, at, depth, draws[1]) else { return 0 };
            let sigma = SIGMA[0] + SIGMA[1] * (depth - SIGMA[2]).powi(2);
            let noisy = (depth + noise * sigma * shared[index]).max(RANGE[0]);
            let step = DISPARITY_STEP;
            millimetres(DISPARITY / (step * (DISPARITY / noisy / step).round()).max(step))
        })
        .collect()
}

fn millimetres(depth: f64) -> u16 {
    (1000.0 * depth).round() as u16
}

/// The pixel so many columns and rows beside, within the view.
fn displaced(size: Size, index: usize, jitter: [f64; 2]) -> usize {
    let (column, row) = size.position(index);
    let move_by = |at: usize, by: f64, length: usize| (at as f64 + by).round().clamp(0.0, length as f64 - 1.0) as usize;
    size.index(move_by(column, jitter[0], size.width), move_by(row, jitter[1], size.height))
}

/// The depth at a pixel which may be at a rim: lost, between both surfaces, or as it is.
fn at_rim(seen: &Seen, size: Size, index: usize, depth: f64, draw: f64) -> Option<f64> {
    let jump = |near: usize| f64::from(seen.depth[near]) - depth;
    let other = size.neighbours(index).find(|&near| jump(near).abs() > RIM * depth);
    match other {
        Some(_) if draw < LOST => None,
        Some(near) if draw < LOST + FLYING => Some(depth + jump(near) * (draw - LOST) / FLYING),
        _ => Some(depth),
    }
}

/// Gaussian noise of variance one whose neighbours resemble each other.
fn smooth_noise(size: Size, chance: &mut Chance) -> Vec<f64> {
    let reach = (3.0 * NOISE_SMOOTHING).ceil() as isize;
    let kernel: Vec<f64> = (-reach..=reach).map(|k| (-0.5 * (k as f64 / NOISE_SMOOTHING).powi(2)).exp()).collect();
    let length = kernel.iter().map(|weight| weight * weight).sum::<f64>().sqrt();
    let kernel: Vec<f64> = kernel.iter().map(|weight| weight / length).collect();
    let white: Vec<f64> = (0..size.len()).map(|_| chance.gaussian()).collect();
    // Borders take the noise of the other side, so that the variance is one there, too.
    let along = |values: &[f64], step: [usize; 2]| -> Vec<f64> {
        let mut sums = vec![0.0; values.len()];
        for (index, sum) in sums.iter_mut().enumerate() {
            let (column, row) = size.position(index);
            for (k, weight) in kernel.iter().enumerate() {
                let off = k as isize - reach;
                let wrapped = |at: usize, by: usize, length: usize| {
                    (at as isize + off * by as isize).rem_euclid(length as isize) as usize
                };
                let near = size.index(wrapped(column, step[0], size.width), wrapped(row, step[1], size.height));
                *sum += weight * values[near];
            }
        }
        sums
    };
    along(&along(&white, [1, 0]), [0, 1])
}
