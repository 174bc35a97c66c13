//! A raster as a depth map: its unit (given, in the file or guessed from the values), its valid pixels, and whether it
//! looks like the output of a depth camera. The rules are those of js/rig/depth.ts.

use bimodal_stereo::DepthSamples;

use crate::read::{Raster, Samples};
use crate::text::numbers::{fixed, precise};
use crate::unit::{FARTHEST, NEAREST, Sample, Unit, turned_back};
use crate::warning::Warnings;

/// Smallest share of holes that causes a warning.
const MANY_HOLES: f64 = 0.4;
/// Renderers write 1e10 where nothing was seen.
const BEYOND: f32 = 1e9;
/// Smallest value that means that nothing was seen.
const LARGEST: f64 = 1e12;

/// A depth map as read.
#[derive(Clone, Debug)]
pub struct Depth {
    pub samples: DepthSamples,
    /// Metres for each stored number.
    pub unit: f64,
    /// A description of what was read.
    pub says: String,
    pub warnings: Warnings,
}

const NOTHING: &str = "it has no valid depth: all values are zero, negative or not a number";

/// The raster as a depth map or, with three channels of floats, as an organised cloud.
pub fn depth_of(raster: Raster, given: Option<f64>) -> Result<Depth, String> {
    if raster.is_lossy {
        return Err(
            "a JPEG cannot store depths: it has 8 bits and does not keep them exactly; use a 16-bit PNG or .npy".into(),
        );
    }
    if let Samples::F32(_) = raster.samples {
        return of_floats(raster, given);
    }
    if !raster.is_grey() {
        return Err("it is a colour picture where a depth map was expected: were the files swapped, or is it a rendering of the depth?".into());
    }
    of_integers(&raster, given)
}

fn warnings_of(raster: &Raster) -> Warnings {
    let mut warnings = Warnings::default();
    warnings.extend(raster.warnings.iter().cloned());
    warnings
}

fn of_integers(raster: &Raster, given: Option<f64>) -> Result<Depth, String> {
    let mut warnings = warnings_of(raster);
    let mut notes = raster.notes.clone();
    let mut data = raster.map_pixels(|pixel| pixel[0]);
    if data.contains(&u16::MAX) {
        // 16-bit sensors store this number where they see nothing.
        data.iter_mut().filter(|value| **value == u16::MAX).for_each(|value| *value = 0);
        notes.push("65535 treated as holes".into());
    }
    let sample = |data: &[u16]| Sample::of(data.iter().map(|&value| f64::from(value)));
    let mut values = sample(&data);
    if values.is_empty() {
        return Err(NOTHING.into());
    }
    let unit = match given {
        Some(metres) => Unit::given(metres),
        None if raster.bits > 8 && values.is_turned() => {
            data = turned_back(&data);
            values = sample(&data);
            Unit::TURNED
        }
        None => values.unit_of_integers(),
    };
    if raster.bits <= 8 {
        warnings.add(
            "eight-bits",
            "Depths of 8 bits are too coarse for a calibration, and often a picture of the depth rather than the depth itself.",
        );
    }
    if values.looks_like_disparity() {
        warnings.add(
            "raw-disparity",
            "The largest value is 2047 and occurs often: this looks like a Kinect's raw disparity, not depth (z is about 351.3 / (1092.5 - d) m).",
        );
    }
    let seen = || data.iter().map(|&value| f64::from(value));
    let says = judged(raster, &format!("{}-bit", raster.bits), seen(), &values, &unit, &notes, &mut warnings);
    Ok(Depth { samples: DepthSamples::Integer(data), unit: unit.metres, says, warnings })
}

fn of_floats(mut raster: Raster, given: Option<f64>) -> Result<Depth, String> {
    let mut warnings = warnings_of(&raster);
    let Samples::F32(data) = &mut raster.samples else { return Err(NOTHING.into()) };
    let mut data = std::mem::take(data);
    let step = match raster.channels {
        1 => 1,
        3 => 3,
        count => return Err(format!("a depth map has 1 channel and a cloud 3, not {count}")),
    };
    if step == 1 {
        data.iter_mut().filter(|value| **value >= BEYOND).for_each(|value| *value = 0.0);
    }
    let depths: Vec<f64> = data.iter().skip(step / 3 * 2).step_by(step).map(|&value| f64::from(value)).collect();
    let values = Sample::of(depths.iter().copied());
    let behind = depths.iter().filter(|&&depth| depth < 0.0).count();
    let ahead = depths.iter().filter(|&&depth| is_there(depth)).count();
    if step == 3 && behind > ahead {
        return Err(
            "its points lie behind the camera (z is negative): rotate them so that z points forward and y down".into(),
        );
    }
    if values.is_empty() {
        return Err(NOTHING.into());
    }
    let unit = given.map_or_else(|| values.unit_of_floats(), Unit::given);
    let stored = if step == 3 { "an organised cloud".into() } else { format!("{}-bit float", raster.bits) };
    let notes = raster.notes.clone();
    let says = judged(&raster, &stored, depths.iter().copied(), &values, &unit, &notes, &mut warnings);
    if step == 1 {
        return Ok(Depth { samples: DepthSamples::Float(data), unit: unit.metres, says, warnings });
    }
    for point in data.chunks_exact_mut(3) {
        let is_point = is_there(point[2].into()) && point[0].is_finite() && point[1].is_finite();
        point
            .iter_mut()
            .for_each(|value| *value = if is_point { (f64::from(*value) * unit.metres) as f32 } else { f32::NAN });
    }
    Ok(Depth { samples: DepthSamples::Cloud(data), unit: 1.0, says, warnings })
}

fn is_there(value: f64) -> bool {
    value > 0.0 && value < LARGEST
}

fn metres_text(value: f64) -> String {
    if value < 0.01 { precise(value, 3) } else { fixed(value, if value < 1000.0 { 2 } else { 0 }) }
}

/// Describes any depth map, and adds the warnings about it.
fn judged(
    raster: &Raster,
    stored: &str,
    values: impl Iterator<Item = f64>,
    sample: &Sample,
    unit: &Unit,
    notes: &[String],
    warnings: &mut Warnings,
) -> String {
    let (mut count, mut nearest, mut farthest) = (0_usize, f64::INFINITY, 0.0_f64);
    for value in values.filter(|&value| is_there(value)) {
        (count, nearest, farthest) = (count + 1, nearest.min(value), farthest.max(value));
    }
    let percent = |share: f64| format!("{} %", fixed(100.0 * share, 1));
    let valid = count as f64 / (raster.width * raster.height) as f64;
    let range = format!("{} to {} m", metres_text(nearest * unit.metres), metres_text(farthest * unit.metres));
    if unit.is_guessed {
        warnings.add(
            "unit-guessed",
            format!(
                "The file does not state its unit. It was guessed to be {}, so depths are {range}; give the unit if that is wrong.",
                unit.name()
            ),
        );
    }
    if let Some(beyond) = sample.beyond(unit.metres) {
        warnings.add(
            "depth-range",
            format!(
                "{} of the depths are outside {NEAREST} to {FARTHEST} m ({range}): is the unit right?",
                percent(beyond)
            ),
        );
    }
    if 1.0 - valid > MANY_HOLES {
        warnings.add("many-holes", format!("{} % of the depth map is missing.", fixed(100.0 * (1.0 - valid), 0)));
    }
    let says = format!(
        "{}x{}, {stored}, read as {}, {} valid, {range}",
        raster.width,
        raster.height,
        unit.says(),
        percent(valid)
    );
    [says].into_iter().chain(notes.iter().cloned()).collect::<Vec<_>>().join(", ")
}
