//! A bar on a terminal: the search in percent, then the iterations. Nothing is shown if the standard error is not a
//! terminal.

use std::time::Duration;

use bimodal_stereo::{Reason, Stage, StepReport};
use bimodal_stereo_files::plain;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

/// Length of the bar, and the share of the search, which takes most of the time.
const LENGTH: u64 = 1000;
const SEARCH: f64 = 0.7;
/// Interval at which the bar's clock advances during a long step.
const TICK: Duration = Duration::from_millis(100);
const STYLE: &str = "{prefix}[{bar:24}] {percent:>3} %  {elapsed}  {wide_msg}";

pub struct Progress {
    bar: ProgressBar,
    most_iterations: u32,
}

impl Progress {
    /// Creates the bar. For a pair of a folder, `pair` holds the pair's index, the number of pairs, and the pair's
    /// name.
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
        // The estimated progress can decrease, but a bar should not.
        self.bar.set_position(self.bar.position().max((share * LENGTH as f64) as u64));
        self.bar.set_message(words);
    }

    /// Erases the bar.
    pub fn end(&self) {
        self.bar.finish_and_clear();
    }
}

/// Progress of the run, 0 to 1, and its current activity. The search reports its percentage. Of the iterations,
/// only the largest number is known, and most runs need far fewer.
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
