//! Correspondences between depth points and image pixels (the paper's 1-pixel rule), with occlusion in both directions.
//!
//! See docs/method/surfaces.md. The pose transforms and projects a depth point. It corresponds to the pixel on which it
//! falls if the pixel is on the mask, the point faces the colour camera, no other depth point hides it there
//! (z-buffer), the image surface does not hide it from the depth camera (z-buffer of the reverse view), and both
//! surfaces are close to each other. The distance threshold comes from the caller or from the median distance. The
//! latter is at least one pixel, because a surface from shading under poor light is off by several pixels even under
//! the best pose.
//!
//! Of several points on one pixel, the nearest to its centre is kept. Where the depth camera sees a surface more
//! obliquely than the image does, some pixels lie between the points. They have no correspondence, but their
//! neighbours' normals apply to them ([`Correspondences::normal_at`]). Limits: the z-buffers have the views'
//! resolution, so parts thinner than two pixels may be misjudged; organised clouds have no depth camera and skip the
//! reverse test.

use nalgebra::Vector3;

use super::similarity::Similarity;
use super::visibility::{CloudProjection, HIDDEN_BEHIND, Visibility, VisibilityProblem};
use crate::numeric::{LANES, quantile};
use crate::view::{ColourView, DepthView, Normals, Points, Size};

/// Smallest accepted distance in image pixels: the paper's threshold.
const LEAST_DISTANCE: f64 = 1.0;
/// Tolerance of the reverse view relative to that of the colour view. The image surface is an estimate, so only points
/// that it hides by a clear margin count as hidden.
const REVERSE_TOLERANCE: f64 = 2.0;
/// Inliers are within this multiple of the median distance.
const INLIER_SPREADS: f32 = 3.0;
/// Maximum number of pixels between two points of one surface. A rotation by 70 degrees spreads depth pixels three
/// image pixels apart, which leaves gaps of two.
const WIDEST_GAP: usize = 2;
/// The points on either side of a gap belong to one surface if they are at most this many depth pixels apart along
/// either axis.
const NEIGHBOURS: usize = 2;

/// Input of the correspondences. Points and normals are NaN where missing.
#[derive(Clone, Copy)]
pub struct CorrespondenceProblem<'a> {
    /// The colour view.
    pub image: &'a ColourView,
    /// The depth view.
    pub depth: &'a DepthView,
    /// The pose.
    pub pose: &'a Similarity,
    /// Points of the depth view, in its own frame.
    pub depth_points: &'a Points,
    /// Normals of the depth view, in its own frame.
    pub depth_normals: &'a Normals,
    /// Points of the image surface; NaN as long as there is no surface, in which case only visibility decides.
    pub image_points: &'a Points,
    /// Normals of the image surface.
    pub image_normals: &'a Normals,
    /// Accepted distance between both surfaces in units of the colour view; `None` derives it from the data.
    pub distance: Option<f64>,
    /// Length of an image pixel at the object, in units of the colour view.
    pub pixel_length: f64,
    /// Multiple of the median distance that the threshold from the data accepts.
    pub spreads: f64,
}

/// Correspondences in both directions; owns its memory.
#[derive(Clone, Debug)]
pub struct Correspondences {
    image: Size,
    depth: Size,
    widest_gap: usize,
    depth_of_pixel: Vec<i32>,
    visible: Visibility,
    /// One number for each point: the z-buffer of the reverse view, then the distance from the image surface.
    of_point: Vec<f32>,
    /// Scratch for the median distance.
    distances: Vec<f32>,
    count: usize,
    inliers: f64,
}

impl Correspondences {
    /// Allocates the memory for two views, without correspondences.
    #[must_use]
    pub fn new(image: &ColourView, depth: &DepthView) -> Self {
        let (pixels, points) = (image.size.len(), depth.size.len());
        Self {
            image: image.size,
            depth: depth.size,
            widest_gap: WIDEST_GAP,
            depth_of_pixel: vec![-1; pixels],
            visible: Visibility::new(pixels, points),
            of_point: vec![f32::INFINITY; points],
            distances: Vec::with_capacity(depth.valid()),
            count: 0,
            inliers: 0.0,
        }
    }

    /// Index of the depth pixel for each image pixel, or -1.
    #[must_use]
    pub fn depth_of_pixel(&self) -> &[i32] {
        &self.depth_of_pixel
    }

    /// A copy of the correspondences without normals in gaps between points, as in the paper. The paper's prior holds
    /// each pixel separately, and additional pixels with wrong normals would impede the paper's loop.
    #[must_use]
    pub fn of_points_alone(self) -> Self {
        Self { widest_gap: 0, ..self }
    }

    /// The depth view's normal at an image pixel, from `normals` in the depth view's own frame: that of the
    /// corresponding point, or in a gap the mean of the two points of one surface beside it. `None` where the depth
    /// view shows nothing.
    #[must_use]
    pub fn normal_at(&self, pixel: usize, normals: &Normals) -> Option<Vector3<f32>> {
        let normal_of = |index: usize| normals.is_valid(index).then(|| Vector3::from(normals.get(index)));
        match self.depth_at(pixel) {
            Some(index) => normal_of(index),
            None => {
                let [before, after] = self.around(pixel)?;
                Some((normal_of(before)? + normal_of(after)?).normalize())
            }
        }
    }

    fn depth_at(&self, pixel: usize) -> Option<usize> {
        usize::try_from(self.depth_of_pixel[pixel]).ok()
    }

    /// The depth pixels on either side of a gap, along the row or the column.
    fn around(&self, pixel: usize) -> Option<[usize; 2]> {
        let (column, row) = self.image.position(pixel);
        let across = || self.ends(pixel, 1, column, self.image.width);
        across().or_else(|| self.ends(pixel, self.image.width, row, self.image.height))
    }

    /// The depth pixels on either side of a gap in a line of pixels that are `stride` apart. The pixel in the gap is
    /// number `place` in the line.
    fn ends(&self, pixel: usize, stride: usize, place: usize, length: usize) -> Option<[usize; 2]> {
        let reach = 1..=self.widest_gap;
        let before =
            reach.clone().filter(|&k| k <= place).find_map(|k| Some((k, self.depth_at(pixel - k * stride)?)))?;
        let after =
            reach.filter(|&k| place + k < length).find_map(|k| Some((k, self.depth_at(pixel + k * stride)?)))?;
        let [from, to] = [before, after].map(|(_, index)| self.depth.position(index));
        let is_one_surface = from.0.abs_diff(to.0).max(from.1.abs_diff(to.1)) <= NEIGHBOURS;
        (before.0 + after.0 <= self.widest_gap + 1 && is_one_surface).then_some([before.1, after.1])
    }

    /// Continuous image column and row of each depth pixel, NaN where it has no counterpart.
    #[must_use]
    pub fn position(&self) -> [&[f32]; 2] {
        [&self.visible.column, &self.visible.row]
    }

    /// Depth pixels that have a counterpart.
    pub fn visible_points(&self) -> impl Iterator<Item = usize> {
        (0..self.visible.column.len()).filter(|&index| !self.visible.column[index].is_nan())
    }

    /// Number of measured depth pixels that have a counterpart.
    #[must_use]
    pub const fn count(&self) -> usize {
        self.count
    }

    /// Share of the visible measured points whose distance from the image surface is within three medians, or unknown.
    /// Points dropped because of their distance are visible as well.
    #[must_use]
    pub const fn inliers(&self) -> f64 {
        self.inliers
    }

    /// Finds the correspondences of a pose. Allocates nothing.
    pub fn update(&mut self, problem: &CorrespondenceProblem<'_>) {
        if !problem.depth.organised {
            self.project_back(problem);
        }
        self.measure_distances(problem);
        let median = if self.distances.is_empty() { 0.0 } else { quantile(&mut self.distances, 0.5) };
        self.accept_near(problem, median);
    }

    /// Fills the z-buffer of the image surface as seen by the depth camera.
    fn project_back(&mut self, problem: &CorrespondenceProblem<'_>) {
        let DepthView { camera, size, .. } = problem.depth;
        let projection = CloudProjection::new(&problem.pose.inverse(), problem.image_points, camera, *size);
        self.of_point.fill(f32::INFINITY);
        for start in (0..problem.image_points.len()).step_by(LANES) {
            projection.enter(start, &mut self.of_point);
        }
    }

    /// Finds the points that neither view hides, and their distances from the image surface.
    fn measure_distances(&mut self, problem: &CorrespondenceProblem<'_>) {
        let CorrespondenceProblem { image, depth, pose, depth_points: points, image_points, .. } = *problem;
        let (normals, pixel_length) = (problem.depth_normals, problem.pixel_length);
        let tolerance = (REVERSE_TOLERANCE * HIDDEN_BEHIND * pixel_length / pose.scale) as f32;
        let Self { visible, of_point, distances, .. } = self;
        distances.clear();
        visible.update(
            &VisibilityProblem { image, pose, points, normals, pixel_length },
            &mut |index, pixel, [x, y, z]| {
                if !depth.organised && points.z[index] > of_point[index] + tolerance {
                    return false;
                }
                let [surface, normal] = [image_points.get(pixel), problem.image_normals.get(pixel)];
                let distance =
                    (surface[0] - x) * normal[0] + (surface[1] - y) * normal[1] + (surface[2] - z) * normal[2];
                of_point[index] = distance.abs();
                if !distance.is_nan() && !depth.depth()[index].is_nan() {
                    distances.push(distance.abs());
                }
                true
            },
        );
    }

    /// Drops points too far from the image surface, and assigns to each pixel the point nearest to its centre.
    fn accept_near(&mut self, problem: &CorrespondenceProblem<'_>, median: f32) {
        let follows = (problem.spreads * f64::from(median)).max(LEAST_DISTANCE * problem.pixel_length);
        let threshold = problem.distance.unwrap_or(follows) as f32;
        let inlier = INLIER_SPREADS * median;
        self.depth_of_pixel.fill(-1);
        // In the following lines, `of_pixel` holds the squared distance between the centre of each pixel and the
        // pixel's point.
        self.visible.of_pixel.fill(f32::INFINITY);
        (self.count, self.inliers) = (0, 0.0);
        let mut visible = 0_usize;
        for index in 0..self.of_point.len() {
            let (column, row) = (self.visible.column[index], self.visible.row[index]);
            let Some(pixel) = problem.image.size.nearest(column, row) else { continue };
            // A point over a pixel without a surface has no distance and stays.
            let distance = self.of_point[index];
            let is_measured = !problem.depth.depth()[index].is_nan();
            if is_measured {
                visible += 1;
                self.inliers += f64::from(u8::from(distance.is_nan() || distance <= inlier));
            }
            if distance > threshold {
                self.visible.drop(index);
                continue;
            }
            self.count += usize::from(is_measured);
            let off = from_centre(column).powi(2) + from_centre(row).powi(2);
            let nearest = &mut self.visible.of_pixel[pixel];
            if off < *nearest && problem.depth_normals.is_valid(index) {
                *nearest = off;
                self.depth_of_pixel[pixel] = i32::try_from(index).unwrap_or(-1);
            }
        }
        self.inliers /= visible.max(1) as f64;
    }
}

/// Distance along one axis from the centre of the pixel on which a position falls.
fn from_centre(position: f32) -> f32 {
    position - (position + 0.5).floor()
}
