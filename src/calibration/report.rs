//! The result of a check.

use nalgebra::SMatrix;

use super::cue::Cue;
use super::evidence::{Evidence, Tiles};
use super::frame::Frame;
use super::health::Health;
use super::next::NextFrame;
use super::reason::{CheckReason, Warning};
use super::registration::{Findings, Scene};
use super::sensitivity::Sensitivity;
use super::unknowns::POSE;
use super::verdict::{CandidateReport, CheckVerdict};
use crate::pose::Similarity;

/// The contribution of one cue.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct CueReport {
    /// The cue.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub cue: Cue,
    /// Share of the estimate's information, 0 .. 1.
    pub share: f64,
    /// The inverse of the sigma that this cue gives by itself, in pixels of the colour image.
    pub sharpness: f64,
}

/// The contribution of one frame.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FrameReport {
    /// Name of the frame.
    pub name: String,
    /// Share of the estimate's information, 0 .. 1.
    pub share: f64,
    /// A remark about the frame, if there is one.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub note: Option<String>,
}

/// The result of a check.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct CheckReport {
    /// Verdict on the first candidate; undecided without a candidate.
    pub verdict: CheckVerdict,
    /// The reason for the verdict.
    #[cfg_attr(feature = "serde", serde(flatten, serialize_with = "super::serialised::coded"))]
    pub reason: CheckReason,
    /// Warnings about guessed or implausible input.
    pub warnings: Vec<Warning>,
    /// The extrinsics that fit best.
    pub estimate: Similarity,
    /// Share of the depth points that the estimate puts onto the image, 0 .. 1.
    pub overlap: f64,
    /// The centre of the scene in the colour camera's frame, metres.
    pub middle: [f64; 3],
    /// Covariance of the rotation vector in rad about the scene's centre, then of the translation in m; colour camera's
    /// frame.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::serialised::rows"))]
    pub covariance: SMatrix<f64, POSE, POSE>,
    /// Factor of the colour camera's focal length and the sigma of its logarithm, if the focal length was estimated.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub focal: Option<[f64; 2]>,
    /// Expected error of the estimate.
    pub health: Health,
    /// Largest expected error that passes, pixels of the colour image.
    pub tolerance: f64,
    /// Reports on the candidates, in the order given.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::serialised::candidates_by_name"))]
    pub candidates: Vec<CandidateReport>,
    /// Reports on the requested cues.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::serialised::cues_by_name"))]
    pub cues: Vec<CueReport>,
    /// Reports on the frames, in the order given.
    pub frames: Vec<FrameReport>,
    /// Curves by cue and axis.
    pub sensitivity: Vec<Sensitivity>,
    /// The frame to take next, if the evidence shows one.
    #[cfg_attr(
        feature = "serde",
        serde(skip_serializing_if = "Option::is_none", serialize_with = "super::serialised::in_words")
    )]
    pub next: Option<NextFrame>,
}

impl CueReport {
    pub(super) fn all(findings: &Findings, pixel: f64) -> Vec<Self> {
        let informations: Vec<f64> = findings
            .cues
            .iter()
            .map(|(_, evidence, weight)| {
                let curvature = evidence.curvature();
                weight * (0..POSE).map(|k| curvature[(k, k)]).sum::<f64>() / POSE as f64
            })
            .collect();
        let total = informations.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let report = |((cue, ..), information): (&(Cue, Evidence, f64), &f64)| Self {
            cue: *cue,
            share: information / total,
            sharpness: information.max(0.0).sqrt() / pixel,
        };
        findings.cues.iter().zip(&informations).map(report).collect()
    }
}

impl FrameReport {
    pub(super) fn all(scene: &Scene, findings: &Findings) -> Vec<Self> {
        let mut start = 0;
        let traces: Vec<f64> = scene
            .frames
            .iter()
            .map(|frame| {
                let count = Tiles::new(frame.planes.size).count();
                let shares = findings.total.shares.iter().skip(start).take(count);
                start += count;
                shares.map(|share| share.curvature.trace()).sum()
            })
            .collect();
        let total = traces.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        let fair = 1.0 / traces.len() as f64;
        let report = |(frame, trace): (&Frame, &f64)| {
            let share = trace / total;
            let note =
                (share < 0.25 * fair).then(|| "adds little: its depth and its image have little in common".to_owned());
            Self { name: frame.name.clone(), share, note }
        };
        scene.frames.iter().zip(&traces).map(report).collect()
    }
}
