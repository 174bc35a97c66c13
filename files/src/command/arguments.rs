//! The arguments of the command, equal to those of the JavaScript package.

use std::path::PathBuf;

use bimodal_stereo::Cue;
use clap::Parser;

use crate::problem::{Problem, Result};

/// All languages have the same text.
pub const HELP: &str = include_str!("help.txt");
const MOST_WORKERS: usize = 16;

/// Whether the extrinsics of a rig agree with its frames.
#[derive(Debug, Parser)]
#[command(name = "check", bin_name = "bimodal-stereo check", version, override_help = HELP)]
pub struct Arguments {
    pub folder: PathBuf,
    #[arg(long, value_name = "FILE", required = true)]
    pub calibration: Vec<PathBuf>,
    #[arg(long)]
    pub inverted: bool,
    #[arg(long, value_name = "FILE")]
    pub cameras: Vec<PathBuf>,
    #[arg(long, value_name = "METRES")]
    pub unit: Option<f64>,
    #[arg(long, value_name = "N")]
    pub frames: Option<usize>,
    #[arg(long, value_name = "LIST", value_delimiter = ',', value_parser = cue)]
    pub cues: Vec<Cue>,
    #[arg(long, value_name = "N")]
    pub workers: Option<usize>,
    #[arg(long, value_name = "OUT")]
    pub json: Option<PathBuf>,
    #[arg(long, value_name = "OUT.html")]
    pub report: Option<PathBuf>,
}

impl Arguments {
    /// Refuses numbers outside the range of their option.
    pub fn checked(&self) -> Result<()> {
        if self.unit.is_some_and(|unit| !(unit > 0.0 && unit.is_finite())) {
            return Err(Problem::option("--unit", "needs metres per stored number, above zero"));
        }
        if self.frames == Some(0) {
            return Err(Problem::option("--frames", "needs a whole number above zero"));
        }
        if self.workers.is_some_and(|count| !(1..=MOST_WORKERS).contains(&count)) {
            return Err(Problem::option("--workers", format!("needs a whole number from 1 to {MOST_WORKERS}")));
        }
        Ok(())
    }
}

fn cue(name: &str) -> std::result::Result<Cue, String> {
    let found = Cue::ALL.into_iter().find(|cue| cue.name() == name.trim());
    found.ok_or_else(|| format!("must be one of {}", Cue::ALL.map(Cue::name).join(", ")))
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    use super::*;

    #[test]
    fn the_help_lists_every_option_and_no_other() {
        let command = Arguments::command();
        let mut ours: Vec<String> = command.get_arguments().filter_map(|one| one.get_long()).map(Into::into).collect();
        ours.extend(["help".into(), "version".into()]);
        let listed = HELP.lines().filter_map(|line| line.strip_prefix("  --")?.split_whitespace().next());
        assert_eq!(listed.collect::<Vec<_>>(), ours);
    }
}
