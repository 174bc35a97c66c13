//! A moving bar on a terminal, and a line for each tenth elsewhere.

use std::io::Write;

const WIDTH: usize = 24;
/// Characters of the current activity that fit a terminal.
const ROOM: usize = 44;

pub struct Progress {
    is_terminal: bool,
    tenth: Option<u32>,
}

impl Progress {
    pub const fn new(is_terminal: bool) -> Self {
        Self { is_terminal, tenth: None }
    }

    /// A failure to print is not an error of the check.
    pub fn show(&mut self, share: f64, words: &str, to: &mut dyn Write) {
        let share = share.clamp(0.0, 1.0);
        let percent = (100.0 * share).floor();
        if self.is_terminal {
            let full = (share * WIDTH as f64).round() as usize;
            let words: String = words.chars().take(ROOM).collect();
            let _ = write!(to, "\r[{}{}] {percent:>3} %  {words}\x1b[K", "#".repeat(full), "-".repeat(WIDTH - full));
            let _ = to.flush();
            return;
        }
        let tenth = (10.0 * share).floor() as u32;
        if self.tenth.is_none_or(|last| tenth > last) {
            self.tenth = Some(tenth);
            let _ = writeln!(to, "{percent:>3} %  {words}");
        }
    }

    /// Erases the bar.
    pub fn end(&self, to: &mut dyn Write) {
        if self.is_terminal {
            let _ = write!(to, "\r\x1b[K");
        }
    }
}
