//! Four pixels side by side: f32 arithmetic that fills one vector register of WebAssembly.
//!
//! Solvers of single pixels branch too much for the compiler to vectorise them. Here all four pixels compute both sides
//! of a branch, and a [`Mask`] selects. WebAssembly without SIMD processes one pixel at a time, because four of each
//! instruction would be a larger download and no faster. Every operation rounds as f32 does, so both variants agree
//! except for the order of sums.
//!
//! Why not the crate `wide` (1.7): a kernel of shading takes 0.9 of the time with simd128 and as long without (Node
//! 20), so speed does not decide. It has no load that pads the ends of a row, its masks are numbers that can be
//! mistaken for values, and its exponential is too slow for [`doubles`](super::doubles).

use std::ops::{Add, BitAnd, BitOr, Div, Mul, Not, Sub};

/// Number of pixels that are processed at once.
pub const LANES: usize = if cfg!(all(target_arch = "wasm32", not(target_feature = "simd128"))) { 1 } else { 4 };

/// The operations that a formula needs of a number, whether of one pixel or of several.
pub trait Real: Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> {
    /// Number type of one pixel.
    type Scalar: Real<Scalar = Self::Scalar>;

    /// The same number for every pixel.
    fn splat(value: Self::Scalar) -> Self;

    /// A constant of a formula, rounded to the precision of this type.
    fn constant(value: f64) -> Self;
}

impl Real for f32 {
    type Scalar = Self;

    #[inline(always)]
    fn splat(value: Self) -> Self {
        value
    }

    #[inline(always)]
    fn constant(value: f64) -> Self {
        value as Self
    }
}

impl Real for f64 {
    type Scalar = Self;

    #[inline(always)]
    fn splat(value: Self) -> Self {
        value
    }

    #[inline(always)]
    fn constant(value: f64) -> Self {
        value
    }
}

/// Four numbers, one for each of four pixels.
#[derive(Clone, Copy, Debug)]
pub struct Lanes(arch::Four);

/// A boolean for each of four pixels.
#[derive(Clone, Copy, Debug)]
pub struct Mask(arch::Choice);

impl Lanes {
    /// Four values from `start`, NaN beyond the ends.
    #[inline(always)]
    pub fn load(values: &[f32], start: isize) -> Self {
        // A negative start, read as an unsigned number, lies beyond the last value.
        match values.get(start as usize..).and_then(|values| values.first_chunk()) {
            Some(four) => Self::from(*four),
            None => Self::load_end(values, start),
        }
    }

    #[cold]
    #[inline(never)]
    fn load_end(values: &[f32], start: isize) -> Self {
        let mut four = [f32::NAN; LANES];
        for (lane, value) in four.iter_mut().enumerate() {
            let index = start.checked_add_unsigned(lane).and_then(|index| usize::try_from(index).ok());
            if let Some(&known) = index.and_then(|index| values.get(index)) {
                *value = known;
            }
        }
        Self::from(four)
    }

    /// Writes as many of the four numbers as `values` can hold.
    #[inline(always)]
    pub fn store(self, values: &mut [f32]) {
        match values.first_chunk_mut() {
            Some(room) => *room = self.array(),
            None => self.store_end(values),
        }
    }

    #[cold]
    #[inline(never)]
    fn store_end(self, values: &mut [f32]) {
        values.iter_mut().zip(self.array()).for_each(|(value, new)| *value = new);
    }

    #[inline(always)]
    pub fn array(self) -> [f32; LANES] {
        arch::array(self.0)
    }

    /// The first numbers of all rows, then the second ones, and so on.
    #[inline(always)]
    pub fn transpose(rows: [Self; LANES]) -> [Self; LANES] {
        arch::transpose(rows.map(|row| row.0)).map(Self)
    }

    /// Sum of all four.
    #[inline(always)]
    pub fn sum(self) -> f32 {
        match self.array()[..] {
            [a, b, c, d] => (a + b) + (c + d),
            ref few => few.iter().sum(),
        }
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(arch::sqrt(self.0))
    }

    /// The smaller of each pair; the other's number where this one is NaN.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        self.less(other).select(self, other)
    }

    /// False for NaN.
    #[inline(always)]
    pub fn less(self, other: Self) -> Mask {
        Mask(arch::less(self.0, other.0))
    }

    /// False for NaN.
    #[inline(always)]
    pub fn at_most(self, other: Self) -> Mask {
        Mask(arch::at_most(self.0, other.0))
    }

    /// The lanes that are neither NaN nor infinite.
    #[inline(always)]
    pub fn finite(self) -> Mask {
        (self * Self::splat(0.0)).at_most(Self::splat(0.0))
    }
}

/// Dot product of two vectors.
#[inline(always)]
pub fn dot<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

impl From<[f32; LANES]> for Lanes {
    #[inline(always)]
    fn from(values: [f32; LANES]) -> Self {
        Self(arch::four(values))
    }
}

impl Real for Lanes {
    type Scalar = f32;

    #[inline(always)]
    fn splat(value: f32) -> Self {
        Self::from([value; LANES])
    }

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::splat(value as f32)
    }
}

impl Mask {
    /// True for those of four bytes that share a bit with `bits`.
    #[inline(always)]
    pub fn with_bits(bytes: [u8; LANES], bits: u8) -> Self {
        Self(arch::with_bits(bytes, bits))
    }

    /// `yes` where the mask is true, `no` elsewhere.
    #[inline(always)]
    pub fn select(self, yes: Lanes, no: Lanes) -> Lanes {
        Lanes(arch::select(self.0, yes.0, no.0))
    }

    /// [`select`](Self::select) for vectors.
    #[inline(always)]
    pub fn select3(self, yes: [Lanes; 3], no: [Lanes; 3]) -> [Lanes; 3] {
        [self.select(yes[0], no[0]), self.select(yes[1], no[1]), self.select(yes[2], no[2])]
    }

    #[inline(always)]
    pub fn any(self) -> bool {
        arch::any(self.0)
    }

    /// Number of pixels for which the mask is true.
    #[inline(always)]
    pub fn count(self) -> usize {
        arch::count(self.0)
    }
}

impl BitAnd for Mask {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(arch::and(self.0, other.0))
    }
}

impl BitOr for Mask {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        Self(arch::or(self.0, other.0))
    }
}

impl Not for Mask {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self(arch::not(self.0))
    }
}

operator!(Lanes, Add, add);
operator!(Lanes, Sub, sub);
operator!(Lanes, Mul, mul);
operator!(Lanes, Div, div);

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod arch {
    pub use core::arch::wasm32::{
        f32x4_add as add, f32x4_div as div, f32x4_le as at_most, f32x4_lt as less, f32x4_mul as mul,
        f32x4_sqrt as sqrt, f32x4_sub as sub, v128_and as and, v128_any_true as any, v128_not as not, v128_or as or,
    };
    use core::arch::wasm32::{
        i32x4_bitmask, i32x4_ne, i32x4_shuffle, i32x4_splat, u16x8_extend_low_u8x16, u32x4_extend_low_u16x8, v128,
        v128_bitselect,
    };

    pub type Four = v128;
    pub type Choice = v128;

    #[inline(always)]
    pub fn four(values: [f32; 4]) -> v128 {
        // The vector is read as a whole, because otherwise each number would be loaded and inserted separately.
        bytemuck::cast(values)
    }

    #[inline(always)]
    pub fn array(four: v128) -> [f32; 4] {
        bytemuck::cast(four)
    }

    #[inline(always)]
    pub fn select(choice: v128, yes: v128, no: v128) -> v128 {
        v128_bitselect(yes, no, choice)
    }

    #[inline(always)]
    pub fn with_bits(bytes: [u8; 4], bits: u8) -> v128 {
        let spread = u32x4_extend_low_u16x8(u16x8_extend_low_u8x16(i32x4_splat(i32::from_le_bytes(bytes))));
        i32x4_ne(and(spread, i32x4_splat(i32::from(bits))), i32x4_splat(0))
    }

    #[inline(always)]
    pub fn count(choice: v128) -> usize {
        i32x4_bitmask(choice).count_ones() as usize
    }

    #[inline(always)]
    pub fn transpose([a, b, c, d]: [v128; 4]) -> [v128; 4] {
        let [low, high] = [i32x4_shuffle::<0, 4, 1, 5>(a, b), i32x4_shuffle::<2, 6, 3, 7>(a, b)];
        let [other_low, other_high] = [i32x4_shuffle::<0, 4, 1, 5>(c, d), i32x4_shuffle::<2, 6, 3, 7>(c, d)];
        [
            i32x4_shuffle::<0, 1, 4, 5>(low, other_low),
            i32x4_shuffle::<2, 3, 6, 7>(low, other_low),
            i32x4_shuffle::<0, 1, 4, 5>(high, other_high),
            i32x4_shuffle::<2, 3, 6, 7>(high, other_high),
        ]
    }
}

#[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
mod arch {
    use super::LANES;

    pub type Four = [f32; LANES];
    pub type Choice = [bool; LANES];

    each! {
        add(a, b: Four) -> Four { a + b }
        sub(a, b: Four) -> Four { a - b }
        mul(a, b: Four) -> Four { a * b }
        div(a, b: Four) -> Four { a / b }
        sqrt(a: Four) -> Four { a.sqrt() }
        less(a, b: Four) -> Choice { a < b }
        at_most(a, b: Four) -> Choice { a <= b }
        or(a, b: Choice) -> Choice { a || b }
        and(a, b: Choice) -> Choice { a && b }
        not(a: Choice) -> Choice { !a }
    }

    #[inline(always)]
    pub fn four(values: Four) -> Four {
        values
    }

    #[inline(always)]
    pub fn array(four: Four) -> Four {
        four
    }

    #[inline(always)]
    pub fn any(choice: Choice) -> bool {
        choice.contains(&true)
    }

    #[inline(always)]
    pub fn count(choice: Choice) -> usize {
        choice.iter().filter(|&&holds| holds).count()
    }

    #[inline(always)]
    pub fn with_bits(bytes: [u8; LANES], bits: u8) -> Choice {
        bytes.map(|byte| byte & bits != 0)
    }

    #[inline(always)]
    pub fn select(choice: Choice, yes: Four, no: Four) -> Four {
        std::array::from_fn(|lane| if choice[lane] { yes[lane] } else { no[lane] })
    }

    #[inline(always)]
    pub fn transpose(rows: [Four; LANES]) -> [Four; LANES] {
        std::array::from_fn(|lane| rows.map(|row| row[lane]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn ends_are_padded_and_nothing_is_written_beyond_them() {
        let mut values = [1.0, 2.0, 3.0, 4.0, 5.0];
        let [a, b, ..] = Lanes::load(&values, 4).array();
        assert!(a == 5.0 && b.is_nan());
        let [a, b, c, d] = Lanes::load(&values, -2).array();
        assert!(a.is_nan() && b.is_nan() && c == 1.0 && d == 2.0);
        Lanes::splat(7.0).store(&mut values[3..]);
        assert_eq!(values, [1.0, 2.0, 3.0, 7.0, 7.0]);
    }

    #[test]
    fn bits_choose_and_rows_become_columns() {
        let chosen = Mask::with_bits([1, 4, 0, 255], 5);
        assert_eq!(chosen.count(), 3);
        assert_eq!(chosen.select(Lanes::splat(1.0), Lanes::splat(0.0)).array(), [1.0, 1.0, 0.0, 1.0]);
        let rows = [0.0, 4.0, 8.0, 12.0].map(|first| Lanes::from([first, first + 1.0, first + 2.0, first + 3.0]));
        assert_eq!(Lanes::transpose(rows)[1].array(), [1.0, 5.0, 9.0, 13.0]);
    }

    #[test]
    fn neither_nan_nor_infinity_is_finite_or_less() {
        let odd = Lanes::from([f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -2.0]);
        assert_eq!(odd.finite().count(), 1);
        assert_eq!(odd.less(Lanes::splat(0.0)).count(), 2);
        let chosen = (!odd.finite() & odd.less(Lanes::splat(0.0))).select(Lanes::splat(1.0), Lanes::splat(0.0));
        assert_eq!(chosen.array(), [0.0, 0.0, 1.0, 0.0]);
    }
}
