//! The registration stage: runs the finder or the matching of surfaces, as the options say, and keeps what it found.

use crate::estimator::finder::{Decision, Finder, Method, Staying, TrustRegion, explains};
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::solution::Solution;
use crate::light::Light;
use crate::options::{Registration, Start};
use crate::pose::{ContrastReport, OutlineReport, PhotometricReport, Similarity, Uncertainty};
use crate::reason::Reason;
use crate::view::Normals;

use super::colours::ColourRegistration;
use super::contrasted::Contrasted;
use super::light::Inputs;
use super::paint::PaintStage;
use super::surfaces::{Matched, SurfaceRegistration};

/// What a registration found: a pose, and what came with it.
pub struct Registered {
    pub pose: Similarity,
    /// Light, where it was found together with the pose.
    pub light: Option<Light>,
    /// Exposure, likewise.
    pub exposure: Option<f64>,
    /// None of a pose that never moved: what says nothing of the pose says nothing of its error.
    pub uncertainty: Option<Uncertainty>,
    /// Whether the pose is better than its start.
    pub improved: bool,
    /// Other poses that the data can't tell from it, where they were looked for.
    pub rivals: Option<Vec<Similarity>>,
}

impl Registered {
    /// A better pose, and nothing else.
    const fn of_pose(pose: Similarity) -> Self {
        Self { pose, light: None, exposure: None, uncertainty: None, improved: true, rivals: None }
    }

    fn by_outlines(found: &OutlineReport) -> Self {
        Self { uncertainty: Some(found.uncertainty.clone()), ..Self::of_pose(found.pose) }
    }
}

/// Registers the depth view to the image, by colours or by surfaces.
pub struct RegistrationStage {
    /// Only where the options ask for it: it holds splines of the image.
    colours: Option<ColourRegistration>,
    surfaces: SurfaceRegistration,
    /// Where the pose may be, if there is an initial one.
    region: Option<TrustRegion>,
    /// What the pose rests on, once the finder has decided.
    decided: Option<Decided>,
}

/// What the pose rests on.
enum Decided {
    Image,
    Contrast(Box<Contrasted>),
    Silhouettes(Box<OutlineReport>),
    /// Nothing better was found: the initial pose stays.
    Initial(Staying),
}

/// What a stage has come to.
pub enum Registering {
    Done(Option<Box<Registered>>),
    /// A pose has to be found first.
    Finding(Box<Finder>),
}

impl Registering {
    fn of(found: Option<Registered>) -> Self {
        Self::Done(found.map(Box::new))
    }
}

impl RegistrationStage {
    /// Without the registration by colours where `colours_wait` for the search to end; the finder makes it then.
    pub fn new(pair: &ViewPair, colours_wait: bool) -> Self {
        let by_colours = pair.options.start == Start::Search || pair.options.registration == Registration::Joint;
        let by_colours = by_colours && !colours_wait;
        Self {
            colours: by_colours.then(|| ColourRegistration::new(pair)),
            surfaces: SurfaceRegistration::new(),
            region: TrustRegion::of(pair),
            decided: None,
        }
    }

    /// The registration by colours, for a finder, which makes it where it is not there yet.
    pub const fn memory(&mut self) -> &mut Option<ColourRegistration> {
        &mut self.colours
    }

    /// The registration that this pair asks for now: noisy depth is found by its colours and settled by its surface.
    pub fn kind(&self, pair: &ViewPair) -> Registration {
        let settled_by_surface = |colours: &ColourRegistration| colours.is_coarse() && colours.found().is_some();
        match pair.options.registration {
            Registration::Joint if self.colours.as_ref().is_some_and(settled_by_surface) => Registration::Icp,
            asked => asked,
        }
    }

    /// What the registration by colours has found, where pose and light are its own to settle.
    pub fn found_by_colours(&self) -> Option<&PhotometricReport> {
        self.colours.as_ref().filter(|colours| !colours.is_coarse()).and_then(ColourRegistration::found)
    }

    /// The measured normals of the depth view, the best there are.
    pub fn measured_normals<'a>(&'a self, pair: &'a ViewPair) -> &'a Normals {
        self.colours.as_ref().map_or(&pair.depth.normals, ColourRegistration::normals)
    }

    /// Takes over what the finder has decided.
    ///
    /// # Errors
    /// Where nothing could be registered, or the size has run away from the initial pose's.
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
                let registered = Registered::by_outlines(&found);
                self.decided = Some(Decided::Silhouettes(found));
                registered
            }
            Method::Contrast(found) => {
                let pose = with_gauge_of(pair, found.pose, present);
                let uncertainty = Some(found.uncertainty.clone());
                self.decided = Some(Decided::Contrast(Box::new(Contrasted::new(*found))));
                Registered { uncertainty, ..Registered::of_pose(pose) }
            }
            Method::Image(found) => {
                self.decided = Some(Decided::Image);
                let registered = self.registered(pair, &found, present);
                let size = self.region.is_some().then(|| check_size(pair, &found.pose, present));
                if let Some(colours) = &mut self.colours {
                    colours.adopt(*found);
                }
                size.transpose()?;
                registered
            }
        };
        Ok(Some(Registered { rivals, ..registered }))
    }

    /// Whether the initial pose may be used, where it was kept because no pose near it fits the image better.
    pub const fn staying(&self) -> Option<Staying> {
        match self.decided {
            Some(Decided::Initial(staying)) => Some(staying),
            _ => None,
        }
    }

    /// What the pose rests on, in words.
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

    /// What outlines have found, where they decide.
    pub const fn found_by_outlines(&self) -> Option<&OutlineReport> {
        match &self.decided {
            Some(Decided::Silhouettes(found)) => Some(found),
            _ => None,
        }
    }

    /// What local contrast has found, where it decides.
    pub const fn found_by_contrast(&self) -> Option<&ContrastReport> {
        match &self.decided {
            Some(Decided::Contrast(found)) => Some(&found.report),
            _ => None,
        }
    }

    /// Whether the next registration will leave `pose` as it is, whatever the shapes become.
    pub fn keeps(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        match self.kind(pair) {
            Registration::Fixed => true,
            Registration::Joint => {
                let stands = match &self.decided {
                    Some(Decided::Initial(_) | Decided::Silhouettes(_)) => true,
                    Some(Decided::Contrast(found)) => found.stands(),
                    Some(Decided::Image) | None => false,
                };
                stands || self.colours.as_ref().is_some_and(|colours| colours.ended_in(pose))
            }
            Registration::Icp => false,
        }
    }

    /// Whether paint is looked for under `pose`: it stands, or waits for nothing but that.
    pub fn asks_for_paint(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        matches!(self.decided, Some(Decided::Contrast(_))) || self.keeps(pair, pose)
    }

    /// The pose from the present one, without the paint that was found under it; nothing where it is fixed. Around an initial pose that does
    /// not explain the image a finder has to be asked.
    pub fn register(
        &mut self,
        inputs: Inputs<'_>,
        paint: &PaintStage,
        solution: &Solution,
    ) -> Result<Registering, Reason> {
        let pair = inputs.pair;
        match self.kind(pair) {
            Registration::Fixed => Ok(Registering::Done(None)),
            Registration::Joint if self.region.is_some() && self.decided.is_none() => {
                self.register_initial(pair, &solution.pose)
            }
            Registration::Joint => self.register_colours(pair, paint, &solution.pose).map(Registering::of),
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

    /// From the initial pose: what explains the image from there is the answer, or else a finder looks around.
    fn register_initial(&mut self, pair: &ViewPair, present: &Similarity) -> Result<Registering, Reason> {
        let (Some(colours), Some(region)) = (&mut self.colours, &self.region) else {
            return Ok(Registering::Done(None));
        };
        let found = colours.register(pair, &region.initial).ok().cloned();
        let is_answer = |found: &PhotometricReport| region.holds(pair, &found.pose) && explains(pair, found);
        match found {
            Some(found) if is_answer(&found) => {
                self.adopt(pair, Decision::of(Method::Image(Box::new(found))), present).map(Registering::of)
            }
            _ => {
                let plain = colours.take_found();
                Ok(Registering::Finding(Box::new(Finder::near(pair, region.clone(), plain))))
            }
        }
    }

    /// Pose and light together from the colours, or the pose of what else decides.
    fn register_colours(
        &mut self,
        pair: &ViewPair,
        paint: &PaintStage,
        start: &Similarity,
    ) -> Result<Option<Registered>, Reason> {
        let Some(colours) = &mut self.colours else { return Ok(None) };
        match &mut self.decided {
            Some(Decided::Initial(_) | Decided::Silhouettes(_)) => Ok(None),
            Some(Decided::Contrast(found)) => {
                let pose = found.follow(pair, colours, paint, self.region.as_ref());
                Ok(pose.map(|pose| Registered::of_pose(with_gauge_of(pair, pose, start))))
            }
            Some(Decided::Image) | None => {
                let found = colours.register(pair, start)?.clone();
                check_size(pair, &found.pose, start)?;
                Ok(Some(self.registered(pair, &found, start)))
            }
        }
    }

    fn registered(&self, pair: &ViewPair, found: &PhotometricReport, present: &Similarity) -> Registered {
        let pose = with_gauge_of(pair, found.pose, present);
        // Normals that noise has flattened mislead about the exposure; the stages find it anew.
        let is_coarse = self.colours.as_ref().is_some_and(ColourRegistration::is_coarse);
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

/// The apparent size may not run away from that of another pose.
fn check_size(pair: &ViewPair, pose: &Similarity, other: &Similarity) -> Result<(), Reason> {
    let keeps = gauge::keeps_size(pair, pose, other);
    keeps.then_some(()).ok_or_else(|| Reason::SizeRunsAway { times: gauge::growth(pair, pose, other).exp() })
}

/// A pose with the present t_z before an orthographic image: there it is a gauge, which the loop has settled already.
fn with_gauge_of(pair: &ViewPair, mut pose: Similarity, present: &Similarity) -> Similarity {
    if pair.image.camera.is_orthographic() {
        pose.translation.z = present.translation.z;
    }
    pose
}
