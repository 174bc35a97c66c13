//! The verdict on a candidate, from the distribution of the estimate.
//!
//! The quality of a calibration is its reprojection error at the scene's depth: a rotation and a shift that cancel at
//! this depth do no harm there. The error of a candidate is the distance of its pixels from those of the estimate, root
//! mean square over the scene. It is as uncertain as the estimate: its interval holds 95 % of the draws from the
//! estimate's distribution.
//!
//! Consistent: all of the interval lies below the tolerance. Or the candidate is not contradicted (at least 5 % of the
//! draws are less likely), and the scene would show a relevant error (the estimate's own error is below the tolerance in
//! 95 % of cases).
//!
//! Off: all of the interval lies above the tolerance, and 95 % of the draws are more likely than the candidate. The
//! second condition is needed because with six unknowns hardly any draw is near a candidate, wherever it is. If the
//! colour camera was guessed, all of the interval must also lie above the error that the guess explains. The interval
//! of the estimate's own error must not lie above these limits.
//!
//! Undecided: otherwise.

use nalgebra::Vector3;

use super::distribution::{Distribution, PoseMatrix, PoseVector, VARIANCE};
use super::health::Health;
use super::reason::{CheckReason, Margin, Offset};
use super::unknowns::{Matrix, POSE, State, Units, Vector};
use crate::numeric::quantile;
use crate::pose::{Axis, Unknown};

/// Smallest share of the depth points that the estimate has to put onto the image before it may judge a candidate. The
/// other points are not compared with anything, and a wrong pose can always fit a small part.
pub(super) const LEAST_COMPARED_SHARE: f64 = 0.15;
/// Largest reprojection error that passes, pixels of an image 640 wide, or 0.4 degrees at a common focal length.
/// Careful calibrations by hand reach this accuracy, and the colouring of points at depth discontinuities needs it.
pub(super) const TOLERANCE: f64 = 3.5;
/// Share of draws inside an interval.
const INSIDE: f64 = 0.95;
/// The 95 % quantile of chi-squared with as many degrees of freedom as a pose has.
const CHI_SQUARED: f64 = 12.59;
/// Sigma above which the scene does not constrain an axis: about half the sigma of the prior.
pub(super) const UNSEEN_DEGREES: f64 = 2.0;
pub(super) const UNSEEN_METRES: f64 = 0.03;

/// The unknowns of a pose in their order.
pub(super) const ORDER: [Unknown; POSE] = [
    Unknown::Rotation(Axis::X),
    Unknown::Rotation(Axis::Y),
    Unknown::Rotation(Axis::Z),
    Unknown::Translation(Axis::X),
    Unknown::Translation(Axis::Y),
    Unknown::Translation(Axis::Z),
];

/// The answer of a check about a candidate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum CheckVerdict {
    /// The error is within the tolerance.
    Consistent,
    /// The error is beyond the tolerance.
    Off,
    /// The scene does not determine the verdict.
    Undecided,
}

/// The report on one candidate.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "camelCase"))]
pub struct CandidateReport {
    /// Name of the candidate.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub name: String,
    /// The verdict.
    pub verdict: CheckVerdict,
    /// The reason for the verdict.
    #[cfg_attr(feature = "serde", serde(flatten, serialize_with = "super::serialised::coded"))]
    pub reason: CheckReason,
    /// Rotation from the estimate, degrees.
    pub off_degrees: f64,
    /// Shift of the scene's centre from that of the estimate, millimetres.
    pub off_millimetres: f64,
    /// Rotation and shift by axis, from the estimate to the candidate: degrees about x, y, z, then millimetres along
    /// them; colour camera's frame.
    pub off_axes: [f64; POSE],
    /// Expected reprojection error of the candidate.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub health: Health,
    /// Probability that a right candidate is at least this far from the estimate.
    pub probability: f64,
}

/// The distribution of the estimate, which judges candidates by the motion of the scene's pixels.
pub(super) struct Judge {
    units: Units,
    /// Mean squared motion of the scene's pixels, in pixels of the image as given.
    motion: PoseMatrix,
    distribution: Distribution,
    tolerance: f64,
    /// Errors below this many pixels may come from a guessed camera.
    explained: f64,
    /// Expected error of the estimate.
    own: Health,
    /// Number of pixels below which the estimate's error lies in 95 % of cases.
    reach: f64,
}

impl Judge {
    /// Decrease of the log posterior, in units of the scale, up to which a pose is an alternative to the best one. It
    /// is the decrease at the border of the ellipsoid that holds 95 % of a normal distribution with the reported
    /// covariance.
    pub const ALTERNATIVE: f64 = 0.5 * VARIANCE * CHI_SQUARED;

    /// `cloud` is in the colour camera's frame, and the distribution in `units`. `pixel` is the width of a
    /// working pixel in pixels of the image as given, and `width` is the width of that image.
    pub fn new(
        units: Units,
        camera: &crate::view::Pinhole,
        cloud: &[Vector3<f64>],
        distribution: Distribution,
        pixel: f64,
        width: f64,
    ) -> Self {
        let mut motion = PoseMatrix::zeros();
        let mut count = 0.0;
        for (_, rows) in cloud.iter().filter_map(|point| units.rows(point, camera)) {
            for row in rows {
                let row: PoseVector = row.fixed_rows::<POSE>(0).into();
                motion += row * row.transpose();
            }
            count += 1.0;
        }
        motion *= pixel * pixel / f64::max(count, 1.0);
        let own = Health { pixels: 0.0, interval: [0.0; 2] };
        let mut judge = Self {
            units,
            motion,
            distribution,
            tolerance: TOLERANCE * (width / 640.0).max(1.0),
            explained: 0.0,
            own,
            reach: 0.0,
        };
        judge.own = judge.health(&PoseVector::zeros());
        judge.reach = f64::from(quantile(&mut judge.errors(&PoseVector::zeros()), INSIDE));
        judge
    }

    /// The same judge, for which errors below this many pixels may be those of a guessed camera.
    pub fn explaining(self, pixels: f64) -> Self {
        Self { explained: pixels, ..self }
    }

    /// Errors of a state that is `offset` from the estimate, one for each draw.
    fn errors(&self, offset: &PoseVector) -> Vec<f32> {
        let error = |draw: &PoseVector| {
            let off = offset - draw;
            off.dot(&(self.motion * off)).max(0.0).sqrt() as f32
        };
        self.distribution.draws.iter().map(error).collect()
    }

    /// The expected error and its interval at an offset from the estimate.
    fn health(&self, offset: &PoseVector) -> Health {
        let mut errors = self.errors(offset);
        let mean = errors.iter().map(|error| f64::from(*error).powi(2)).sum::<f64>() / errors.len() as f64;
        let mut at = |share: f64| f64::from(quantile(&mut errors, share));
        let tail = (1.0 - INSIDE) / 2.0;
        Health { pixels: mean.sqrt(), interval: [at(tail), at(1.0 - tail)] }
    }

    /// Expected error of the estimate.
    pub const fn estimate(&self) -> Health {
        self.own
    }

    /// The axis that the scene constrains the least, if it hardly constrains it.
    pub fn weakest(&self, covariance: &Matrix) -> Option<Unknown> {
        let worst = |k: usize| {
            let sigma = covariance[(k, k)].sqrt() * self.units.of[k];
            sigma / if k < 3 { UNSEEN_DEGREES.to_radians() } else { UNSEEN_METRES }
        };
        let k = (0..POSE).max_by(|&a, &b| worst(a).total_cmp(&worst(b)))?;
        (worst(k) > 1.0).then_some(ORDER[k])
    }

    /// Density of the estimate's distribution at an offset from the estimate, up to a factor that all distributions share.
    pub fn density(&self, offset: &PoseVector) -> f64 {
        self.distribution.density(offset)
    }

    /// Largest reprojection error that passes, pixels of the image as given.
    pub const fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// The unknown error of a pose that puts hardly any point onto the image.
    pub fn blind(width: f64) -> Health {
        Health { pixels: width, interval: [0.0, width] }
    }

    /// The verdict on a candidate.
    pub fn judge(&self, name: &str, estimate: &State, candidate: &State, weakest: Option<Unknown>) -> CandidateReport {
        let between = self.units.between(estimate, candidate);
        let offset: PoseVector = between.fixed_rows::<POSE>(0).into();
        let health = self.health(&offset);
        let probability = self.distribution.probability(&offset);
        let is_likely = probability >= 1.0 - INSIDE;
        let offset = self.offset(&between);
        let (verdict, reason) = self.decide(health, is_likely, offset, weakest);
        CandidateReport {
            name: name.to_owned(),
            verdict,
            reason,
            off_degrees: offset.degrees,
            off_millimetres: offset.millimetres,
            off_axes: self.offset_by_axis(&between),
            health,
            probability,
        }
    }

    /// The verdict on a candidate with this error, and the reason for it.
    fn decide(
        &self,
        health: Health,
        is_likely: bool,
        offset: Offset,
        weakest: Option<Unknown>,
    ) -> (CheckVerdict, CheckReason) {
        let [low, high] = health.interval;
        let bound = self.tolerance.max(self.explained);
        let margin = Margin { health, tolerance: self.tolerance };
        if high <= self.tolerance {
            (CheckVerdict::Consistent, CheckReason::WithinTolerance(margin))
        } else if is_likely && self.reach <= self.tolerance {
            (CheckVerdict::Consistent, CheckReason::NothingAgainst { margin, shown: self.reach })
        } else if low > bound && self.own.interval[0] <= bound && !is_likely {
            (CheckVerdict::Off, CheckReason::OffTarget { margin, offset })
        } else if low > self.tolerance && low <= bound && !is_likely {
            (CheckVerdict::Undecided, CheckReason::GuessedCamera { margin, explained: self.explained })
        } else {
            let reason = match weakest {
                Some(weakest) => CheckReason::Unconstrained { margin, weakest },
                None => CheckReason::TooClose(margin),
            };
            (CheckVerdict::Undecided, reason)
        }
    }

    /// Degrees about the axes, then millimetres along them.
    fn offset_by_axis(&self, between: &Vector) -> [f64; POSE] {
        let metric = between.component_mul(&self.units.of);
        std::array::from_fn(|k| if k < 3 { metric[k].to_degrees() } else { metric[k] * 1000.0 })
    }

    /// The rotation and the shift between two states, with the axis of the largest part of each.
    fn offset(&self, between: &Vector) -> Offset {
        let metric = between.component_mul(&self.units.of);
        let axis = |first: usize| {
            let largest = (0..3).max_by(|&a, &b| metric[first + a].abs().total_cmp(&metric[first + b].abs()));
            [Axis::X, Axis::Y, Axis::Z][largest.unwrap_or(0)]
        };
        Offset {
            degrees: metric.fixed_rows::<3>(0).norm().to_degrees(),
            about: axis(0),
            millimetres: metric.fixed_rows::<3>(3).norm() * 1000.0,
            along: axis(3),
            distance: self.units.middle.norm(),
        }
    }
}

impl CandidateReport {
    /// Overrides the verdict if no cue found anything to compare: the estimate is then the first candidate, and its
    /// distribution the prior.
    pub(super) fn without_evidence(&mut self) {
        self.verdict = CheckVerdict::Undecided;
        self.reason = CheckReason::NoEvidence;
    }

    /// Overrides the verdict if the estimate puts only this share of the depth points onto the image.
    pub(super) fn with_little_overlap(&mut self, overlap: f64) {
        self.verdict = CheckVerdict::Undecided;
        self.reason = CheckReason::LittleOverlap { percent: 100.0 * overlap };
    }

    /// Overrides the verdict if optima that are about as likely contradict each other on the candidate.
    pub(super) fn between_optima(&mut self, tolerance: f64) {
        self.verdict = CheckVerdict::Undecided;
        self.reason = CheckReason::BetweenOptima(Margin { health: self.health, tolerance });
    }

    /// Overrides the verdict if the candidate puts hardly any point onto the image. `is_end_seen`: the best fit puts enough points
    /// there to be relied on.
    #[inline(never)]
    pub(super) fn without_points(&mut self, is_end_seen: bool, width: f64) {
        self.verdict = CheckVerdict::Off;
        self.probability = 0.0;
        self.reason = if is_end_seen {
            CheckReason::NoPointsOnImage
        } else {
            self.health = Judge::blind(width);
            CheckReason::NoPoseOnImage
        };
    }
}
