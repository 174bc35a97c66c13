//! Files that hold only numbers: K.txt, matrices of motions, and trajectories in the TUM and Redwood formats.

use super::calibration::{Calibration, Names, Reason};
use super::cameras::{RawCamera, camera_of};
use super::numbers::{number_in, shown, words_of_numbers};
use super::poses::{motion_of_matrix, of_quaternion, turned};
use crate::warning::Warnings;

const MOST_NUMBERS: usize = 200_000;
/// Largest number of warnings of a trajectory, whose poses mostly share them.
const MOST_WARNINGS: usize = 4;

fn near(value: Option<&f64>, to: f64) -> bool {
    value.is_some_and(|value| (value - to).abs() < 1e-9)
}

/// Rows of numbers, without comments and brackets; `None` if there is anything else.
fn rows_of(text: &str) -> Result<Option<Vec<Vec<f64>>>, Reason> {
    let mut rows = Vec::new();
    let mut count = 0;
    for line in text.lines() {
        let end = ["#", "//", "%"].iter().filter_map(|sign| line.find(sign)).min().unwrap_or(line.len());
        let number = |part: &str| {
            let is_none =
                matches!(part.trim_start_matches(['+', '-']).to_lowercase().as_str(), "nan" | "inf" | "infinity");
            if is_none { Some(f64::NAN) } else { number_in(part) }
        };
        let Some(row) = words_of_numbers(&line[..end]).map(number).collect::<Option<Vec<f64>>>() else {
            return Ok(None);
        };
        if row.is_empty() {
            continue;
        }
        count += row.len();
        if count > MOST_NUMBERS {
            return Err(format!("it has more than {MOST_NUMBERS} numbers, too many for cameras and transforms"));
        }
        rows.push(row);
    }
    Ok((!rows.is_empty()).then_some(rows))
}

fn found(format: &str, warnings: Warnings) -> Calibration {
    Calibration { warnings, format: format.into(), ..Calibration::default() }
}

fn camera(k: &[f64; 9], size: Option<[f64; 2]>, lens: &[f64]) -> Result<Calibration, Reason> {
    let raw = RawCamera {
        focal: [k[0], k[4]],
        centre: [k[2], k[5]],
        skew: k[1],
        distortion: lens.to_vec(),
        width: size.map(|size| size[0]),
        height: size.map(|size| size[1]),
        ..RawCamera::default()
    };
    let mut warnings = Warnings::default();
    let camera = camera_of(raw, &mut warnings)?;
    Ok(Calibration { cameras: vec![camera], ..found("a matrix of intrinsics", warnings) })
}

/// Nine numbers: a matrix of intrinsics, or a rotation without its translation.
fn nine(values: &[f64; 9], size: Option<[f64; 2]>) -> Result<Calibration, Reason> {
    let is = |zeros: [usize; 3]| zeros.iter().all(|&at| near(values.get(at), 0.0)) && near(values.get(8), 1.0);
    if is([3, 6, 7]) {
        return camera(values, size, &[]);
    }
    if is([1, 2, 5]) {
        return Err("its matrix of intrinsics is transposed; it must be fx 0 cx / 0 fy cy / 0 0 1".into());
    }
    Err("its nine numbers are not a matrix of intrinsics (fx 0 cx / 0 fy cy / 0 0 1), and a rotation needs its translation".into())
}

/// TUM: time stamp, translation and quaternion x y z w of the camera in the world.
fn trajectory(rows: &[Vec<f64>]) -> Result<Calibration, Reason> {
    let mut warnings = Warnings::default();
    let pose = |row: &Vec<f64>| {
        let numbers = &row[row.len() - 7..];
        let is_rig = row.len() == 7;
        let names = if is_rig { Names::default() } else { Names::between(Some(shown(row[0])), "camera", "world") };
        let rotation = of_quaternion([numbers[3], numbers[4], numbers[5], numbers[6]], &mut warnings)?;
        turned(&rotation, &numbers[..3], names, &mut warnings, is_rig)
    };
    let poses = rows.iter().map(pose).collect::<Result<Vec<_>, _>>()?;
    warnings.0.truncate(MOST_WARNINGS);
    let format = if rows.len() == 1 { "a translation and a quaternion" } else { "a trajectory" };
    Ok(Calibration { poses, ..found(format, warnings) })
}

/// Redwood: three whole numbers, then the 4x4 matrix of the camera in the world.
fn log(rows: &[Vec<f64>]) -> Result<Calibration, Reason> {
    let mut warnings = Warnings::default();
    let pose = |rows: &[Vec<f64>]| {
        let names = Names::between(Some(shown(rows[0][0])), "camera", "world");
        motion_of_matrix(&rows[1..].concat(), names, &mut warnings, false)
    };
    let poses = rows.chunks_exact(5).map(pose).collect::<Result<Vec<_>, _>>()?;
    warnings.0.truncate(MOST_WARNINGS);
    Ok(Calibration { poses, ..found("a trajectory", warnings) })
}

/// Content of a text of numbers; `None` if it has words.
pub fn read(text: &str) -> Result<Option<Calibration>, Reason> {
    let Some(rows) = rows_of(text)? else { return Ok(None) };
    of_rows(&rows).map(Some)
}

fn of_rows(rows: &[Vec<f64>]) -> Result<Calibration, Reason> {
    let values = rows.concat();
    if values.iter().any(|value| value.is_nan()) {
        return Err("it has nan or inf where numbers are needed".into());
    }
    let is_log = |(index, row): (usize, &Vec<f64>)| row.len() == if index % 5 == 0 { 3 } else { 4 };
    if rows.len().is_multiple_of(5) && rows.iter().enumerate().all(is_log) {
        return log(rows);
    }
    if rows.iter().all(|row| row.len() == 8) || rows.iter().all(|row| row.len() == 7) {
        return trajectory(rows);
    }
    let size = (rows[0].len() == 2 && values.len() == 11).then(|| [values[0], values[1]]);
    let is_line = rows.len() == 1 && !near(values.get(8), 1.0);
    let rest = &values[if size.is_some() { 2 } else { 0 }..];
    if let (Ok(matrix), false) = (rest.try_into(), is_line) {
        return nine(matrix, size);
    }
    if values.len() == 12 || values.len() == 16 {
        let mut warnings = Warnings::default();
        let pose = motion_of_matrix(&values, Names::default(), &mut warnings, true)?;
        return Ok(Calibration { poses: vec![pose], ..found("a matrix of a transform", warnings) });
    }
    if let (&[fx, fy, cx, cy, ref lens @ ..], 1) = (&values[..], rows.len())
        && matches!(values.len(), 4 | 9 | 12)
        && fx > 10.0
        && fy > 10.0
    {
        return camera(&[fx, 0.0, cx, 0.0, fy, cy, 0.0, 0.0, 1.0], None, lens);
    }
    Err(format!(
        "it has {} numbers in {} rows; it needs 3x3 numbers of intrinsics, 3x4 or 4x4 of a transform, or the rows of a trajectory",
        values.len(),
        rows.len()
    ))
}
