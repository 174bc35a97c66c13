//! The registration stage: which of the two registrations a pair asks for, and what it found.

use crate::error::{Error, ErrorKind, Result};
use crate::estimator::pair::ViewPair;
use crate::estimator::solution::Solution;
use crate::light::Light;
use crate::options::{Registration, Start};
use crate::pose::{PhotometricReport, Similarity, Uncertainty};
use crate::view::Normals;

use super::colours::ColourRegistration;
use super::light::Inputs;
use super::surfaces::{Matched, SurfaceRegistration};

/// Growth of the scale beyond which, or below whose inverse, a registration has collapsed: shrunk onto a few pixels a
/// cloud is easily explained. The search looks from 0.7 to 1.4.
const LARGEST_GROWTH: f64 = 2.0;

/// What a registration found: a pose, and what came with it.
pub struct Registered {
    pub pose: Similarity,
    /// Light, where it was found together with the pose.
    pub light: Option<Light>,
    /// Exposure, likewise.
    pub exposure: Option<f64>,
    pub uncertainty: Uncertainty,
    /// Whether the pose is better than its start.
    pub improved: bool,
}

/// Registers the depth view to the image, by colours or by surfaces.
pub struct RegistrationStage {
    /// Only where the options ask for it: it holds splines of the image.
    colours: Option<ColourRegistration>,
    surfaces: SurfaceRegistration,
}

impl RegistrationStage {
    pub fn new(pair: &ViewPair) -> Self {
        let by_colours = pair.options.start == Start::Search || pair.options.registration == Registration::Joint;
        Self { colours: by_colours.then(|| ColourRegistration::new(pair)), surfaces: SurfaceRegistration::new() }
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

    /// The registration by colours, for the search.
    pub fn colours(&mut self) -> Option<&mut ColourRegistration> {
        self.colours.as_mut()
    }

    /// Takes over what the search has found.
    pub fn adopt(&mut self, pair: &ViewPair, found: PhotometricReport, present: &Similarity) -> Registered {
        let registered = self.registered(pair, &found, present);
        if let Some(colours) = &mut self.colours {
            colours.adopt(found);
        }
        registered
    }

    /// Whether the next registration will leave `pose` as it is, whatever the shapes become.
    pub fn keeps(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        match self.kind(pair) {
            Registration::Fixed => true,
            Registration::Joint => self.colours.as_ref().is_some_and(|colours| colours.ended_in(pose)),
            Registration::Icp => false,
        }
    }

    /// The pose from the present one; nothing where it is fixed.
    pub fn register(&mut self, inputs: Inputs<'_>, solution: &Solution) -> Result<Option<Registered>> {
        match self.kind(inputs.pair) {
            Registration::Fixed => Ok(None),
            Registration::Joint => self.register_colours(inputs.pair, &solution.pose),
            Registration::Icp => {
                let Matched { pose, improved, uncertainty } = self.surfaces.register(inputs, solution)?;
                Ok(Some(Registered { pose, light: None, exposure: None, uncertainty, improved }))
            }
        }
    }

    /// Pose and light together from the colours.
    fn register_colours(&mut self, pair: &ViewPair, start: &Similarity) -> Result<Option<Registered>> {
        let Some(colours) = &mut self.colours else { return Ok(None) };
        let found = colours.register(pair, start)?.clone();
        if found.pose.growth_from(start) > LARGEST_GROWTH.ln() {
            let message = "the colours pull the scale away from the start's: their ratio must stay between 0.5 and 2";
            let ratio = found.pose.scale / start.scale;
            return Err(Error::new(ErrorKind::Degenerate, "start", message).value(ratio));
        }
        Ok(Some(self.registered(pair, &found, start)))
    }

    fn registered(&self, pair: &ViewPair, found: &PhotometricReport, present: &Similarity) -> Registered {
        let mut pose = found.pose;
        // t_z of an orthographic image is a gauge, which the loop has settled already.
        if pair.image.camera.is_orthographic() {
            pose.translation.z = present.translation.z;
        }
        // Normals that noise has flattened mislead about the exposure; the stages find it anew.
        let is_coarse = self.colours.as_ref().is_some_and(ColourRegistration::is_coarse);
        Registered {
            pose,
            light: Some(found.light),
            exposure: (!is_coarse).then_some(found.exposure),
            uncertainty: found.uncertainty.clone(),
            improved: true,
        }
    }
}
