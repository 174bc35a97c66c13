//! Rendered rigs: a seed fixes everything, and each kind of scene has its properties.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::scenes::rig::{RigFrame, RigKind, RigRequest, render};
use bimodal_stereo::{ErrorKind, Similarity, Size};

const SMALL: Size = Size { width: 160, height: 120 };

fn small(kind: RigKind, seed: u64, frame: u32) -> RigFrame {
    let request =
        RigRequest { colour_size: Some(SMALL), depth_size: Some(SMALL), ..RigRequest::new(kind, seed, frame) };
    render(&request).expect("a frame")
}

#[test]
fn a_seed_fixes_the_rig_and_a_frame_what_is_seen() {
    for kind in RigKind::ALL {
        let [first, again, second, other] =
            [(7, 0), (7, 0), (7, 1), (8, 0)].map(|(seed, frame)| small(kind, seed, frame));
        assert!(first.colour == again.colour && first.depth == again.depth);
        assert_eq!((first.pose, first.colour_camera, first.depth_camera), {
            (second.pose, second.colour_camera, second.depth_camera)
        });
        assert!(first.colour != second.colour && first.depth != second.depth);
        assert!(first.pose != other.pose && first.colour_camera != other.colour_camera);
    }
}

/// Share of the pixels whose depth lies in a range of metres.
fn share(frame: &RigFrame, range: std::ops::Range<f32>) -> f64 {
    frame.true_depth.iter().filter(|depth| range.contains(depth)).count() as f64 / frame.true_depth.len() as f64
}

#[test]
fn scenes_are_what_they_are_called() {
    for seed in 0..5 {
        for kind in RigKind::ALL {
            let frame = small(kind, seed, 2);
            assert!(share(&frame, 0.1..9.0) > 0.98, "{kind:?} {seed}: nothing is seen");
            let holes = frame.depth.iter().filter(|&&depth| depth == 0).count() as f64 / frame.depth.len() as f64;
            assert!((0.001..0.3).contains(&holes), "{kind:?} {seed}: {holes}");
            // The image is neither all black nor all white.
            let mean = frame.colour.iter().map(|&value| f64::from(value)).sum::<f64>() / frame.colour.len() as f64;
            assert!((90.0..245.0).contains(&mean), "{kind:?} {seed}: {mean}");
            let (near, all) = match kind {
                RigKind::Objects | RigKind::Sheet => (0.4..1.4, 0.3..4.0),
                RigKind::Boxes => (0.3..1.5, 0.25..5.0),
                RigKind::Room => (1.0..4.0, 0.6..5.0),
            };
            assert!(share(&frame, all) > 0.95, "{kind:?} {seed}");
            let least = if kind == RigKind::Room { 0.4 } else { 0.02 };
            assert!(share(&frame, near) > least, "{kind:?} {seed}");
        }
    }
}

#[test]
fn without_noise_the_depth_is_the_true_one_to_half_a_millimetre() {
    let request = RigRequest { noise: 0.0, depth_size: Some(SMALL), ..RigRequest::new(RigKind::Boxes, 4, 0) };
    let frame = render(&request).unwrap();
    let measured = || frame.depth.iter().zip(&frame.true_depth).filter(|(depth, _)| **depth > 0);
    assert!(measured().count() > SMALL.len() / 2);
    assert!(measured().all(|(&depth, truth)| (f32::from(depth) / 1000.0 - truth).abs() < 0.000_501));
}

#[test]
fn requests_out_of_range_name_their_field() {
    let good = RigRequest::new(RigKind::Room, 1, 0);
    let cases = [
        (
            RigRequest { colour_size: Some(Size { width: 8, height: 480 }), ..good.clone() },
            "colourSize",
            ErrorKind::Size,
        ),
        (
            RigRequest { depth_size: Some(Size { width: 640, height: 5000 }), ..good.clone() },
            "depthSize",
            ErrorKind::Size,
        ),
        (RigRequest { noise: f64::NAN, ..good.clone() }, "noise", ErrorKind::Range),
        (RigRequest { noise: -1.0, ..good.clone() }, "noise", ErrorKind::Range),
        (
            RigRequest { motion: Similarity { scale: 1.5, ..Similarity::identity() }, ..good },
            "motion.scale",
            ErrorKind::Range,
        ),
    ];
    for (request, field, kind) in cases {
        let error = render(&request).unwrap_err();
        assert_eq!((error.field(), error.kind()), (field, kind));
    }
}

/// Tests of over three seconds: `cargo test` runs them, `npm test` only with `--long`.
mod long {
    #[cfg(target_arch = "wasm32")]
    use super::test;
    use super::*;

    #[test]
    fn rigs_are_as_their_makers_build_them() {
        let mut sizes = Vec::new();
        for seed in 0..16 {
            let frame = small(RigKind::Sheet, seed, 0);
            frame.pose.validate("pose").unwrap();
            let baseline = frame.pose.translation.norm();
            assert!(frame.pose.scale == 1.0 && (0.0199..0.0801).contains(&baseline), "{baseline}");
            let still =
                bimodal_stereo::Similarity { scale: 1.0, rotation: nalgebra::Matrix3::identity(), ..frame.pose };
            assert!(frame.pose.degrees_to(&still) <= 3.0);
            for camera in [frame.colour_camera, frame.depth_camera] {
                camera.validate("camera").unwrap();
                for [column, row] in [[0.0, 0.0], [159.0, 0.0], [0.0, 119.0], [159.0, 119.0]] {
                    assert!(camera.ray([column, row]).is_some(), "{camera:?}");
                }
            }
            if seed < 4 {
                let frame = render(&RigRequest::new(RigKind::Objects, seed, 0)).unwrap();
                assert_eq!(frame.colour.len(), 4 * frame.colour_size.len());
                assert_eq!(
                    (frame.depth.len(), frame.true_depth.len()),
                    (frame.depth_size.len(), frame.depth_size.len())
                );
                sizes.push((frame.colour_size.width, frame.depth_size.width));
            }
        }
        sizes.sort_unstable();
        sizes.dedup();
        assert!(sizes.len() > 1, "{sizes:?}");
    }
}
