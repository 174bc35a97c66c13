//! The output of `rs-enumerate-devices -c`: intrinsics of all streams and sizes, and the extrinsics between streams.

use std::collections::HashMap;

use super::calibration::{Calibration, NamedCamera, NamedPose, Names, Reason};
use super::cameras::{RawCamera, camera_of};
use super::names::{Pattern, pattern};
use super::numbers::number_in;
use super::poses::motion;
use crate::warning::Warnings;

static INTRINSIC: Pattern = Pattern::new(|| pattern(r#"^\s*Intrinsic of "([^"]{1,60})""#));
static EXTRINSIC: Pattern = Pattern::new(|| pattern(r#"(?i)^\s*Extrinsic from "([^"]{1,60})"\s+To\s+"([^"]{1,60})""#));
/// Largest number of entries, streams times sizes; a camera has some sixty.
const MOST: usize = 2000;
/// Largest number of lines of a camera, and of a motion.
const BLOCK: usize = 15;
const MOTION: usize = 7;

pub fn is_enumeration(text: &str) -> bool {
    static HEAD: Pattern = Pattern::new(|| pattern(r#"(?m)^[ \t]*(?:Intrinsic of|Extrinsic from) ""#));
    HEAD.is_match(text)
}

fn numbers_of(text: &str) -> Vec<f64> {
    text.split_whitespace().filter_map(number_in).collect()
}

fn camera(name: &str, lines: &[&str], warnings: &mut Warnings) -> Result<NamedCamera, Reason> {
    let entries: HashMap<String, &str> = lines
        .iter()
        .map(|line| line.split_once(':').unwrap_or((line, line)))
        .map(|(key, value)| (key.trim().to_lowercase(), value.trim()))
        .collect();
    let number = |key: &str| entries.get(key).and_then(|text| number_in(text)).unwrap_or(f64::NAN);
    let raw = RawCamera {
        name: Some(name.into()),
        focal: [number("fx"), number("fy")],
        centre: [number("ppx"), number("ppy")],
        model: entries.get("distortion").map(|&text| text.into()),
        distortion: numbers_of(entries.get("coeffs").unwrap_or(&"")),
        width: Some(number("width")),
        height: Some(number("height")),
        ..RawCamera::default()
    };
    camera_of(raw, warnings)
}

/// The rotation is printed row by row, although librealsense stores it by columns.
fn extrinsics(from: &str, to: &str, lines: &[&str], warnings: &mut Warnings) -> Result<NamedPose, Reason> {
    let after_colon = |line: &&str| numbers_of(line.rsplit_once(':').map_or(line, |(_, value)| value));
    let values: Vec<f64> = lines.iter().flat_map(after_colon).collect();
    if values.len() != 12 {
        return Err(format!(
            "its extrinsics from \"{from}\" to \"{to}\" have {} numbers; nine of a rotation and three of a translation are needed",
            values.len()
        ));
    }
    let names = Names::between(Some(format!("{to} from {from}")), from, to);
    motion(&values[..9], &values[9..], names, warnings, true)
}

pub fn read(text: &str) -> Result<Calibration, Reason> {
    let mut found = Calibration { format: "RealSense's streams".into(), ..Calibration::default() };
    let lines: Vec<&str> = text.lines().collect();
    let is_start = |at: &usize| INTRINSIC.is_match(lines[*at]) || EXTRINSIC.is_match(lines[*at]);
    let starts: Vec<usize> = (0..lines.len()).filter(is_start).collect();
    if starts.len() > MOST {
        return Err(format!("it holds more than {MOST} intrinsics and extrinsics"));
    }
    if starts.is_empty() {
        return Err("it has intrinsics or extrinsics of RealSense, but no stream".into());
    }
    for (index, &start) in starts.iter().enumerate() {
        let end = starts.get(index + 1).copied().unwrap_or(lines.len()).min(start + 1 + BLOCK);
        let block = &lines[start + 1..end];
        let warnings = &mut found.warnings;
        if let Some(streams) = EXTRINSIC.captures(lines[start]) {
            let block = &block[..block.len().min(MOTION)];
            found.poses.push(extrinsics(&streams[1], &streams[2], block, warnings)?);
        } else if let Some(stream) = INTRINSIC.captures(lines[start]) {
            found.cameras.push(camera(&stream[1], block, warnings)?);
        }
    }
    Ok(found)
}
