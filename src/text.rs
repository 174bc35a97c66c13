//! Numbers in messages for people.
//!
//! The standard library can write any float exactly, up to its 300th digit. Messages need three or eight, and without
//! the rest the download is 10 kB smaller.

use std::fmt;

/// Decimals of a [`Brief`] number between one and ten: eight digits distinguish a number just above a limit from the
/// limit, and omit most of what f32 adds to 0.1.
const DECIMALS: i32 = 7;
/// Powers of ten for which a [`Brief`] number is written out; others get an exponent.
const WRITTEN_OUT: std::ops::Range<i32> = -4..15;

/// A number with this many decimals, at most six.
pub struct Fixed(pub f64, pub u32);

impl fmt::Display for Fixed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(value, decimals) = *self;
        write(f, value, (value.abs() * 10_f64.powi(decimals as i32)).round() as u64, decimals)
    }
}

/// A number to eight digits, as one would type it.
pub struct Brief(pub f64);

impl fmt::Display for Brief {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let value = self.0;
        let (digits, power) = leading_digits(value.abs());
        if !WRITTEN_OUT.contains(&power) {
            write_trimmed(f, value, digits, DECIMALS)?;
            return write!(f, "e{power:+}");
        }
        if power > DECIMALS {
            return write(f, value, value.abs().round() as u64, 0);
        }
        write_trimmed(f, value, digits, DECIMALS - power)
    }
}

/// The first digits of a magnitude as a whole number, and the power of ten of the first one; zeros unless it is a
/// finite number above zero.
fn leading_digits(mut magnitude: f64) -> (u64, i32) {
    if magnitude == 0.0 || !magnitude.is_finite() {
        return (0, 0);
    }
    let mut power = 0;
    while magnitude >= 10.0 {
        (magnitude, power) = (magnitude / 10.0, power + 1);
    }
    while magnitude < 1.0 {
        (magnitude, power) = (magnitude * 10.0, power - 1);
    }
    let digits = (magnitude * 10_f64.powi(DECIMALS)).round() as u64;
    if digits == 10_u64.pow(DECIMALS as u32 + 1) { (digits / 10, power + 1) } else { (digits, power) }
}

/// Omits zeros at the end of the decimals.
fn write_trimmed(f: &mut fmt::Formatter<'_>, value: f64, mut digits: u64, decimals: i32) -> fmt::Result {
    let mut decimals = decimals as u32;
    while decimals > 0 && digits.is_multiple_of(10) {
        (digits, decimals) = (digits / 10, decimals - 1);
    }
    write(f, value, digits, decimals)
}

/// The sign of `value`, and its digits with a point before the last `decimals`.
fn write(f: &mut fmt::Formatter<'_>, value: f64, digits: u64, decimals: u32) -> fmt::Result {
    if value.is_nan() {
        return f.write_str("NaN");
    }
    if value < 0.0 {
        f.write_str("-")?;
    }
    if value.is_infinite() {
        // JavaScript also writes infinity in this way.
        return f.write_str("Infinity");
    }
    let unit = 10_u64.pow(decimals);
    write!(f, "{}", digits / unit)?;
    if decimals > 0 {
        write!(f, ".{:0width$}", digits % unit, width = decimals as usize)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fixed_is_what_the_standard_library_writes() {
        for value in [0.0, 0.04, 0.96, 1.5, -2.26, 12.345, 99.99, 1234.0, 1e12] {
            for decimals in 0..5_u32 {
                let expected = format!("{value:.width$}", width = decimals as usize);
                // A tie in binary digits need not be a tie in decimal digits.
                let found = Fixed(value, decimals).to_string();
                let apart = (found.parse::<f64>().unwrap() - expected.parse::<f64>().unwrap()).abs();
                assert!(
                    found.len() == expected.len() && apart < 1.01 * 0.1_f64.powi(decimals as i32),
                    "{found} {expected}"
                );
            }
        }
    }

    #[test]
    fn brief_is_as_one_would_type_it() {
        for (value, text) in [
            (0.0, "0"),
            (1.0, "1"),
            (-3.0, "-3"),
            (f64::from(0.1_f32), "0.1"),
            (-0.000_25, "-0.00025"),
            (1_234_567.0, "1234567"),
            (4_294_967_296.0, "4294967296"),
            (2.0 / 3.0, "0.66666667"),
            (9.999_999_996, "10"),
            (1.000_000_1, "1.0000001"),
            (999_999.5, "999999.5"),
            (1e300, "1e+300"),
            (-1.5e-12, "-1.5e-12"),
            (5e-324, "4.9406565e-324"),
            (f64::MAX, "1.7976931e+308"),
            (f64::NAN, "NaN"),
            (f64::NEG_INFINITY, "-Infinity"),
        ] {
            assert_eq!(Brief(value).to_string(), text);
        }
    }
}
