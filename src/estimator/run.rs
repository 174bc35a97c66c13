//! Where a run stands, and what it remembers of its iterations.

use super::finder::{Finder, Opening};
use crate::pose::ImageGrid;
use crate::reason::Reason;
use crate::report::Stage;

/// Where the run stands: what the next step does.
pub enum Run {
    /// Prepares the image's grid for the search, with the coarse views where these are large, then the search of the
    /// depth view in it: a slice each.
    Preparing(Option<Box<(ImageGrid, Option<Box<Opening>>)>>),
    /// A slice of the finder: before the first iteration, or in place of its registration.
    Searching(Box<Finder>),
    /// A stage of an iteration.
    Iterating(Stage),
    /// Nothing: the status says how it ended.
    Ended,
}

/// What the loop remembers of the iterations before: how their registrations ended.
pub struct History {
    /// Share of the registration's step that is taken; halves with each rejection.
    pub step_fraction: f64,
    /// Change of rotation that the last registration proposed, degrees, before it was shortened.
    pub proposed_degrees: f64,
    /// Whether it found a pose better than its start.
    pub improved: bool,
    /// Iterations in a row that were taken back or did not improve the pose.
    pub rejections: u32,
    /// Iterations in a row whose registration proposed less than `stop_degrees`.
    pub unmoved: u32,
    /// Whether the depth map was found to be hollow when the search began.
    pub hollow: Option<Reason>,
}

impl Default for History {
    fn default() -> Self {
        Self { step_fraction: 1.0, proposed_degrees: 0.0, improved: true, rejections: 0, unmoved: 0, hollow: None }
    }
}
