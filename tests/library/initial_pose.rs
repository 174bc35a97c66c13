//! A given initial pose: trusted within its tolerance, searched around, and kept if nothing better is near.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::{Sample, SampleRequest, Scene, light, surface};
use bimodal_stereo::{
    Angles, Camera, ColourSamples, DepthView, Estimator, Lens, Options, Pinhole, Reason, Registration, Similarity,
    Size, Start, StartTolerance, Status, StepReport,
};
use nalgebra::{Rotation3, Vector3};

const SIZE: Size = Size { width: 96, height: 72 };

fn pinhole(focal_length: f64) -> Camera {
    Camera::Pinhole(Pinhole { fx: focal_length, fy: focal_length, cx: 47.5, cy: 35.5, lens: Lens::None })
}

/// The bust at a distance of four times its height from both calibrated cameras.
fn request(light_name: &str) -> SampleRequest {
    SampleRequest {
        size: SIZE,
        light: light(light_name).unwrap(),
        rotation: Angles { alpha: -5.0, beta: 20.0, gamma: 5.0 }.rotation(),
        noise: 0.01,
        depth_noise: 0.1,
        image_camera: pinhole(288.0),
        depth_camera: pinhole(288.0),
        ..Default::default()
    }
}

fn sampled(request: &SampleRequest) -> Sample {
    Scene::new(&surface("bust").unwrap()).unwrap().sample(request).unwrap()
}

fn perspective(light_name: &str) -> Sample {
    sampled(&request(light_name))
}

#[derive(Clone, Copy, PartialEq)]
enum Albedo {
    None,
    /// Four albedos in a pattern.
    Patches,
    /// Spots of dirt, which are a quarter darker than what is between them.
    Dirt,
    /// Black on white, in letters of one pixel, which neighbouring pixels cannot distinguish from noise.
    FinePrint,
}

/// Albedo that no shading explains, on a dark background.
fn varying(sample: &Sample, kind: Albedo) -> ColourSamples {
    let palette = [[0.8, 0.2, 0.1], [0.1, 0.6, 0.2], [0.2, 0.2, 0.7], [0.9, 0.9, 0.3]];
    let pattern = |index: usize| {
        let (column, row) = sample.image.size.position(index);
        if !sample.image.mask[index] {
            return [0.02; 3];
        }
        if kind == Albedo::Patches {
            return palette[(column / 5 + 2 * (row / 7) + (column + row) / 11) % 4];
        }
        if (index as u64 * 2_654_435_761) >> 7 & 3 < 2 { [0.04; 3] } else { [0.9; 3] }
    };
    let dirty = |index: usize, colours: [f32; 3]| {
        let (column, row) = sample.image.size.position(index);
        let [x, y] = [column, row].map(|at| at as f32);
        let dirt = (0.55 * x + 0.2 * y).sin() * (0.5 * y - 0.3 * x).sin();
        let albedo = (-0.15 * (4.0 * dirt).tanh()).exp();
        colours.map(|colour| albedo * (0.05 + colour))
    };
    let shaded = |index: usize| {
        let colours = [0, 1, 2].map(|channel| sample.image.colours[3 * index + channel]);
        if kind == Albedo::Dirt && sample.image.mask[index] {
            return dirty(index, colours);
        }
        let shading = colours.iter().sum::<f32>() / 3.0;
        pattern(index).map(|albedo: f32| if sample.image.mask[index] { albedo * (0.5 + shading) } else { albedo })
    };
    ColourSamples::RgbLinear((0..sample.image.size.len()).flat_map(shaded).collect())
}

/// The true pose, rotated about the depth camera.
fn turned_about_the_sensor(sample: &Sample, axis: Vector3<f64>, degrees: f64) -> Similarity {
    let turn = Rotation3::new(axis.normalize() * degrees.to_radians()).into_inner();
    Similarity { rotation: sample.pose.rotation * turn, ..sample.pose }
}

fn told(pose: &Similarity) -> Options {
    let Similarity { rotation, scale, translation } = *pose;
    Options {
        start: Start::Pose { rotation, scale: Some(scale), translation: Some(translation) },
        ..Options::default()
    }
}

fn run(sample: &Sample, albedo: Albedo, options: Options) -> StepReport {
    let mut image = sample.colour_image();
    if albedo != Albedo::None {
        image.samples = varying(sample, albedo);
    }
    let mut estimator = Estimator::new(image, &sample.depth_map(), options).unwrap();
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    estimator.report().clone()
}

fn middle(sample: &Sample) -> Vector3<f64> {
    DepthView::new(&sample.depth_map(), true).unwrap().points.centroid()
}

#[test]
fn what_never_moved_has_no_sigmas() {
    let sample = perspective("window");
    let start = turned_about_the_sensor(&sample, Vector3::y(), 2.0);
    for albedo in [Albedo::None, Albedo::Patches] {
        let report = run(&sample, albedo, Options { registration: Registration::Icp, ..told(&start) });
        let moved = report.pose.translation != start.translation || report.pose.degrees_to(&start) > 0.0;
        assert_eq!(report.uncertainty.is_some(), moved, "{report:?}");
    }
}

/// Tests of over three seconds: `cargo test` runs them, `npm test` only with `--long`.
mod long {
    #[cfg(target_arch = "wasm32")]
    use super::test;
    use super::*;

    #[test]
    fn a_told_start_never_ends_further_from_itself_than_its_tolerance() {
        let sample = perspective("window");
        let middle = middle(&sample);
        for (degrees, distance, off) in [(1.0, 2.0, 4.0), (30.0, 3.0, 6.0), (5.0, 100.0, 8.0), (0.1, 0.1, 1.0)] {
            for albedo in [Albedo::None, Albedo::Patches] {
                let start = turned_about_the_sensor(&sample, Vector3::new(0.5, 1.0, 0.0), off);
                let start_tolerance = StartTolerance { degrees, distance: Some(distance) };
                let report = run(&sample, albedo, Options { start_tolerance, ..told(&start) });
                let moved = (report.pose.apply(middle) - start.apply(middle)).norm();
                let turned = report.pose.degrees_to(&start);
                let tolerance = format!("{degrees} {distance} {off} {}: {turned} {moved}", albedo != Albedo::None);
                assert!(turned <= degrees && moved <= distance, "{tolerance}");
                // A pose beyond the tolerance cannot be found, and the status says so.
                if off > degrees {
                    assert_ne!(report.status, Status::Converged, "{tolerance}");
                }
                if turned == 0.0 && moved == 0.0 {
                    assert_eq!((report.status, &report.uncertainty), (Status::Ambiguous, &None), "{tolerance}");
                    assert_eq!(report.reason, Some(Reason::InitialPoseKept), "{tolerance}");
                }
            }
        }
    }

    #[test]
    fn a_start_turned_about_the_sensor_comes_home_under_an_unknown_light() {
        for (name, axis) in [("window", Vector3::new(0.3, 1.0, 0.1)), ("colourful", Vector3::new(1.0, -0.4, 0.2))] {
            let sample = perspective(name);
            let searched = run(&sample, Albedo::None, Options::default());
            for degrees in [1.0, 3.0, 8.0] {
                let start = turned_about_the_sensor(&sample, axis, degrees);
                let report = run(&sample, Albedo::None, told(&start));
                let (error, apart) = (report.pose.degrees_to(&sample.pose), report.pose.degrees_to(&searched.pose));
                assert!(error < 2.0 && apart < 0.2, "{name}, {degrees}: {error} {apart} {report:?}");
                assert_ne!(report.status, Status::Lost, "{name}, {degrees}");
            }
        }
    }

    #[test]
    fn silhouettes_find_an_object_of_varying_albedo_of_which_nothing_is_known() {
        let sample = perspective("window");
        let report = run(&sample, Albedo::Patches, Options::default());
        assert!(report.pose.degrees_to(&sample.pose) < 10.0, "{report:?}");
        let middle = middle(&sample);
        let off = report.pose.apply(middle) - sample.pose.apply(middle);
        assert!(off.xy().norm() < 4.0, "{off} {report:?}");
        // With a single albedo, photometric registration determines the pose.
        let plain = run(&sample, Albedo::None, Options::default());
        let by_silhouettes = matches!(plain.reason, Some(Reason::AlbedoVaries { .. } | Reason::SilhouetteBlind { .. }));
        assert!(plain.pose.degrees_to(&sample.pose) < 2.0 && !by_silhouettes, "{plain:?}");
    }

    /// Silhouettes move what the depth camera sees until it fills the mask, and the first search places the object as far
    /// away as the depth camera is.
    #[test]
    fn an_object_of_varying_albedo_is_found_though_the_depth_camera_sees_a_part_of_it_from_nearer() {
        let request = SampleRequest {
            rotation: Angles { alpha: -5.0, beta: 10.0, gamma: 5.0 }.rotation(),
            overlap: 0.5,
            depth_camera: pinhole(192.0),
            ..request("colourful")
        };
        let sample = sampled(&request);
        let report = run(&sample, Albedo::Dirt, Options::default());
        let middle = middle(&sample);
        let off = report.pose.apply(middle) - sample.pose.apply(middle);
        assert!(report.pose.degrees_to(&sample.pose) < 2.0 && off.norm() < 3.0, "{off} {report:?}");
    }

    /// If the views are over 20 degrees apart, their occluding contours are different curves on the surface, so that
    /// silhouettes fit best off the true pose.
    #[test]
    fn the_image_outweighs_silhouettes_that_agree() {
        let rotation = Angles { alpha: -12.0, beta: -26.0, gamma: 4.0 }.rotation();
        let sample = sampled(&SampleRequest { rotation, ..request("colourful") });
        let report = run(&sample, Albedo::Dirt, Options::default());
        let error = report.pose.degrees_to(&sample.pose);
        assert!(error < 2.0, "{error} {report:?}");
    }

    #[test]
    fn silhouettes_find_the_place_of_an_object_whose_rotation_alone_is_told() {
        let sample = perspective("window");
        let middle = middle(&sample);
        for degrees in [0.0, 3.0] {
            let start = turned_about_the_sensor(&sample, Vector3::new(0.2, 1.0, 0.3), degrees);
            let rotation_alone = Start::Pose { rotation: start.rotation, scale: None, translation: None };
            let report = run(&sample, Albedo::Patches, Options { start: rotation_alone, ..Options::default() });
            let off = report.pose.apply(middle) - sample.pose.apply(middle);
            assert!(off.xy().norm() < 1.5, "{off} {report:?}");
            assert!(report.pose.degrees_to(&sample.pose) < 3.5, "{report:?}");
        }
    }

    #[test]
    fn silhouettes_bring_an_object_of_varying_albedo_home() {
        let sample = perspective("window");
        let middle = middle(&sample);
        for (axis, degrees) in [(Vector3::new(0.2, 1.0, 0.3), 3.0), (Vector3::new(1.0, 0.1, -0.5), 4.0)] {
            let start = turned_about_the_sensor(&sample, axis, degrees);
            let report = run(&sample, Albedo::Patches, told(&start));
            let off = |pose: &Similarity| pose.apply(middle) - sample.pose.apply(middle);
            let (before, after) = (off(&start), off(&report.pose));
            // A pixel measures one unit at the object.
            assert!(after.xy().norm() < 1.5 && before.norm() > 10.0, "{before} {after} {report:?}");
            assert!(report.pose.degrees_to(&sample.pose) < 3.5, "{report:?}");
            // The error is within the sigmas of the silhouettes.
            let sigma = report.uncertainty.as_ref().expect("sigmas");
            let turned = Rotation3::from_matrix_unchecked(report.pose.rotation * sample.pose.rotation.transpose());
            let turned = turned.scaled_axis().map(f64::to_degrees);
            for axis in 0..3 {
                assert!(turned[axis].abs() < 3.0 * sigma.rotation_degrees[axis], "{turned} {sigma:?}");
            }
        }
    }

    /// The mask ends at the frame, but the object does not.
    #[test]
    fn a_frame_that_cuts_the_object_in_half_does_not_pull_it_inside() {
        let Camera::Pinhole(camera) = pinhole(288.0) else { unreachable!() };
        let off_centre = Camera::Pinhole(Pinhole { cx: 95.0, ..camera });
        let sample = sampled(&SampleRequest { image_camera: off_centre, ..request("colourful") });
        let middle = middle(&sample);
        for degrees in [0.0, 2.0] {
            let start = turned_about_the_sensor(&sample, Vector3::new(0.2, 1.0, 0.3), degrees);
            let report = run(&sample, Albedo::Dirt, told(&start));
            let off = report.pose.apply(middle) - sample.pose.apply(middle);
            assert!(report.pose.degrees_to(&sample.pose) < 2.5 && off.xy().norm() < 1.0, "{off} {report:?}");
        }
    }

    /// The prior about an initial pose must not count for more than its sigma says.
    #[test]
    fn initial_poses_six_degrees_apart_end_close_to_each_other() {
        let sample = perspective("colourful");
        let middle = middle(&sample);
        let [one, other] = [-3.0_f64, 3.0].map(|degrees| {
            let turn = Rotation3::new(Vector3::y() * degrees.to_radians()).into_inner();
            let place = sample.pose.apply(middle);
            let translation = turn * (sample.pose.translation - place) + place;
            let start = Similarity { rotation: turn * sample.pose.rotation, translation, ..sample.pose };
            run(&sample, Albedo::Dirt, told(&start))
        });
        let apart = one.pose.degrees_to(&other.pose);
        assert!(apart < 2.0, "{apart} {one:?} {other:?}");
    }

    #[test]
    fn fine_print_is_not_taken_for_noise_that_explains_the_colours() {
        // Letters of one pixel are uncorrelated between neighbours, as noise is; only their amplitude distinguishes them from a camera's noise.
        let sample = perspective("window");
        let middle = middle(&sample);
        for (axis, degrees) in [(Vector3::new(0.2, 1.0, 0.3), 3.0), (Vector3::new(1.0, 0.1, -0.5), 4.0)] {
            let start = turned_about_the_sensor(&sample, axis, degrees);
            let report = run(&sample, Albedo::FinePrint, told(&start));
            let off = |pose: &Similarity| (pose.apply(middle) - sample.pose.apply(middle)).xy().norm();
            assert!(off(&report.pose) < 1.5 && off(&start) > 10.0, "{} {report:?}", off(&report.pose));
            let by_silhouettes =
                matches!(report.reason, Some(Reason::AlbedoVaries { .. } | Reason::SilhouetteBlind { .. }));
            assert!(by_silhouettes, "{report:?}");
        }
    }
}
