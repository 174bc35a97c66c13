//! The equations of pose and light, the light projected out.
//!
//! With r the residuals, J = dr/dpose, K = dr/dlight, weights w, and Z the rows by which the pose listens to the residuals
//! (Z = J for least squares) the joint system is [A C; E^T D] [x; y] = -[a; d], A = sum w Z^T J, C = sum w Z^T K,
//! E = sum w J^T K, D = sum w K^T K + precision of the light, a = sum w Z^T r, d = sum w K^T r. Eliminating y leaves the
//! Schur complement (A - C D^-1 E^T) x = -(a - C D^-1 d), the system of the pose where the light follows it at its best;
//! then y = -D^-1 (d + E^T x). A known light has one unknown only, the exposure: it takes the first place of y, and
//! K = -1 in all channels.

use nalgebra::{Cholesky, Const, SMatrix};

use super::residual::Linear;
use crate::light::{COEFFICIENTS, CoefficientMatrix, Coefficients, HARMONICS, LightPrior};
use crate::pose::increment::{Row, Square, UNKNOWNS};

type Cross = SMatrix<f64, UNKNOWNS, COEFFICIENTS>;

/// Relative damping of unknowns without any information, so that the factorisation exists: rounding of 10^6 terms.
const LEAST_DAMPING: f64 = 1e-12;

/// Sums over points.
pub(super) struct Equations {
    pose: Square,
    heard: Cross,
    cross: Cross,
    /// One channel's block of D: all three have the same weights.
    gram: SMatrix<f64, HARMONICS, HARMONICS>,
    precision: CoefficientMatrix,
    pose_slope: Row,
    light_slope: Coefficients,
    /// Whether only the exposure is unknown of the light.
    light_is_known: bool,
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

impl Equations {
    pub fn new(light_is_known: bool) -> Self {
        Self {
            pose: Square::zeros(),
            heard: Cross::zeros(),
            cross: Cross::zeros(),
            gram: SMatrix::zeros(),
            precision: CoefficientMatrix::zeros(),
            pose_slope: Row::zeros(),
            light_slope: Coefficients::zeros(),
            light_is_known,
        }
    }

    /// Enters a point.
    pub fn add(&mut self, point: &Linear, weight: f64) {
        for channel in 0..3 {
            let heard = weight * point.listener[channel];
            self.pose.ger(1.0, &heard, &point.jacobian[channel], 1.0);
            self.pose_slope.axpy(point.residual[channel], &heard, 1.0);
            let moved = weight * point.jacobian[channel];
            if self.light_is_known {
                self.heard.column_mut(0).axpy(-1.0, &heard, 1.0);
                self.cross.column_mut(0).axpy(-1.0, &moved, 1.0);
                self.light_slope[0] -= weight * point.residual[channel];
                continue;
            }
            for (k, basis) in point.basis.iter().enumerate() {
                let place = channel * HARMONICS + k;
                self.heard.column_mut(place).axpy(-basis, &heard, 1.0);
                self.cross.column_mut(place).axpy(-basis, &moved, 1.0);
                self.light_slope[place] -= weight * basis * point.residual[channel];
            }
        }
        if self.light_is_known {
            self.gram[(0, 0)] += 3.0 * weight;
        } else {
            let basis = SMatrix::<f64, HARMONICS, 1>::from(point.basis);
            self.gram.syger(weight, &basis, &basis, 1.0);
        }
    }

    /// Enters the prior of an unknown light; `weight` is its share against squared residuals, `off` the light less the mean.
    pub fn add_prior(&mut self, prior: &LightPrior, weight: f64, off: &Coefficients) {
        if !self.light_is_known {
            self.precision += prior.precision() * weight;
            self.light_slope += prior.precision() * off * weight;
        }
    }

    /// Eliminates the light; `None` where the points do not determine it.
    pub fn reduce(&self) -> Option<Reduced> {
        let mut light = self.precision;
        if self.light_is_known {
            light.fill_with_identity();
            light[(0, 0)] = self.gram[(0, 0)];
        } else {
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
        }
        let factor: Cholesky<f64, Const<COEFFICIENTS>> = light.cholesky()?;
        let follow = factor.solve(&self.cross.transpose());
        let solved = factor.solve(&self.light_slope);
        Some(Reduced {
            matrix: self.pose - self.heard * follow,
            slope: self.pose_slope - self.heard * solved,
            heard: factor.solve(&self.heard.transpose()).transpose(),
            follow,
            light: solved,
            light_is_known: self.light_is_known,
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

    /// The light's step while the pose stays.
    pub fn light_step(&self) -> Coefficients {
        -self.light
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

/// Makes `held` unknowns inert: no row, no column, one on the diagonal.
pub(super) fn hold(matrix: &mut Square, held: &[bool; UNKNOWNS]) {
    for k in (0..UNKNOWNS).filter(|&k| held[k]) {
        matrix.row_mut(k).fill(0.0);
        matrix.column_mut(k).fill(0.0);
        matrix[(k, k)] = 1.0;
    }
}
