//! Trimming: removes flying pixels and background from the object (docs/method/views.md).
//!
//! The depth map is cut wherever neighbours differ by more than a multiple of the median step. A piece stays if it has
//! enough pixels relative to the largest piece, and lies no farther in front of or behind it than the extent of that
//! piece. Limits: an object whose parts are farther apart in depth loses the smaller parts; trimming can be switched
//! off. The data used to set the constants are not recorded.

use crate::numeric::quantile;
use crate::view::Size;
use crate::view::mask::components;

/// Neighbours are separated beyond this multiple of the median step between neighbours, so that steep but smooth
/// surfaces stay whole.
const JUMP_STEPS: f32 = 12.0;
/// Smallest step that separates neighbours in a metric view, as a share of the median depth, above the noise of
/// consumer sensors at arm's length.
const METRIC_JUMP: f32 = 0.015;
/// Smallest step that separates neighbours, pixels, a slope of 76 degrees.
const PIXEL_JUMP: f32 = 4.0;
/// Smallest number of pixels of a kept piece, as a share of the number in the largest piece.
const LEAST_SHARE: f64 = 0.05;
/// Largest distance of a kept piece in front of or behind the largest piece, in extents of the largest piece.
const REACH: f32 = 1.0;

/// Whether each pixel belongs to the object. `depth` is NaN at holes; `focal_length`, in pixels, is `None` for an
/// orthographic view.
pub fn object_pixels(size: Size, depth: &[f32], focal_length: Option<f64>) -> Vec<bool> {
    let valid = |index: usize| !depth[index].is_nan();
    let mut values: Vec<f32> = depth.iter().copied().filter(|value| !value.is_nan()).collect();
    if values.is_empty() {
        return vec![false; size.len()];
    }
    let median = quantile(&mut values, 0.5);
    let pixel = focal_length.map_or(1.0, |focal_length| median / focal_length as f32);
    let floor = if focal_length.is_some() { METRIC_JUMP * median } else { 0.0 }.max(PIXEL_JUMP * pixel);
    let mut steps: Vec<f32> = (0..size.len())
        .filter(|&index| valid(index))
        .flat_map(|index| size.neighbours(index).map(move |neighbour| (index, neighbour)))
        .filter(|&(index, neighbour)| index < neighbour && valid(neighbour))
        .map(|(index, neighbour)| (depth[index] - depth[neighbour]).abs())
        .collect();
    let cut = if steps.is_empty() { floor } else { floor.max(JUMP_STEPS * quantile(&mut steps, 0.5)) };
    let (labels, counts) = components(size, valid, |a, b| (depth[a] - depth[b]).abs() <= cut);
    let largest = (0..counts.len()).max_by_key(|&label| counts[label]).unwrap_or(0);

    let mut pieces: Vec<Vec<f32>> = vec![Vec::new(); counts.len()];
    for index in (0..size.len()).filter(|&index| valid(index)) {
        pieces[labels[index]].push(depth[index]);
    }
    let near = quantile(&mut pieces[largest], 0.05);
    let far = quantile(&mut pieces[largest], 0.95);
    let width = (counts[largest] as f32).sqrt() * pixel;
    let reach = REACH * (far - near).max(width);
    let keep: Vec<bool> = (0..counts.len())
        .map(|label| {
            let middle = quantile(&mut pieces[label], 0.5);
            counts[label] as f64 >= LEAST_SHARE * counts[largest] as f64
                && middle >= near - reach
                && middle <= far + reach
        })
        .collect();
    labels.into_iter().map(|label| label != usize::MAX && keep[label]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn background_and_flying_pixels_go_and_the_object_stays() {
        let size = Size { width: 40, height: 30 };
        let mut depth: Vec<f32> = (0..size.len())
            .map(|index| {
                let (column, row) = size.position(index);
                1.0 + 0.002 * column as f32 + 0.001 * row as f32
            })
            .collect();
        let outliers = [(3, 1.7), (500, 1.3), (501, 1.31), (777, 0.4)];
        for (index, value) in outliers {
            depth[index] = value;
        }
        for index in (0..size.len()).filter(|index| index % 40 > 37) {
            depth[index] = 2.5;
        }
        depth[900] = f32::NAN;
        let kept = object_pixels(size, &depth, Some(525.0));
        for index in 0..size.len() {
            let bad = index == 900 || index % 40 > 37 || outliers.iter().any(|&(bad, _)| bad == index);
            assert_eq!(kept[index], !bad, "pixel {index}");
        }
    }

    #[test]
    fn two_large_parts_of_one_object_stay() {
        let size = Size { width: 20, height: 20 };
        let depth: Vec<f32> = (0..size.len()).map(|index| if index % 20 < 10 { 50.0 } else { 60.0 }).collect();
        assert!(object_pixels(size, &depth, None).into_iter().all(|kept| kept));
    }
}
