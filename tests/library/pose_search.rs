//! The search over poses on scenes with a known pose: its results and its laws.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::{self, Sample, SampleRequest, Scene};
use bimodal_stereo::{
    Angles, Camera, ColourSamples, ColourView, DepthView, Lens, Light, Pinhole, Search, SearchProblem, Similarity, Size,
};
use nalgebra::{Rotation3, Vector3};

/// Largest error of a candidate, degrees; photometric registration converges from 15 degrees.
const NEAR: f64 = 12.0;
/// Number of candidates that are checked.
const FIRST: usize = 10;
/// Limit of the slices of a search with one scale; a free scale has four scales, and less than four times as many slices.
const MOST_SLICES: usize = 200;

fn bust(request: SampleRequest) -> Sample {
    let relief = scenes::surface("bust").unwrap();
    Scene::new(&relief).unwrap().sample(&SampleRequest { noise: 0.01, ..request }).unwrap()
}

/// A rotation of sixty degrees about an oblique axis, with a roll.
fn far() -> SampleRequest {
    let tilt = Rotation3::new(Vector3::new(0.5, 0.8, 0.0).normalize() * 60_f64.to_radians());
    let rotation = (tilt * Rotation3::new(Vector3::z() * -0.3)).into_inner();
    SampleRequest { light: scenes::light("window").unwrap(), rotation, ..SampleRequest::default() }
}

fn search(sample: &Sample, gain: f32, light: Option<&Light>, scale: Option<f64>, seed: u64) -> Search {
    let mut image = sample.colour_image();
    if let ColourSamples::RgbLinear(colours) = &mut image.samples {
        colours.iter_mut().for_each(|colour| *colour *= gain);
    }
    let (image, depth) = (ColourView::new(image).unwrap(), DepthView::new(&sample.depth_map(), true).unwrap());
    let problem = SearchProblem { light, scale, seed, ..problem(&image, &depth) };
    Search::new(&problem).unwrap()
}

/// A problem with an unknown light and a free scale.
fn problem<'a>(image: &'a ColourView, depth: &'a DepthView) -> SearchProblem<'a> {
    SearchProblem { image, depth, normals: &depth.normals, light: None, scale: None, unit_scale: 1.0, seed: 1 }
}

fn run(mut search: Search) -> Vec<(Similarity, f64)> {
    while search.advance().share < 1.0 {}
    search.candidates().iter().map(|candidate| (candidate.pose, candidate.score)).collect()
}

fn nearest(found: &[(Similarity, f64)], truth: &Similarity) -> f64 {
    found.iter().take(FIRST).map(|(pose, _)| pose.degrees_to(truth)).fold(f64::INFINITY, f64::min)
}

#[test]
fn a_known_light_finds_a_far_pose() {
    for name in scenes::lights::NAMES {
        let sample = bust(SampleRequest { light: scenes::light(name).unwrap(), ..far() });
        let found = run(search(&sample, 1.0, Some(&sample.light), Some(1.0), 1));
        assert!(nearest(&found, &sample.pose) < NEAR, "{name}");
    }
}

#[test]
fn an_unknown_light_finds_a_far_pose() {
    for name in scenes::lights::NAMES {
        let sample = bust(SampleRequest { light: scenes::light(name).unwrap(), ..far() });
        let found = run(search(&sample, 1.0, None, Some(1.0), 1));
        assert!(nearest(&found, &sample.pose) < NEAR, "{name}");
    }
}

#[test]
fn beta_of_sixty_is_found_in_half_a_depth_map() {
    let rotation = Angles { beta: 60.0, ..Angles::default() }.rotation();
    let sample = bust(SampleRequest { rotation, overlap: 0.5, ..far() });
    for light in [None, Some(&sample.light)] {
        assert!(nearest(&run(search(&sample, 1.0, light, Some(1.0), 1)), &sample.pose) < NEAR);
    }
}

#[test]
fn a_free_scale_is_found_with_the_pose() {
    let sample = bust(SampleRequest { scale: 1.25, ..far() });
    let found = run(search(&sample, 1.0, None, None, 1));
    let near =
        |(pose, _): &&(Similarity, f64)| pose.degrees_to(&sample.pose) < NEAR && (pose.scale / 1.25).ln().abs() < 0.12;
    assert!(found.iter().take(FIRST).any(|candidate| near(&candidate)));
}

#[test]
fn translations_carry_the_centre_to_its_place() {
    let pinhole = |focal_length: f64| {
        let centre = 31.5;
        Camera::Pinhole(Pinhole { fx: focal_length, fy: focal_length, cx: centre + 12.0, cy: centre, lens: Lens::None })
    };
    for (image_camera, depth_camera) in [
        (Camera::Orthographic, Camera::Orthographic),
        (pinhole(160.0), pinhole(160.0)),
        (pinhole(160.0), Camera::Orthographic),
    ] {
        let sample = bust(SampleRequest { image_camera, depth_camera, ..far() });
        let found = run(search(&sample, 1.0, Some(&sample.light), Some(1.0), 1));
        let (pose, _) = found.iter().take(FIRST).find(|(pose, _)| pose.degrees_to(&sample.pose) < NEAR).unwrap();
        let depth = DepthView::new(&sample.depth_map(), true).unwrap();
        let size = Size { width: 64, height: 64 };
        let centre = depth.points.centroid();
        let pixel = |pose: &Similarity| image_camera.project(size, pose.apply(centre).into()).unwrap();
        let ([column, row], [true_column, true_row]) = (pixel(pose), pixel(&sample.pose));
        assert!((column - true_column).hypot(row - true_row) < 6.0, "{image_camera:?} {depth_camera:?}");
    }
}

#[test]
fn exposure_changes_nothing() {
    let sample = bust(far());
    for light in [None, Some(&sample.light)] {
        let plain = run(search(&sample, 1.0, light, Some(1.0), 1));
        for gain in [0.1, 10.0] {
            let exposed = run(search(&sample, gain, light, Some(1.0), 1));
            for ((pose, score), (other, other_score)) in plain.iter().zip(&exposed).take(FIRST) {
                assert!(pose.degrees_to(other) < 0.01 && (score - other_score).abs() < 1e-3 * score.abs());
            }
        }
    }
}

#[test]
fn the_same_seed_finds_the_same_and_another_one_the_same_pose() {
    let sample = bust(far());
    let first = run(search(&sample, 1.0, None, Some(1.0), 1));
    assert_eq!(first, run(search(&sample, 1.0, None, Some(1.0), 1)));
    assert!(nearest(&run(search(&sample, 1.0, None, Some(1.0), 2)), &sample.pose) < NEAR);
}

#[test]
fn slices_are_few_and_progress_grows_to_one() {
    let sample = bust(far());
    for (scale, most) in [(Some(1.0), MOST_SLICES), (None, 4 * MOST_SLICES)] {
        let mut search = search(&sample, 1.0, None, scale, 1);
        let (mut slices, mut share) = (0, 0.0);
        while share < 1.0 {
            assert!(search.candidates().is_empty());
            let progress = search.advance();
            assert!(progress.share > share || slices == 0);
            share = progress.share;
            slices += 1;
            assert!(slices <= most);
        }
        let done = search.candidates().to_vec();
        search.advance();
        assert_eq!(done, search.candidates());
    }
}

#[test]
fn candidates_are_sorted_valid_and_apart() {
    let sample = bust(far());
    let found = run(search(&sample, 1.0, None, None, 1));
    assert!(!found.is_empty() && found.len() <= 40);
    assert!(found.windows(2).all(|pair| pair[0].1 >= pair[1].1));
    for (index, (pose, score)) in found.iter().enumerate() {
        assert!(pose.validate("pose").is_ok() && score.is_finite());
        assert!((0.6..1.6).contains(&pose.scale));
        assert!(found[..index].iter().all(|(other, _)| pose.degrees_to(other) > 4.99));
    }
}

#[test]
fn what_cannot_be_searched_is_refused_by_name() {
    let sample = bust(far());
    let mut image = ColourView::new(sample.colour_image()).unwrap();
    let depth = DepthView::new(&sample.depth_map(), true).unwrap();
    assert_eq!(
        Search::new(&SearchProblem { scale: Some(-1.0), ..problem(&image, &depth) }).err().unwrap().field(),
        "scale"
    );
    for channel in &mut image.log {
        channel.iter_mut().filter(|log| !log.is_nan()).for_each(|log| *log = -1.0);
    }
    assert_eq!(Search::new(&problem(&image, &depth)).err().unwrap().field(), "image");
}
