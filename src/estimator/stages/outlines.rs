//! Outlines in place of colours that are painted (docs/method.md, section 10): near a told pose, or from anywhere.

use crate::diagnosis::{Alternative, Diagnosis};
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::pose::{Angles, Outline, OutlinePrior, OutlineProblem, OutlineReport, PhotometricReport, Similarity};
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
pub fn near(pair: &ViewPair, normals: &Normals, told: OutlinePrior) -> Option<OutlineReport> {
    let problem = OutlineProblem { image: &pair.image, depth: &pair.depth, normals, prior: told };
    let mut outline = Outline::new(&problem);
    let staying = outline.judge(&problem, &told.pose).cost;
    let found = outline.register(&problem, &told.pose);
    Some(found).filter(|found| is_seen(found) && found.cost < staying)
}

/// The pose where nothing is told: the best from several rotations at the middle of the image's object.
pub fn anywhere(pair: &ViewPair, normals: &Normals) -> Option<OutlineReport> {
    let turned = |angles: Angles| gauge::centred(pair, angles.rotation());
    let prior = placed_by_middles(pair, turned(Angles::default()), ANYWHERE_DEGREES)?;
    let problem = OutlineProblem { image: &pair.image, depth: &pair.depth, normals, prior };
    let mut outline = Outline::new(&problem);
    let starts = TURNS.into_iter().flat_map(|beta| TILTS.map(|alpha| turned(Angles { alpha, beta, gamma: 0.0 })));
    let found = starts.map(|start| outline.register(&problem, &start)).filter(is_seen);
    found.min_by(|a, b| a.cost.total_cmp(&b.cost))
}

/// What is known where no place is told: the pose, which puts the middle of the depth points on that of the image's object,
/// with this sigma of its rotation, degrees.
pub fn placed_by_middles(pair: &ViewPair, pose: Similarity, degrees: f64) -> Option<OutlinePrior> {
    // An orthographic image has other ways; a frame without a mask has no object whose middle it could be.
    if pair.image.camera.is_orthographic() || !pair.image.whole.object.contains(&false) {
        return None;
    }
    let distance = pose.apply(pair.depth.points.centroid()).z;
    let (across, along) = (ANYWHERE_ACROSS * distance, ANYWHERE_ALONG * distance);
    Some(OutlinePrior { pose, rotation: degrees.to_radians(), across, along })
}

fn is_seen(found: &OutlineReport) -> bool {
    found.rims >= FEWEST_RIMS && found.noise <= LARGEST_RIM_NOISE
}
