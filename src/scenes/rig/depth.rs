//! The depth sensor: a camera beside a projector of structured light, with the flaws of such sensors.
//!
//! The noise of depth grows with the square of depth (Nguyen, Izadi and Lovell 2012), and neighbours share part of it.
//! Depth discontinuities waver by half a pixel, and disparities come in steps. Nothing is measured in the projector's
//! shadow, at grazing angles of sight or light, and out of range. Some pixels at discontinuities lie between both
//! surfaces.

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
/// Sigma in pixels of the smoothing that correlates the noise of neighbours.
const NOISE_SMOOTHING: f64 = 0.8;
/// Sigma in pixels by which depth discontinuities waver.
const LATERAL: f64 = 0.5;
/// Disparity d of the sensor, with z = f b / d: f b in pixel metres for 640 columns, and the steps of d in pixels
/// (Kinect).
const DISPARITY: f64 = 580.0 * 0.075;
const DISPARITY_STEP: f64 = 0.125;
/// Cosines between surface and line of sight: up to the first no light returns, and above the second all light returns.
const GRAZING: [f64; 2] = [0.08, 0.18];
/// Relative jump of depth between neighbours that counts as a discontinuity.
const RIM: f64 = 0.03;
/// Shares of the pixels at discontinuities that are lost, and that lie between both surfaces.
const LOST: f64 = 0.25;
const FLYING: f64 = 0.15;
/// A point lies in the projector's shadow if another one is nearer by more than this share.
const SHADOW_BIAS: f64 = 0.008;
/// Samples of the projector's view for each pixel of the camera, and the factor by which its view is wider.
const PROJECTOR_SAMPLES: f64 = 1.5;
const PROJECTOR_REACH: f64 = 1.3;

/// The depth camera's view without flaws.
pub struct Seen {
    /// Metres, NaN for background.
    pub depth: Vec<f32>,
    /// Cosine between the surface and the line of sight.
    pub cosine: Vec<f32>,
    /// Whether the projector lights the point.
    pub is_lit: Vec<bool>,
}

/// The depth camera's view of a stage that `placement` transforms into its frame.
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

/// Output of the sensor in millimetres, 0 where it measures nothing, with `noise` times the typical noise. Without
/// noise only points out of range, unlit or at a grazing angle are lost.
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

/// The pixel displaced by these columns and rows, clamped to the view.
fn displaced(size: Size, index: usize, jitter: [f64; 2]) -> usize {
    let (column, row) = size.position(index);
    let move_by = |at: usize, by: f64, length: usize| ((at as f64 + by).round().max(0.0) as usize).min(length - 1);
    size.index(move_by(column, jitter[0], size.width), move_by(row, jitter[1], size.height))
}

/// The depth at a pixel that may lie at a discontinuity. It is lost, between both surfaces, or unchanged.
fn at_rim(seen: &Seen, size: Size, index: usize, depth: f64, draw: f64) -> Option<f64> {
    let jump = |near: usize| f64::from(seen.depth[near]) - depth;
    let other = size.neighbours(index).find(|&near| jump(near).abs() > RIM * depth);
    match other {
        Some(_) if draw < LOST => None,
        Some(near) if draw < LOST + FLYING => Some(depth + jump(near) * (draw - LOST) / FLYING),
        _ => Some(depth),
    }
}

/// Gaussian noise of variance one that is correlated between neighbours.
fn smooth_noise(size: Size, chance: &mut Chance) -> Vec<f64> {
    let reach = (3.0 * NOISE_SMOOTHING).ceil() as isize;
    let kernel: Vec<f64> = (-reach..=reach).map(|k| (-0.5 * (k as f64 / NOISE_SMOOTHING).powi(2)).exp()).collect();
    let length = kernel.iter().map(|weight| weight * weight).sum::<f64>().sqrt();
    let kernel: Vec<f64> = kernel.iter().map(|weight| weight / length).collect();
    let white: Vec<f64> = (0..size.len()).map(|_| chance.gaussian()).collect();
    // Borders wrap around, so that the variance is also one at the borders.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scenes::rig::pattern::Albedo;
    use crate::scenes::rig::solids::Solid;
    use crate::view::{Lens, Pinhole};

    const SIZE: Size = Size { width: 200, height: 150 };

    fn flat(depth: f32) -> Seen {
        Seen { depth: vec![depth; SIZE.len()], cosine: vec![1.0; SIZE.len()], is_lit: vec![true; SIZE.len()] }
    }

    #[test]
    fn noise_grows_with_depth_as_it_says_and_neighbours_share_it() {
        for depth in [0.6_f32, 1.2, 3.5] {
            let z = f64::from(depth);
            let measured = measure(&flat(depth), SIZE, 1.0, &mut Chance::of_stream(5, 0));
            let off: Vec<f64> = measured.iter().map(|&value| f64::from(value) / 1000.0 - z).collect();
            let mean = off.iter().sum::<f64>() / off.len() as f64;
            let variance = |by: usize| {
                let pairs = off.iter().zip(&off[by..]);
                pairs.map(|(a, b)| (a - mean) * (b - mean)).sum::<f64>() / (off.len() - by) as f64
            };
            let sigma = SIGMA[0] + SIGMA[1] * (z - SIGMA[2]).powi(2);
            // Quantisation adds a twelfth of the squared step, for the steps of disparity and those of a millimetre.
            let step = z * z * DISPARITY_STEP / DISPARITY;
            let expected = (sigma * sigma + (step * step + 1e-6) / 12.0).sqrt();
            assert!((variance(0).sqrt() / expected - 1.0).abs() < 0.1, "{depth}: {} {expected}", variance(0).sqrt());
            assert!(mean.abs() < 0.1 * expected + 0.5 * step * step / z, "{depth}: {mean}");
            // Gaussian windows of this sigma, one pixel apart, share exp(-1 / (4 sigma^2)) of the smooth part.
            let shared = (-0.25 / (NOISE_SMOOTHING * NOISE_SMOOTHING)).exp() * sigma * sigma;
            assert!((variance(1) - shared).abs() < 0.1 * variance(0), "{depth}: {} {shared}", variance(1));
            assert!(variance(10).abs() < 0.05 * variance(0));
            let mut steps: Vec<u16> = measured.clone();
            steps.sort_unstable();
            steps.dedup();
            let gap = f64::from(steps[steps.len() / 2 + 1] - steps[steps.len() / 2]) / 1000.0;
            assert!((gap - step).abs() < 0.0021, "{depth}: {gap} {step}");
        }
    }

    #[test]
    fn what_cannot_be_measured_is_a_hole() {
        let mut seen = flat(1.0);
        seen.depth[..100].fill(f32::NAN);
        seen.depth[100..200].fill(0.2);
        seen.depth[200..300].fill(9.0);
        seen.cosine[300..400].fill(0.05);
        seen.is_lit[400..500].fill(false);
        let measured = measure(&seen, SIZE, 0.0, &mut Chance::of_stream(1, 0));
        assert!(measured[..500].iter().all(|&value| value == 0));
        assert!(measured[500..].iter().all(|&value| value == 1000));
    }

    #[test]
    fn rims_lose_pixels_and_have_some_between_both_surfaces() {
        let mut seen = flat(1.0);
        (0..SIZE.len()).filter(|index| SIZE.position(*index).0 >= 100).for_each(|index| seen.depth[index] = 1.5);
        let measured = measure(&seen, SIZE, 1.0, &mut Chance::of_stream(2, 0));
        let at = |column: usize| (0..SIZE.height).map(move |row| SIZE.index(column, row)).map(|index| measured[index]);
        let rim = || at(99).chain(at(100));
        let share = |count: usize| count as f64 / (2 * SIZE.height) as f64;
        let lost = share(rim().filter(|&value| value == 0).count());
        let flying = share(rim().filter(|value| (1050..1450).contains(value)).count());
        // Since discontinuities waver, a pixel beside one may be measured one column away from it.
        assert!((lost / LOST - 0.8).abs() < 0.4 && (flying / FLYING - 0.7).abs() < 0.5, "{lost} {flying}");
        assert!(at(50).chain(at(150)).all(|value| (950..1050).contains(&value) || (1450..1550).contains(&value)));
    }

    /// A square at 0.8 m is in front of a wall at 1.6 m. Its shadow on the wall is f b (1 / 0.8 - 1 / 1.6) pixels wide,
    /// on the side away from the projector.
    #[test]
    fn the_shadow_of_the_projector_lies_where_geometry_says() {
        for projector in [0.06, -0.08] {
            let camera = Pinhole { fx: 180.0, fy: 180.0, cx: 99.5, cy: 74.5, lens: Lens::None };
            let mut rig = Rig::random(Some(SIZE), Some(SIZE), &mut Chance::of_stream(1, 1));
            (rig.depth, rig.projector) = (camera, projector);
            let mut stage = Stage::default();
            let still = Similarity::identity();
            for (half, z) in [(2.0, 1.6), (0.15, 0.8)] {
                let face =
                    Solid::face(Vector3::new(-half, -half, z), 2.0 * half * Vector3::x(), 2.0 * half * Vector3::y());
                stage.put(&face, &still, Albedo::plain(&still, &mut Chance::of_stream(1, 2)));
            }
            let seen = look(&stage, &still, &rig);
            let dark: Vec<usize> = (0..SIZE.width).filter(|&column| !seen.is_lit[SIZE.index(column, 75)]).collect();
            let width = camera.fx * projector.abs() * (1.0 / 0.8 - 1.0 / 1.6);
            assert!((dark.len() as f64 - width).abs() <= 2.0, "{dark:?} {width}");
            // The square's own borders are 33.75 pixels from the middle.
            let rim = 99.5 - f64::signum(projector) * 33.75;
            assert!(dark.iter().all(|&column| (column as f64 - rim) * -projector.signum() > -1.0), "{dark:?}");
            assert!(dark.iter().all(|&column| (column as f64 - rim).abs() < width + 2.0), "{dark:?}");
        }
    }
}
