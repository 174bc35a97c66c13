//! Angles and closed-form similarity against numpy and scipy (scripts/reference/pose.py).

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::{Angles, Similarity};
use nalgebra::{Matrix3, Vector3};

const REFERENCE: &str = include_str!("../../scripts/reference/pose.csv");

fn cases(name: &str) -> Vec<Vec<f64>> {
    let prefix = format!("{name},");
    let lines = REFERENCE.lines().filter_map(|line| line.strip_prefix(&prefix));
    lines.map(|line| line.split(',').map(|word| word.parse().unwrap()).collect()).collect()
}

#[test]
fn angles_agree_with_scipy() {
    let cases = cases("angles");
    assert_eq!(cases.len(), 8);
    for case in cases {
        let rotation = Matrix3::from_row_slice(&case[3..12]);
        let angles = Angles { alpha: case[0], beta: case[1], gamma: case[2] };
        assert!((angles.rotation() - rotation).norm() < 1e-13);
        let found = Angles::of(&rotation);
        assert!((found.alpha - angles.alpha).abs() < 1e-9, "{found:?} {angles:?}");
        assert!((found.beta - angles.beta).abs() < 1e-9, "{found:?} {angles:?}");
        assert!((found.gamma - angles.gamma).abs() < 1e-9, "{found:?} {angles:?}");
    }
}

#[test]
fn closed_form_agrees_with_umeyama() {
    let cases = cases("pairs");
    assert_eq!(cases.len(), 8);
    for case in cases {
        let (pairs, answer) = case.split_at(case.len() - 13);
        let (mut depth, mut image, mut weights) = (Vec::new(), Vec::new(), Vec::new());
        for pair in pairs.chunks_exact(7) {
            depth.push(Vector3::from_column_slice(&pair[..3]));
            image.push(Vector3::from_column_slice(&pair[3..6]));
            weights.push(pair[6]);
        }
        let found = Similarity::fit(&depth, &image, Some(&weights), None).unwrap();
        assert!((found.scale - answer[0]).abs() < 1e-12, "{} {}", found.scale, answer[0]);
        assert!((found.rotation - Matrix3::from_row_slice(&answer[1..10])).norm() < 1e-12);
        assert!((found.translation - Vector3::from_column_slice(&answer[10..])).norm() < 1e-12);
    }
}
