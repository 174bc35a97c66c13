//! The domain of unknown heights: the mask of one view, the neighbours of its pixels, and their rays.

use super::ray_frames::RayFrames;
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::cosine::CosineSolver;
use crate::numeric::{LANES, Mask};
use crate::view::{Camera, Size};

/// Bits of a pixel: whether it is inside the mask, whether the cell of four pixels to its right and below is, and which
/// neighbours are.
pub(super) const INSIDE: u8 = 1;
pub(super) const CELL: u8 = 2;
pub(super) const LEFT: u8 = 4;
pub(super) const RIGHT: u8 = 8;
pub(super) const ABOVE: u8 = 16;
pub(super) const BELOW: u8 = 32;

/// The pixels of one mask over its bounding box: everything that stays the same between solves.
pub struct HeightDomain {
    pub(super) size: Size,
    /// Left column and top row of the mask's bounding box.
    corner: [usize; 2],
    /// Columns of the box; the rows of the rasters over it have length `width`, a multiple of [`LANES`].
    pub(super) columns: usize,
    pub(super) width: usize,
    /// The pixels and neighbours that are inside, as bits of [`INSIDE`] and the following constants.
    pub(super) flags: Vec<u8>,
    pub(super) pixels: usize,
    pub(super) cosine: CosineSolver,
    /// The frames from which normals follow, given the slopes at each pixel.
    pub(super) frames: RayFrames,
}

impl HeightDomain {
    /// The domain of the pixels of `mask`.
    ///
    /// # Errors
    /// [`ErrorKind::Empty`] if the mask holds no pixel.
    pub fn new(size: Size, camera: Camera, mask: &[bool]) -> Result<Self> {
        let inside_view = || (0..size.len()).filter(|&index| mask[index]).map(|index| size.position(index));
        let bounds = |values: &mut dyn Iterator<Item = usize>| {
            values.fold((usize::MAX, 0), |(low, high), value| (low.min(value), high.max(value)))
        };
        let (left, rightmost) = bounds(&mut inside_view().map(|(column, _)| column));
        let (top, bottom) = bounds(&mut inside_view().map(|(_, row)| row));
        if left > rightmost {
            return Err(Error::new(ErrorKind::Empty, "mask", "holds no pixel"));
        }
        let (columns, height) = (rightmost - left + 1, bottom - top + 1);
        // Blocks of four must not extend into the next row.
        let width = columns.next_multiple_of(LANES);
        let length = width * height;
        let is_inside =
            |column: usize, row: usize| column < size.width && row < size.height && mask[size.index(column, row)];
        let mut flags = vec![0; length];
        for (column, row) in inside_view() {
            let [right, below] = [is_inside(column + 1, row), is_inside(column, row + 1)];
            let own = [
                (INSIDE, true),
                (CELL, right && below && is_inside(column + 1, row + 1)),
                (LEFT, is_inside(column.wrapping_sub(1), row)),
                (RIGHT, right),
                (ABOVE, is_inside(column, row.wrapping_sub(1))),
                (BELOW, below),
            ];
            flags[(row - top) * width + column - left] =
                own.into_iter().filter(|(_, holds)| *holds).map(|(flag, _)| flag).sum();
        }
        let frames = RayFrames::new(&camera, size, [left, top], [width, height]);
        let (corner, pixels) = ([left, top], inside_view().count());
        Ok(Self { size, corner, columns, width, pixels, flags, cosine: CosineSolver::new(width, height), frames })
    }

    /// Length of the rasters over the box.
    pub(super) fn len(&self) -> usize {
        self.flags.len()
    }

    /// The rows of the box: the index at which each starts here and in the view.
    pub(super) fn rows(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let ([left, top], width, view_width) = (self.corner, self.width, self.size.width);
        (0..self.flags.len() / width).map(move |row| (row * width, (top + row) * view_width + left))
    }

    /// The pixels of a block of [`LANES`] that have any of the `wanted` bits.
    #[inline(always)]
    pub(super) fn flagged(&self, index: usize, wanted: u8) -> Mask {
        let flags = self.flags.get(index..).and_then(|flags| flags.first_chunk());
        Mask::with_bits(flags.copied().unwrap_or_default(), wanted)
    }

    /// The pixels inside the mask: their indices here and in the view.
    pub(super) fn inside(&self) -> impl Iterator<Item = (usize, usize)> {
        let pixels = self.rows().flat_map(|(here, source)| (0..self.columns).map(move |k| (here + k, source + k)));
        pixels.filter(|&(index, _)| self.flags[index] & INSIDE != 0)
    }
}
