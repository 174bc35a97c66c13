//! Which depth point is which image pixel (the paper's 1-pixel rule), with occlusion in both directions.
//!
//! A depth point is carried by the pose and projected. It corresponds to the pixel that it falls on if the pixel is on the
//! mask, the point faces the colour camera, no other depth point hides it there (z-buffer), the image surface does
//! not hide it from the depth camera (z-buffer of the reverse view), and both surfaces are close to each other. How close
//! is the caller's threshold, or follows the robust spread of the distances, never below one pixel: a surface
//! from shading under poor light is off by several pixels although every pose but one is worse.
//!
//! Of several points on one pixel the nearest to its centre is kept. Limits: the z-buffers have the views' resolution, so
//! parts thinner than two pixels may be judged wrongly; organised clouds have no depth camera and skip the reverse test.

use nalgebra::Vector3;

use crate::pose::Similarity;
use crate::view::{Camera, ColourView, DepthView, Normals, Points, Size, quantile};

/// A point counts as hidden when it lies this many image pixels behind the nearest one: more than a steep slope drops
/// between neighbours, less than a nose stands before a cheek.
const HIDDEN_BEHIND: f64 = 3.0;
/// Least accepted distance in image pixels: the paper's threshold.
const LEAST_DISTANCE: f64 = 1.0;
/// Cosine at the rim: flatter views of a surface have no reliable pixel.
const RIM: f64 = 0.05;
/// Inliers are within this multiple of the median distance.
const INLIER_SPREADS: f32 = 3.0;

/// What decides about correspondences. Points and normals are NaN where missing.
#[derive(Clone, Copy)]
pub struct CorrespondenceProblem<'a> {
    /// The colour view.
    pub image: &'a ColourView,
    /// The depth view.
    pub depth: &'a DepthView,
    /// The pose.
    pub pose: &'a Similarity,
    /// Points of the depth view, its own frame.
    pub depth_points: &'a Points,
    /// Normals of the depth view, its own frame.
    pub depth_normals: &'a Normals,
    /// Points of the image surface; NaN before there is one, then only visibility decides.
    pub image_points: &'a Points,
    /// Normals of the image surface.
    pub image_normals: &'a Normals,
    /// Accepted distance of both surfaces in units of the colour view; `None` follows the data.
    pub distance: Option<f64>,
    /// Length of an image pixel at the object in units of the colour view.
    pub pixel_length: f64,
    /// Multiple of the robust spread that the data-driven threshold accepts.
    pub spreads: f64,
}

/// Correspondences in both directions; owns its memory.
#[derive(Clone, Debug)]
pub struct Correspondences {
    depth_of_pixel: Vec<i32>,
    /// Squared distance of the kept point from its pixel's centre.
    off_centre: Vec<f32>,
    column: Vec<f32>,
    row: Vec<f32>,
    image_buffer: Vec<f32>,
    depth_buffer: Vec<f32>,
    gaps: Vec<f32>,
    sorted: Vec<f32>,
    count: usize,
    inliers: f64,
}

impl Correspondences {
    /// No correspondence yet, memory for two views.
    #[must_use]
    pub fn new(image: &ColourView, depth: &DepthView) -> Self {
        let (pixels, points) = (image.size.len(), depth.size.len());
        Self {
            depth_of_pixel: vec![-1; pixels],
            off_centre: vec![f32::INFINITY; pixels],
            column: vec![f32::NAN; points],
            row: vec![f32::NAN; points],
            image_buffer: vec![f32::INFINITY; pixels],
            depth_buffer: vec![f32::INFINITY; points],
            gaps: vec![f32::NAN; points],
            sorted: Vec::with_capacity(points),
            count: 0,
            inliers: 0.0,
        }
    }

    /// For each image pixel the index of its depth pixel, or -1.
    #[must_use]
    pub fn depth_of_pixel(&self) -> &[i32] {
        &self.depth_of_pixel
    }

    /// Continuous image column and row of each depth pixel, NaN where it has no counterpart.
    #[must_use]
    pub fn position(&self) -> [&[f32]; 2] {
        [&self.column, &self.row]
    }

    /// Depth pixels that have a counterpart.
    pub fn visible_points(&self) -> impl Iterator<Item = usize> {
        (0..self.column.len()).filter(|&index| !self.column[index].is_nan())
    }

    /// Number of measured depth pixels that have a counterpart.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Share of them whose distance is within the robust scale.
    #[must_use]
    pub const fn inliers(&self) -> f64 {
        self.inliers
    }

    /// Finds the correspondences of a pose. Allocates nothing.
    pub fn update(&mut self, problem: &CorrespondenceProblem<'_>) {
        self.project(problem);
        self.hide(problem);
        if !problem.depth.organised {
            self.hide_from_depth_camera(problem);
        }
        self.accept_near(problem);
        self.assign(problem);
    }

    /// Places of all points that face the camera and fall on the mask, and the z-buffer of the colour view.
    fn project(&mut self, problem: &CorrespondenceProblem<'_>) {
        let size = problem.image.size;
        self.image_buffer.fill(f32::INFINITY);
        for index in 0..self.column.len() {
            (self.column[index], self.row[index], self.gaps[index]) = (f32::NAN, f32::NAN, f32::NAN);
            if !problem.depth_points.is_valid(index) {
                continue;
            }
            let point = carried(problem, index);
            let Some([column, row]) = problem.image.camera.project(size, point.into()) else { continue };
            splat(size, &mut self.image_buffer, [column, row], point.z as f32);
            let normal = problem.pose.rotation * vector(problem.depth_normals.get(index));
            // A normal that is missing (a hole not yet filled) does not exclude its point.
            if normal.dot(&sight(&problem.image.camera, point)) > -RIM {
                continue;
            }
            let pixel = size.nearest(column as f32, row as f32);
            if pixel.is_some_and(|pixel| problem.image.mask[pixel]) {
                (self.column[index], self.row[index]) = (column as f32, row as f32);
            }
        }
    }

    /// Drops the points that lie behind others in the colour view.
    fn hide(&mut self, problem: &CorrespondenceProblem<'_>) {
        let tolerance = (HIDDEN_BEHIND * problem.pixel_length) as f32;
        for index in 0..self.column.len() {
            let Some(pixel) = problem.image.size.nearest(self.column[index], self.row[index]) else { continue };
            if carried(problem, index).z as f32 > self.image_buffer[pixel] + tolerance {
                self.column[index] = f32::NAN;
                self.row[index] = f32::NAN;
            }
        }
    }

    /// Drops the points that the image surface hides from the depth camera.
    fn hide_from_depth_camera(&mut self, problem: &CorrespondenceProblem<'_>) {
        let inverse = problem.pose.inverse();
        let size = problem.depth.size;
        self.depth_buffer.fill(f32::INFINITY);
        for pixel in (0..problem.image_points.len()).filter(|&pixel| problem.image_points.is_valid(pixel)) {
            let point = inverse.apply(vector(problem.image_points.get(pixel)));
            if let Some([column, row]) = problem.depth.camera.project(size, point.into()) {
                splat(size, &mut self.depth_buffer, [column, row], point.z as f32);
            }
        }
        // The image surface is an estimate: only what it hides by a clear margin is hidden.
        let tolerance = (2.0 * HIDDEN_BEHIND * problem.pixel_length / problem.pose.scale) as f32;
        for index in 0..self.column.len() {
            if problem.depth_points.z[index] > self.depth_buffer[index] + tolerance {
                self.column[index] = f32::NAN;
                self.row[index] = f32::NAN;
            }
        }
    }

    /// Drops the points that are too far from the image surface.
    fn accept_near(&mut self, problem: &CorrespondenceProblem<'_>) {
        let size = problem.image.size;
        self.sorted.clear();
        for index in 0..self.column.len() {
            let Some(pixel) = size.nearest(self.column[index], self.row[index]) else { continue };
            let gap = vector(problem.image_points.get(pixel)) - carried(problem, index);
            let gap = gap.dot(&vector(problem.image_normals.get(pixel))).abs() as f32;
            self.gaps[index] = gap;
            if !gap.is_nan() && !problem.depth.depth[index].is_nan() {
                self.sorted.push(gap);
            }
        }
        let median = if self.sorted.is_empty() { 0.0 } else { quantile(&mut self.sorted, 0.5) };
        let follows = (problem.spreads * f64::from(median)).max(LEAST_DISTANCE * problem.pixel_length);
        let threshold = problem.distance.unwrap_or(follows) as f32;
        let inlier = (INLIER_SPREADS * median).min(threshold);
        (self.count, self.inliers) = (0, 0.0);
        for index in 0..self.column.len() {
            // A point over a pixel without a surface has no distance, and stays.
            if self.gaps[index] > threshold {
                (self.column[index], self.row[index]) = (f32::NAN, f32::NAN);
            } else if !self.column[index].is_nan() && !problem.depth.depth[index].is_nan() {
                self.count += 1;
                self.inliers += f64::from(u8::from(self.gaps[index].is_nan() || self.gaps[index] <= inlier));
            }
        }
        self.inliers /= self.count.max(1) as f64;
    }

    /// Gives each pixel the point nearest to its centre.
    fn assign(&mut self, problem: &CorrespondenceProblem<'_>) {
        self.depth_of_pixel.fill(-1);
        self.off_centre.fill(f32::INFINITY);
        for index in 0..self.column.len() {
            let (column, row) = (self.column[index], self.row[index]);
            let Some(pixel) = problem.image.size.nearest(column, row) else { continue };
            let off = (column - column.round()).powi(2) + (row - row.round()).powi(2);
            if off < self.off_centre[pixel] && problem.depth_normals.is_valid(index) {
                self.off_centre[pixel] = off;
                self.depth_of_pixel[pixel] = i32::try_from(index).unwrap_or(-1);
            }
        }
    }
}

fn vector(values: [f32; 3]) -> Vector3<f64> {
    Vector3::from(values.map(f64::from))
}

fn carried(problem: &CorrespondenceProblem<'_>, index: usize) -> Vector3<f64> {
    problem.pose.apply(vector(problem.depth_points.get(index)))
}

/// Unit direction from the camera to a point.
fn sight(camera: &Camera, point: Vector3<f64>) -> Vector3<f64> {
    if camera.is_orthographic() { Vector3::z() } else { point.normalize() }
}

/// Enters a depth at the four pixels around a position, so that gaps between points let nothing through.
fn splat(size: Size, buffer: &mut [f32], position: [f64; 2], depth: f32) {
    let [left, top] = position.map(f64::floor);
    for (column, row) in [(left, top), (left + 1.0, top), (left, top + 1.0), (left + 1.0, top + 1.0)] {
        // A position on a pixel's centre enters that pixel alone.
        let near = (column - position[0]).abs() < 1.0 && (row - position[1]).abs() < 1.0;
        if near && column >= 0.0 && row >= 0.0 && column < size.width as f64 && row < size.height as f64 {
            let pixel = size.index(column as usize, row as usize);
            buffer[pixel] = buffer[pixel].min(depth);
        }
    }
}
