//! Albedo is separated from shading, and both add up to the image.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::{Sample, SampleRequest, Scene, light, surface};
use bimodal_stereo::{ColourSamples, Estimator, LightSource, Options, Registration, Size, Start, Status};

const SIDE: usize = 80;

/// Log albedo of a pixel: a chequerboard of two albedos.
fn chequers(index: usize) -> [f64; 3] {
    let (column, row) = (index % SIDE, index / SIDE);
    if (column / 9 + row / 9) % 2 == 0 { [0.0; 3] } else { [-0.7, -0.2, 0.3] }
}

/// The bust, with 20 degrees between the views.
fn bust(name: &str, depth_noise: f64) -> Sample {
    let size = Size { width: SIDE, height: SIDE };
    let light = light(name).expect("a name");
    let request = SampleRequest { light, size, noise: 0.01, depth_noise, ..SampleRequest::default() };
    Scene::new(&surface("bust").expect("a name")).and_then(|scene| scene.sample(&request)).expect("a pair")
}

/// Runs on it with the pose given and fixed; the image is multiplied by the albedo.
fn run(name: &str, depth_noise: f64, known: bool, paint: impl Fn(usize) -> [f64; 3]) -> Estimator {
    let sample = bust(name, depth_noise);
    let mut image = sample.colour_image();
    let ColourSamples::RgbLinear(colours) = &mut image.samples else { panic!("renders are linear") };
    for (index, rgb) in colours.chunks_exact_mut(3).enumerate() {
        rgb.iter_mut().zip(paint(index)).for_each(|(value, log)| *value *= log.exp() as f32);
    }
    let pose = sample.pose;
    let options = Options {
        light: if known { LightSource::Known(sample.light) } else { LightSource::Estimate },
        start: Start::Pose { rotation: pose.rotation, scale: Some(pose.scale), translation: Some(pose.translation) },
        registration: Registration::Fixed,
        ..Options::default()
    };
    let mut estimator = Estimator::new(image, &sample.depth_map(), options).expect("good input");
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    estimator
}

#[test]
fn colours_are_paint_and_shading_and_what_is_left() {
    for known in [false, true] {
        let estimator = run("overcast", 0.0, known, chequers);
        let (albedo, shading) = (estimator.albedo(), estimator.shading());
        let mask = &estimator.image().mask;
        let mut sums = [0.0; 3];
        for (index, &inside) in mask.iter().enumerate() {
            let pixel = 3 * index..3 * index + 3;
            if !inside {
                assert!(albedo[pixel.clone()].iter().chain(&shading[pixel]).all(|value| value.is_nan()));
                continue;
            }
            let log = estimator.image().log_at(index);
            let left: [f32; 3] = std::array::from_fn(|c| log[c] - albedo[3 * index + c] - shading[3 * index + c]);
            let length = left.iter().map(|value| value * value).sum::<f32>().sqrt();
            assert!((length - estimator.residual()[index]).abs() < 1e-5, "{index}");
            (0..3).for_each(|c| sums[c] += f64::from(albedo[3 * index + c]));
        }
        let count = mask.iter().filter(|&&inside| inside).count() as f64;
        assert!(sums.iter().all(|sum| (sum / count).abs() < 1e-5), "{sums:?}");
    }
}

#[test]
fn two_paints_are_found_under_each_light() {
    for (name, known) in [("window", false), ("overcast", false), ("colourful", true), ("colourful", false)] {
        let estimator = run(name, 0.0, known, chequers);
        let albedo = estimator.albedo();
        // Under coloured light, chromaticity has no information where there is no normal.
        let counts = |index: usize| name != "colourful" || estimator.correspondence()[index] >= 0;
        let inside = (0..SIDE * SIDE).filter(|&index| estimator.image().mask[index]);
        let inside: Vec<usize> = inside.filter(|&index| counts(index)).collect();
        for channel in 0..3 {
            let off: Vec<f64> =
                inside.iter().map(|&index| f64::from(albedo[3 * index + channel]) - chequers(index)[channel]).collect();
            let mean = crate::common::mean(&off);
            let error = crate::common::mean(&off.iter().map(|value| (value - mean).powi(2)).collect::<Vec<_>>()).sqrt();
            // A tenth of the contrast between the two albedos.
            assert!(error < 0.07, "{name}, known: {known}, channel {channel}: {error}");
        }
    }
}

/// In an oblique view, depth pixels are farther apart than the image's. Image pixels between the points of the depth view
/// must not get different normals, which would show as dots and lines in shading and albedo.
#[test]
fn shading_has_no_dots_between_the_points_of_the_depth_view() {
    let estimator = run("window", 0.0, false, chequers);
    let (shading, correspondence) = (estimator.shading(), estimator.correspondence());
    let is_seen = |pixel: usize| correspondence[pixel] >= 0;
    let bend = |pixel: usize| {
        let at = |pixel: usize| shading[3 * pixel + 1];
        f64::from((at(pixel) - 0.5 * (at(pixel - 1) + at(pixel + 1))).abs())
    };
    let of = |between: bool| -> Vec<f64> {
        let inside = (1..SIDE * SIDE - 1).filter(|&pixel| estimator.image().mask[pixel] && is_seen(pixel) != between);
        inside.filter(|&pixel| is_seen(pixel - 1) && is_seen(pixel + 1)).map(bend).collect()
    };
    let [between, seen] = [of(true), of(false)].map(|bends| (bends.len(), crate::common::mean(&bends)));
    println!("{between:?} {seen:?}");
    assert!(between.0 > 50 && between.1 < 1.5 * seen.1, "{between:?} between points, {seen:?} on them");
}

#[test]
fn an_object_of_one_paint_has_none() {
    for name in ["window", "overcast", "colourful"] {
        for depth_noise in [0.0, 0.5] {
            let estimator = run(name, depth_noise, false, |_| [0.2, -0.4, 0.1]);
            assert!(estimator.albedo().iter().all(|value| value.is_nan() || *value == 0.0), "{name}, {depth_noise}");
        }
    }
}

#[test]
fn print_is_no_relief() {
    let truth = bust("window", 0.3).truth;
    let error = |paint: fn(usize) -> [f64; 3]| {
        let estimator = run("window", 0.3, false, paint);
        let off =
            estimator.refined_depth().iter().zip(&truth.depth).map(|(found, truth)| f64::from(found - truth).powi(2));
        crate::common::mean(&off.filter(|square| !square.is_nan()).collect::<Vec<_>>()).sqrt()
    };
    let [painted, plain] = [error(chequers), error(|_| [0.0; 3])];
    // A margin of a tenth of a square, because the albedo at the borders is a mixture.
    assert!(painted < 1.1 * plain, "{painted} {plain}");
}
