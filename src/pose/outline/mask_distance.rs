//! The signed distance to a mask's outline, pixels: exact at pixel centres, bilinear between them.

use crate::pose::distance_transform::squared_distances;
use crate::view::Size;

/// Half the distance over which the gradient is taken, pixels: the steps of a mask's outline turn its normal by up to 45
/// degrees, and noise of normals passes for information about turns that leave the outline as it is.
const BESIDE: f64 = 4.0;

/// Distance to the outline of a mask, positive outside; the outline runs between pixels.
pub struct MaskDistance {
    size: Size,
    values: Vec<f32>,
}

impl MaskDistance {
    /// Of the pixels where `mask` is true.
    pub fn new(size: Size, mask: &[bool]) -> Self {
        let to_inside = squared_distances(size, |index| mask[index]);
        let to_outside = squared_distances(size, |index| !mask[index]);
        let signed = |(inside, outside): (&f64, &f64)| {
            (if *inside > 0.0 { inside.sqrt() - 0.5 } else { 0.5 - outside.sqrt() }) as f32
        };
        Self { size, values: to_inside.iter().zip(&to_outside).map(signed).collect() }
    }

    #[cfg(test)]
    fn of_pixel(&self, index: usize) -> f64 {
        f64::from(self.values[index])
    }

    /// The distance at a position and its gradient. Beyond the frame it grows with the distance from the frame.
    pub fn at(&self, place: [f64; 2]) -> (f64, [f64; 2]) {
        let gradient = [0, 1].map(|axis| {
            let beside = |by: f64| {
                let mut place = place;
                place[axis] += by;
                self.value(place)
            };
            (beside(BESIDE) - beside(-BESIDE)) / (2.0 * BESIDE)
        });
        (self.value(place), gradient)
    }

    fn value(&self, [column, row]: [f64; 2]) -> f64 {
        let last = [(self.size.width - 1) as f64, (self.size.height - 1) as f64];
        let within = [column.clamp(0.0, last[0]), row.clamp(0.0, last[1])];
        let value = f64::from(self.size.bilinear(&self.values, within[0] as f32, within[1] as f32));
        let beyond = (column - within[0]).hypot(row - within[1]);
        if beyond > 0.0 { value.max(0.0) + beyond } else { value }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_a_search_over_all_pixels() {
        let size = Size { width: 23, height: 17 };
        let mask: Vec<bool> = (0..size.len()).map(|index| (index * 7919) % 11 < 3 || index % 23 > 16).collect();
        let distance = MaskDistance::new(size, &mask);
        for index in 0..size.len() {
            let (column, row) = size.position(index);
            let others = (0..size.len()).filter(|&other| mask[other] != mask[index]).map(|other| {
                let (c, r) = size.position(other);
                (c as f64 - column as f64).hypot(r as f64 - row as f64)
            });
            let nearest = others.fold(f64::INFINITY, f64::min) - 0.5;
            let expected = if mask[index] { -nearest } else { nearest };
            assert!((distance.of_pixel(index) - expected).abs() < 1e-5, "{index}");
        }
    }

    #[test]
    fn the_gradient_is_the_slope_and_the_frame_is_no_end() {
        let size = Size { width: 40, height: 30 };
        let mask: Vec<bool> = (0..size.len())
            .map(|index| {
                let (column, row) = size.position(index);
                (column as f64 - 20.0).hypot(row as f64 - 14.0) < 9.0
            })
            .collect();
        let distance = MaskDistance::new(size, &mask);
        for at in [[3.0, 4.0], [31.0, 14.2], [19.3, 25.0], [-5.0, 40.0]] {
            let (value, gradient) = distance.at(at);
            let [right, down] = [at[0] - 20.0, at[1] - 14.0];
            let exact = right.hypot(down);
            // The frame is nearer than the disc where the place is beyond it.
            assert!((value - (exact - 9.0)).abs() < if at[0] < 0.0 { 20.0 } else { 0.6 }, "{at:?}: {value}");
            assert!((gradient[0] * right + gradient[1] * down) / exact > 0.9, "{at:?}: {gradient:?}");
        }
        assert!(distance.at([-50.0, 14.0]).0 > 50.0);
    }
}
