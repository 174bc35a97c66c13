//! Silhouettes, where the albedo varies behind a pinhole (docs/method/registration.md): near an initial pose, or from anywhere.

use crate::diagnosis::{Alternative, Diagnosis};
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::options::Registration;
use crate::pose::{Angles, Outline, OutlineProblem, OutlineReport, PhotometricReport, PosePrior, Similarity};
use crate::view::Normals;

/// Outlines of fewer points, or that are farther from the image's in the median, tell nothing; pixels.
const FEWEST_RIMS: usize = 40;
const LARGEST_RIM_NOISE: f64 = 6.0;
/// Where nothing is told, starts are turned by so many degrees about y and x: from all of them the captures that see their
/// rotation at all end in one place.
const TURNS: [f64; 3] = [0.0, -32.0, 32.0];
const TILTS: [f64; 3] = [0.0, -24.0, 24.0];
/// One sigma of the pose where nothing is told: cameras look from one side by and large. Degrees, and shares of the
/// distance.
const ANYWHERE_DEGREES: f64 = 25.0;
const ANYWHERE_ACROSS: f64 = 0.12;
const ANYWHERE_ALONG: f64 = 0.08;

/// Whether what the colours leave is paint: then outlines decide where there are any.
pub fn is_painted(pair: &ViewPair, found: &PhotometricReport) -> bool {
    pair.residuals(found).diagnose(Alternative::Silhouettes) == Diagnosis::VaryingAlbedo
}

/// The pose near a told one, where outlines like it better.
pub fn near(pair: &ViewPair, normals: &Normals, told: PosePrior) -> Option<OutlineReport> {
    let problem = OutlineProblem { image: &pair.image, depth: &pair.depth, normals, prior: told };
    let mut outline = Outline::new(&problem);
    let staying = outline.judge(&problem, &told.pose).cost;
    let found = outline.register(&problem, &told.pose);
    Some(found).filter(|found| is_seen(found) && found.cost < staying)
}

/// Whether silhouettes decide where nothing is known of the pose, unless they tell nothing: `found` is the best by a single albedo.
pub fn are_called_for(pair: &ViewPair, found: Option<&PhotometricReport>) -> bool {
    pair.options.registration == Registration::Joint && found.is_none_or(|found| is_painted(pair, found))
}

/// The pose where nothing is known of it, in slices: the best from several rotations at the middle of the image's object.
pub struct Anywhere {
    outline: Outline,
    prior: PosePrior,
    /// Those that are left, the next one last.
    starts: Vec<Similarity>,
    best: Option<OutlineReport>,
}

impl Anywhere {
    /// `None` where silhouettes tell nothing.
    pub fn new(pair: &ViewPair, normals: &Normals) -> Option<Self> {
        let turned = |angles: Angles| gauge::centred(pair, angles.rotation());
        let prior = placed_by_middles(pair, turned(Angles::default()), ANYWHERE_DEGREES)?;
        let starts = TURNS.into_iter().flat_map(|beta| TILTS.map(|alpha| turned(Angles { alpha, beta, gamma: 0.0 })));
        let mut starts: Vec<_> = starts.collect();
        starts.reverse();
        let outline = Outline::new(&OutlineProblem { image: &pair.image, depth: &pair.depth, normals, prior });
        Some(Self { outline, prior, starts, best: None })
    }

    /// The registration from the next start; whether all are done.
    pub fn advance(&mut self, pair: &ViewPair, normals: &Normals) -> bool {
        let Some(start) = self.starts.pop() else { return true };
        let problem = OutlineProblem { image: &pair.image, depth: &pair.depth, normals, prior: self.prior };
        let found = self.outline.register(&problem, &start);
        // The first of equals stays.
        let is_better = |best: &OutlineReport| found.cost.total_cmp(&best.cost).is_lt();
        if is_seen(&found) && self.best.as_ref().is_none_or(is_better) {
            self.best = Some(found);
        }
        self.starts.is_empty()
    }

    /// The best so far that tells anything.
    pub fn best(&mut self) -> Option<OutlineReport> {
        self.best.take()
    }
}

/// What is known where no place is told: the pose, which puts the middle of the depth points on that of the image's object,
/// with this sigma of its rotation, degrees.
pub fn placed_by_middles(pair: &ViewPair, pose: Similarity, degrees: f64) -> Option<PosePrior> {
    // An orthographic image has other ways; a frame without a mask has no object whose middle it could be.
    if pair.image.camera.is_orthographic() || !pair.image.whole.object.contains(&false) {
        return None;
    }
    let distance = pose.apply(pair.depth.points.centroid()).z;
    let (across, along) = (ANYWHERE_ACROSS * distance, ANYWHERE_ALONG * distance);
    Some(PosePrior { pose, rotation: degrees.to_radians(), across, along })
}

fn is_seen(found: &OutlineReport) -> bool {
    found.rims >= FEWEST_RIMS && found.noise <= LARGEST_RIM_NOISE
}
