//! The state of a run, and what it remembers of its iterations.

use super::finder::{Finder, HalvedPair};
use crate::pose::ImageGrid;
use crate::reason::Reason;
use crate::report::Stage;

/// The state of the run, which decides what the next step does.
pub enum Run {
    /// Prepares the image's grid for the search, with the coarse views if a view is large; then the search of the depth
    /// view in it. Each takes one slice.
    Preparing(Option<Box<(ImageGrid, Option<Box<HalvedPair>>)>>),
    /// A slice of the finder: before the first iteration, or in place of its registration.
    Searching(Box<Finder>),
    /// A stage of an iteration.
    Iterating(Stage),
    /// The run is over; the status says how it ended.
    Ended,
}

/// How the registrations of earlier iterations ended.
pub struct History {
    /// Share of the registration's step that is taken; halves with each rejection.
    pub step_fraction: f64,
    /// Change of rotation that the last registration proposed, degrees, before it was shortened.
    pub proposed_degrees: f64,
    /// Whether it found a better pose than its start.
    pub improved: bool,
    /// Successive iterations that were rejected or did not improve the pose.
    pub rejections: u32,
    /// Successive iterations whose registration proposed less than `stop_degrees`.
    pub unmoved: u32,
    /// The reason found at the beginning of the search, if the depth map is hollow.
    pub hollow: Option<Reason>,
}

impl Default for History {
    fn default() -> Self {
        Self { step_fraction: 1.0, proposed_degrees: 0.0, improved: true, rejections: 0, unmoved: 0, hollow: None }
    }
}
