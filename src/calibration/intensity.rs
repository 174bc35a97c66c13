//! Intensities of a scanner's returns as levels of equal count (histogram equalisation).
//!
//! Every scanner stores the strength of a return in another unit, often as a curved function of reflectivity. Mutual
//! information with the image needs no unit: only the order of the intensities counts (Koide, Oishi, Yokozuka and Banno
//! 2023).

use crate::numeric::quantile;

/// Number of levels, as many as a channel of the image has.
pub(super) const LEVELS: usize = 16;
/// The level of a sample without intensity; no row of a table belongs to it.
pub(super) const UNKNOWN: u8 = u8::MAX;

/// The level of each intensity among all of them; equal intensities have one level. The levels are those of all samples
/// of a frame, seen or not, so they do not depend on the pose.
pub(super) fn levels(intensities: &[f32]) -> Vec<u8> {
    let mut known: Vec<f32> = intensities.iter().copied().filter(|value| value.is_finite()).collect();
    if known.is_empty() {
        return vec![UNKNOWN; intensities.len()];
    }
    let edges: [f32; LEVELS - 1] = std::array::from_fn(|edge| quantile(&mut known, (edge + 1) as f64 / LEVELS as f64));
    let level = |value: &f32| {
        if value.is_finite() { edges.iter().filter(|&edge| value >= edge).count() as u8 } else { UNKNOWN }
    };
    intensities.iter().map(level).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_have_equal_counts_and_equal_intensities_one_level() {
        let all: Vec<f32> = (0..1600).map(|index| ((7 * index) % 1600) as f32).collect();
        let found = levels(&all);
        for level in 0..LEVELS as u8 {
            let count = found.iter().filter(|&&other| other == level).count();
            assert!(count.abs_diff(100) <= 1, "{count} at level {level}");
        }
        let few = levels(&[3.0, f32::NAN, 1.0, 3.0, f32::INFINITY]);
        assert_eq!((few[0], few[1], few[4]), (few[3], UNKNOWN, UNKNOWN));
        assert!(few[2] < few[0]);
        assert_eq!(levels(&[f32::NAN; 3]), [UNKNOWN; 3]);
    }
}
