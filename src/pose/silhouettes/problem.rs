//! Input and output of a registration from silhouettes.

use nalgebra::Vector3;

use crate::pose::prior::PosePrior;
use crate::pose::similarity::Similarity;
use crate::pose::uncertainty::Uncertainty;
use crate::view::{ColourView, DepthView, Normals};

/// Two views whose silhouettes have to agree.
#[derive(Clone, Copy)]
pub struct SilhouetteProblem<'a> {
    pub image: &'a ColourView,
    pub depth: &'a DepthView,
    /// Normals of the depth view's points.
    pub normals: &'a Normals,
    /// Prior about the initial pose.
    pub prior: PosePrior,
}

/// Result of a registration from silhouettes.
#[derive(Clone, Debug)]
pub struct SilhouetteReport {
    pub pose: Similarity,
    /// Robust standard deviation of the depth discontinuities about silhouette and edges, pixels.
    pub noise: f64,
    pub uncertainty: Uncertainty,
    /// Whether the weakest rotation keeps its initial value because the silhouettes do not constrain it.
    pub unseen: bool,
    /// The objective at the finest scale.
    pub cost: f64,
    /// Number of depth discontinuities.
    pub discontinuities: usize,
    /// Number of their independent errors.
    pub independent: f64,
}

impl SilhouetteProblem<'_> {
    pub(super) fn point(&self, index: usize) -> Vector3<f64> {
        Vector3::from(self.depth.points.get(index).map(f64::from))
    }
}
