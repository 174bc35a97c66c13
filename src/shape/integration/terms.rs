//! The data of a surface's equations: edges, which prescribe differences between neighbours, and anchors, which
//! prescribe heights.

use crate::numeric::{Lanes, Mask, Real};

/// Edge e from a pixel to its right or lower neighbour, stored at the pixel.
pub struct Edges {
    /// w_e >= 0; zero without an edge, as in the last column (row).
    pub weight: Vec<f32>,
    /// g_e.
    pub gradient: Vec<f32>,
}

impl Edges {
    pub fn new(length: usize) -> Self {
        Self { weight: vec![0.0; length], gradient: vec![0.0; length] }
    }
}

/// Weights of the anchors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AnchorWeight<'a> {
    /// One weight for all anchors.
    Uniform(f32),
    /// A weight for each pixel of the raster.
    PerPixel(&'a [f32]),
}

/// Heights towards which the surface is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchors<'a> {
    /// Target height of each pixel of the raster, NaN if it has none.
    pub height: &'a [f32],
    /// a_i relative to edges of weight one; an anchor whose weight is not finite or not above zero is ignored.
    pub weight: AnchorWeight<'a>,
}

impl Anchors<'_> {
    /// Target and weight; zero weight without an anchor.
    pub(super) fn get(&self, index: usize) -> (f32, f32) {
        let weight = match self.weight {
            AnchorWeight::Uniform(weight) => weight,
            AnchorWeight::PerPixel(weights) => weights[index],
        };
        let height = self.height[index];
        if height.is_finite() && weight.is_finite() && weight > 0.0 { (height, weight) } else { (0.0, 0.0) }
    }

    /// Targets and weights of four pixels; zero for pixels that are not `wanted`.
    #[inline(always)]
    pub(crate) fn four(&self, start: isize, wanted: Mask) -> (Lanes, Lanes) {
        let zero = Lanes::splat(0.0);
        let weight = match self.weight {
            AnchorWeight::Uniform(weight) => Lanes::splat(weight),
            AnchorWeight::PerPixel(weights) => Lanes::load(weights, start),
        };
        let height = Lanes::load(self.height, start);
        let holds = wanted & height.finite() & weight.finite() & zero.less(weight);
        (holds.select(height, zero), holds.select(weight, zero))
    }
}
