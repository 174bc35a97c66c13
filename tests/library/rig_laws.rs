//! Laws of the calibration check for every rig, cue and candidate.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::common::laws;
use bimodal_stereo::scenes::rig::{RigFrame, RigKind, RigRequest, render};
use bimodal_stereo::{
    CalibrationCheck, CheckReport, CheckVerdict, ColourSamples, Cue, DepthSamples, Pinhole, RigView, Similarity, Size,
};
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

const SMALL: Size = Size { width: 96, height: 72 };

fn small(kind: RigKind, seed: u64) -> RigFrame {
    let request = RigRequest { colour_size: Some(SMALL), depth_size: Some(SMALL), ..RigRequest::new(kind, seed, 0) };
    render(&request).expect("a frame")
}

fn view(frame: &RigFrame, is_known: bool) -> RigView {
    RigView {
        name: "frame".into(),
        image_size: [frame.colour_size.width, frame.colour_size.height],
        image: ColourSamples::Rgba8(frame.colour.clone()),
        transfer: None,
        image_mask: None,
        image_camera: is_known.then_some(frame.colour_camera),
        depth_size: [frame.depth_size.width, frame.depth_size.height],
        depth: DepthSamples::Integer(frame.depth.clone()),
        unit: None,
        intensity: None,
        depth_mask: None,
        depth_camera: Some(frame.depth_camera),
    }
}

fn check(view: RigView, candidates: &[Similarity], cues: &[Cue]) -> CheckReport {
    let named = candidates.iter().enumerate().map(|(index, pose)| (index.to_string(), *pose)).collect();
    let mut check = CalibrationCheck::new(vec![view], named, cues).expect("a check");
    while !check.step() {}
    check.report().expect("a report").clone()
}

/// Every number of a report, by name.
fn numbers(report: &CheckReport) -> Vec<(String, f64)> {
    let CheckReport {
        estimate, overlap, middle, covariance, focal, health, candidates, cues, frames, sensitivity, ..
    } = report;
    let mut all = vec![];
    let mut add = |name: &str, values: &[f64]| all.extend(values.iter().map(|value| (name.to_owned(), *value)));
    add("estimate", estimate.rotation.as_slice());
    add("estimate", estimate.translation.as_slice());
    add("overlap", &[*overlap]);
    add("middle", middle);
    add("covariance", covariance.as_slice());
    add("focal", focal.as_ref().map_or(&[], |focal| focal.as_slice()));
    add("health", &[health.pixels, health.interval[0], health.interval[1]]);
    for one in candidates {
        let [low, high] = one.health.interval;
        add(&one.name, &[one.off_degrees, one.off_millimetres, one.health.pixels, low, high, one.probability]);
        add(&one.name, &one.off_axes);
    }
    cues.iter().for_each(|cue| add(cue.cue.name(), &[cue.share, cue.sharpness]));
    frames.iter().for_each(|frame| add(&frame.name, &[frame.share]));
    for curve in sensitivity {
        add("sensitivity", &curve.offsets);
        add("sensitivity", &curve.values);
    }
    all
}

fn turned(pose: &Similarity, turn: Vector3<f64>, shift: Vector3<f64>) -> Similarity {
    let change = Similarity { scale: 1.0, rotation: Rotation3::new(turn).into_inner(), translation: shift };
    change.after(pose)
}

fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-size..size).prop_map(Vector3::from)
}

/// The image is cut to its last tenth, which shows about as much of the depth map.
#[test]
fn an_estimate_that_shows_few_of_the_points_judges_no_candidate() {
    const KEPT: usize = 16;
    let size = Size { width: 160, height: 120 };
    let request =
        RigRequest { colour_size: Some(size), depth_size: Some(size), ..RigRequest::new(RigKind::Boxes, 1, 0) };
    let frame = render(&request).expect("a frame");
    let first = size.width - KEPT;
    let strip: Vec<u8> = frame.colour.chunks_exact(4 * size.width).flat_map(|row| row[4 * first..].to_vec()).collect();
    let camera = Pinhole { cx: frame.colour_camera.cx - first as f64, ..frame.colour_camera };
    let cut = RigView {
        image_size: [KEPT, size.height],
        image: ColourSamples::Rgba8(strip),
        image_camera: Some(camera),
        ..view(&frame, true)
    };
    let wrong = turned(&frame.pose, Vector3::new(0.0, 0.03, 0.0), Vector3::zeros());
    let report = check(cut, &[frame.pose, wrong], &Cue::ALL);
    assert!(report.overlap > 0.02 && report.overlap < 0.15, "{}", report.overlap);
    for candidate in &report.candidates {
        assert_eq!(candidate.verdict, CheckVerdict::Undecided, "{candidate:?}");
        assert_eq!(candidate.reason.code(), "little-overlap", "{candidate:?}");
    }
    let whole = check(view(&frame, true), &[frame.pose], &Cue::ALL);
    assert!(whole.overlap > 0.5 && whole.overlap <= 1.0, "{}", whole.overlap);
}

/// With a guessed camera the next step is to find out its intrinsics.
#[test]
fn the_next_frame_is_expected_to_sharpen_the_least_certain_unknown() {
    let size = Size { width: 160, height: 120 };
    let request =
        RigRequest { colour_size: Some(size), depth_size: Some(size), ..RigRequest::new(RigKind::Boxes, 1, 0) };
    let frame = render(&request).expect("a frame");
    let report = check(view(&frame, true), &[frame.pose], &Cue::ALL);
    let next = report.next.expect("a proposal");
    assert!(next.expected > 0.0 && next.expected < next.sigma, "{next:?}");
    assert_eq!(next.frame, "frame");
    assert!(next.to_string().contains(&next.axis.to_string()), "{next}");
    let moved = RigRequest { motion: next.pose, ..request };
    assert_ne!(render(&moved).expect("a moved frame").depth, frame.depth);
    assert_eq!(check(view(&frame, false), &[frame.pose], &Cue::ALL).next, None);
}

/// Tests of over three seconds: `cargo test` runs them, `npm test` only with `--long`.
mod long {
    #[cfg(target_arch = "wasm32")]
    use super::test;
    use super::*;

    /// The first candidate is so far off that a single search would end 6 degrees off.
    #[test]
    fn candidates_far_off_lead_to_one_estimate() {
        let size = Size { width: 160, height: 120 };
        let request =
            RigRequest { colour_size: Some(size), depth_size: Some(size), ..RigRequest::new(RigKind::Boxes, 1, 0) };
        let frame = render(&request).expect("a frame");
        let axes = [Vector3::new(1.0, 0.3, 0.2), Vector3::new(-0.3, 1.0, -0.2), Vector3::new(0.2, -0.8, 1.0)];
        for axis in axes {
            let turn = axis.normalize() * 8_f64.to_radians();
            let candidate = turned(&frame.pose, turn, Vector3::new(0.08, -0.02, 0.03));
            let report = check(view(&frame, true), &[candidate], &Cue::ALL);
            let off = (report.estimate.translation - frame.pose.translation).norm();
            assert!(report.estimate.degrees_to(&frame.pose) < 0.5 && off < 0.01, "{off} {report:?}");
            assert_eq!(report.candidates[0].verdict, CheckVerdict::Off);
        }
    }

    proptest! {
        #![proptest_config(laws(10))]

        #[test]
        fn a_report_holds_numbers_alone_and_no_verdict_without_evidence(
            kind in prop::sample::select(RigKind::ALL.to_vec()),
            seed in 0_u64..1000,
            cues in prop::sample::subsequence(Cue::ALL.to_vec(), 1..=4),
            turn in vector(0.05),
            shift in vector(0.02),
            is_known in prop::bool::weighted(0.8),
        ) {
            let frame = small(kind, seed);
            let report = check(view(&frame, is_known), &[frame.pose, turned(&frame.pose, turn, shift)], &cues);
            for (name, value) in numbers(&report) {
                prop_assert!(value.is_finite(), "{name}: {value} of {kind:?} {seed} by {cues:?}");
            }
            let has_evidence = report.cues.iter().any(|cue| cue.sharpness > 0.0);
            for candidate in report.candidates {
                let [turn, shift] = [0, 3].map(|first| Vector3::from_column_slice(&candidate.off_axes[first..first + 3]).norm());
                prop_assert!((turn - candidate.off_degrees).abs() < 1e-9, "{candidate:?}");
                prop_assert!((shift - candidate.off_millimetres).abs() < 1e-9, "{candidate:?}");
                prop_assert!(has_evidence || candidate.verdict == CheckVerdict::Undecided, "{candidate:?} by {cues:?}");
            }
        }
    }

    /// Without masks there is no silhouette: the estimate equals the candidate to the last digit, and nothing is known about its error.
    #[test]
    fn silhouettes_without_masks_leave_every_candidate_undecided() {
        for kind in RigKind::ALL {
            for seed in 0..4 {
                let frame = small(kind, seed);
                let report = check(view(&frame, true), &[frame.pose], &[Cue::Silhouette]);
                let candidate = &report.candidates[0];
                assert_eq!((report.verdict, candidate.verdict), (CheckVerdict::Undecided, CheckVerdict::Undecided));
                assert!(candidate.off_degrees < 1e-4 && candidate.probability > 0.99, "{kind:?} {seed}: {candidate:?}");
            }
        }
    }

    /// Pixels outside the image's mask have no effect: other colours there change no digit of any cue's result.
    #[test]
    fn every_cue_obeys_the_mask_of_the_image() {
        let size = Size { width: 192, height: 144 };
        let request =
            RigRequest { colour_size: Some(size), depth_size: Some(size), ..RigRequest::new(RigKind::Boxes, 3, 0) };
        let frame = render(&request).expect("a frame");
        let is_used =
            |index: usize| (48..144).contains(&(index % size.width)) && (36..108).contains(&(index / size.width));
        let far =
            |index: usize| !((40..152).contains(&(index % size.width)) && (28..116).contains(&(index / size.width)));
        let mask: Vec<u8> = (0..size.len()).map(|index| u8::from(is_used(index))).collect();
        let mut other = frame.colour.clone();
        for index in (0..size.len()).filter(|&index| far(index)) {
            other[4 * index..4 * index + 3].fill((37 * index % 251) as u8);
        }
        for cue in [Cue::Edges, Cue::Shading, Cue::Information, Cue::Silhouette] {
            let report = |colour: &[u8], mask: Option<&[u8]>| {
                let view = RigView {
                    image: ColourSamples::Rgba8(colour.to_vec()),
                    image_mask: mask.map(<[u8]>::to_vec),
                    depth_mask: Some(vec![1; size.len()]),
                    ..view(&frame, true)
                };
                let report = check(view, &[frame.pose], &[cue]);
                (report.estimate.matrix(), report.candidates[0].probability)
            };
            assert_eq!(report(&frame.colour, Some(&mask)), report(&other, Some(&mask)), "{cue:?}");
            if cue != Cue::Silhouette {
                assert_ne!(report(&frame.colour, None), report(&other, None), "{cue:?}");
            }
        }
    }
}
