//! The command `check`: the calibration of a rig over a folder of frames, for a shell and for continuous integration.
//!
//! `arguments` defines the arguments, `candidates` reads the calibrations to be checked, `checked` is the result, and
//! `text`, `json` and `page` write it. The help text equals that of the JavaScript package, line by line.

mod arguments;
mod candidates;
mod checked;
mod frames;
mod json;
mod page;
mod progress;
mod text;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use bimodal_stereo::{CalibrationCheck, CheckReport, CheckVerdict, RigView};
use clap::Parser;
use serde_json::json;
use sha2::{Digest, Sha256};

use crate::problem::{Problem, Result, own_name};
use crate::rig::{FolderOptions, RigFolder, read_calibration, read_rig_folder};
use crate::warning::Warnings;
use arguments::Arguments;
use candidates::{Candidates, candidates};
use checked::{Checked, Input, Said};
use progress::Progress;

pub use arguments::HELP;

/// Exit codes in addition to those of the verdicts.
const BAD: u8 = 3;
const INTERRUPTED: u8 = 130;

/// Output streams of the command, and its interruption.
pub struct Terminal<'a> {
    pub out: &'a mut dyn Write,
    pub err: &'a mut dyn Write,
    /// Whether `err` is a terminal that a person watches.
    pub is_terminal: bool,
    /// Called between two slices of the work.
    pub is_interrupted: &'a mut dyn FnMut() -> bool,
}

/// Why there is no verdict.
enum End {
    Problem(Problem),
    Interrupted,
}

impl From<Problem> for End {
    fn from(problem: Problem) -> Self {
        Self::Problem(problem)
    }
}

/// Runs the command with the arguments after `check`; returns the exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>, terminal: &mut Terminal<'_>) -> u8 {
    let name = OsString::from("check");
    let parsed = Arguments::try_parse_from([name].into_iter().chain(arguments));
    let mut is_json = false;
    let ended = match parsed {
        Ok(arguments) => {
            is_json = arguments.json.as_deref() == Some(Path::new("-"));
            arguments.checked().map_err(End::from).and_then(|()| check(&arguments, terminal))
        }
        Err(said) if said.use_stderr() => {
            let _ = write!(terminal.err, "{said}");
            return BAD;
        }
        Err(said) => print(terminal.out, &said.to_string()).map(|()| 0).map_err(End::from),
    };
    match ended {
        Ok(code) => code,
        Err(End::Interrupted) => {
            let _ = writeln!(terminal.err, "interrupted");
            INTERRUPTED
        }
        Err(End::Problem(problem)) => {
            let _ = writeln!(terminal.err, "{problem}");
            if is_json {
                let Problem { code, field, .. } = &problem;
                let error = json!({ "error": { "code": code, "field": field, "message": problem.to_string() } });
                let _ = writeln!(terminal.out, "{error:#}");
            }
            BAD
        }
    }
}

fn check(arguments: &Arguments, terminal: &mut Terminal<'_>) -> std::result::Result<u8, End> {
    let mut warnings = Warnings::default();
    let Candidates { poses, readings, cameras } = candidates(arguments, &mut warnings)?;
    for path in &arguments.cameras {
        if read_calibration(path)?.cameras.is_empty() {
            return Err(Problem::file(path, "it contains no intrinsics").into());
        }
    }
    let options = FolderOptions {
        unit: arguments.unit,
        frames: arguments.frames,
        cameras: arguments.cameras.iter().cloned().chain(cameras).collect(),
        except: arguments.calibration.clone(),
    };
    let RigFolder { mut frames, readings: read, warnings: doubts, .. } = read_rig_folder(&arguments.folder, &options)?;
    if frames.is_empty() {
        let first = doubts.first().map(|warning| format!(": {warning}")).unwrap_or_default();
        let folder = &arguments.folder;
        let reason = format!("it contains no readable pair of a colour image and a depth map{first}");
        return Err(Problem::file(folder, reason).into());
    }
    name_by_number(&mut frames);
    let run = CalibrationCheck::new(frames, poses, &arguments.cues).map_err(|error| Problem::of_check(&error))?;
    let report = finished(run, terminal)?;
    let mut all = Warnings::default();
    all.extend(warnings.0);
    all.extend(doubts);
    let own = report.warnings.iter().map(|one| Said { message: one.to_string(), is_doubt: true, json: json!(one) });
    let others =
        all.0.iter().map(|one| Said { message: one.message.clone(), is_doubt: one.is_doubt(), json: json!(one) });
    let warnings = own.chain(others).collect();
    let files = readings.iter().chain(&read).map(|each| (each.name.clone(), (each.says.clone(), each.path.clone())));
    let checked = Checked::capped(report, warnings, inputs(files)?);
    write(&checked, arguments, terminal)?;
    Ok(match checked.verdict {
        CheckVerdict::Consistent => 0,
        CheckVerdict::Off => 1,
        CheckVerdict::Undecided => 2,
    })
}

/// Renames frames whose names are numbers alone, because "0: 48 % .." is hard to read. The number of the file stays in parentheses.
fn name_by_number(frames: &mut [RigView]) {
    for (index, frame) in frames.iter_mut().enumerate() {
        if !frame.name.is_empty() && frame.name.bytes().all(|byte| byte.is_ascii_digit()) {
            frame.name = format!("frame {} ({})", index + 1, frame.name);
        }
    }
}

/// Runs the check to its end with a progress bar.
fn finished(mut check: CalibrationCheck, terminal: &mut Terminal<'_>) -> std::result::Result<CheckReport, End> {
    let mut progress = Progress::new(terminal.is_terminal);
    loop {
        let is_done = check.step();
        let (share, words) = check.progress();
        progress.show(share, words, terminal.err);
        if (terminal.is_interrupted)() {
            progress.end(terminal.err);
            return Err(End::Interrupted);
        }
        if is_done {
            break;
        }
    }
    progress.end(terminal.err);
    let report = check.report().cloned();
    report.ok_or_else(|| Problem::option("check", "ended without a report").into())
}

/// Each file once, in the order in which it was first read.
fn inputs(files: impl Iterator<Item = (String, (String, PathBuf))>) -> Result<Vec<Input>> {
    let (mut order, mut last) = (Vec::new(), BTreeMap::new());
    for (name, read) in files {
        if last.insert(name.clone(), read).is_none() {
            order.push(name);
        }
    }
    let input = |name: String| {
        let (says, path) = &last[&name];
        let bytes = fs::read(path).map_err(|error| Problem::file(path, error))?;
        let sha256 = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect();
        Ok(Input { says: says.clone(), sha256, name })
    };
    order.into_iter().map(input).collect()
}

fn write(checked: &Checked, arguments: &Arguments, terminal: &mut Terminal<'_>) -> Result<()> {
    let is_json = arguments.json.as_deref() == Some(Path::new("-"));
    // The verdict is printed first, so that it is not lost if an output file cannot be written.
    let words = text::text(checked);
    if is_json { print(terminal.err, &words) } else { print(terminal.out, &words) }?;
    if let Some(path) = arguments.json.as_ref().filter(|_| !is_json) {
        fs::write(path, json::json(checked)).map_err(|error| Problem::file(path, error))?;
    }
    if let Some(path) = &arguments.report {
        let page = page::page(checked, &format!("Check of {}", own_name(&arguments.calibration[0])));
        fs::write(path, page).map_err(|error| Problem::file(path, error))?;
    }
    if is_json {
        print(terminal.out, &json::json(checked))?;
    }
    Ok(())
}

/// A reader that closes the pipe early (`head`) is not an error.
fn print(to: &mut dyn Write, text: &str) -> Result<()> {
    match to.write_all(text.as_bytes()).and_then(|()| to.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            Err(Problem::file(Path::new("standard output"), io::Error::from(error.kind())))
        }
        _ => Ok(()),
    }
}
