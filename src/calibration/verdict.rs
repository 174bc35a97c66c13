//! What is said of a candidate, with numbers.
//!
//! A calibration is worth what its reprojection error at the scene's depth is: a turn and a shift that cancel there do no
//! harm there. The error of a candidate is the distance of its pixels from those of the estimate, root mean square over
//! the scene, and uncertain as the estimate is: its interval holds 95 % of Student's distribution about the estimate.
//!
//! Consistent: all of the interval is below the tolerance; or nothing speaks against the candidate (the estimate is farther from
//! the truth than from it in 5 % of cases and more), and the scene would show an error that counts (the estimate's own
//! error is below the tolerance in 95 % of cases). Off: all of the interval is above the tolerance, and the candidate is farther from the
//! estimate than the truth is in 95 % of cases; with six unknowns open hardly any draw is near a candidate, wherever it is.
//! Where the colour camera was guessed, all of the interval has to be above what that explains. An estimate that would itself be
//! off by its own interval speaks against nobody.
//! Else the scene can't tell.

use nalgebra::{SMatrix, SVector, Vector3};

use super::health::Health;
use super::reason::{CheckReason, Margin, Offset};
use super::unknowns::{Matrix, POSE, State, Units, Vector};
use crate::numeric::quantile;
use crate::numeric::random::Random;
use crate::pose::{Axis, Unknown};

/// Reprojection error that passes, pixels of an image 640 wide: 0.4 degrees at a usual focal length, what a
/// careful calibration by hand reaches and colours of points at rims need.
pub(super) const TOLERANCE: f64 = 3.5;
/// Draws from the estimate's distribution; its quantiles are then certain to about a twentieth of their sigma.
const DRAWS: usize = 2000;
const SEED: u64 = 1;
/// Share of draws inside an interval.
const INSIDE: f64 = 0.95;
/// Degrees of freedom of the estimate's distribution, the only number here that was fitted: what all of an outline shares moves its
/// tiles alike, so that their scatter is a guess of the error's size, on some scenes by far too small. The likelihood of 112 rendered
/// rigs' true errors is highest at 3.3 (docs/lab/thresholds.md); at 3 the distribution has a covariance still.
const DEGREES: f64 = 3.0;
/// Above this sigma an axis is not seen by a scene: about half of what the prior alone leaves open.
const UNSEEN_DEGREES: f64 = 2.0;
const UNSEEN_METRES: f64 = 0.03;

type PoseVector = SVector<f64, POSE>;
type PoseMatrix = SMatrix<f64, POSE, POSE>;

/// What can be said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum CheckVerdict {
    /// Within the tolerance.
    Consistent,
    /// Beyond it.
    Off,
    /// The scene can't tell.
    Undecided,
}

/// What is said of one candidate.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "camelCase"))]
pub struct CandidateReport {
    /// Its name.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub name: String,
    /// The word.
    pub verdict: CheckVerdict,
    /// Why.
    #[cfg_attr(feature = "serde", serde(flatten, serialize_with = "super::serialised::coded"))]
    pub reason: CheckReason,
    /// Turn from the estimate.
    pub off_degrees: f64,
    /// Shift of the scene's middle from the estimate's.
    pub off_millimetres: f64,
    /// Its reprojection error.
    #[cfg_attr(feature = "serde", serde(flatten))]
    pub health: Health,
    /// Probability of a distance as large, were it right.
    pub probability: f64,
}

/// The estimate's distribution in pixels of the scene.
pub(super) struct Judge {
    units: Units,
    /// Mean squared motion of the scene's pixels, original pixels.
    motion: PoseMatrix,
    inverse: PoseMatrix,
    draws: Vec<PoseVector>,
    tolerance: f64,
    /// Errors below these pixels have another explanation than a wrong candidate.
    explained: f64,
    /// Of the estimate.
    own: Health,
    /// What the estimate's error stays below in 95 % of cases.
    reach: f64,
}

impl Judge {
    /// Student's covariance over its scale.
    pub const VARIANCE: f64 = DEGREES / (DEGREES - 2.0);

    /// `cloud` in the colour camera's frame; `scale` of the distribution; `pixel` of the original image in one worked on; `width` of the original.
    pub fn new(
        units: Units,
        camera: &crate::view::Pinhole,
        cloud: &[Vector3<f64>],
        scale: &Matrix,
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
        let scale: PoseMatrix = scale.fixed_view::<POSE, POSE>(0, 0).into();
        let root = scale.cholesky().map_or_else(PoseMatrix::zeros, |c| c.l());
        let mut random = Random::new(SEED, 0);
        let mut normal = || (0..12).map(|_| random.uniform()).sum::<f64>() - 6.0;
        let draws = (0..DRAWS)
            .map(|_| {
                // Student's: a normal over the root of a mean square; chi-square by Wilson and Hilferty (1931).
                let h = 2.0 / (9.0 * DEGREES);
                let mean_square = (1.0 - h + h.sqrt() * normal()).powi(3).max(1e-3);
                root * PoseVector::from_fn(|_, _| normal()) / mean_square.sqrt()
            })
            .collect();
        let inverse = scale.try_inverse().unwrap_or_else(PoseMatrix::zeros);
        let own = Health { pixels: 0.0, interval: [0.0; 2] };
        let mut judge = Self {
            units,
            motion,
            inverse,
            draws,
            tolerance: TOLERANCE * (width / 640.0).max(1.0),
            explained: 0.0,
            own,
            reach: 0.0,
        };
        judge.own = judge.health(&PoseVector::zeros());
        judge.reach = f64::from(quantile(&mut judge.errors(&PoseVector::zeros()), INSIDE));
        judge
    }

    /// The same where errors below these pixels have another explanation.
    pub fn explaining(self, pixels: f64) -> Self {
        Self { explained: pixels, ..self }
    }

    /// Errors of a state that is `offset` from the estimate, one for each draw.
    fn errors(&self, offset: &PoseVector) -> Vec<f32> {
        let error = |draw: &PoseVector| {
            let off = offset + draw;
            off.dot(&(self.motion * off)).max(0.0).sqrt() as f32
        };
        self.draws.iter().map(error).collect()
    }

    /// What these errors come to.
    fn health(&self, offset: &PoseVector) -> Health {
        let mut errors = self.errors(offset);
        let mean = errors.iter().map(|error| f64::from(*error).powi(2)).sum::<f64>() / errors.len() as f64;
        let mut at = |share: f64| f64::from(quantile(&mut errors, share));
        let tail = (1.0 - INSIDE) / 2.0;
        Health { pixels: mean.sqrt(), interval: [at(tail), at(1.0 - tail)] }
    }

    /// The estimate's own.
    pub const fn estimate(&self) -> Health {
        self.own
    }

    /// What a scene shows least of a pose, where it is next to nothing.
    pub fn weakest(&self, covariance: &Matrix) -> Option<Unknown> {
        const ORDER: [Unknown; POSE] = [
            Unknown::Rotation(Axis::X),
            Unknown::Rotation(Axis::Y),
            Unknown::Rotation(Axis::Z),
            Unknown::Translation(Axis::X),
            Unknown::Translation(Axis::Y),
            Unknown::Translation(Axis::Z),
        ];
        let worst = |k: usize| {
            let sigma = covariance[(k, k)].sqrt() * self.units.of[k];
            sigma / if k < 3 { UNSEEN_DEGREES.to_radians() } else { UNSEEN_METRES }
        };
        let k = (0..POSE).max_by(|&a, &b| worst(a).total_cmp(&worst(b)))?;
        (worst(k) > 1.0).then_some(ORDER[k])
    }

    /// How far the log posterior may fall within the distribution: half the squared distance of all but the farthest draws.
    pub fn likely(&self) -> f64 {
        let squared = |draw: &PoseVector| draw.dot(&(self.inverse * draw)) as f32;
        let mut distances: Vec<f32> = self.draws.iter().map(squared).collect();
        0.5 * f64::from(quantile(&mut distances, INSIDE))
    }

    /// Reprojection error that passes, pixels of the image.
    pub const fn tolerance(&self) -> f64 {
        self.tolerance
    }

    /// Nothing is known of a pose that puts hardly any point onto the image.
    pub fn blind(width: f64) -> Health {
        Health { pixels: width, interval: [0.0, width] }
    }

    /// The verdict on a candidate.
    pub fn judge(&self, name: &str, estimate: &State, candidate: &State, weakest: Option<Unknown>) -> CandidateReport {
        let between = self.units.between(estimate, candidate);
        let offset: PoseVector = between.fixed_rows::<POSE>(0).into();
        let health = self.health(&offset);
        let distance = offset.dot(&(self.inverse * offset));
        let farther = self.draws.iter().filter(|draw| draw.dot(&(self.inverse * **draw)) > distance).count();
        let probability = farther as f64 / self.draws.len() as f64;
        let is_likely = probability >= 1.0 - INSIDE;
        let offset = self.offset(&between);
        let (verdict, reason) = self.decide(health, is_likely, offset, weakest);
        CandidateReport {
            name: name.to_owned(),
            verdict,
            reason,
            off_degrees: offset.degrees,
            off_millimetres: offset.millimetres,
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

    /// The turn and the shift of a difference of states, with the axis of the largest part of each.
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
    /// What is said where no cue found anything to compare: the estimate is the first candidate, and its distribution the prior.
    pub(super) fn without_evidence(&mut self) {
        self.verdict = CheckVerdict::Undecided;
        self.reason = CheckReason::NoEvidence;
    }

    /// What is said where optima that are about as likely contradict each other.
    pub(super) fn between_optima(&mut self, tolerance: f64) {
        self.verdict = CheckVerdict::Undecided;
        self.reason = CheckReason::BetweenOptima(Margin { health: self.health, tolerance });
    }

    /// What is said where the check's end or the candidate puts hardly any point onto the image.
    #[inline(never)]
    pub(super) fn without_points(&mut self, is_end_seen: bool, width: f64) {
        (self.verdict, self.reason, self.probability) = if is_end_seen {
            (CheckVerdict::Off, CheckReason::NoPointsOnImage, 0.0)
        } else {
            self.health = Judge::blind(width);
            (CheckVerdict::Undecided, CheckReason::NoPoseOnImage, 1.0)
        };
    }
}
