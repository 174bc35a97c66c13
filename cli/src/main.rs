//! The pose between a colour image and a depth map from their files, for a shell and for scripts.
//!
//! `arguments` defines the arguments, `views` turns what the crate `files` reads into the library's input, `estimate`
//! runs the loop with a progress bar, `report` and `write` print and save the result, and `check` hands over to the
//! command of that name. Nothing here computes.

mod arguments;
mod cameras;
mod check;
mod code;
mod estimate;
mod progress;
mod report;
mod views;

use std::ffi::OsString;
use std::io::{self, ErrorKind, Write};
use std::path::Path;
use std::process::ExitCode;

use arguments::{Arguments, Input};
use bimodal_stereo::Options;
use bimodal_stereo_files::pairs::{self, Files};
use bimodal_stereo_files::{Problem, Result, write};
use cameras::Cameras;
use clap::Parser;
use code::Code;
use estimate::estimate;
use progress::Progress;

/// A first word that names another command; an image or a folder of that name can be given as "./check".
const CHECK: &str = "check";
/// A first word that names the default command.
const ESTIMATE: &str = "estimate";

fn main() -> ExitCode {
    let mut words: Vec<OsString> = std::env::args_os().collect();
    match words.get(1).and_then(|word| word.to_str()) {
        Some(CHECK) => return check::run(words.into_iter().skip(2)).into(),
        Some(ESTIMATE) => drop(words.remove(1)),
        _ => {}
    }
    let code = match Arguments::try_parse_from(words) {
        Ok(arguments) => run(arguments).unwrap_or_else(|problem| {
            eprintln!("{problem}");
            Code::BadInput
        }),
        // Help and version are not errors, and clap's own code for errors would mean "undecided".
        Err(said) => {
            let code = if said.use_stderr() { Code::BadInput } else { Code::Converged };
            match said.print() {
                Err(error) if error.kind() != ErrorKind::BrokenPipe => Code::BadInput,
                _ => code,
            }
        }
    };
    code.into()
}

/// The arguments, once they are read.
struct Task {
    arguments: Arguments,
    options: Options,
    cameras: Cameras,
}

fn run(arguments: Arguments) -> Result<Code> {
    let is_json = arguments.json;
    let options = arguments.options().map_err(|problem| printed(problem, None, is_json))?;
    let cameras = Cameras::named(&arguments.cameras).map_err(|problem| printed(problem, None, is_json))?;
    let task = Task { arguments, options, cameras };
    match task.arguments.input().map_err(|problem| printed(problem, None, is_json))? {
        Input::Pair(files) => task.one(&files),
        Input::Folder(folder) => task.many(&folder),
    }
}

/// Reports a problem that ends the program, also on the standard output if that is JSON.
fn printed(problem: Problem, files: Option<&Files>, is_json: bool) -> Problem {
    let text = || report::json_of_problem(None, files, &problem, report::Layout::Lines);
    let said = if is_json { print(&text()) } else { Ok(()) };
    said.err().unwrap_or(problem)
}

impl Task {
    /// Runs one pair, and prints everything known about it.
    fn one(&self, files: &Files) -> Result<Code> {
        let arguments = &self.arguments;
        let outcome = self.finish(files, arguments.out.as_deref(), &Progress::new(None, arguments.max_iterations));
        match (outcome, arguments.json) {
            (Ok(found), true) => print(&report::json(&found, report::Layout::Lines)).map(|()| found.code()),
            (Ok(found), false) => {
                found.warnings.iter().for_each(|warning| eprintln!("warning: {warning}"));
                print(&report::words(&found)).map(|()| found.code())
            }
            (Err(problem), is_json) => Err(printed(problem, Some(files), is_json)),
        }
    }

    /// Runs a folder, with one line for each pair. A pair that cannot be read does not stop the others.
    fn many(&self, folder: &Path) -> Result<Code> {
        let arguments = &self.arguments;
        let found =
            pairs::pairs(folder, arguments.out.as_deref()).map_err(|problem| printed(problem, None, arguments.json))?;
        found.warnings.0.iter().for_each(|warning| eprintln!("warning: {warning}"));
        let mut worst = Code::Converged;
        for (index, pair) in found.pairs.iter().enumerate() {
            let progress = Progress::new(Some((index, found.pairs.len(), &pair.name)), arguments.max_iterations);
            let out = arguments.out.as_ref().map(|out| out.join(pair.folder_name()));
            let outcome = self.finish(&pair.files, out.as_deref(), &progress);
            let (line, code) = match &outcome {
                Ok(found) if arguments.json => (report::json_line(&pair.name, found), found.code()),
                Ok(found) => (report::line(&pair.name, found), found.code()),
                Err(problem) if arguments.json => (
                    report::json_of_problem(Some(&pair.name), Some(&pair.files), problem, report::Layout::OneLine),
                    Code::BadInput,
                ),
                Err(problem) => (format!("{}: {problem}\n", pair.name), Code::BadInput),
            };
            print(&line)?;
            if let (Ok(found), false) = (&outcome, arguments.json) {
                found.notes.iter().for_each(|note| eprintln!("note: {note}"));
                found.warnings.iter().for_each(|warning| eprintln!("warning: {}: {warning}", pair.name));
            }
            worst = worst.max(code);
        }
        Ok(worst)
    }

    /// Runs one pair and writes its files.
    fn finish(&self, files: &Files, out: Option<&Path>, progress: &Progress) -> Result<estimate::Outcome> {
        let outcome = estimate(files, self, progress);
        progress.end();
        let mut outcome = outcome?;
        if let Some(out) = out {
            let report = ("report.json", report::json(&outcome, report::Layout::Lines).into(), "as --json".into());
            outcome.written = write::results(out, &outcome.estimator, vec![report])?;
        }
        Ok(outcome)
    }
}

/// Prints to the standard output. A reader that closes the pipe early (`head`) is not an error.
fn print(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Problem::file(Path::new("standard output"), error)),
        _ => Ok(()),
    }
}
