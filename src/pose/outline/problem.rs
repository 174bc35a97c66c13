//! What goes into a registration by outlines, and what comes out.

use nalgebra::Vector3;

use crate::pose::prior::PosePrior;
use crate::pose::similarity::Similarity;
use crate::pose::uncertainty::Uncertainty;
use crate::view::{ColourView, DepthView, Normals};

/// Two views whose outlines shall agree.
#[derive(Clone, Copy)]
pub struct OutlineProblem<'a> {
    pub image: &'a ColourView,
    pub depth: &'a DepthView,
    /// Normals of the depth view's points.
    pub normals: &'a Normals,
    /// What is told.
    pub prior: PosePrior,
}

/// What outlines say.
#[derive(Clone, Debug)]
pub struct OutlineReport {
    pub pose: Similarity,
    /// Robust standard deviation of the rims about the mask's outline, pixels.
    pub noise: f64,
    pub uncertainty: Uncertainty,
    /// Whether its weakest rotation is as good as unseen: what was told of it is kept.
    pub unseen: bool,
    /// The objective at the finest scale.
    pub cost: f64,
    /// Number of rims.
    pub rims: usize,
}

impl OutlineProblem<'_> {
    pub(super) fn point(&self, index: usize) -> Vector3<f64> {
        Vector3::from(self.depth.points.get(index).map(f64::from))
    }
}
