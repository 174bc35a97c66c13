//! A Gaussian about an initial pose: over its rotation and over the position of the object's centre.

use nalgebra::Vector3;

use super::increment::{Frame, PoseVector, rotation_vector};
use super::similarity::Similarity;
use crate::check::positive;
use crate::error::Result;

/// A pose with its sigmas.
#[derive(Clone, Copy, Debug)]
pub struct PosePrior {
    /// The pose.
    pub pose: Similarity,
    /// Sigma of the rotation about each axis, radians.
    pub rotation: f64,
    /// Sigma of the object's centre across the line of sight, units of the colour view.
    pub across: f64,
    /// Sigma of the object's centre along the line of sight, units of the colour view.
    pub along: f64,
}

impl PosePrior {
    /// # Errors
    /// [`ErrorKind::Range`](crate::ErrorKind::Range) if the pose is not a similarity or a sigma is not positive.
    pub(super) fn validate(&self, field: &'static str) -> Result<()> {
        self.pose.validate(field)?;
        let sigmas = [("rotation", self.rotation), ("across", self.across), ("along", self.along)];
        sigmas.into_iter().try_for_each(|(name, sigma)| positive(name, sigma).map_err(|error| error.below(field)))
    }

    /// Calls `visit` with each residual of a pose, in sigmas, and its derivative by the unknowns of `frame`; `middle`
    /// is the object's centre in the depth view's frame.
    pub(super) fn for_each(
        &self,
        middle: Vector3<f64>,
        pose: &Similarity,
        frame: &Frame,
        mut visit: impl FnMut(&PoseVector, f64),
    ) {
        let turned = -rotation_vector(&(self.pose.rotation * pose.rotation.transpose()));
        let place = pose.apply(middle);
        let moved = place - self.pose.apply(middle);
        for axis in 0..3 {
            let mut row = PoseVector::zeros();
            row[axis] = 1.0 / self.rotation;
            visit(&row, turned[axis] / self.rotation);
            let sigma = if axis < 2 { self.across } else { self.along };
            let direction = Vector3::from_fn(|k, _| if k == axis { 1.0 / sigma } else { 0.0 });
            visit(&frame.row(&place, &direction), moved[axis] / sigma);
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Rotation3;

    use super::*;
    use crate::pose::increment::UNKNOWNS;

    #[test]
    fn rows_are_the_derivatives_of_the_residuals() {
        let turned = |by: Vector3<f64>| Rotation3::new(by).into_inner();
        let initial = Similarity {
            scale: 1.0,
            rotation: turned(Vector3::new(0.1, 0.2, -0.3)),
            translation: Vector3::new(0.1, -0.2, 0.9),
        };
        let prior = PosePrior { pose: initial, rotation: 0.05, across: 0.02, along: 0.07 };
        let middle = Vector3::new(0.03, 0.01, 0.6);
        let residuals = |pose: &Similarity, frame: &Frame| {
            let mut found = Vec::new();
            prior.for_each(middle, pose, frame, |row, residual| found.push((*row, residual)));
            found
        };
        let pose = Similarity {
            rotation: turned(Vector3::new(0.02, -0.01, 0.015)) * initial.rotation,
            translation: initial.translation + Vector3::new(0.01, 0.02, -0.03),
            ..initial
        };
        let frame = Frame { centre: Vector3::new(0.2, 0.1, 1.2), length: 0.1 };
        let before = residuals(&pose, &frame);
        assert!((before[0].1 / (0.02 / 0.05) - 1.0).abs() < 0.02, "{}", before[0].1);
        let small = 1e-6;
        for k in 0..UNKNOWNS - 1 {
            let mut step = PoseVector::zeros();
            step[k] = small;
            let after = residuals(&frame.change(&step).after(&pose), &frame);
            for ((row, before), (_, after)) in before.iter().zip(&after) {
                // Rotation vectors add up except for products of small angles.
                assert!(
                    (row[k] - (after - before) / small).abs() < 0.5,
                    "{k}: {} {}",
                    row[k],
                    (after - before) / small
                );
            }
        }
    }
}
