//! What a check found, as it is given out.

use nalgebra::SMatrix;

use super::cue::Cue;
use super::evidence::{Evidence, Tiles};
use super::frame::Frame;
use super::health::Health;
use super::reason::{CheckReason, Warning};
use super::registration::{Findings, Scene};
use super::sensitivity::Sensitivity;
use super::unknowns::POSE;
use super::verdict::{CandidateReport, CheckVerdict};
use crate::pose::Similarity;

/// What one cue contributed.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct CueReport {
    /// Which.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub cue: Cue,
    /// Of the answer's information, 0 .. 1.
    pub share: f64,
    /// One over its sigma, pixels of the colour image.
    pub sharpness: f64,
}

/// What one frame contributed.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct FrameReport {
    /// Its name.
    pub name: String,
    /// Of the answer's information, 0 .. 1.
    pub share: f64,
    /// What should be known about it.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub note: Option<String>,
}

/// What a check found.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct CheckReport {
    /// Of the first candidate; undecided without one.
    pub verdict: CheckVerdict,
    /// Why.
    #[cfg_attr(feature = "serde", serde(flatten, serialize_with = "super::serialised::coded"))]
    pub reason: CheckReason,
    /// What was guessed or looks wrong.
    pub warnings: Vec<Warning>,
    /// The extrinsics that fit best.
    pub estimate: Similarity,
    /// The scene's middle, colour frame, metres.
    pub middle: [f64; 3],
    /// Rotation vector in rad about the scene's middle, then translation in m; colour frame.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::serialised::rows"))]
    pub covariance: SMatrix<f64, POSE, POSE>,
    /// Factor of the colour camera's focal length, and its sigma, where it was looked for.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub focal: Option<[f64; 2]>,
    /// Of the estimate.
    pub health: Health,
    /// In the order given.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::serialised::candidates_by_name"))]
    pub candidates: Vec<CandidateReport>,
    /// Each that was asked for.
    #[cfg_attr(feature = "serde", serde(serialize_with = "super::serialised::cues_by_name"))]
    pub cues: Vec<CueReport>,
    /// In the order given.
    pub frames: Vec<FrameReport>,
    /// By cue and axis.
    pub sensitivity: Vec<Sensitivity>,
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
