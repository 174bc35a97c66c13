//! After the first iteration, stages that process every pixel do not allocate.

#[path = "common/allocations.rs"]
mod allocations;

use std::sync::atomic::Ordering;

use allocations::ALLOCATIONS;
use bimodal_stereo::scenes::{SampleRequest, Scene, surface};
use bimodal_stereo::{Camera, Estimator, Lens, LightSource, Options, Pinhole, Stage, Status};

/// Iterations that are counted, after the first.
const COUNTED: u32 = 4;

/// Smallest number of allocations of each stage over the counted iterations.
fn fewest(request: &SampleRequest, known: bool) -> [usize; Stage::ALL.len()] {
    let sample = Scene::new(&surface("bust").expect("a name")).and_then(|scene| scene.sample(request)).expect("a pair");
    let light = if known { LightSource::Known(sample.light) } else { LightSource::Estimate };
    // The threshold cannot be reached, so the loop keeps running.
    let options = Options { light, stop_degrees: f64::MIN_POSITIVE, ..Options::paper() };
    let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options).expect("good input");
    estimator.step();
    let mut fewest = [usize::MAX; Stage::ALL.len()];
    for _ in 0..COUNTED {
        assert_eq!(estimator.report().status, Status::Running);
        for (stage, fewest) in Stage::ALL.into_iter().zip(&mut fewest) {
            let before = ALLOCATIONS.load(Ordering::Relaxed);
            let report = estimator.step_stage();
            let count = ALLOCATIONS.load(Ordering::Relaxed) - before;
            assert_eq!(report.stage, stage);
            *fewest = (*fewest).min(count);
        }
    }
    fewest
}

// This binary has only one test, so nothing else runs during the count. The test harness has a thread too, so the smallest
// count of several iterations is taken.
#[test]
fn later_iterations_allocate_nothing_for_their_pixels() {
    let camera = Camera::Pinhole(Pinhole { fx: 150.0, fy: 150.0, cx: 31.5, cy: 31.5, lens: Lens::None });
    let flawed = SampleRequest { noise: 0.01, depth_noise: 0.2, holes: 0.1, ..SampleRequest::default() };
    let perspective = SampleRequest { image_camera: camera, depth_camera: camera, ..flawed.clone() };
    for request in [flawed, perspective] {
        for known in [true, false] {
            for (stage, count) in Stage::ALL.into_iter().zip(fewest(&request, known)) {
                // The registration rebuilds a tree of the image surface.
                if stage != Stage::Registration {
                    assert_eq!(count, 0, "{} with light known: {known}", stage.name());
                }
            }
        }
    }
}
