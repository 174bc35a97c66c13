//! What the verdict is taken from: the state of the loop at the end of an iteration, and what each registration reports of its answer.

use crate::options::{Registration, Shading};
use crate::pose::{ContrastReport, Direction, OutlineReport, PhotometricReport};
use crate::reason::Reason;

use super::finder::Staying;

/// What is known at the end of an iteration.
#[derive(Clone, Debug)]
pub struct Evidence {
    /// Iterations so far, and their cap.
    pub iteration: u32,
    pub max_iterations: u32,
    /// The largest sigma of the rotation at which a run converges, degrees.
    pub tolerance: f64,
    /// The registration that ran, and the way the shape is found.
    pub registration: Registration,
    pub shading: Shading,
    /// Number of correspondences, and their share of the valid depth pixels.
    pub correspondences: usize,
    pub overlap: f64,
    /// Objective before the iteration, none before the first, and after it.
    pub objective_before: Option<f64>,
    pub objective: f64,
    /// Whether the iteration was taken back.
    pub is_rejected: bool,
    /// Iterations in a row that were taken back or found no better pose.
    pub rejections: u32,
    /// Whether the registration's whole step was less than the caller's `stopDegrees`, and for how many iterations in a
    /// row.
    pub unmoved: u32,
    /// Whether the registration's whole step was taken, and to a better pose.
    pub is_whole_step: bool,
    /// What the registration by colours says of its answer, where the answer is its own.
    pub colours: Option<ColourEvidence>,
    /// What outlines say of their answer, where the colours are painted and the answer is theirs.
    pub outlines: Option<OutlineEvidence>,
    /// What local contrast says, likewise.
    pub contrast: Option<ContrastEvidence>,
    /// Whether the initial pose may be used, where it was kept.
    pub staying: Option<Staying>,
    /// What checks of the input have against an answer: a hollow depth map, a mask that is missing.
    pub hollow: Option<Reason>,
    pub missing_mask: Option<Reason>,
    /// Number of rivals, and the degrees to the nearest.
    pub rivals: u32,
    pub nearest_rival: f64,
}

/// What the registration by colours says of its answer.
#[derive(Clone, Copy, Debug)]
pub struct ColourEvidence {
    /// Sigma of the rotation about the least certain axis, degrees, and the weakest direction.
    pub sigma: f64,
    pub weakest: Direction,
    /// Share of the colours' spread that is left unexplained.
    pub unexplained: f64,
    /// Share of the points within the robust scale.
    pub inliers: f64,
}

/// What outlines say of their answer.
#[derive(Clone, Copy, Debug)]
pub struct OutlineEvidence {
    /// Sigma of the rotation about the least certain axis, degrees, and that axis.
    pub sigma: f64,
    pub weakest: Direction,
    /// Whether that rotation is as good as unseen.
    pub is_unseen: bool,
}

/// What local contrast says of its answer.
#[derive(Clone, Copy, Debug)]
pub struct ContrastEvidence {
    /// Sigma of the rotation about the least certain axis, degrees, and the weakest direction.
    pub sigma: f64,
    pub weakest: Direction,
    /// What contrast and outline leave unexplained: zero where nothing, one where shading explains none of the contrast.
    pub unexplained: f64,
}

impl ContrastEvidence {
    /// Of a registration by local contrast.
    pub fn of(found: &ContrastReport) -> Self {
        Self {
            sigma: found.uncertainty.largest_rotation(),
            weakest: found.uncertainty.weakest,
            unexplained: found.objective,
        }
    }
}

impl ColourEvidence {
    /// Of a registration, given the spread of the colours.
    pub fn of(found: &PhotometricReport, log_spread: f64) -> Self {
        Self {
            sigma: found.uncertainty.largest_rotation(),
            weakest: found.uncertainty.weakest,
            unexplained: found.noise / log_spread,
            inliers: found.inliers,
        }
    }
}

impl OutlineEvidence {
    /// Of a registration by outlines.
    pub fn of(found: &OutlineReport) -> Self {
        Self {
            sigma: found.uncertainty.largest_rotation(),
            weakest: found.uncertainty.weakest,
            is_unseen: found.unseen,
        }
    }
}
