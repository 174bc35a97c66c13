//! The cues over surfaces as functions of the state.

use super::cue::Cue;
use super::differences::differences;
use super::evidence::{Share, Tiles};
use super::information::Information;
use super::patches::{Patches, Sight};
use super::shading::Shading;
use super::silhouette::Silhouette;
use super::unknowns::{Matrix, State, Units};

/// A log likelihood of the colours at a state, tile by tile.
type LogLikelihood<'a> = Box<dyn Fn(&State, &[[f32; 3]], &mut [f64]) + 'a>;

/// Cues over the patches of one frame. They compare the same colours, so the samples are projected once for all.
pub(super) struct Surfaces<'a> {
    patches: &'a Patches,
    sight: Sight<'a>,
    /// `None` for a cue that does not compare surfaces, or if the frame lacks the data for it.
    cues: Vec<Option<LogLikelihood<'a>>>,
    tiles: usize,
}

impl<'a> Surfaces<'a> {
    /// The cues over the patches that are visible from `from`.
    pub fn new(cues: &[Cue], patches: &'a Patches, sight: Sight<'a>, from: &State) -> Self {
        let colours = patches.colours(&sight, from);
        let cues = cues.iter().map(|cue| log_likelihood(*cue, patches, sight, &colours)).collect();
        Self { patches, sight, cues, tiles: Tiles::new(sight.planes.size).count() }
    }

    /// The log likelihoods at a state: the tiles of each cue, one cue after the other.
    pub fn at(&self, state: &State) -> Vec<f64> {
        let mut tiles = vec![0.0; self.cues.len() * self.tiles];
        let colours = self.patches.colours(&self.sight, state);
        for (cue, tiles) in self.cues.iter().zip(tiles.chunks_mut(self.tiles)) {
            if let Some(of_cue) = cue {
                of_cue(state, &colours, tiles);
            }
        }
        tiles
    }

    /// The sum of the log likelihoods at a state, each times its weight.
    pub fn sum(&self, state: &State, weights: &[f64]) -> f64 {
        let tiles = self.at(state);
        tiles.chunks(self.tiles).zip(weights).map(|(tiles, weight)| weight * tiles.iter().sum::<f64>()).sum()
    }

    /// The log likelihood of each cue with its derivatives at a state, tile by tile. If there are no `curvatures` yet, they
    /// are those at this state.
    pub fn shares(&self, units: &Units, state: &State, curvatures: &mut Vec<Matrix>) -> Vec<Vec<Share>> {
        differences(units, state, self.tiles, curvatures, |state| self.at(state))
    }
}

fn log_likelihood<'a>(
    cue: Cue,
    patches: &'a Patches,
    sight: Sight<'a>,
    colours: &[[f32; 3]],
) -> Option<LogLikelihood<'a>> {
    match cue {
        Cue::Edges => None,
        Cue::Information => {
            let cue = Information(patches);
            Some(Box::new(move |_, colours, out| cue.evaluate(&sight, colours, out)))
        }
        Cue::Shading => {
            let cue = Shading::new(patches, colours);
            Some(Box::new(move |_, colours, out| cue.evaluate(colours, out)))
        }
        Cue::Silhouette => {
            let cue = Silhouette::new(patches, &sight)?;
            Some(Box::new(move |state, _, out| cue.evaluate(&sight, state, out)))
        }
    }
}
