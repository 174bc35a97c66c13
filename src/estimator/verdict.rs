//! When the loop ends, and what its end is called (the last line of Algorithm 1).
//!
//! One pure function: evidence in, status and message out. First it decides whether the loop goes on; an end that looks
//! good is then held against what the registration by colours says of its own answer, and may turn out to be ambiguous
//! or lost. `docs/method.md`, section 16, lists the thresholds with the data they were calibrated on.

use crate::options::{Registration, Shading};
use crate::pose::{ContrastReport, OutlineReport, PhotometricReport, Uncertainty};
use crate::report::Status;
use crate::text::Fixed;

/// Rejected iterations in a row after which nothing new is to be expected.
const MOST_REJECTIONS: u32 = 6;
/// Without a moving pose the loop has converged when the objective changes by less than this share.
const SETTLED_OBJECTIVE: f64 = 1e-3;
/// Iterations after which shapes under a pose that does not move have come as far as they will: they flicker by some
/// tenths of a percent.
const MOST_UNMOVED: u32 = 8;
/// Share of the depths that trimming may leave out of a map without a mask. Of two whole frames of a table with an object it left out 40
/// and 45 %, the object among them, and the wall had a pose 56 to 94 degrees off that seemed sure; of 79 renders with a second object,
/// which seemed sure as well, less than this.
const LARGEST_TRIMMED: f64 = 0.15;
/// Overlap (share of valid depth pixels) below which a pose cannot be trusted.
const LEAST_OVERLAP: f64 = 0.05;
/// Fewer correspondences than this determine nothing.
const FEWEST_CORRESPONDENCES: usize = 12;
/// Iterations before convergence is believed: the first has no predecessor, and a surface tries its starts first.
const FIRST_VERDICT: u32 = 2;
const FIRST_VERDICT_OF_SURFACE: u32 = crate::shape::STARTS;

/// A rotation less certain than this about any axis is not observable at all, degrees (one sigma).
const UNOBSERVABLE: f64 = 30.0;
/// A rotation less certain than this about any axis is no answer, degrees (one sigma). Found poses of the random scenes
/// stay below 3.
const LARGEST_SIGMA: f64 = 5.0;
/// A rotation less certain than this is no single answer, degrees (one sigma): two sigmas pass the three degrees within
/// which a pose counts as found. One in 300 random scenes is so uncertain, and all photographs that end over 4 degrees
/// off are, by 2.2 or more.
const DOUBTFUL_SIGMA: f64 = 1.5;
/// Share of the colours' spread that a trusted pose may leave unexplained. Renders leave 0.01 to 0.1.
const LARGEST_UNEXPLAINED: f64 = 0.3;
/// What contrast and outline may leave unexplained of a trusted pose. Before paint was taken out at its edges, found
/// photographs left 0.13 to 0.51 and print on a flat bag 0.58 or more; since then the bag leaves 0.26, so that this catches
/// what has no edges alone.
const LARGEST_UNEXPLAINED_CONTRAST: f64 = 0.56;
/// Share of the points within the robust scale that a trusted pose has at least.
const FEWEST_INLIERS: f64 = 0.4;

/// What is known at the end of an iteration.
#[derive(Clone, Copy, Debug)]
pub struct Evidence<'a> {
    /// Iterations so far, and their cap.
    pub iteration: u32,
    pub max_iterations: u32,
    /// The registration that ran, and the way the shape is found.
    pub registration: Registration,
    pub shading: Shading,
    /// Number of correspondences, and their share of the valid depth pixels.
    pub correspondences: usize,
    pub overlap: f64,
    /// Objective before the iteration, none before the first, and after it.
    pub objective_before: Option<f64>,
    pub objective: f64,
    /// Whether the iteration was taken back.
    pub is_rejected: bool,
    /// Iterations in a row that were taken back or found no better pose.
    pub rejections: u32,
    /// Whether the registration's whole step was less than the caller's `stopDegrees`, and for how many iterations in a
    /// row.
    pub unmoved: u32,
    /// Whether the registration's whole step was taken, and to a better pose.
    pub is_whole_step: bool,
    /// What the registration by colours says of its answer, where the answer is its own.
    pub colours: Option<ColourEvidence<'a>>,
    /// What outlines say of their answer, where the colours are painted and the answer is theirs.
    pub outlines: Option<OutlineEvidence<'a>>,
    /// What local contrast says, likewise.
    pub contrast: Option<ContrastEvidence<'a>>,
    /// Whether nothing near a told start explains the colours better, so that it was kept.
    pub has_kept_start: bool,
    /// Whether a pose was searched for a depth map that looks hollow: mirrored, it has another pose that is as good.
    pub is_hollow: bool,
    /// Share of the depths that trimming left out where no mask said what the object is.
    pub trimmed_without_mask: f64,
    /// Whether a pose was searched for a camera's whole frame, so that nothing says what in it is the object.
    pub is_whole_frame: bool,
    /// Number of rivals, and the degrees to the nearest.
    pub rivals: usize,
    pub nearest_rival: f64,
}

/// What the registration by colours says of its answer.
#[derive(Clone, Copy, Debug)]
pub struct ColourEvidence<'a> {
    /// Sigma of the rotation about the least certain axis, degrees, and the weakest direction in words.
    pub sigma: f64,
    pub weakest: &'a str,
    /// Share of the colours' spread that is left unexplained.
    pub unexplained: f64,
    /// Share of the points within the robust scale.
    pub inliers: f64,
}

/// What outlines say of their answer.
#[derive(Clone, Copy, Debug)]
pub struct OutlineEvidence<'a> {
    /// Sigma of the rotation about the least certain axis, degrees, and that axis in words.
    pub sigma: f64,
    pub weakest: &'a str,
    /// Whether that rotation is as good as unseen.
    pub is_unseen: bool,
}

/// What local contrast says of its answer.
#[derive(Clone, Copy, Debug)]
pub struct ContrastEvidence<'a> {
    /// Sigma of the rotation about the least certain axis, degrees, and the weakest direction in words.
    pub sigma: f64,
    pub weakest: &'a str,
    /// What contrast and outline leave unexplained: zero where nothing, one where shading explains none of the contrast.
    pub unexplained: f64,
}

impl<'a> ContrastEvidence<'a> {
    /// Of a registration by local contrast.
    pub fn of(found: &'a ContrastReport) -> Self {
        Self { sigma: largest(&found.uncertainty), weakest: &found.uncertainty.weakest, unexplained: found.objective }
    }
}

impl<'a> ColourEvidence<'a> {
    /// Of a registration, given the spread of the colours.
    pub fn of(found: &'a PhotometricReport, log_spread: f64) -> Self {
        Self {
            sigma: largest(&found.uncertainty),
            weakest: &found.uncertainty.weakest,
            unexplained: found.noise / log_spread,
            inliers: found.inliers,
        }
    }
}

impl<'a> OutlineEvidence<'a> {
    /// Of a registration by outlines.
    pub fn of(found: &'a OutlineReport) -> Self {
        Self { sigma: largest(&found.uncertainty), weakest: &found.uncertainty.weakest, is_unseen: found.unseen }
    }
}

fn largest(uncertainty: &Uncertainty) -> f64 {
    uncertainty.rotation_degrees.into_iter().fold(0.0, f64::max)
}

/// A status with its reason.
pub type Verdict = (Status, Option<String>);

/// What becomes of the loop after an iteration; `None` where it goes on.
pub fn verdict(evidence: &Evidence<'_>) -> Option<Verdict> {
    let Evidence { registration, is_rejected, rejections, iteration, max_iterations, .. } = *evidence;
    if evidence.correspondences < FEWEST_CORRESPONDENCES || evidence.overlap < LEAST_OVERLAP {
        let share = Fixed(100.0 * evidence.overlap, 1);
        return Some((
            Status::Lost,
            Some(format!("only {share} % of the depth pixels have a counterpart in the image")),
        ));
    }
    let end = if has_settled(evidence) {
        // What became of the last iteration is no news once the answer stands.
        (Status::Converged, None)
    } else if is_rejected && registration == Registration::Fixed {
        // With the pose held the next iteration would be this one again.
        (Status::MaxIterations, Some("another iteration would worsen the shapes under this pose".into()))
    } else if rejections >= MOST_REJECTIONS {
        (Status::MaxIterations, Some(format!("{MOST_REJECTIONS} iterations in a row brought no better pose")))
    } else if iteration >= max_iterations {
        (Status::MaxIterations, Some(format!("the cap of {max_iterations} iterations was reached")))
    } else {
        return None;
    };
    Some(reason_for_distrust(evidence).or_else(|| reason_of_missing_mask(evidence)).unwrap_or(end))
}

/// The verdict of an answer that looked good, where relief so many times as deep explains its colours better.
pub fn verdict_of_other_unit(unit: f32) -> Verdict {
    let times = Fixed(f64::from(unit), if unit < 1.0 { 2 } else { 1 });
    (
        Status::Ambiguous,
        Some(format!("relief about {times} times as deep explains the colours better: check depth.unit")),
    )
}

/// Whether another iteration would change nothing that matters.
fn has_settled(evidence: &Evidence<'_>) -> bool {
    let Evidence { unmoved, is_rejected, objective, .. } = *evidence;
    let Some(before) = evidence.objective_before else { return false };
    let is_steady = (objective - before).abs() < SETTLED_OBJECTIVE * before.max(f64::MIN_POSITIVE);
    let has_settled = match evidence.registration {
        Registration::Fixed => is_steady && !is_rejected,
        // Shapes that get no better have settled, too.
        Registration::Joint => unmoved > 0 && (is_steady || is_rejected || unmoved >= MOST_UNMOVED),
        Registration::Icp => unmoved > 0 && evidence.is_whole_step && !is_rejected,
    };
    let first_verdict = match evidence.shading {
        Shading::Pixel => FIRST_VERDICT,
        Shading::Surface => FIRST_VERDICT_OF_SURFACE,
    };
    has_settled && evidence.iteration >= first_verdict
}

/// Why the answer is "lost" or "ambiguous" although the loop came to an end, if it is.
fn reason_for_distrust(evidence: &Evidence<'_>) -> Option<Verdict> {
    if evidence.has_kept_start {
        let reason = "nothing within startTolerance explains the colours better than the told pose, which is kept";
        return Some((Status::Lost, Some(reason.into())));
    }
    if let Some(OutlineEvidence { sigma, weakest, is_unseen }) = evidence.outlines {
        let painted = "outlines decide, since one paint does not explain the colours";
        let sigma = (sigma.is_nan() || sigma > DOUBTFUL_SIGMA).then_some(Fixed(sigma, 1));
        let reason = match (is_unseen, sigma) {
            (true, _) => format!("{painted}; they do not show {weakest}: what was told of it is kept"),
            (_, Some(sigma)) => {
                format!("{painted}; the rotation is uncertain by {sigma} degrees (one sigma): {weakest}")
            }
            (..) => return None,
        };
        return Some((Status::Ambiguous, Some(reason)));
    }
    if let Some(reason) = evidence.contrast.and_then(|contrast| reason_without_contrast(&contrast)) {
        return Some((Status::Lost, Some(reason)));
    }
    if let Some(reason) = evidence.colours.and_then(|colours| reason_to_be_lost(&colours)) {
        return Some((Status::Lost, Some(reason)));
    }
    if evidence.is_hollow {
        let reason = "the depth map's limbs come towards the camera: it shows something hollow, or larger means nearer in \
                      it; mirrored in depth it explains the colours as well";
        return Some((Status::Ambiguous, Some(reason.into())));
    }
    let certainty = evidence.colours.map(|colours| (colours.sigma, colours.weakest));
    let certainty = certainty.or(evidence.contrast.map(|contrast| (contrast.sigma, contrast.weakest)));
    let reason = match (evidence.rivals, certainty) {
        (0, Some((sigma, weakest))) if sigma > DOUBTFUL_SIGMA => {
            format!("the rotation is uncertain by {} degrees (one sigma): {weakest}", Fixed(sigma, 1))
        }
        (0, _) => return None,
        (count, _) => {
            let nearest = Fixed(evidence.nearest_rival, 0);
            match count {
                1 => format!("one other pose explains the colours as well, {nearest} degrees away"),
                _ => format!("{count} other poses explain the colours as well, the nearest {nearest} degrees away"),
            }
        }
    };
    Some((Status::Ambiguous, Some(reason)))
}

/// Why an answer that looks good may be that of something else.
fn reason_of_missing_mask(evidence: &Evidence<'_>) -> Option<Verdict> {
    let reason = if evidence.trimmed_without_mask > LARGEST_TRIMMED {
        let share = Fixed(100.0 * evidence.trimmed_without_mask, 0);
        format!("{share} % of the depths were left out as background, a guess: give depth.mask")
    } else if evidence.is_whole_frame {
        "nothing says what the object is in the image: give image.mask".into()
    } else {
        return None;
    };
    Some((Status::Ambiguous, Some(reason)))
}

fn reason_without_contrast(&ContrastEvidence { sigma, weakest, unexplained }: &ContrastEvidence<'_>) -> Option<String> {
    let paint = || {
        let share = Fixed(100.0 * unexplained, 0);
        format!(
            "one paint does not explain the colours, and shading leaves {share} % of their local contrast unexplained"
        )
    };
    too_uncertain(sigma, weakest)
        .or_else(|| (unexplained.is_nan() || unexplained > LARGEST_UNEXPLAINED_CONTRAST).then(paint))
}

fn too_uncertain(sigma: f64, weakest: &str) -> Option<String> {
    (sigma.is_nan() || sigma > LARGEST_SIGMA)
        .then(|| format!("the rotation is uncertain by {} degrees: {weakest}", Fixed(sigma, 0)))
}

fn reason_to_be_lost(&ColourEvidence { sigma, weakest, unexplained, inliers }: &ColourEvidence<'_>) -> Option<String> {
    if sigma.is_nan() || sigma > UNOBSERVABLE {
        return Some(format!(
            "{weakest} is not observable: as far as the noise lets see, changing it changes no colour"
        ));
    }
    if let Some(reason) = too_uncertain(sigma, weakest) {
        return Some(reason);
    }
    if unexplained.is_nan() || unexplained > LARGEST_UNEXPLAINED {
        let share = Fixed(100.0 * unexplained, 0);
        return Some(format!("light and normals leave {share} % of the colours' spread unexplained"));
    }
    let share = Fixed(100.0 * inliers, 0);
    (inliers < FEWEST_INLIERS).then(|| format!("only {share} % of the points agree with the pose"))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A run by colours in its fifth iteration, all well, that has just settled.
    const SETTLED: Evidence<'static> = Evidence {
        iteration: 5,
        max_iterations: 60,
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
        colours: Some(SURE),
        outlines: None,
        contrast: None,
        has_kept_start: false,
        is_hollow: false,
        trimmed_without_mask: 0.0,
        is_whole_frame: false,
        rivals: 0,
        nearest_rival: f64::INFINITY,
    };
    const SURE: ColourEvidence<'static> =
        ColourEvidence { sigma: 0.1, weakest: "rotation about x", unexplained: 0.05, inliers: 0.9 };
    const SEEN: OutlineEvidence<'static> =
        OutlineEvidence { sigma: 0.8, weakest: "rotation about y", is_unseen: false };
    const ICP: Evidence<'static> = Evidence { registration: Registration::Icp, colours: None, ..SETTLED };
    const FIXED: Evidence<'static> = Evidence { registration: Registration::Fixed, colours: None, ..SETTLED };
    const MOVING: Evidence<'static> = Evidence { unmoved: 0, ..SETTLED };

    /// A kind of evidence, what it comes to, and a word of its message.
    type Row = (&'static str, Evidence<'static>, Option<Status>, &'static str);

    /// Whether the loop ends.
    fn ends() -> Vec<Row> {
        let (converged, capped) = (Some(Status::Converged), Some(Status::MaxIterations));
        vec![
            ("the pose and the shapes have settled", SETTLED, converged, ""),
            ("the pose still moves", MOVING, None, ""),
            ("the shapes still change", Evidence { objective: 0.19, ..SETTLED }, None, ""),
            (
                "shapes that get worse have settled",
                Evidence { is_rejected: true, objective: 0.19, ..SETTLED },
                converged,
                "",
            ),
            ("shapes flicker for ever", Evidence { unmoved: 8, objective: 0.19, ..SETTLED }, converged, ""),
            ("the first iteration", Evidence { iteration: 1, objective_before: None, ..SETTLED }, None, ""),
            ("a surface with starts to try", Evidence { iteration: 2, ..SETTLED }, None, ""),
            ("single pixels", Evidence { iteration: 2, shading: Shading::Pixel, ..SETTLED }, converged, ""),
            ("surfaces that match", Evidence { objective: 0.1, ..ICP }, converged, ""),
            ("half a step", Evidence { is_whole_step: false, ..ICP }, None, ""),
            ("a rejected match", Evidence { is_rejected: true, ..ICP }, None, ""),
            ("a held pose", FIXED, converged, ""),
            ("a held pose whose shapes change", Evidence { objective: 0.19, ..FIXED }, None, ""),
            (
                "a held pose whose shapes get worse",
                Evidence { is_rejected: true, ..FIXED },
                capped,
                "worsen the shapes",
            ),
            ("nothing is accepted any more", Evidence { rejections: 6, ..MOVING }, capped, "6 iterations in a row"),
            ("the cap", Evidence { iteration: 60, ..MOVING }, capped, "cap of 60"),
        ]
    }

    /// Whether its end is to be relied on.
    fn reliability() -> Vec<Row> {
        let colours = |colours: ColourEvidence<'static>| Evidence { colours: Some(colours), ..SETTLED };
        let (lost, ambiguous) = (Some(Status::Lost), Some(Status::Ambiguous));
        vec![
            ("little overlap", Evidence { overlap: 0.04, ..MOVING }, lost, "only 4.0 %"),
            ("few correspondences", Evidence { correspondences: 11, ..SETTLED }, lost, "counterpart"),
            (
                "a turn that nothing shows",
                colours(ColourEvidence { sigma: 31.0, ..SURE }),
                lost,
                "about x is not observable",
            ),
            ("a sigma that is no number", colours(ColourEvidence { sigma: f64::NAN, ..SURE }), lost, "not observable"),
            ("a large sigma", colours(ColourEvidence { sigma: 6.0, ..SURE }), lost, "uncertain by 6 degrees"),
            ("paint", colours(ColourEvidence { unexplained: 0.4, ..SURE }), lost, "40 % of the colours"),
            ("colours without spread", colours(ColourEvidence { unexplained: f64::NAN, ..SURE }), lost, "unexplained"),
            ("outliers", colours(ColourEvidence { inliers: 0.3, ..SURE }), lost, "only 30 % of the points"),
            ("a fair sigma", colours(ColourEvidence { sigma: 1.6, ..SURE }), ambiguous, "1.6 degrees (one sigma)"),
            ("a hollow depth map", Evidence { is_hollow: true, ..SETTLED }, ambiguous, "larger means nearer"),
            ("flying pixels", Evidence { trimmed_without_mask: 0.05, ..SETTLED }, Some(Status::Converged), ""),
            (
                "a guessed object",
                Evidence { trimmed_without_mask: 0.4, ..SETTLED },
                ambiguous,
                "40 % of the depths were left out",
            ),
            ("a whole frame", Evidence { is_whole_frame: true, ..SETTLED }, ambiguous, "give image.mask"),
            ("rivals", Evidence { rivals: 2, nearest_rival: 40.2, ..SETTLED }, ambiguous, "2 other poses"),
            (
                "rivals of matched surfaces",
                Evidence { rivals: 1, nearest_rival: 9.0, ..ICP },
                ambiguous,
                "9 degrees away",
            ),
            (
                "an end by the cap with a rival",
                Evidence { iteration: 60, rivals: 1, nearest_rival: 12.0, ..MOVING },
                ambiguous,
                "one other pose explains the colours as well, 12 degrees away",
            ),
            ("what goes on, whatever its rivals", Evidence { rivals: 1, ..MOVING }, None, ""),
        ]
    }

    /// Told starts, and what outlines say where colours are painted.
    fn told_and_outlined() -> Vec<Row> {
        let outlines =
            |outlines: OutlineEvidence<'static>| Evidence { colours: None, outlines: Some(outlines), ..SETTLED };
        let (lost, ambiguous) = (Some(Status::Lost), Some(Status::Ambiguous));
        vec![
            (
                "a told start that nothing improves",
                Evidence { has_kept_start: true, colours: None, ..SETTLED },
                lost,
                "within startTolerance",
            ),
            ("outlines that see everything", outlines(SEEN), Some(Status::Converged), ""),
            (
                "outlines that see little",
                outlines(OutlineEvidence { sigma: 1.9, ..SEEN }),
                ambiguous,
                "1.9 degrees (one sigma): rotation about y",
            ),
            (
                "a mug's own axis",
                outlines(OutlineEvidence { sigma: 2.8, is_unseen: true, ..SEEN }),
                ambiguous,
                "do not show rotation about y",
            ),
            ("a told start that still settles", Evidence { has_kept_start: true, ..MOVING }, None, ""),
        ]
    }

    #[test]
    fn each_kind_of_evidence_has_its_verdict() {
        for (name, evidence, status, word) in ends().into_iter().chain(reliability()).chain(told_and_outlined()) {
            let found = verdict(&evidence);
            assert_eq!(found.as_ref().map(|(status, _)| *status), status, "{name}: {found:?}");
            let message = found.and_then(|(_, message)| message).unwrap_or_default();
            assert!(message.contains(word) && message.is_empty() == word.is_empty(), "{name}: {message:?}");
        }
    }
}
