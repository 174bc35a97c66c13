//! Flaws that a sensor adds to a perfect view: noise, holes, a limited field of view. All of them follow from a seed.

use std::f64::consts::TAU;

use crate::numeric::random::Random;
use crate::view::Size;

/// Share of the lost pixels that form blobs, as at dark or shiny spots; the others are single.
const BLOB_SHARE: f64 = 0.5;
/// Largest radius of a blob relative to the smaller side of the view.
const LARGEST_BLOB: f64 = 1.0 / 16.0;

/// A stream of random numbers, the same on every platform.
pub(super) struct Chance(Random);

/// Purposes with separate streams, so that enabling one does not change the others.
#[derive(Clone, Copy)]
pub(super) enum Purpose {
    Brightness = 1,
    Depth = 2,
    Holes = 3,
}

impl Chance {
    pub(super) fn new(seed: u64, purpose: Purpose) -> Self {
        Self::of_stream(seed, purpose as u64)
    }

    /// One of a seed's independent streams.
    pub(super) fn of_stream(seed: u64, stream: u64) -> Self {
        Self(Random::new(seed, stream))
    }

    /// Uniform over [0, 1), with 53 bits.
    pub(super) fn uniform(&mut self) -> f64 {
        self.0.uniform()
    }

    /// Uniform between two bounds.
    pub(super) fn between(&mut self, [low, high]: [f64; 2]) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// A whole number below `count`.
    pub(super) fn below(&mut self, count: usize) -> usize {
        // The product has a bias of count / 2^53.
        (self.uniform() * count as f64) as usize
    }

    /// Standard normal, by the method of Box and Muller, which is exact and needs no tables.
    pub(super) fn gaussian(&mut self) -> f64 {
        // 1 - u lies in (0, 1], where the logarithm is finite.
        let radius = (-2.0 * (1.0 - self.0.uniform()).ln()).sqrt();
        radius * (TAU * self.0.uniform()).cos()
    }
}

/// Keeps the middle round(share * n) of the n columns of `mask` that hold a pixel, at least one; clears the others.
pub(super) fn keep_columns(mask: &mut [bool], size: Size, share: f64) {
    let occupied: Vec<usize> =
        (0..size.width).filter(|&column| (0..size.height).any(|row| mask[size.index(column, row)])).collect();
    let kept = ((share * occupied.len() as f64).round() as usize).clamp(1, occupied.len().max(1));
    let first = (occupied.len() - kept.min(occupied.len())) / 2;
    let kept: Vec<usize> = occupied.into_iter().skip(first).take(kept).collect();
    for (index, inside) in mask.iter_mut().enumerate() {
        *inside &= kept.binary_search(&size.position(index).0).is_ok();
    }
}

/// Sets round(share * n) of the n values that are not NaN to NaN: half of them in discs, half singly.
pub(super) fn punch_holes(values: &mut [f32], size: Size, share: f64, chance: &mut Chance) {
    let valid: Vec<usize> = (0..values.len()).filter(|&index| !values[index].is_nan()).collect();
    let mut left = (share * valid.len() as f64).round() as usize;
    let singles = left - (BLOB_SHARE * left as f64) as usize;
    let largest = size.width.min(size.height) as f64 * LARGEST_BLOB;
    while left > singles {
        let radius = 1.0 + chance.0.uniform() * (largest - 1.0).max(0.0);
        let centre = valid[chance.below(valid.len())];
        for index in disc(size, centre, radius) {
            if left > singles && !values[index].is_nan() {
                values[index] = f32::NAN;
                left -= 1;
            }
        }
    }
    // A partial shuffle: every draw takes one of the remaining pixels.
    let mut there: Vec<usize> = valid.into_iter().filter(|&index| !values[index].is_nan()).collect();
    for _ in 0..left {
        let index = there.swap_remove(chance.below(there.len()));
        values[index] = f32::NAN;
    }
}

/// Pixels within `radius` of the pixel `centre`.
fn disc(size: Size, centre: usize, radius: f64) -> impl Iterator<Item = usize> {
    let (column, row) = size.position(centre);
    let reach = radius as usize;
    let columns = column.saturating_sub(reach)..(column + reach + 1).min(size.width);
    let rows = row.saturating_sub(reach)..(row + reach + 1).min(size.height);
    rows.flat_map(move |y| columns.clone().map(move |x| (x, y)))
        .filter(move |&(x, y)| (x.abs_diff(column) as f64).hypot(y.abs_diff(row) as f64) <= radius)
        .map(move |(x, y)| size.index(x, y))
}
