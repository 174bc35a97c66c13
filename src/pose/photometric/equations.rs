//! The equations of pose and light, the light projected out.
//!
//! With r the residuals, J = dr/dpose, K = dr/dlight, weights w, and Z the rows by which the pose listens to the
//! residuals (Z = J for least squares) the joint system is [A C; E^T D] [x; y] = -[a; d], A = sum w Z^T J, C = sum w
//! Z^T K, E = sum w J^T K, D = sum w K^T K + precision of the light, a = sum w Z^T r, d = sum w K^T r. Eliminating y
//! leaves the Schur complement (A - C D^-1 E^T) x = -(a - C D^-1 d), the system of the pose where the light follows it
//! at its best; then y = -D^-1 (d + E^T x). A known light has one unknown only, the exposure: it takes the first place
//! of y, and K = -1 in all channels.

use nalgebra::{Cholesky, Const, SMatrix, Vector3};

use super::residual::Linear;
use crate::light::{COEFFICIENTS, CoefficientMatrix, Coefficients, HARMONICS, LightPrior};
use crate::pose::increment::{Row, Square, UNKNOWNS};

type Cross = SMatrix<f64, UNKNOWNS, COEFFICIENTS>;

/// Relative damping of unknowns without any information, so that the factorisation exists: rounding of 10^6 terms.
const LEAST_DAMPING: f64 = 1e-12;

/// Sums over points: those of the light, and those that a pose adds.
pub(super) struct Equations {
    light: LightEquations,
    pose: Square,
    /// C, where the pose listens by other rows than its Jacobian's.
    heard: Option<Cross>,
    cross: Cross,
    pose_slope: Row,
}

/// Sums over points for the light alone: D and d.
pub(super) struct LightEquations {
    /// One channel's block of D: all three have the same weights.
    gram: SMatrix<f64, HARMONICS, HARMONICS>,
    precision: CoefficientMatrix,
    slope: Coefficients,
    /// Whether only the exposure is unknown of the light.
    is_known: bool,
}

/// The pose's own system after the elimination of the light.
pub(super) struct Reduced {
    /// A - C D^-1 E^T: the information of the pose where Z = J.
    pub matrix: Square,
    slope: Row,
    /// C D^-1.
    heard: Cross,
    /// D^-1 E^T.
    follow: SMatrix<f64, COEFFICIENTS, UNKNOWNS>,
    /// D^-1 d.
    light: Coefficients,
    light_is_known: bool,
}

impl LightEquations {
    pub fn new(light_is_known: bool) -> Self {
        Self {
            gram: SMatrix::zeros(),
            precision: CoefficientMatrix::zeros(),
            slope: Coefficients::zeros(),
            is_known: light_is_known,
        }
    }

    /// Enters a point by the harmonics of its normal.
    pub fn add(&mut self, basis: &[f64; HARMONICS], residual: &Vector3<f64>, weight: f64) {
        if self.is_known {
            self.gram[(0, 0)] += 3.0 * weight;
            self.slope[0] -= weight * residual.sum();
            return;
        }
        for (k, value) in basis.iter().enumerate() {
            let share = weight * value;
            (k..HARMONICS).for_each(|row| self.gram[(row, k)] += share * basis[row]);
            (0..3).for_each(|channel| self.slope[channel * HARMONICS + k] -= share * residual[channel]);
        }
    }

    /// Enters the prior of an unknown light; `weight` is its share against squared residuals, `off` the light less the
    /// mean.
    pub fn add_prior(&mut self, prior: &LightPrior, weight: f64, off: &Coefficients) {
        if !self.is_known {
            self.precision += prior.precision() * weight;
            self.slope += prior.precision() * off * weight;
        }
    }

    /// The light's step; `None` where the points do not determine it.
    pub fn step(&self) -> Option<Coefficients> {
        self.factor().map(|factor| -factor.solve(&self.slope))
    }

    fn factor(&self) -> Option<Cholesky<f64, Const<COEFFICIENTS>>> {
        let mut light = self.precision;
        if self.is_known {
            light.fill_with_identity();
            light[(0, 0)] = self.gram[(0, 0)];
            return light.cholesky();
        }
        for channel in 0..3 {
            for row in 0..HARMONICS {
                for column in 0..HARMONICS {
                    let value = self.gram[(row.max(column), row.min(column))];
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
    /// `listens`: the pose listens by rows of its own.
    pub fn new(light_is_known: bool, listens: bool) -> Self {
        Self {
            light: LightEquations::new(light_is_known),
            pose: Square::zeros(),
            heard: listens.then(Cross::zeros),
            cross: Cross::zeros(),
            pose_slope: Row::zeros(),
        }
    }

    /// Enters a point.
    pub fn add(&mut self, point: &Linear, weight: f64) {
        self.light.add(&point.basis, &point.residual, weight);
        for channel in 0..3 {
            let heard = weight * point.listener[channel];
            self.pose.ger(1.0, &heard, &point.jacobian[channel], 1.0);
            self.pose_slope.axpy(point.residual[channel], &heard, 1.0);
            let known = self.light.is_known;
            enter(&mut self.cross, channel, &(weight * point.jacobian[channel]), &point.basis, known);
            if let Some(sum) = &mut self.heard {
                enter(sum, channel, &heard, &point.basis, known);
            }
        }
    }

    /// Enters the prior of an unknown light, see [`LightEquations::add_prior`].
    pub fn add_prior(&mut self, prior: &LightPrior, weight: f64, off: &Coefficients) {
        self.light.add_prior(prior, weight, off);
    }

    /// Eliminates the light; `None` where the points do not determine it.
    pub fn reduce(&self) -> Option<Reduced> {
        let factor = self.light.factor()?;
        let follow = factor.solve(&self.cross.transpose());
        let solved = factor.solve(&self.light.slope);
        let heard = self.heard.as_ref().unwrap_or(&self.cross);
        Some(Reduced {
            matrix: self.pose - heard * follow,
            slope: self.pose_slope - heard * solved,
            heard: if self.heard.is_some() { factor.solve(&heard.transpose()).transpose() } else { follow.transpose() },
            follow,
            light: solved,
            light_is_known: self.light.is_known,
        })
    }
}

impl Reduced {
    /// Steps of pose and light, the pose's damped by a share of its diagonal; `held` unknowns stay. `None` where the
    /// step is not finite.
    pub fn step(&self, damping: f64, held: &[bool; UNKNOWNS]) -> Option<(Row, Coefficients)> {
        let mut matrix = self.matrix;
        let mut slope = self.slope;
        let most = matrix.diagonal().max();
        for k in 0..UNKNOWNS {
            matrix[(k, k)] += damping * matrix[(k, k)].abs() + LEAST_DAMPING * most;
            slope[k] = if held[k] { 0.0 } else { slope[k] };
        }
        hold(&mut matrix, held);
        let pose = -matrix.lu().solve(&slope)?;
        let light = -(self.light + self.follow * pose);
        (pose.norm().is_finite() && light.norm().is_finite()).then_some((pose, light))
    }

    /// What a point says about the pose once the light has followed: sum over channels of (Z - C D^-1 K^T) r.
    pub fn score(&self, point: &Linear) -> Row {
        (0..3).fold(Row::zeros(), |mut sum, channel| {
            let residual = point.residual[channel];
            sum.axpy(residual, &point.listener[channel], 1.0);
            if self.light_is_known {
                sum.axpy(residual, &self.heard.column(0), 1.0);
            } else {
                for (k, basis) in point.basis.iter().enumerate() {
                    sum.axpy(residual * basis, &self.heard.column(channel * HARMONICS + k), 1.0);
                }
            }
            sum
        })
    }
}

/// sum of row K with K = -basis of this channel, or -1 where only the exposure is unknown.
fn enter(sum: &mut Cross, channel: usize, row: &Row, basis: &[f64; HARMONICS], light_is_known: bool) {
    if light_is_known {
        sum.column_mut(0).axpy(-1.0, row, 1.0);
        return;
    }
    for (k, value) in basis.iter().enumerate() {
        sum.column_mut(channel * HARMONICS + k).axpy(-value, row, 1.0);
    }
}

/// Makes `held` unknowns inert: no row, no column, one on the diagonal.
pub(super) fn hold(matrix: &mut Square, held: &[bool; UNKNOWNS]) {
    for k in (0..UNKNOWNS).filter(|&k| held[k]) {
        matrix.row_mut(k).fill(0.0);
        matrix.column_mut(k).fill(0.0);
        matrix[(k, k)] = 1.0;
    }
}
