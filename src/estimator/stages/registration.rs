//! The registration stage: runs the finder or matches the surfaces, depending on the options, and keeps the result.

use crate::estimator::finder::{Decision, Finder, Method, Staying, TrustRegion, explains};
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::PhotometricRegistration;
use crate::estimator::solution::Solution;
use crate::light::Light;
use crate::options::{Registration, Start};
use crate::pose::{PhotometricReport, SilhouetteReport, Similarity, Uncertainty};
use crate::reason::Reason;
use crate::view::Normals;

use super::albedo::AlbedoStage;
use super::contrasted::Contrasted;
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
    /// A better pose and nothing else.
    const fn of_pose(pose: Similarity) -> Self {
        Self { pose, light: None, exposure: None, uncertainty: None, improved: true, rivals: None }
    }

    fn by_silhouettes(found: &SilhouetteReport) -> Self {
        Self { uncertainty: Some(found.uncertainty.clone()), ..Self::of_pose(found.pose) }
    }
}

/// Registers the depth view to the image, photometrically or by matching surfaces.
pub struct RegistrationStage {
    /// Present only if the options require it, because it holds splines of the image.
    photometric: Option<PhotometricRegistration>,
    surfaces: SurfaceRegistration,
    /// Region around the initial pose, if there is one.
    region: Option<TrustRegion>,
    /// The result that determines the pose, once the finder has decided.
    decided: Option<Decided>,
}

/// The result that determines the pose.
pub enum Decided {
    Photometric,
    Contrast(Box<Contrasted>),
    Silhouettes(Box<SilhouetteReport>),
    /// No better pose was found; the initial pose stays.
    Initial(Staying),
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
            surfaces: SurfaceRegistration::new(),
            region: TrustRegion::of(pair),
            decided: None,
        }
    }

    /// The photometric registration, for a finder to use or to make.
    pub const fn memory(&mut self) -> &mut Option<PhotometricRegistration> {
        &mut self.photometric
    }

    /// The registration that this pair needs now: with noisy depth, photometric registration finds the pose and ICP settles it.
    pub fn kind(&self, pair: &ViewPair) -> Registration {
        let settled_by_surface =
            |photometric: &PhotometricRegistration| photometric.is_coarse() && photometric.found().is_some();
        match pair.options.registration {
            Registration::Joint if self.photometric.as_ref().is_some_and(settled_by_surface) => Registration::Icp,
            asked => asked,
        }
    }

    /// Result of the photometric registration, unless depth noise leaves pose and light to other stages.
    pub fn found_photometrically(&self) -> Option<&PhotometricReport> {
        self.photometric
            .as_ref()
            .filter(|photometric| !photometric.is_coarse())
            .and_then(PhotometricRegistration::found)
    }

    /// The best measured normals of the depth view.
    pub fn measured_normals<'a>(&'a self, pair: &'a ViewPair) -> &'a Normals {
        self.photometric.as_ref().map_or(&pair.depth.normals, PhotometricRegistration::normals)
    }

    /// Adopts the finder's decision.
    ///
    /// # Errors
    /// [`Reason::NoPose`] if nothing could be registered, [`Reason::SizeRunsAway`] if the size departs from the initial
    /// pose's.
    pub fn adopt(
        &mut self,
        pair: &ViewPair,
        decision: Decision,
        present: &Similarity,
    ) -> Result<Option<Registered>, Reason> {
        let Decision { by, rivals } = decision;
        let registered = match by {
            Method::Nothing => return Err(Reason::NoPose { scale_is_held: gauge::held_scale(pair).is_some() }),
            Method::Initial(staying) => {
                self.decided = Some(Decided::Initial(staying));
                return Ok(None);
            }
            Method::Silhouettes(found) => {
                let registered = Registered::by_silhouettes(&found);
                self.decided = Some(Decided::Silhouettes(found));
                registered
            }
            Method::Contrast(found) => {
                let pose = with_gauge_of(pair, found.pose, present);
                let uncertainty = Some(found.uncertainty.clone());
                self.decided = Some(Decided::Contrast(Box::new(Contrasted::new(*found))));
                Registered { uncertainty, ..Registered::of_pose(pose) }
            }
            Method::Photometric(found) => {
                self.decided = Some(Decided::Photometric);
                let registered = self.registered(pair, &found, present);
                let size = self.region.is_some().then(|| check_size(pair, &found.pose, present));
                if let Some(photometric) = &mut self.photometric {
                    photometric.adopt(*found);
                }
                size.transpose()?;
                registered
            }
        };
        Ok(Some(Registered { rivals, ..registered }))
    }

    /// What the pose rests on, once the finder has decided.
    pub const fn decided(&self) -> Option<&Decided> {
        self.decided.as_ref()
    }

    /// Names the kind of registration that determined the pose.
    pub fn engine(&self, pair: &ViewPair) -> &'static str {
        match (self.kind(pair), &self.decided) {
            (Registration::Fixed, _) => "held pose",
            (Registration::Icp, _) => "surfaces",
            (Registration::Joint, Some(Decided::Initial(_))) => "initial pose kept",
            (Registration::Joint, Some(Decided::Silhouettes(_))) => "silhouettes",
            (Registration::Joint, Some(Decided::Contrast(_))) => "local contrast",
            (Registration::Joint, _) => "photometric registration",
        }
    }

    /// Whether the next registration will leave `pose` unchanged, whatever the shapes become.
    pub fn keeps(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        match self.kind(pair) {
            Registration::Fixed => true,
            Registration::Joint => {
                let stands = match &self.decided {
                    Some(Decided::Initial(_) | Decided::Silhouettes(_)) => true,
                    Some(Decided::Contrast(found)) => found.stands(),
                    Some(Decided::Photometric) | None => false,
                };
                stands || self.photometric.as_ref().is_some_and(|photometric| photometric.ended_in(pose))
            }
            Registration::Icp => false,
        }
    }

    /// Whether the albedo is to be fitted under `pose`: the pose has settled, or waits only for the albedo.
    pub fn requires_albedo(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        matches!(self.decided, Some(Decided::Contrast(_))) || self.keeps(pair, pose)
    }

    /// Registers from the current pose, without the albedo found under it; finds nothing if the pose is fixed. If an
    /// initial pose does not explain the image, a finder is required.
    pub fn register(
        &mut self,
        inputs: Inputs<'_>,
        albedo: &AlbedoStage,
        solution: &Solution,
    ) -> Result<Registering, Reason> {
        let pair = inputs.pair;
        match self.kind(pair) {
            Registration::Fixed => Ok(Registering::Done(None)),
            Registration::Joint if self.region.is_some() && self.decided.is_none() => {
                self.register_initial(pair, &solution.pose)
            }
            Registration::Joint => self.register_photometrically(pair, albedo, &solution.pose).map(Registering::of),
            Registration::Icp => {
                let Matched { mut pose, mut improved, uncertainty } = self.surfaces.register(inputs, solution)?;
                if self.region.as_ref().is_some_and(|region| !region.holds(pair, &pose)) {
                    (pose, improved) = (solution.pose, false);
                }
                let uncertainty = improved.then_some(uncertainty);
                let found = Registered { pose, light: None, exposure: None, uncertainty, improved, rivals: None };
                Ok(Registering::of(Some(found)))
            }
        }
    }

    /// Registers from the initial pose. A result that explains the image is the answer; otherwise a finder searches
    /// around it.
    fn register_initial(&mut self, pair: &ViewPair, present: &Similarity) -> Result<Registering, Reason> {
        let (Some(photometric), Some(region)) = (&mut self.photometric, &self.region) else {
            return Ok(Registering::Done(None));
        };
        let found = photometric.register(pair, &region.initial).ok().cloned();
        let is_answer = |found: &PhotometricReport| region.holds(pair, &found.pose) && explains(pair, found);
        match found {
            Some(found) if is_answer(&found) => {
                self.adopt(pair, Decision::of(Method::Photometric(Box::new(found))), present).map(Registering::of)
            }
            _ => {
                let plain = photometric.take_found();
                Ok(Registering::Finding(Box::new(Finder::near(pair, region.clone(), plain))))
            }
        }
    }

    /// Finds pose and light together photometrically, or keeps the pose of the method that decided.
    fn register_photometrically(
        &mut self,
        pair: &ViewPair,
        albedo: &AlbedoStage,
        start: &Similarity,
    ) -> Result<Option<Registered>, Reason> {
        let Some(photometric) = &mut self.photometric else { return Ok(None) };
        match &mut self.decided {
            Some(Decided::Initial(_) | Decided::Silhouettes(_)) => Ok(None),
            Some(Decided::Contrast(found)) => {
                let pose = found.follow(pair, photometric, albedo, self.region.as_ref());
                Ok(pose.map(|pose| Registered::of_pose(with_gauge_of(pair, pose, start))))
            }
            Some(Decided::Photometric) | None => {
                let found = photometric.register(pair, start)?.clone();
                check_size(pair, &found.pose, start)?;
                Ok(Some(self.registered(pair, &found, start)))
            }
        }
    }

    fn registered(&self, pair: &ViewPair, found: &PhotometricReport, present: &Similarity) -> Registered {
        let pose = with_gauge_of(pair, found.pose, present);
        // Normals flattened by noise bias the exposure, so the stages find it again.
        let is_coarse = self.photometric.as_ref().is_some_and(PhotometricRegistration::is_coarse);
        Registered {
            pose,
            light: Some(found.light),
            exposure: (!is_coarse).then_some(found.exposure),
            uncertainty: Some(found.uncertainty.clone()),
            improved: true,
            rivals: None,
        }
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
