//! A log likelihood, its derivatives, and their reliability.
//!
//! Neighbouring depth discontinuities and pixels share their errors, so a sum over them is a composite likelihood. Its
//! maximum is right, but its curvature is too large. The check estimates the information from the scene itself. It
//! splits the sum into tiles of the image whose errors are independent. A cue is weighted by trace(H) / trace(J), with
//! the curvature H and J = sum over tiles g g^T; this ratio would be one for a true likelihood (Pauli, Racugno and
//! Ventura 2011). The covariance of the estimate is H^-1 plus the jackknife over tiles (Efron 1982), which unlike H^-1
//! J H^-1 is not overconfident if a few tiles hold most of the information.

use std::ops::AddAssign;

use super::unknowns::{Matrix, UNKNOWNS, Vector, add_square, solve, spectral};
use crate::numeric::eigen::symmetric_eigen;
use crate::view::Size;

/// Number of tiles along the longer side of an image. Tiles are so wide that their errors are independent, and so many
/// that their scatter can be estimated.
const TILES_ACROSS: usize = 10;

/// A partition of an image into tiles.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tiles {
    side: f64,
    columns: u32,
    rows: u32,
}

impl Tiles {
    pub fn new(size: Size) -> Self {
        let side = size.width.max(size.height) as f64 / TILES_ACROSS as f64;
        let along = |length: usize| (length as f64 / side).ceil() as u32;
        Self { side, columns: along(size.width), rows: along(size.height) }
    }

    pub fn of(&self, [column, row]: [f64; 2]) -> u32 {
        let place = |value: f64, count: u32| ((value / self.side).max(0.0) as u32).min(count - 1);
        place(row, self.rows) * self.columns + place(column, self.columns)
    }

    pub fn count(&self) -> usize {
        (self.columns * self.rows) as usize
    }
}

/// The contribution of one tile to a log likelihood: value, gradient, and negative second derivative.
#[derive(Clone, Copy, Debug)]
pub(super) struct Share {
    pub value: f64,
    pub gradient: Vector,
    pub curvature: Matrix,
}

impl Share {
    pub fn none() -> Self {
        Self { value: 0.0, gradient: Vector::zeros(), curvature: Matrix::zeros() }
    }
}

/// Traces of the curvature H and of the scatter J of a log likelihood's tiles.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Traces {
    pub curvature: f64,
    pub scatter: f64,
}

impl Traces {
    /// The weight trace(H) / trace(J), at most one.
    pub fn weight(self) -> f64 {
        if self.curvature <= 0.0 || self.scatter <= 0.0 { 0.0 } else { (self.curvature / self.scatter).min(1.0) }
    }
}

impl AddAssign for Traces {
    fn add_assign(&mut self, other: Self) {
        self.curvature += other.curvature;
        self.scatter += other.scatter;
    }
}

/// A log likelihood over all frames, tile by tile.
#[derive(Clone, Debug, Default)]
pub(super) struct Evidence {
    pub shares: Vec<Share>,
}

impl Evidence {
    pub fn value(&self) -> f64 {
        self.shares.iter().map(|share| share.value).sum()
    }
    pub fn gradient(&self) -> Vector {
        self.shares.iter().map(|share| share.gradient).sum()
    }
    pub fn curvature(&self) -> Matrix {
        self.shares.iter().map(|share| share.curvature).sum()
    }

    /// trace(H) and trace(J), with the gradients of tiles extrapolated to the point at which their sum vanishes.
    pub fn traces(&self) -> Traces {
        let curvature = self.curvature();
        let ridge = 1e-3 * curvature.trace().abs() / UNKNOWNS as f64 + f64::MIN_POSITIVE;
        let step = solve(&(curvature + Matrix::identity() * ridge), &self.gradient()).unwrap_or_else(Vector::zeros);
        let scatter: f64 =
            self.shares.iter().map(|share| (share.gradient - share.curvature * step).norm_squared()).sum();
        Traces { curvature: curvature.trace(), scatter }
    }

    /// Adds this log likelihood, times `weight`, to another one over the same tiles.
    pub fn add_to(&self, total: &mut Self, weight: f64) {
        total.shares.resize(total.shares.len().max(self.shares.len()), Share::none());
        for (sum, share) in total.shares.iter_mut().zip(&self.shares) {
            sum.value += weight * share.value;
            sum.gradient += share.gradient * weight;
            sum.curvature += share.curvature * weight;
        }
    }

    /// Covariance of the maximum of this log likelihood with a prior: the inverse curvature plus the jackknife, which
    /// leaves out one tile after the other.
    pub fn covariance(&self, prior: &Matrix) -> Option<Matrix> {
        let curvature = self.curvature() + prior;
        let whole = curvature.cholesky()?.inverse();
        let gradient = self.gradient();
        let mut covariance = whole;
        for share in self.shares.iter().filter(|share| share.gradient.norm() > 0.0) {
            // The gradient of the tile extrapolated to the maximum, so that a remaining total gradient does not count as
            // scatter.
            let own = share.gradient - share.curvature * (whole * gradient);
            let step = solve(&(curvature - share.curvature), &own).unwrap_or_else(|| whole * own);
            add_square(&mut covariance, &step, 1.0);
        }
        Some(covariance)
    }
}

/// The nearest matrix without negative eigenvalues.
pub(super) fn positive(matrix: &Matrix) -> Matrix {
    symmetric_eigen(matrix).map_or(Matrix::zeros(), |eigen| spectral(&eigen, |value| value.max(0.0)))
}
