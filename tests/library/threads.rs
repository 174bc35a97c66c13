//! Threads that share an estimator's work: the results are equal bit by bit for any number of threads.

use bimodal_stereo::scenes::{Sample, SampleRequest, Scene, light, surface};
use bimodal_stereo::{Estimator, Options, Reason, Similarity, Start, Status, StepReport};

/// The report, refined depth and image depth as bits.
type End = (StepReport, [Vec<u32>; 2]);

fn estimator(sample: &Sample, options: &Options) -> Estimator {
    Estimator::new(sample.colour_image(), &sample.depth_map(), options.clone()).unwrap()
}

fn end(estimator: &mut Estimator) -> End {
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    let bits = |values: &[f32]| values.iter().map(|value| value.to_bits()).collect();
    (estimator.report().clone(), [bits(estimator.refined_depth()), bits(&estimator.image_depth())])
}

fn assert_same(name: &str, sample: &Sample, options: &Options, counts: &[usize]) {
    let alone = end(&mut estimator(sample, options));
    for &count in counts {
        let shared = end(&mut estimator(sample, options).with_threads(count));
        assert_eq!(shared.0, alone.0, "{name}, {count} threads");
        assert!(shared.1 == alone.1, "{name}, {count} threads: other shapes");
    }
}

fn searched() -> Sample {
    let request =
        SampleRequest { light: light("colourful").unwrap(), noise: 0.01, overlap: 0.8, ..SampleRequest::default() };
    Scene::new(&surface("bust").unwrap()).unwrap().sample(&request).unwrap()
}

/// Options that start from the truth and settle late, so that some iterations follow.
fn near(sample: &Sample) -> Options {
    let Similarity { rotation, scale, translation } = sample.pose;
    let start = Start::Pose { rotation, scale: Some(scale), translation: Some(translation) };
    Options { start, stop_degrees: f64::MIN_POSITIVE, ..Options::default() }
}

#[test]
fn a_loop_that_is_shared_ends_the_same() {
    let sample = searched();
    assert_same("near", &sample, &near(&sample), &[0, 2]);
}

#[test]
fn a_search_that_is_shared_says_how_far_it_is_and_can_be_begun_again() {
    let sample = searched();
    let mut shared = estimator(&sample, &Options::default()).with_threads(3);
    let mut told = Vec::new();
    while shared.is_searching() {
        // The last step of a search reports that the search is done.
        if let Some(Reason::Searching { percent, .. }) = shared.step().reason {
            told.push(percent);
        }
    }
    assert!(told.len() > 4 && told.is_sorted(), "{told:?}");
    let first = end(&mut shared);
    shared.reset(Options::default()).unwrap();
    assert_eq!(end(&mut shared).0, first.0);
}

/// Tests of over three seconds: `cargo test` runs them, `npm test` only with `--long`.
mod long {
    use super::*;

    #[test]
    fn any_number_of_threads_ends_the_same() {
        let sample = searched();
        assert_same("searched", &sample, &Options::default(), &[1, 2, 3, 8]);
    }

    #[test]
    fn so_it_does_where_the_search_has_small_views() {
        let size = bimodal_stereo::Size { width: 160, height: 120 };
        let request = SampleRequest { size, light: light("window").unwrap(), noise: 0.01, ..SampleRequest::default() };
        let sample = Scene::new(&surface("bust").unwrap()).unwrap().sample(&request).unwrap();
        assert_same("large", &sample, &Options::default(), &[2]);
    }
}
