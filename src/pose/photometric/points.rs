//! The depth points that take part in a round.

use nalgebra::Vector3;

use super::problem::{Indices, PhotometricProblem};
use crate::numeric::{DOUBLE_LANES, Doubles, robust};
use crate::pose::increment::Frame;
use crate::pose::residuals::NORMAL_ERROR;
use crate::pose::similarity::Similarity;
use crate::pose::spline_image::SplineImage;
use crate::pose::visibility::{Visibility, VisibilityProblem};
use crate::view::{Size, extent};

/// Distance from the border of the mask within which points stay out, image pixels: they would enter and leave with
/// every step, and the spline is continued there.
const MARGIN: usize = 1;
/// Points that a coarse level needs: 20 for each unknown of the pose, 30 where the light's 27 unknowns come in as well,
/// which may fit the colours in a wrong pose. Measured on Mozart at 64x64, starts 20 and 30 degrees off.
const ENOUGH_KNOWN: usize = 100;
const ENOUGH_UNKNOWN: usize = 1000;
/// (5^(1/2) - 1) / 2.
const GOLDEN_SECTION: f64 = 0.618_033_988_749_895;

/// How many of the visible points take part.
#[derive(Clone, Copy)]
pub(super) struct Sampling {
    /// Every 2^level-th along both axes, more where that leaves too few.
    pub level: usize,
    /// About so many at most.
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

    /// The most that there can be.
    pub fn capacity(&self) -> usize {
        self.indices.capacity()
    }

    /// Chooses anew among the points that the image shows under `pose`.
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

    /// Whether the points are a sample of those that are visible.
    pub fn are_sampled(&self) -> bool {
        self.sampled
    }

    /// Leaves every k-th point, so that `most` or fewer are left of evenly spread ones: on a lattice, whose rows are
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

    /// Every `stride`-th visible point.
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

    /// The points side by side with their own weights. An odd last one comes twice, once without weight.
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
