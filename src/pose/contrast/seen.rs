//! Samples that the image sees under a pose, and the contour at which the surface turns away.

use nalgebra::Vector3;

use super::problem::ContrastProblem;
use super::samples::Samples;
use crate::pose::similarity::Similarity;
use crate::pose::visibility::{HIDDEN_BEHIND, LEAST_FACING};
use crate::view::Size;

/// Neighbours farther apart than this many median steps do not belong to one surface.
const JUMP: f64 = 4.0;

/// Visible samples and occluding contour under one pose; owns its memory.
pub(in crate::pose) struct Seen {
    /// Nearest depth in each cell of the image; cells are as wide as the spacing of samples.
    buffer: Vec<f64>,
    size: Size,
    /// Width of a cell in image pixels.
    cell: f64,
    /// Whether each sample is visible, regardless of the mask.
    pub visible: Vec<bool>,
    /// Cosine between each sample's normal and the viewing direction, negative if it faces the camera.
    facing: Vec<f64>,
    /// Points of the depth view where the surface turns away from the image's camera; they have to lie on the
    /// silhouette.
    pub contour: Vec<Vector3<f64>>,
}

impl Seen {
    pub fn new(image: Size, samples: &Samples, pixels_per_sample: f64) -> Self {
        let cell = pixels_per_sample.max(1.0);
        let side = |length: usize| (length as f64 / cell).ceil() as usize + 1;
        let size = Size { width: side(image.width), height: side(image.height) };
        let count = samples.list.len();
        Self {
            buffer: vec![f64::INFINITY; size.len()],
            size,
            cell,
            visible: vec![false; count],
            facing: vec![0.0; count],
            contour: Vec::with_capacity(count),
        }
    }

    /// Updates visible samples and contour for a pose.
    pub fn look(&mut self, problem: &ContrastProblem<'_>, samples: &Samples, pose: &Similarity) {
        self.buffer.fill(f64::INFINITY);
        let camera = &problem.image.camera;
        let place = |point: &Vector3<f64>| camera.project(problem.image.size, (*point).into());
        for (k, sample) in samples.list.iter().enumerate() {
            let point = pose.apply(sample.point);
            self.facing[k] = (pose.rotation * sample.normal).z;
            if let Some(place) = place(&point) {
                self.enter(place, point.z);
            }
        }
        let tolerance = HIDDEN_BEHIND * self.cell;
        for (k, sample) in samples.list.iter().enumerate() {
            let point = pose.apply(sample.point);
            let nearest = place(&point).and_then(|place| self.at(place));
            self.visible[k] =
                self.facing[k] < -LEAST_FACING && nearest.is_some_and(|nearest| point.z <= nearest + tolerance);
        }
        self.find_contour(samples);
    }

    fn at(&self, [column, row]: [f64; 2]) -> Option<f64> {
        let pixel = self.size.nearest((column / self.cell) as f32, (row / self.cell) as f32)?;
        Some(self.buffer[pixel])
    }

    /// Enters a depth at the four cells around a position, so that gaps between samples are closed.
    fn enter(&mut self, [column, row]: [f64; 2], depth: f64) {
        let (column, row) = (column / self.cell, row / self.cell);
        for (right, down) in [(-0.5, -0.5), (0.5, -0.5), (-0.5, 0.5), (0.5, 0.5)] {
            if let Some(pixel) = self.size.nearest((column + right) as f32, (row + down) as f32) {
                self.buffer[pixel] = self.buffer[pixel].min(depth);
            }
        }
    }

    /// Finds where the facing changes its sign between neighbours on one surface.
    fn find_contour(&mut self, samples: &Samples) {
        self.contour.clear();
        for &pair in &samples.neighbours {
            let [a, b] = pair.map(|k| k as usize);
            let (here, there) = (self.facing[a], self.facing[b]);
            if (here < 0.0) != (there < 0.0) && samples.distance(pair) < JUMP * samples.step {
                self.contour.push(samples.list[a].point.lerp(&samples.list[b].point, here / (here - there)));
            }
        }
    }
}
