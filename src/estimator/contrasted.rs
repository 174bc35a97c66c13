//! Alternates between pose and albedo if the albedo varies (docs/method/registration.md).
//!
//! The search by contrast can remove only the albedo that shows at edges, because it has no pose yet. Under the pose of
//! the search, the light stage finds more of the albedo: a palette and gradual changes ([`AlbedoStage`]). This albedo is
//! removed, and the contrast is registered once more. The new pose then gives a new albedo. These two steps alternate
//! for a few rounds (coordinate descent). Then the pose is combined with the one from the gradient domain, if there is
//! one, which was registered from the end of the search.
//!
//! Limits: cast shadows are mistaken for albedo, so a round counts only if shading explains more of the remainder than
//! before.

use super::finder::initial_pose::TrustRegion;
use super::pair::ViewPair;
use super::photometric::PhotometricRegistration;
use super::stages::AlbedoStage;
use crate::pose::{ContrastReport, GradientReport, Similarity, Uncertainty, combine, register_again};

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
    /// The registration in the gradient domain, until its pose is combined with this one.
    gradients: Option<Box<GradientReport>>,
    /// Poses that fit the contrast equally well.
    rivals: Vec<Similarity>,
}

/// A better pose.
pub struct Followed {
    pub pose: Similarity,
    /// Its sigmas and rivals, if they changed.
    pub uncertainty: Option<Uncertainty>,
    pub rivals: Option<Vec<Similarity>>,
}

impl Contrasted {
    /// The state before the first round.
    pub const fn new(report: ContrastReport) -> Self {
        let objective = report.objective;
        Self { report, objective, rounds: ROUNDS, gradients: None, rivals: Vec::new() }
    }

    /// Adds the registration in the gradient domain, and the rivals of this pose.
    pub fn with_gradients(self, gradients: Option<GradientReport>, rivals: Vec<Similarity>) -> Self {
        Self { gradients: gradients.map(Box::new), rivals, ..self }
    }

    /// Whether the pose has settled.
    pub const fn stands(&self) -> bool {
        self.rounds == 0 && self.gradients.is_none()
    }

    /// One round of pose and albedo or, once they are over, the combination with the gradient domain. `None` if neither
    /// moves the pose.
    pub fn follow(
        &mut self,
        pair: &ViewPair,
        photometric: &PhotometricRegistration,
        albedo: &AlbedoStage,
        region: Option<&TrustRegion>,
    ) -> Option<Followed> {
        let before = self.report.pose;
        let improved = self.improve(pair, photometric, albedo, region);
        // The loop may end after a round that hardly moves the pose.
        let goes_on = |pose: &Similarity| self.rounds > 0 && pose.degrees_to(&before) >= pair.options.stop_degrees;
        let combined = if improved.as_ref().is_some_and(goes_on) { None } else { self.combine(pair, region) };
        combined.or_else(|| improved.map(|pose| Followed { pose, uncertainty: None, rivals: None }))
    }

    /// One round: registers the pose to the image, from which the albedo found under the current pose is removed.
    /// `None` if the pose has settled, if E does not fall, or if the pose would leave the trust region of an initial
    /// one.
    fn improve(
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

    /// Combines the pose with the one from the gradient domain; `None` without one, or if the result would leave the
    /// trust region.
    fn combine(&mut self, pair: &ViewPair, region: Option<&TrustRegion>) -> Option<Followed> {
        let gradients = self.gradients.take()?;
        self.rounds = 0;
        let combined = combine(&self.report, &gradients)?;
        if !region.is_none_or(|region| region.holds(pair, &combined.pose)) {
            return None;
        }
        (self.report.pose, self.report.uncertainty) = (combined.pose, combined.uncertainty);
        let mut rivals = std::mem::take(&mut self.rivals);
        rivals.extend(combined.rival);
        Some(Followed {
            pose: self.report.pose,
            uncertainty: Some(self.report.uncertainty.clone()),
            rivals: Some(rivals),
        })
    }
}
