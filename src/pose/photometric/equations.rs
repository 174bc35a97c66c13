//! The equations of pose and light, the light projected out.
//!
//! With r the residuals, J = dr/dpose, K = dr/dlight, weights w, and Z the rows by which the pose listens to the
//! residuals (Z = J for least squares) the joint system is [A C; E^T D] [x; y] = -[a; d], A = sum w Z^T J, C = sum w
//! Z^T K, E = sum w J^T K, D = sum w K^T K + precision of the light, a = sum w Z^T r, d = sum w K^T r. Eliminating y
//! leaves the Schur complement (A - C D^-1 E^T) x = -(a - C D^-1 d), the system of the pose where the light follows it
//! at its best; then y = -D^-1 (d + E^T x). A known light has one unknown only, the exposure: it takes the first place
//! of y, and K = -1 in all channels.

use nalgebra::{Cholesky, Const, SMatrix};

use super::residual::{Linear, Motion};
use crate::light::{COEFFICIENTS, CoefficientMatrix, Coefficients, HARMONICS, LightPrior};
use crate::numeric::{Doubles, Real};
use crate::pose::increment::{Row, Square, UNKNOWNS};

type Cross = SMatrix<f64, UNKNOWNS, COEFFICIENTS>;

/// Relative damping of unknowns without any information, so that the factorisation exists: rounding of 10^6 terms.
const LEAST_DAMPING: f64 = 1e-12;

/// Sums over points: those of the light, and those that a pose adds.
pub(super) struct Equations {
    light: LightEquations,
    pose: SquareSums,
    /// C, where the pose listens by other rows than its Jacobian's.
    heard: Option<CrossSums>,
    /// E.
    cross: CrossSums,
    pose_slope: Motion,
}

/// Sums of points side by side, each lane by itself.
pub(super) type SquareSums = [Motion; UNKNOWNS];
type CrossSums = [Motion; COEFFICIENTS];

/// Sums over points for the light alone: D and d.
pub(super) struct LightEquations {
    /// One channel's block of D up to its diagonal: all three have the same weights.
    gram: [[Doubles; HARMONICS]; HARMONICS],
    /// The points' share of d, channel by channel.
    slopes: [[Doubles; HARMONICS]; 3],
    /// The prior's share of D and d.
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
            gram: [[Doubles::splat(0.0); HARMONICS]; HARMONICS],
            slopes: [[Doubles::splat(0.0); HARMONICS]; 3],
            precision: CoefficientMatrix::zeros(),
            slope: Coefficients::zeros(),
            is_known: light_is_known,
        }
    }

    /// Enters points by the harmonics of their normals.
    #[inline(always)]
    pub fn add(&mut self, basis: &[Doubles; HARMONICS], residual: &[Doubles; 3], weight: Doubles) {
        if self.is_known {
            self.gram[0][0] = self.gram[0][0] + Doubles::splat(3.0) * weight;
            self.slopes[0][0] = self.slopes[0][0] - weight * (residual[0] + residual[1] + residual[2]);
            return;
        }
        for (row, sums) in self.gram.iter_mut().enumerate() {
            let share = weight * basis[row];
            for (sum, &other) in sums.iter_mut().zip(&basis[..=row]) {
                *sum = *sum + share * other;
            }
        }
        for (sums, &residual) in self.slopes.iter_mut().zip(residual) {
            let share = weight * residual;
            for (sum, &other) in sums.iter_mut().zip(basis) {
                *sum = *sum - share * other;
            }
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
        self.factor().map(|factor| -factor.solve(&self.slope()))
    }

    /// d.
    fn slope(&self) -> Coefficients {
        self.slope + Coefficients::from_iterator(self.slopes.as_flattened().iter().map(|sum| sum.sum()))
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
    /// `listens`: the pose listens by rows of its own.
    pub fn new(light_is_known: bool, listens: bool) -> Self {
        Self {
            light: LightEquations::new(light_is_known),
            pose: no_sums(),
            heard: listens.then(no_sums),
            cross: no_sums(),
            pose_slope: [Doubles::splat(0.0); UNKNOWNS],
        }
    }

    /// Enters points.
    #[inline(always)]
    pub fn add(&mut self, point: &Linear, weight: Doubles) {
        self.light.add(&point.basis, &point.residual, weight);
        let is_known = self.light.is_known;
        for channel in 0..3 {
            let jacobian = &point.jacobian[channel];
            let heard = scaled(&point.listener()[channel], weight);
            add_product(&mut self.pose, &heard, jacobian);
            add_scaled(&mut self.pose_slope, &heard, point.residual[channel]);
            let weighted = scaled(jacobian, weight);
            enter(&mut self.cross, channel, &weighted, &point.basis, is_known);
            if let Some(sums) = &mut self.heard {
                enter(sums, channel, &heard, &point.basis, is_known);
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
        // E^T and C^T: a row for each coefficient.
        let cross = folded(&self.cross);
        let heard = self.heard.as_ref().map(folded);
        let follow = factor.solve(&cross);
        let solved = factor.solve(&self.light.slope());
        let listening = heard.as_ref().unwrap_or(&cross).transpose();
        Some(Reduced {
            matrix: folded(&self.pose) - listening * follow,
            slope: Row::from(self.pose_slope.map(Doubles::sum)) - listening * solved,
            heard: heard.map_or(follow, |heard| factor.solve(&heard)).transpose(),
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

    /// What points say about the pose once the light has followed: sum over channels of (Z - C D^-1 K^T) r.
    pub fn score(&self, point: &Linear) -> Motion {
        let [mut sum] = no_sums();
        for (channel, &residual) in point.residual.iter().enumerate() {
            add_scaled(&mut sum, &point.listener()[channel], residual);
            let mut follow = |coefficient: usize, share: Doubles| {
                for (sum, &heard) in sum.iter_mut().zip(&self.heard.column(coefficient)) {
                    *sum = *sum + share * Doubles::splat(heard);
                }
            };
            if self.light_is_known {
                follow(0, residual);
                continue;
            }
            for (k, &basis) in point.basis.iter().enumerate() {
                follow(channel * HARMONICS + k, residual * basis);
            }
        }
        sum
    }
}

/// Sums of nothing yet.
pub(super) fn no_sums<const ROWS: usize>() -> [Motion; ROWS] {
    [[Doubles::splat(0.0); UNKNOWNS]; ROWS]
}

/// Adds the outer product of two rows.
#[inline(always)]
pub(super) fn add_product(sums: &mut SquareSums, left: &Motion, right: &Motion) {
    for (sums, &share) in sums.iter_mut().zip(left) {
        add_scaled(sums, right, share);
    }
}

#[inline(always)]
fn add_scaled(sums: &mut Motion, row: &Motion, share: Doubles) {
    for (sum, &entry) in sums.iter_mut().zip(row) {
        *sum = *sum + share * entry;
    }
}

#[inline(always)]
pub(super) fn scaled(row: &Motion, share: Doubles) -> Motion {
    let mut scaled = *row;
    scaled.iter_mut().for_each(|entry| *entry = *entry * share);
    scaled
}

/// The sums over all lanes.
#[inline(never)]
pub(super) fn folded<const ROWS: usize>(sums: &[Motion; ROWS]) -> SMatrix<f64, ROWS, UNKNOWNS> {
    SMatrix::from_fn(|row, column| sums[row][column].sum())
}

/// sum of row K with K = -basis of this channel, or -1 where only the exposure is unknown.
#[inline(always)]
fn enter(sums: &mut CrossSums, channel: usize, row: &Motion, basis: &[Doubles; HARMONICS], light_is_known: bool) {
    if light_is_known {
        return add_scaled(&mut sums[0], row, Doubles::splat(-1.0));
    }
    for (sums, &value) in sums[channel * HARMONICS..].iter_mut().zip(basis) {
        for (sum, &entry) in sums.iter_mut().zip(row) {
            *sum = *sum - value * entry;
        }
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
