//! State of a registration, pose and light, and a step of both.

use crate::light::{COEFFICIENTS, Coefficients, HARMONICS, Light};
use crate::pose::increment::{Frame, PoseVector};
use crate::pose::similarity::Similarity;

/// A pose and its light.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub pose: Similarity,
    pub light: Light,
    /// Offset of log S relative to a known light; zero if the light is free.
    pub exposure: f64,
}

/// A step of pose and light together. For a known light the first coefficient is the exposure, and the others are zero.
pub(super) struct Step {
    pub pose: PoseVector,
    pub light: Coefficients,
}

impl State {
    /// The state after a step of pose and light.
    pub fn stepped(&self, frame: &Frame, step: &Step, light_is_known: bool) -> Self {
        let pose = frame.change(&step.pose).after(&self.pose).orthonormal();
        Self { pose, ..self.relit(&step.light, light_is_known) }
    }

    /// The state after a step of the light under the same pose.
    pub fn relit(&self, step: &Coefficients, light_is_known: bool) -> Self {
        let mut next = *self;
        if light_is_known {
            next.exposure += step[0];
        } else {
            (0..COEFFICIENTS).for_each(|k| next.light.0[k / HARMONICS][k % HARMONICS] += step[k]);
        }
        next
    }

    /// The light with its exposure.
    pub fn exposed_light(&self) -> Light {
        self.light.exposed(self.exposure)
    }
}
