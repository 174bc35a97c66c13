//! Distance of a position from an image's mask, exact at pixel centres and bilinear between them.

use super::distance_transform::squared_distances;
use crate::view::Size;

/// Distance off the mask that costs nothing, pixels. The size of a pixel and the rounding of a mask are not errors, and
/// without this slack the silhouette would bias the pose.
pub(crate) const SLACK: f64 = 0.7;
/// Weight of points off the mask, relative to the other terms (local contrast, depth discontinuities).
pub(super) const OUTSIDE_WEIGHT: f64 = 3.0;
/// Half the distance over which [`Silhouette::smoothly_signed_at`] takes its gradient, pixels. The steps of a mask's
/// border turn its normal by up to 45 degrees, and that noise would pass for information about rotations that do not
/// change the border.
const SMOOTHING: f64 = 4.0;

/// Distances to one mask, pixels.
pub(crate) struct Silhouette {
    size: Size,
    /// Distance to the nearest pixel of the mask; zero on the mask.
    outside: Vec<f32>,
    /// Distance to the mask's border, which runs between pixels; negative on the mask.
    signed: Vec<f32>,
}

impl Silhouette {
    pub fn new(size: Size, mask: &[bool]) -> Self {
        let [outside, inside] = [true, false].map(|kind| distances(size, |index| mask[index] == kind));
        // Centres of pixels on either side of the border are half a pixel from it.
        let signed =
            outside.iter().zip(&inside).map(|(out, inn)| if *out > 0.0 { out - 0.5 } else { 0.5 - inn }).collect();
        Self { size, outside, signed }
    }

    /// Number of mask pixels that have a neighbour off the mask.
    pub fn border(&self) -> usize {
        self.signed.iter().filter(|&&signed| signed == -0.5).count()
    }

    /// Distance to the mask, and its derivative by column and row. Beyond the frame it is that of the nearest position
    /// inside, because an object cut off by the frame may continue there.
    pub fn at(&self, place: [f64; 2]) -> (f64, [f64; 2]) {
        self.bilinear(&self.outside, place)
    }

    /// Distance to the mask; beyond the frame see [`beyond_frame`](Self::beyond_frame).
    pub fn beyond_frame_at(&self, place: [f64; 2]) -> f64 {
        self.beyond_frame(place, self.bilinear(&self.outside, place).0)
    }

    /// Signed distance to the border and its derivative; beyond the frame as in [`at`](Self::at).
    pub fn signed_at(&self, place: [f64; 2]) -> (f64, [f64; 2]) {
        self.bilinear(&self.signed, place)
    }

    /// Signed distance to the border, and its gradient over several pixels; beyond the frame see
    /// [`beyond_frame`](Self::beyond_frame).
    pub fn smoothly_signed_at(&self, place: [f64; 2]) -> (f64, [f64; 2]) {
        let value = |place| self.beyond_frame(place, self.bilinear(&self.signed, place).0);
        let gradient = [0, 1].map(|axis| {
            let beside = |by: f64| value(std::array::from_fn(|k| if k == axis { place[k] + by } else { place[k] }));
            (beside(SMOOTHING) - beside(-SMOOTHING)) / (2.0 * SMOOTHING)
        });
        (value(place), gradient)
    }

    /// Distance beyond the frame, from the `distance` of the nearest position inside. It grows with the distance from the
    /// frame, but not where the frame cuts the object off, because the object may continue there. The growth sets in
    /// gradually, so that the distance is continuous where the mask's border meets the frame.
    fn beyond_frame(&self, place: [f64; 2], distance: f64) -> f64 {
        let [x, y] = self.within(place);
        let off_frame = (place[0] - x).hypot(place[1] - y);
        distance + off_frame * (distance / SMOOTHING).clamp(0.0, 1.0)
    }

    fn within(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        // `clamp` is not used, because its panic prints both limits, which takes 8 kB of code for floats.
        let within = |value: f64, length: usize| value.max(0.0).min((length - 1) as f64);
        [within(column, self.size.width), within(row, self.size.height)]
    }

    fn bilinear(&self, field: &[f32], place: [f64; 2]) -> (f64, [f64; 2]) {
        let Size { width, height } = self.size;
        let [x, y] = self.within(place);
        let (left, top) = ((x as usize).min(width.saturating_sub(2)), (y as usize).min(height.saturating_sub(2)));
        let (u, v) = (x - left as f64, y - top as f64);
        let at = |c: usize, r: usize| {
            let (column, row) = ((left + c).min(width - 1), (top + r).min(height - 1));
            f64::from(field[self.size.index(column, row)])
        };
        let [a, b, c, d] = [at(0, 0), at(1, 0), at(0, 1), at(1, 1)];
        let distance = (1.0 - v) * ((1.0 - u) * a + u * b) + v * ((1.0 - u) * c + u * d);
        let gradient = [(1.0 - v) * (b - a) + v * (d - c), (1.0 - u) * (c - a) + u * (d - b)];
        (distance, gradient)
    }
}

/// Distance from each pixel to the nearest pixel of a kind.
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
    fn signed_distances_are_those_of_a_search_over_all_pixels() {
        let size = Size { width: 23, height: 17 };
        let mask: Vec<bool> = (0..size.len()).map(|index| (index * 7919) % 11 < 3 || index % 23 > 16).collect();
        let silhouette = Silhouette::new(size, &mask);
        for index in 0..size.len() {
            let (column, row) = size.position(index);
            let others = (0..size.len()).filter(|&other| mask[other] != mask[index]).map(|other| {
                let (c, r) = size.position(other);
                (c as f64 - column as f64).hypot(r as f64 - row as f64)
            });
            let nearest = others.fold(f64::INFINITY, f64::min) - 0.5;
            let expected = if mask[index] { -nearest } else { nearest };
            let (found, _) = silhouette.smoothly_signed_at([column as f64, row as f64]);
            assert!((found - expected).abs() < 1e-5, "{index}");
        }
    }

    #[test]
    fn the_smooth_gradient_points_away_from_the_mask_and_the_frame_is_no_end() {
        let silhouette = disc();
        for at in [[3.0, 4.0], [31.0, 14.2], [18.3, 27.0], [-5.0, 40.0]] {
            let (value, gradient) = silhouette.smoothly_signed_at(at);
            let [right, down] = [at[0] - 18.0, at[1] - 15.0];
            let exact = right.hypot(down);
            // Beyond the frame, the frame is nearer than the disc.
            assert!((value - (exact - 9.0)).abs() < if at[0] < 0.0 { 20.0 } else { 0.6 }, "{at:?}: {value}");
            assert!((gradient[0] * right + gradient[1] * down) / exact > 0.9, "{at:?}: {gradient:?}");
        }
        let far = [-50.0, 14.0];
        assert!(silhouette.smoothly_signed_at(far).0 > 50.0 && silhouette.beyond_frame_at(far) > 50.0);
        assert_eq!(silhouette.at(far), silhouette.at([0.0, 14.0]));
    }

    #[test]
    fn an_object_that_the_frame_cuts_off_continues_beyond_it() {
        let inside = |(column, row): (usize, usize)| (column as f64 - 2.0).hypot(row as f64 - 15.0) <= 9.0;
        let mask: Vec<bool> = (0..SIZE.len()).map(|index| inside(SIZE.position(index))).collect();
        let cut = Silhouette::new(SIZE, &mask);
        for column in [-3.0, -20.0, -300.0] {
            assert!(cut.smoothly_signed_at([column, 15.0]).0 < 0.0 && cut.beyond_frame_at([column, 15.0]) == 0.0);
            // Where the frame is off the mask, the object does not continue.
            assert!(cut.smoothly_signed_at([column, 31.0]).0 > 6.0 - column, "{column}");
        }
        // No step along a line beyond the frame.
        let along = |row: i32| cut.smoothly_signed_at([-10.0, 0.1 * f64::from(row)]).0;
        let largest = (0..320).map(|row| (along(row + 1) - along(row)).abs()).fold(0.0, f64::max);
        assert!(largest < 0.5, "{largest}");
    }

    #[test]
    fn a_mask_of_one_pixel_has_distances_as_well() {
        let silhouette = Silhouette::new(Size { width: 1, height: 1 }, &[true]);
        assert_eq!((silhouette.at([0.3, -2.0]).0, silhouette.beyond_frame_at([4.0, 3.0])), (0.0, 0.0));
    }

    #[test]
    fn a_mask_without_border_is_near_everywhere() {
        let all = Silhouette::new(SIZE, &[true; 40 * 32]);
        assert_eq!((all.at([-50.0, 100.0]), all.border()), ((0.0, [0.0; 2]), 0));
    }
}
