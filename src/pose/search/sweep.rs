//! The sweep: pairs of a rotation and an apparent size, spread evenly, in slices.

use nalgebra::Matrix3;

use super::rotations;

/// Distance between neighbouring rotations in degrees; set on 160 scenes with unknown light (docs/lab/thresholds.md).
const SPACING: f64 = 16.0;
/// Scales relative to s0 if the scale is free. Neighbouring ones move the ends of the object by one cell. The ascent reaches 0.7 and 1.4
/// and closes the gaps (docs/lab/thresholds.md).
const FREE_SCALES: [f64; 4] = [0.74, 0.90, 1.09, 1.32];
/// Apparent sizes behind a pinhole with a held scale, where the distance is known only roughly.
const NEAR_SIZES: [f64; 3] = [0.87, 1.0, 1.15];
/// Apparent sizes behind a pinhole if the depth map may show only a part of the object, relative to a silhouette of the
/// same area: the smallest covers two fifths of the mask.
const SIZES_OF_PARTS: [f64; 4] = [1.1, 0.91, 0.75, 0.62];
/// Number of pairs in one slice.
const SWEPT_AT_ONCE: usize = 8;
/// Number of slices at the beginning that have a single pair. The first call compiles the code, and until engines have
/// optimised it, a pair takes several times as long.
const WARMING_SLICES: usize = 30;

/// All pairs of a rotation and a size.
pub struct Sweep {
    rotations: Vec<Matrix3<f64>>,
    sizes: &'static [f64],
}

impl Sweep {
    /// `seed` draws the set of rotations.
    pub fn new(scale_is_free: bool, has_distance: bool, seed: u64) -> Self {
        let sizes: &[f64] = match (scale_is_free, has_distance) {
            (true, _) => &FREE_SCALES,
            (false, true) => &NEAR_SIZES,
            (false, false) => &[1.0],
        };
        Self { rotations: rotations::spread(SPACING, seed), sizes }
    }

    /// Restricts the sweep to rotations within `degrees` of a given one, and adds that one.
    pub fn narrow(&mut self, initial: &Matrix3<f64>, degrees: f64) {
        let least_trace = 1.0 + 2.0 * degrees.min(180.0).to_radians().cos();
        self.rotations.retain(|turn| turn.trace() >= least_trace);
        self.rotations.iter_mut().for_each(|turn| *turn *= initial);
        self.rotations.push(*initial);
    }

    /// Takes the sizes of parts of the object.
    pub const fn seek_parts(&mut self) {
        self.sizes = &SIZES_OF_PARTS;
    }

    /// The apparent sizes of the sweep.
    pub const fn sizes(&self) -> &'static [f64] {
        self.sizes
    }

    /// Whether there is more than one size.
    pub const fn varies_size(&self) -> bool {
        self.sizes.len() > 1
    }

    /// Number of slices.
    pub const fn slices(&self) -> usize {
        slices(self.pairs())
    }

    /// The pairs of a slice; empty beyond the last slice.
    pub fn slice(&self, slice: usize) -> impl Iterator<Item = (Matrix3<f64>, f64)> {
        let start = |slice| slice_start(slice).min(self.pairs());
        let pair = |pair: usize| (self.rotations[pair / self.sizes.len()], self.sizes[pair % self.sizes.len()]);
        (start(slice)..start(slice.saturating_add(1))).map(pair)
    }

    const fn pairs(&self) -> usize {
        self.rotations.len() * self.sizes.len()
    }
}

/// Number of slices of a sweep over this many pairs.
const fn slices(pairs: usize) -> usize {
    match pairs.checked_sub(WARMING_SLICES) {
        Some(others) => WARMING_SLICES + others.div_ceil(SWEPT_AT_ONCE),
        None => pairs,
    }
}

/// Index of the first pair of a slice.
const fn slice_start(slice: usize) -> usize {
    match slice.checked_sub(WARMING_SLICES) {
        Some(others) => WARMING_SLICES.saturating_add(others.saturating_mul(SWEPT_AT_ONCE)),
        None => slice,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slices_hold_every_pair_once() {
        for pairs in [0, 5, 12, 13, 100, 2792] {
            let starts: Vec<usize> = (0..=slices(pairs)).map(|slice| slice_start(slice).min(pairs)).collect();
            assert!(starts.windows(2).all(|pair| pair[0] < pair[1]) && starts[0] == 0 && starts.last() == Some(&pairs));
        }
        assert!(slice_start(usize::MAX) >= 2792);
    }
}
