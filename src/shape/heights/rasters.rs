//! Memory of rasters that several domains use in turn.

/// Length of a raster with a margin of a row and a pixel at both ends.
pub const fn padded(length: usize, width: usize) -> usize {
    length + 2 * (width + 1)
}

/// Makes a raster one of `length` numbers, whatever they are; there will be `room` for more.
#[inline(never)]
pub fn resize(raster: &mut Vec<f32>, length: usize, room: usize) {
    raster.reserve_exact(room.saturating_sub(raster.len()));
    raster.resize(length, 0.0);
}

/// The same of zeros.
#[inline(never)]
pub fn resize_to_zeros(raster: &mut Vec<f32>, length: usize, room: usize) {
    resize(raster, length, room);
    raster.fill(0.0);
}
