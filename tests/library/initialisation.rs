//! The search, in which only the two views are known.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use std::collections::VecDeque;

use bimodal_stereo::scenes::{Relief, Sample, SampleRequest, Scene, light, surface};
use bimodal_stereo::{
    Angles, ColourSamples, Estimator, Finding, LightSource, Options, Reason, Registration, Size, Stage, Start, Status,
    StepReport, Task, Weights, Worker,
};

fn scene(name: &str, light_name: &str) -> Sample {
    let request = SampleRequest {
        size: Size { width: 64, height: 64 },
        light: light(light_name).unwrap(),
        rotation: Angles { alpha: 10.0, beta: 50.0, gamma: 15.0 }.rotation(),
        scale: 1.1,
        overlap: 0.7,
        noise: 0.01,
        ..Default::default()
    };
    Scene::new(&surface(name).unwrap()).unwrap().sample(&request).unwrap()
}

fn run(sample: &Sample, gain: f32, options: Options) -> StepReport {
    let mut image = sample.colour_image();
    if let ColourSamples::RgbLinear(colours) = &mut image.samples {
        colours.iter_mut().for_each(|value| *value *= gain);
    }
    let mut estimator = Estimator::new(image, &sample.depth_map(), options).unwrap();
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    estimator.report().clone()
}

#[test]
fn nothing_known_is_enough() {
    for (name, light) in [("bust", "window"), ("bust", "colourful"), ("ripples", "window")] {
        let sample = scene(name, light);
        let report = run(&sample, 1.0, Options::default());
        let error = report.pose.degrees_to(&sample.pose);
        assert_eq!(report.status, Status::Converged, "{name} {light}: {report:?}");
        assert!(error < 1.0, "{name} {light}: {error}");
        assert!((report.pose.scale / sample.pose.scale - 1.0).abs() < 0.02, "{name} {light}: {}", report.pose.scale);
        let sigma = report.uncertainty.unwrap().rotation_degrees;
        assert!(error < 4.0 * sigma.iter().map(|s| s * s).sum::<f64>().sqrt(), "{name} {light}: {error} {sigma:?}");
    }
}

#[test]
fn a_known_light_is_used() {
    let sample = scene("bust", "window");
    let known = Options { light: LightSource::Known(sample.light), ..Options::default() };
    let report = run(&sample, 1.0, known);
    assert_eq!(report.status, Status::Converged);
    assert!(report.pose.degrees_to(&sample.pose) < 0.5, "{}", report.pose.degrees_to(&sample.pose));
}

#[test]
fn the_same_input_gives_the_same_pose_and_exposure_does_not_matter() {
    let sample = scene("bust", "overcast");
    let reports = [1.0, 1.0, 0.1, 10.0].map(|gain| run(&sample, gain, Options::default()));
    assert_eq!(reports[0], reports[1]);
    for other in &reports[2..] {
        let off = other.pose.degrees_to(&reports[0].pose);
        assert!(off < 0.01, "{off}");
    }
}

#[test]
fn the_search_comes_in_slices_and_says_how_far_it_is() {
    let sample = scene("bust", "window");
    let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), Options::default()).unwrap();
    let (mut slices, mut last) = (0, -1.0);
    while estimator.is_searching() {
        let report = estimator.step();
        assert_eq!((report.stage, report.iteration, report.status), (Stage::Search, 0, Status::Running));
        let percent = match report.reason {
            Some(Reason::Searching { percent, .. }) => percent,
            Some(Reason::SearchDone { .. }) => 100.0,
            _ => panic!("no progress: {report:?}"),
        };
        assert!((0.0..=100.0).contains(&percent) && percent >= last, "{last} then {percent}");
        (slices, last) = (slices + 1, percent);
    }
    assert!(slices > 50 && last == 100.0, "{slices} {last}");
    let report = estimator.step();
    assert_eq!((report.stage, report.iteration), (Stage::Refinement, 1));
}

/// A ball looks the same from everywhere, and a uniform image has no information, so no pose may be reported as found.
#[test]
fn what_cannot_be_known_is_not_claimed() {
    let ball: Vec<f32> = (0..256 * 256)
        .map(|index| {
            let [x, y] = [(index % 256) as f32 - 127.5, (index / 256) as f32 - 127.5];
            (100.0_f32.powi(2) - x * x - y * y).max(0.0).sqrt()
        })
        .collect();
    let request = SampleRequest {
        size: Size { width: 64, height: 64 },
        light: light("window").unwrap(),
        rotation: Angles { beta: 40.0, ..Angles::default() }.rotation(),
        noise: 0.01,
        ..Default::default()
    };
    let ball = Scene::new(&Relief::new(256, 256, ball).unwrap()).unwrap().sample(&request).unwrap();
    let report = run(&ball, 1.0, Options::default());
    assert!(matches!(report.status, Status::Lost | Status::Ambiguous), "{report:?}");
    assert!(report.reason.is_some());

    let mut grey = scene("bust", "window").colour_image();
    grey.samples = ColourSamples::RgbLinear(vec![0.5; 3 * 64 * 64]);
    let mut estimator = Estimator::new(grey, &ball.depth_map(), Options::default()).unwrap();
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    assert_eq!(estimator.report().status, Status::Lost, "{:?}", estimator.report());
}

/// A depth map whose prior has no weight must not influence the image's normals, which stay poor under a poor light.
#[test]
fn a_prior_without_weight_has_no_say() {
    let sample = scene("bust", "window");
    let truth = &sample.truth.image_normals;
    let error = |prior: f64| {
        let start = Start::Pose {
            rotation: sample.pose.rotation,
            scale: Some(sample.pose.scale),
            translation: Some(sample.pose.translation),
        };
        let weights = Weights { prior, ..Weights::default() };
        let light = LightSource::Known(sample.light);
        let options = Options { light, start, registration: Registration::Fixed, weights, ..Options::default() };
        let mut depth = sample.depth_map();
        depth.normals = Some(sample.truth.depth_normals.interleaved());
        let mut estimator = Estimator::new(sample.colour_image(), &depth, options).unwrap();
        while estimator.report().status == Status::Running {
            estimator.step();
        }
        let found = estimator.image_normals();
        let valid = || (0..found.len()).filter(|&i| found.is_valid(i) && truth.is_valid(i));
        let cosine = |i: usize| found.get(i).iter().zip(truth.get(i)).map(|(a, b)| a * b).sum::<f32>();
        valid().map(|i| cosine(i).min(1.0).acos().to_degrees()).sum::<f32>() / valid().count() as f32
    };
    let (without, with) = (error(0.0), error(0.05));
    assert!(without > 1.5 * with, "{without} {with}");
}

/// Random numbers without a library. They decide which task is given away, which one comes back, and when.
struct Chance(u64);

impl Chance {
    fn below(&mut self, count: u64) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (self.0 >> 33) % count
    }
}

/// Runs with several workers. Each returns its findings late and out of order, and the first one stops after a while. Also
/// returns the number of findings.
fn run_with_workers(sample: &Sample, options: &Options, workers: usize, seed: u64) -> (StepReport, Vec<u32>, usize) {
    let mut chance = Chance(seed);
    let mut estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), options.clone()).unwrap();
    let worker = || Worker::new(sample.colour_image(), &sample.depth_map(), options.clone()).unwrap();
    let mut workers: Vec<(Worker, VecDeque<Vec<f64>>)> = (0..workers).map(|_| (worker(), VecDeque::new())).collect();
    let mut findings = 0;
    while estimator.report().status == Status::Running {
        estimator.step();
        for (index, (worker, tasks)) in workers.iter_mut().enumerate() {
            while tasks.len() < 3 {
                let Some(task) = estimator.take_task() else { break };
                tasks.push_back(task.to_numbers());
            }
            let is_gone = index == 0 && findings > 40;
            if is_gone || chance.below(3) == 0 {
                continue;
            }
            let task = if chance.below(2) == 0 { tasks.pop_front() } else { tasks.pop_back() };
            if let Some(task) = task.and_then(|task| Task::from_numbers(&task)) {
                let finding = worker.perform(&task).unwrap().to_numbers();
                estimator.accept_finding(Finding::from_numbers(&finding).unwrap());
                findings += 1;
            }
        }
    }
    let depth = estimator.image_depth().iter().map(|depth| depth.to_bits()).collect();
    (estimator.report().clone(), depth, findings)
}

/// Tests of over three seconds: `cargo test` runs them, `npm test` only with `--long`.
mod long {
    #[cfg(target_arch = "wasm32")]
    use super::test;
    use super::*;

    #[test]
    fn any_number_of_workers_leaves_the_same_to_the_bit() {
        for (name, light, known) in
            [("bust", "window", false), ("ripples", "overcast", false), ("vase", "colourful", true)]
        {
            let sample = scene(name, light);
            let light = if known { LightSource::Known(sample.light) } else { LightSource::Estimate };
            let options = Options { light, ..Options::default() };
            let (alone, depth, _) = run_with_workers(&sample, &options, 0, 0);
            for (workers, seed) in [(1, 1), (2, 2), (3, 3)] {
                let (report, other, findings) = run_with_workers(&sample, &options, workers, seed);
                assert!(findings > 40, "{name}: {findings}");
                assert_eq!(report, alone, "{name}, {workers} workers");
                assert_eq!(depth, other, "{name}, {workers} workers");
            }
        }
    }

    /// A pose that albedo or shadows may have displaced is not reported as found.
    #[test]
    fn what_paint_and_shadows_mislead_is_doubted() {
        for (name, light) in [("bust", "window"), ("bust", "overcast"), ("vase", "window")] {
            let sample = scene(name, light);
            let mut image = sample.colour_image();
            let ColourSamples::RgbLinear(colours) = &mut image.samples else { unreachable!() };
            for (index, pixel) in colours.chunks_exact_mut(3).enumerate() {
                let [x, y] = [(index % 64) as f32, (index / 64) as f32];
                let shadow = if x + 0.5 * y > 60.0 { 0.4 } else { 1.0 };
                let paint = if (0.35 * x).sin() * (0.3 * y + 1.0).cos() > 0.2 { [0.5, 0.8, 1.1] } else { [1.0; 3] };
                pixel.iter_mut().zip(paint).for_each(|(value, paint)| *value *= shadow * paint);
            }
            let mut estimator = Estimator::new(image, &sample.depth_map(), Options::default()).unwrap();
            while estimator.report().status == Status::Running {
                estimator.step();
            }
            let report = estimator.report();
            let error = report.pose.degrees_to(&sample.pose);
            assert!(error < 3.0 || report.status != Status::Converged, "{name} {light}: {error} {report:?}");
        }
    }
}
