//! Information of the silhouette: points off the mask, and the occluding contour.

use super::registration::GradientRegistration;
use crate::numeric::robust;
use crate::pose::contrast::{ContrastProblem, by_pose};
use crate::pose::increment::{Frame, PoseMatrix, PoseVector};
use crate::pose::silhouette::SLACK;
use crate::pose::similarity::Similarity;

/// Weight of a square of this side, pixels, off the mask. Nearby points share their error.
const OUTSIDE_WEIGHT: f64 = 18.0;
const OUTSIDE_SIDE: f64 = 4.0;
/// Weight of this length of occluding contour, pixels.
const CONTOUR_WEIGHT: f64 = 6.0;
const CONTOUR_LENGTH: f64 = 8.0;
/// Robust scales, pixels. That of the contour is tighter, because contours inside the mask, where one part of the
/// object hides another, do not belong to the silhouette.
const OUTSIDE_SCALE: f64 = 3.0;
const CONTOUR_SCALE: f64 = 2.0;

impl GradientRegistration {
    /// Adds the silhouette to matrix and gradient of the pose.
    pub(super) fn add_silhouette(
        &self,
        problem: &ContrastProblem<'_>,
        frame: &Frame,
        pose: &Similarity,
        (matrix, gradient): (&mut PoseMatrix, &mut PoseVector),
    ) {
        let spacing = self.samples.step * pose.scale / self.unit;
        let outside = OUTSIDE_WEIGHT * (spacing / OUTSIDE_SIDE).powi(2);
        let contour = CONTOUR_WEIGHT * spacing / CONTOUR_LENGTH;
        let mut add = |rows: [PoseVector; 2], slope: [f64; 2], off: f64, scale: f64, weight: f64| {
            let (row, off) = ((slope[0] * rows[0] + slope[1] * rows[1]) / self.unit, off / self.unit);
            let weight = weight * robust::weight((off / scale).powi(2));
            matrix.ger(weight, &row, &row, 1.0);
            gradient.axpy(weight * off, &row, 1.0);
        };
        for sample in &self.samples.list {
            let Some((place, rows)) = by_pose(problem, &pose.apply(sample.point), frame) else { continue };
            let (distance, slope) = self.silhouette.at(place);
            if distance > SLACK {
                add(rows, slope, distance - SLACK, OUTSIDE_SCALE, outside);
            }
        }
        for point in &self.seen.contour {
            let Some((place, rows)) = by_pose(problem, &pose.apply(*point), frame) else { continue };
            let (distance, slope) = self.silhouette.signed_at(place);
            add(rows, slope, distance, CONTOUR_SCALE, contour);
        }
    }
}
