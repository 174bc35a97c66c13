//! The command `check` on a terminal, which an interrupt can end.

use std::ffi::OsString;
use std::io::{self, IsTerminal};
use std::sync::atomic::{AtomicBool, Ordering};

use bimodal_stereo_files::command::{self, Terminal};

static INTERRUPTED: AtomicBool = AtomicBool::new(false);

/// Runs the command; returns the exit code.
pub fn run(arguments: impl Iterator<Item = OsString>) -> u8 {
    // Without a handler, an interrupt ends the program as usual.
    let _ = ctrlc::set_handler(|| INTERRUPTED.store(true, Ordering::Relaxed));
    command::run(
        arguments,
        &mut Terminal {
            out: &mut io::stdout(),
            err: &mut io::stderr(),
            is_terminal: io::stderr().is_terminal(),
            is_interrupted: &mut || INTERRUPTED.load(Ordering::Relaxed),
        },
    )
}
