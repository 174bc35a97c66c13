//! Alternates between pose and albedo if the albedo varies (docs/method/registration.md).
//!
//! The search by contrast can remove only the albedo that shows at edges, because it has no pose yet. Under the pose of
//! the search, the light stage finds more of the albedo: a palette and gradual changes ([`AlbedoStage`]). This albedo is
//! removed, and the contrast is registered once more. The new pose then gives a new albedo. These two steps alternate
//! for a few rounds (coordinate descent).
//!
//! Limits: cast shadows are mistaken for albedo, so a round counts only if shading explains more of the remainder than
//! before.

use super::finder::initial_pose::TrustRegion;
use super::pair::ViewPair;
use super::photometric::PhotometricRegistration;
use super::stages::AlbedoStage;
use crate::pose::{ContrastReport, Similarity, register_again};

/// Largest number of rounds of pose and albedo. Set on photographs at 20 and 60 degrees (docs/lab/thresholds.md).
const ROUNDS: usize = 3;

/// A pose from contrast, and the number of rounds that remain.
pub struct Contrasted {
    /// The result of the search. Its sigmas and its E stay when the pose moves: albedo found from the same colours is
    /// no independent evidence.
    pub report: ContrastReport,
    /// E of the pose without the albedo found so far.
    objective: f64,
    rounds: usize,
}

impl Contrasted {
    /// The state before the first round.
    pub const fn new(report: ContrastReport) -> Self {
        let objective = report.objective;
        Self { report, objective, rounds: ROUNDS }
    }

    /// Whether the pose has settled.
    pub const fn stands(&self) -> bool {
        self.rounds == 0
    }

    /// One round: registers the pose to the image, from which the albedo found under the current pose is removed.
    /// `None` if the pose has settled, if E does not fall, or if the pose would leave the trust region of an initial
    /// one.
    pub fn follow(
        &mut self,
        pair: &ViewPair,
        photometric: &PhotometricRegistration,
        albedo: &AlbedoStage,
        region: Option<&TrustRegion>,
    ) -> Option<Similarity> {
        let rounds = self.rounds.checked_sub(1)?;
        self.rounds = 0;
        let image = albedo.without_albedo(pair)?;
        let (pose, objective) = register_again(&photometric.contrast_problem(pair, &image), &self.report.pose)?;
        let is_allowed = region.is_none_or(|region| region.holds(pair, &pose));
        if !is_allowed || objective >= self.objective {
            return None;
        }
        (self.rounds, self.report.pose, self.objective) = (rounds, pose, objective);
        Some(pose)
    }
}
