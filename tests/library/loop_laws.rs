//! Laws of the loop for every scene: it does not depend on exposure, origin or chance, and its claims are true.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::{DepthData, Sample, SampleRequest, Scene, light, surface};
use bimodal_stereo::{
    ColourSamples, DepthSamples, Estimator, Light, LightSource, Options, Reason, Registration, Similarity, Start,
    Status, StepReport,
};
use nalgebra::{Matrix3, Vector3};

/// Largest difference of two equal poses, degrees: the aim for images with another exposure.
const SAME: f64 = 1e-3;
/// Tolerance for a mirrored scene, which has the same numbers in another order and other RANSAC samples: a tenth of the aim for the bust.
const MIRRORED: f64 = 0.1;

fn bust(request: &SampleRequest) -> Sample {
    Scene::new(&surface("bust").expect("a name")).and_then(|scene| scene.sample(request)).expect("a sample")
}

fn noisy(light_name: &str) -> Sample {
    bust(&SampleRequest {
        light: light(light_name).expect("a name"),
        noise: 0.01,
        depth_noise: 0.1,
        holes: 0.05,
        ..Default::default()
    })
}

fn known(sample: &Sample) -> Options {
    Options { light: LightSource::Known(sample.light), ..Options::paper() }
}

fn estimator(sample: &Sample, options: Options) -> Estimator {
    Estimator::new(sample.colour_image(), &sample.depth_map(), options).expect("good input")
}

/// Runs to the end and returns the reports of all steps.
fn finish(estimator: &mut Estimator) -> Vec<StepReport> {
    let mut reports = vec![estimator.report().clone()];
    while estimator.report().status == Status::Running {
        reports.push(estimator.step().clone());
    }
    reports
}

/// All outputs of an estimator as bits, so that NaN equals NaN.
fn outcome(estimator: &Estimator) -> (StepReport, Vec<u32>, Vec<i32>, Light) {
    let (image, depth) = (estimator.image_normals().interleaved(), estimator.depth_normals().interleaved());
    let fields = [&image[..], &estimator.image_depth(), &depth, estimator.refined_depth(), &estimator.residual()];
    let bits = fields.into_iter().flatten().map(|value| value.to_bits()).collect();
    (estimator.report().clone(), bits, estimator.correspondence().to_vec(), estimator.light())
}

fn exposure_leaves_the_pose_alone(sample: &Sample, options: &Options) {
    let poses = [1.0, 0.1, 10.0].map(|gain: f32| {
        let mut image = sample.colour_image();
        let ColourSamples::RgbLinear(colours) = &mut image.samples else { panic!("floats") };
        colours.iter_mut().for_each(|colour| *colour *= gain);
        let mut estimator = Estimator::new(image, &sample.depth_map(), options.clone()).expect("good input");
        finish(&mut estimator);
        let StepReport { status, pose, iteration, .. } = estimator.report();
        let degrees = pose.degrees_to(&sample.pose);
        println!("colours x{gain}: {} after {iteration} iterations, {degrees:.4} degrees off", status.name());
        *pose
    });
    let apart = poses.map(|pose| pose.degrees_to(&poses[0]));
    assert!(apart.iter().all(|&degrees| degrees < SAME), "{apart:?} degrees apart");
}

#[test]
fn exposure_leaves_the_pose_alone_under_a_known_light() {
    let sample = bust(&SampleRequest::default());
    exposure_leaves_the_pose_alone(&sample, &known(&sample));
}

#[test]
fn exposure_leaves_the_pose_alone_under_a_known_light_with_noise() {
    let sample = noisy("colourful");
    exposure_leaves_the_pose_alone(&sample, &known(&sample));
}

/// Starts from the true pose. From other poses these stages do not find the pose under an unknown light, and the last
/// digit of a colour decides which way the loop goes.
#[test]
fn exposure_leaves_the_pose_alone_under_an_estimated_light() {
    for name in ["colourful", "window"] {
        let light = light(name).expect("a built-in light");
        let sample = bust(&SampleRequest { light, ..SampleRequest::default() });
        let Similarity { rotation, scale, translation } = sample.pose;
        let start = Start::Pose { rotation, scale: Some(scale), translation: Some(translation) };
        exposure_leaves_the_pose_alone(&sample, &Options { start, ..Options::paper() });
    }
}

#[test]
fn two_runs_are_the_same_to_the_last_bit() {
    let sample = noisy("window");
    for options in [known(&sample), Options::paper()] {
        let [first, second] = [(); 2].map(|()| {
            let mut estimator = estimator(&sample, options.clone());
            let reports = finish(&mut estimator);
            (reports, outcome(&estimator))
        });
        assert!(first == second);
    }
}

#[test]
fn reset_is_a_new_beginning() {
    let sample = noisy("window");
    let mut used = estimator(&sample, known(&sample));
    finish(&mut used);
    used.reset(Options::paper()).expect("good options");
    let mut fresh = estimator(&sample, Options::paper());
    assert!(outcome(&used) == outcome(&fresh));
    assert!(finish(&mut used) == finish(&mut fresh));
    assert!(outcome(&used) == outcome(&fresh));
}

#[test]
fn steps_after_the_end_change_nothing() {
    let sample = noisy("colourful");
    let mut estimator = estimator(&sample, known(&sample));
    finish(&mut estimator);
    let end = outcome(&estimator);
    estimator.step();
    estimator.step_stage();
    assert!(outcome(&estimator) == end);
}

#[test]
fn stages_make_up_a_step() {
    let sample = noisy("colourful");
    let mut whole = estimator(&sample, known(&sample));
    let mut staged = estimator(&sample, known(&sample));
    for _ in 0..2 {
        whole.step();
        while staged.report().iteration < whole.report().iteration {
            staged.step_stage();
        }
        assert!(outcome(&whole) == outcome(&staged));
    }
}

#[test]
fn the_origin_of_orthographic_depth_moves_only_the_translation() {
    const OFFSET: f32 = 100.0;
    let sample = noisy("colourful");
    let [near, far] = [0.0, OFFSET].map(|offset| {
        let mut map = sample.depth_map();
        let DepthSamples::Float(depth) = &mut map.samples else { panic!("a depth map") };
        depth.iter_mut().for_each(|depth| *depth += offset);
        let mut estimator = Estimator::new(sample.colour_image(), &map, known(&sample)).expect("good input");
        finish(&mut estimator);
        estimator
    });
    let (a, b) = (near.report().pose, far.report().pose);
    let moved = b.translation - a.translation + b.scale * b.rotation * Vector3::new(0.0, 0.0, f64::from(OFFSET));
    println!("{:.2e} degrees, scale {:.2e}, translation {moved:?}", a.degrees_to(&b), b.scale - a.scale);
    assert!(a.degrees_to(&b) < SAME);
    // Tolerance: a thousandth of a degree about an origin at the distance of the offset.
    assert!(moved.norm() < SAME.to_radians() * f64::from(OFFSET));
}

/// The sample's inputs, mirrored: columns reversed, x negated.
fn mirrored(sample: &Sample) -> Sample {
    let mut other = sample.clone();
    let size = sample.image.size;
    for index in 0..size.len() {
        let (column, row) = size.position(index);
        let from = size.index(size.width - 1 - column, row);
        other.image.mask[index] = sample.image.mask[from];
        other.depth.mask[index] = sample.depth.mask[from];
        other.image.colours[3 * index..3 * index + 3].copy_from_slice(&sample.image.colours[3 * from..3 * from + 3]);
    }
    let DepthData::Map(depth) = &mut other.depth.data else { panic!("a depth map") };
    depth.chunks_exact_mut(size.width).for_each(<[f32]>::reverse);
    // The sign changes for L4, L5 and L8, which multiply x, xy and xz.
    for channel in &mut other.light.0 {
        for odd in [3, 4, 7] {
            channel[odd] = -channel[odd];
        }
    }
    other
}

#[test]
fn a_mirrored_scene_has_the_mirrored_answer() {
    let sample = noisy("colourful");
    let mirrored = mirrored(&sample);
    let [here, there] = [&sample, &mirrored].map(|sample| {
        let mut estimator = estimator(sample, known(sample));
        finish(&mut estimator);
        estimator.report().pose
    });
    let mirror = Matrix3::from_diagonal(&Vector3::new(-1.0, 1.0, 1.0));
    let back = Similarity { rotation: mirror * there.rotation * mirror, ..there };
    println!("{:.2e} degrees apart", back.degrees_to(&here));
    assert!(back.degrees_to(&here) < MIRRORED);
}

#[test]
fn an_iteration_taken_back_is_no_convergence() {
    let [colourful, window] = ["colourful", "window"].map(noisy);
    let true_pose = |sample: &Sample| Start::Pose {
        rotation: sample.pose.rotation,
        scale: Some(sample.pose.scale),
        translation: Some(sample.pose.translation),
    };
    // A light unrelated to the image: whatever normals the shading finds, the pose gets worse.
    let nonsense = LightSource::Known(Light(colourful.light.0.map(|channel| channel.map(|value| -3.0 * value))));
    let runs = [
        (
            &colourful,
            Options { light: nonsense.clone(), start: true_pose(&colourful), scale: Some(1.0), ..Options::paper() },
        ),
        (&colourful, Options { light: nonsense, ..Options::paper() }),
        (&window, Options { start: true_pose(&window), ..Options::paper() }),
        (&window, Options::paper()),
        (&window, known(&window)),
        (&window, Options { registration: Registration::Fixed, start: true_pose(&window), ..known(&window) }),
    ];
    let mut taken_back = 0;
    for (sample, options) in runs {
        let mut estimator = estimator(sample, options);
        for pair in finish(&mut estimator).windows(2) {
            if matches!(pair[1].reason, Some(Reason::TakenBack { .. })) {
                taken_back += 1;
                assert_ne!(pair[1].status, Status::Converged);
                assert_eq!(pair[1].pose, pair[0].pose);
            }
        }
    }
    println!("{taken_back} iterations were taken back");
    assert!(taken_back > 0, "nothing was tested");
}

#[test]
fn reports_and_maps_hold_what_they_promise() {
    for light_name in ["colourful", "overcast"] {
        let sample = noisy(light_name);
        let mut estimator = estimator(&sample, Options::paper());
        while estimator.report().status == Status::Running {
            let report = estimator.step().clone();
            let objective = report.objective;
            let terms = [objective.shading, objective.prior, objective.registration, objective.refinement];
            assert!(
                terms.iter().all(|term| (0.0..=1.0).contains(term)),
                "means of robust residuals that saturate at one: {terms:?}"
            );
            assert!((objective.total() - terms.iter().sum::<f64>()).abs() < 1e-12);
            assert!((0.0..=1.0).contains(&report.overlap) && (0.0..=1.0).contains(&report.inliers));

            let (image, depth) = (estimator.image(), estimator.depth());
            let mut taken = vec![false; depth.size.len()];
            for (pixel, &index) in estimator.correspondence().iter().enumerate() {
                assert_eq!(estimator.residual()[pixel].is_finite(), image.mask[pixel], "residual of pixel {pixel}");
                if index == -1 {
                    continue;
                }
                let index = usize::try_from(index).expect("-1 or an index");
                assert!(image.mask[pixel] && depth.mask[index]);
                assert!(!std::mem::replace(&mut taken[index], true), "depth pixel {index} answers twice");
            }
            assert!(taken.contains(&true));
        }
    }
}
