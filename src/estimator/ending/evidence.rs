//! Evidence for the verdict: the state of the loop after an iteration, and what each registration reports about its
//! answer.

use crate::options::{Registration, Shading};
use crate::pose::{ContrastReport, Direction, PhotometricReport, SilhouetteReport};
use crate::reason::Reason;

use crate::estimator::finder::Staying;

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
    pub answer: Answer,
    /// Reasons of the input checks to distrust an answer: a hollow depth map, a missing mask.
    pub hollow: Option<Reason>,
    pub missing_mask: Option<Reason>,
    /// Number of rivals, and the degrees to the nearest.
    pub rivals: u32,
    pub nearest_rival: f64,
}

/// The method that found the answer, and what it reports about it.
#[derive(Clone, Copy, Debug)]
pub enum Answer {
    Photometric(PhotometricEvidence),
    Contrast(ContrastEvidence),
    Silhouettes(SilhouetteEvidence),
    /// The initial pose was kept.
    Initial(Staying),
    /// The surfaces were matched, or the pose is fixed.
    Surfaces,
}

/// What photometric registration reports about its answer.
#[derive(Clone, Copy, Debug)]
pub struct PhotometricEvidence {
    /// Sigma of the rotation about the least certain axis, degrees, and the weakest direction.
    pub sigma: f64,
    pub weakest: Direction,
    /// Share of the log image's spread that is left unexplained.
    pub unexplained: f64,
    /// Share of the points within the robust scale.
    pub inliers: f64,
}

/// What silhouettes report about their answer.
#[derive(Clone, Copy, Debug)]
pub struct SilhouetteEvidence {
    /// Sigma of the rotation about the least certain axis, degrees, and that axis.
    pub sigma: f64,
    pub weakest: Direction,
    /// Whether that rotation is practically unobserved.
    pub is_unseen: bool,
}

/// What local contrast reports about its answer.
#[derive(Clone, Copy, Debug)]
pub struct ContrastEvidence {
    /// Sigma of the rotation about the least certain axis, degrees, and the weakest direction.
    pub sigma: f64,
    pub weakest: Direction,
    /// Objective of local contrast and silhouette: 0 if both fit perfectly, about 1 if shading explains nothing.
    pub objective: f64,
}

impl ContrastEvidence {
    /// Evidence from a registration by local contrast.
    pub fn of(found: &ContrastReport) -> Self {
        Self {
            sigma: found.uncertainty.largest_rotation(),
            weakest: found.uncertainty.weakest,
            objective: found.objective,
        }
    }
}

impl PhotometricEvidence {
    /// Evidence from a photometric registration, given the spread of the log image.
    pub fn of(found: &PhotometricReport, log_spread: f64) -> Self {
        Self {
            sigma: found.uncertainty.largest_rotation(),
            weakest: found.uncertainty.weakest,
            unexplained: found.noise / log_spread,
            inliers: found.inliers,
        }
    }
}

impl SilhouetteEvidence {
    /// Evidence from a registration by silhouettes.
    pub fn of(found: &SilhouetteReport) -> Self {
        Self {
            sigma: found.uncertainty.largest_rotation(),
            weakest: found.uncertainty.weakest,
            is_unseen: found.unseen,
        }
    }
}
