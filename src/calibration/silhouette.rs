//! Silhouette: the masked object lies on the image's mask, if both views have a mask.
//!
//! The log likelihood is minus half the sum over points of u^2 / (1 + u^2 / U^2), where u is the distance of a point
//! outside the mask beyond a tolerance. By itself this cue would shrink the object into its mask. The cue of edges
//! pulls the object's depth discontinuities to the mask's border from inside.

use super::evidence::Tiles;
use super::patches::{Patches, Sight};
use super::unknowns::State;
use crate::pose::{SLACK, Silhouette as MaskDistance};

/// U, pixels; a point farther outside is an error of one of the masks.
const OUTLIER: f64 = 6.0;

/// The cue of one frame.
pub(super) struct Silhouette<'a> {
    patches: &'a Patches,
    mask: MaskDistance,
    tiles: Tiles,
}

impl<'a> Silhouette<'a> {
    /// `None` unless both views have a mask.
    pub fn new(patches: &'a Patches, sight: &Sight) -> Option<Self> {
        let frame = sight.frame;
        let mask = frame.image_mask.as_ref().filter(|_| frame.has_depth_mask)?;
        let size = frame.planes.size;
        Some(Self { patches, mask: MaskDistance::new(size, mask), tiles: Tiles::new(size) })
    }

    /// Adds the log likelihood at a state, tile by tile.
    pub fn evaluate(&self, sight: &Sight, state: &State, out: &mut [f64]) {
        let camera = state.camera(&sight.frame.camera);
        for (point, &tile) in self.patches.points.iter().zip(&self.patches.tiles) {
            let [x, y, z] = state.pose.apply(*point).into();
            let Some(pixel) = camera.project([x, y, z]) else { continue };
            let distance = self.mask.beyond_frame_at(pixel);
            let u = (distance - SLACK).max(0.0);
            out[tile as usize] -= 0.5 * u * u / (1.0 + u * u / (OUTLIER * OUTLIER));
        }
        debug_assert_eq!(out.len(), self.tiles.count());
    }
}
