//! One pose from local contrast and from the gradient domain.
//!
//! Both registrations use the same pixels, but weight them differently, so their errors are only partly the same. The
//! result is the mean of a mixture of both, weighted by the inverse variance of the rotation. Its covariance is that of
//! the mixture: the mean covariance plus the spread of both ends (law of total variance). It assumes nothing about the
//! correlation of the errors, and it grows where the ends differ.
//!
//! Limits: ends that differ by far more than their sigmas belong to different optima, where a mean would fit neither.

use nalgebra::Vector3;

use super::registration::GradientReport;
use crate::pose::contrast::ContrastReport;
use crate::pose::increment::{
    Frame, PoseMatrix, PoseVector, SCALE, TRANSLATION_Z, UNKNOWNS, clear_unknowns, rotation_vector,
};
use crate::pose::similarity::Similarity;
use crate::pose::uncertainty::{Uncertainty, describe, weakest_of};

/// Angle between both ends, in sigmas of the difference, above which they belong to different optima.
const LARGEST_DIFFERENCE: f64 = 3.0;

/// The pose from both registrations.
#[derive(Clone, Debug)]
pub struct Combination {
    pub pose: Similarity,
    pub uncertainty: Uncertainty,
    /// The other end, if the ends belong to different optima.
    pub rival: Option<Similarity>,
}

/// Combines the pose from local contrast with the one from the gradient domain. `None` without sigmas.
#[must_use]
pub fn combine(contrast: &ContrastReport, gradients: &GradientReport) -> Option<Combination> {
    let (frame, held) = (&contrast.frame, &gradients.held);
    let [first, second] = [&contrast.covariance, &gradients.covariance].map(|c| c.fixed_view::<3, 3>(0, 0).trace());
    let share = first / (first + second);
    let difference = step_between(frame, &contrast.pose, &gradients.pose, held);
    if !(share.is_finite() && difference.norm().is_finite()) {
        return None;
    }
    let square = difference.fixed_rows::<3>(0).norm_squared() / (first + second);
    if square > LARGEST_DIFFERENCE * LARGEST_DIFFERENCE {
        return Some(apart(contrast, gradients));
    }
    let pose = frame.change(&(share * difference)).after(&contrast.pose).orthonormal();
    let mut covariance = (1.0 - share) * contrast.covariance + share * gradients.covariance;
    covariance.ger(share * (1.0 - share), &difference, &difference, 1.0);
    clear_unknowns(&mut covariance, held);
    Some(Combination { pose, uncertainty: described(&covariance, frame, &pose, held), rival: None })
}

/// The end with the smaller sigma, and the other one as its rival.
fn apart(contrast: &ContrastReport, gradients: &GradientReport) -> Combination {
    let by_gradients = described(&gradients.covariance, &contrast.frame, &gradients.pose, &gradients.held);
    match by_gradients.largest_rotation() < contrast.uncertainty.largest_rotation() {
        true => Combination { pose: gradients.pose, uncertainty: by_gradients, rival: Some(contrast.pose) },
        false => {
            Combination { pose: contrast.pose, uncertainty: contrast.uncertainty.clone(), rival: Some(gradients.pose) }
        }
    }
}

fn described(covariance: &PoseMatrix, frame: &Frame, pose: &Similarity, held: &[bool; UNKNOWNS]) -> Uncertainty {
    describe(covariance, frame, pose, [held[TRANSLATION_Z], held[SCALE]], weakest_of(covariance))
}

/// The step of a frame that leads from one pose to another; zero for held unknowns.
fn step_between(frame: &Frame, from: &Similarity, to: &Similarity, held: &[bool; UNKNOWNS]) -> PoseVector {
    let rotation = rotation_vector(&(to.rotation * from.rotation.transpose()));
    let moved = to.apply(from.inverse().apply(frame.centre));
    let shift: Vector3<f64> = (moved - frame.centre) / frame.length;
    let growth = (to.scale / from.scale).ln();
    let step = [rotation.x, rotation.y, rotation.z, shift.x, shift.y, shift.z, growth];
    PoseVector::from_fn(|k, _| if held[k] { 0.0 } else { step[k] })
}
