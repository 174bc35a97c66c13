//! Evidence for the verdict: the state of the loop after an iteration.

use crate::options::{Registration, Shading};
use crate::reason::Reason;

/// The state of the loop at the end of an iteration.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// Iterations so far, and their cap.
    pub iteration: u32,
    pub max_iterations: u32,
    /// The largest sigma of the rotation at which a run converges, degrees.
    pub tolerance: f64,
    /// The registration that ran, and how the shape is found.
    pub registration: Registration,
    pub shading: Shading,
    /// Number of correspondences, and their share of the valid depth pixels.
    pub correspondences: usize,
    pub overlap: f64,
    /// Objective before the iteration (`None` before the first) and after it.
    pub objective_before: Option<f64>,
    pub objective: f64,
    /// Whether the iteration was rejected.
    pub is_rejected: bool,
    /// Iterations in a row that were rejected or found no better pose.
    pub rejections: u32,
    /// Number of successive iterations in which the registration's whole step was less than the caller's `stopDegrees`.
    pub unmoved: u32,
    /// Whether the registration's whole step was taken, and to a better pose.
    pub is_whole_step: bool,
    /// Standard deviation of log S over the object.
    pub log_spread: f64,
    /// Whether local contrast chose the pose, so that shading need not explain the colours.
    pub by_contrast: bool,
    /// Reasons of the input checks to distrust an answer: a hollow depth map, a missing mask.
    pub hollow: Option<Reason>,
    pub missing_mask: Option<Reason>,
    /// Number of rivals, and the degrees to the nearest.
    pub rivals: u32,
    pub nearest_rival: f64,
}
