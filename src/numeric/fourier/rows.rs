//! Fourier transforms of complex rows, four side by side in lanes.
//!
//! Method: Stockham's, decimation in frequency. Each stage takes a factor out of the length, reads one buffer and
//! writes the other in an order that leaves the spectrum sorted. Factors of four come first because they need the
//! fewest products; the others are 2 and 3.
//!
//! Why no library: see [`cosine`](crate::numeric::cosine).

use super::roots::{Root, root};
use crate::numeric::{Lanes, Real};

/// Real and imaginary parts of four numbers.
pub(crate) type Complex = [Lanes; 2];

/// sin(2 pi / 3).
const SINE_OF_A_THIRD: f32 = 0.866_025_4;

/// A transform of one length; owns its roots and scratch memory.
pub(crate) struct RowFourier {
    stages: Vec<Pass>,
    spare: Vec<Complex>,
}

/// The stage of one factor of the length.
struct Pass {
    factor: usize,
    /// Number of sequences that this stage transforms side by side: the product of the earlier factors.
    stride: usize,
    /// exp(-2 pi i p k / n) for k = 1 .. factor - 1 (fast index) and p (slow index), where n is the remaining length.
    roots: Vec<Root>,
}

/// The shortest length of at least `least` that is a multiple of four and has no prime factors but 2 and 3.
pub(crate) fn fast_length(least: usize) -> usize {
    (least.next_multiple_of(4)..)
        .step_by(4)
        .find(|&length| factors(length).product::<usize>() == length)
        .unwrap_or(least)
}

/// Factors of a length that are 4, 2 or 3, with repetition.
fn factors(mut length: usize) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let factor = [4, 2, 3].into_iter().find(|factor| length.is_multiple_of(*factor) && length > 0)?;
        length /= factor;
        Some(factor)
    })
}

impl RowFourier {
    /// A transform of `length` numbers; `length` must be a [`fast_length`].
    pub fn new(length: usize) -> Self {
        let (mut stages, mut left) = (Vec::new(), length);
        for factor in factors(length) {
            stages.push(Pass::new(factor, left, length / left));
            left /= factor;
        }
        Self { stages, spare: vec![[Lanes::splat(0.0); 2]; length] }
    }

    /// Replaces `values` by sum_n values_n exp(-2 pi i k n / length) for each k.
    pub fn transform(&mut self, values: &mut Vec<Complex>) {
        for stage in &self.stages {
            match stage.factor {
                4 => stage.run(values, &mut self.spare, fourth),
                2 => stage.run(values, &mut self.spare, half),
                _ => stage.run(values, &mut self.spare, third),
            }
            std::mem::swap(values, &mut self.spare);
        }
    }
}

impl Pass {
    fn new(factor: usize, left: usize, stride: usize) -> Self {
        let roots = (0..left / factor).flat_map(|p| (1..factor).map(move |k| root(p * k, left))).collect();
        Self { factor, stride, roots }
    }

    /// Sets `to` to the shorter transforms of `from` times the roots.
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
                    block[k * self.stride + place] = multiply(sums[k], roots[k - 1]);
                }
            }
        }
    }
}

/// Multiplies by a root.
#[inline(always)]
fn multiply([re, im]: Complex, [cos, sin]: Root) -> Complex {
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

#[inline(always)]
fn times_minus_i([re, im]: Complex) -> Complex {
    [im, Lanes::splat(0.0) - re]
}

#[inline(always)]
fn half([a, b]: [Complex; 2]) -> [Complex; 2] {
    [plus(a, b), minus(a, b)]
}

#[inline(always)]
fn fourth([a, b, c, d]: [Complex; 4]) -> [Complex; 4] {
    let (even, off_even) = (plus(a, c), minus(a, c));
    let (odd, off_odd) = (plus(b, d), times_minus_i(minus(b, d)));
    [plus(even, odd), plus(off_even, off_odd), minus(even, odd), minus(off_even, off_odd)]
}

#[inline(always)]
fn third([a, b, c]: [Complex; 3]) -> [Complex; 3] {
    let (sum, [re, im]) = (plus(b, c), minus(b, c));
    let (half, sine) = (Lanes::splat(0.5), Lanes::splat(SINE_OF_A_THIRD));
    let (even, off) = ([a[0] - half * sum[0], a[1] - half * sum[1]], times_minus_i([sine * re, sine * im]));
    [plus(a, sum), plus(even, off), minus(even, off)]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    use super::*;

    #[test]
    fn the_transform_is_its_definition() {
        for length in [4, 8, 12, 16, 24, 32, 36, 64, 72, 96, 108] {
            let value = |n: usize, lane: usize| [(n * n + lane) as f32 % 7.0, (3 * n + lane) as f32 % 5.0];
            let complex = |n: usize| [0, 1].map(|part| Lanes::from([0, 1, 2, 3].map(|lane| value(n, lane)[part])));
            let mut values: Vec<Complex> = (0..length).map(complex).collect();
            RowFourier::new(length).transform(&mut values);
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
        assert_eq!([1, 7, 11, 64, 97, 150, 412, 640].map(fast_length), [4, 8, 12, 64, 108, 192, 432, 648]);
    }
}
