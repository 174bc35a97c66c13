//! Two pixels side by side: f64 arithmetic that fills one vector register of WebAssembly, see [`lanes`](super::lanes).
//!
//! For sums whose small differences matter, because solving normal equations loses half of the digits.
//!
//! Why not the crate `wide` (1.7): its exponential takes 4.5 times as long with simd128 and 3.6 times without (Node 20),
//! because it returns all digits. Seven suffice here.

use std::ops::{Add, BitAnd, Div, Mul, Sub};

use super::lanes::Real;

/// Number of pixels that are processed at once.
pub const DOUBLE_LANES: usize = if cfg!(all(target_arch = "wasm32", not(target_feature = "simd128"))) { 1 } else { 2 };

/// Smallest exponent; smaller ones are raised to it, because 2^-1000 is practically zero.
const LEAST_POWER: f64 = -1000.0;
/// 1.5 2^52. Adding this constant to a number rounds that number to an integer, which is then in the last bits of the
/// sum.
const ROUNDING: f64 = 6_755_399_441_055_744.0;
/// Number of mantissa bits of an f64, below its exponent.
const MANTISSA: u32 = 52;
/// Taylor series of e^x, from the sixth power down; its relative error is below 2e-7 where |x| < ln(2) / 2.
const SERIES: [f64; 7] = [1.0 / 720.0, 1.0 / 120.0, 1.0 / 24.0, 1.0 / 6.0, 0.5, 1.0, 1.0];

/// Two numbers.
#[derive(Clone, Copy, Debug)]
pub struct Doubles(arch::Two);

/// A boolean for each of two numbers.
#[derive(Clone, Copy, Debug)]
pub struct Choices(arch::Choice);

impl Doubles {
    /// Two values from `start`; all NaN where fewer are left.
    #[inline(always)]
    pub fn load(values: &[f64], start: usize) -> Self {
        let two = values.get(start..).and_then(|values| values.first_chunk());
        two.map_or(Self::splat(f64::NAN), |two| Self::from(*two))
    }

    #[inline(always)]
    pub fn array(self) -> [f64; DOUBLE_LANES] {
        arch::array(self.0)
    }

    /// Sum of both.
    #[inline(always)]
    pub fn sum(self) -> f64 {
        self.array().iter().sum()
    }

    #[inline(always)]
    pub fn sqrt(self) -> Self {
        Self(arch::sqrt(self.0))
    }

    /// False for NaN.
    #[inline(always)]
    pub fn less(self, other: Self) -> Choices {
        Choices(arch::less(self.0, other.0))
    }

    /// False for NaN.
    #[inline(always)]
    pub fn at_most(self, other: Self) -> Choices {
        Choices(arch::at_most(self.0, other.0))
    }

    /// The smaller of each pair; the other's number where this one is NaN.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        self.less(other).select(self, other)
    }

    /// Raises numbers below `floor` to it; NaN stays NaN.
    #[inline(always)]
    pub fn raised_to(self, floor: f64) -> Self {
        let floor = Self::splat(floor);
        self.less(floor).select(floor, self)
    }

    /// 2^x to seven digits, for x up to 1000.
    #[inline(always)]
    pub fn exp2(self) -> Self {
        let power = self.raised_to(LEAST_POWER);
        let shifted = power + Self::splat(ROUNDING);
        let rest = (power - (shifted - Self::splat(ROUNDING))) * Self::splat(std::f64::consts::LN_2);
        let [sixth, fifth, fourth, third, second, first, zeroth] = SERIES.map(Self::splat);
        let value = (((((sixth * rest + fifth) * rest + fourth) * rest + third) * rest + second) * rest + first) * rest;
        Self(arch::grow((value + zeroth).0, shifted.0))
    }
}

impl From<[f64; DOUBLE_LANES]> for Doubles {
    #[inline(always)]
    fn from(values: [f64; DOUBLE_LANES]) -> Self {
        Self(arch::two(values))
    }
}

impl Real for Doubles {
    type Scalar = f64;

    #[inline(always)]
    fn splat(value: f64) -> Self {
        Self::from([value; DOUBLE_LANES])
    }

    #[inline(always)]
    fn constant(value: f64) -> Self {
        Self::splat(value)
    }
}

impl Choices {
    /// `yes` where the choice is true, `no` elsewhere.
    #[inline(always)]
    pub fn select(self, yes: Doubles, no: Doubles) -> Doubles {
        Doubles(arch::select(self.0, yes.0, no.0))
    }

    /// `number` where the choice is true, zero elsewhere.
    #[inline(always)]
    pub fn keep(self, number: Doubles) -> Doubles {
        self.select(number, Doubles::splat(0.0))
    }
}

impl BitAnd for Choices {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self(arch::and(self.0, other.0))
    }
}

operator!(Doubles, Add, add);
operator!(Doubles, Sub, sub);
operator!(Doubles, Mul, mul);
operator!(Doubles, Div, div);

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod arch {
    pub use core::arch::wasm32::{
        f64x2_add as add, f64x2_div as div, f64x2_le as at_most, f64x2_lt as less, f64x2_mul as mul,
        f64x2_sqrt as sqrt, f64x2_sub as sub, v128_and as and,
    };
    use core::arch::wasm32::{i64x2_add, i64x2_shl, v128, v128_bitselect};

    pub type Two = v128;
    pub type Choice = v128;

    #[inline(always)]
    pub fn two(values: [f64; 2]) -> v128 {
        // The vector is cast as a whole, for the reason given in lanes.rs.
        bytemuck::cast(values)
    }

    #[inline(always)]
    pub fn array(two: v128) -> [f64; 2] {
        bytemuck::cast(two)
    }

    #[inline(always)]
    pub fn select(choice: v128, yes: v128, no: v128) -> v128 {
        v128_bitselect(yes, no, choice)
    }

    /// The value times 2 to the power in the last bits of `power`.
    #[inline(always)]
    pub fn grow(value: v128, power: v128) -> v128 {
        i64x2_add(value, i64x2_shl(power, super::MANTISSA))
    }
}

#[cfg(not(all(target_arch = "wasm32", target_feature = "simd128")))]
mod arch {
    use super::DOUBLE_LANES;

    pub type Two = [f64; DOUBLE_LANES];
    pub type Choice = [bool; DOUBLE_LANES];

    each! {
        add(a, b: Two) -> Two { a + b }
        sub(a, b: Two) -> Two { a - b }
        mul(a, b: Two) -> Two { a * b }
        div(a, b: Two) -> Two { a / b }
        sqrt(a: Two) -> Two { a.sqrt() }
        less(a, b: Two) -> Choice { a < b }
        at_most(a, b: Two) -> Choice { a <= b }
        and(a, b: Choice) -> Choice { a && b }
        // The value times 2 to the power in the last bits of `power`.
        grow(value, power: Two) -> Two {
            f64::from_bits(value.to_bits().wrapping_add(power.to_bits() << super::MANTISSA))
        }
    }

    #[inline(always)]
    pub fn two(values: Two) -> Two {
        values
    }

    #[inline(always)]
    pub fn array(two: Two) -> Two {
        two
    }

    #[inline(always)]
    pub fn select(choice: Choice, yes: Two, no: Two) -> Two {
        std::array::from_fn(|lane| if choice[lane] { yes[lane] } else { no[lane] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    #[test]
    fn powers_of_two_have_seven_digits() {
        for k in -9000..9000 {
            let x = 0.1 * f64::from(k);
            let [found, _] = Doubles::from([x, 0.0]).exp2().array();
            assert!((found / x.exp2() - 1.0).abs() < 2e-7, "{x} {found}");
        }
        assert!(Doubles::splat(f64::NEG_INFINITY).exp2().array()[0] < 1e-300);
    }

    #[test]
    fn what_is_missing_is_not_raised_and_never_less() {
        let odd = Doubles::from([f64::NAN, -2.0]);
        let [missing, floor] = odd.raised_to(0.0).array();
        assert!(missing.is_nan() && floor == 0.0);
        let [kept, other] = (odd.less(Doubles::splat(0.0)) & odd.at_most(odd)).keep(Doubles::splat(1.0)).array();
        assert_eq!([kept, other], [0.0, 1.0]);
        assert!(Doubles::load(&[1.0; 3], 2).array()[0].is_nan());
    }
}
