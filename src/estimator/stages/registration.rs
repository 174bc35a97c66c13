//! The registration stage: which of the two registrations a pair asks for, and what it found.

use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::solution::Solution;
use crate::light::Light;
use crate::options::{Registration, Start};
use crate::pose::{ContrastOutcome, ContrastReport, OutlineReport, PhotometricReport, Similarity, Uncertainty};
use crate::reason::Reason;
use crate::view::Normals;

use super::colours::ColourRegistration;
use super::contrasted::Contrasted;
use super::light::Inputs;
use super::outlines;
use super::paint::PaintStage;
use super::surfaces::{Matched, SurfaceRegistration};
use super::told_start::{Settled, TrustRegion};

/// What the initialisation found.
#[derive(Default)]
pub struct Outcome {
    /// The best pose by colours, if any could be registered.
    pub best: Option<Box<PhotometricReport>>,
    /// Poses that the data can't tell from the best, best first.
    pub rivals: Vec<Similarity>,
    /// What local contrast says, where the colours are painted.
    pub contrast: Option<Box<ContrastOutcome>>,
}

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
    told: Told,
}

/// What is known of a told start.
enum Told {
    /// The pose is free: nothing was told, or the registration is the paper's own, which walks as far as it likes.
    Nothing,
    Untried(TrustRegion),
    /// A better pose within the tolerance was found.
    Improved(TrustRegion),
    /// None was: the told pose is kept.
    Kept,
    /// The colours are painted; the pose is that of the outlines ..
    Outlined(OutlineReport),
    /// .. or that of local contrast.
    Contrasted(Contrasted),
}

impl RegistrationStage {
    /// Without the registration by colours where `colours_wait` for the search to end: [`prepare`](Self::prepare).
    pub fn new(pair: &ViewPair, colours_wait: bool) -> Self {
        let by_colours = pair.options.start == Start::Search || pair.options.registration == Registration::Joint;
        let by_colours = by_colours && !colours_wait;
        let is_joint = pair.options.registration == Registration::Joint;
        let region = is_joint.then(|| TrustRegion::new(pair)).flatten();
        Self {
            colours: by_colours.then(|| ColourRegistration::new(pair)),
            surfaces: SurfaceRegistration::new(),
            told: region.map_or(Told::Nothing, Told::Untried),
        }
    }

    /// The registration by colours, made now where it is not there yet.
    #[inline(never)]
    pub fn prepare(&mut self, pair: &ViewPair) -> &mut ColourRegistration {
        self.colours.get_or_insert_with(|| ColourRegistration::new(pair))
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

    /// How many times as deep relief would have to be for colours that it does not explain otherwise.
    pub fn better_unit(&mut self, pair: &ViewPair, pose: &Similarity) -> Option<f32> {
        let colours = self.colours.as_mut().filter(|_| pair.options.registration == Registration::Joint);
        colours.and_then(|colours| colours.better_unit(pair, pose))
    }

    /// Takes over what the search has found, if anything; what contrast or outlines say where the colours are painted.
    pub fn adopt(&mut self, pair: &ViewPair, outcome: Outcome, present: &Similarity) -> Option<Registered> {
        let Outcome { best, rivals, contrast } = outcome;
        if let Some(contrast) = contrast {
            return Some(self.adopt_contrast(pair, *contrast, None, present));
        }
        let registered = self.adopt_colours(pair, best.map(|best| *best), present)?;
        let rivals = if self.found_by_outlines().is_some() { Vec::new() } else { rivals };
        Some(Registered { rivals: Some(rivals), ..registered })
    }

    fn adopt_contrast(
        &mut self,
        pair: &ViewPair,
        found: ContrastOutcome,
        region: Option<TrustRegion>,
        present: &Similarity,
    ) -> Registered {
        let ContrastOutcome { best, rivals } = found;
        let (pose, uncertainty) = (with_gauge_of(pair, best.pose, present), Some(best.uncertainty.clone()));
        self.told = Told::Contrasted(Contrasted::new(best, region));
        Registered { uncertainty, rivals: Some(rivals), ..Registered::of_pose(pose) }
    }

    fn adopt_colours(
        &mut self,
        pair: &ViewPair,
        found: Option<PhotometricReport>,
        present: &Similarity,
    ) -> Option<Registered> {
        let is_painted = found.as_ref().is_none_or(|found| outlines::is_painted(pair, found));
        if is_painted
            && pair.options.registration == Registration::Joint
            && let Some(outlined) = outlines::anywhere(pair, self.colours.as_ref()?.normals())
        {
            let registered = Registered::by_outlines(&outlined);
            self.told = Told::Outlined(outlined);
            return Some(registered);
        }
        let found = found?;
        let registered = self.registered(pair, &found, present);
        if let Some(colours) = &mut self.colours {
            colours.adopt(found);
        }
        Some(registered)
    }

    /// Whether nothing near a told start explains the colours better, so that it is kept.
    pub const fn has_kept_start(&self) -> bool {
        matches!(self.told, Told::Kept)
    }

    /// What the pose rests on, in words.
    pub fn engine(&self, pair: &ViewPair) -> &'static str {
        match (self.kind(pair), &self.told) {
            (Registration::Fixed, _) => "held pose",
            (Registration::Icp, _) => "surfaces",
            (Registration::Joint, Told::Kept) => "initial pose kept",
            (Registration::Joint, Told::Outlined(_)) => "silhouettes",
            (Registration::Joint, Told::Contrasted(_)) => "local contrast",
            (Registration::Joint, _) => "photometric registration",
        }
    }

    /// What outlines have found, where they decide.
    pub const fn found_by_outlines(&self) -> Option<&OutlineReport> {
        match &self.told {
            Told::Outlined(found) => Some(found),
            _ => None,
        }
    }

    /// What local contrast has found, where it decides.
    pub const fn found_by_contrast(&self) -> Option<&ContrastReport> {
        match &self.told {
            Told::Contrasted(found) => Some(&found.report),
            _ => None,
        }
    }

    /// Whether the next registration will leave `pose` as it is, whatever the shapes become.
    pub fn keeps(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        match self.kind(pair) {
            Registration::Fixed => true,
            Registration::Joint => {
                let stands = match &self.told {
                    Told::Kept | Told::Outlined(_) => true,
                    Told::Contrasted(found) => found.stands(),
                    _ => false,
                };
                stands || self.colours.as_ref().is_some_and(|colours| colours.ended_in(pose))
            }
            Registration::Icp => false,
        }
    }

    /// Whether paint is looked for under `pose`: it stands, or waits for nothing but that.
    pub fn asks_for_paint(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        matches!(self.told, Told::Contrasted(_)) || self.keeps(pair, pose)
    }

    /// The pose from the present one, without the paint that was found under it; nothing where it is fixed.
    pub fn register(
        &mut self,
        inputs: Inputs<'_>,
        paint: &PaintStage,
        solution: &Solution,
    ) -> Result<Option<Registered>, Reason> {
        match self.kind(inputs.pair) {
            Registration::Fixed => Ok(None),
            Registration::Joint => self.register_colours(inputs.pair, paint, &solution.pose),
            Registration::Icp => {
                let Matched { mut pose, mut improved, uncertainty } = self.surfaces.register(inputs, solution)?;
                if let Told::Improved(region) = &self.told
                    && !region.holds(inputs.pair, &pose)
                {
                    (pose, improved) = (solution.pose, false);
                }
                let uncertainty = improved.then_some(uncertainty);
                Ok(Some(Registered { pose, light: None, exposure: None, uncertainty, improved, rivals: None }))
            }
        }
    }

    /// Pose and light together from the colours.
    fn register_colours(
        &mut self,
        pair: &ViewPair,
        paint: &PaintStage,
        start: &Similarity,
    ) -> Result<Option<Registered>, Reason> {
        let Some(colours) = &mut self.colours else { return Ok(None) };
        let found = match std::mem::replace(&mut self.told, Told::Kept) {
            told @ (Told::Kept | Told::Outlined(_)) => {
                self.told = told;
                return Ok(None);
            }
            Told::Contrasted(mut found) => {
                let pose = found.follow(pair, colours, paint);
                self.told = Told::Contrasted(found);
                return Ok(pose.map(|pose| Registered::of_pose(with_gauge_of(pair, pose, start))));
            }
            Told::Untried(region) => match region.settle(pair, colours)? {
                Settled::ByColours(found) => {
                    self.told = Told::Improved(region);
                    *found
                }
                Settled::ByOutlines(found) => {
                    let registered = Registered::by_outlines(&found);
                    self.told = Told::Outlined(*found);
                    return Ok(Some(registered));
                }
                Settled::ByContrast(found) => {
                    return Ok(Some(self.adopt_contrast(pair, *found, Some(region), start)));
                }
                // As it stands since the replacement above.
                Settled::Kept => return Ok(None),
            },
            told => {
                self.told = told;
                colours.register(pair, start)?.clone()
            }
        };
        if !gauge::keeps_size(pair, &found.pose, start) {
            return Err(Reason::SizeRunsAway { times: gauge::growth(pair, &found.pose, start).exp() });
        }
        Ok(Some(self.registered(pair, &found, start)))
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

/// A pose with the present t_z before an orthographic image: there it is a gauge, which the loop has settled already.
fn with_gauge_of(pair: &ViewPair, mut pose: Similarity, present: &Similarity) -> Similarity {
    if pair.image.camera.is_orthographic() {
        pose.translation.z = present.translation.z;
    }
    pose
}
