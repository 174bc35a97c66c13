//! Photometric registration on scenes with a known pose.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::{
    Angles, ColourView, DepthNoise, DepthView, ErrorKind, Light, LightPrior, Photometric, PhotometricOptions,
    PhotometricProblem, PhotometricReport, PhotometricTermination, Points, Result, Similarity, Size, cubic_normals,
    scenes,
};
use nalgebra::{Rotation3, Vector3};
use scenes::{Relief, Sample};

struct Views {
    image: ColourView,
    depth: DepthView,
    error: Vec<f32>,
    sample: Sample,
}

/// Both views of a sample, with the image `gain` times as bright.
fn views(sample: Sample, gain: f32) -> Views {
    let mut image = sample.colour_image();
    if let bimodal_stereo::ColourSamples::RgbLinear(colours) = &mut image.samples {
        colours.iter_mut().for_each(|value| *value *= gain);
    }
    let mut depth = DepthView::new(&sample.depth_map(), false).unwrap();
    let mut error = vec![0.0; depth.size.len()];
    if !depth.normals_given {
        cubic_normals::improve(depth.size, &depth.points, &mut depth.normals, &mut error, depth.noise.is_white);
    }
    Views { image: ColourView::new(image).unwrap(), depth, error, sample }
}

fn bust(beta: f64, side: usize, light: Light) -> Sample {
    bust_with_noise(beta, side, light, 0.01)
}

fn bust_with_noise(beta: f64, side: usize, light: Light, noise: f64) -> Sample {
    let request = scenes::SampleRequest {
        light,
        size: Size { width: side, height: side },
        rotation: Angles { beta, ..Angles::default() }.rotation(),
        noise,
        ..Default::default()
    };
    scenes::Scene::new(&scenes::surface("bust").unwrap()).unwrap().sample(&request).unwrap()
}

fn register(views: &Views, light: Option<&Light>, start: &Similarity) -> Result<PhotometricReport> {
    let prior = LightPrior::natural();
    let problem = PhotometricProblem {
        image: &views.image,
        depth_size: views.depth.size,
        points: &views.depth.points,
        normals: &views.depth.normals,
        normal_error: Some(&views.error),
        depth_noise: views.depth.noise,
        light,
        prior: &prior,
        prior_weight: 1.0,
        scale_is_held: true,
        near: None,
    };
    Photometric::new(&problem).register(&problem, start, &PhotometricOptions::default())
}

/// The true pose, rotated by `degrees` about the object's centre and shifted by a pixel.
fn off(views: &Views, degrees: f64) -> Similarity {
    let pose = views.sample.pose;
    let turn = Rotation3::new(Vector3::new(0.6, -0.7, 0.4).normalize() * degrees.to_radians()).into_inner();
    let centre = views.depth.points.centroid();
    let rotation = turn * pose.rotation;
    let translation = pose.apply(centre) + Vector3::new(1.0, -1.0, 0.0) - pose.scale * (rotation * centre);
    Similarity { rotation, translation, ..pose }
}

#[test]
fn the_bust_is_found_from_afar_under_known_and_unknown_light() {
    for (beta, degrees, known, worst) in [(20.0, 20.0, true, 0.1), (60.0, 8.0, true, 0.3), (40.0, 20.0, false, 0.3)] {
        let views = views(bust(beta, 96, scenes::lights::COLOURFUL), 1.0);
        let light = views.sample.light;
        let report = register(&views, known.then_some(&light), &off(&views, degrees)).unwrap();
        let error = report.pose.degrees_to(&views.sample.pose);
        assert!(error < worst, "{beta} {known}: {error} {report:?}");
        assert_eq!(report.termination, PhotometricTermination::Settled);
        assert!(report.noise > 0.008 && report.noise < 0.025 && report.inliers > 0.7, "{report:?}");
        let sigma = Vector3::from(report.uncertainty.rotation_degrees).norm();
        assert!(sigma > 0.005 && error < 5.0 * sigma, "{error} {sigma}");
        assert!(report.uncertainty.translation[2].is_none() && report.uncertainty.scale.is_none());
    }
}

#[test]
fn exposure_changes_nothing() {
    for known in [true, false] {
        let poses = [0.1, 1.0, 10.0].map(|gain| {
            let views = views(bust(30.0, 64, scenes::lights::WINDOW), gain);
            let light = views.sample.light;
            register(&views, known.then_some(&light), &off(&views, 5.0)).unwrap().pose
        });
        let off = poses.map(|pose| pose.degrees_to(&poses[1]));
        assert!(off.iter().all(|&off| off < 1e-3), "{known}: {off:?}");
    }
}

/// The pair of Table 2A, the bare grid, has an exact answer, because every point falls on a pixel's centre.
fn exact_views_give_the_pose_to_rounding(relief: &Relief) {
    for (beta, overlap) in [(20.0, 1.0), (-20.0, 1.0), (60.0, 0.5), (90.0, 0.25), (90.0, 1.0)] {
        let rotation = Angles { beta, ..Angles::default() }.rotation();
        let sample = scenes::bare_grid(relief, &scenes::lights::COLOURFUL, &rotation, overlap).unwrap();
        let views = views(sample, 1.0);
        let report = register(&views, Some(&scenes::lights::COLOURFUL), &off(&views, 2.0)).unwrap();
        let error = report.pose.degrees_to(&views.sample.pose);
        assert!(error < 1e-4, "{beta} {overlap}: {error} {report:?}");
    }
}

#[test]
fn exact_views_of_the_bust_give_the_pose_to_rounding() {
    exact_views_give_the_pose_to_rounding(&scenes::surface("bust").unwrap());
}

#[test]
#[ignore = "needs ../shared/data"]
fn exact_views_of_mozart_give_the_pose_to_rounding() {
    exact_views_give_the_pose_to_rounding(&crate::common::mozart(&crate::common::data_dir()));
}

#[test]
fn what_cannot_be_registered_is_an_error() {
    let views = views(bust(20.0, 64, scenes::lights::COLOURFUL), 1.0);
    let away = Similarity { translation: Vector3::new(500.0, 0.0, 0.0), ..views.sample.pose };
    assert_eq!(register(&views, None, &away).unwrap_err().kind(), ErrorKind::Degenerate);
    let nothing = Views { depth: DepthView { points: Points::missing(64 * 64), ..views.depth.clone() }, ..views };
    assert_eq!(register(&nothing, None, &Similarity::identity()).unwrap_err().kind(), ErrorKind::Degenerate);
    let short = Views { error: vec![0.0; 3], ..nothing };
    assert_eq!(register(&short, None, &Similarity::identity()).unwrap_err().kind(), ErrorKind::Size);
}

/// Results of a prototype, whose number of visible points differs by some ten percent.
#[test]
#[ignore = "needs ../shared/data"]
fn the_bound_is_that_of_the_prototype() {
    let folder = crate::common::data_dir();
    let scene = scenes::Scene::new(&crate::common::mozart(&folder)).unwrap();
    for (side, beta, known, expected) in [
        (128, 20.0, true, 0.007),
        (128, 60.0, true, 0.009),
        (128, 90.0, true, 0.014),
        (128, 20.0, false, 0.010),
        (128, 60.0, false, 0.012),
        (64, 20.0, true, 0.017),
        (64, 60.0, false, 0.036),
    ] {
        let request = scenes::SampleRequest {
            size: Size { width: side, height: side },
            rotation: Angles { beta, ..Angles::default() }.rotation(),
            ..Default::default()
        };
        let bound = scenes::bound(&scene.sample(&request).unwrap(), known, 0.01).unwrap();
        assert!((bound / expected).ln().abs() < 0.35, "{side} {beta} {known}: {bound} {expected}");
    }
}

/// Normals of a noisy depth map bias the light towards less contrast, and the pose follows in one direction. Over maps that
/// differ only in their noise, the mean pose is nearer to the truth if the noise's contribution is removed from the equations.
#[test]
fn what_noisy_normals_add_to_the_equations_is_taken_off() {
    let scene = scenes::Scene::new(&scenes::surface("bust").unwrap()).unwrap();
    let mut means = [Vector3::zeros(); 2];
    for seed in 0..SEEDS {
        let request = scenes::SampleRequest {
            light: scenes::lights::WINDOW,
            size: Size { width: 96, height: 96 },
            rotation: Angles { beta: 25.0, ..Angles::default() }.rotation(),
            noise: 0.01,
            depth_noise: 0.3,
            seed,
            ..Default::default()
        };
        let mut views = views(scene.sample(&request).unwrap(), 1.0);
        assert!(views.depth.noise.is_white && views.depth.noise.is_visible());
        for mean in &mut means {
            let found = register(&views, None, &views.sample.pose).unwrap();
            let off = found.pose.rotation * views.sample.pose.rotation.transpose();
            *mean += Rotation3::from_matrix_unchecked(off).scaled_axis() / f64::from(SEEDS as u32);
            views.depth.noise = DepthNoise::default();
        }
    }
    let [without, with] = means.map(|mean| mean.norm().to_degrees());
    println!("{without} {with}");
    assert!(without < 0.7 * with, "{without} {with}");
}

/// Number of maps with different noise: enough for a mean with a third of one map's error.
const SEEDS: u64 = 10;

#[test]
fn neighbours_share_what_the_model_leaves_out_and_no_noise() {
    let covariance = |noise: f64, shadow: f64| {
        let mut sample = bust_with_noise(30.0, 96, scenes::lights::WINDOW, noise);
        for (index, colour) in sample.image.colours.chunks_mut(3).enumerate() {
            // A shadow over a part of the object, which harmonics of the normals cannot represent.
            let [x, y] = [index % 96, index / 96].map(|at| at as f64);
            let share = shadow * (0.35 * x).sin() * (0.35 * y).sin();
            colour.iter_mut().for_each(|value| *value *= share.exp() as f32);
        }
        let views = views(sample, 1.0);
        let report = register(&views, None, &views.sample.pose).unwrap();
        (report.spatial_covariance, report.noise)
    };
    for noise in [0.0, 0.01, 0.03] {
        let (covariance, noise) = covariance(noise, 0.0);
        assert!(covariance < 0.15 * noise, "{covariance} of {noise}");
    }
    // The mean over a tile of 8 pixels keeps sin(u) / u of such a wave along each axis; the light absorbs a little.
    let kept = (4.0 * 0.35_f64).sin() / (4.0 * 0.35);
    for noise in [0.0, 0.03] {
        let (covariance, _) = covariance(noise, 0.04);
        let expected = 0.02 * kept * kept;
        assert!(covariance > 0.6 * expected && covariance < 1.1 * expected, "{covariance} of {expected}");
    }
}

/// Where shading is faint compared with the noise, least squares gain more from positions between pixels, which average the noise,
/// than from the right pose.
#[test]
fn a_gain_that_is_only_averaged_noise_is_given_up() {
    for (side, noise) in [(160, 0.04), (256, 0.02)] {
        for beta in [10.0, 20.0] {
            let request = scenes::SampleRequest {
                light: scenes::light("overcast").unwrap(),
                size: Size { width: side, height: side },
                rotation: Angles { beta, ..Angles::default() }.rotation(),
                noise,
                ..Default::default()
            };
            let scene = scenes::Scene::new(&scenes::surface("ripples").unwrap()).unwrap();
            let views = views(scene.sample(&request).unwrap(), 1.0);
            let report = register(&views, None, &off(&views, 2.0)).unwrap();
            let error = report.pose.degrees_to(&views.sample.pose);
            assert_eq!(report.termination, PhotometricTermination::Settled);
            assert!(error < 0.2, "{side} {noise} {beta}: {error} {report:?}");
        }
    }
}
