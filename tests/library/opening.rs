//! Large views: the search uses coarse views, and the result is that of all pixels.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use std::sync::OnceLock;

use bimodal_stereo::scenes::{Sample, SampleRequest, Scene, light, surface};
use bimodal_stereo::{
    Angles, Camera, Estimator, Lens, Options, Pinhole, Size, Stage, Start, Status, StepReport, Worker,
};

/// A scene with more object pixels than a frame of 128x128, odd sides, and a depth map that lacks a part.
fn large(camera: Camera) -> Sample {
    let scale = if camera.is_orthographic() { 1.1 } else { 1.0 };
    let request = SampleRequest {
        size: Size { width: 235, height: 219 },
        light: light("window").unwrap(),
        rotation: Angles { alpha: 5.0, beta: 25.0, gamma: 10.0 }.rotation(),
        scale,
        overlap: 0.8,
        noise: 0.01,
        image_camera: camera,
        depth_camera: camera,
        ..Default::default()
    };
    let sample = Scene::new(&surface("bust").unwrap()).unwrap().sample(&request).unwrap();
    assert!(sample.image.mask.iter().filter(|&&inside| inside).count() > 128 * 128);
    sample
}

fn pinhole() -> Camera {
    Camera::Pinhole(Pinhole { fx: 300.0, fy: 310.0, cx: 118.3, cy: 107.6, lens: Lens::None })
}

/// Runs to the end; also returns the reports of the search.
fn run(sample: &Sample, start: Start) -> (Estimator, Vec<StepReport>) {
    let options = Options { start, ..Options::default() };
    let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options).unwrap();
    let mut search = Vec::new();
    while estimator.report().status == Status::Running {
        let report = estimator.step();
        if report.stage == Stage::Search {
            search.push(report.clone());
        }
    }
    (estimator, search)
}

/// The result of a run: its last report, those of its search, the refined depth.
struct Run {
    report: StepReport,
    search: Vec<StepReport>,
    refined: Vec<u32>,
}

fn bits(estimator: &Estimator) -> Vec<u32> {
    estimator.refined_depth().iter().map(|z| z.to_bits()).collect()
}

fn searched(sample: &Sample) -> Run {
    let (estimator, search) = run(sample, Start::Search);
    Run { report: estimator.report().clone(), search, refined: bits(&estimator) }
}

/// The run of the orthographic pair, which takes long and which two tests share.
fn searched_without_cameras() -> &'static Run {
    static RUN: OnceLock<Run> = OnceLock::new();
    RUN.get_or_init(|| searched(&large(Camera::Orthographic)))
}

fn middle_of_depth(sample: &Sample) -> nalgebra::Vector3<f64> {
    let estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), Options::paper()).unwrap();
    estimator.depth().points.centroid()
}

/// Tests of over three seconds: `cargo test` runs them, `npm test` only with `--long`.
mod long {
    #[cfg(target_arch = "wasm32")]
    use super::test;
    use super::*;

    #[test]
    fn a_worker_searches_the_same_coarse_views() {
        let sample = large(Camera::Orthographic);
        let alone = searched_without_cameras();
        let options = Options::default();
        let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options.clone()).unwrap();
        let mut worker = Worker::new(sample.colour_image(), &sample.depth_map(), options).unwrap();
        let mut done = 0;
        while estimator.report().status == Status::Running {
            if let Some(task) = estimator.take_task() {
                estimator.accept_finding(worker.perform(&task).unwrap());
                done += 1;
            }
            estimator.step();
        }
        assert!(done > 100, "{done}");
        let [one, two] = [&alone.report, estimator.report()];
        assert_eq!((one.pose, one.iteration, &one.reason), (two.pose, two.iteration, &two.reason));
        assert!(alone.refined == bits(&estimator));
    }

    #[test]
    fn a_search_on_coarse_views_ends_where_all_pixels_say() {
        for camera in [Camera::Orthographic, pinhole()] {
            let sample = large(camera);
            let own;
            let Run { report: found, search, .. } = match camera {
                Camera::Orthographic => searched_without_cameras(),
                _ => {
                    own = searched(&sample);
                    &own
                }
            };
            let pose = sample.pose;
            let truth =
                Start::Pose { rotation: pose.rotation, scale: Some(pose.scale), translation: Some(pose.translation) };
            let (near, _) = run(&sample, truth);
            let near = near.report();
            assert_eq!([found.status, near.status], [Status::Converged; 2], "{found:?}");
            // Both results come from the same registration by all points, whatever its initial pose.
            let sigma = near.uncertainty.as_ref().unwrap().rotation_degrees;
            let apart = found.pose.degrees_to(&near.pose);
            assert!(apart < 0.3 * sigma.iter().map(|s| s * s).sum::<f64>().sqrt(), "{camera:?}: {apart} {sigma:?}");
            assert!((found.pose.scale / near.pose.scale - 1.0).abs() < 1e-3);
            let middle = middle_of_depth(&sample);
            let off = found.pose.apply(middle) - near.pose.apply(middle);
            let pixel = camera.focal_length().map_or(1.0, |focal_length| near.pose.apply(middle).z / focal_length);
            assert!(off.xy().norm() < 0.1 * pixel, "{camera:?}: {off}");
            // During the search, the best candidate is reported in the units of the views.
            let halfway = &search[search.len() / 2];
            assert!(halfway.pose.degrees_to(&pose) < 16.0, "{}", halfway.pose.degrees_to(&pose));
            let off = halfway.pose.apply(middle) - pose.apply(middle);
            assert!(off.xy().norm() < 25.0 * pixel, "{camera:?}: {off}");
        }
    }
}
