//! Input and output of a search.

use crate::light::Light;
use crate::pose::similarity::Similarity;
use crate::view::{ColourView, DepthView, Normals};

/// Two views whose pose is sought, with the available prior knowledge.
#[derive(Clone, Copy)]
pub struct SearchProblem<'a> {
    /// The colour view.
    pub image: &'a ColourView,
    /// The depth view.
    pub depth: &'a DepthView,
    /// Normals of the depth view's points.
    pub normals: &'a Normals,
    /// The light in the colour view's frame if it is known up to its exposure.
    pub light: Option<&'a Light>,
    /// s if it is held; `None` means a search over 0.7 .. 1.4 times `unit_scale`.
    pub scale: Option<f64>,
    /// Initial value of s.
    pub unit_scale: f64,
    /// Seed of the set of rotations.
    pub seed: u64,
}

/// A pose worth registering.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Transforms points of the depth view into the colour view.
    pub pose: Similarity,
    /// Gain of log likelihood over a constant colour, in cells; comparable only within one search.
    pub score: f64,
}

/// Progress of a search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Share of the work that is done; one when the candidates are ready.
    pub share: f64,
}
