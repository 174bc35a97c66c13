//! Cameras from files, checked, with distortion models by their many names.

use std::sync::LazyLock;

use bimodal_stereo::{Lens, Pinhole};
use regex_lite::Regex;

use super::calibration::{NamedCamera, Reason};
use super::numbers::{DIGITS, brief, fixed, shown};
use crate::read::MOST_SIDE;
use crate::warning::Warnings;

/// A camera as the file states it, before it is checked.
#[derive(Clone, Debug, Default)]
pub struct RawCamera {
    pub name: Option<String>,
    /// fx, fy.
    pub focal: [f64; 2],
    /// cx, cy.
    pub centre: [f64; 2],
    pub skew: f64,
    pub model: Option<String>,
    pub distortion: Vec<f64>,
    pub width: Option<f64>,
    pub height: Option<f64>,
}

fn pattern(text: &str) -> Regex {
    Regex::new(text).expect("is a constant")
}
/// The names by which files call the models.
static BROWN: LazyLock<Regex> = LazyLock::new(|| {
    pattern(
        "^(|none|pinhole|plumb[_ ]?bob|radtan|radial-tangential|brown|brown[_ ]?conrady|opencv|rational[_ ]?polynomial|full_opencv|perspective)$",
    )
});
static FISHEYE: LazyLock<Regex> =
    LazyLock::new(|| pattern("^(fisheye|equidistant|equi|kannala[_ ]?brandt4?|opencv_fisheye)$"));
/// Variants of Brown's model in librealsense, which projects both as Brown's model except for products of terms. Older
/// versions inverted the second one.
static REALSENSE: LazyLock<Regex> = LazyLock::new(|| pattern("^(modified|inverse)[_ ]?brown[_ ]?conrady$"));
/// Longest plausible focal length, pixels.
const LONGEST: f64 = 1e6;

/// The checked camera, or why it is invalid.
pub fn camera_of(raw: RawCamera, warnings: &mut Warnings) -> Result<NamedCamera, Reason> {
    let ([fx, fy], [cx, cy]) = (raw.focal, raw.centre);
    let called = raw.name.as_ref().map(|name| format!(" \"{name}\"")).unwrap_or_default();
    let is_focal = |value: f64| value > 0.0 && value < LONGEST;
    if !(is_focal(fx) && is_focal(fy)) {
        return Err(format!(
            "its camera{called} has the focal lengths {} and {}; both must be above zero, in pixels",
            shown(fx),
            shown(fy)
        ));
    }
    if !(cx.abs() < LONGEST && cy.abs() < LONGEST) {
        return Err(format!("its camera{called} has the principal point {}, {}", shown(cx), shown(cy)));
    }
    let size = size_of(&raw)?;
    doubts(&raw, size, &format!("The camera{called}"), warnings);
    let lens = lens_of(&raw, &format!("The camera{called}"), warnings)?;
    Ok(NamedCamera { name: raw.name, camera: Pinhole { fx, fy, cx, cy, lens }, size })
}

fn size_of(raw: &RawCamera) -> Result<Option<[usize; 2]>, Reason> {
    let is_side = |side: f64| side.fract() == 0.0 && side > 0.0 && side <= 4.0 * MOST_SIDE as f64;
    match (raw.width, raw.height) {
        (None, None) => Ok(None),
        (Some(0.0), Some(0.0)) => Ok(None),
        (Some(width), Some(height)) if is_side(width) && is_side(height) => Ok(Some([width as usize, height as usize])),
        (Some(width), Some(height)) => {
            Err(format!("its camera has the invalid image size {}x{}", shown(width), shown(height)))
        }
        (width, height) => {
            let (what, side) = (if width.is_none() { "height" } else { "width" }, width.or(height).unwrap_or(0.0));
            Err(format!("its camera states only the {what} of its images, {}; both are needed", shown(side)))
        }
    }
}

/// Warns about suspicious values of a usable camera.
fn doubts(raw: &RawCamera, size: Option<[usize; 2]>, label: &str, warnings: &mut Warnings) {
    let ([fx, fy], [cx, cy]) = (raw.focal, raw.centre);
    match size {
        Some([width, height]) if cx < 0.0 || cy < 0.0 || cx > width as f64 || cy > height as f64 => warnings.add(
            "principal-point",
            format!(
                "{label} has its principal point outside its image ({}, {} of {width}x{height}).",
                brief(cx, DIGITS),
                brief(cy, DIGITS)
            ),
        ),
        None if cx <= 0.0 || cy <= 0.0 => warnings.add(
            "principal-point",
            format!(
                "{label} has the principal point {}, {}, which is outside any image.",
                brief(cx, DIGITS),
                brief(cy, DIGITS)
            ),
        ),
        _ => {}
    }
    if fx < 2.0 || fy < 2.0 {
        warnings.add(
            "focal-length-normalised",
            format!(
                "{label} has a focal length of {}, which looks normalised by the image's size; pixels are needed.",
                brief(fx, DIGITS)
            ),
        );
    }
    if (fx / fy - 1.0).abs() > 0.1 {
        warnings.add(
            "pixels-not-square",
            format!("{label} has pixels that are not square (fx {}, fy {}).", fixed(fx, 1), fixed(fy, 1)),
        );
    }
    if raw.skew.abs() > 1e-6 * fx {
        warnings.add("skew-ignored", format!("{label} has skewed axes ({}); the skew is ignored.", shown(raw.skew)));
    }
}

fn lens_of(raw: &RawCamera, label: &str, warnings: &mut Warnings) -> Result<Lens, Reason> {
    let values = &raw.distortion;
    if !values.iter().all(|value| value.is_finite() && value.abs() < 1e6) {
        return Err("its distortion contains something other than numbers".into());
    }
    let written = raw.model.as_deref().unwrap_or("").trim();
    let model = written.to_lowercase();
    let is_bent = |values: &[f64]| values.iter().any(|&value| value != 0.0);
    if FISHEYE.is_match(&model) {
        if !values.is_empty() && values.len() != 4 && is_bent(values.get(4..).unwrap_or(&[])) {
            return Err(format!("its fisheye lens has {} coefficients; k1 k2 k3 k4 are needed", values.len()));
        }
        return Ok(Lens::Fisheye(std::array::from_fn(|index| values.get(index).copied().unwrap_or(0.0))));
    }
    if !is_bent(values) {
        return Ok(Lens::None);
    }
    if REALSENSE.is_match(&model) {
        warnings.add(
            "lens-approximated",
            format!(
                "{label} has RealSense's \"{written}\" lens, which is read as Brown's, as librealsense projects it; the two differ by products of coefficients."
            ),
        );
    } else if !BROWN.is_match(&model) {
        let short: String = raw.model.as_deref().unwrap_or("").chars().take(40).collect();
        return Err(format!("its lens model \"{short}\" is not supported; Brown's and Kannala-Brandt's are"));
    }
    // Further coefficients belong to thin prisms and a tilted sensor.
    if values.len() > 14 || is_bent(values.get(8..).unwrap_or(&[])) {
        return Err("its distortion has thin-prism or tilt terms, which are not supported".into());
    }
    Ok(Lens::Brown(std::array::from_fn(|index| values.get(index).copied().unwrap_or(0.0))))
}

/// Number of coefficients as files have it: four, five or eight for Brown's lens.
pub fn coefficients(lens: &Lens) -> Option<usize> {
    match lens {
        Lens::None => None,
        Lens::Fisheye(_) => Some(4),
        Lens::Brown(values) => {
            let used = values.iter().rposition(|&value| value != 0.0).map_or(0, |last| last + 1);
            Some(if used <= 4 {
                4
            } else if used <= 5 {
                5
            } else {
                8
            })
        }
    }
}
