//! A refinement during the computation of the image surface gives the same bits in this thread and in a worker.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::{Sample, SampleRequest, Scene, light, surface};
use bimodal_stereo::{
    Camera, Estimator, Lens, LightSource, Options, Pinhole, Reason, Registration, Similarity, Stage, Start, Status,
    StepReport, Weights, Worker,
};

/// The result of a run: its report, refined depth and image depth as bits, and the number of refinements from a worker.
type End = (StepReport, [Vec<u32>; 2], usize);

fn bits(values: &[f32]) -> Vec<u32> {
    values.iter().map(|value| value.to_bits()).collect()
}

/// Runs with a worker that delivers only those refinements whose number `brings` accepts. If the worker `forgets`, it
/// gets all planes again, including those that it already holds.
fn run(sample: &Sample, options: &Options, brings: impl Fn(usize) -> bool, forgets: bool) -> End {
    let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options.clone()).unwrap();
    let mut worker = Worker::new(sample.colour_image(), &sample.depth_map(), options.clone()).unwrap();
    let (mut held, mut asked, mut brought) = (None, 0, 0);
    while estimator.report().status == Status::Running {
        let task = estimator.refinement_task(held).filter(|_| estimator.report().stage == Stage::Refinement);
        let Some(task) = task else {
            estimator.step_stage();
            continue;
        };
        let load =
            |own: [&mut [f32]; 9]| own.into_iter().zip(&task.planes).for_each(|(own, it)| own.copy_from_slice(it));
        let refined = worker.refine(&task.numbers, load).unwrap().map(<[f32]>::to_vec);
        let shape = task.shape;
        held = (!forgets).then_some(shape + 1);
        asked += 1;
        // A refinement is refused before its stage and for another shape.
        assert!(estimator.accept_refinement(shape).is_none());
        while estimator.precedes_refinement() {
            estimator.step_stage();
        }
        assert!(estimator.accept_refinement(shape + 1).is_none());
        if brings(asked)
            && let Some(own) = estimator.accept_refinement(shape)
        {
            own.into_iter().zip(&refined).for_each(|(own, it)| own.copy_from_slice(it));
            brought += 1;
        }
        estimator.step_stage();
    }
    (estimator.report().clone(), [bits(estimator.refined_depth()), bits(&estimator.image_depth())], brought)
}

fn assert_same(name: &str, sample: &Sample, options: &Options) {
    let (alone, shapes, _) = run(sample, options, |_| false, false);
    for (forgets, every) in [(false, 1), (true, 1), (false, 2)] {
        let (report, others, brought) = run(sample, options, |asked| asked % every == 0, forgets);
        assert!(brought > 0, "{name}: nothing was brought");
        assert_eq!(report, alone, "{name}");
        assert!(others == shapes, "{name}: other shapes");
    }
}

fn sample(request: &SampleRequest) -> Sample {
    Scene::new(&surface("bust").unwrap()).unwrap().sample(request).unwrap()
}

/// Options that start from the truth and settle late, so that some iterations follow.
fn near(sample: &Sample) -> Options {
    let Similarity { rotation, scale, translation } = sample.pose;
    let start = Start::Pose { rotation, scale: Some(scale), translation: Some(translation) };
    Options { start, stop_degrees: f64::MIN_POSITIVE, ..Options::default() }
}

#[test]
fn an_iteration_that_is_taken_back_takes_its_shape_along() {
    let colourful = light("colourful").unwrap();
    let request =
        SampleRequest { light: colourful, noise: 0.05, depth_noise: 0.3, holes: 0.1, ..SampleRequest::default() };
    let sample = sample(&request);
    // With too much trust in the depth view, the second iteration is worse than the first.
    let options = Options { weights: Weights { prior: 10.0, ..Weights::default() }, ..near(&sample) };
    let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options.clone()).unwrap();
    estimator.step();
    let planes = |estimator: &Estimator, held| estimator.refinement_task(held).unwrap().planes.len();
    let first = estimator.refinement_task(None).unwrap().shape;
    let (known, unknown) = (planes(&estimator, Some(first)), planes(&estimator, None));
    assert!(known < unknown);
    let report = estimator.step();
    assert!(matches!(report.reason, Some(Reason::TakenBack { .. })), "{report:?}");
    // A worker that has refined the second shape no longer holds the first.
    assert_eq!(planes(&estimator, Some(first + 1)), unknown);
    assert_same("taken back", &sample, &options);
}

#[test]
fn after_a_search_the_loop_is_shared_as_well() {
    let request =
        SampleRequest { light: light("colourful").unwrap(), noise: 0.01, overlap: 0.8, ..SampleRequest::default() };
    let sample = sample(&request);
    assert_same("known light", &sample, &Options { light: LightSource::Known(sample.light), ..Options::default() });
}

#[test]
fn a_pose_that_may_move_is_refined_here() {
    let sample = sample(&SampleRequest::default());
    let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), Options::paper()).unwrap();
    assert!(estimator.refinement_task(None).is_none());
    estimator.step();
    assert!(estimator.refinement_task(None).is_none() && !estimator.precedes_refinement());
}

#[test]
fn numbers_of_something_else_are_refused() {
    let sample = sample(&SampleRequest::default());
    let mut worker = Worker::new(sample.colour_image(), &sample.depth_map(), Options::default()).unwrap();
    for count in [0, 26, 27, 38, 40] {
        assert_eq!(worker.refine(&vec![0.5; count], |_| {}).unwrap_err().field(), "numbers");
    }
}

/// Tests of over three seconds: `cargo test` runs them, `npm test` only with `--long`.
mod long {
    #[cfg(target_arch = "wasm32")]
    use super::test;
    use super::*;

    #[test]
    fn a_pose_that_does_not_move_lets_a_worker_refine() {
        let camera = Camera::Pinhole(Pinhole { fx: 150.0, fy: 150.0, cx: 31.5, cy: 31.5, lens: Lens::None });
        let plain = SampleRequest { light: light("window").unwrap(), noise: 0.01, ..SampleRequest::default() };
        let holes = SampleRequest { holes: 0.1, depth_noise: 0.1, ..plain.clone() };
        let perspective = SampleRequest { image_camera: camera, depth_camera: camera, ..plain.clone() };
        for (name, request) in [("plain", plain), ("holes", holes), ("perspective", perspective)] {
            let sample = sample(&request);
            let near = near(&sample);
            assert_same(name, &sample, &near);
            let fixed = Options { registration: Registration::Fixed, ..near };
            assert_same(&format!("{name}, fixed"), &sample, &fixed);
        }
    }
}
