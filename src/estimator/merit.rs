//! The merit l + f + g (Eq. 1): one number by which an iteration is kept or not.
//!
//! Two solutions are compared over the SAME depth points, those that had a correspondence before the iteration: a
//! pose that loses points outside the image pays for each of them in full, so it can't look good by looking away.
//! Each term is a mean of Geman-McClure costs in 0 .. 1, so sizes of images do not matter.
//!
//! The depth term g asks how well the measured normals, not the refined ones, explain the colours where the pose puts
//! them: refined normals explain any colour, and would call any pose good.

use nalgebra::Vector3;

use crate::light::{Light, Polynomial};
use crate::numeric::{Lanes, Real, evenly_spread};
use crate::pose::Similarity;
use crate::report::Energy;
use crate::view::{ColourView, DepthView, Normals, Points};

/// Robust scale of the log-colour residual: a tenth is half a step of a photographer's stop over three channels.
const COLOUR_SCALE: f64 = 0.1;
/// Robust scale of the distance of both surfaces in image pixels: the paper's threshold for a correspondence.
const DISTANCE_SCALE: f64 = 1.0;
/// Robust scale of the difference of two normals: 12 degrees.
const NORMAL_SCALE: f64 = 0.2;

/// Points or pixels that a mean is taken of at most: of robust costs in 0 .. 1 it is then right to half a percent, and two
/// solutions are compared over the same ones.
pub const MOST_JURORS: usize = 10_000;

/// After a small step a merit that grows by less than this share has not grown: correspondences flicker at pixel
/// borders.
const MERIT_SLACK: f64 = 1e-2;
/// Degrees up to which a step is small. A larger one has to lower the merit, or a flat merit would let the pose drift.
const SMALL_STEP: f64 = 0.25;

/// Residuals within this multiple of their median enter the robust mean.
pub const SPREADS_OF_MEDIAN: f32 = 3.0;

/// What is compared: a pose with the shape and light that go with it.
#[derive(Clone, Copy)]
pub struct Candidate<'a> {
    /// Pose.
    pub pose: &'a Similarity,
    /// Light, exposure included.
    pub light: &'a Light,
    /// Normals of the image surface.
    pub normals: &'a Normals,
    /// Points of the image surface.
    pub points: &'a Points,
    /// Points of the depth view, its own frame.
    pub depth_points: &'a Points,
    /// Length of an image pixel at the object, in units of the colour view.
    pub pixel_length: f64,
}

/// Squares saturated at one.
fn robust(value: f64, scale: f64) -> f64 {
    let squared = (value / scale).powi(2);
    if squared.is_finite() { squared / (1.0 + squared) } else { 1.0 }
}

/// The energy of `candidate` over the depth points `fixed`, each term a mean over them or over the image's mask.
pub fn energy(image: &ColourView, depth: &DepthView, fixed: &[u32], candidate: Candidate<'_>) -> Energy {
    let (mut prior, mut distance, mut colour) = (0.0, 0.0, 0.0);
    let light = Polynomial::of(candidate.light);
    for &index in fixed {
        let terms = point_terms(image, depth, index as usize, candidate, &light).unwrap_or([1.0; 3]);
        prior += terms[0];
        distance += terms[1];
        colour += terms[2];
    }
    let share = 1.0 / fixed.len().max(1) as f64;
    Energy {
        shading: brightness(image, candidate, &light),
        prior: share * prior,
        registration: share * distance,
        refinement: share * colour,
    }
}

/// Costs of one depth point: of its normal, its distance, its colour. `None` where the image does not see it.
fn point_terms(
    image: &ColourView,
    depth: &DepthView,
    index: usize,
    candidate: Candidate<'_>,
    light: &[Polynomial; 3],
) -> Option<[f64; 3]> {
    let point = candidate.pose.apply(Vector3::from(candidate.depth_points.get(index).map(f64::from)));
    let [column, row] = image.camera.project(image.size, [point.x, point.y, point.z])?;
    let pixel = image.size.nearest(column as f32, row as f32).filter(|&pixel| image.mask[pixel])?;
    let normal = candidate.pose.rotation * Vector3::from(depth.normals.get(index).map(f64::from));
    let image_normal = Vector3::from(candidate.normals.get(pixel).map(f64::from));
    let image_point = Vector3::from(candidate.points.get(pixel).map(f64::from));
    let gap = image_normal.dot(&(image_point - point)) / candidate.pixel_length;
    let log = image.size.each_bilinear(image.log.each_ref().map(Vec::as_slice), column as f32, row as f32);
    let normal_f32 = [normal.x as f32, normal.y as f32, normal.z as f32];
    Some([
        robust((image_normal - normal).norm(), NORMAL_SCALE),
        robust(gap, DISTANCE_SCALE),
        robust(residual(log, light, normal_f32), COLOUR_SCALE),
    ])
}

/// Mean brightness cost of the image's own normals.
fn brightness(image: &ColourView, candidate: Candidate<'_>, light: &[Polynomial; 3]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    let inside = || (0..image.size.len()).filter(|&index| image.mask[index]);
    for index in evenly_spread(MOST_JURORS, inside) {
        count += 1.0;
        let [red, green, blue] = &image.log;
        let log = [red[index], green[index], blue[index]];
        sum += robust(residual(log, light, candidate.normals.get(index)), COLOUR_SCALE);
    }
    sum / f64::max(count, 1.0)
}

/// |log S - predicted| for a normal in the colour view's frame, under a light as three polynomials.
#[inline(never)]
fn residual(log: [f32; 3], light: &[Polynomial; 3], normal: [f32; 3]) -> f64 {
    f64::from(square_residual(log, light, normal).sqrt())
}

/// [`residual`] of the pixels from `start` on, each for its own normal.
pub fn residuals(image: &ColourView, start: usize, light: &[Polynomial; 3], normals: [Lanes; 3]) -> Lanes {
    let [red, green, blue] = &image.log;
    let start = start as isize;
    let log = [Lanes::load(red, start), Lanes::load(green, start), Lanes::load(blue, start)];
    square_residual(log, light, normals).sqrt()
}

#[inline(always)]
fn square_residual<T: Real<Scalar = f32>>(log: [T; 3], light: &[Polynomial; 3], normal: [T; 3]) -> T {
    let off = |channel: usize| log[channel] - light[channel].shade(normal);
    let [red, green, blue] = [off(0), off(1), off(2)];
    red * red + green * green + blue * blue
}

/// Whether a step of so many degrees has made the merit worse.
pub fn worsens(before: f64, after: f64, degrees: f64) -> bool {
    let slack = if degrees < SMALL_STEP { MERIT_SLACK } else { 0.0 };
    after > before * (1.0 + slack)
}
