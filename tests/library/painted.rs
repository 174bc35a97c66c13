//! Objects with varying albedo: colours that light and shape do not explain must neither displace the pose nor be trusted.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::{SampleRequest, Scene, light, surface};
use bimodal_stereo::{
    Angles, ColourImage, ColourSamples, DepthMap, DepthSamples, Estimator, Options, Result, Similarity, Size, Start,
    Status, StepReport,
};

/// A scene whose image has four albedos in squares of a given side, or a single albedo.
struct Painted {
    image: ColourImage,
    depth: DepthMap,
    truth: Similarity,
}

fn painted(name: &str, beta: f64, square: Option<usize>) -> Result<Painted> {
    painted_at(72, name, beta, square)
}

fn painted_at(side: usize, name: &str, beta: f64, square: Option<usize>) -> Result<Painted> {
    let request = SampleRequest {
        light: light("window")?,
        size: Size { width: side, height: side },
        rotation: Angles { alpha: 0.0, beta, gamma: 0.0 }.rotation(),
        noise: 0.01,
        ..SampleRequest::default()
    };
    let sample = Scene::new(&surface(name)?)?.sample(&request)?;
    let mut image = sample.colour_image();
    let hues = [[1.0, 1.0, 1.0], [0.9, 0.35, 0.3], [0.3, 0.7, 0.4], [0.35, 0.4, 0.85]];
    if let ColourSamples::RgbLinear(data) = &mut image.samples {
        for (pixel, colour) in data.chunks_mut(3).enumerate() {
            let (column, row) = (pixel % image.width, pixel / image.width);
            let hue = square.map_or(0, |square| (column / square + 3 * (row / square)) % 4);
            colour.iter_mut().zip(hues[hue]).for_each(|(value, share)| *value *= share);
        }
    }
    Ok(Painted { image, depth: sample.depth_map(), truth: sample.pose })
}

/// Linear colours whose chromaticity has half the resolution, as in a JPEG; brightness is unchanged.
fn with_half_hues(image: &ColourImage) -> ColourImage {
    let ColourSamples::RgbLinear(data) = &image.samples else { return image.clone() };
    let (width, height) = (image.width, image.height);
    let grey = |index: usize| data[3 * index..3 * index + 3].iter().sum::<f32>().max(1e-3);
    let half = |column: usize, row: usize, channel: usize| {
        let corner = 2 * row.min(height / 2 - 1) * width + 2 * column.min(width / 2 - 1);
        let cells = [corner, corner + 1, corner + width, corner + width + 1];
        cells.map(|index| data[3 * index + channel] / grey(index)).iter().sum::<f32>() / 4.0
    };
    let mut soft = data.clone();
    for index in 0..width * height {
        let place = [index % width, index / width].map(|at| (at as f32 / 2.0 - 0.25).max(0.0));
        let [column, row] = place.map(|at| at as usize);
        let [right, down] = place.map(f32::fract);
        for channel in 0..3 {
            let along = |row| (1.0 - right) * half(column, row, channel) + right * half(column + 1, row, channel);
            soft[3 * index + channel] = grey(index) * ((1.0 - down) * along(row) + down * along(row + 1)).max(1e-4);
        }
    }
    ColourImage { samples: ColourSamples::RgbLinear(soft), ..image.clone() }
}

/// Depth in steps, as from whole disparities.
fn in_steps(depth: &DepthMap, step: f32) -> DepthMap {
    let DepthSamples::Float(data) = &depth.samples else { return depth.clone() };
    DepthMap { samples: DepthSamples::Float(data.iter().map(|z| (z / step).round() * step).collect()), ..depth.clone() }
}

fn run(scene: &Painted, options: Options) -> Result<StepReport> {
    let mut estimator = Estimator::new(scene.image.clone(), &scene.depth, options)?;
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    Ok(estimator.report().clone())
}

fn assert_found(scene: &Painted) -> Result<()> {
    let report = run(scene, Options::default())?;
    let off = report.pose.degrees_to(&scene.truth);
    assert!(off < 3.0, "{off} degrees, {:?} {:?}", report.status, report.reason);
    Ok(())
}

#[test]
fn paint_does_not_pull_a_told_start_away() -> Result<()> {
    let scene = painted("bust", 20.0, Some(9))?;
    let told = Angles { alpha: 3.0, beta: 15.0, gamma: -2.0 }.rotation();
    let start = Start::Pose { rotation: told, scale: Some(1.0), translation: None };
    let report = run(&scene, Options { start, ..Options::default() })?;
    let off = report.pose.degrees_to(&scene.truth);
    assert!(off < 3.0, "{off} degrees, {:?} {:?}", report.status, report.reason);
    Ok(())
}

/// Two albedos that blend over several pixels, so that no edge separates them.
fn softly_painted(name: &str, beta: f64) -> Result<Painted> {
    let mut scene = painted_at(96, name, beta, None)?;
    let ColourSamples::RgbLinear(data) = &mut scene.image.samples else { return Ok(scene) };
    for (pixel, colour) in data.chunks_mut(3).enumerate() {
        let [x, y] = [pixel % scene.image.width, pixel / scene.image.width].map(|at| at as f32);
        let share = 1.0 / (1.0 + (-5.0 * ((0.23 * x).sin() + (0.19 * y + 0.07 * x).cos())).exp());
        colour.iter_mut().zip([-1.2, -0.3, 0.2]).for_each(|(value, paint)| *value *= (share * paint).exp());
    }
    Ok(scene)
}

#[test]
fn without_paint_the_colours_themselves_decide() -> Result<()> {
    let scene = painted("bust", 25.0, None)?;
    let report = run(&scene, Options::default())?;
    let off = report.pose.degrees_to(&scene.truth);
    // The limit is a third of the error that only local contrast would leave.
    assert!(off < 0.3 && report.status == Status::Converged, "{off} degrees, {:?}", report.status);
    Ok(())
}

/// Tests of over three seconds: `cargo test` runs them, `npm test` only with `--long`.
mod long {
    #[cfg(target_arch = "wasm32")]
    use super::test;
    use super::*;

    #[test]
    fn the_pose_follows_soft_paint_that_is_found_under_it() -> Result<()> {
        let (mut searched, mut followed) = (Vec::new(), Vec::new());
        for (name, beta) in [("bust", 25.0), ("bust", -40.0), ("vase", -20.0), ("ripples", 20.0)] {
            let scene = softly_painted(name, beta)?;
            let mut estimator = Estimator::new(scene.image.clone(), &scene.depth, Options::default())?;
            while estimator.is_searching() {
                estimator.step();
            }
            searched.push(estimator.report().pose.degrees_to(&scene.truth));
            while estimator.report().status == Status::Running {
                estimator.step();
            }
            followed.push(estimator.report().pose.degrees_to(&scene.truth));
        }
        let mean = |off: &[f64]| off.iter().sum::<f64>() / off.len() as f64;
        assert!(mean(&followed) < 0.7 * mean(&searched), "{followed:?} instead of {searched:?} degrees");
        Ok(())
    }

    #[test]
    fn a_painted_object_is_found_from_nothing() -> Result<()> {
        for (name, beta) in [("bust", 25.0), ("vase", -20.0)] {
            let scene = painted(name, beta, Some(11))?;
            let report = run(&scene, Options::default())?;
            let off = report.pose.degrees_to(&scene.truth);
            assert!(off < 3.0, "{name}: {off} degrees, {:?} {:?}", report.status, report.reason);
            let sigma = report.uncertainty.expect("a pose that was found has sigmas").rotation_degrees;
            let largest = sigma.into_iter().fold(0.0, f64::max);
            assert!(off < 3.0_f64.sqrt() * 3.0 * largest, "{name}: {off} degrees at sigmas of {sigma:?}");
        }
        Ok(())
    }

    #[test]
    fn paint_is_told_beside_depth_in_steps() -> Result<()> {
        let scene = painted("bust", 25.0, Some(11))?;
        let scene = Painted { depth: in_steps(&scene.depth, 1.0), ..scene };
        assert_found(&scene)
    }

    #[test]
    fn half_the_hues_are_enough() -> Result<()> {
        let scene = painted_at(96, "bust", 25.0, Some(15))?;
        let scene = Painted { image: with_half_hues(&scene.image), ..scene };
        assert_found(&scene)
    }
}
