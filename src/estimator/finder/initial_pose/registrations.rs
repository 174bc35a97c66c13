//! Registrations near an initial pose that precede the search. Each runs only if the earlier ones did not explain the
//! image.
//!
//! The loop itself registers from the initial pose. The next starts are the pose that silhouettes find, and the initial
//! rotation shifted to where the projected cloud fits mask and image best: a calibration that is wrong by a degree
//! about the sensor moves the object by an eighth of its size, beyond the registration's basin of convergence. The
//! search over the rotations within tolerance comes last.

use crate::diagnosis::{Alternative, Diagnosis};
use crate::error::Result;
use crate::estimator::finder::candidates::{Candidates, NEARBY, search};
use crate::estimator::finder::local_optima::{Choice, LocalOptima, Origin, RegisteredCandidate};
use crate::estimator::finder::silhouettes;
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::{Attempt, FIRST_LEVEL_NEAR, PhotometricRegistration};
use crate::pose::{COARSEST_NEAR, ImageGrid, PhotometricReport, Search, SilhouetteReport, Similarity};

use super::trust_region::TrustRegion;

/// Result of a slice.
pub enum Progress {
    Ongoing,
    Explained(Choice),
    Unexplained(Box<Candidates>),
}

/// The next step.
enum Step {
    Judge,
    FromInitial { level: usize },
    FromSilhouettes(Similarity),
    Shift,
    FromShifted(Similarity),
    Search,
}

/// The steps around an initial pose.
pub struct InitialRegistrations {
    region: TrustRegion,
    step: Step,
    /// Whether the registration of this step is in progress.
    is_begun: bool,
    /// Where the registration from the initial pose ended, if within tolerance.
    plain: Option<Box<PhotometricReport>>,
    optima: Option<LocalOptima>,
    silhouettes: Option<Box<SilhouetteReport>>,
    search: Option<Search>,
}

impl InitialRegistrations {
    pub fn new(pair: &ViewPair, region: TrustRegion, plain: Option<Box<PhotometricReport>>) -> Self {
        let optima = LocalOptima::new(NEARBY.most + 4, pair.residuals_of_noise(0.0));
        Self {
            region,
            step: Step::Judge,
            is_begun: false,
            plain,
            optima: Some(optima),
            silhouettes: None,
            search: None,
        }
    }

    /// Repeats the registrations near the initial pose, because a single albedo did not explain the image. They start
    /// from that pose and from the one that silhouettes found.
    pub fn again(pair: &ViewPair, region: TrustRegion, silhouettes: Option<Box<SilhouetteReport>>) -> Self {
        let step = Step::FromInitial { level: COARSEST_NEAR };
        Self { step, silhouettes, ..Self::new(pair, region, None) }
    }

    /// The pose from silhouettes, if they constrain it.
    pub fn silhouettes(&mut self) -> Option<Box<SilhouetteReport>> {
        self.silhouettes.take()
    }

    /// Runs one slice.
    pub fn advance(&mut self, pair: &ViewPair, photometric: &mut PhotometricRegistration) -> Result<Progress> {
        match self.step {
            Step::Judge => {
                self.judge(pair, photometric);
                self.step = self.after_initial();
            }
            Step::FromInitial { level } => {
                let next = match level {
                    COARSEST_NEAR => Step::FromInitial { level: FIRST_LEVEL_NEAR },
                    _ => self.after_initial(),
                };
                let initial = self.region.initial;
                return Ok(self.register(pair, photometric, &initial, level, next));
            }
            Step::FromSilhouettes(start) => {
                return Ok(self.register(pair, photometric, &start, COARSEST_NEAR, Step::Shift));
            }
            Step::Shift => {
                let mut search = search(pair, ImageGrid::new(&pair.image)?, photometric)?;
                self.step = search.shifted(&self.region.initial.rotation).map_or(Step::Search, Step::FromShifted);
                self.search = Some(search);
            }
            Step::FromShifted(start) => {
                return Ok(self.register(pair, photometric, &start, COARSEST_NEAR, Step::Search));
            }
            Step::Search => {
                let (Some(search), Some(optima)) = (self.search.take(), self.optima.take()) else {
                    return Ok(Progress::Explained(Choice::default()));
                };
                let candidates = Candidates::new(search, optima, NEARBY, false);
                let candidates = if photometric.is_kept_near() { candidates.near() } else { candidates };
                return Ok(Progress::Unexplained(Box::new(candidates)));
            }
        }
        Ok(Progress::Ongoing)
    }

    /// The step after the initial pose.
    fn after_initial(&self) -> Step {
        self.silhouettes.as_ref().map_or(Step::Shift, |found| Step::FromSilhouettes(found.pose))
    }

    /// Enters the initial pose and the result from it, and registers silhouettes.
    fn judge(&mut self, pair: &ViewPair, photometric: &mut PhotometricRegistration) {
        let region = &self.region;
        let Some(optima) = &mut self.optima else { return };
        if let Some(staying) = photometric.judge(pair, &region.initial) {
            optima.enter(Origin::Initial, RegisteredCandidate::of(staying));
        }
        if let Some(plain) = self.plain.take() {
            optima.enter(Origin::Nearby, RegisteredCandidate::of(plain));
        }
        let found = region.prior(pair).and_then(|prior| silhouettes::near(pair, photometric.normals(), prior));
        self.silhouettes = found.filter(|found| region.holds(pair, &found.pose)).map(Box::new);
    }

    /// Advances a registration by a step; at its end, decides whether it explains the image.
    fn register(
        &mut self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        start: &Similarity,
        first_level: usize,
        next: Step,
    ) -> Progress {
        let attempt = photometric.step_from(pair, start, first_level, !self.is_begun);
        let Attempt::Ended(found) = attempt else {
            self.is_begun = true;
            return Progress::Ongoing;
        };
        (self.is_begun, self.step) = (false, next);
        let found = found.filter(|found| self.region.holds(pair, &found.pose));
        let (Some(found), Some(optima)) = (found, &mut self.optima) else { return Progress::Ongoing };
        let is_explained = explains(pair, &found);
        optima.enter(Origin::Nearby, RegisteredCandidate::of(found));
        if is_explained { Progress::Explained(Choice::of(optima.ranked())) } else { Progress::Ongoing }
    }
}

/// Whether a pose explains the image. Fine print raises the residuals like noise, but neighbouring residuals share it.
pub fn explains(pair: &ViewPair, found: &PhotometricReport) -> bool {
    pair.residuals(found).diagnose(Alternative::Silhouettes) == Diagnosis::Explained
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::options::{Options, Start, StartTolerance};
    use crate::pose::Angles;
    use crate::scenes::{SampleRequest, Scene, surface};

    /// A pair whose initial pose is three degrees off and trusted within 0.1 degrees, and its true pose.
    fn pair_beside_its_pose() -> (ViewPair, Similarity) {
        let sample = Scene::new(&surface("bust").unwrap()).unwrap().sample(&SampleRequest::default()).unwrap();
        let Similarity { rotation, scale, translation } = sample.pose;
        let turn = Angles { gamma: 3.0, ..Angles::default() }.rotation();
        let options = Options {
            start: Start::Pose { rotation: turn * rotation, scale: Some(scale), translation: Some(translation) },
            start_tolerance: StartTolerance { degrees: 0.1, distance: None },
            ..Options::default()
        };
        (ViewPair::new(sample.colour_image(), &sample.depth_map(), options).unwrap(), sample.pose)
    }

    #[test]
    fn what_was_found_before_outlives_a_registration_that_fails_or_ends_outside_the_region() {
        let (pair, truth) = pair_beside_its_pose();
        let mut photometric = PhotometricRegistration::new(&pair);
        let out_of_sight = Similarity { translation: Vector3::new(1e4, 0.0, 0.0), ..truth };
        for (start, is_registered) in [(out_of_sight, false), (truth, true)] {
            let region = TrustRegion::of(&pair).unwrap();
            let initial = region.initial;
            let end = photometric.register_candidate(&pair, &start);
            assert_eq!(end.is_some(), is_registered);
            assert!(end.is_none_or(|end| !region.holds(&pair, &end.pose)));
            let mut nearby = InitialRegistrations::new(&pair, region, None);
            nearby.judge(&pair, &mut photometric);
            nearby.step = Step::FromSilhouettes(start);
            while matches!(nearby.step, Step::FromSilhouettes(_)) {
                assert!(matches!(nearby.advance(&pair, &mut photometric).unwrap(), Progress::Ongoing));
            }
            assert_eq!(nearby.optima.and_then(|optima| optima.best()), Some(initial), "{is_registered}");
        }
    }
}
