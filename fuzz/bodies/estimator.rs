//! Runs the loop on arbitrary small views and options for a limited number of stages, and checks every output.

use std::hint::black_box;

use arbitrary::{Result, Unstructured};
use bimodal_stereo::{ColourMap, Estimator, Layer, Normals, Objective, Status, StepReport, Surface};

use super::numbers::{odd, rarely};
use super::views::{Pair, options, pair};
use super::{named, numbers};

/// Limit of the stages and search slices of a run. An iteration has five stages; a search of views this small has hundreds
/// of slices.
const MOST_STAGES: u16 = 30;
const MOST_OF_A_LONG_RUN: u16 = 400;
/// Tolerance of a normal's length, in f32.
const UNIT: f32 = 1e-3;

pub fn run(data: &[u8]) {
    // Exhausted bytes read as zeros, so an error here does not come from the library.
    let _ = attempt(&mut Unstructured::new(data));
}

fn attempt(u: &mut Unstructured<'_>) -> Result<()> {
    let Pair { image, depth, options: chosen } = pair(u)?;
    let sizes = [[image.width, image.height], [depth.width, depth.height]].map(|[width, height]| width * height);
    let mut estimator = match Estimator::new(image, &depth, chosen) {
        Ok(estimator) => estimator,
        Err(error) => {
            named(&error);
            return Ok(());
        }
    };
    check(&estimator, sizes);
    let most = if rarely(u, 16)? { MOST_OF_A_LONG_RUN } else { MOST_STAGES };
    for _ in 0..u.int_in_range(5..=most)? {
        estimator.step_stage();
        judge(estimator.report());
        if estimator.report().status != Status::Running {
            break;
        }
        if rarely(u, 16)? {
            check(&estimator, sizes);
        }
    }
    check(&estimator, sizes);
    draw(u, &estimator)?;
    if rarely(u, 4)? {
        let light = numbers::light(u)?;
        if let Err(error) = estimator.reset(options(u, &light)?) {
            named(&error);
        }
        estimator.step();
        check(&estimator, sizes);
    }
    Ok(())
}

/// Checks the guarantees of every report.
pub fn judge(report: &StepReport) {
    let StepReport { pose, objective, .. } = report;
    assert!(pose.validate("pose").is_ok(), "no similarity: {report:?}");
    let Objective { shading, prior, registration, refinement } = *objective;
    for share in [shading, prior, registration, refinement, report.overlap, report.inliers] {
        assert!((0.0..=1.0).contains(&share), "a mean of costs, or a share, outside of 0 .. 1: {report:?}");
    }
    assert!(report.residual >= 0.0 && report.rotation_change >= 0.0, "{report:?}");
    assert!(report.rivals.iter().all(|rival| rival.validate("rival").is_ok()), "{report:?}");
    if report.status == Status::Lost {
        assert!(report.reason.is_some(), "lost without a reason: {report:?}");
    }
    if let Some(uncertainty) = &report.uncertainty {
        let sigmas = uncertainty.rotation_degrees.into_iter();
        let sigmas = sigmas.chain(uncertainty.translation.into_iter().flatten()).chain(uncertainty.scale);
        // An infinite sigma means "unknown"; NaN has no meaning.
        assert!(sigmas.into_iter().all(|sigma| sigma >= 0.0), "{uncertainty:?}");
    }
}

/// Checks the guarantees of every output for views with these numbers of pixels.
fn check(estimator: &Estimator, [pixels, points]: [usize; 2]) {
    judge(estimator.report());
    let light = estimator.light();
    assert!(light.flat().iter().all(|value| value.is_finite()) && estimator.exposure().is_finite(), "{light:?}");
    are_unit(&estimator.image_normals(), pixels);
    are_unit(estimator.depth_normals(), points);
    let lengths = [estimator.image_depth().len(), estimator.residual().len(), estimator.correspondence().len()];
    assert_eq!(lengths, [pixels; 3]);
    assert_eq!(estimator.refined_depth().len(), points);
    assert_eq!([estimator.albedo().len(), estimator.shading().len()], [3 * pixels; 2]);
    assert!(estimator.correspondence().iter().all(|&index| index >= -1 && index < points as i32));
    assert!(estimator.residual().iter().all(|&value| value.is_nan() || value >= 0.0));
    for surface in [Surface::Image, Surface::Depth] {
        let places = estimator.points(surface);
        assert!(places.len().is_multiple_of(3) && places.len() <= 3 * pixels.max(points));
    }
    black_box((estimator.search_scores(), estimator.workers_afforded(), estimator.refinement_task(None)));
}

fn are_unit(normals: &Normals, count: usize) {
    assert_eq!(normals.len(), count);
    for index in (0..count).filter(|&index| normals.is_valid(index)) {
        let [x, y, z] = normals.get(index);
        let length = (x * x + y * y + z * z).sqrt();
        assert!((length - 1.0).abs() < UNIT, "normal {index} has the length {length}");
    }
}

fn draw(u: &mut Unstructured<'_>, estimator: &Estimator) -> Result<()> {
    let mut rgba = Vec::new();
    for layer in Layer::ALL {
        let range = if rarely(u, 8)? { Some([odd(u)?, odd(u)?]) } else { None };
        match estimator.draw(layer, range, *u.choose(&ColourMap::ALL)?, &mut rgba) {
            Ok(size) => assert_eq!(rgba.len(), 4 * size.len()),
            Err(error) => named(&error),
        }
    }
    Ok(())
}
