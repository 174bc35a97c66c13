//! The report for a terminal.

use bimodal_stereo::{CheckVerdict, Health};

use super::checked::Checked;
use crate::problem::plain;
use crate::text::numbers::{brief, fixed, shown};

/// Digits of printed numbers.
const DIGITS: usize = 3;

pub const fn word(verdict: CheckVerdict) -> &'static str {
    match verdict {
        CheckVerdict::Consistent => "consistent",
        CheckVerdict::Off => "off",
        CheckVerdict::Undecided => "undecided",
    }
}

fn short(value: f64) -> String {
    if value.is_finite() { brief(value, DIGITS) } else { "?".into() }
}

fn percent(share: f64) -> String {
    format!("{} %", fixed(100.0 * share, 0))
}

fn pixels(health: &Health) -> String {
    let [low, high] = health.interval;
    format!("{} ({} to {})", short(health.pixels), short(low), short(high))
}

/// Columns as wide as their widest cell.
fn table(rows: &[[String; 6]]) -> Vec<String> {
    let width = |text: &str| text.encode_utf16().count();
    let widths: [usize; 6] =
        std::array::from_fn(|column| rows.iter().map(|row| width(&row[column])).max().unwrap_or(0));
    let line = |row: &[String; 6]| {
        let cells: Vec<String> =
            row.iter().zip(widths).map(|(cell, most)| format!("{cell}{}", " ".repeat(most - width(cell)))).collect();
        cells.join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

/// The verdict with its reason.
pub fn headline(checked: &Checked) -> String {
    format!("{}: {}", word(checked.verdict).to_uppercase(), checked.sentence())
}

pub fn text(checked: &Checked) -> String {
    let report = &checked.report;
    let head = ["calibration", "verdict", "rotation", "shift", "error, pixels (95 %)", "probability"];
    let mut rows = vec![head.map(String::from)];
    rows.extend(report.candidates.iter().map(|one| {
        [
            plain(&one.name),
            word(checked.result(one).0).into(),
            format!("{} deg", short(one.off_degrees)),
            format!("{} mm", short(one.off_millimetres)),
            pixels(&one.health),
            short(one.probability),
        ]
    }));
    let none = String::new;
    rows.push(["best fit".into(), none(), none(), none(), pixels(&report.health), none()]);
    let mut lines = vec![headline(checked), none()];
    lines.extend(table(&rows));
    lines.extend([none(), "best fit, P_colour = R P_depth + t, metres:".into()]);
    let (r, t) = (&report.estimate.rotation, &report.estimate.translation);
    lines.extend((0..3).map(|i| {
        let row = [r[(i, 0)], r[(i, 1)], r[(i, 2)], t[i]].map(shown);
        format!("  {}", row.join(" "))
    }));
    lines.extend(["  0 0 0 1".into(), none()]);
    let cues: Vec<String> =
        report.cues.iter().map(|one| format!("{} {}", one.cue.name(), percent(one.share))).collect();
    lines.push(format!("depth points on the image: {}", percent(report.overlap)));
    lines.push(format!("cues: {}", cues.join(", ")));
    let frame = |one: &bimodal_stereo::FrameReport| {
        let note = one.note.as_ref().map(|note| format!(" ({})", plain(note))).unwrap_or_default();
        format!("{} {}{note}", plain(&one.name), percent(one.share))
    };
    lines.push(format!("frames: {}", report.frames.iter().map(frame).collect::<Vec<_>>().join(", ")));
    lines.extend(report.next.iter().map(|next| format!("next frame: {next}")));
    lines.extend(checked.warnings.iter().map(|warning| format!("warning: {}", plain(&warning.message))));
    lines.push(none());
    lines.join("\n")
}
