//! ROS's static transforms on a command line, in a launch file or in a script, and the output of tf_echo.

use std::collections::HashMap;

use super::calibration::{Calibration, NamedPose, Names, Reason};
use super::names::{Pattern, pattern};
use super::numbers::number_in;
use super::poses::{of_quaternion, of_yaw_pitch_roll, turned};
use crate::warning::Warnings;

const NAME: &str = "static_transform_publisher";
/// Number of characters after the name that may hold its arguments: numbers, names, quotes and brackets.
const REACH: usize = 2000;
const MOST: usize = 1000;

pub fn is_publisher(text: &str) -> bool {
    text.contains(NAME)
}

/// The first `most` characters.
fn head(text: &str, most: usize) -> &str {
    text.char_indices().nth(most).map_or(text, |(end, _)| &text[..end])
}

/// The words after each mention, up to the end of its element or the next mention.
fn mentions(text: &str) -> Result<Vec<Vec<String>>, Reason> {
    static END: Pattern = Pattern::new(|| pattern(r"/>|</node>|<node|\bNode\s*\("));
    static BROKEN: Pattern = Pattern::new(|| pattern(r"\\\r?\n"));
    static ARGUMENTS: [Pattern; 2] = [
        Pattern::new(|| pattern(r#"\bargs\s*=\s*"([^"]*)""#)),
        Pattern::new(|| pattern(r"\barguments\s*=\s*\[([^\]]*)\]")),
    ];
    let pieces: Vec<&str> = text.split(NAME).skip(1).collect();
    if pieces.len() > MOST {
        return Err(format!("it holds more than {MOST} static transforms"));
    }
    let words = |piece: &&str| {
        let whole = BROKEN.replace_all(head(piece, REACH), " ").into_owned();
        let inside = END.find(&whole).map_or(&whole[..], |end| &whole[..end.start()]);
        let named = ARGUMENTS.iter().find_map(|pattern| pattern.captures(inside)?.get(1).map(|found| found.as_str()));
        let line = || inside.lines().find(|line| line.bytes().any(|letter| letter.is_ascii_digit())).unwrap_or("");
        let is_between = |letter: char| letter.is_whitespace() || ",'\"[]()=".contains(letter);
        let arguments = named.unwrap_or_else(line);
        arguments.split(is_between).filter(|part| !part.is_empty()).map(Into::into).collect()
    };
    Ok(pieces.iter().map(words).collect())
}

fn names(from: Option<&str>, to: Option<&str>) -> Names {
    Names { name: None, from: from.map(Into::into), to: to.map(Into::into) }
}

/// ROS 2: `--x 1 --qw 1 --frame-id a --child-frame-id b`.
fn of_flags(words: &[String], warnings: &mut Warnings) -> Result<NamedPose, Reason> {
    let values: HashMap<&str, &str> = words
        .iter()
        .enumerate()
        .filter_map(|(at, word)| Some((word.strip_prefix("--")?, words.get(at + 1).map_or("", |value| value))))
        .collect();
    let number = |name: &str, missing: f64| match values.get(name) {
        None => Ok(missing),
        Some(text) => {
            number_in(text).ok_or_else(|| format!("its static transform has --{name} {text}, which is not a number"))
        }
    };
    let is_quaternion = ["qx", "qy", "qz", "qw"].iter().any(|name| values.contains_key(name));
    let rotation = if is_quaternion {
        of_quaternion([number("qx", 0.0)?, number("qy", 0.0)?, number("qz", 0.0)?, number("qw", 1.0)?], warnings)?
    } else {
        of_yaw_pitch_roll([number("yaw", 0.0)?, number("pitch", 0.0)?, number("roll", 0.0)?])
    };
    let shift = [number("x", 0.0)?, number("y", 0.0)?, number("z", 0.0)?];
    let names = names(values.get("child-frame-id").copied(), values.get("frame-id").copied());
    turned(&rotation, &shift, names, warnings, true)
}

/// ROS 1: `x y z yaw pitch roll parent child [ms]` or `x y z qx qy qz qw parent child [ms]`.
fn of_places(words: &[String], warnings: &mut Warnings) -> Result<NamedPose, Reason> {
    let numbers: Vec<f64> = words.iter().map_while(|word| number_in(word)).collect();
    let rotation = match numbers[..] {
        [_, _, _, yaw, pitch, roll] => of_yaw_pitch_roll([yaw, pitch, roll]),
        [_, _, _, x, y, z, w] => of_quaternion([x, y, z, w], warnings)?,
        _ => {
            return Err(format!(
                "its static transform has {} numbers; x y z and yaw pitch roll, or qx qy qz qw, are needed",
                numbers.len()
            ));
        }
    };
    let name = |at: usize| words.get(numbers.len() + at).map(String::as_str);
    turned(&rotation, &numbers[..3], names(name(1), name(0)), warnings, true)
}

/// The transform maps points of the child frame into the parent, so they come from the child.
pub fn read_publishers(text: &str) -> Result<Calibration, Reason> {
    let mut found = Calibration { format: "a static transform of ROS".into(), ..Calibration::default() };
    let mut mentions = mentions(text)?;
    mentions.retain(|words| words.iter().any(|word| number_in(word).is_some()));
    if mentions.is_empty() {
        return Err(format!("it names {NAME}, but no numbers follow"));
    }
    for words in &mentions {
        let has_flags = words.iter().any(|word| word.starts_with("--"));
        let read = if has_flags { of_flags } else { of_places };
        found.poses.push(read(words, &mut found.warnings)?);
    }
    Ok(found)
}

static TRIPLE: Pattern = Pattern::new(|| pattern(r"Translation:\s*\[([^\]\n]{1,200})\]"));
static QUATERNION: Pattern = Pattern::new(|| pattern(r"Quaternion\s*(?:\(xyzw\)\s*)?\[([^\]\n]{1,200})\]"));

pub fn is_echo(text: &str) -> bool {
    let text = head(text, REACH);
    TRIPLE.is_match(text) && QUATERNION.is_match(text)
}

/// The first transform in the output of tf_echo, which does not contain the names of the frames.
pub fn read_echo(text: &str) -> Result<Calibration, Reason> {
    let text = head(text, REACH);
    let numbers = |pattern: &Pattern, count: usize| {
        let listed = pattern.captures(text).map(|found| found[1].to_owned()).unwrap_or_default();
        let numbers: Option<Vec<f64>> = listed.split(',').map(number_in).collect();
        numbers
            .filter(|numbers| numbers.len() == count)
            .ok_or_else(|| format!("its transform does not have {count} numbers where they are needed"))
    };
    let (turn, shift) = (numbers(&QUATERNION, 4)?, numbers(&TRIPLE, 3)?);
    let mut found = Calibration { format: "a transform of ROS".into(), ..Calibration::default() };
    let rotation = of_quaternion(std::array::from_fn(|at| turn[at]), &mut found.warnings)?;
    found.poses.push(turned(&rotation, &shift, Names::default(), &mut found.warnings, true)?);
    Ok(found)
}
