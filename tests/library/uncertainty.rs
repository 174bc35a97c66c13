//! The sigmas show where the image does not determine the pose.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::{Relief, Sample, SampleRequest, Scene, light};
use bimodal_stereo::{Angles, Estimator, LightSource, Options, Similarity, Size, Start, Status, StepReport};

const SIDE: usize = 128;

/// A relief over a disc of radius one; `height` in units of the disc's radius.
fn relief(height: impl Fn(f64, f64) -> f64) -> Relief {
    let radius = 0.44 * SIDE as f64;
    let middle = 0.5 * (SIDE - 1) as f64;
    let at = |index: usize| {
        let (x, y) = (((index % SIDE) as f64 - middle) / radius, ((index / SIDE) as f64 - middle) / radius);
        if x.hypot(y) < 0.99 { (radius * (1.0 + height(x, y))) as f32 } else { f32::NAN }
    };
    Relief::new(SIDE, SIDE, (0..SIDE * SIDE).map(at).collect()).unwrap()
}

fn sample(relief: &Relief, light_name: &str, angles: Angles, side: usize) -> Sample {
    let request = SampleRequest {
        size: Size { width: side, height: side },
        light: light(light_name).unwrap(),
        rotation: angles.rotation(),
        noise: 0.01,
        ..Default::default()
    };
    Scene::new(relief).unwrap().sample(&request).unwrap()
}

fn from_the_truth(sample: &Sample, light: LightSource) -> StepReport {
    let Similarity { rotation, scale, translation } = sample.pose;
    let start = Start::Pose { rotation, scale: Some(scale), translation: Some(translation) };
    let options = Options { start, light, ..Options::default() };
    let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options).unwrap();
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    estimator.report().clone()
}

#[test]
fn a_ball_does_not_tell_its_rotation() {
    let ball = relief(|x, y| (1.0 - x * x - y * y).max(0.0).sqrt());
    let sample = sample(&ball, "window", Angles { beta: 12.0, ..Angles::default() }, 72);
    for light in [LightSource::Estimate, LightSource::Known(sample.light)] {
        let report = from_the_truth(&sample, light);
        assert_eq!(report.status, Status::Lost, "{report:?}");
        let sigmas = report.uncertainty.unwrap().rotation_degrees;
        assert!(sigmas.iter().all(|&sigma| sigma > 3.0), "{sigmas:?}");
    }
}

#[test]
fn a_bowl_under_an_unknown_light_is_not_sure_of_its_pose() {
    let bowl = relief(|x, y| 0.4 * x * x + 0.25 * y * y - 0.5);
    let sample = sample(&bowl, "overcast", Angles { alpha: 8.0, beta: 20.0, gamma: 5.0 }, 72);
    let report = from_the_truth(&sample, LightSource::Estimate);
    assert_ne!(report.status, Status::Converged, "{report:?}");
    let sigmas = report.uncertainty.unwrap().rotation_degrees;
    let off = report.pose.degrees_to(&sample.pose);
    assert!(off < 3.0 * sigmas.iter().map(|sigma| sigma * sigma).sum::<f64>().sqrt(), "{off} {sigmas:?}");
}

/// This cloud fits best if it shrinks onto a few pixels, on the coarse level as on later ones. The scale must not collapse.
#[test]
fn a_cloud_does_not_shrink_away_from_the_true_pose() {
    let pillow = relief(|x, y| -0.35 * (x.powi(4) + y.powi(4)) - 0.15 * x * x - 0.1 * x * y);
    for beta in [-30.0, 20.0, 30.0] {
        let sample = sample(&pillow, "overcast", Angles { alpha: -6.0, beta, gamma: 8.0 }, 64);
        let report = from_the_truth(&sample, LightSource::Estimate);
        assert!((report.pose.scale / sample.pose.scale).ln().abs() < 0.05, "{beta}: {report:?}");
        assert!(report.pose.degrees_to(&sample.pose) < 5.0, "{beta}: {report:?}");
    }
}
