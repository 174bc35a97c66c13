//! Decides when the loop ends, and with which status (the last line of Algorithm 1).
//!
//! A pure function from evidence to status and reason. It first decides whether the loop continues. An end that looks
//! good is then checked against what the registration reports about its answer, and may become ambiguous or lost.
//! `docs/lab/thresholds.md` lists the thresholds with the data used to calibrate them.

use crate::diagnosis::{LARGEST_CONTRAST_OBJECTIVE, LARGEST_UNEXPLAINED};
use crate::options::{Registration, Shading};
use crate::pose::{ContrastReport, PhotometricReport, SilhouetteReport, Uncertainty};
use crate::reason::Reason;
use crate::report::Status;

use super::evidence::Evidence;
use crate::estimator::decision::{Method, Staying};

/// Successive rejected iterations after which no better pose is expected.
const MOST_REJECTIONS: u32 = 6;
/// If the pose does not move, the loop has converged when the objective changes by less than this share.
const SETTLED_OBJECTIVE: f64 = 1e-3;
/// Iterations after which shapes under an unmoving pose improve no further: they flicker by some tenths of a percent.
const MOST_UNMOVED: u32 = 8;
/// Share of valid depth pixels with a correspondence below which a pose cannot be trusted.
const LEAST_MATCHED_SHARE: f64 = 0.05;
/// Fewer correspondences than this determine nothing.
const FEWEST_CORRESPONDENCES: usize = 12;
/// Iterations before the loop may converge: the first has no predecessor, and a surface tries its starts first.
const FIRST_VERDICT: u32 = 2;
const FIRST_VERDICT_OF_SURFACE: u32 = crate::shape::STARTS;

/// Sigma in degrees above which the rotation about an axis is not observable. An angle that is uniform over a quarter
/// turn has a sigma of 26.
const UNOBSERVABLE: f64 = 25.0;
/// Sigma in degrees above which the rotation about an axis is too uncertain to be used. Set above the sigmas of poses
/// found in random scenes.
const LOST_SIGMA: f64 = 5.0;
/// Smallest share of points within the robust scale for a pose to be trusted.
const FEWEST_INLIERS: f64 = 0.4;

/// A status with its reason.
pub type Verdict = (Status, Option<Reason>);

/// The verdict after an iteration; `None` if the loop continues. Without a method, surfaces determine the pose, or it is
/// fixed.
pub fn verdict(evidence: &Evidence, method: Option<&Method>) -> Option<Verdict> {
    let Evidence { registration, is_rejected, rejections, iteration, max_iterations, .. } = *evidence;
    if evidence.correspondences < FEWEST_CORRESPONDENCES || evidence.overlap < LEAST_MATCHED_SHARE {
        return Some((Status::Lost, Some(Reason::LittleOverlap { percent: 100.0 * evidence.overlap })));
    }
    let end = if has_settled(evidence) {
        // Once the answer is final, it does not matter whether the last iteration was rejected.
        (Status::Converged, None)
    } else if is_rejected && registration == Registration::Fixed {
        // With a fixed pose, the next iteration would repeat this one.
        (Status::MaxIterations, Some(Reason::ShapesStay))
    } else if rejections >= MOST_REJECTIONS {
        (Status::MaxIterations, Some(Reason::NoBetterPose { iterations: MOST_REJECTIONS }))
    } else if iteration >= max_iterations {
        (Status::MaxIterations, Some(Reason::IterationCap { iterations: max_iterations }))
    } else {
        return None;
    };
    let of_input = || evidence.missing_mask.clone().map(capped);
    Some(reason_for_distrust(evidence, method).or_else(of_input).unwrap_or(end))
}

/// The verdict if a check of the input distrusts an answer that looks good.
pub const fn capped(reason: Reason) -> Verdict {
    (Status::Ambiguous, Some(reason))
}

/// Whether another iteration would change nothing that matters.
fn has_settled(evidence: &Evidence) -> bool {
    let Evidence { unmoved, is_rejected, objective, .. } = *evidence;
    let Some(before) = evidence.objective_before else { return false };
    let is_steady = (objective - before).abs() < SETTLED_OBJECTIVE * before.max(f64::MIN_POSITIVE);
    let has_settled = match evidence.registration {
        Registration::Fixed => is_steady && !is_rejected,
        // Shapes that improve no further have settled as well.
        Registration::Joint => unmoved > 0 && (is_steady || is_rejected || unmoved >= MOST_UNMOVED),
        Registration::Icp => unmoved > 0 && evidence.is_whole_step && !is_rejected,
    };
    let first_verdict = match evidence.shading {
        Shading::Pixel => FIRST_VERDICT,
        Shading::Surface => FIRST_VERDICT_OF_SURFACE,
    };
    has_settled && evidence.iteration >= first_verdict
}

/// The reason why the answer is "lost" or "ambiguous" although the loop has ended, if there is one.
fn reason_for_distrust(evidence: &Evidence, method: Option<&Method>) -> Option<Verdict> {
    let (lost, certainty) = match method {
        Some(Method::Initial(Staying::Explains)) => return Some(capped(Reason::InitialPoseKept)),
        Some(Method::Initial(Staying::ExplainsNothing)) => return Some((Status::Lost, Some(Reason::InitialPoseKept))),
        Some(Method::Silhouettes(found)) => return reason_to_doubt_silhouettes(found, evidence.tolerance).map(capped),
        Some(Method::Contrast(found)) => (reason_to_doubt_contrast(&found.report), Some(&found.report.uncertainty)),
        Some(Method::Photometric(found)) => (reason_to_be_lost(found, evidence), Some(&found.uncertainty)),
        None => (None, None),
    };
    if lost.is_some() {
        return Some((Status::Lost, lost));
    }
    if let Some(hollow) = &evidence.hollow {
        return Some(capped(hollow.clone()));
    }
    let uncertain = || certainty.and_then(|uncertainty| too_uncertain(uncertainty, evidence.tolerance));
    match evidence.rivals {
        0 => uncertain().or_else(|| reason_to_doubt_colours(evidence, method)).map(capped),
        count => Some(capped(Reason::Rivals { count, nearest_degrees: evidence.nearest_rival })),
    }
}

fn reason_to_doubt_silhouettes(found: &SilhouetteReport, tolerance: f64) -> Option<Reason> {
    let (sigma, weakest) = (found.uncertainty.largest_rotation(), found.uncertainty.weakest);
    if found.unseen {
        return Some(Reason::SilhouetteBlind { weakest });
    }
    (sigma.is_nan() || sigma > tolerance).then_some(Reason::AlbedoVaries { sigma_degrees: sigma, weakest })
}

fn reason_to_doubt_contrast(ContrastReport { objective, uncertainty, .. }: &ContrastReport) -> Option<Reason> {
    let is_unexplained = objective.is_nan() || *objective > LARGEST_CONTRAST_OBJECTIVE;
    too_uncertain(uncertainty, LOST_SIGMA)
        .or_else(|| is_unexplained.then_some(Reason::ContrastUnexplained { percent: 100.0 * objective }))
}

fn too_uncertain(uncertainty: &Uncertainty, most: f64) -> Option<Reason> {
    let (sigma, weakest) = (uncertainty.largest_rotation(), uncertainty.weakest);
    (sigma.is_nan() || sigma > most).then_some(Reason::RotationUncertain { sigma_degrees: sigma, weakest })
}

/// Colours that shading does not explain, if local contrast chose the pose: the albedo is known to vary, so that they only
/// cap the status.
fn reason_to_doubt_colours(evidence: &Evidence, method: Option<&Method>) -> Option<Reason> {
    match method {
        Some(Method::Photometric(found)) if evidence.by_contrast => unexplained(found, evidence.log_spread),
        _ => None,
    }
}

fn unexplained(found: &PhotometricReport, log_spread: f64) -> Option<Reason> {
    let share = found.noise / log_spread;
    (share.is_nan() || share > LARGEST_UNEXPLAINED).then_some(Reason::Unexplained { percent: 100.0 * share })
}

fn reason_to_be_lost(found: &PhotometricReport, evidence: &Evidence) -> Option<Reason> {
    let (sigma, weakest) = (found.uncertainty.largest_rotation(), found.uncertainty.weakest);
    if sigma.is_nan() || sigma > UNOBSERVABLE {
        return Some(Reason::NotObservable { weakest });
    }
    if let Some(reason) = too_uncertain(&found.uncertainty, LOST_SIGMA) {
        return Some(reason);
    }
    if let Some(reason) = unexplained(found, evidence.log_spread).filter(|_| !evidence.by_contrast) {
        return Some(reason);
    }
    (found.inliers < FEWEST_INLIERS).then_some(Reason::FewInliers { percent: 100.0 * found.inliers })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::estimator::contrasted::Contrasted;
    use crate::light::Light;
    use crate::pose::{Axis, Direction, PhotometricTermination, Similarity, Unknown};

    /// A run without any problem that has just settled in its fifth iteration.
    const SETTLED: Evidence = Evidence {
        iteration: 5,
        max_iterations: 60,
        tolerance: 1.5,
        registration: Registration::Joint,
        shading: Shading::Surface,
        correspondences: 1000,
        overlap: 0.8,
        objective_before: Some(0.2),
        objective: 0.2,
        is_rejected: false,
        rejections: 0,
        unmoved: 1,
        is_whole_step: true,
        log_spread: 1.0,
        by_contrast: false,
        hollow: None,
        missing_mask: None,
        rivals: 0,
        nearest_rival: f64::INFINITY,
    };
    const ABOUT_X: Direction = Direction { first: Some(Unknown::Rotation(Axis::X)), second: None };
    const ABOUT_Y: Direction = Direction { first: Some(Unknown::Rotation(Axis::Y)), second: None };
    const ICP: Evidence = Evidence { registration: Registration::Icp, ..SETTLED };
    const FIXED: Evidence = Evidence { registration: Registration::Fixed, ..SETTLED };
    const MOVING: Evidence = Evidence { unmoved: 0, ..SETTLED };

    /// A case: its name, the evidence or the method of a settled run, the expected status and reason.
    type Row<Case = Evidence> = (&'static str, Case, Option<Status>, Option<Reason>);

    fn uncertainty(sigma: f64, weakest: Direction) -> Uncertainty {
        Uncertainty { rotation_degrees: [0.0, sigma, 0.1], translation: [None; 3], scale: None, weakest }
    }

    /// Photometric registration that leaves `noise` of the image's spread, whose `inliers` lie within the robust scale.
    fn photometric(sigma: f64, noise: f64, inliers: f64) -> Method {
        Method::Photometric(Box::new(PhotometricReport {
            pose: Similarity::identity(),
            light: Light([[0.0; 9]; 3]),
            exposure: 0.0,
            objective: 0.0,
            noise,
            spatial_covariance: 0.0,
            visible: 1000,
            sampled: false,
            inliers,
            iterations: 9,
            termination: PhotometricTermination::Settled,
            information: Default::default(),
            covariance: Default::default(),
            uncertainty: uncertainty(sigma, ABOUT_X),
        }))
    }

    fn contrast(sigma: f64, objective: f64) -> Method {
        let (pose, uncertainty) = (Similarity::identity(), uncertainty(sigma, ABOUT_X));
        Method::Contrast(Box::new(Contrasted::new(ContrastReport::of(pose, objective, uncertainty))))
    }

    fn silhouettes(sigma: f64, unseen: bool) -> Method {
        let (pose, uncertainty) = (Similarity::identity(), uncertainty(sigma, ABOUT_Y));
        Method::Silhouettes(Box::new(SilhouetteReport {
            pose,
            noise: 1.0,
            uncertainty,
            unseen,
            cost: 0.1,
            discontinuities: 99,
            independent: 40.0,
        }))
    }

    const fn turned(sigma_degrees: f64) -> Option<Reason> {
        Some(Reason::RotationUncertain { sigma_degrees, weakest: ABOUT_X })
    }

    /// Cases of whether the loop ends.
    fn ends() -> Vec<Row> {
        let (converged, capped) = (Some(Status::Converged), Some(Status::MaxIterations));
        vec![
            ("the pose and the shapes have settled", SETTLED, converged, None),
            ("the pose still moves", MOVING, None, None),
            ("the shapes still change", Evidence { objective: 0.19, ..SETTLED }, None, None),
            (
                "shapes that get worse have settled",
                Evidence { is_rejected: true, objective: 0.19, ..SETTLED },
                converged,
                None,
            ),
            ("shapes flicker for ever", Evidence { unmoved: 8, objective: 0.19, ..SETTLED }, converged, None),
            ("the first iteration", Evidence { iteration: 1, objective_before: None, ..SETTLED }, None, None),
            ("a surface with starts to try", Evidence { iteration: 2, ..SETTLED }, None, None),
            ("single pixels", Evidence { iteration: 2, shading: Shading::Pixel, ..SETTLED }, converged, None),
            ("surfaces that match", Evidence { objective: 0.1, ..ICP }, converged, None),
            ("half a step", Evidence { is_whole_step: false, ..ICP }, None, None),
            ("a rejected match", Evidence { is_rejected: true, ..ICP }, None, None),
            ("a held pose", FIXED, converged, None),
            ("a held pose whose shapes change", Evidence { objective: 0.19, ..FIXED }, None, None),
            (
                "a held pose whose shapes get worse",
                Evidence { is_rejected: true, ..FIXED },
                capped,
                Some(Reason::ShapesStay),
            ),
            (
                "nothing is accepted any more",
                Evidence { rejections: 6, ..MOVING },
                capped,
                Some(Reason::NoBetterPose { iterations: 6 }),
            ),
            ("the cap", Evidence { iteration: 60, ..MOVING }, capped, Some(Reason::IterationCap { iterations: 60 })),
        ]
    }

    /// Cases of whether the end of the loop is reliable, whatever the method.
    fn reliability() -> Vec<Row> {
        let (lost, ambiguous) = (Some(Status::Lost), Some(Status::Ambiguous));
        vec![
            (
                "little overlap",
                Evidence { overlap: 0.04, ..MOVING },
                lost,
                Some(Reason::LittleOverlap { percent: 4.0 }),
            ),
            (
                "few correspondences",
                Evidence { correspondences: 11, ..SETTLED },
                lost,
                Some(Reason::LittleOverlap { percent: 80.0 }),
            ),
            (
                "a hollow depth map",
                Evidence { hollow: Some(Reason::Hollow), ..SETTLED },
                ambiguous,
                Some(Reason::Hollow),
            ),
            (
                "a whole frame",
                Evidence { missing_mask: Some(Reason::MissingImageMask), ..SETTLED },
                ambiguous,
                Some(Reason::MissingImageMask),
            ),
            (
                "a guessed object",
                Evidence { missing_mask: Some(Reason::MissingDepthMask { percent: 40.0 }), ..SETTLED },
                ambiguous,
                Some(Reason::MissingDepthMask { percent: 40.0 }),
            ),
            (
                "a hollow guessed object with rivals",
                Evidence {
                    hollow: Some(Reason::Hollow),
                    missing_mask: Some(Reason::MissingImageMask),
                    rivals: 2,
                    ..SETTLED
                },
                ambiguous,
                Some(Reason::Hollow),
            ),
            (
                "rivals",
                Evidence { rivals: 2, nearest_rival: 40.2, ..SETTLED },
                ambiguous,
                Some(Reason::Rivals { count: 2, nearest_degrees: 40.2 }),
            ),
            (
                "rivals of matched surfaces",
                Evidence { rivals: 1, nearest_rival: 9.0, ..ICP },
                ambiguous,
                Some(Reason::Rivals { count: 1, nearest_degrees: 9.0 }),
            ),
            (
                "an end by the cap with a rival",
                Evidence { iteration: 60, rivals: 1, nearest_rival: 12.0, ..MOVING },
                ambiguous,
                Some(Reason::Rivals { count: 1, nearest_degrees: 12.0 }),
            ),
            ("what goes on, whatever its rivals", Evidence { rivals: 1, ..MOVING }, None, None),
        ]
    }

    /// Cases of what a method reports about the pose of a settled run.
    fn methods() -> Vec<Row<Method>> {
        let (lost, ambiguous) = (Some(Status::Lost), Some(Status::Ambiguous));
        let varies = |sigma_degrees| Some(Reason::AlbedoVaries { sigma_degrees, weakest: ABOUT_Y });
        vec![
            (
                "a turn that nothing shows",
                photometric(31.0, 0.05, 0.9),
                lost,
                Some(Reason::NotObservable { weakest: ABOUT_X }),
            ),
            (
                "a sigma that is no number",
                photometric(f64::NAN, 0.05, 0.9),
                lost,
                Some(Reason::NotObservable { weakest: ABOUT_X }),
            ),
            ("a large sigma", photometric(6.0, 0.05, 0.9), lost, turned(6.0)),
            ("albedo", photometric(0.1, 0.4, 0.9), lost, Some(Reason::Unexplained { percent: 40.0 })),
            (
                "colours without spread",
                photometric(0.1, f64::NAN, 0.9),
                lost,
                Some(Reason::Unexplained { percent: f64::NAN }),
            ),
            ("outliers", photometric(0.1, 0.05, 0.3), lost, Some(Reason::FewInliers { percent: 30.0 })),
            ("a fair sigma", photometric(1.6, 0.05, 0.9), ambiguous, turned(1.6)),
            (
                "local contrast that shading does not explain",
                contrast(0.5, 0.6),
                lost,
                Some(Reason::ContrastUnexplained { percent: 60.0 }),
            ),
            ("local contrast with a large sigma", contrast(6.0, 0.3), lost, turned(6.0)),
            ("local contrast with a fair sigma", contrast(1.6, 0.3), ambiguous, turned(1.6)),
            ("local contrast", contrast(0.5, 0.3), Some(Status::Converged), None),
            (
                "an initial pose that nothing improves",
                Method::Initial(Staying::Explains),
                ambiguous,
                Some(Reason::InitialPoseKept),
            ),
            (
                "an initial pose that explains nothing, as nothing else does",
                Method::Initial(Staying::ExplainsNothing),
                lost,
                Some(Reason::InitialPoseKept),
            ),
            ("silhouettes that see everything", silhouettes(0.8, false), Some(Status::Converged), None),
            ("silhouettes that see little", silhouettes(1.9, false), ambiguous, varies(1.9)),
            ("silhouettes with a sigma that is no number", silhouettes(f64::NAN, false), ambiguous, varies(f64::NAN)),
            ("a mug's own axis", silhouettes(2.8, true), ambiguous, Some(Reason::SilhouetteBlind { weakest: ABOUT_Y })),
        ]
    }

    /// Compared as text, by code and numbers, because NaN equals nothing.
    #[track_caller]
    fn expect(name: &str, found: Option<Verdict>, (status, reason): (Option<Status>, Option<Reason>)) {
        assert_eq!(format!("{found:?}"), format!("{:?}", status.map(|status| (status, reason))), "{name}");
    }

    #[test]
    fn each_kind_of_evidence_has_its_verdict() {
        for (name, evidence, status, reason) in ends().into_iter().chain(reliability()) {
            for method in [None, Some(photometric(0.1, 0.05, 0.9))] {
                expect(name, verdict(&evidence, method.as_ref()), (status, reason.clone()));
            }
        }
    }

    #[test]
    fn unexplained_colours_are_a_doubt_if_local_contrast_chose_the_pose() {
        let chosen = Evidence { by_contrast: true, ..SETTLED };
        let unexplained = Some(Reason::Unexplained { percent: 40.0 });
        let cases = [
            (photometric(0.1, 0.4, 0.9), Some(Status::Ambiguous), unexplained),
            (photometric(6.0, 0.4, 0.9), Some(Status::Lost), turned(6.0)),
            (photometric(0.1, 0.05, 0.9), Some(Status::Converged), None),
        ];
        for (method, status, reason) in cases {
            expect("by contrast", verdict(&chosen, Some(&method)), (status, reason));
        }
    }

    #[test]
    fn each_method_has_its_verdict_once_the_pose_has_settled() {
        for (name, method, status, reason) in methods() {
            expect(name, verdict(&SETTLED, Some(&method)), (status, reason));
            assert_eq!(verdict(&MOVING, Some(&method)), None, "{name}");
        }
    }
}
