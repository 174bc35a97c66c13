//! Compares cameras of a rig with OpenCV (scripts/reference/lens.py).

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use bimodal_stereo::{Lens, Pinhole};

const REFERENCE: &str = include_str!("../../scripts/reference/lens.csv");
/// Tolerance in pixels; both programs compute in 64 bits.
const SAME_PIXEL: f64 = 1e-9;

fn lens(name: &str, numbers: &[f64]) -> Lens {
    match name {
        "fisheye" => Lens::Fisheye(numbers.try_into().unwrap()),
        _ => Lens::Brown(std::array::from_fn(|k| numbers.get(k).copied().unwrap_or(0.0))),
    }
}

#[test]
fn pixels_agree_with_opencv() {
    let mut cameras = 0;
    for line in REFERENCE.lines() {
        let (name, numbers) = line.split_once(',').unwrap();
        let numbers: Vec<f64> = numbers.split(',').map(|word| word.parse().unwrap()).collect();
        let (intrinsics, rest) = numbers.split_at(4);
        let [fx, fy, cx, cy] = intrinsics.try_into().unwrap();
        let count = match name {
            "brown5" => 5,
            "brown8" => 8,
            _ => 4,
        };
        let (coefficients, points) = rest.split_at(count);
        let camera = Pinhole { fx, fy, cx, cy, lens: lens(name, coefficients) };
        assert_eq!((camera.validate("camera"), points.len()), (Ok(()), 25));
        for row in points.chunks_exact(5) {
            let (point, pixel) = ([row[0], row[1], row[2]], [row[3], row[4]]);
            let [column, down] = camera.project(point).unwrap();
            assert!((column - pixel[0]).hypot(down - pixel[1]) < SAME_PIXEL, "{name}: {point:?}");
            let [x, y, z] = camera.ray(pixel).unwrap();
            assert!((x * point[2] - point[0]).hypot(y * point[2] - point[1]) < 1e-8 && z == 1.0, "{name}: {point:?}");
        }
        cameras += 1;
    }
    assert_eq!(cameras, 18);
}

/// Found by the fuzzer: rays with infinite slopes, and rays with finite slopes whose pixels are infinite.
#[test]
fn slopes_beyond_all_numbers_are_no_rays() {
    for lens in [Lens::None, Lens::Brown([0.0; 8]), Lens::Fisheye([0.0; 4])] {
        let camera = Pinhole { fx: 500.0, fy: 500.0, cx: 320.0, cy: 240.0, lens };
        for beyond in [f64::INFINITY, f64::NEG_INFINITY, f64::NAN, f64::MAX, -1e300] {
            assert_eq!((camera.ray([beyond, 0.0]), camera.ray([0.0, beyond])), (None, None), "{lens:?}");
        }
        let sharp = Pinhole { fx: 5e-324, ..camera };
        assert_eq!(sharp.ray([0.0, 0.0]), None, "{lens:?}");
    }
}
