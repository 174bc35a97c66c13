//! Detects a depth map in another unit by registering its relief in other units and comparing the fits.
//!
//! Applies only to depth maps under a parallel projection: behind a pinhole, the unit scales all three axes alike.

use crate::diagnosis::{Alternative, Diagnosis};
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::{COLLAPSE, PhotometricRegistration};
use crate::pose::{PhotometricReport, Similarity};
use crate::reason::Reason;

/// Factors that scale the relief (flatter, deeper), nearest first. A unit may be mistaken by any factor, so they cover
/// a tenth to ten times in steps of 1.3 to 1.7.
const UNITS: [[f32; 6]; 2] = [[0.7, 0.5, 0.3, 0.2, 0.15, 0.1], [1.5, 2.0, 3.0, 5.0, 7.0, 10.0]];
/// A unit whose noise exceeds this multiple of the given unit's leads away from the right one, and no unit beyond it is
/// tried.
const AWAY: f64 = 2.0;
/// Largest number of rounds of a registration in another unit. Least squares usually needs all of them, and further
/// rounds with instrumental variables would double the time. A registration that settles sooner spends its remaining
/// rounds on instrumental variables.
const UNIT_ROUNDS: usize = 5;
/// Another unit fits better if the spatial covariance of its residuals is below this share of the given unit's. Set on
/// pairs with right and wrong units (docs/lab/thresholds.md).
const BETTER_COVARIANCE: f64 = 0.5;
/// Another unit must also lower the noise by four sigmas: the noise, estimated by the median of n points in three
/// channels, has a relative sigma of 0.56 / sqrt(n).
const SIGMAS_OF_NOISE: f64 = 4.0 * 0.56;

/// The reason to cap a verdict if relief in another unit explains an image that the given unit does not explain; `found`
/// is the result in the given unit, if the pose rests on it.
pub fn other_unit(
    photometric: &mut PhotometricRegistration,
    pair: &ViewPair,
    pose: &Similarity,
    found: Option<&PhotometricReport>,
) -> Option<Reason> {
    better_unit(photometric, pair, pose, found).map(|times| Reason::OtherUnit { times: f64::from(times) })
}

/// The factor by which relief would have to be deeper.
fn better_unit(
    photometric: &mut PhotometricRegistration,
    pair: &ViewPair,
    pose: &Similarity,
    found: Option<&PhotometricReport>,
) -> Option<f32> {
    // White noise leaves nothing for another unit to explain, neither in all points nor in the few that are tried here.
    let is_explained =
        |found: &PhotometricReport| pair.residuals(found).diagnose(Alternative::DepthUnit) == Diagnosis::Explained;
    if !pair.depth.camera.is_orthographic() || found.is_some_and(is_explained) {
        return None;
    }
    // All units are compared on the points that are visible in the given one.
    photometric.judge(pair, pose)?;
    let own = photometric.register_relief(pair, pose, 1.0, UNIT_ROUNDS).filter(|own| !is_explained(own))?;
    let uncertainty = SIGMAS_OF_NOISE / (own.visible as f64).sqrt();
    let (mut better, mut noise) = (None, (1.0 - uncertainty) * own.noise);
    for way in UNITS {
        for unit in way {
            let Some(found) = photometric.register_relief(pair, pose, unit, UNIT_ROUNDS) else { continue };
            if found.noise > AWAY * own.noise {
                break;
            }
            if found.noise < noise
                && pair.residuals(&found).have_less_covariance(BETTER_COVARIANCE, &pair.residuals(&own))
                && gauge::growth(pair, &found.pose, pose) < COLLAPSE
            {
                (better, noise) = (Some(unit), found.noise);
            }
        }
    }
    better
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::diagnosis::{UNIT_COVARIANCE, UNIT_NOISE};
    use crate::estimator::Estimator;
    use crate::options::Options;
    use crate::pose::Angles;
    use crate::scenes::{SampleRequest, Scene, light, surface};
    use crate::view::{DepthMap, Size};

    /// The views of a pair whose depths are multiplied by `unit`, registered from the true rotation with their centres
    /// aligned.
    fn registered(unit: f64) -> (Estimator, PhotometricRegistration, PhotometricReport) {
        let request = SampleRequest {
            light: light("colourful").unwrap(),
            size: Size { width: 96, height: 96 },
            rotation: Angles { beta: 10.0, ..Angles::default() }.rotation(),
            noise: 0.01,
            ..SampleRequest::default()
        };
        let sample = Scene::new(&surface("ripples").unwrap()).unwrap().sample(&request).unwrap();
        let depth = DepthMap { unit: Some(unit), ..sample.depth_map() };
        let estimator = Estimator::new(sample.colour_image(), &depth, Options::default()).unwrap();
        let mut registration = PhotometricRegistration::new(&estimator.pair);
        let middle = estimator.pair.depth.points.centroid();
        let moved = Vector3::new(0.0, 0.0, middle.z * (1.0 / unit - 1.0));
        let translation = sample.pose.translation + sample.pose.scale * sample.pose.rotation * moved;
        let found = registration.register(&estimator.pair, &Similarity { translation, ..sample.pose }).unwrap();
        (estimator, registration, found)
    }

    fn better_unit(
        estimator: &Estimator,
        registration: &mut PhotometricRegistration,
        found: &PhotometricReport,
    ) -> Option<f32> {
        super::better_unit(registration, &estimator.pair, &found.pose, Some(found))
    }

    #[test]
    fn relief_too_deep_and_too_flat_is_told_and_right_relief_is_left_alone() {
        let wrong = [(10.0, 0.1), (5.0, 0.2), (3.0, 0.3), (2.0, 0.5), (1.5, 0.7), (0.7, 1.5), (0.1, 10.0)];
        for (unit, expected) in wrong.map(|(unit, right)| (unit, Some(right))).into_iter().chain([(1.0, None)]) {
            let (estimator, mut registration, found) = registered(unit);
            assert_eq!(better_unit(&estimator, &mut registration, &found), expected, "unit {unit}");
        }
    }

    #[test]
    fn no_unit_is_asked_for_where_only_white_noise_is_left() {
        let (estimator, mut registration, mut found) = registered(10.0);
        let limits = (UNIT_COVARIANCE, UNIT_NOISE * estimator.pair.image.log_noise());
        for (covariance, noise, expected) in [(0.99, 0.99, None), (1.01, 0.99, Some(0.1)), (0.99, 1.01, Some(0.1))] {
            (found.spatial_covariance, found.noise) = (covariance * limits.0, noise * limits.1);
            let better = better_unit(&estimator, &mut registration, &found);
            assert_eq!(better, expected, "{covariance} and {noise} of the limits");
        }
        // With the right relief no unit is better, with or without the gate.
        let (estimator, mut registration, found) = registered(1.0);
        let found = PhotometricReport { spatial_covariance: f64::MAX, ..found };
        assert_eq!(better_unit(&estimator, &mut registration, &found), None);
    }
}
