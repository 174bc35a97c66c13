//! Terms of the pose alone beside the colours: the object's points on the image's mask, and a Gaussian about an initial pose.
//!
//! A point of the object that lies off the mask is a residual like any other: far off, it costs as much as one whose colours do not fit
//! at all, the square of the robust scale. Nothing is asked of pixels of the mask that no point covers: the depth camera may not have seen
//! what is there.

use nalgebra::Vector3;

use super::problem::{PhotometricProblem, PosePrior};
use crate::numeric::robust;
use crate::pose::increment::{Frame, PoseMatrix, PoseVector, rotation_vector};
use crate::pose::silhouette::{SLACK, Silhouette};
use crate::pose::similarity::Similarity;
use crate::view::extent;

/// Points that are held against the mask at most.
const MOST_POINTS: usize = 2000;
/// Distance off the mask at which a point's weight has fallen to a quarter on each level of the image, pixels.
const SCALES: [f64; 4] = [3.0, 6.0, 12.0, 20.0];
/// Neighbouring residuals that err together count as one.
const CORRELATED: f64 = 64.0;

/// What is held against the mask; owns its memory.
pub(super) struct Anchors {
    silhouette: Option<Silhouette>,
    points: Vec<Vector3<f64>>,
    middle: Vector3<f64>,
}

/// Their sums.
#[derive(Clone, Copy)]
pub(super) struct AnchorSums {
    pub matrix: PoseMatrix,
    pub gradient: PoseVector,
    pub cost: f64,
}

/// Weights at one moment: of all points together, the square of the robust scale, the level of the image, the noise.
#[derive(Clone, Copy)]
pub(super) struct AnchorWeights {
    pub total: f64,
    pub largest: f64,
    pub level: usize,
    pub noise: f64,
}

impl Anchors {
    pub fn new(problem: &PhotometricProblem<'_>) -> Self {
        let object = &problem.image.whole.object;
        let valid: Vec<_> = problem.points.valid().collect();
        let stride = valid.len().div_ceil(MOST_POINTS).max(1);
        Self {
            silhouette: object.contains(&false).then(|| Silhouette::new(problem.image.size, object)),
            middle: extent(valid.iter().copied()).0,
            points: valid.into_iter().step_by(stride).collect(),
        }
    }

    /// The terms at a pose; derivatives by the unknowns of a frame.
    pub fn sums(
        &self,
        problem: &PhotometricProblem<'_>,
        prior: &PosePrior,
        pose: &Similarity,
        frame: &Frame,
        weights: AnchorWeights,
    ) -> AnchorSums {
        let mut sums = AnchorSums { matrix: PoseMatrix::zeros(), gradient: PoseVector::zeros(), cost: 0.0 };
        let AnchorWeights { total, largest, level, noise } = weights;
        let knob = |name: &str, default: f64| std::env::var(name).ok().map_or(default, |v| v.parse().unwrap());
        let scale = SCALES[level] * knob("KS", 1.0);
        let share = knob(if level == 0 { "KW0" } else { "KW" }, 0.5) * total * largest / self.points.len().max(1) as f64 / (scale * scale);
        if let Some(silhouette) = &self.silhouette {
            for point in &self.points {
                let point = pose.apply(*point);
                let Some((place, slopes)) =
                    problem.image.camera.project_with_gradient(problem.image.size, point.into())
                else {
                    continue;
                };
                let (distance, [right, down]) = silhouette.smoothly_signed_at(place);
                let off = distance - SLACK;
                if off > 0.0 {
                    let [across, low] = slopes.map(|slope| frame.row(&point, &slope.into()));
                    sums.add(&(right * across + down * low), off, share, scale);
                }
            }
        }
        let share = knob(if level == 0 { "KP0" } else { "KP" }, 10.0) * noise * noise * CORRELATED;
        let turned = -rotation_vector(&(prior.pose.rotation * pose.rotation.transpose()));
        let moved = pose.apply(self.middle) - prior.pose.apply(self.middle);
        let arm = pose.apply(self.middle);
        for axis in 0..3 {
            let mut row = PoseVector::zeros();
            row[axis] = 1.0 / prior.rotation;
            sums.add(&row, turned[axis] / prior.rotation, share, f64::INFINITY);
            let sigma = if axis < 2 { prior.across } else { prior.along };
            let mut unit = Vector3::zeros();
            unit[axis] = 1.0 / sigma;
            sums.add(&frame.row(&arm, &unit), moved[axis] / sigma, share, f64::INFINITY);
        }
        sums
    }
}

impl AnchorSums {
    fn add(&mut self, row: &PoseVector, residual: f64, weight: f64, scale: f64) {
        let square = (residual / scale).powi(2);
        let robust = weight * robust::weight(square);
        self.cost += weight * robust::rho(residual * residual, square);
        self.matrix.ger(robust, row, row, 1.0);
        self.gradient.axpy(robust * residual, row, 1.0);
    }
}
