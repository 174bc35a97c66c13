//! A painted object's pose and its paint in turn (docs/method/registration.md).
//!
//! The search by contrast can take out no paint but what shows at edges, since it has no pose yet. Under its pose the light
//! stage tells more: a palette and soft changes ([`PaintStage`]). Without these the contrast is compared once more, from
//! where the pose is, which moves the pose, and paint is looked for anew: coordinate descent, for a few rounds.
//!
//! Limits: cast shadows pass for paint. So a round counts only where shading explains more of what is left than before.

use super::colours::ColourRegistration;
use super::paint::PaintStage;
use crate::estimator::finder::TrustRegion;
use crate::estimator::pair::ViewPair;
use crate::pose::{ContrastReport, Similarity, register_again};

/// Rounds at most. Of twenty photographs most stand after the first, since E rises in the second; two go on to the third.
const ROUNDS: usize = 3;

/// A pose by contrast, and how many rounds it may still follow its paint.
pub struct Contrasted {
    /// What the search has found. Its sigmas and its E stay as they are when the pose moves: paint that was found by the same
    /// colours is no evidence of its own.
    pub report: ContrastReport,
    /// E of the pose without its paint.
    objective: f64,
    rounds: usize,
}

impl Contrasted {
    /// Before the first round.
    pub const fn new(report: ContrastReport) -> Self {
        let objective = report.objective;
        Self { report, objective, rounds: ROUNDS }
    }

    /// Whether the pose will not move any more.
    pub const fn stands(&self) -> bool {
        self.rounds == 0
    }

    /// A round: the pose by what is left without the paint that was found under it; nothing where it stands, or would leave the trust region
    /// of an initial pose.
    pub fn follow(
        &mut self,
        pair: &ViewPair,
        colours: &ColourRegistration,
        paint: &PaintStage,
        region: Option<&TrustRegion>,
    ) -> Option<Similarity> {
        let rounds = self.rounds.checked_sub(1)?;
        self.rounds = 0;
        let image = paint.without_albedo(pair)?;
        let (pose, objective) = register_again(&colours.contrast_problem(pair, &image), &self.report.pose)?;
        let is_allowed = region.is_none_or(|region| region.holds(pair, &pose));
        if !is_allowed || objective >= self.objective {
            return None;
        }
        (self.rounds, self.report.pose, self.objective) = (rounds, pose, objective);
        Some(pose)
    }
}
