//! A bar on a terminal: the search in percent, then the iterations. Nothing where the standard error is no terminal.

use std::time::Duration;

use bimodal_stereo::{Reason, Stage, StepReport};
use bimodal_stereo_files::plain;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// The bar: in thousandths, of which the search takes most.
const LENGTH: u64 = 1000;
const SEARCH: f64 = 0.7;
/// The clock of the bar goes on while a long step is under way, seconds / 10.
const TICK: Duration = Duration::from_millis(100);
const STYLE: &str = "{prefix}[{bar:24}] {percent:>3} %  {elapsed}  {wide_msg}";

pub struct Progress {
    bar: ProgressBar,
    most_iterations: u32,
}

impl Progress {
    /// Of a folder, the pair by number, of how many, and name.
    pub fn new(pair: Option<(usize, usize, &str)>, most_iterations: u32) -> Self {
        let bar = ProgressBar::with_draw_target(Some(LENGTH), ProgressDrawTarget::stderr());
        if let Ok(style) = ProgressStyle::with_template(STYLE) {
            bar.set_style(style.progress_chars("##-"));
        }
        if let Some((index, count, name)) = pair {
            bar.set_prefix(format!("{}/{count} {} ", index + 1, plain(name)));
        }
        bar.enable_steady_tick(TICK);
        Self { bar, most_iterations }
    }

    pub fn show(&self, report: &StepReport) {
        let (share, words) = share(report, self.most_iterations);
        // What is known can move back, a bar should not.
        self.bar.set_position(self.bar.position().max((share * LENGTH as f64) as u64));
        self.bar.set_message(words);
    }

    /// Wipes the bar away.
    pub fn end(&self) {
        self.bar.finish_and_clear();
    }
}

/// How far the run is, 0 to 1, and what it is at. The search reports its percent; of the iterations only their largest number is known, of
/// which most runs need few.
fn share(report: &StepReport, most_iterations: u32) -> (f64, String) {
    if report.stage == Stage::Search {
        return match report.reason {
            Some(Reason::Searching { percent, activity }) => (SEARCH * percent / 100.0, format!("search: {activity}")),
            _ => (SEARCH, "search".into()),
        };
    }
    let iterations = f64::from(report.iteration) / f64::from(most_iterations.max(1));
    let words = format!("iteration {}, turned by {:.3} degrees", report.iteration, report.rotation_change);
    (SEARCH + (1.0 - SEARCH) * iterations.sqrt().min(1.0), words)
}
