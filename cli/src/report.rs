//! The result: in words with units, as one line, and as JSON with the names of the JavaScript contract's `StepReport`.

use std::fmt::Write;

use bimodal_stereo::{Angles, CODES, Light, Reason, Similarity, StepReport, Uncertainty};
use bimodal_stereo_files::pairs::Files;
use bimodal_stereo_files::{Problem, Warning, plain, shown};
use serde::Serialize;

use crate::estimate::Outcome;

/// Significant digits of lengths, sigmas and shares.
const DIGITS: i32 = 4;

/// Powers of ten beyond which a number gets an exponent, because hundreds of zeros are unreadable.
const PLAIN: std::ops::RangeInclusive<i32> = -9..=14;

/// A number with this many significant digits, without an exponent if it is readable without.
fn digits(value: f64, digits: i32) -> String {
    if value == 0.0 || !value.is_finite() {
        return value.to_string();
    }
    let power = value.abs().log10().floor() as i32;
    if !PLAIN.contains(&power) {
        return format!("{value:.*e}", digits as usize - 1);
    }
    let decimals = (digits - 1 - power).clamp(0, 12);
    format!("{value:.*}", decimals as usize)
}

fn list(values: impl IntoIterator<Item = String>) -> String {
    values.into_iter().collect::<Vec<_>>().join(", ")
}

/// Appends a line to a text, which cannot fail.
macro_rules! line {
    ($text:expr, $($words:tt)*) => {
        let _ = writeln!($text, $($words)*);
    };
}

/// The whole result in words.
pub fn words(found: &Outcome) -> String {
    let report = found.estimator.report();
    let length = found.image_length.word();
    let mut text = String::new();
    line!(text, "{} after {}", report.status.name(), iterations(report));
    if let Some(reason) = &report.reason {
        line!(text, "{}", plain(&reason.to_string()));
        remedy(reason).into_iter().for_each(|remedy| {
            line!(text, "{remedy}");
        });
    }
    line!(text, "\npose: P_colour = s R P_depth + t, R = Rx(alpha) Ry(beta) Rz(gamma); x right, y down, z forward");
    pose_words(&mut text, &report.pose, length);
    if let Some(sigma) = &report.uncertainty {
        sigma_words(&mut text, sigma, length);
    }
    line!(
        text,
        "\noverlap {:.0} % of the depth points, of which {:.0} % are inliers; residual {} in log colour",
        100.0 * report.overlap,
        100.0 * report.inliers,
        digits(report.residual, 3)
    );
    for rival in &report.rivals {
        let Angles { alpha, beta, gamma } = Angles::of(&rival.rotation);
        let off = rival.degrees_to(&report.pose);
        line!(
            text,
            "another pose fits the image equally well: {alpha:.2}, {beta:.2}, {gamma:.2} degrees, {off:.1} degrees away"
        );
    }
    found.notes.iter().for_each(|note| {
        line!(text, "{note}");
    });
    found.written.iter().for_each(|file| {
        line!(text, "wrote {file}");
    });
    text
}

/// A remedy from the table of codes, if there is one.
fn remedy(reason: &Reason) -> Option<String> {
    let table: serde_json::Value = serde_json::from_str(CODES).ok()?;
    Some(table["runs"][reason.code()]["remedy"].as_str()?.to_owned())
}

fn iterations(report: &StepReport) -> String {
    format!("{} iteration{}", report.iteration, if report.iteration == 1 { "" } else { "s" })
}

fn pose_words(text: &mut String, pose: &Similarity, length: &str) {
    let Angles { alpha, beta, gamma } = Angles::of(&pose.rotation);
    line!(text, "  s      {}", digits(pose.scale, 6));
    for (name, angle) in [("alpha", alpha), ("beta ", beta), ("gamma", gamma)] {
        line!(text, "  {name}  {angle:.4} degrees");
    }
    line!(text, "  t      {} {length}", list(pose.translation.iter().map(|&value| digits(value, 5))));
}

fn sigma_words(text: &mut String, sigma: &Uncertainty, length: &str) {
    let seen = |value: Option<f64>| {
        value.map_or_else(|| "not seen".into(), |value| format!("{} {length}", digits(value, DIGITS)))
    };
    line!(text, "\none sigma, in the colour view's frame");
    line!(
        text,
        "  rotation about x, y, z     {} degrees",
        list(sigma.rotation_degrees.map(|value| digits(value, DIGITS)))
    );
    line!(text, "  translation along x, y, z  {}", list(sigma.translation.map(seen)));
    line!(text, "  s                          {}", sigma.scale.map_or("held".into(), |scale| digits(scale, DIGITS)));
    line!(text, "  weakest: {}", sigma.weakest);
}

/// One line for a pair of a folder.
pub fn line(name: &str, found: &Outcome) -> String {
    let report = found.estimator.report();
    let Similarity { scale, rotation, translation } = &report.pose;
    let Angles { alpha, beta, gamma } = Angles::of(rotation);
    let sigma = report.uncertainty.as_ref().map_or_else(String::new, |sigma| {
        let largest = sigma.rotation_degrees.into_iter().fold(0.0, f64::max);
        format!(", sigma up to {} degrees", digits(largest, 2))
    });
    format!(
        "{}: {}, alpha {alpha:.3}, beta {beta:.3}, gamma {gamma:.3} degrees, s {}, t {} {}{sigma}\n",
        plain(name),
        report.status.name(),
        digits(*scale, 5),
        list(translation.iter().map(|&value| digits(value, DIGITS))),
        found.image_length.word(),
    )
}

/// Layout of JSON: indented, or in one line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    Lines,
    OneLine,
}

/// The report as the crate serialises it, with the additions of the command line.
#[derive(Serialize)]
#[serde(rename_all = "camelCase")]
struct Report<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    image: String,
    depth: String,
    #[serde(flatten)]
    report: &'a StepReport,
    /// Unit of lengths: "px" or "m".
    unit: &'static str,
    depth_unit: &'static str,
    /// R1..9, G1..9, B1..9.
    light: Light,
    exposure: f64,
    notes: &'a [String],
    warnings: &'a [Warning],
    written: &'a [String],
}

#[derive(Serialize)]
struct Failed<'a> {
    #[serde(skip_serializing_if = "Option::is_none")]
    name: Option<&'a str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    image: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    depth: Option<String>,
    error: Fault<'a>,
}

#[derive(Serialize)]
struct Fault<'a> {
    code: &'a str,
    field: &'a str,
    message: String,
}

impl<'a> Report<'a> {
    fn of(name: Option<&'a str>, found: &'a Outcome) -> Self {
        Self {
            name,
            image: found.files.image.display().to_string(),
            depth: found.files.depth.display().to_string(),
            report: found.estimator.report(),
            unit: found.image_length.symbol(),
            depth_unit: found.depth_length.symbol(),
            light: found.estimator.light(),
            exposure: found.estimator.exposure(),
            notes: &found.notes,
            warnings: &found.warnings,
            written: &found.written,
        }
    }
}

/// Numbers that are not finite become null.
fn text(value: &impl Serialize, layout: Layout) -> String {
    let made = match layout {
        Layout::Lines => serde_json::to_string_pretty(value),
        Layout::OneLine => serde_json::to_string(value),
    };
    // Serialising cannot fail, because the value holds only strings and numbers, and its keys are names.
    made.expect("can be written") + "\n"
}

/// The report of a pair.
pub fn json(found: &Outcome, layout: Layout) -> String {
    text(&Report::of(None, found), layout)
}

/// The report of a pair in a folder, in one line.
pub fn json_line(name: &str, found: &Outcome) -> String {
    text(&Report::of(Some(name), found), Layout::OneLine)
}

/// The error that is written instead of a report. Without files it is an error of all pairs.
pub fn json_of_problem(name: Option<&str>, files: Option<&Files>, problem: &Problem, layout: Layout) -> String {
    let [image, depth] = [files.map(|files| shown(&files.image)), files.map(|files| shown(&files.depth))];
    let error = Fault { code: problem.code, field: &problem.field, message: problem.to_string() };
    text(&Failed { name, image, depth, error }, layout)
}

#[cfg(test)]
mod tests {
    use super::digits;

    #[test]
    fn digits_are_those_that_count() {
        let texts = [(0.012_345, "0.01235"), (-12.345, "-12.35"), (123_456.0, "123456"), (0.0, "0"), (9.99, "9.990")];
        let far = [(1e300, "1.000e300"), (-1.5e-20, "-1.500e-20"), (1e14, "100000000000000"), (f64::INFINITY, "inf")];
        for (value, text) in texts.into_iter().chain(far) {
            assert_eq!(digits(value, 4), text);
        }
    }
}
