//! Numbers and matrices in the notations of many files.

use std::sync::LazyLock;

use regex_lite::Regex;
use serde_json::Value;

/// Largest number of numbers in a matrix; calibrations have at most 16 and distortions 14.
const MOST: usize = 64;

static NUMBER: LazyLock<Regex> = LazyLock::new(|| {
    Regex::new(r"^[-+]?(?:[0-9]+(?:\.[0-9]*)?|\.[0-9]+)(?:[eEdD][-+]?[0-9]+)?$").expect("is a constant")
});

/// A number in a text; `None` if it is not a number.
pub fn number_in(text: &str) -> Option<f64> {
    let text = text.trim();
    if !NUMBER.is_match(text) {
        return None;
    }
    text.replace(['d', 'D'], "e").parse().ok()
}

/// A number, possibly written as text; `None` if it is not one or not finite.
pub fn number_of(value: Option<&Value>) -> Option<f64> {
    match value? {
        Value::Number(number) => number.as_f64().filter(|value| value.is_finite()),
        Value::String(text) => number_in(text),
        _ => None,
    }
}

/// A number as in messages, formatted like JavaScript's.
pub fn shown(value: f64) -> String {
    ryu_js::Buffer::new().format(value).to_owned()
}

/// Significant digits of numbers in messages: a file's own digits, of which there may be sixteen, hide the value.
pub const DIGITS: usize = 5;

/// This many significant digits, without trailing zeros.
pub fn brief(value: f64, digits: usize) -> String {
    match precise(value, digits).parse() {
        Ok(value) => shown(value),
        Err(_) => shown(value),
    }
}

/// This many significant digits, formatted like JavaScript's toPrecision.
pub fn precise(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return shown(value);
    }
    if value == 0.0 {
        return format!("{:.*}", digits - 1, 0.0);
    }
    let written = format!("{value:.*e}", digits - 1);
    let (mantissa, power) = written.split_once('e').unwrap_or((&written, "0"));
    let power: i32 = power.parse().unwrap_or(0);
    if power < -6 || power >= digits as i32 {
        return format!("{mantissa}e{power:+}");
    }
    format!("{value:.*}", (digits as i32 - 1 - power).max(0) as usize)
}

/// This many decimals, halves away from zero, formatted like JavaScript's toFixed.
pub fn fixed(value: f64, decimals: i32) -> String {
    if !value.is_finite() || value.abs() >= 1e15 {
        return shown(value);
    }
    // Rust and JavaScript differ only in the rounding of exact halves, which are multiples of this power of two.
    let scaled = value.abs() * 10_f64.powi(decimals);
    let is_half = scaled.fract() == 0.5 && (value * 2_f64.powi(decimals + 1)).fract() == 0.0;
    let value = if is_half { value.signum() * (scaled + 0.25).round() / 10_f64.powi(decimals) } else { value };
    format!("{value:.*}", decimals as usize)
}

/// Numbers, and the number of rows if the file states it: lists of lists, `rows`.
#[derive(Clone, Debug, PartialEq)]
pub struct Matrix {
    pub values: Vec<f64>,
    pub rows: Option<usize>,
}

pub fn words_of_numbers(text: &str) -> impl Iterator<Item = &str> {
    text.split(|letter: char| letter.is_whitespace() || ",;[]()".contains(letter)).filter(|part| !part.is_empty())
}

fn list_of(value: &Value) -> Option<Vec<f64>> {
    let numbers: Vec<f64> = match value {
        Value::String(text) => words_of_numbers(text).take(MOST + 1).map(number_in).collect::<Option<_>>()?,
        Value::Array(parts) if parts.len() <= MOST => {
            parts.iter().map(|part| number_of(Some(part))).collect::<Option<_>>()?
        }
        _ => return None,
    };
    (!numbers.is_empty() && numbers.len() <= MOST).then_some(numbers)
}

/// A list of numbers, of lists of numbers, or OpenCV's and ROS's `{ rows, cols, data }`.
pub fn matrix_of(value: Option<&Value>) -> Option<Matrix> {
    let value = value?;
    if let Value::Object(node) = value {
        let values = list_of(node.get("data")?)?;
        let (rows, columns) = (number_of(node.get("rows"))?, number_of(node.get("cols"))?);
        return (rows * columns == values.len() as f64).then_some(Matrix { values, rows: Some(rows as usize) });
    }
    if let Value::Array(lists) = value
        && !lists.is_empty()
        && lists.len() <= MOST
        && lists.iter().all(Value::is_array)
    {
        let rows: Vec<Vec<f64>> = lists.iter().map(list_of).collect::<Option<_>>()?;
        let is_even = rows.iter().all(|row| row.len() == rows[0].len());
        return is_even.then(|| Matrix { values: rows.concat(), rows: Some(rows.len()) });
    }
    list_of(value).map(|values| Matrix { values, rows: None })
}

/// The transpose of a square matrix.
pub fn transposed(values: &[f64], side: usize) -> Vec<f64> {
    (0..values.len()).map(|at| values.get((at % side) * side + at / side).copied().unwrap_or(0.0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_javascript_writes_them() {
        for (value, digits, text) in [
            (0.012_345, 3, "0.0123"),
            (1234.5, 3, "1.23e+3"),
            (1e-9, 2, "1.0e-9"),
            (9.999, 2, "10"),
            (17.4, 4, "17.40"),
        ] {
            assert_eq!(precise(value, digits), text);
        }
        assert_eq!((brief(1234.5, 3), brief(0.5, 3), brief(1e-9, 3)), ("1230".into(), "0.5".into(), "1e-9".into()));
        assert_eq!((fixed(12.5, 0), fixed(0.125, 2), fixed(2.675, 2)), ("13".into(), "0.13".into(), "2.67".into()));
    }

    #[test]
    fn numbers_in_texts_are_whole_words() {
        assert_eq!(
            ["1e3", "-.5", "1d2", "nan", "0x10", "1 2", ""].map(number_in),
            [Some(1000.0), Some(-0.5), Some(100.0), None, None, None, None]
        );
    }
}
