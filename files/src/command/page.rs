//! The report as one self-contained HTML file that can be kept, mailed and printed. It has no script, its policy allows
//! none, and everything from files is escaped. The sections are those of js/rig/write/report, without the charts.

use bimodal_stereo::{Angles, CandidateReport, CheckVerdict, Health};

use super::checked::Checked;
use super::text::word;
use crate::text::numbers::{brief, fixed, shown};

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:70rem;margin:2rem auto;padding:0 1rem;color:#1d2329;background:#fff}\
h1{font-size:1.5rem}h2{font-size:1.15rem;margin-top:2rem}table{border-collapse:collapse;width:100%}th,td{text-align:left;vertical-align:top;\
padding:.3rem .8rem .3rem 0;border-bottom:1px solid #d5dade}pre{overflow-x:auto;background:#f3f5f6;padding:.8rem}code{overflow-wrap:anywhere}\
.card{border-left:.5rem solid #8a6d00;padding:.5rem 1rem;background:#fbf6e3}.consistent{border-color:#0a6b3d;background:#eaf6ef}\
.off{border-color:#b3261e;background:#fbecea}.verdict{font-size:1.3rem;font-weight:600;margin:0}.soft{color:#59636c}";
/// The page makes no request; it has only an inline style.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; base-uri 'none'; form-action 'none'";
const DIGITS: usize = 3;

fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            other => out.push(other),
        }
    }
    out
}

fn measure(value: f64, unit: &str) -> String {
    if value.is_finite() { format!("{}{unit}", brief(value, DIGITS)) } else { "not known".into() }
}

fn span(health: &Health) -> String {
    let [low, high] = health.interval;
    format!("{} to {}", measure(low, ""), measure(high, " px"))
}

fn percent(share: f64) -> String {
    format!("{} %", fixed(100.0 * share, 0))
}

/// Text cells; the first one names the row.
fn table(head: &[&str], rows: impl Iterator<Item = Vec<String>>) -> String {
    let head: String = head.iter().map(|name| format!("<th scope=\"col\">{name}</th>")).collect();
    let row = |cells: Vec<String>| {
        let cell = |(at, cell): (usize, &String)| match at {
            0 => format!("<th scope=\"row\">{}</th>", escaped(cell)),
            _ => format!("<td>{}</td>", escaped(cell)),
        };
        format!("<tr>{}</tr>\n", cells.iter().enumerate().map(cell).collect::<String>())
    };
    format!("<table><thead><tr>{head}</tr></thead><tbody>\n{}</tbody></table>", rows.map(row).collect::<String>())
}

fn section(title: &str, body: &str) -> String {
    format!("<section><h2>{title}</h2>\n{body}</section>\n")
}

const fn title_of(verdict: CheckVerdict) -> &'static str {
    match verdict {
        CheckVerdict::Consistent => "Consistent",
        CheckVerdict::Off => "Off",
        CheckVerdict::Undecided => "Undecided",
    }
}

fn card(checked: &Checked) -> String {
    let name = checked.report.candidates.first().map_or("", |one| &one.name);
    format!(
        "<section class=\"card {}\"><p class=\"verdict\">{} <span class=\"soft\">{}</span></p><p>{}</p>\n\
         <p>Expected reprojection error of the best fit: {} (95 %: {}); it puts {} of the depth points onto the image.</p>{}</section>\n",
        word(checked.verdict),
        title_of(checked.verdict),
        escaped(name),
        escaped(&checked.sentence()),
        measure(checked.report.health.pixels, " px"),
        span(&checked.report.health),
        percent(checked.report.overlap),
        checked.report.next.as_ref().map(|next| format!("<p>{}</p>", escaped(&next.to_string()))).unwrap_or_default()
    )
}

fn warnings(checked: &Checked) -> String {
    if checked.warnings.is_empty() {
        return section("Warnings", "<p>None: nothing was guessed, and nothing looks wrong.</p>");
    }
    let items: String =
        checked.warnings.iter().map(|warning| format!("<li>{}</li>\n", escaped(&warning.message))).collect();
    section("Warnings", &format!("<ul>\n{items}</ul>"))
}

fn candidates(checked: &Checked) -> String {
    let row = |one: &CandidateReport| {
        let (verdict, reason) = checked.result(one);
        vec![
            one.name.clone(),
            title_of(verdict).into(),
            measure(one.off_degrees, "\u{b0}"),
            measure(one.off_millimetres, " mm"),
            measure(one.health.pixels, " px"),
            span(&one.health),
            measure(one.probability, ""),
            reason,
        ]
    };
    let head =
        ["Calibration", "Verdict", "Rotation", "Shift", "Expected error", "95 % interval", "Probability", "Reason"];
    section("Calibrations compared", &table(&head, checked.report.candidates.iter().map(row)))
}

fn shares(checked: &Checked) -> String {
    let report = &checked.report;
    let sharp =
        |sharpness: f64| if sharpness > 0.0 { measure(1.0 / sharpness, " px") } else { "no information".into() };
    let cues = report.cues.iter().map(|one| vec![one.cue.name().to_owned(), percent(one.share), sharp(one.sharpness)]);
    let frames = report
        .frames
        .iter()
        .map(|one| vec![one.name.clone(), percent(one.share), one.note.clone().unwrap_or_default()]);
    section("What the verdict rests on", &table(&["Cue", "Share", "Precision"], cues))
        + &section("Frames", &table(&["Frame", "Share", "Note"], frames))
}

fn estimate(checked: &Checked) -> String {
    let report = &checked.report;
    let (r, t) = (&report.estimate.rotation, &report.estimate.translation);
    let rows: Vec<String> = (0..3).map(|i| [r[(i, 0)], r[(i, 1)], r[(i, 2)], t[i]].map(shown).join("  ")).collect();
    let Angles { alpha, beta, gamma } = Angles::of(r);
    let sigma = |k: usize| report.covariance[(k, k)].sqrt() * if k < 3 { 1_f64.to_degrees() } else { 1000.0 };
    let axes = |from: usize, unit: &str, about: &str| -> String {
        let one = |(k, axis)| format!("{} {about} {axis}", measure(sigma(from + k), unit));
        ["x", "y", "z"].into_iter().enumerate().map(one).collect::<Vec<_>>().join(", ")
    };
    let body = format!(
        "<pre>{}\n0  0  0  1</pre>\n<p class=\"soft\">P_colour = R P_depth + t, metres; x right, y down, z forward.</p>\n\
         <p>Angles of R = Rx Ry Rz: {}, {}, {}. One sigma: {}; {}.</p>",
        rows.join("\n"),
        measure(alpha, "\u{b0}"),
        measure(beta, "\u{b0}"),
        measure(gamma, "\u{b0}"),
        axes(0, "\u{b0}", "about"),
        axes(3, " mm", "along")
    );
    section("The best fit", &body)
}

fn inputs(checked: &Checked) -> String {
    let row = |one: &super::Input| vec![one.name.clone(), one.says.clone(), one.sha256.clone()];
    section("Files", &table(&["File", "Read as", "SHA-256"], checked.inputs.iter().map(row)))
}

pub fn page(checked: &Checked, title: &str) -> String {
    let title = escaped(title);
    let parts = [card, warnings, candidates, shares, estimate, inputs].map(|part| part(checked));
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n<style>{STYLE}</style>\n</head>\n\
         <body>\n<header><h1>{title}</h1></header>\n<main>\n{}</main>\n\
         <footer class=\"soft\">Made by bimodal-stereo. This file is self-contained.</footer>\n</body>\n</html>\n",
        parts.concat()
    )
}

#[cfg(test)]
mod tests {
    use super::escaped;

    #[test]
    fn names_of_files_are_no_markup() {
        assert_eq!(escaped("<b a=\"'&\">"), "&lt;b a=&quot;&#39;&amp;&quot;&gt;");
    }
}
