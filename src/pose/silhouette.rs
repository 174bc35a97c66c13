//! How far a place lies off an image's mask: the distance to the nearest pixel of the mask, bilinear between pixels.

use super::distance_transform::squared_distances;
use crate::view::Size;

/// Distance off the mask that costs nothing, pixels: neither a pixel's own size nor the rounding of a mask is an error. Without it
/// a silhouette pulls poses by one to two degrees.
pub(crate) const SLACK: f64 = 0.7;
/// Weight of points off the mask, against one of what else decides (local contrast, depth discontinuities).
pub(super) const OUTSIDE_WEIGHT: f64 = 3.0;

/// Distances to one mask, pixels: zero on it.
pub(super) struct Silhouette {
    size: Size,
    distance: Vec<f32>,
    /// Likewise, negative on the mask: the distance to its border.
    signed: Vec<f32>,
}

impl Silhouette {
    pub fn new(size: Size, mask: &[bool]) -> Self {
        let [distance, inside] = [true, false].map(|kind| distances(size, |index| mask[index] == kind));
        // Centres of pixels on either side of a border are half a pixel off it.
        let signed =
            distance.iter().zip(&inside).map(|(out, inn)| if *out > 0.0 { out - 0.5 } else { 0.5 - inn }).collect();
        Self { size, distance, signed }
    }

    /// Pixels of the mask next to one that is not.
    pub fn border(&self) -> usize {
        self.signed.iter().filter(|&&signed| signed == -0.5).count()
    }

    /// The signed distance of a place and its derivative.
    pub fn signed_at(&self, place: [f64; 2]) -> (f64, [f64; 2]) {
        self.bilinear(&self.signed, place)
    }

    /// Distance of a place and its derivative by column and row. Beyond the raster that of the nearest place within
    /// counts on: an object that the frame cuts off may go on there.
    pub fn at(&self, place: [f64; 2]) -> (f64, [f64; 2]) {
        self.bilinear(&self.distance, place)
    }

    fn bilinear(&self, field: &[f32], [column, row]: [f64; 2]) -> (f64, [f64; 2]) {
        let Size { width, height } = self.size;
        let x = column.clamp(0.0, (width - 1) as f64);
        let y = row.clamp(0.0, (height - 1) as f64);
        let (left, top) = ((x as usize).min(width - 2), (y as usize).min(height - 2));
        let (u, v) = (x - left as f64, y - top as f64);
        let at = |c: usize, r: usize| f64::from(field[self.size.index(left + c, top + r)]);
        let [a, b, c, d] = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
        let distance = (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d);
        let gradient = [(1.0 - v) * (b - a) + v * (d - c), (1.0 - u) * (c - a) + u * (d - b)];
        (distance, gradient)
    }
}

/// Distance of each pixel to the nearest one of a kind.
fn distances(size: Size, is_of_kind: impl Fn(usize) -> bool) -> Vec<f32> {
    squared_distances(size, is_of_kind).into_iter().map(|squared| squared.sqrt() as f32).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Size = Size { width: 40, height: 32 };

    fn disc() -> Silhouette {
        let inside = |(column, row): (usize, usize)| (column as f64 - 18.0).hypot(row as f64 - 15.0) <= 9.0;
        Silhouette::new(SIZE, &(0..SIZE.len()).map(|index| inside(SIZE.position(index))).collect::<Vec<_>>())
    }

    #[test]
    fn distances_are_those_to_the_nearest_pixel_of_the_mask() {
        let mask: Vec<bool> = (0..SIZE.len()).map(|index| index % 97 == 5).collect();
        let silhouette = Silhouette::new(SIZE, &mask);
        for index in (0..SIZE.len()).step_by(13) {
            let (column, row) = SIZE.position(index);
            let distance = |other: usize| {
                let (c, r) = SIZE.position(other);
                (column as f64 - c as f64).hypot(row as f64 - r as f64)
            };
            let nearest = (0..SIZE.len()).filter(|&other| mask[other]).map(distance).fold(f64::INFINITY, f64::min);
            let (found, _) = silhouette.at([column as f64, row as f64]);
            assert!((found - nearest).abs() < 1e-5, "{found} {nearest}");
        }
    }

    #[test]
    fn signed_distances_cross_zero_at_the_border_and_slopes_are_difference_quotients() {
        let silhouette = disc();
        for angle in 0..12 {
            let (sine, cosine) = (0.5 * f64::from(angle)).sin_cos();
            let off = |radius: f64| silhouette.signed_at([18.0 + radius * cosine, 15.0 + radius * sine]).0;
            assert!((off(4.0) + 5.3).abs() < 0.8 && (off(13.0) - 3.7).abs() < 0.8, "{angle}");
            assert!(off(8.0) < 0.0 && off(11.0) > 0.0);
        }
        let (place, step) = ([29.3, 20.6], 1e-6);
        let (_, slope) = silhouette.signed_at(place);
        let right =
            silhouette.signed_at([place[0] + step, place[1]]).0 - silhouette.signed_at([place[0] - step, place[1]]).0;
        let down =
            silhouette.signed_at([place[0], place[1] + step]).0 - silhouette.signed_at([place[0], place[1] - step]).0;
        assert!((slope[0] - right / (2.0 * step)).abs() < 1e-4 && (slope[1] - down / (2.0 * step)).abs() < 1e-4);
    }

    #[test]
    fn a_mask_without_border_is_near_everywhere() {
        let all = Silhouette::new(SIZE, &[true; 40 * 32]);
        assert_eq!((all.at([-50.0, 100.0]), all.border()), ((0.0, [0.0; 2]), 0));
    }
}
