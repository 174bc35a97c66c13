//! The registration in the gradient domain that follows the search by local contrast (docs/method/registration.md).
//!
//! It starts from the best end of that search, on the same image. The loop combines both poses after its rounds of pose
//! and albedo ([`Contrasted`]).

use super::local_contrast::CleanedImage;
use crate::estimator::contrasted::Contrasted;
use crate::estimator::decision::{Decision, Method};
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::PhotometricRegistration;
use crate::pose::{ContrastReport, GradientRegistration, Similarity};

/// A registration in progress, with the result of local contrast.
pub struct InGradients {
    cleaned: CleanedImage,
    registration: GradientRegistration,
    contrast: Box<ContrastReport>,
    rivals: Vec<Similarity>,
}

impl InGradients {
    pub fn new(
        pair: &ViewPair,
        photometric: &PhotometricRegistration,
        cleaned: CleanedImage,
        (contrast, rivals): (Box<ContrastReport>, Vec<Similarity>),
    ) -> Self {
        let problem = photometric.contrast_problem(pair, cleaned.image(pair));
        let registration = GradientRegistration::new(&problem, &contrast);
        Self { cleaned, registration, contrast, rivals }
    }

    /// Takes one step. Returns whether it was the last. Noisy normals bend by more than the registration assumes, so it
    /// then takes none.
    pub fn advance(&mut self, pair: &ViewPair, photometric: &PhotometricRegistration) -> bool {
        let problem = photometric.contrast_problem(pair, self.cleaned.image(pair));
        !photometric.has_clean_normals() || self.registration.advance(&problem)
    }

    /// The decision, once all steps are done.
    pub fn decision(self, pair: &ViewPair, photometric: &PhotometricRegistration) -> Decision {
        let Self { cleaned, registration, contrast, rivals } = self;
        let gradients = registration.report(&photometric.contrast_problem(pair, cleaned.image(pair)));
        let contrasted = Contrasted::new(*contrast).with_gradients(gradients, rivals.clone());
        Decision { rivals: Some(rivals), ..Decision::of(Method::Contrast(Box::new(contrasted))) }
    }
}
