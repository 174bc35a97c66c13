//! The objective l + f + g (Eq. 1), by which an iteration is accepted or rejected.
//!
//! Two solutions are compared over the SAME depth points, the evaluation points: those with a correspondence before the
//! iteration. A pose that moves points out of the image pays for each of them in full, so looking away never pays. Each
//! term is a mean of Geman-McClure costs in 0 .. 1, so image sizes do not matter.
//!
//! The depth term g measures how well the measured normals explain the colours under the pose. Refined normals would
//! explain any colour, and any pose would look good.

use nalgebra::Vector3;

use super::gauge;
use super::pair::ViewPair;
use super::solution::Solution;
use crate::light::{Light, Polynomial};
use crate::numeric::robust::saturated;
use crate::numeric::{Lanes, Real, evenly_spread};
use crate::pose::{Correspondences, Similarity};
use crate::report::Objective;
use crate::view::ColourView;

/// Robust scale of the log-colour residual, natural logarithm over three channels: 0.1 is a brightness error of 6 % in
/// each channel, several times the noise of a good image.
const COLOUR_SCALE: f64 = 0.1;
/// Robust scale of the distance of both surfaces in image pixels: the paper's threshold for a correspondence.
const DISTANCE_SCALE: f64 = 1.0;
/// Robust scale of the difference of two normals: 12 degrees.
const NORMAL_SCALE: f64 = 0.2;

/// Largest number of points or pixels in a mean: robust costs in 0 .. 1 are then accurate to half a percent. Both
/// solutions are compared over the same ones.
pub const MOST_POINTS: usize = 10_000;
/// Distance of the evaluation points from the border of the mask, image pixels.
const MARGIN: f32 = 1.5;

/// After a small step, an objective that grows by less than this share counts as unchanged, because correspondences
/// flicker at pixel borders.
const SLACK: f64 = 1e-2;
/// Largest small step, degrees. A larger one must lower the objective, or a flat objective would let the pose drift.
const SMALL_STEP: f64 = 0.25;

/// What is evaluated: a pose with its shape and light.
#[derive(Clone, Copy)]
pub struct Trial<'a> {
    pub pose: &'a Similarity,
    /// The image without its albedo.
    pub colours: &'a ColourView,
    /// The light, with exposure.
    pub light: &'a Light,
    pub solution: &'a Solution,
    /// Length of an image pixel at the object, in units of the colour view.
    pub pixel_length: f64,
}

impl<'a> Trial<'a> {
    /// The solution itself under `light`, which is its light with exposure.
    pub fn of(pair: &ViewPair, colours: &'a ColourView, solution: &'a Solution, light: &'a Light) -> Self {
        let pixel_length = gauge::pixel_length(&pair.image, solution);
        Self { pose: &solution.pose, colours, light, solution, pixel_length }
    }
}

/// Depth points with a correspondence and a measured normal. Those near the border of the mask are excluded, because
/// they would enter and leave it with every small step.
pub fn evaluation_points(pair: &ViewPair, correspondences: &Correspondences) -> impl Iterator<Item = u32> {
    let (image, depth) = (&pair.image, &pair.depth);
    let [columns, rows] = correspondences.position();
    let inside = move |index: usize| {
        [[-1.0, -1.0], [1.0, -1.0], [-1.0, 1.0], [1.0, 1.0]].iter().all(|[right, down]| {
            let (column, row) = (columns[index] + MARGIN * right, rows[index] + MARGIN * down);
            !image.size.bilinear(&image.log[0], column, row).is_nan()
        })
    };
    let points = evenly_spread(MOST_POINTS, || correspondences.visible_points());
    points.filter(move |&index| depth.normals.is_valid(index) && inside(index)).map(|index| index as u32)
}

/// Geman-McClure cost in 0 .. 1; values that overflow cost 1.
fn robust(value: f64, scale: f64) -> f64 {
    let squared = (value / scale).powi(2);
    if squared.is_finite() { saturated(squared) } else { 1.0 }
}

/// The objective of `trial` over the depth points `evaluated`, each term a mean over them or over the image's mask.
pub fn evaluate(pair: &ViewPair, evaluated: &[u32], trial: Trial<'_>) -> Objective {
    let (mut prior, mut distance, mut colour) = (0.0, 0.0, 0.0);
    let light = Polynomial::of(trial.light);
    for &index in evaluated {
        let terms = point_terms(pair, index as usize, trial, &light).unwrap_or([1.0; 3]);
        prior += terms[0];
        distance += terms[1];
        colour += terms[2];
    }
    let share = 1.0 / evaluated.len().max(1) as f64;
    Objective {
        shading: brightness(trial.colours, trial, &light),
        prior: share * prior,
        registration: share * distance,
        refinement: share * colour,
    }
}

/// Costs of one depth point: of its normal, its distance, its colour. `None` if it falls outside the image's mask.
fn point_terms(
    ViewPair { image, depth, .. }: &ViewPair,
    index: usize,
    Trial { pose, colours, solution, pixel_length, .. }: Trial<'_>,
    light: &[Polynomial; 3],
) -> Option<[f64; 3]> {
    let point = pose.apply(Vector3::from(solution.depth.points.get(index).map(f64::from)));
    let [column, row] = image.camera.project(image.size, [point.x, point.y, point.z])?;
    let pixel = image.size.nearest(column as f32, row as f32).filter(|&pixel| image.mask[pixel])?;
    let normal = pose.rotation * Vector3::from(depth.normals.get(index).map(f64::from));
    let image_normal = Vector3::from(solution.image.normals.get(pixel).map(f64::from));
    let image_point = Vector3::from(solution.image.points.get(pixel).map(f64::from));
    let gap = image_normal.dot(&(image_point - point)) / pixel_length;
    let log = image.size.each_bilinear(colours.log.each_ref().map(Vec::as_slice), column as f32, row as f32);
    let normal_f32 = [normal.x as f32, normal.y as f32, normal.z as f32];
    Some([
        robust((image_normal - normal).norm(), NORMAL_SCALE),
        robust(gap, DISTANCE_SCALE),
        robust(residual(log, light, normal_f32), COLOUR_SCALE),
    ])
}

/// Mean brightness cost of the image's own normals.
fn brightness(image: &ColourView, trial: Trial<'_>, light: &[Polynomial; 3]) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    let inside = || (0..image.size.len()).filter(|&index| image.mask[index]);
    for index in evenly_spread(MOST_POINTS, inside) {
        count += 1.0;
        let [red, green, blue] = &image.log;
        let log = [red[index], green[index], blue[index]];
        sum += robust(residual(log, light, trial.solution.image.normals.get(index)), COLOUR_SCALE);
    }
    sum / f64::max(count, 1.0)
}

/// |log S - predicted| for a normal in the colour view's frame, under a light given as three polynomials.
#[inline(never)]
fn residual(log: [f32; 3], light: &[Polynomial; 3], normal: [f32; 3]) -> f64 {
    f64::from(square_residual(log, light, normal).sqrt())
}

/// [`residual`] of the pixels from `start` on, each for its own normal; `albedo` is subtracted from the colours.
pub fn residuals(
    image: &ColourView,
    albedo: Option<&[Vec<f32>; 3]>,
    start: usize,
    light: &[Polynomial; 3],
    normals: [Lanes; 3],
) -> Lanes {
    let load = |planes: &[Vec<f32>; 3]| [0, 1, 2].map(|channel: usize| Lanes::load(&planes[channel], start as isize));
    let mut log = load(&image.log);
    if let Some(albedo) = albedo {
        let albedo = load(albedo);
        log = [log[0] - albedo[0], log[1] - albedo[1], log[2] - albedo[2]];
    }
    square_residual(log, light, normals).sqrt()
}

#[inline(always)]
fn square_residual<T: Real<Scalar = f32>>(log: [T; 3], light: &[Polynomial; 3], normal: [T; 3]) -> T {
    let off = |channel: usize| log[channel] - light[channel].shade(normal);
    let [red, green, blue] = [off(0), off(1), off(2)];
    red * red + green * green + blue * blue
}

/// Whether a step of this many degrees made the objective worse.
pub fn worsens(before: f64, after: f64, degrees: f64) -> bool {
    let slack = if degrees < SMALL_STEP { SLACK } else { 0.0 };
    after > before * (1.0 + slack)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;
    use crate::estimator::Estimator;
    use crate::options::{LightSource, Options};
    use crate::pose::Angles;
    use crate::report::{Stage, Status};
    use crate::scenes::{Sample, SampleRequest, Scene, light, surface};
    use crate::view::Size;

    prop_compose! {
        fn sample()(
            alpha in -15.0..15.0, beta in 5.0..40.0, noise in 0.0..0.02, depth_noise in 0.0..0.2, seed in 1_u64..1000,
            name in prop::sample::select(vec!["colourful", "window"]),
        ) -> Sample {
            let request = SampleRequest {
                light: light(name).unwrap(),
                size: Size { width: 32, height: 32 },
                rotation: Angles { alpha, beta, gamma: 0.0 }.rotation(),
                noise,
                depth_noise,
                seed,
                ..Default::default()
            };
            Scene::new(&surface("bust").unwrap()).unwrap().sample(&request).unwrap()
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, ..ProptestConfig::default() })]

        /// Over the points of the last solution the new one is no worse, or it is rejected together with its pose.
        #[test]
        fn no_accepted_step_raises_the_objective(sample in sample(), known: bool) {
            let light = if known { LightSource::Known(sample.light) } else { LightSource::Estimate };
            let options = Options { light, max_iterations: 12, ..Options::paper() };
            let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options).unwrap();
            while estimator.report.status == Status::Running {
                while estimator.report.stage != Stage::Registration && estimator.report.status == Status::Running {
                    estimator.step_stage();
                }
                if estimator.report.status != Status::Running || estimator.report.iteration == 0 {
                    estimator.step();
                    continue;
                }
                // The end of the iteration, with the objective observed in between.
                let (before, pose) = (estimator.report.objective.total(), estimator.accepted.pose);
                estimator.report.stage = Stage::Refinement;
                estimator.refine();
                let after = estimator.objective().total();
                let degrees = pose.degrees_to(&estimator.solution.pose);
                estimator.run = crate::estimator::Run::Iterating(Stage::Light);
                let whole = estimator.history.step_fraction;
                estimator.finish_iteration();
                // Only a rejected step is halved.
                if estimator.history.step_fraction < whole {
                    prop_assert!(after > before, "{before} would have come to {after}");
                    prop_assert_eq!(estimator.report.pose, pose);
                } else {
                    prop_assert!(after <= before * (1.0 + SLACK), "{before} rose to {after}");
                    prop_assert!(degrees < SMALL_STEP || after <= before, "{before} rose to {after} over {degrees} degrees");
                }
            }
        }
    }
}
