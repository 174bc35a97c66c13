//! The cues over surfaces as functions of the state.

use super::cue::Cue;
use super::information::Information;
use super::patches::{Patches, Sight};
use super::shading::Shading;
use super::silhouette::Silhouette;
use super::unknowns::State;

/// A log likelihood at a state, tile by tile.
pub(super) type LogLikelihood<'a> = Box<dyn Fn(&State, &mut [f64]) + 'a>;

/// The log likelihood by a cue over the patches of one frame that are visible from `from`. It is `None` if the cue does
/// not compare surfaces, or if the frame lacks the data for it.
pub(super) fn log_likelihood<'a>(
    cue: Cue,
    patches: &'a Patches,
    sight: Sight<'a>,
    from: &State,
) -> Option<LogLikelihood<'a>> {
    match cue {
        Cue::Edges => None,
        Cue::Information => {
            let cue = Information(patches);
            Some(Box::new(move |state, out| cue.evaluate(&sight, state, out)))
        }
        Cue::Shading => {
            let cue = Shading::new(patches, &sight, from);
            Some(Box::new(move |state, out| cue.evaluate(&sight, state, out)))
        }
        Cue::Silhouette => {
            let cue = Silhouette::new(patches, &sight)?;
            Some(Box::new(move |state, out| cue.evaluate(&sight, state, out)))
        }
    }
}
