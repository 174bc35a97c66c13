//! Weights of residuals and prior in the objective, from the noise that is left.

use super::problem::PhotometricProblem;
use crate::diagnosis::excess;
use crate::light::{COEFFICIENTS, Light};
use crate::numeric::robust;

/// Largest factor on the robust scale if residuals exceed the noise. A narrow scale would settle on a part of the
/// object that light and normals happen to fit.
const LARGEST_WIDENING: f64 = 2.0;
/// Degrees of freedom of Student's t in the prior's tails. Under coloured lamps, which lie far outside the Gaussian, a
/// Gaussian prior would bias poses by degrees.
const PRIOR_DEGREES_OF_FREEDOM: f64 = 5.0;

/// Number of residuals that count as one independent error if the albedo varies. It determines the weight of other
/// terms relative to sums over residuals, that of the prior of a pose only during annealing. Set on pairs of a statue (docs/lab/thresholds.md).
pub(super) const CORRELATED: f64 = 640.0;

/// Weights of residuals and prior.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weighting {
    /// Value of |r|, in log units, at which a point's weight has fallen to a quarter.
    pub robust_scale: f64,
    /// Weight of the light's prior relative to squared residuals.
    pub prior: f64,
}

impl Weighting {
    /// Weights for the first fit of the light, before the residuals are known. The scale exceeds all residuals, so that
    /// all points count alike.
    pub const FIRST: Self = Self { robust_scale: 1e3, prior: 1e-2 };
}

/// The robust scale for residuals with this standard deviation per channel, log units.
pub(super) fn final_robust_scale(noise: f64) -> f64 {
    robust::SCALE_IN_SIGMAS * robust::NORM_OF_CHANNELS * noise * excess(noise, [1.0, LARGEST_WIDENING])
}

/// Weight of the prior at a light: that of a Gaussian near the natural lights, with the tails of Student's t for lights
/// unlike any natural one.
pub(super) fn prior_weight(problem: &PhotometricProblem<'_>, light: &Light, noise: f64) -> f64 {
    let distance = problem.prior.squared_distance(light);
    let tail = (PRIOR_DEGREES_OF_FREEDOM + COEFFICIENTS as f64) / (PRIOR_DEGREES_OF_FREEDOM + distance);
    problem.prior_weight * tail.min(1.0) * noise * noise
}
