//! The unit of a depth map in metres, guessed from its values by the rules of js/rig/depth.ts, and warnings about it.
//!
//! Limits: values alone cannot always distinguish millimetres from fifths of them (TUM), so every guess is reported.

use std::collections::HashSet;

use crate::text::numbers::brief;

/// Range of depths that a camera is expected to see, metres.
pub const NEAREST: f64 = 0.1;
pub const FARTHEST: f64 = 20.0;
/// Largest share of depths outside the range that does not cause a warning about the unit.
const STRAY: f64 = 0.01;
/// Largest median depth of indoor sensors with integer depths, metres; beyond it, the unit is not the millimetre.
const USUAL: f64 = 8.0;
/// Share of values for which a rule about their last digits must hold.
const NEARLY_ALL: f64 = 0.99;
/// The same share for SUN RGB-D, whose depths beyond 8.19 m wrap into the low bits.
const MOSTLY: f64 = 0.9;
/// Smallest number of distinct depths of a measured map; round numbers of a map made by hand do not show the unit.
const MANY_VALUES: usize = 16;
/// Smallest value that means that nothing was seen.
const LARGEST: f64 = 1e12;
/// Largest number of values in a quantile.
const SAMPLE: usize = 65_536;

/// Metres for each stored number, and how they are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    pub metres: f64,
    pub is_guessed: bool,
    /// The evidence for the guess among the values; may be empty.
    why: &'static str,
}

impl Unit {
    /// A given unit.
    pub const fn given(metres: f64) -> Self {
        Self { metres, is_guessed: false, why: "" }
    }

    const fn guessed(metres: f64, why: &'static str) -> Self {
        Self { metres, is_guessed: true, why }
    }

    /// The unit of values rotated by three bits, once they are rotated back.
    pub const TURNED: Self = Self::guessed(0.001, "SUN RGB-D");

    /// The name of the unit.
    pub fn name(&self) -> String {
        const NAMED: [(f64, &str); 5] = [
            (1.0, "metres"),
            (0.001, "millimetres"),
            (0.01, "centimetres"),
            (0.0002, "fifths of a millimetre, 5000 to the metre"),
            (0.0001, "tenths of a millimetre"),
        ];
        let named = NAMED.into_iter().find(|(metres, _)| (self.metres / metres - 1.0).abs() < 1e-6);
        named.map_or_else(|| format!("units of {} mm", brief(1000.0 * self.metres, 4)), |(_, name)| name.into())
    }

    /// The name of the unit, with a remark if it was guessed.
    pub fn says(&self) -> String {
        match (*self == Self::TURNED, self.is_guessed, self.why) {
            (true, ..) => "millimetres with their bits rotated by three (SUN RGB-D; guessed)".into(),
            (_, false, _) => self.name(),
            (_, true, "") => format!("{} (guessed)", self.name()),
            (_, true, why) => format!("{} (guessed: {why})", self.name()),
        }
    }
}

/// The valid values, sorted, at most [`SAMPLE`] of them.
pub struct Sample(Vec<f64>);

impl Sample {
    pub fn of(values: impl ExactSizeIterator<Item = f64>) -> Self {
        let stride = values.len().div_ceil(SAMPLE).max(1);
        let mut sorted: Vec<f64> = values.step_by(stride).filter(|&value| value > 0.0 && value < LARGEST).collect();
        sorted.sort_by(f64::total_cmp);
        Self(sorted)
    }

    fn median(&self) -> f64 {
        self.0.get((self.0.len().max(1) - 1) / 2).copied().unwrap_or(f64::NAN)
    }

    fn share(&self, rule: impl Fn(f64) -> bool) -> f64 {
        self.0.iter().filter(|&&value| rule(value)).count() as f64 / self.0.len() as f64
    }

    fn is_varied(&self) -> bool {
        self.0.iter().map(|value| value.to_bits()).collect::<HashSet<_>>().len() >= MANY_VALUES
    }

    /// SUN RGB-D rotates the bits of its millimetres by three, so most values are multiples of 8.
    pub fn is_turned(&self) -> bool {
        self.is_varied() && self.share(|value| value % 8.0 == 0.0) >= MOSTLY && self.median() > 1000.0
    }

    /// The unit of whole numbers. In TUM's files all are multiples of 5, because they are a Kinect's millimetres in
    /// fifths.
    pub fn unit_of_integers(&self) -> Unit {
        let fives = self.is_varied()
            && self.share(|value| value % 5.0 == 0.0) >= NEARLY_ALL
            && self.median() > 1000.0 * NEAREST * 5.0;
        if fives {
            return Unit::guessed(0.0002, "all values are multiples of 5");
        }
        if self.median() > 1000.0 * USUAL {
            return Unit::guessed(0.0002, "too far for millimetres");
        }
        Unit::guessed(0.001, "")
    }

    /// The unit of floats: millimetres if, as metres, half of them would be out of range.
    pub fn unit_of_floats(&self) -> Unit {
        Unit::guessed(if self.median() > FARTHEST { 0.001 } else { 1.0 }, "")
    }

    /// Whether whole numbers without a unit are a camera's millimetres: at least half of them are too large to be
    /// depths in pixels.
    pub fn looks_like_millimetres(&self) -> bool {
        self.is_varied() && self.median() > 1000.0 * NEAREST
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether the largest value is common and equals the mark of a Kinect's raw disparity for missing pixels.
    pub fn looks_like_disparity(&self) -> bool {
        const BLIND: f64 = 2047.0;
        self.0.last() == Some(&BLIND) && self.share(|value| value == BLIND) > STRAY
    }

    /// The share of depths outside the range that a rig's camera is expected to see; `None` if only stray depths are
    /// outside.
    pub fn beyond(&self, metres: f64) -> Option<f64> {
        let beyond = self.share(|value| value * metres < NEAREST || value * metres > FARTHEST);
        (beyond > STRAY).then_some(beyond)
    }

    /// A warning about depths in that unit, if they are implausible.
    pub fn warning(&self, metres: f64) -> Option<String> {
        let share = 100.0 * self.beyond(metres)?;
        Some(format!("{share:.1} % of the depths are outside {NEAREST} to {FARTHEST} m: is the unit right?"))
    }
}

/// Converts SUN RGB-D's numbers to millimetres.
pub fn turned_back(data: &[u16]) -> Vec<u16> {
    data.iter().map(|value| value.rotate_right(3)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(values: impl Iterator<Item = u32>) -> f64 {
        let values: Vec<f64> = values.map(f64::from).collect();
        Sample::of(values.into_iter()).unit_of_integers().metres
    }

    #[test]
    fn whole_numbers_are_millimetres_but_for_multiples_of_five_and_what_is_too_far() {
        assert_eq!(unit(700..900), 0.001);
        assert_eq!(unit((700..900).map(|value| 5 * value)), 0.0002);
        assert_eq!(unit(9001..9300), 0.0002);
        // Round numbers of a few values that were made by hand do not show the unit.
        assert_eq!(unit([1000, 1005, 1010].into_iter()), 0.001);
    }

    #[test]
    fn floats_are_metres_unless_that_is_too_far() {
        let of = |value: f64| Sample::of([value; 4].into_iter()).unit_of_floats().metres;
        assert_eq!((of(1.2), of(1200.0)), (1.0, 0.001));
    }

    #[test]
    fn turned_bits_are_found_and_turned_back() {
        let millimetres: Vec<u16> = (1500..1700).collect();
        let stored: Vec<u16> = millimetres.iter().map(|value| value.rotate_left(3)).collect();
        let sample = |data: &[u16]| Sample::of(data.iter().map(|&value| f64::from(value)));
        assert!(sample(&stored).is_turned() && !sample(&millimetres).is_turned());
        assert_eq!(turned_back(&stored), millimetres);
    }
}
