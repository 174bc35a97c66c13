//! Memory of rasters that several domains use alternately.

/// Length of a raster with a margin of one row and one pixel at both ends.
pub const fn padded(length: usize, width: usize) -> usize {
    length + 2 * (width + 1)
}

/// Resizes a raster to `length` numbers of arbitrary value, with capacity for `room`.
#[inline(never)]
pub fn resize(raster: &mut Vec<f32>, length: usize, room: usize) {
    raster.reserve_exact(room.saturating_sub(raster.len()));
    raster.resize(length, 0.0);
}

/// Resizes a raster to zeros.
#[inline(never)]
pub fn resize_to_zeros(raster: &mut Vec<f32>, length: usize, room: usize) {
    resize(raster, length, room);
    raster.fill(0.0);
}
