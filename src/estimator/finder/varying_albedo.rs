//! The pose behind a pinhole, if nothing is known about it and the albedo varies (docs/method/registration.md): from
//! silhouettes, and from a second search. Silhouettes pull a depth map of a part over the whole object, and the second
//! search errs where shading has little contrast, so that neither decides alone: the evidence of the image and that of the
//! silhouettes are added at both poses, and the larger sum decides.

use crate::estimator::decision::{Decision, Method};
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::PhotometricRegistration;
use crate::pose::{PhotometricReport, SilhouetteReport};
use crate::reason::Activity;

use super::halved_pair::HalvedPair;
use super::initial_pose::aligned_prior;
use super::local_optima::Choice;
use super::second_search::{Found, SecondSearch};
use super::silhouettes::{ANYWHERE_DEGREES, Anywhere};

/// Result of a slice.
pub enum Progressed {
    Ongoing,
    /// `None` if neither method constrains the pose.
    Done(Option<Decision>),
}

/// Silhouettes and second search in slices; owns its memory.
pub struct VaryingAlbedo {
    anywhere: Box<Anywhere>,
    /// The second search, once silhouettes are done.
    search: Option<Box<SecondSearch>>,
    /// The pose from silhouettes, if they constrain it.
    silhouettes: Option<Box<SilhouetteReport>>,
}

impl VaryingAlbedo {
    /// `None` if silhouettes constrain nothing.
    pub fn new(pair: &ViewPair, photometric: &PhotometricRegistration) -> Option<Self> {
        let anywhere = Box::new(Anywhere::new(pair, photometric.normals())?);
        Some(Self { anywhere, search: None, silhouettes: None })
    }

    /// Runs one slice; `plain` is the best registration under a single albedo.
    pub fn advance(
        &mut self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        halved: Option<&mut HalvedPair>,
        plain: Option<&PhotometricReport>,
    ) -> Progressed {
        let Some(search) = &mut self.search else {
            if !self.anywhere.advance(pair, photometric.normals()) {
                return Progressed::Ongoing;
            }
            self.silhouettes = self.anywhere.best().map(Box::new);
            self.search = self.second_search(pair, photometric, halved, plain).map(Box::new);
            return match self.search {
                Some(_) => Progressed::Ongoing,
                None => Progressed::Done(self.decide(pair, photometric, Found::default())),
            };
        };
        let found = match halved {
            Some(halved) => {
                let found = search.advance(&halved.pair, &mut halved.photometric);
                found.map(|found| Found { choice: halved.choice_out(found.choice), ..found })
            }
            None => search.advance(pair, photometric),
        };
        match found {
            Some(found) => Progressed::Done(self.decide(pair, photometric, found)),
            None => Progressed::Ongoing,
        }
    }

    /// The second search, if the views allow one.
    fn second_search(
        &self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        halved: Option<&mut HalvedPair>,
        plain: Option<&PhotometricReport>,
    ) -> Option<SecondSearch> {
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

    /// The end of the second search, registered by all points, if its evidence is at least that of silhouettes. These are
    /// then a rival if they differ by more than the sigma. Otherwise silhouettes.
    fn decide(
        &mut self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        Found { choice: Choice { best, mut rivals, ends }, lead }: Found,
    ) -> Option<Decision> {
        let silhouettes = self.silhouettes.take();
        photometric.keep_near(None);
        let mut is_evident = |best: &PhotometricReport| {
            let of_silhouettes = |found| self.anywhere.lead(pair, photometric.normals(), found, &best.pose);
            lead >= silhouettes.as_deref().map_or(0.0, of_silhouettes)
        };
        if let Some(mut best) = best.filter(|best| is_evident(best)) {
            let sampled = best.pose;
            photometric.keep_near(aligned_prior(pair, sampled, ANYWHERE_DEGREES));
            if photometric.register_again(pair, &mut best, &sampled, &ends).is_ok() {
                let sigma = best.uncertainty.largest_rotation();
                let other = silhouettes.map(|found| found.pose);
                rivals.extend(other.filter(|pose| pose.degrees_to(&best.pose) > sigma));
                let by = Method::Photometric(best);
                return Some(Decision { by, rivals: Some(rivals), ends, by_contrast: true });
            }
            photometric.keep_near(None);
        }
        let by = Method::Silhouettes(silhouettes?);
        Some(Decision { rivals: Some(Vec::new()), ..Decision::of(by) })
    }

    /// Share of the work done, and the current activity.
    pub fn progress(&self) -> (f64, Activity) {
        match &self.search {
            None => (0.0, Activity::ComparingSilhouettes),
            Some(search) => search.progress(),
        }
    }
}
