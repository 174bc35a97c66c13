//! A raster's size, its pixels and their neighbours, and bilinear interpolation between pixels.

use crate::error::{Error, ErrorKind, Result};

/// Smallest side of a view; smaller views do not determine normals and a light.
pub const SMALLEST_SIDE: usize = 4;
/// Largest side of a view; the samples of two such views fit a 32-bit memory.
pub const LARGEST_SIDE: usize = 4096;

/// Width and height of a raster in pixels; row-major, pixel (0, 0) top left.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Size {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
}

impl Size {
    /// A size within 4x4 .. 4096x4096.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] with `field` otherwise.
    pub fn new(field: &'static str, width: usize, height: usize) -> Result<Self> {
        for side in [width, height] {
            if !(SMALLEST_SIDE..=LARGEST_SIDE).contains(&side) {
                return Err(Error::new(
                    ErrorKind::Size,
                    field,
                    format!("sides must lie within {SMALLEST_SIDE} .. {LARGEST_SIDE} pixels, not {width}x{height}"),
                ));
            }
        }
        Ok(Self { width, height })
    }

    /// Number of pixels.
    #[must_use]
    #[expect(clippy::len_without_is_empty, reason = "a size is never empty")]
    pub const fn len(self) -> usize {
        self.width * self.height
    }

    /// Index of the pixel at `column`, `row`.
    #[must_use]
    pub const fn index(self, column: usize, row: usize) -> usize {
        row * self.width + column
    }

    /// The existing pixels to the left and right, above and below.
    pub fn neighbours(self, index: usize) -> impl Iterator<Item = usize> {
        let (column, row) = self.position(index);
        [
            (column > 0).then(|| index - 1),
            (column + 1 < self.width).then(|| index + 1),
            (row > 0).then(|| index - self.width),
            (row + 1 < self.height).then(|| index + self.width),
        ]
        .into_iter()
        .flatten()
    }

    /// All runs of `N` neighbours, along the rows and down the columns, so that measurements do not depend on how a
    /// view is oriented.
    pub(crate) fn runs<const N: usize>(self) -> impl Iterator<Item = [usize; N]> {
        (0..2 * self.len()).filter_map(move |number| {
            let (index, is_across) = (number / 2, number % 2 == 0);
            let (column, row) = self.position(index);
            let (at, side, step) = if is_across { (column, self.width, 1) } else { (row, self.height, self.width) };
            (at + N <= side).then(|| std::array::from_fn(|k| index + k * step))
        })
    }

    /// Index of the pixel nearest to a continuous position; `None` outside the raster.
    #[must_use]
    pub fn nearest(self, column: f32, row: f32) -> Option<usize> {
        // WebAssembly has an instruction that rounds down, but none that rounds halves away from zero.
        let (column, row) = ((column + 0.5).floor(), (row + 0.5).floor());
        let inside = column >= 0.0 && row >= 0.0 && column < self.width as f32 && row < self.height as f32;
        inside.then(|| self.index(column as usize, row as usize))
    }

    /// Bilinear value of `field` at a continuous position. NaN neighbours that carry weight make the value NaN.
    #[must_use]
    pub fn bilinear(self, field: &[f32], column: f32, row: f32) -> f32 {
        let [value] = self.each_bilinear([field], column, row);
        value
    }

    /// [`bilinear`](Self::bilinear) of several fields.
    #[must_use]
    pub fn each_bilinear<const N: usize>(self, fields: [&[f32]; N], column: f32, row: f32) -> [f32; N] {
        self.interpolate(fields, column, row, weighted_mean)
    }

    /// [`bilinear`](Self::bilinear) over the neighbours that are not NaN, because at the border of an object some lie
    /// off the mask.
    #[must_use]
    pub fn bilinear_of_known(self, field: &[f32], column: f32, row: f32) -> f32 {
        let [value] = self.each_bilinear_of_known([field], column, row);
        value
    }

    /// [`bilinear_of_known`](Self::bilinear_of_known) of several fields.
    #[must_use]
    pub fn each_bilinear_of_known<const N: usize>(self, fields: [&[f32]; N], column: f32, row: f32) -> [f32; N] {
        self.interpolate(fields, column, row, weighted_mean_of_known)
    }

    /// A mean of the four pixels around a position in each field; NaN outside the raster.
    #[inline(always)]
    fn interpolate<const N: usize>(
        self,
        fields: [&[f32]; N],
        column: f32,
        row: f32,
        mean: impl Fn(&[f32], &Corners) -> f32,
    ) -> [f32; N] {
        let Some(corners) = self.corners(column, row) else { return [f32::NAN; N] };
        fields.map(|field| mean(field, &corners))
    }

    /// The four pixels around a continuous position and their bilinear weights; `None` outside the raster.
    #[inline(always)]
    fn corners(self, column: f32, row: f32) -> Option<Corners> {
        let inside =
            column >= 0.0 && row >= 0.0 && column <= (self.width - 1) as f32 && row <= (self.height - 1) as f32;
        if !inside {
            return None;
        }
        let (left, top) = (column.floor() as usize, row.floor() as usize);
        let (right_share, low_share) = (column - left as f32, row - top as f32);
        let (right, low) = ((left + 1).min(self.width - 1), (top + 1).min(self.height - 1));
        Some([
            (self.index(left, top), (1.0 - right_share) * (1.0 - low_share)),
            (self.index(right, top), right_share * (1.0 - low_share)),
            (self.index(left, low), (1.0 - right_share) * low_share),
            (self.index(right, low), right_share * low_share),
        ])
    }

    /// Column and row of the pixel at `index`.
    #[must_use]
    pub const fn position(self, index: usize) -> (usize, usize) {
        (index % self.width, index / self.width)
    }
}

/// Four pixels and their weights, which add up to one.
type Corners = [(usize, f32); 4];

/// Weighted mean of the corners. A corner without weight must not contribute, because NaN times zero is NaN.
#[inline(never)]
fn weighted_mean(field: &[f32], corners: &Corners) -> f32 {
    corners.iter().filter(|(_, weight)| *weight > 0.0).map(|&(pixel, weight)| weight * field[pixel]).sum()
}

/// Weighted mean of the corners that are not NaN; NaN if all are.
#[inline(never)]
fn weighted_mean_of_known(field: &[f32], corners: &Corners) -> f32 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for &(pixel, weight) in corners {
        if !field[pixel].is_nan() {
            sum += weight * field[pixel];
            weights += weight;
        }
    }
    if weights > 0.0 { sum / weights } else { f32::NAN }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_go_along_rows_and_down_columns() {
        let size = Size { width: 3, height: 2 };
        let runs: Vec<[usize; 2]> = size.runs().collect();
        assert_eq!(runs, [[0, 1], [0, 3], [1, 2], [1, 4], [2, 5], [3, 4], [4, 5]]);
        assert_eq!(size.runs::<3>().collect::<Vec<_>>(), [[0, 1, 2], [3, 4, 5]]);
        assert_eq!(size.runs::<4>().count(), 0);
    }

    #[test]
    fn the_rim_has_the_colours_of_its_known_neighbours() {
        let size = Size { width: 2, height: 2 };
        let discontinuity = [1.0, f32::NAN, 3.0, f32::NAN];
        assert!(size.bilinear(&discontinuity, 0.25, 0.5).is_nan());
        assert_eq!(size.bilinear(&discontinuity, 0.0, 0.5), 2.0);
        assert_eq!(size.bilinear_of_known(&discontinuity, 0.25, 0.5), 2.0);
        assert_eq!(size.bilinear_of_known(&discontinuity, 0.0, 0.5), 2.0);
        assert!(size.bilinear_of_known(&[f32::NAN; 4], 0.5, 0.5).is_nan());
        assert!(size.bilinear_of_known(&discontinuity, -0.1, 0.5).is_nan());
    }
}
