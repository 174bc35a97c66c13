//! The equations of pose and light, with the light eliminated.
//!
//! Let r be the residuals, J = dr/dpose, K = dr/dlight, w the weights, and Z the instrumental variables (Z = J for
//! least squares). The joint system is [A C; E^T D] [x; y] = -[a; d] with A = sum w Z^T J, C = sum w Z^T K, E = sum w
//! J^T K, D = sum w K^T K + precision of the light, a = sum w Z^T r, d = sum w K^T r. Eliminating y leaves the Schur
//! complement (A - C D^-1 E^T) x = -(a - C D^-1 d), the system of the pose with the light at its optimum; then y =
//! -D^-1 (d + E^T x). A known light has a single unknown, the exposure, which takes the first place of y with K = -1 in
//! all channels.

use nalgebra::{Cholesky, Const, SMatrix};

use super::residual::{Derivative, LinearisedPoints};
use super::state::Step;
use crate::light::{COEFFICIENTS, CoefficientMatrix, Coefficients, HARMONICS, Light, LightPrior, falling_by_turns};
use crate::numeric::{Doubles, Real};
use crate::pose::increment::{PoseMatrix, PoseVector, UNKNOWNS, fix_unknowns, inverse, product};
use crate::pose::sums::Sums;

/// One row for each unknown of the pose, one column for each of the light.
type PoseByLight = SMatrix<f64, UNKNOWNS, COEFFICIENTS>;

/// Relative damping of unknowns without any information, so that the factorisation exists. It is the rounding error of
/// 10^6 terms.
const LEAST_DAMPING: f64 = 1e-12;

/// Sums over points: those of the light, and those for the pose.
pub(super) struct Equations {
    light: LightEquations,
    /// A.
    pose: SquareSums,
    /// C^T if Z is not J; otherwise C^T is E^T.
    instrument_cross: Option<CrossSums>,
    /// E^T.
    cross: CrossSums,
    /// a.
    score: Derivative,
}

/// Sums over points side by side; each lane has separate sums.
pub(super) type SquareSums = [Derivative; UNKNOWNS];
type CrossSums = [Derivative; COEFFICIENTS];

/// Sums over points for the equations of the light: D and d.
pub(super) struct LightEquations {
    /// One channel's block of D up to its diagonal; all three channels have the same weights.
    gram: [[Doubles; HARMONICS]; HARMONICS],
    /// Contribution of the points to d, channel by channel.
    point_gradient: [[Doubles; HARMONICS]; 3],
    /// Contribution of the prior to D and d.
    precision: CoefficientMatrix,
    prior_gradient: Coefficients,
    /// Whether the exposure is the only unknown of the light.
    is_known: bool,
}

/// The equations of the pose after the elimination of the light.
pub(super) struct ReducedSystem {
    /// A - C D^-1 E^T: the information of the pose if Z = J.
    pub matrix: PoseMatrix,
    /// a - C D^-1 d.
    score: PoseVector,
    /// C D^-1.
    score_by_light: PoseByLight,
    /// D^-1 E^T: response of the light to a step of the pose.
    light_by_pose: SMatrix<f64, COEFFICIENTS, UNKNOWNS>,
    /// D^-1 d.
    light: Coefficients,
    light_is_known: bool,
}

impl LightEquations {
    pub fn new(light_is_known: bool) -> Self {
        Self {
            gram: [[Doubles::splat(0.0); HARMONICS]; HARMONICS],
            point_gradient: [[Doubles::splat(0.0); HARMONICS]; 3],
            precision: CoefficientMatrix::zeros(),
            prior_gradient: Coefficients::zeros(),
            is_known: light_is_known,
        }
    }

    /// Adds points, given the harmonics of their normals.
    #[inline(always)]
    pub fn add(&mut self, basis: &[Doubles; HARMONICS], residual: &[Doubles; 3], weight: Doubles) {
        if self.is_known {
            self.gram[0][0] = self.gram[0][0] + Doubles::splat(3.0) * weight;
            self.point_gradient[0][0] = self.point_gradient[0][0] - weight * (residual[0] + residual[1] + residual[2]);
            return;
        }
        for (row, sums) in self.gram.iter_mut().enumerate() {
            let share = weight * basis[row];
            for (sum, &other) in sums.iter_mut().zip(&basis[..=row]) {
                *sum = *sum + share * other;
            }
        }
        for (sums, &residual) in self.point_gradient.iter_mut().zip(residual) {
            let share = weight * residual;
            for (sum, &other) in sums.iter_mut().zip(basis) {
                *sum = *sum - share * other;
            }
        }
    }

    /// Adds the prior of an unknown light; `weight` is relative to squared residuals, `off` is the light minus the
    /// mean.
    pub fn add_prior(&mut self, prior: &LightPrior, weight: f64, off: &Coefficients) {
        if !self.is_known {
            self.precision += prior.precision() * weight;
            self.prior_gradient += prior.precision() * off * weight;
        }
    }

    /// The step of the light; `None` if the points do not determine it.
    pub fn step(&self) -> Option<Coefficients> {
        self.factor().map(|factor| -factor.solve(&self.gradient()))
    }

    /// d.
    fn gradient(&self) -> Coefficients {
        self.prior_gradient
            + Coefficients::from_iterator(self.point_gradient.as_flattened().iter().map(|sum| sum.sum()))
    }

    fn factor(&self) -> Option<Cholesky<f64, Const<COEFFICIENTS>>> {
        let mut light = self.precision;
        if self.is_known {
            light.fill_with_identity();
            light[(0, 0)] = self.gram[0][0].sum();
            return light.cholesky();
        }
        for row in 0..HARMONICS {
            for column in 0..HARMONICS {
                let value = self.gram[row.max(column)][row.min(column)].sum();
                for channel in 0..3 {
                    light[(channel * HARMONICS + row, channel * HARMONICS + column)] += value;
                }
            }
        }
        let most = light.diagonal().max();
        (0..COEFFICIENTS).for_each(|k| light[(k, k)] += LEAST_DAMPING * most);
        light.cholesky()
    }
}

impl Equations {
    /// Equations without points.
    pub fn new(light_is_known: bool, has_instruments: bool) -> Self {
        Self {
            light: LightEquations::new(light_is_known),
            pose: no_sums(),
            instrument_cross: has_instruments.then(no_sums),
            cross: no_sums(),
            score: [Doubles::splat(0.0); UNKNOWNS],
        }
    }

    /// Adds points.
    #[inline(always)]
    pub fn add(&mut self, points: &LinearisedPoints, weight: Doubles) {
        self.light.add(&points.basis, &points.residual, weight);
        let is_known = self.light.is_known;
        for channel in 0..3 {
            let jacobian = &points.jacobian[channel];
            let instrument = scaled(&points.instruments()[channel], weight);
            add_product(&mut self.pose, &instrument, jacobian);
            add_scaled(&mut self.score, &instrument, points.residual[channel]);
            let weighted = scaled(jacobian, weight);
            add_cross(&mut self.cross, channel, &weighted, &points.basis, is_known);
            if let Some(sums) = &mut self.instrument_cross {
                add_cross(sums, channel, &instrument, &points.basis, is_known);
            }
        }
    }

    /// Adds the prior of an unknown light, see [`LightEquations::add_prior`].
    pub fn add_prior(&mut self, prior: &LightPrior, weight: f64, off: &Coefficients) {
        self.light.add_prior(prior, weight, off);
    }

    /// Subtracts the contribution of noisy normals. `noise` is the contribution to products of harmonics; shading, its
    /// derivatives by rotation, and K are linear combinations of the harmonics under this light.
    #[inline(never)]
    pub fn take_off(&mut self, noise: SMatrix<f64, HARMONICS, HARMONICS>, light: &Light) {
        // The value in one of the lanes.
        let once = |value: f64| Doubles::from(std::array::from_fn(|lane| if lane == 0 { value } else { 0.0 }));
        for (channel, coefficients) in light.0.iter().enumerate() {
            let shade = SMatrix::<f64, HARMONICS, 1>::from(*coefficients);
            let turns = SMatrix::<f64, HARMONICS, 3>::from(falling_by_turns(coefficients));
            let (of_shade, of_turns) = (noise * shade, noise * turns);
            let (products, scores) = (turns.transpose() * of_turns, turns.transpose() * of_shade);
            for row in 0..3 {
                self.score[row] = self.score[row] + once(scores[row]);
                for column in 0..3 {
                    self.pose[row][column] = self.pose[row][column] - once(products[(row, column)]);
                }
            }
            if self.light.is_known {
                continue;
            }
            for k in 0..HARMONICS {
                let gradient = &mut self.light.point_gradient[channel][k];
                *gradient = *gradient - once(of_shade[k]);
                for sums in std::iter::once(&mut self.cross).chain(&mut self.instrument_cross) {
                    let sums = &mut sums[channel * HARMONICS + k];
                    (0..3).for_each(|axis| sums[axis] = sums[axis] + once(of_turns[(k, axis)]));
                }
            }
        }
        for (row, sums) in self.light.gram.iter_mut().enumerate().filter(|_| !self.light.is_known) {
            (0..=row).for_each(|column| sums[column] = sums[column] - once(noise[(row, column)]));
        }
    }

    /// Eliminates the light; `None` if the points do not determine it.
    pub fn reduce(&self) -> Option<ReducedSystem> {
        let factor = self.light.factor()?;
        // E^T and C^T: one row for each coefficient.
        let cross = folded(&self.cross);
        let instrument_cross = self.instrument_cross.as_ref().map(folded);
        let light_by_pose = factor.solve(&cross);
        let light = factor.solve(&self.light.gradient());
        let pose_cross = instrument_cross.as_ref().unwrap_or(&cross).transpose();
        Some(ReducedSystem {
            matrix: folded(&self.pose) - pose_cross * light_by_pose,
            score: PoseVector::from(self.score.map(Doubles::sum)) - pose_cross * light,
            score_by_light: instrument_cross.map_or(light_by_pose, |cross| factor.solve(&cross)).transpose(),
            light_by_pose,
            light,
            light_is_known: self.light.is_known,
        })
    }
}

impl ReducedSystem {
    /// Adds sums that do not depend on the light.
    pub fn add(&mut self, sums: &Sums) {
        self.matrix += sums.symmetric();
        self.score += sums.gradient;
    }

    /// Adds the product of a matrix and sums that do not depend on the light.
    pub fn add_weighted(&mut self, weight: &PoseMatrix, sums: &Sums) {
        self.matrix += product(weight, &sums.symmetric());
        self.score += weight * sums.gradient;
    }

    /// The step of pose and light, with the pose damped by a share of its diagonal; `held` unknowns do not move. `None`
    /// if the step is not finite.
    pub fn step(&self, damping: f64, held: &[bool; UNKNOWNS]) -> Option<Step> {
        let mut matrix = self.matrix;
        let mut score = self.score;
        let most = matrix.diagonal().max();
        for k in 0..UNKNOWNS {
            matrix[(k, k)] += damping * matrix[(k, k)].abs() + LEAST_DAMPING * most;
            score[k] = if held[k] { 0.0 } else { score[k] };
        }
        fix_unknowns(&mut matrix, held);
        let pose = -inverse(&matrix)? * score;
        let light = -(self.light + self.light_by_pose * pose);
        (pose.norm().is_finite() && light.norm().is_finite()).then_some(Step { pose, light })
    }

    /// Scores of points, their contributions to the right-hand side of the reduced system: sum over channels of (Z - C
    /// D^-1 K^T) r.
    pub fn score(&self, points: &LinearisedPoints) -> Derivative {
        let [mut sum] = no_sums();
        for (channel, &residual) in points.residual.iter().enumerate() {
            add_scaled(&mut sum, &points.instruments()[channel], residual);
            let mut add_light = |coefficient: usize, share: Doubles| {
                for (sum, &by_light) in sum.iter_mut().zip(&self.score_by_light.column(coefficient)) {
                    *sum = *sum + share * Doubles::splat(by_light);
                }
            };
            if self.light_is_known {
                add_light(0, residual);
                continue;
            }
            for (k, &basis) in points.basis.iter().enumerate() {
                add_light(channel * HARMONICS + k, residual * basis);
            }
        }
        sum
    }
}

/// Sums before any points.
pub(super) fn no_sums<const ROWS: usize>() -> [Derivative; ROWS] {
    [[Doubles::splat(0.0); UNKNOWNS]; ROWS]
}

/// Adds the outer product of two rows.
#[inline(always)]
pub(super) fn add_product(sums: &mut SquareSums, left: &Derivative, right: &Derivative) {
    for (sums, &share) in sums.iter_mut().zip(left) {
        add_scaled(sums, right, share);
    }
}

#[inline(always)]
fn add_scaled(sums: &mut Derivative, row: &Derivative, share: Doubles) {
    for (sum, &entry) in sums.iter_mut().zip(row) {
        *sum = *sum + share * entry;
    }
}

#[inline(always)]
pub(super) fn scaled(row: &Derivative, share: Doubles) -> Derivative {
    let mut scaled = *row;
    scaled.iter_mut().for_each(|entry| *entry = *entry * share);
    scaled
}

/// Sums over all lanes.
#[inline(never)]
pub(super) fn folded<const ROWS: usize>(sums: &[Derivative; ROWS]) -> SMatrix<f64, ROWS, UNKNOWNS> {
    SMatrix::from_fn(|row, column| sums[row][column].sum())
}

/// Adds K^T row, where K = -basis of this channel, or -1 if the exposure is the only unknown.
#[inline(always)]
fn add_cross(
    sums: &mut CrossSums,
    channel: usize,
    row: &Derivative,
    basis: &[Doubles; HARMONICS],
    light_is_known: bool,
) {
    if light_is_known {
        return add_scaled(&mut sums[0], row, Doubles::splat(-1.0));
    }
    for (sums, &value) in sums[channel * HARMONICS..].iter_mut().zip(basis) {
        for (sum, &entry) in sums.iter_mut().zip(row) {
            *sum = *sum - value * entry;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_prior_weighed_by_the_covariance_leads_to_the_mean_of_both() {
        let positive = |shift: f64| {
            let part = PoseMatrix::from_fn(|row, column| ((3 * row + 5 * column) as f64 + shift).sin());
            part * part.transpose() + PoseMatrix::identity()
        };
        let [matrix, covariance, precision] = [0.0, 1.0, 2.0].map(positive);
        let [of_image, initial] = [0.3, 0.7].map(|shift| PoseVector::from_fn(|k, _| (k as f64 + shift).cos()));
        let mut system = ReducedSystem {
            matrix,
            score: -matrix * of_image,
            score_by_light: PoseByLight::zeros(),
            light_by_pose: SMatrix::zeros(),
            light: Coefficients::zeros(),
            light_is_known: true,
        };
        let prior = Sums { matrix: precision, gradient: -precision * initial, cost: 0.0 };
        system.add_weighted(&product(&matrix, &covariance), &prior);
        let step = system.step(0.0, &[false; UNKNOWNS]).expect("a step");
        let by_image = inverse(&covariance).expect("positive");
        let mean = inverse(&(by_image + precision)).expect("positive") * (by_image * of_image + precision * initial);
        assert!((step.pose - mean).norm() < 1e-6, "{} {mean}", step.pose);
    }
}
