//! Laws that hold for all poses.

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use crate::common::laws;
use bimodal_stereo::{Angles, ErrorKind, RansacOptions, Similarity, ransac};
use nalgebra::{Rotation3, Vector3};
use proptest::prelude::*;

fn vector(size: f64) -> impl Strategy<Value = Vector3<f64>> {
    prop::array::uniform3(-size..size).prop_map(Vector3::from)
}

prop_compose! {
    fn similarity()(turn in vector(3.0), scale in 0.1..10.0, translation in vector(100.0)) -> Similarity {
        Similarity { scale, rotation: Rotation3::new(turn).into_inner(), translation }
    }
}

fn distance(a: &Similarity, b: &Similarity) -> f64 {
    (a.rotation - b.rotation).norm() + (a.scale / b.scale).ln().abs() + (a.translation - b.translation).norm() / 1e3
}

/// Points in a box, enough that no four of them determine the result.
fn cloud(points: usize) -> impl Strategy<Value = Vec<Vector3<f64>>> {
    prop::collection::vec(vector(20.0), points)
}

proptest! {
    #![proptest_config(laws(128))]

    #[test]
    fn angles_round_trip(alpha in -180.0..180.0, beta in -90.0..=90.0, gamma in -180.0..180.0) {
        let rotation = Angles { alpha, beta, gamma }.rotation();
        let found = Angles::of(&rotation);
        prop_assert!((found.rotation() - rotation).norm() < 1e-9);
        prop_assert!((-90.0..=90.0).contains(&found.beta));
    }

    #[test]
    fn angles_round_trip_near_the_poles(
        alpha in -180.0..180.0, sign in prop::sample::select(vec![-1.0, 1.0]), power in -12.0..-2.0, gamma in -180.0..180.0,
    ) {
        let beta = sign * (90.0 - 10.0_f64.powf(power));
        let rotation = Angles { alpha, beta, gamma }.rotation();
        let found = Angles::of(&rotation);
        // Within 1e-6 rad of the pole alpha is set to zero, which changes the rotation by about 1e-6 rad.
        prop_assert!((found.rotation() - rotation).norm() < 4e-6, "{found:?}");
    }

    #[test]
    fn inverse_and_composition(a in similarity(), b in similarity(), point in vector(50.0)) {
        prop_assert!(distance(&a.after(&a.inverse()), &Similarity::identity()) < 1e-9);
        prop_assert!(distance(&a.inverse().after(&a), &Similarity::identity()) < 1e-9);
        prop_assert!((a.after(&b).apply(point) - a.apply(b.apply(point))).norm() < 1e-8);
        prop_assert!(distance(&a.after(&b).inverse(), &b.inverse().after(&a.inverse())) < 1e-9);
    }

    #[test]
    fn a_way_between_two_poses(a in similarity(), b in similarity(), share in 0.0..1.0, centre in vector(50.0)) {
        prop_assert!(distance(&a.towards(&b, 0.0, centre), &a) < 1e-8);
        prop_assert!(distance(&a.towards(&b, 1.0, centre), &b) < 1e-8);
        let half_way = a.towards(&b, share, centre);
        half_way.validate("pose").unwrap();
        prop_assert!((a.degrees_to(&half_way) - share * a.degrees_to(&b)).abs() < 1e-5);
        prop_assert!((half_way.apply(centre) - a.apply(centre).lerp(&b.apply(centre), share)).norm() < 1e-8);
    }

    #[test]
    fn closed_form_recovers_a_similarity(pose in similarity(), points in cloud(12)) {
        let image: Vec<_> = points.iter().map(|&point| pose.apply(point)).collect();
        prop_assert!(distance(&Similarity::fit(&points, &image, None, None).unwrap(), &pose) < 1e-9);
        let held = Similarity::fit(&points, &image, None, Some(2.0)).unwrap();
        prop_assert_eq!(held.scale, 2.0);
        prop_assert!((held.rotation - pose.rotation).norm() < 1e-9);
    }

    #[test]
    fn consensus_withstands_outliers(
        pose in similarity(), points in cloud(60), wrong in cloud(18), noise in cloud(60), seed: u64,
    ) {
        let mut image: Vec<_> = points.iter().map(|&point| pose.apply(point)).collect();
        for (target, wrong) in image.iter_mut().zip(&wrong) {
            *target += pose.scale * wrong + Vector3::repeat(pose.scale * 40.0);
        }
        let options = RansacOptions { threshold: 0.1 * pose.scale, seed, ..RansacOptions::default() };
        let found = ransac(&points, &image, &options).unwrap();
        prop_assert!(distance(&found.pose, &pose) < 1e-9);
        prop_assert_eq!(&found.inliers, &(18..60).collect::<Vec<u32>>());
        prop_assert_eq!(&found, &ransac(&points, &image, &options).unwrap());
        let linear = Similarity::nearest(&found.matrix, Vector3::zeros()).unwrap();
        prop_assert!((linear.rotation - pose.rotation).norm() < 1e-6);
        // Noise of 0.01 leaves an error of that order divided by the root of the number of pairs.
        for (target, noise) in image.iter_mut().zip(&noise) {
            *target += pose.scale * 5e-4 * noise;
        }
        let found = ransac(&points, &image, &options).unwrap();
        prop_assert!(found.pose.degrees_to(&pose) < 0.1, "{}", found.pose.degrees_to(&pose));
    }
}

#[test]
fn degenerate_pairs_are_errors() {
    let kind = |depth: &[Vector3<f64>]| {
        let image: Vec<_> = depth.iter().map(|point| point * 2.0).collect();
        ransac(depth, &image, &RansacOptions::default()).map_err(|error| error.kind())
    };
    let grid = |k: usize| Vector3::new((k % 5) as f64, (k / 5) as f64, 0.0);
    let plane: Vec<_> = (0..25).map(grid).collect();
    let line: Vec<_> = (0..25).map(|k| Vector3::new(1.0, 2.0, 3.0) * k as f64).collect();
    assert_eq!(kind(&plane), Err(ErrorKind::Degenerate));
    assert_eq!(kind(&line), Err(ErrorKind::Degenerate));
    assert_eq!(kind(&vec![Vector3::new(1.0, 2.0, 3.0); 100]), Err(ErrorKind::Degenerate));
    assert_eq!(kind(&plane[..3]), Err(ErrorKind::Degenerate));
    assert_eq!(kind(&[]), Err(ErrorKind::Degenerate));
    assert_eq!(kind(&vec![Vector3::repeat(f64::NAN); 9]), Err(ErrorKind::Range));

    let fit = |points: &[Vector3<f64>]| Similarity::fit(points, points, None, None).map_err(|error| error.kind());
    assert!(fit(&plane).is_ok(), "a plane determines a similarity, though no linear model");
    assert_eq!(fit(&line), Err(ErrorKind::Degenerate));
    assert_eq!(fit(&plane[..3]), Err(ErrorKind::Degenerate));
    assert_eq!(fit(&vec![Vector3::repeat(1.0); 100]), Err(ErrorKind::Degenerate));
    assert_eq!(fit(&vec![Vector3::repeat(f64::NAN); 9]), Err(ErrorKind::Range));
}

/// Found by the fuzzer: the maximum of several numbers skips NaN.
#[test]
fn a_rotation_with_entries_that_are_no_numbers_is_none() {
    for (first, second) in (0..81).map(|pair| (pair / 9, pair % 9)) {
        let mut pose = Similarity::identity();
        (pose.rotation[first], pose.rotation[second]) = (f64::NAN, f64::NAN);
        assert_eq!(pose.validate("pose").map_err(|error| error.kind()), Err(ErrorKind::Range), "{first}, {second}");
    }
    let mut pose = Similarity::identity();
    pose.rotation.fixed_columns_mut::<2>(0).fill(f64::NAN);
    assert_eq!(pose.validate("pose").map_err(|error| error.kind()), Err(ErrorKind::Range));
}
