//! The registration stage: runs the finder or matches the surfaces, depending on the options, and keeps the decision.

use crate::estimator::contrasted::Followed;
use crate::estimator::decision::{Decision, Method};
use crate::estimator::finder::initial_pose::TrustRegion;
use crate::estimator::finder::{Beginning, Finder};
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::PhotometricRegistration;
use crate::estimator::solution::Solution;
use crate::light::Light;
use crate::options::{Registration, Start};
use crate::pose::{PhotometricReport, Similarity, Uncertainty};
use crate::reason::Reason;
use crate::view::Normals;

use super::albedo::AlbedoStage;
use super::light::Inputs;
use super::surfaces::{Matched, SurfaceRegistration};

/// Result of a registration: a pose, and what was found with it.
pub struct Registered {
    pub pose: Similarity,
    /// Light, if found with the pose.
    pub light: Option<Light>,
    /// Exposure, if found with the pose.
    pub exposure: Option<f64>,
    /// `None` for a pose that never moved: data that cannot determine it do not determine its error either.
    pub uncertainty: Option<Uncertainty>,
    /// Whether the pose is better than its start.
    pub improved: bool,
    /// Other poses that the data cannot distinguish from it, if they were looked for.
    pub rivals: Option<Vec<Similarity>>,
}

impl Registered {
    /// A better pose, its sigmas, and nothing else.
    const fn of(pose: Similarity, uncertainty: Option<Uncertainty>) -> Self {
        Self { pose, light: None, exposure: None, uncertainty, improved: true, rivals: None }
    }

    /// Pose and light of a photometric registration.
    fn photometric(
        pair: &ViewPair,
        found: &PhotometricReport,
        present: &Similarity,
        surfaces_settle_pose: bool,
    ) -> Self {
        Self {
            light: Some(found.light),
            // Normals flattened by noise bias the exposure, so the stages find it again.
            exposure: (!surfaces_settle_pose).then_some(found.exposure),
            ..Self::of(with_gauge_of(pair, found.pose, present), Some(found.uncertainty.clone()))
        }
    }
}

/// Registers the depth view to the image, photometrically or by matching surfaces.
pub struct RegistrationStage {
    /// Present only if the options require it, because it holds splines of the image; a finder makes it if it is missing.
    pub photometric: Option<PhotometricRegistration>,
    /// The decision of the finder, and its method's latest result.
    pub decision: Option<Decision>,
    surfaces: SurfaceRegistration,
    /// Region around the initial pose, if there is one.
    region: Option<TrustRegion>,
}

/// Result of the stage.
pub enum Registering {
    Done(Option<Box<Registered>>),
    /// A finder must find the pose first.
    Finding(Box<Finder>),
}

impl Registering {
    fn of(found: Option<Registered>) -> Self {
        Self::Done(found.map(Box::new))
    }
}

impl RegistrationStage {
    /// Leaves photometric registration out if `photometric_waits`; the finder then makes it after the search.
    pub fn new(pair: &ViewPair, photometric_waits: bool) -> Self {
        let is_photometric = pair.options.start == Start::Search || pair.options.registration == Registration::Joint;
        let is_photometric = is_photometric && !photometric_waits;
        Self {
            photometric: is_photometric.then(|| PhotometricRegistration::new(pair)),
            decision: None,
            surfaces: SurfaceRegistration::new(),
            region: TrustRegion::of(pair),
        }
    }

    /// The registration that this pair needs now: with noisy depth, photometric registration finds the pose and ICP settles it.
    pub fn kind(&self, pair: &ViewPair) -> Registration {
        match pair.options.registration {
            Registration::Joint if self.surfaces_settle_pose() && self.decided_photometrically().is_some() => {
                Registration::Icp
            }
            asked => asked,
        }
    }

    /// The method that the pose rests on; `None` before the decision, and if surfaces settle the pose.
    pub fn method(&self) -> Option<&Method> {
        let settled_by_surfaces = |by: &Method| self.surfaces_settle_pose() && matches!(by, Method::Photometric(_));
        self.decision.as_ref().map(|decision| &decision.by).filter(|by| !settled_by_surfaces(by))
    }

    /// Whether local contrast chose the pose.
    pub fn is_by_contrast(&self) -> bool {
        self.decision.as_ref().is_some_and(|decision| decision.by_contrast)
    }

    /// Result of the photometric registration, unless depth noise leaves pose and light to other stages.
    pub fn found_photometrically(&self) -> Option<&PhotometricReport> {
        self.decided_photometrically().filter(|_| !self.surfaces_settle_pose())
    }

    fn decided_photometrically(&self) -> Option<&PhotometricReport> {
        self.decision.as_ref().and_then(Decision::photometric)
    }

    fn surfaces_settle_pose(&self) -> bool {
        self.photometric.as_ref().is_some_and(PhotometricRegistration::surfaces_settle_pose)
    }

    /// The best measured normals of the depth view.
    pub fn measured_normals<'a>(&'a self, pair: &'a ViewPair) -> &'a Normals {
        self.photometric.as_ref().map_or(&pair.depth.normals, PhotometricRegistration::normals)
    }

    /// Adopts the finder's decision.
    ///
    /// # Errors
    /// [`Reason::SizeRunsAway`] if the size departs from the initial pose's.
    pub fn adopt(
        &mut self,
        pair: &ViewPair,
        mut decision: Decision,
        present: &Similarity,
    ) -> Result<Option<Registered>, Reason> {
        let rivals = decision.rivals.take();
        let registered = match &decision.by {
            Method::Initial(_) => None,
            Method::Silhouettes(found) => Some(Registered::of(found.pose, Some(found.uncertainty.clone()))),
            Method::Contrast(found) => {
                let pose = with_gauge_of(pair, found.report.pose, present);
                Some(Registered::of(pose, Some(found.report.uncertainty.clone())))
            }
            Method::Photometric(found) => {
                if self.region.is_some() {
                    check_size(pair, &found.pose, present)?;
                }
                Some(Registered::photometric(pair, found, present, self.surfaces_settle_pose()))
            }
        };
        self.decision = Some(decision);
        Ok(registered.map(|registered| Registered { rivals, ..registered }))
    }

    /// Names the kind of registration that determined the pose.
    pub fn engine(&self, pair: &ViewPair) -> &'static str {
        match (self.kind(pair), self.decision.as_ref().map(|decision| &decision.by)) {
            (Registration::Fixed, _) => "held pose",
            (Registration::Icp, _) => "surfaces",
            (Registration::Joint, Some(Method::Initial(_))) => "initial pose kept",
            (Registration::Joint, Some(Method::Silhouettes(_))) => "silhouettes",
            (Registration::Joint, Some(Method::Contrast(_))) => "local contrast",
            (Registration::Joint, _) => "photometric registration",
        }
    }

    /// Whether the next registration will leave `pose` unchanged, whatever the shapes become.
    pub fn keeps(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        match self.kind(pair) {
            Registration::Fixed => true,
            Registration::Joint => self.decision.as_ref().is_some_and(|decision| decision.by.keeps(pose)),
            Registration::Icp => false,
        }
    }

    /// Whether the albedo is to be fitted under `pose`: the pose has settled, or waits only for the albedo.
    pub fn requires_albedo(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        matches!(self.method(), Some(Method::Contrast(_))) || self.keeps(pair, pose)
    }

    /// Registers from the current pose, without the albedo found under it; finds nothing if the pose is fixed. If an
    /// initial pose does not explain the image, a finder is required.
    pub fn register(
        &mut self,
        inputs: Inputs<'_>,
        albedo: &AlbedoStage,
        solution: &Solution,
    ) -> Result<Registering, Reason> {
        let (pair, present) = (inputs.pair, &solution.pose);
        match self.kind(pair) {
            Registration::Fixed => Ok(Registering::Done(None)),
            Registration::Icp => self.match_surfaces(inputs, solution).map(Registering::of),
            Registration::Joint if self.decision.is_some() => {
                self.register_again(pair, albedo, present).map(Registering::of)
            }
            Registration::Joint => {
                let (Some(photometric), Some(region)) = (&mut self.photometric, &self.region) else {
                    return Ok(Registering::Done(None));
                };
                match Finder::near(pair, region, photometric) {
                    Beginning::Done(decision) => self.adopt(pair, decision, present).map(Registering::of),
                    Beginning::Ongoing(finder) => Ok(Registering::Finding(finder)),
                }
            }
        }
    }

    /// Registers again by the method that found the pose, or keeps its pose.
    fn register_again(
        &mut self,
        pair: &ViewPair,
        albedo: &AlbedoStage,
        start: &Similarity,
    ) -> Result<Option<Registered>, Reason> {
        let surfaces_settle_pose = self.surfaces_settle_pose();
        let (Some(photometric), Some(Decision { by, ends, .. })) = (&mut self.photometric, &mut self.decision) else {
            return Ok(None);
        };
        match by {
            Method::Initial(_) | Method::Silhouettes(_) => Ok(None),
            Method::Contrast(found) => {
                let followed = found.follow(pair, photometric, albedo, self.region.as_ref());
                Ok(followed.map(|Followed { pose, uncertainty, rivals }| Registered {
                    rivals,
                    ..Registered::of(with_gauge_of(pair, pose, start), uncertainty)
                }))
            }
            Method::Photometric(found) => {
                photometric.register_again(pair, found, start, ends)?;
                check_size(pair, &found.pose, start)?;
                Ok(Some(Registered::photometric(pair, found, start, surfaces_settle_pose)))
            }
        }
    }

    /// Matches both surfaces; the pose stays if it would leave the region of an initial one.
    fn match_surfaces(&mut self, inputs: Inputs<'_>, solution: &Solution) -> Result<Option<Registered>, Reason> {
        let Matched { mut pose, mut improved, uncertainty } = self.surfaces.register(inputs, solution)?;
        if self.region.as_ref().is_some_and(|region| !region.holds(inputs.pair, &pose)) {
            (pose, improved) = (solution.pose, false);
        }
        Ok(Some(Registered { improved, ..Registered::of(pose, improved.then_some(uncertainty)) }))
    }
}

/// An error if the apparent size departs from that of another pose.
fn check_size(pair: &ViewPair, pose: &Similarity, other: &Similarity) -> Result<(), Reason> {
    let keeps = gauge::keeps_size(pair, pose, other);
    keeps.then_some(()).ok_or_else(|| Reason::SizeRunsAway { times: gauge::growth(pair, pose, other).exp() })
}

/// A pose with the current t_z for an orthographic image, where it is a gauge that the loop has already set.
fn with_gauge_of(pair: &ViewPair, mut pose: Similarity, present: &Similarity) -> Similarity {
    if pair.image.camera.is_orthographic() {
        pose.translation.z = present.translation.z;
    }
    pose
}
