//! The next piece of work of a photometric registration.

use super::problem::PhotometricTermination;
use crate::pose::descent::Damping;
use crate::pose::increment::Frame;
use crate::pose::similarity::Similarity;

/// The next piece of work.
#[derive(Clone, Copy, Debug)]
pub(super) enum Phase {
    /// The beginning of a round of annealing, which chooses its visible points, their light and its robust scale.
    AnnealingRound {
        level: usize,
        fine_rounds: usize,
    },
    /// A Gauss-Newton step of such a round.
    AnnealingStep(Descent),
    /// The beginning of a round with instrumental variables.
    InstrumentalRound {
        round: usize,
    },
    /// A step of such a round.
    InstrumentalStep {
        round: usize,
        frame: Frame,
        steps: usize,
        /// Length of the previous step.
        last: f64,
    },
    Done(PhotometricTermination),
}

/// A round of damped Gauss-Newton at one level and one robust scale, between two of its steps.
#[derive(Clone, Copy, Debug)]
pub(super) struct Descent {
    pub level: usize,
    /// Number of earlier rounds at the robust scale of the noise.
    pub fine_rounds: usize,
    pub frame: Frame,
    /// The pose at the beginning of the round.
    pub before: Similarity,
    /// Whether the robust scale is that of the noise.
    pub at_noise: bool,
    pub damping: Damping,
    pub objective: f64,
    pub steps: usize,
}
