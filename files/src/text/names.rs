//! Names of members, compared word by word: "cameraMatrix1", "camera_matrix_1" and "CAMERA-MATRIX 1" are the same.

use std::sync::LazyLock;

use regex_lite::Regex;
use serde_json::{Map, Value};

/// Longest name that is interpreted.
pub const LONGEST: usize = 80;

/// Largest number of characters of a text that names something.
const LONGEST_TEXT: usize = 200;

pub type Pattern = LazyLock<Regex>;

pub fn pattern(text: &str) -> Regex {
    Regex::new(text).expect("is a constant")
}

pub type Phrases = &'static [&'static [&'static str]];

pub const INTRINSICS: Phrases = &[
    &["camera", "matrix"],
    &["intrinsic", "matrix"],
    &["camera", "intrinsics"],
    &["intrinsics"],
    &["intrinsic"],
    &["mtx"],
    &["k"],
    &["m"],
];
pub const LENS: Phrases = &[
    &["distortion", "coefficients"],
    &["distortion", "coeffs"],
    &["dist", "coeffs"],
    &["dist", "coeff"],
    &["distortion"],
    &["dist"],
    &["coeffs"],
    &["d"],
];
pub const ROTATION: Phrases = &[
    &["rotation", "matrix"],
    &["rotation", "vector"],
    &["rotation"],
    &["orientation"],
    &["quaternion"],
    &["rot"],
    &["rvec"],
    &["r"],
];
pub const TRANSLATION: Phrases =
    &[&["translation", "vector"], &["translation"], &["position"], &["trans"], &["tvec"], &["t"]];
/// Matrices of 3x4 and 4x4 that are not motions: projections, and disparity to depth.
pub const NO_MOTION: Phrases = &[
    &["p"],
    &["q"],
    &["projection", "matrix"],
    &["projection"],
    &["disp", "to", "depth"],
    &["disparity", "to", "depth"],
    &["covariance"],
];

/// The words of a name.
pub fn words(name: &str) -> Vec<String> {
    if name.len() > LONGEST {
        return Vec::new();
    }
    let mut spaced = String::new();
    let mut before = ' ';
    for letter in name.chars() {
        let is_new = before.is_ascii_lowercase() && letter.is_ascii_uppercase()
            || before.is_ascii_alphabetic() && letter.is_ascii_digit();
        if is_new {
            spaced.push(' ');
        }
        spaced.push(letter);
        before = letter;
    }
    let spaced = spaced.to_lowercase();
    spaced
        .split(|letter: char| !letter.is_ascii_alphanumeric())
        .filter(|word| !word.is_empty())
        .map(Into::into)
        .collect()
}

/// The rest of a name after removing one of some phrases at its beginning or end; `None` if no phrase is there.
pub fn leftover(name: &str, phrases: Phrases) -> Option<String> {
    let words = words(name);
    phrases.iter().find_map(|phrase| {
        let is = |some: &[String]| some.iter().eq(phrase.iter());
        let split = words.len().checked_sub(phrase.len())?;
        if is(&words[..phrase.len()]) {
            return Some(words[phrase.len()..].join(" "));
        }
        is(&words[split..]).then(|| words[..split].join(" "))
    })
}

/// A name in lower case without punctuation.
fn bare(name: &str) -> String {
    if name.len() > LONGEST {
        return String::new();
    }
    name.to_lowercase().chars().filter(char::is_ascii_alphanumeric).collect()
}

/// A member by one of its names, ignoring case and punctuation.
pub fn member<'a>(node: &'a Map<String, Value>, names: &[&str]) -> Option<&'a Value> {
    node.iter().find(|(key, _)| names.contains(&bare(key).as_str())).map(|(_, value)| value)
}

/// A text that names something.
pub fn text_of(value: Option<&Value>) -> Option<String> {
    value?.as_str().filter(|text| !text.is_empty()).map(|text| text.chars().take(LONGEST_TEXT).collect())
}

/// The member whose name consists of one of some phrases and this label; earlier phrases take precedence.
pub fn labelled<'a>(node: &'a Map<String, Value>, phrases: Phrases, label: &str) -> Option<(&'a String, &'a Value)> {
    (0..phrases.len())
        .find_map(|index| node.iter().find(|(key, _)| leftover(key, &phrases[index..=index]).as_deref() == Some(label)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_compared_word_by_word() {
        for name in ["cameraMatrix1", "camera_matrix_1", "CAMERA-MATRIX 1", "1_camera_matrix"] {
            assert_eq!(leftover(name, INTRINSICS).as_deref(), Some("1"), "{name}");
        }
        assert_eq!(leftover("K", INTRINSICS).as_deref(), Some(""));
        assert_eq!(leftover("depth_intrinsics", INTRINSICS).as_deref(), Some("depth"));
        assert_eq!(leftover("kind", INTRINSICS), None);
    }
}
