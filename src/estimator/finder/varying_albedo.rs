//! The pose behind a pinhole, if nothing is known about it and the albedo varies (docs/method/registration.md): from
//! silhouettes, then from a second search.

use crate::estimator::decision::{Decision, Method};
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::PhotometricRegistration;
use crate::pose::{PhotometricReport, SilhouetteReport};
use crate::reason::Activity;

use super::halved_pair::HalvedPair;
use super::initial_pose::aligned_prior;
use super::local_optima::Choice;
use super::second_search::SecondSearch;
use super::silhouettes::{ANYWHERE_DEGREES, Anywhere};

/// Noise of the depth discontinuities about the silhouette, as a share of the object's size (root of its area in the image),
/// up to which silhouettes agree, because the depth map shows the whole object. Set on pairs of a statue and on captures
/// (docs/lab/thresholds.md).
const LARGEST_MISFIT: f64 = 0.017;

/// Result of a slice.
pub enum Progressed {
    Ongoing,
    /// `None` if neither method constrains the pose.
    Done(Option<Decision>),
}

/// Silhouettes and second search in slices; owns its memory.
pub struct VaryingAlbedo {
    step: Step,
    /// The pose from silhouettes, if they constrain it.
    silhouettes: Option<Box<SilhouetteReport>>,
}

enum Step {
    Silhouettes(Box<Anywhere>),
    Search(Box<SecondSearch>),
}

impl VaryingAlbedo {
    /// `None` if silhouettes constrain nothing.
    pub fn new(pair: &ViewPair, photometric: &PhotometricRegistration) -> Option<Self> {
        let step = Step::Silhouettes(Box::new(Anywhere::new(pair, photometric.normals())?));
        Some(Self { step, silhouettes: None })
    }

    /// Runs one slice; `plain` is the best registration under a single albedo.
    pub fn advance(
        &mut self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        halved: Option<&mut HalvedPair>,
        plain: Option<&PhotometricReport>,
    ) -> Progressed {
        let choice = match &mut self.step {
            Step::Silhouettes(anywhere) => {
                if !anywhere.advance(pair, photometric.normals()) {
                    return Progressed::Ongoing;
                }
                self.silhouettes = anywhere.best().map(Box::new);
                match self.second_search(pair, photometric, halved, plain) {
                    Some(search) => {
                        self.step = Step::Search(Box::new(search));
                        return Progressed::Ongoing;
                    }
                    None => Choice::default(),
                }
            }
            Step::Search(search) => {
                let choice = match halved {
                    Some(halved) => {
                        let choice = search.advance(&halved.pair, &mut halved.photometric);
                        choice.map(|choice| halved.choice_out(choice))
                    }
                    None => search.advance(pair, photometric),
                };
                let Some(choice) = choice else { return Progressed::Ongoing };
                choice
            }
        };
        Progressed::Done(self.decide(pair, photometric, choice))
    }

    /// The second search, unless silhouettes agree.
    fn second_search(
        &self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        halved: Option<&mut HalvedPair>,
        plain: Option<&PhotometricReport>,
    ) -> Option<SecondSearch> {
        let area = pair.image.object().iter().filter(|&&inside| inside).count() as f64;
        if self.silhouettes.as_ref().is_some_and(|found| found.noise <= LARGEST_MISFIT * area.sqrt()) {
            return None;
        }
        let silhouettes = self.silhouettes.as_ref().map(|found| found.pose);
        let plain = plain.map(|plain| plain.pose);
        match halved {
            Some(halved) => {
                let [silhouettes, plain] = [silhouettes, plain].map(|pose| pose.map(|pose| halved.pose_in(&pose)));
                SecondSearch::new(&halved.pair, &mut halved.photometric, silhouettes, plain)
            }
            None => SecondSearch::new(pair, photometric, silhouettes, plain),
        }
    }

    /// The end of the second search, registered by all points, if it is more certain than silhouettes. These are then a
    /// rival if they differ by more than the sigma. Otherwise silhouettes.
    fn decide(
        &mut self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        Choice { best, mut rivals, ends }: Choice,
    ) -> Option<Decision> {
        let silhouettes = self.silhouettes.take();
        photometric.keep_near(None);
        if let Some(mut best) = best {
            let sampled = best.pose;
            photometric.keep_near(aligned_prior(pair, sampled, ANYWHERE_DEGREES));
            let again = photometric.register_again(pair, &mut best, &sampled, &ends);
            let sigma = best.uncertainty.largest_rotation();
            let is_more_certain = |found: &SilhouetteReport| sigma <= found.uncertainty.largest_rotation();
            if again.is_ok() && silhouettes.as_deref().is_none_or(is_more_certain) {
                let other = silhouettes.map(|found| found.pose);
                rivals.extend(other.filter(|pose| pose.degrees_to(&best.pose) > sigma));
                return Some(Decision { by: Method::Photometric(best), rivals: Some(rivals), ends });
            }
            photometric.keep_near(None);
        }
        let by = Method::Silhouettes(silhouettes?);
        Some(Decision { rivals: Some(Vec::new()), ..Decision::of(by) })
    }

    /// Share of the work done, and the current activity.
    pub fn progress(&self) -> (f64, Activity) {
        match &self.step {
            Step::Silhouettes(_) => (0.0, Activity::ComparingSilhouettes),
            Step::Search(search) => search.progress(),
        }
    }
}
