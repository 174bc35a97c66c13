//! The depth points of a round.

use nalgebra::Vector3;

use super::problem::{Indices, PhotometricProblem};
use crate::numeric::{DOUBLE_LANES, Doubles, robust};
use crate::pose::increment::Frame;
use crate::pose::residuals::NORMAL_ERROR;
use crate::pose::similarity::Similarity;
use crate::pose::spline_image::SplineImage;
use crate::pose::visibility::{Visibility, VisibilityProblem};
use crate::view::{Size, extent};

/// Distance from the border of the mask within which points are left out, image pixels, because they would enter and
/// leave with every step, and the spline is only a continuation there.
const MARGIN: usize = 1;
/// Minimum number of points for a coarse level under a known light: about 15 for each unknown of the pose
/// (docs/lab/thresholds.md).
const ENOUGH_KNOWN: usize = 100;
/// Minimum number of points for a coarse level under an unknown light: 30 for each unknown, because the 27 unknowns of
/// the light may fit the image under a wrong pose (docs/lab/thresholds.md).
const ENOUGH_UNKNOWN: usize = 1000;
/// The golden section, (5^(1/2) - 1) / 2.
const GOLDEN_SECTION: f64 = 0.618_033_988_749_895;

/// Thinning of the visible points.
#[derive(Clone, Copy)]
pub(super) struct Sampling {
    /// Takes every 2^level-th point along both axes, more if too few are left.
    pub level: usize,
    /// Approximate maximum number of points.
    pub most: usize,
}

/// A fixed set of visible points; owns its memory.
pub(super) struct VisiblePoints {
    visible: Visibility,
    indices: Vec<u32>,
    sampled: bool,
    weights: Vec<f32>,
}

impl VisiblePoints {
    pub fn new(problem: &PhotometricProblem<'_>) -> Self {
        let length = problem.points.len();
        let capacity = (0..length).filter(|&index| problem.points.is_valid(index)).count();
        Self {
            visible: Visibility::new(problem.image.size.len(), length),
            indices: Vec::with_capacity(capacity),
            sampled: false,
            weights: Vec::with_capacity(capacity),
        }
    }

    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// Depth pixels of the points.
    pub fn indices(&self) -> impl Iterator<Item = usize> {
        self.indices.iter().map(|&index| index as usize)
    }

    /// Maximum number of points: all valid ones.
    pub fn capacity(&self) -> usize {
        self.indices.capacity()
    }

    /// Chooses among the points that the image shows under `pose`.
    pub fn update(
        &mut self,
        problem: &PhotometricProblem<'_>,
        pose: &Similarity,
        image: &SplineImage,
        sampling: Sampling,
    ) {
        let centre = pose.apply(problem.points.centroid());
        self.visible.update(
            &VisibilityProblem {
                image: problem.image,
                pose,
                points: problem.points,
                normals: problem.normals,
                pixel_length: problem.image.camera.focal_length().map_or(1.0, |focal_length| centre.z / focal_length),
            },
            &mut |_, _, _| true,
        );
        let enough = if problem.light.is_some() { ENOUGH_KNOWN } else { ENOUGH_UNKNOWN };
        for level in (0..=sampling.level).rev() {
            self.list(problem, image, 1 << level);
            if self.indices.len() >= enough {
                break;
            }
        }
        self.thin(problem.depth_size, sampling.most);
    }

    /// Whether the points are a sample of the visible ones.
    pub fn are_sampled(&self) -> bool {
        self.sampled
    }

    /// Keeps every k-th point, so that at most about `most` are left, evenly spread: on a lattice whose rows are
    /// shifted by the golden section of k.
    fn thin(&mut self, size: Size, most: usize) {
        let every = self.indices.len().div_ceil(most.max(1)).max(1);
        self.sampled = every > 1;
        if !self.sampled {
            return;
        }
        let shift = (GOLDEN_SECTION * every as f64).round() as usize;
        let mut kept = 0;
        for place in 0..self.indices.len() {
            let (column, row) = size.position(self.indices[place] as usize);
            if (column + shift * row).is_multiple_of(every) {
                (self.indices[kept], self.weights[kept]) = (self.indices[place], self.weights[place]);
                kept += 1;
            }
        }
        self.indices.truncate(kept);
        self.weights.truncate(kept);
    }

    /// Lists every `stride`-th visible point along both axes.
    fn list(&mut self, problem: &PhotometricProblem<'_>, image: &SplineImage, stride: usize) {
        self.indices.clear();
        self.weights.clear();
        let Visibility { column: columns, row: rows, .. } = &self.visible;
        for index in 0..columns.len() {
            let (column, row) = problem.depth_size.position(index);
            let position = [f64::from(columns[index]), f64::from(rows[index])];
            if column % stride != 0 || row % stride != 0 || !problem.normals.is_valid(index) {
                continue;
            }
            let error = problem.normal_error.map_or(0.0, |error| f64::from(error[index]));
            if !error.is_nan() && image.covers(position, MARGIN) {
                self.indices.push(index as u32);
                self.weights.push(robust::weight_of_square((error / NORMAL_ERROR).powi(2)) as f32);
            }
        }
    }

    /// The points side by side with their own weights. An odd last point comes twice, once with weight zero.
    pub fn lane_groups(&self) -> impl Iterator<Item = (Indices, Doubles)> {
        self.indices.chunks(DOUBLE_LANES).zip(self.weights.chunks(DOUBLE_LANES)).map(|(some, weights)| {
            let (mut indices, mut lanes) = ([some[0]; DOUBLE_LANES], [0.0; DOUBLE_LANES]);
            indices[..some.len()].copy_from_slice(some);
            lanes.iter_mut().zip(weights).for_each(|(lane, &weight)| *lane = f64::from(weight));
            (indices, Doubles::from(lanes))
        })
    }

    /// Centroid of the transformed points and their root mean square distance from it.
    pub fn frame(&self, problem: &PhotometricProblem<'_>, pose: &Similarity) -> Frame {
        let point = |&index: &u32| Vector3::from(problem.points.get(index as usize).map(f64::from));
        let (centre, spread) = extent(self.indices.iter().map(point));
        let length = pose.scale * spread;
        Frame { centre: pose.apply(centre), length: if length > 0.0 { length } else { 1.0 } }
    }

    /// The points' weights before robust weighting.
    pub fn weights(&self) -> &[f32] {
        &self.weights
    }

    /// Replaces these weights.
    pub fn reweigh(&mut self, weights: impl Iterator<Item = f32>) {
        self.weights.iter_mut().zip(weights).for_each(|(own, other)| *own = other);
    }

    /// Sum of the points' own weights.
    pub fn weight(&self) -> f64 {
        self.weights.iter().map(|&weight| f64::from(weight)).sum()
    }
}
