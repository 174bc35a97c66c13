//! Rasters: their size, and fields of vectors over them as structure-of-arrays.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};

use crate::error::{Error, ErrorKind, Result};
use crate::numeric::Lanes;

/// Smallest side of a view: below it neither a normal nor a light is determined.
pub const SMALLEST_SIDE: usize = 4;
/// Largest side of a view: the buffers of two such views still fit a 32-bit memory.
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
    /// [`ErrorKind::Size`] naming `field` otherwise.
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

    /// The pixels left, right, above and below that exist.
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

    /// Index of the pixel nearest to a continuous position, `None` outside the raster.
    #[must_use]
    pub fn nearest(self, column: f32, row: f32) -> Option<usize> {
        // WebAssembly has no instruction that rounds halves away from zero, but one that rounds down.
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
        // A corner without weight must not spoil the value: NaN times zero is NaN.
        let Some(corners) = self.corners(column, row) else { return [f32::NAN; N] };
        fields.map(|field| weigh(field, &corners))
    }

    /// As [`bilinear`](Self::bilinear), from those neighbours that have a value: colours of an object's rim.
    #[must_use]
    pub fn bilinear_of_known(self, field: &[f32], column: f32, row: f32) -> f32 {
        let [value] = self.each_bilinear_of_known([field], column, row);
        value
    }

    /// [`bilinear_of_known`](Self::bilinear_of_known) of several fields.
    #[must_use]
    pub fn each_bilinear_of_known<const N: usize>(self, fields: [&[f32]; N], column: f32, row: f32) -> [f32; N] {
        let Some(corners) = self.corners(column, row) else { return [f32::NAN; N] };
        fields.map(|field| weigh_known(field, &corners))
    }

    /// The four pixels around a continuous position and their bilinear weights; `None` outside of the raster.
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

/// Their mean; one that is NaN and has a weight makes it NaN.
#[inline(never)]
fn weigh(field: &[f32], corners: &Corners) -> f32 {
    corners.iter().filter(|(_, weight)| *weight > 0.0).map(|&(pixel, weight)| weight * field[pixel]).sum()
}

/// Their mean as far as they are known; NaN where none is.
#[inline(never)]
fn weigh_known(field: &[f32], corners: &Corners) -> f32 {
    let (mut sum, mut weights) = (0.0, 0.0);
    for &(pixel, weight) in corners {
        if !field[pixel].is_nan() {
            sum += weight * field[pixel];
            weights += weight;
        }
    }
    if weights > 0.0 { sum / weights } else { f32::NAN }
}

/// Unit normals over a raster, NaN where there is none. They face the camera: z < 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Normals {
    /// x components (right).
    pub x: Vec<f32>,
    /// y components (down).
    pub y: Vec<f32>,
    /// z components (forward).
    pub z: Vec<f32>,
}

/// Points over a raster, NaN where there is none.
pub type Points = Normals;

impl Normals {
    /// `length` missing vectors.
    #[must_use]
    #[inline(never)]
    pub fn missing(length: usize) -> Self {
        Self { x: vec![f32::NAN; length], y: vec![f32::NAN; length], z: vec![f32::NAN; length] }
    }

    /// Number of vectors.
    #[must_use]
    pub fn len(&self) -> usize {
        self.z.len()
    }

    /// Whether there is no vector at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.z.is_empty()
    }

    /// The vector at `index`, NaN where missing.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, index: usize) -> [f32; 3] {
        [self.x[index], self.y[index], self.z[index]]
    }

    /// The four vectors from `index` on, NaN beyond the last one.
    pub(crate) fn lanes(&self, index: usize) -> [Lanes; 3] {
        let start = index as isize;
        [Lanes::load(&self.x, start), Lanes::load(&self.y, start), Lanes::load(&self.z, start)]
    }

    /// Replaces the vector at `index`.
    #[inline(always)]
    pub fn set(&mut self, index: usize, vector: [f32; 3]) {
        [self.x[index], self.y[index], self.z[index]] = vector;
    }

    /// Whether there is a vector at `index`.
    #[inline(always)]
    #[must_use]
    pub fn is_valid(&self, index: usize) -> bool {
        // A sum is NaN where a member is.
        !self.get(index).iter().sum::<f32>().is_nan()
    }

    /// Takes over other vectors; allocates where there are more than ever.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.x.clone_from(&other.x);
        self.y.clone_from(&other.y);
        self.z.clone_from(&other.z);
    }

    /// Makes room for, or leaves, so many vectors; new ones are missing.
    pub(crate) fn resize(&mut self, length: usize) {
        [&mut self.x, &mut self.y, &mut self.z].into_iter().for_each(|axis| axis.resize(length, f32::NAN));
    }

    /// Takes over some of other vectors, from `place` on.
    pub(crate) fn copy_some(&mut self, place: usize, other: &Self, some: &Range<usize>) {
        let [x, y, z] = [&other.x, &other.y, &other.z].map(|axis| &axis[some.clone()]);
        for (mine, theirs) in [(&mut self.x, x), (&mut self.y, y), (&mut self.z, z)] {
            mine[place..place + theirs.len()].copy_from_slice(theirs);
        }
    }

    /// Some vectors turned, into others from `place` on.
    pub(crate) fn rotate(&self, some: &Range<usize>, rotation: &Matrix3<f64>, turned: &mut Self, place: usize) {
        let [x, y, z] = [&self.x, &self.y, &self.z].map(|axis| &axis[some.clone()]);
        for (axis, out) in [&mut turned.x, &mut turned.y, &mut turned.z].into_iter().enumerate() {
            let [a, b, c] = [0, 1, 2].map(|column: usize| rotation[(axis, column)] as f32);
            for (((out, x), y), z) in out[place..].iter_mut().zip(x).zip(y).zip(z) {
                *out = a * x + b * y + c * z;
            }
        }
    }

    /// Mean of the vectors that are there, zero where there is none.
    #[must_use]
    pub fn centroid(&self) -> Vector3<f64> {
        let (mut sum, mut count) = (Vector3::zeros(), 0.0);
        for index in (0..self.len()).filter(|&index| self.is_valid(index)) {
            sum += Vector3::from(self.get(index).map(f64::from));
            count += 1.0;
        }
        sum / f64::max(count, 1.0)
    }

    /// The vectors interleaved: x, y, z, x, y, z, ...
    #[must_use]
    pub fn interleaved(&self) -> Vec<f32> {
        (0..self.len()).flat_map(|index| self.get(index)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vector_with_a_missing_member_is_missing() {
        let mut points = Points::missing(1);
        points.set(0, [1.0; 3]);
        assert!(points.is_valid(0));
        for axis in 0..3 {
            let point = [0, 1, 2].map(|other| if other == axis { f32::NAN } else { 1.0 });
            points.set(0, point);
            assert!(!points.is_valid(0), "{point:?}");
        }
    }

    #[test]
    fn the_rim_has_the_colours_of_its_known_neighbours() {
        let size = Size { width: 2, height: 2 };
        let rim = [1.0, f32::NAN, 3.0, f32::NAN];
        assert!(size.bilinear(&rim, 0.25, 0.5).is_nan());
        assert_eq!(size.bilinear(&rim, 0.0, 0.5), 2.0);
        assert_eq!(size.bilinear_of_known(&rim, 0.25, 0.5), 2.0);
        assert_eq!(size.bilinear_of_known(&rim, 0.0, 0.5), 2.0);
        assert!(size.bilinear_of_known(&[f32::NAN; 4], 0.5, 0.5).is_nan());
        assert!(size.bilinear_of_known(&rim, -0.1, 0.5).is_nan());
    }
}
