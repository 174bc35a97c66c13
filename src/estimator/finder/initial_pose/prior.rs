//! The prior about an initial pose: how far the answer may be from it, one sigma.

use crate::estimator::pair::ViewPair;
use crate::pose::{PosePrior, Similarity};

/// One sigma of the initial pose as a share of its tolerance: of the rotation, and of the object's position across and
/// along the line of sight. For a mug at 0.8 m these are 3 degrees, 45 and 25 mm.
const SIGMA_OF_DEGREES: f64 = 0.1;
const SIGMA_ACROSS: f64 = 0.4;
const SIGMA_ALONG: f64 = 0.22;
/// Sigma of the object's position across and along the line of sight if no translation is given, shares of the distance.
const ALIGNED_ACROSS: f64 = 0.12;
const ALIGNED_ALONG: f64 = 0.08;

/// The prior about a pose with these tolerances of its rotation, in degrees, and of the object's position. Without the
/// latter, the pose aligns the centres of both views. `None` if the image does not depend on distances.
pub fn prior(pair: &ViewPair, pose: Similarity, degrees: f64, distance: Option<f64>) -> Option<PosePrior> {
    let degrees = SIGMA_OF_DEGREES * degrees;
    let Some(distance) = distance else { return aligned_prior(pair, pose, degrees) };
    let (across, along) = (SIGMA_ACROSS * distance, SIGMA_ALONG * distance);
    let sees_depth = !pair.image.camera.is_orthographic();
    sees_depth.then_some(PosePrior { pose, rotation: degrees.to_radians(), across, along })
}

/// The prior without a given translation: `pose` puts the centre of the depth points at that of the image's object;
/// `degrees` is the sigma of its rotation.
pub fn aligned_prior(pair: &ViewPair, pose: Similarity, degrees: f64) -> Option<PosePrior> {
    // Orthographic images have other methods, and without a mask the centre of the object is unknown.
    if pair.image.camera.is_orthographic() || !pair.image.whole.object.contains(&false) {
        return None;
    }
    let distance = pose.apply(pair.depth.points.centroid()).z;
    let (across, along) = (ALIGNED_ACROSS * distance, ALIGNED_ALONG * distance);
    Some(PosePrior { pose, rotation: degrees.to_radians(), across, along })
}
