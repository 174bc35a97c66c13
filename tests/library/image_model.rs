//! Compares the image model with other people's renders (MIT-Berkeley Intrinsic Images under natural lights).

#[cfg(target_arch = "wasm32")]
use wasm_bindgen_test::wasm_bindgen_test as test;

use std::path::Path;

use crate::common::{data_dir, median, read_csv, read_npy_f32, read_png};
use bimodal_stereo::{Light, Size};

/// Error allowed for central differences in the natural logarithm; only slopes cause it.
const CENTRAL_BOUND: f64 = 0.004;
/// Bound of the natural logarithm for the slopes with which the renders were made. A step of a 16-bit value changes the
/// logarithm by 1.5e-4 at a tenth of the range, the usual grey of the renders.
const SOBEL_BOUND: f64 = 1.5e-4;

/// Slopes of the heights by Sobel's 3 x 3 filters, as in the renders; NaN where a neighbour is missing.
fn sobel(heights: &[f32], size: Size, column: usize, row: usize) -> [f64; 2] {
    let at = |x: usize, y: usize| f64::from(heights[size.index(column + x - 1, row + y - 1)]);
    let across = |y: usize| at(2, y) - at(0, y);
    let down = |x: usize| at(x, 2) - at(x, 0);
    [(across(0) + 2.0 * across(1) + across(2)) / 8.0, (down(0) + 2.0 * down(1) + down(2)) / 8.0]
}

/// Slopes by central differences, NaN where a neighbour is missing.
fn central(heights: &[f32], size: Size, column: usize, row: usize) -> [f64; 2] {
    let at = |x: usize, y: usize| f64::from(heights[size.index(x, y)]);
    [(at(column + 1, row) - at(column - 1, row)) / 2.0, (at(column, row + 1) - at(column, row - 1)) / 2.0]
}

type Slopes = fn(&[f32], Size, usize, usize) -> [f64; 2];

/// Median of |log S - log of the render| over all channels and pixels, with the number of values.
fn difference(folder: &Path, slopes: Slopes) -> (f64, usize) {
    let (size, heights) = read_npy_f32(&folder.join("height.npy"));
    let light = Light::from_slice("light", &read_csv(&folder.join("natural_light.csv")).concat()).expect("27 numbers");
    let render = read_png(&folder.join("natural_shading_color.png"));
    assert_eq!((render.size, render.channels, render.bits), (size, 3, 16));
    let mut differences = Vec::new();
    for row in 1..size.height - 1 {
        for column in 1..size.width - 1 {
            let [p, q] = slopes(&heights, size, column, row);
            let length = (1.0 + p * p + q * q).sqrt();
            let predicted = light.shade([-p / length, -q / length, -1.0 / length]);
            for (channel, log) in predicted.into_iter().enumerate() {
                let value = render.values[3 * size.index(column, row) + channel];
                // Black has no logarithm, and white is clipped.
                if !log.is_nan() && (1..u16::MAX).contains(&value) {
                    differences.push((log - (f64::from(value) / f64::from(u16::MAX)).ln()).abs());
                }
            }
        }
    }
    let count = differences.len();
    (median(differences), count)
}

#[test]
#[ignore = "needs ../shared/data"]
fn the_formula_reproduces_renders_of_natural_light() {
    let data = data_dir();
    for object in ["raccoon", "frog2"] {
        let folder = data.join("mit_berkeley").join(object);
        let (sobel, count) = difference(&folder, sobel);
        let (central, _) = difference(&folder, central);
        println!(
            "{object}: median |log difference| {sobel:.5} by Sobel, {central:.5} by central differences, {count} values"
        );
        assert!(count > 10_000, "{object}: {count} values");
        assert!(sobel <= SOBEL_BOUND && central <= CENTRAL_BOUND, "{object}: {sobel}, {central}");
    }
}
