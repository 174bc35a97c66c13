//! A start that is told: believed within a tolerance, and searched around (docs/method.md, section 10).
//!
//! Objective: the gain of `local_optima` over the poses within the tolerance, the told one among them. Method, each step
//! only where those before it have not explained the colours: (1) the registration from the told pose; (2) from its
//! rotation, moved to where the projected cloud fits mask and colours, for a calibration that is turned about the sensor
//! moves the object by an eighth of its size with each degree, and the registration's basin is one of translation; (3)
//! from the best of a search over the rotations within the tolerance, which turn about the object's middle. Where
//! nothing within the tolerance explains the colours better than staying does, the told pose is kept.
//!
//! Limits: where the view's frame is not shared and no translation is told, only the rotation is believed; outlines then look
//! for the place from where the middles of both views meet.

use nalgebra::Vector3;

use super::colours::ColourRegistration;
use super::outlines;
use super::painted::{self, Conclusion};
use crate::diagnosis::{Alternative, Diagnosis};
use crate::error::Result;
use crate::estimator::gauge;
use crate::estimator::local_optima::LocalOptima;
use crate::estimator::pair::ViewPair;
use crate::estimator::workers::task::RegisteredCandidate;
use crate::options::Start;
use crate::pose::{
    ContrastOutcome, ImageGrid, OutlinePrior, OutlineReport, PhotometricReport, Search, SearchProblem, Similarity,
};

/// Tolerance of the object's place where none is stated, in object sizes (root mean square distance of its points from
/// their middle): the object's own width, more or less, and as far as a turn by 8 degrees about a sensor moves what is 0.2
/// m high at 0.8 m, a slim vase included.
const OBJECT_SIZES: f64 = 3.0;
/// One sigma of what is told as a share of its tolerance: of the rotation, and of the object's place across and along the
/// line of sight. For a mug at 0.8 m 3 degrees, 45 and 25 mm.
const SIGMA_OF_DEGREES: f64 = 0.1;
const SIGMA_ACROSS: f64 = 0.4;
const SIGMA_ALONG: f64 = 0.22;
/// Candidates of the search around that are registered at most.
const MOST_TRIED: usize = 12;
/// Number of the told pose among the candidates: none of the others has it.
const STAYING: usize = usize::MAX;

/// A told pose, and how far from it the answer may lie.
pub struct TrustRegion {
    told: Similarity,
    /// Middle of the depth points, in their own frame.
    middle: Vector3<f64>,
    degrees: f64,
    /// Of the middle, in units of the colour view; infinite where no translation is told.
    distance: f64,
    /// Whether the image sees distances.
    sees_depth: bool,
}

/// What became of a told start.
pub enum Settled {
    ByColours(Box<PhotometricReport>),
    /// The colours are painted: outlines decide ..
    ByOutlines(Box<OutlineReport>),
    /// .. or local contrast.
    ByContrast(Box<ContrastOutcome>),
    /// Nothing better within the tolerance.
    Kept,
}

impl TrustRegion {
    /// Of a pair whose start is told.
    pub fn new(pair: &ViewPair) -> Option<Self> {
        let is_placed = match pair.options.start {
            Start::Search => return None,
            Start::Identity => gauge::shares_frame(pair),
            Start::Pose { translation, .. } => translation.is_some(),
        };
        let told = gauge::first_pose(pair);
        let middle = pair.depth.points.centroid();
        let tolerance = pair.options.start_tolerance;
        let own_width = || OBJECT_SIZES * told.scale * spread(pair, &middle);
        let distance = if is_placed { tolerance.distance.unwrap_or_else(own_width) } else { f64::INFINITY };
        Some(Self {
            told,
            middle,
            degrees: tolerance.degrees,
            distance,
            sees_depth: !pair.image.camera.is_orthographic(),
        })
    }

    /// Whether a pose lies within the tolerance, and leaves the object its size.
    pub fn holds(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        let mut moved = pose.apply(self.middle) - self.told.apply(self.middle);
        if !self.sees_depth {
            moved.z = 0.0;
        }
        pose.degrees_to(&self.told) <= self.degrees
            && moved.norm() <= self.distance
            && gauge::keeps_size(pair, pose, &self.told)
    }

    /// The best pose within the tolerance.
    ///
    /// # Errors
    /// Those of the search, where the views allow none.
    pub fn settle(&self, pair: &ViewPair, colours: &mut ColourRegistration) -> Result<Settled> {
        if let Ok(found) = colours.register(pair, &self.told)
            && self.holds(pair, &found.pose)
            && explains(pair, found)
        {
            return Ok(Settled::ByColours(Box::new(found.clone())));
        }
        let plain = colours.take_found().map(Box::new).filter(|found| self.holds(pair, &found.pose));
        let noisy = plain.as_deref().filter(|found| pair.residuals(found).is_noise()).map(|found| found.pose);
        let mut optima = LocalOptima::new(MOST_TRIED + 4, pair.residuals_of_noise(0.0));
        if let Some(staying) = colours.judge(pair, &self.told) {
            optima.enter(STAYING, RegisteredCandidate::of(staying));
        }
        if let Some(plain) = plain {
            optima.enter(0, RegisteredCandidate::of(plain));
        }
        let outlined = self.by_outlines(pair, colours);
        let is_explained =
            outlined.as_ref().is_some_and(|found| self.try_from(pair, colours, &mut optima, (1, &found.pose)));
        if !is_explained {
            self.search_around(pair, colours, &mut optima)?;
        }
        let best =
            optima.decide().best.filter(|best| best.candidate != STAYING).and_then(|best| best.registered.report);
        if let Some(cleaned) = painted::cleaned(pair, colours, best.as_deref())
            && let Some(found) = painted::near(pair, colours, &cleaned, &self.told)
        {
            match found {
                Conclusion::ByColours(found) if self.holds(pair, &found.pose) => {
                    colours.adopt((*found).clone());
                    return Ok(Settled::ByColours(found));
                }
                Conclusion::ByContrast(mut found) if self.holds(pair, &found.best.pose) => {
                    // What leaves no more than the image's own noise is a rival, however much of it neighbours share.
                    painted::rival(&mut found, noisy);
                    return Ok(Settled::ByContrast(found));
                }
                _ => {}
            }
        }
        match (best, outlined) {
            (Some(best), outlined) if !outlines::is_painted(pair, &best) || outlined.is_none() => {
                self.by_all_points(pair, colours, *best)
            }
            (_, Some(outlined)) => Ok(Settled::ByOutlines(Box::new(outlined))),
            (..) => Ok(Settled::Kept),
        }
    }

    /// All points follow the sample that candidates are registered by.
    fn by_all_points(
        &self,
        pair: &ViewPair,
        colours: &mut ColourRegistration,
        best: PhotometricReport,
    ) -> Result<Settled> {
        let pose = best.pose;
        colours.adopt(best);
        let found = colours.register(pair, &pose)?.clone();
        if self.holds(pair, &found.pose) {
            return Ok(Settled::ByColours(Box::new(found)));
        }
        colours.take_found();
        Ok(Settled::Kept)
    }

    /// The pose by outlines, where intrinsics tell of the whole frame, enough is seen of them and they like it better
    /// than the told one.
    fn by_outlines(&self, pair: &ViewPair, colours: &ColourRegistration) -> Option<OutlineReport> {
        let degrees = SIGMA_OF_DEGREES * self.degrees;
        let (across, along) = (SIGMA_ACROSS * self.distance, SIGMA_ALONG * self.distance);
        let told = if self.distance.is_infinite() {
            outlines::placed_by_middles(pair, self.told, degrees)?
        } else if self.sees_depth {
            OutlinePrior { pose: self.told, rotation: degrees.to_radians(), across, along }
        } else {
            return None;
        };
        outlines::near(pair, colours.normals(), told).filter(|found| self.holds(pair, &found.pose))
    }

    /// Registers from where mask, colours and projected cloud agree at the told rotation, then from the best of a search
    /// over the rotations within the tolerance.
    fn search_around(&self, pair: &ViewPair, colours: &mut ColourRegistration, optima: &mut LocalOptima) -> Result<()> {
        let mut search = Search::with_grid(&self.problem(pair, colours), ImageGrid::new(&pair.image)?)?;
        search.narrow(&self.told, self.degrees);
        let shifted = search.shifted(&self.told.rotation);
        if shifted.is_some_and(|start| self.try_from(pair, colours, optima, (2, &start))) {
            return Ok(());
        }
        while search.progress().share < 1.0 {
            search.advance();
        }
        let mut tried = 0;
        for (index, candidate) in search.candidates().iter().enumerate() {
            if tried < MOST_TRIED && !optima.is_known(&candidate.pose) {
                tried += 1;
                self.try_from(pair, colours, optima, (index + 3, &candidate.pose));
            }
        }
        Ok(())
    }

    fn problem<'a>(&self, pair: &'a ViewPair, colours: &'a ColourRegistration) -> SearchProblem<'a> {
        SearchProblem {
            image: &pair.image,
            depth: &pair.depth,
            normals: colours.normals(),
            light: pair.known_light(),
            scale: gauge::held_scale(pair),
            unit_scale: self.told.scale,
            seed: pair.options.seed,
        }
    }

    /// Registers a candidate and enters where it ends within the tolerance; whether that explains the colours.
    fn try_from(
        &self,
        pair: &ViewPair,
        colours: &mut ColourRegistration,
        optima: &mut LocalOptima,
        (candidate, start): (usize, &Similarity),
    ) -> bool {
        let found = colours.register_candidate(pair, start).filter(|found| self.holds(pair, &found.pose));
        found.is_some_and(|found| {
            let is_explained = explains(pair, &found);
            optima.enter(candidate, RegisteredCandidate::of(found));
            is_explained
        })
    }
}

/// Whether a pose explains the colours: fine print is noise to an image, but not to neighbours.
fn explains(pair: &ViewPair, found: &PhotometricReport) -> bool {
    pair.residuals(found).diagnose(Alternative::Silhouettes) == Diagnosis::Explained
}

/// Root mean square distance of the depth points from their middle.
fn spread(pair: &ViewPair, middle: &Vector3<f64>) -> f64 {
    let points = &pair.depth.points;
    let (mut sum, mut count) = (0.0, 0.0);
    for index in (0..points.len()).filter(|&index| points.is_valid(index)) {
        sum += (Vector3::from(points.get(index).map(f64::from)) - middle).norm_squared();
        count += 1.0;
    }
    (sum / f64::max(count, 1.0)).sqrt()
}
