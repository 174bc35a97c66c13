//! Albedo that varies: log albedo = sum of regressors phi times coefficients, channel by channel.
//!
//! - *Relief*: dirt and ambient shadow lie in hollows, wear on ridges. Curvature of the depth map at two scales, and its
//!   squares, are regressors.
//! - *Stains*: smooth albedo that is independent of the shape. Bilinear tents on a coarse grid over the depth map are
//!   regressors.
//!
//! All coefficients have the same Gaussian prior. Like the light, they are eliminated from the equations
//! ([`equations`](super::equations)), so that a change of the pose that such an albedo can imitate has a large sigma.

use nalgebra::SMatrix;

use super::problem::{Indices, PhotometricProblem};
use super::weighting::CORRELATED;
use crate::light::HARMONICS;
use crate::numeric::{Doubles, Real};
use crate::pose::contrast::LocalMeans;
use crate::pose::increment::UNKNOWNS;
use crate::pose::residuals::MEASURED_SIDE;
use crate::view::{Normals, Size};

/// Number of regressors from the relief.
const RELIEF: usize = 4;
/// Number of tents along either side of a square around the object; set on pairs of a statue (docs/lab/thresholds.md).
const TENTS: usize = 6;
/// Number of coefficients of a channel.
const COEFFICIENTS: usize = RELIEF + TENTS * TENTS;
/// Number of regressors of a point that are not zero: those of the relief, and the tents of one cell.
const NONZERO: usize = RELIEF + 4;
/// Sigmas of the Gaussians, depth pixels of an object of the size of [`MEASURED_SIDE`].
const SCALES: [f64; 2] = [1.5, 4.0];
/// Curvatures are clamped to this many standard deviations.
const LARGEST: f32 = 2.5;
/// One sigma of a coefficient, log units: of a tent, and of a standard deviation of a curvature.
const PRIOR: f64 = 0.3;

/// Coefficients, one column for each channel.
pub(super) type AlbedoCoefficients = SMatrix<f64, COEFFICIENTS, 3>;

/// Columns of a channel's linearised residuals: J, Z, the harmonics and r.
const COLUMNS: usize = 2 * UNKNOWNS + HARMONICS + 1;
pub(super) const INSTRUMENTS: usize = UNKNOWNS;
pub(super) const BASIS: usize = 2 * UNKNOWNS;
pub(super) const RESIDUAL: usize = COLUMNS - 1;
/// These columns of points side by side.
pub(super) type PointColumns = [[Doubles; COLUMNS]; 3];
/// Sums of regressors times columns.
type Columns = SMatrix<f64, COEFFICIENTS, COLUMNS>;

/// The regressors of a depth map.
pub(super) struct VaryingAlbedo {
    relief: Vec<[f32; RELIEF]>,
    width: usize,
    /// Column and row of the first tent, and the distance between tents, depth pixels.
    corner: [usize; 2],
    spacing: f64,
}

/// Sums over points: phi w phi^T, and phi w times the columns of each channel.
pub(super) struct AlbedoSums {
    gram: SMatrix<f64, COEFFICIENTS, COEFFICIENTS>,
    columns: [Columns; 3],
}

/// The part of the columns that an albedo explains.
pub(super) struct ExplainedByAlbedo {
    /// Coefficients that fit each column.
    coefficients: [Columns; 3],
    /// The explained part of the products of columns.
    pub products: [SMatrix<f64, COLUMNS, COLUMNS>; 3],
}

/// Weight of squared coefficients relative to squared residuals; `noise` is the standard deviation of the residuals,
/// log units.
pub(super) fn ridge(noise: f64) -> f64 {
    CORRELATED * (noise / PRIOR).powi(2)
}

impl VaryingAlbedo {
    /// From the points and normals of a problem.
    pub fn new(problem: &PhotometricProblem<'_>) -> Self {
        let size = problem.depth_size;
        let [fine, coarse] = SCALES.map(|scale| curvature(size, problem.normals, scale));
        let relief = fine.into_iter().zip(coarse).map(|(a, b)| [a, b, a * a, b * b]).collect();
        let (mut least, mut most) = ([usize::MAX; 2], [0; 2]);
        for index in (0..size.len()).filter(|&index| problem.points.is_valid(index)) {
            for (axis, place) in <[usize; 2]>::from(size.position(index)).into_iter().enumerate() {
                (least[axis], most[axis]) = (least[axis].min(place), most[axis].max(place));
            }
        }
        let side = (0..2).map(|axis| most[axis].saturating_sub(least[axis])).max().unwrap_or(0).max(1);
        Self { relief, width: size.width, corner: least, spacing: side as f64 / (TENTS - 1) as f64 }
    }

    /// The regressors of a depth pixel that are not zero, with their numbers.
    fn regressors(&self, index: usize) -> [(usize, f64); NONZERO] {
        let place = [index % self.width, index / self.width];
        let [(column, right), (row, below)] = [0, 1].map(|axis: usize| {
            let place = place[axis].saturating_sub(self.corner[axis]) as f64 / self.spacing;
            let cell = (place as usize).min(TENTS - 2);
            (cell, (place - cell as f64).min(1.0))
        });
        let first = RELIEF + TENTS * row + column;
        let relief = self.relief[index].map(f64::from);
        [
            (0, relief[0]),
            (1, relief[1]),
            (2, relief[2]),
            (3, relief[3]),
            (first, (1.0 - right) * (1.0 - below)),
            (first + 1, right * (1.0 - below)),
            (first + TENTS, (1.0 - right) * below),
            (first + TENTS + 1, right * below),
        ]
    }

    /// Log albedo of a depth pixel.
    pub fn at(&self, coefficients: &AlbedoCoefficients, index: usize) -> [f64; 3] {
        let regressors = self.regressors(index);
        let sum = |channel: usize| regressors.iter().map(|&(k, value)| value * coefficients[(k, channel)]).sum();
        [sum(0), sum(1), sum(2)]
    }

    /// The part of the columns of a channel that an albedo explains at a depth pixel.
    pub fn explained(&self, by: &ExplainedByAlbedo, index: usize, channel: usize) -> [f64; COLUMNS] {
        let mut explained = [0.0; COLUMNS];
        for (k, value) in self.regressors(index) {
            let coefficients = by.coefficients[channel].row(k);
            explained.iter_mut().zip(coefficients.iter()).for_each(|(sum, coefficient)| *sum += value * coefficient);
        }
        explained
    }
}

impl AlbedoSums {
    /// Sums over no points yet.
    pub fn new() -> Box<Self> {
        Box::new(Self { gram: SMatrix::zeros(), columns: [Columns::zeros(); 3] })
    }

    /// Adds points side by side.
    pub fn add(&mut self, albedo: &VaryingAlbedo, indices: &Indices, weight: Doubles, columns: &PointColumns) {
        let weight = weight.array();
        for (lane, &index) in indices.iter().enumerate().filter(|(lane, _)| weight[*lane] > 0.0) {
            let regressors = albedo.regressors(index as usize);
            for (row, value) in regressors {
                let share = weight[lane] * value;
                regressors.iter().for_each(|&(column, other)| self.gram[(row, column)] += share * other);
                for (sums, columns) in self.columns.iter_mut().zip(columns) {
                    (0..COLUMNS).for_each(|column| sums[(row, column)] += share * columns[column].array()[lane]);
                }
            }
        }
    }

    /// Fits an albedo to each column, about the present one and under the prior with this ridge; `None` if a sum is not
    /// finite.
    pub fn explained(mut self: Box<Self>, ridge: f64, present: &AlbedoCoefficients) -> Option<Box<ExplainedByAlbedo>> {
        (0..COEFFICIENTS).for_each(|k| self.gram[(k, k)] += ridge);
        for (columns, present) in self.columns.iter_mut().zip(present.column_iter()) {
            columns.column_mut(RESIDUAL).axpy(-ridge, &present, 1.0);
        }
        let factor = self.gram.cholesky()?;
        let coefficients = self.columns.map(|columns| factor.solve(&columns));
        let products = std::array::from_fn(|channel| self.columns[channel].tr_mul(&coefficients[channel]));
        Some(Box::new(ExplainedByAlbedo { coefficients, products }))
    }
}

impl ExplainedByAlbedo {
    /// The step of the albedo that follows steps of the pose and of each channel's light.
    pub fn step(&self, pose: &[f64], light: [&[f64]; 3]) -> AlbedoCoefficients {
        AlbedoCoefficients::from_fn(|k, channel| {
            let row = self.coefficients[channel].row(k);
            let by_pose: f64 = pose.iter().enumerate().map(|(unknown, step)| row[unknown] * step).sum();
            let by_light: f64 = light[channel].iter().enumerate().map(|(k, step)| row[BASIS + k] * step).sum();
            row[RESIDUAL] + by_pose - by_light
        })
    }
}

/// Columns of points side by side.
pub(super) fn columns(
    [jacobian, instruments]: [&[[Doubles; UNKNOWNS]; 3]; 2],
    basis: &[Doubles; HARMONICS],
    residual: &[Doubles; 3],
) -> PointColumns {
    std::array::from_fn(|channel| {
        let mut columns = [residual[channel]; COLUMNS];
        columns[..INSTRUMENTS].copy_from_slice(&jacobian[channel]);
        columns[INSTRUMENTS..BASIS].copy_from_slice(&instruments[channel]);
        columns[BASIS..RESIDUAL].copy_from_slice(basis);
        columns
    })
}

/// Divergence of the normals, smoothed by a Gaussian, in standard deviations; zero where a neighbour is missing.
fn curvature(size: Size, normals: &Normals, scale: f64) -> Vec<f32> {
    let valid: Vec<f32> = (0..size.len()).map(|index| f32::from(u8::from(normals.is_valid(index)))).collect();
    let slope = |index: usize| if valid[index] > 0.0 { [normals.x[index], normals.y[index]] } else { [0.0; 2] };
    let slopes: Vec<[f32; 2]> = (0..size.len()).map(slope).collect();
    let count = valid.iter().sum::<f32>().max(1.0);
    let unit = f64::from(count).sqrt() / MEASURED_SIDE;
    let smooth = LocalMeans::new(size.width, size.len(), scale * unit).smoothed(&valid, &slopes);
    let divergence = |index: usize| {
        let (column, row) = size.position(index);
        let is_inside = column > 0 && row > 0 && column + 1 < size.width && row + 1 < size.height;
        if !is_inside || valid[index] == 0.0 {
            return 0.0;
        }
        let beside = [index - 1, index + 1, index - size.width, index + size.width];
        let [left, right, above, below] = beside.map(|at| smooth[at]);
        let is_whole = beside.iter().all(|&at| valid[at] > 0.0);
        if is_whole { right[0] - left[0] + below[1] - above[1] } else { 0.0 }
    };
    let mut curvature: Vec<f32> = (0..size.len()).map(divergence).collect();
    let square = curvature.iter().map(|value| value * value).sum::<f32>() / count;
    let spread = square.sqrt().max(f32::MIN_POSITIVE);
    curvature.iter_mut().for_each(|value| *value = (*value / spread).clamp(-LARGEST, LARGEST));
    curvature
}

