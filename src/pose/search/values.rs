//! The values of a cell of the grid and their products, in whole lanes.

use crate::light::HARMONICS;

/// Number of regressors by which the albedo follows the relief: the fine and the coarse curvature, and the square of
/// the latter. More would not fit the lanes of [`Sums`].
pub const RELIEF: usize = 3;
/// Number of coefficients of a fit with them.
pub const WITH_RELIEF: usize = HARMONICS + RELIEF;

/// Number of values that are added and multiplied at once.
pub const LANES: usize = 4;
/// Largest number of a cell's values, rounded up to whole lanes.
pub const PADDED: usize = WITH_RELIEF.next_multiple_of(LANES);

/// Weight w, then w B_k for the harmonics after the constant one, then w times the regressors of the relief, or zeros.
pub type Sums = [f32; PADDED];

/// Start of a row of the lower triangle of products; a row has as many lanes as reach the diagonal.
pub const fn row_start(row: usize) -> usize {
    let lanes = row / LANES;
    LANES * (lanes + 1) * (row - LANES * lanes + LANES * lanes / 2)
}

/// Number of products of two values, up to a number of values.
pub const fn products(channels: usize) -> usize {
    row_start(channels - 1) + LANES * channels.div_ceil(LANES)
}
/// w B_k B_l.
pub type Products = [f32; products(WITH_RELIEF)];
