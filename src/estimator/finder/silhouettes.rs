//! Silhouettes, used if the albedo varies behind a pinhole (docs/method/registration.md): near an initial pose, or
//! everywhere.

use crate::diagnosis::{Alternative, Diagnosis};
use crate::estimator::pair::ViewPair;
use crate::options::Registration;
use crate::pose::{
    Angles, PhotometricReport, PosePrior, SilhouetteProblem, SilhouetteRegistration, SilhouetteReport, Similarity,
};
use crate::view::Normals;

use super::initial_pose::{aligned_prior, centred};

/// A registration with fewer depth discontinuities, or a larger noise of their distances to the silhouette (pixels), is
/// ignored.
const FEWEST_DISCONTINUITIES: usize = 40;
const LARGEST_DISCONTINUITY_NOISE: f64 = 6.0;
/// Angles in degrees by which the starts are turned about y and x if there is no initial pose.
const TURNS: [f64; 3] = [0.0, -32.0, 32.0];
const TILTS: [f64; 3] = [0.0, -24.0, 24.0];
/// Sigma of the prior's rotation if no initial pose is given, degrees: both cameras look from roughly the same side.
pub const ANYWHERE_DEGREES: f64 = 25.0;

/// Whether the photometric residuals show varying albedo, so that silhouettes decide if they can.
pub fn has_varying_albedo(pair: &ViewPair, found: &PhotometricReport) -> bool {
    pair.residuals(found).diagnose(Alternative::Silhouettes) == Diagnosis::VaryingAlbedo
}

/// The pose near an initial one, if silhouettes fit it better.
pub fn near(pair: &ViewPair, normals: &Normals, initial: PosePrior) -> Option<SilhouetteReport> {
    let problem = SilhouetteProblem { image: &pair.image, depth: &pair.depth, normals, prior: initial };
    let mut registration = SilhouetteRegistration::new(&problem);
    let staying = registration.judge(&problem, &initial.pose).cost;
    let found = registration.register(&problem, &initial.pose);
    Some(found).filter(|found| is_seen(found) && found.cost < staying)
}

/// Evidence of the silhouettes for the pose found from them, less that for another one.
pub fn lead_near(
    pair: &ViewPair,
    normals: &Normals,
    initial: PosePrior,
    found: &SilhouetteReport,
    pose: &Similarity,
) -> f64 {
    let problem = SilhouetteProblem { image: &pair.image, depth: &pair.depth, normals, prior: initial };
    lead(&mut SilhouetteRegistration::new(&problem), &problem, found, pose)
}

/// The logarithm of the likelihood ratio of independent Gaussian errors, whose deviation is the noise at each pose. Both poses
/// are judged without an edge bias.
fn lead(
    registration: &mut SilhouetteRegistration,
    problem: &SilhouetteProblem<'_>,
    found: &SilhouetteReport,
    pose: &Similarity,
) -> f64 {
    let [own, other] = [&found.pose, pose].map(|pose| registration.judge(problem, pose));
    own.independent * (other.noise / own.noise).ln()
}

/// Whether silhouettes are tried if nothing is known about the pose; `found` is the best pose under a single albedo.
pub fn are_called_for(pair: &ViewPair, found: Option<&PhotometricReport>) -> bool {
    pair.options.registration == Registration::Joint && found.is_none_or(|found| has_varying_albedo(pair, found))
}

/// Finds the pose if nothing is known about it, in slices: the best of several rotations at the centre of the image's
/// object.
pub struct Anywhere {
    registration: SilhouetteRegistration,
    prior: PosePrior,
    /// The remaining starts, the next one last.
    starts: Vec<Similarity>,
    best: Option<SilhouetteReport>,
}

impl Anywhere {
    /// `None` if silhouettes constrain nothing.
    pub fn new(pair: &ViewPair, normals: &Normals) -> Option<Self> {
        let turned = |angles: Angles| centred(pair, angles.rotation());
        let prior = aligned_prior(pair, turned(Angles::default()), ANYWHERE_DEGREES)?;
        let starts = TURNS.into_iter().flat_map(|beta| TILTS.map(|alpha| turned(Angles { alpha, beta, gamma: 0.0 })));
        let mut starts: Vec<_> = starts.collect();
        starts.reverse();
        let registration =
            SilhouetteRegistration::new(&SilhouetteProblem { image: &pair.image, depth: &pair.depth, normals, prior });
        Some(Self { registration, prior, starts, best: None })
    }

    /// Registers from the next start; returns whether all are done.
    pub fn advance(&mut self, pair: &ViewPair, normals: &Normals) -> bool {
        let Some(start) = self.starts.pop() else { return true };
        let problem = SilhouetteProblem { image: &pair.image, depth: &pair.depth, normals, prior: self.prior };
        let found = self.registration.register(&problem, &start);
        // Among equals, the first stays.
        let is_better = |best: &SilhouetteReport| found.cost.total_cmp(&best.cost).is_lt();
        if is_seen(&found) && self.best.as_ref().is_none_or(is_better) {
            self.best = Some(found);
        }
        self.starts.is_empty()
    }

    /// As [`lead_near`], with the prior of this search.
    pub fn lead(&mut self, pair: &ViewPair, normals: &Normals, found: &SilhouetteReport, pose: &Similarity) -> f64 {
        let problem = SilhouetteProblem { image: &pair.image, depth: &pair.depth, normals, prior: self.prior };
        lead(&mut self.registration, &problem, found, pose)
    }

    /// The best registration so far that constrains the pose.
    pub fn best(&mut self) -> Option<SilhouetteReport> {
        self.best.take()
    }
}

fn is_seen(found: &SilhouetteReport) -> bool {
    found.discontinuities >= FEWEST_DISCONTINUITIES && found.noise <= LARGEST_DISCONTINUITY_NOISE
}
