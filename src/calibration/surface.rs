//! Samples of the depth map with their normals, for shading, information and silhouette.

use nalgebra::{Matrix3, Vector3};

use crate::numeric::eigen::symmetric_eigen;

use super::frame::Frame;
use super::intensity::{UNKNOWN, levels};

/// Number of neighbours to each side in the fit of a plane, enough to average the steps of a quantised map.
const REACH: usize = 3;
/// Minimum number of neighbours that determine a plane.
const FEWEST: usize = 12;

/// A point of the depth map with its normal, in the depth camera's frame.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub index: usize,
    pub point: Vector3<f64>,
    pub normal: Vector3<f64>,
    /// The patch of the surface that it belongs to; the first until samples are grouped.
    pub patch: u8,
    /// The level of its intensity.
    pub level: u8,
}

/// About `most` samples, evenly spaced on the raster.
pub(super) fn samples(frame: &Frame, most: usize) -> Vec<Sample> {
    let valid = frame.points.iter().filter(|point| !point[2].is_nan()).count();
    let stride = ((valid as f64 / most as f64).sqrt().ceil() as usize).max(1);
    let grid = frame.grid;
    let rows = (stride / 2..grid.height).step_by(stride);
    let places = rows.flat_map(|row| (stride / 2..grid.width).step_by(stride).map(move |column| (column, row)));
    let mut samples: Vec<Sample> = places.filter_map(|(column, row)| sample(frame, column, row)).collect();
    if let Some(intensity) = &frame.intensity {
        let of = |sample: &Sample| intensity.get(sample.index).copied().unwrap_or(f32::NAN);
        let own: Vec<f32> = samples.iter().map(of).collect();
        samples.iter_mut().zip(levels(&own)).for_each(|(sample, level)| sample.level = level);
    }
    samples
}

fn sample(frame: &Frame, column: usize, row: usize) -> Option<Sample> {
    let grid = frame.grid;
    let index = grid.index(column, row);
    let point = frame.point(index)?;
    let gap = frame.clear_gap(point.norm());
    let (mut count, mut sum, mut squares) = (0_usize, Vector3::zeros(), Matrix3::zeros());
    for row in row.saturating_sub(REACH)..=(row + REACH).min(grid.height - 1) {
        for column in column.saturating_sub(REACH)..=(column + REACH).min(grid.width - 1) {
            let Some(other) = frame.point(grid.index(column, row)) else { continue };
            let offset = other - point;
            if (other.norm() - point.norm()).abs() > gap {
                continue;
            }
            count += 1;
            sum += offset;
            squares += offset * offset.transpose();
        }
    }
    if count < FEWEST {
        return None;
    }
    let mean = sum / count as f64;
    let eigen = symmetric_eigen(&(squares / count as f64 - mean * mean.transpose()))?;
    let normal: Vector3<f64> = eigen.eigenvectors.column(eigen.eigenvalues.imin()).into();
    let normal = if normal.dot(&point) > 0.0 { -normal } else { normal };
    Some(Sample { index, point, normal, patch: 0, level: UNKNOWN })
}
