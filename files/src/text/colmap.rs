//! COLMAP's cameras.txt: a line for each camera, "ID MODEL WIDTH HEIGHT PARAMS[]".

use super::calibration::{Calibration, Reason};
use super::cameras::{RawCamera, camera_of};
use super::names::{Pattern, pattern};
use super::numbers::number_in;

static LINE: Pattern =
    Pattern::new(|| pattern(r"^\s*([0-9]+)\s+([A-Z][A-Z_]+)\s+([0-9]+)\s+([0-9]+)((?:\s+\S+)*)\s*$"));
/// COLMAP measures principal points from the corner of the first pixel, and this crate from its centre.
const CORNER: f64 = 0.5;
/// Bytes within which the first camera must appear.
const HEAD: usize = 4096;

/// Number of focal lengths, number of coefficients after the principal point, and whether the lens is a fisheye.
fn model(name: &str) -> Option<(usize, usize, bool)> {
    Some(match name {
        "SIMPLE_PINHOLE" => (1, 0, false),
        "PINHOLE" => (2, 0, false),
        "SIMPLE_RADIAL" => (1, 1, false),
        "RADIAL" => (1, 2, false),
        "OPENCV" => (2, 4, false),
        "FULL_OPENCV" => (2, 8, false),
        "OPENCV_FISHEYE" => (2, 4, true),
        "SIMPLE_RADIAL_FISHEYE" => (1, 1, true),
        "RADIAL_FISHEYE" => (1, 2, true),
        _ => return None,
    })
}

fn lines_of(text: &str) -> impl Iterator<Item = &str> {
    text.lines().filter(|line| !line.trim().is_empty() && !line.trim_start().starts_with('#'))
}

pub fn is_colmap(text: &str) -> bool {
    lines_of(text).next().is_some_and(|line| line.len() <= HEAD && LINE.is_match(line))
}

fn camera(line: &str) -> Result<RawCamera, Reason> {
    let short = || line.chars().take(60).collect::<String>();
    let parts = (line.len() <= HEAD).then(|| LINE.captures(line)).flatten();
    let parts = parts.ok_or_else(|| format!("it has a line that is not a camera: {}", short()))?;
    let (id, name) = (&parts[1], &parts[2]);
    let (focals, lens, is_fisheye) =
        model(name).ok_or_else(|| format!("its camera {id} has the model {name}, which is not supported"))?;
    let values: Vec<Option<f64>> = parts[5].split_whitespace().map(number_in).collect();
    let needed = focals + 2 + lens;
    let numbers = values.iter().copied().collect::<Option<Vec<f64>>>().filter(|numbers| numbers.len() == needed);
    let numbers =
        numbers.ok_or_else(|| format!("its camera {id} ({name}) needs {needed} numbers, but has {}", values.len()))?;
    Ok(RawCamera {
        name: Some(id.into()),
        focal: [numbers[0], numbers[focals - 1]],
        centre: [numbers[focals] - CORNER, numbers[focals + 1] - CORNER],
        distortion: numbers[focals + 2..].to_vec(),
        model: Some(if is_fisheye { "fisheye" } else { "opencv" }.into()),
        width: number_in(&parts[3]),
        height: number_in(&parts[4]),
        skew: 0.0,
    })
}

pub fn read(text: &str) -> Result<Calibration, Reason> {
    let mut found = Calibration { format: "COLMAP's cameras".into(), ..Calibration::default() };
    for line in lines_of(text) {
        found.cameras.push(camera_of(camera(line)?, &mut found.warnings)?);
    }
    Ok(found)
}
