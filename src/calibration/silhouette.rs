//! The masked object on the image's mask, where both views have one.
//!
//! Points of the object lie on the mask. The log likelihood is the negative half of the sum over points of
//! u^2 / (1 + u^2 / U^2), u being how far a point falls outside the mask beyond a tolerance. That alone would shrink the
//! object into its mask; the edges' cue draws its rims to the outline from inside.

use super::evidence::Tiles;
use super::patches::{Patches, Sight};
use super::unknowns::State;
use crate::pose::{SLACK, squared_distances};

/// U, pixels: beyond it a point is a mistake of one of the masks.
const OUTLIER: f64 = 6.0;

/// The cue of one frame: distances to the mask.
pub(super) struct Silhouette<'a> {
    patches: &'a Patches,
    outside: Vec<f32>,
    tiles: Tiles,
}

impl<'a> Silhouette<'a> {
    /// `None` unless both views have a mask.
    pub fn new(patches: &'a Patches, sight: &Sight) -> Option<Self> {
        let frame = sight.frame;
        let mask = frame.image_mask.as_ref().filter(|_| frame.has_depth_mask)?;
        let size = frame.planes.size;
        let outside =
            squared_distances(size, |index| mask[index]).into_iter().map(|square| square.sqrt() as f32).collect();
        Some(Self { patches, outside, tiles: Tiles::new(size) })
    }

    /// The log likelihood at a state, tile by tile.
    pub fn evaluate(&self, sight: &Sight, state: &State, out: &mut [f64]) {
        out.fill(0.0);
        let (camera, size) = (state.camera(&sight.frame.camera), sight.frame.planes.size);
        for (point, &tile) in self.patches.points.iter().zip(&self.patches.tiles) {
            let [x, y, z] = state.pose.apply(*point).into();
            let Some([column, row]) = camera.project([x, y, z]) else { continue };
            // `clamp` can panic with both limits in words, which takes 8 kB of code for floats.
            let within = |value: f64, length: usize| value.max(0.0).min((length - 1) as f64);
            let clamped = [within(column, size.width), within(row, size.height)];
            let beyond = (column - clamped[0]).hypot(row - clamped[1]);
            let distance = f64::from(size.bilinear(&self.outside, clamped[0] as f32, clamped[1] as f32)) + beyond;
            let u = (distance - SLACK).max(0.0);
            out[tile as usize] -= 0.5 * u * u / (1.0 + u * u / (OUTLIER * OUTLIER));
        }
        debug_assert_eq!(out.len(), self.tiles.count());
    }
}
