//! Painted objects: colours that light and shape do not explain must neither mislead the pose nor be believed.

use bimodal_stereo::scenes::{SampleRequest, Scene, light, surface};
use bimodal_stereo::{
    Angles, ColourImage, ColourSamples, Estimator, Options, Result, Similarity, Size, Start, Status, StepReport,
};

/// A scene whose image is painted in four hues, in squares of so many pixels, or not at all.
struct Painted {
    image: ColourImage,
    depth: bimodal_stereo::DepthMap,
    truth: Similarity,
}

fn painted(name: &str, beta: f64, square: Option<usize>) -> Result<Painted> {
    painted_under("window", name, beta, square)
}

fn painted_under(lamps: &str, name: &str, beta: f64, square: Option<usize>) -> Result<Painted> {
    let request = SampleRequest {
        light: light(lamps)?,
        size: Size { width: 72, height: 72 },
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

fn run(scene: &Painted, options: Options) -> Result<StepReport> {
    let mut estimator = Estimator::new(scene.image.clone(), &scene.depth, options)?;
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    Ok(estimator.report().clone())
}

#[test]
fn a_painted_object_is_found_from_nothing() -> Result<()> {
    for (name, beta) in [("bust", 25.0), ("vase", -20.0)] {
        let scene = painted(name, beta, Some(11))?;
        let report = run(&scene, Options::default())?;
        let off = report.pose.degrees_to(&scene.truth);
        assert!(off < 3.0, "{name}: {off} degrees, {:?} {:?}", report.status, report.message);
        let sigma = report.uncertainty.expect("a pose that was found has sigmas").rotation_degrees;
        let largest = sigma.into_iter().fold(0.0, f64::max);
        assert!(off < 3.0_f64.sqrt() * 3.0 * largest, "{name}: {off} degrees at sigmas of {sigma:?}");
    }
    Ok(())
}

#[test]
fn paint_does_not_pull_a_told_start_away() -> Result<()> {
    let scene = painted("bust", 20.0, Some(9))?;
    let told = Angles { alpha: 3.0, beta: 15.0, gamma: -2.0 }.rotation();
    let start = Start::Pose { rotation: told, scale: Some(1.0), translation: None };
    let report = run(&scene, Options { start, ..Options::default() })?;
    let off = report.pose.degrees_to(&scene.truth);
    assert!(off < 3.0, "{off} degrees, {:?} {:?}", report.status, report.message);
    Ok(())
}

#[test]
fn without_paint_the_colours_themselves_decide() -> Result<()> {
    let scene = painted("bust", 25.0, None)?;
    let report = run(&scene, Options::default())?;
    let off = report.pose.degrees_to(&scene.truth);
    // A third of what contrast alone would leave.
    assert!(off < 0.3 && report.status == Status::Converged, "{off} degrees, {:?}", report.status);
    Ok(())
}

#[test]
fn under_coloured_lamps_paint_of_one_hue_is_no_paint() -> Result<()> {
    // Soft dark and bright patches: no edge shows them, and by brightness the pose is off or said to be uncertain.
    let mut scene = painted_under("colourful", "bust", 25.0, None)?;
    let width = scene.image.width;
    if let ColourSamples::RgbLinear(data) = &mut scene.image.samples {
        for (pixel, colour) in data.chunks_mut(3).enumerate() {
            let [column, row] = [pixel % width, pixel / width].map(|place| place as f32);
            let bright = (1.2 * (column / 4.0).sin() * (row / 5.0).cos()).exp();
            colour.iter_mut().for_each(|value| *value *= bright);
        }
    }
    let report = run(&scene, Options::default())?;
    let off = report.pose.degrees_to(&scene.truth);
    assert!(off < 3.0 && report.status == Status::Converged, "{off} degrees, {:?} {:?}", report.status, report.message);
    Ok(())
}
