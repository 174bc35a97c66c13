//! What goes into a search, and what comes out.

use crate::light::Light;
use crate::pose::similarity::Similarity;
use crate::view::{ColourView, DepthView, Normals};

/// Two views whose pose is to be found, and what is known of it.
#[derive(Clone, Copy)]
pub struct SearchProblem<'a> {
    /// The colour view.
    pub image: &'a ColourView,
    /// The depth view.
    pub depth: &'a DepthView,
    /// Normals of the depth view's points.
    pub normals: &'a Normals,
    /// The light in the colour view's frame, where it is known but for its exposure.
    pub light: Option<&'a Light>,
    /// s where it is held; `None` searches 0.7 .. 1.4 times `unit_scale`.
    pub scale: Option<f64>,
    /// The first guess of s.
    pub unit_scale: f64,
    /// Draws the set of rotations that are tried.
    pub seed: u64,
}

/// A pose worth refining.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Candidate {
    /// Transforms points of the depth view into the colour view.
    pub pose: Similarity,
    /// Gain of log likelihood over a constant colour, in cells; comparable within one search only.
    pub score: f64,
}

/// How far a search has come.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Progress {
    /// Share of the work that is done: one when the candidates are ready.
    pub share: f64,
}
