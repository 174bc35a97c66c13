//! Reports in the form of the JavaScript contract: codes with their sentences, lists of numbers, members by name.

use nalgebra::SMatrix;
use serde::{Serialize, Serializer};

use super::next::{NextFrame, NextMotion};
use super::reason::CheckReason;
use super::report::CueReport;
use super::sensitivity::AXES;
use super::unknowns::POSE;
use super::verdict::{CandidateReport, ORDER};
use crate::pose::Similarity;

pub(super) fn coded<S: Serializer>(reason: &CheckReason, serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Explained {
        code: &'static str,
        reason: String,
        #[serde(skip_serializing_if = "Option::is_none")]
        reading: Option<&'static str>,
    }
    let reading = if let CheckReason::Misread { reading, .. } = reason { Some(reading.code()) } else { None };
    Explained { code: reason.code(), reason: reason.to_string(), reading }.serialize(serializer)
}

pub(super) fn rows<S: Serializer>(matrix: &SMatrix<f64, POSE, POSE>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_seq(matrix.transpose().iter())
}

pub(super) fn candidates_by_name<S: Serializer>(
    candidates: &[CandidateReport],
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.collect_map(candidates.iter().map(|one| (&one.name, one)))
}

pub(super) fn cues_by_name<S: Serializer>(cues: &[CueReport], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(cues.iter().map(|one| (one.cue, one)))
}

pub(super) fn in_words<S: Serializer>(next: &Option<NextFrame>, serializer: S) -> Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Explained<'a> {
        axis: &'static str,
        sigma: f64,
        frame: &'a str,
        motion: NextMotion,
        pose: &'a Similarity,
        expected: f64,
        message: String,
    }
    let explained = next.as_ref().map(|next| {
        let axis = ORDER.iter().position(|unknown| *unknown == next.axis).map_or("", |axis| AXES[axis]);
        let NextFrame { sigma, frame, motion, pose, expected, .. } = next;
        let (sigma, motion, expected) = (*sigma, *motion, *expected);
        Explained { axis, sigma, frame, motion, pose, expected, message: next.to_string() }
    });
    explained.serialize(serializer)
}
