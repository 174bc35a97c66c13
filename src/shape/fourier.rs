//! Fourier transforms of complex rows, four side by side in lanes.
//!
//! Method: Stockham's, decimation in frequency: each stage takes a factor out of the length, reads one buffer and writes
//! the other in an order that leaves the spectrum sorted. Lengths are once, three or five times a power of two;
//! factors of four come first, as they need the fewest products.

use std::f64::consts::TAU;

use crate::view::{Lanes, Real};

/// Real and imaginary part of four numbers.
pub(super) type Complex = [Lanes; 2];
/// cos and -sin of an angle: a root of unity.
type Root = [f32; 2];

/// The largest factor beside the powers of two.
const LARGEST_FACTOR: usize = 5;

/// A transform of one length; owns its roots and its scratch.
pub(super) struct Fourier {
    stages: Vec<Stage>,
    spare: Vec<Complex>,
}

/// One factor of the length.
struct Stage {
    factor: usize,
    /// Sequences that are transformed side by side by now: the product of the factors before.
    stride: usize,
    /// exp(-2 pi i p k / n) for k = 1 .. factor - 1 (fast) and p (slow), n the length that is left.
    roots: Vec<Root>,
    /// exp(-2 pi i j k / factor) of an odd factor, for j (slow) and k up to half of it.
    units: [[Root; LARGEST_FACTOR / 2]; LARGEST_FACTOR / 2],
}

/// The shortest length from `least` on that is once, three or five times a power of two, and a multiple of four.
pub(super) fn fast_length(least: usize) -> usize {
    let next = |odd: usize| odd * least.div_ceil(odd).next_power_of_two().max(4);
    [1, 3, LARGEST_FACTOR].map(next).into_iter().min().unwrap_or(least)
}

impl Fourier {
    /// A transform of `length` numbers, a [`fast_length`].
    pub fn new(length: usize) -> Self {
        let (mut stages, mut left) = (Vec::new(), length);
        while left > 1 {
            let factor = [4, 2].into_iter().find(|factor| left % factor == 0).unwrap_or(left);
            stages.push(Stage::new(factor, left, length / left));
            left /= factor;
        }
        Self { stages, spare: vec![[Lanes::splat(0.0); 2]; length] }
    }

    /// Replaces `values` by sum_n values_n exp(-2 pi i k n / length), for each k.
    pub fn transform(&mut self, values: &mut Vec<Complex>) {
        for stage in &self.stages {
            match stage.factor {
                4 => stage.run(values, &mut self.spare, fourth),
                2 => stage.run(values, &mut self.spare, half),
                3 => stage.run(values, &mut self.spare, |values| odd::<3>(values, &stage.units)),
                _ => stage.run(values, &mut self.spare, |values| odd::<LARGEST_FACTOR>(values, &stage.units)),
            }
            std::mem::swap(values, &mut self.spare);
        }
    }
}

impl Stage {
    fn new(factor: usize, left: usize, stride: usize) -> Self {
        let root = |step: usize, length: usize| -> Root {
            let (sin, cos) = (TAU * step as f64 / length as f64).sin_cos();
            [cos as f32, -sin as f32]
        };
        let roots = (0..left / factor).flat_map(|p| (1..factor).map(move |k| root(p * k, left))).collect();
        let units = [1, 2].map(|j| [1, 2].map(|k| root(j * k, factor)));
        Self { factor, stride, roots, units }
    }

    /// `to` = the shorter transforms of `from`, times the roots.
    #[inline(always)]
    fn run<const F: usize>(
        &self,
        from: &[Complex],
        to: &mut [Complex],
        butterfly: impl Fn([Complex; F]) -> [Complex; F],
    ) {
        let part = from.len() / F;
        let blocks = to.chunks_exact_mut(F * self.stride).zip(self.roots.chunks_exact(F - 1));
        for (start, (block, roots)) in (0..part).step_by(self.stride).zip(blocks) {
            for place in 0..self.stride {
                let sums = butterfly(std::array::from_fn(|part_index| from[part_index * part + start + place]));
                block[place] = sums[0];
                for k in 1..F {
                    block[k * self.stride + place] = turned(sums[k], roots[k - 1]);
                }
            }
        }
    }
}

#[inline(always)]
fn turned([re, im]: Complex, [cos, sin]: Root) -> Complex {
    let (cos, sin) = (Lanes::splat(cos), Lanes::splat(sin));
    [re * cos - im * sin, re * sin + im * cos]
}

#[inline(always)]
fn plus(a: Complex, b: Complex) -> Complex {
    [a[0] + b[0], a[1] + b[1]]
}

#[inline(always)]
fn minus(a: Complex, b: Complex) -> Complex {
    [a[0] - b[0], a[1] - b[1]]
}

/// Times -i.
#[inline(always)]
fn quarter_turn([re, im]: Complex) -> Complex {
    [im, Lanes::splat(0.0) - re]
}

#[inline(always)]
fn half([a, b]: [Complex; 2]) -> [Complex; 2] {
    [plus(a, b), minus(a, b)]
}

#[inline(always)]
fn fourth([a, b, c, d]: [Complex; 4]) -> [Complex; 4] {
    let (even, off_even) = (plus(a, c), minus(a, c));
    let (odd, off_odd) = (plus(b, d), quarter_turn(minus(b, d)));
    [plus(even, odd), plus(off_even, off_odd), minus(even, odd), minus(off_even, off_odd)]
}

/// An odd number of values, by the definition: sums of opposite ones go with cosines, differences with sines.
#[inline(always)]
fn odd<const F: usize>(values: [Complex; F], units: &[[Root; LARGEST_FACTOR / 2]; LARGEST_FACTOR / 2]) -> [Complex; F] {
    let mut sums = values;
    for k in 1..=F / 2 {
        sums[0] = plus(sums[0], plus(values[k], values[F - k]));
        let (mut even, mut off) = (values[0], [Lanes::splat(0.0); 2]);
        for j in 1..=F / 2 {
            let [cos, sin] = units[j - 1][k - 1].map(Lanes::splat);
            let (sum, difference) = (plus(values[j], values[F - j]), minus(values[j], values[F - j]));
            even = plus(even, [cos * sum[0], cos * sum[1]]);
            // -i times the difference, times the sine.
            off = minus(off, [sin * difference[1], Lanes::splat(0.0) - sin * difference[0]]);
        }
        (sums[k], sums[F - k]) = (plus(even, off), minus(even, off));
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_is_its_definition() {
        for length in [4, 8, 12, 16, 20, 24, 40, 64, 96] {
            let value = |n: usize, lane: usize| [(n * n + lane) as f32 % 7.0, (3 * n + lane) as f32 % 5.0];
            let complex = |n: usize| [0, 1].map(|part| Lanes::from([0, 1, 2, 3].map(|lane| value(n, lane)[part])));
            let mut values: Vec<Complex> = (0..length).map(complex).collect();
            Fourier::new(length).transform(&mut values);
            for (k, found) in values.into_iter().enumerate() {
                for lane in 0..4 {
                    let (mut re, mut im) = (0.0, 0.0);
                    for n in 0..length {
                        let (sin, cos) = (TAU * (k * n) as f64 / length as f64).sin_cos();
                        let [x, y] = value(n, lane).map(f64::from);
                        (re, im) = (re + x * cos + y * sin, im + y * cos - x * sin);
                    }
                    let off = [found[0].array()[lane] - re as f32, found[1].array()[lane] - im as f32];
                    assert!(off.iter().all(|off| off.abs() < 1e-3), "{length}: {k} {off:?}");
                }
            }
        }
    }

    #[test]
    fn fast_lengths_are_not_much_longer() {
        assert_eq!([1, 7, 11, 64, 97, 150, 612, 640].map(fast_length), [4, 8, 12, 64, 128, 160, 640, 640]);
    }
}
