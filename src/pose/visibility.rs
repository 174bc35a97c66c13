//! Points of the depth view that the colour camera sees, and their positions in the image.
//!
//! A point is visible if it falls on the mask, faces the camera, and no other depth point hides it (z-buffer at the
//! colour view's resolution, so parts thinner than two pixels may be misjudged). See docs/method/surfaces.md.

use nalgebra::Vector3;

use super::similarity::Similarity;
use crate::numeric::{LANES, Lanes, Mask, Real, dot};
use crate::view::{Camera, ColourView, Normals, Points, Size};

/// A point is hidden if it lies this many image pixels behind the nearest one. This is more than a steep slope drops
/// between neighbours, and less than the height of a nose above a cheek.
pub(super) const HIDDEN_BEHIND: f64 = 3.0;
/// Smallest cosine between normal and ray of a visible point; at a more grazing angle no pixel is reliable.
pub(super) const LEAST_FACING: f64 = 0.05;

/// A cloud in front of a colour camera. Points and normals are NaN where missing.
#[derive(Clone, Copy)]
pub(super) struct VisibilityProblem<'a> {
    pub image: &'a ColourView,
    pub pose: &'a Similarity,
    pub points: &'a Points,
    pub normals: &'a Normals,
    /// Length of an image pixel at the object, in units of the colour view.
    pub pixel_length: f64,
}

/// A pose in f32 for many points of one cloud. It transforms differences from one of the points, which keep their
/// digits however far away the cloud is.
struct SingleTransform {
    /// One point of the cloud, before and after the transformation.
    from: [f32; 3],
    to: [f32; 3],
    /// s R.
    matrix: [[f32; 3]; 3],
}

impl SingleTransform {
    fn new(pose: &Similarity, cloud: &Points) -> Self {
        let valid = (0..cloud.len()).find(|&index| cloud.is_valid(index));
        let from = valid.map_or([0.0; 3], |index| cloud.get(index));
        let to = pose.apply(vector(from)).map(|value| value as f32).into();
        // Columns of the transpose are rows.
        let matrix = (pose.scale * pose.rotation).transpose().map(|value| value as f32).into();
        Self { from, to, matrix }
    }

    #[inline(always)]
    fn apply<T: Real<Scalar = f32>>(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        let [x, y, z] = [x - T::splat(self.from[0]), y - T::splat(self.from[1]), z - T::splat(self.from[2])];
        let row = |axis: usize| {
            let [a, b, c] = self.matrix[axis];
            T::splat(a) * x + T::splat(b) * y + T::splat(c) * z + T::splat(self.to[axis])
        };
        [row(0), row(1), row(2)]
    }
}

/// Transforms a cloud and projects it into a view.
pub(super) struct CloudProjection<'a> {
    transform: SingleTransform,
    cloud: &'a Points,
    camera: &'a Camera,
    size: Size,
}

impl<'a> CloudProjection<'a> {
    pub fn new(pose: &Similarity, cloud: &'a Points, camera: &'a Camera, size: Size) -> Self {
        Self { transform: SingleTransform::new(pose, cloud), cloud, camera, size }
    }

    /// Columns and rows of the [`LANES`] points from `start` on, which are also entered into the z-buffer `buffer`;
    /// `None` if all of them are missing.
    #[inline(never)]
    pub fn enter(&self, start: usize, buffer: &mut [f32]) -> Option<[Lanes; 2]> {
        if !Lanes::load(&self.cloud.z, start as isize).finite().any() {
            return None;
        }
        let transformed = self.transform.apply(self.cloud.lanes(start));
        let [column, row] = self.camera.project_lanes(self.size, transformed);
        let (columns, rows, depths) = (column.array(), row.array(), transformed[2].array());
        for lane in 0..LANES {
            splat(self.size, buffer, [columns[lane], rows[lane]], depths[lane]);
        }
        Some([column, row])
    }
}

/// Positions of the visible points; owns its memory.
#[derive(Clone, Debug)]
pub(super) struct Visibility {
    /// Continuous image column and row of each point, NaN if it is not visible.
    pub column: Vec<f32>,
    pub row: Vec<f32>,
    /// One number for each pixel: the z-buffer during an update, free for the caller afterwards.
    pub of_pixel: Vec<f32>,
}

impl Visibility {
    /// Allocates the memory for this many pixels and points.
    pub fn new(pixels: usize, points: usize) -> Self {
        Self { column: vec![f32::NAN; points], row: vec![f32::NAN; points], of_pixel: vec![f32::INFINITY; pixels] }
    }

    /// Finds the visible points again. Of the points that pass mask, normal and z-buffer, those stay for which `keeps`
    /// is true; its arguments are the index, the pixel on which the point falls, and the transformed point. Allocates
    /// nothing.
    pub fn update(&mut self, problem: &VisibilityProblem<'_>, keeps: &mut dyn FnMut(usize, usize, [f32; 3]) -> bool) {
        let projection = CloudProjection::new(problem.pose, problem.points, &problem.image.camera, problem.image.size);
        self.project(problem, &projection);
        self.hide(problem, &projection.transform, keeps);
    }

    /// Makes a point invisible.
    #[inline(always)]
    pub fn drop(&mut self, index: usize) {
        (self.column[index], self.row[index]) = (f32::NAN, f32::NAN);
    }

    /// Projects all points that face the camera, and fills the z-buffer.
    fn project(&mut self, problem: &VisibilityProblem<'_>, projection: &CloudProjection<'_>) {
        self.of_pixel.fill(f32::INFINITY);
        let missing = Lanes::splat(f32::NAN);
        let rays = Rays::new(problem);
        for start in (0..self.column.len()).step_by(LANES) {
            let mut position = [missing; 2];
            if let Some([column, row]) = projection.enter(start, &mut self.of_pixel) {
                let away = rays.meet(problem.points.lanes(start), problem.normals.lanes(start));
                position = [away.select(missing, column), away.select(missing, row)];
            }
            position[0].store(&mut self.column[start..]);
            position[1].store(&mut self.row[start..]);
        }
    }

    /// Drops points that fall off the mask, lie behind others or are not kept.
    fn hide(
        &mut self,
        problem: &VisibilityProblem<'_>,
        transform: &SingleTransform,
        keeps: &mut dyn FnMut(usize, usize, [f32; 3]) -> bool,
    ) {
        let tolerance = (HIDDEN_BEHIND * problem.pixel_length) as f32;
        for index in 0..self.column.len() {
            if self.column[index].is_nan() {
                continue;
            }
            let pixel = problem.image.size.nearest(self.column[index], self.row[index]);
            let kept = pixel.is_some_and(|pixel| {
                let transformed = transform.apply(problem.points.get(index));
                let hidden = transformed[2] > self.of_pixel[pixel] + tolerance;
                problem.image.mask[pixel] && !hidden && keeps(index, pixel, transformed)
            });
            if !kept {
                self.drop(index);
            }
        }
    }
}

/// Rays from the camera to the points, in the depth view's frame: along its axis, or from its centre.
enum Rays {
    Along([f32; 3]),
    From([f32; 3]),
}

impl Rays {
    fn new(problem: &VisibilityProblem<'_>) -> Self {
        if problem.image.camera.is_orthographic() {
            Self::Along(problem.pose.rotation.tr_mul(&Vector3::z()).map(|value| value as f32).into())
        } else {
            Self::From(problem.pose.inverse().translation.map(|value| value as f32).into())
        }
    }

    /// Mask of points whose surface is seen from behind or at a grazing angle. A missing normal (a hole not yet filled)
    /// does not exclude its point.
    #[inline(always)]
    fn meet(&self, point: [Lanes; 3], normal: [Lanes; 3]) -> Mask {
        match self {
            Self::Along([x, y, z]) => {
                let along = [Lanes::splat(*x), Lanes::splat(*y), Lanes::splat(*z)];
                Lanes::splat(-LEAST_FACING as f32).less(dot(normal, along))
            }
            Self::From([x, y, z]) => {
                let ray = [point[0] - Lanes::splat(*x), point[1] - Lanes::splat(*y), point[2] - Lanes::splat(*z)];
                (Lanes::splat(-LEAST_FACING as f32) * dot(ray, ray).sqrt()).less(dot(normal, ray))
            }
        }
    }
}

#[inline(always)]
fn vector(values: [f32; 3]) -> Vector3<f64> {
    Vector3::from(values.map(f64::from))
}

/// Enters a depth at the four pixels around a position, so that gaps between points are closed.
#[inline(always)]
fn splat(size: Size, buffer: &mut [f32], [column, row]: [f32; 2], depth: f32) {
    // For a position at a pixel's centre all four are that pixel, which is entered repeatedly.
    let (left, right, top, low) = (column.floor(), column.ceil(), row.floor(), row.ceil());
    // A position may lie outside by less than a pixel; NaN fails every comparison.
    let (last_column, last_row) = ((size.width - 1) as f32, (size.height - 1) as f32);
    if !(right >= 0.0 && low >= 0.0 && left <= last_column && top <= last_row) {
        return;
    }
    // The casts turn negative numbers into zero.
    let (left, right) = (left as usize, right.min(last_column) as usize);
    for row in [top as usize, low.min(last_row) as usize] {
        for column in [left, right] {
            let Some(buffered) = buffer.get_mut(size.index(column, row)) else { continue };
            *buffered = if depth < *buffered { depth } else { *buffered };
        }
    }
}
