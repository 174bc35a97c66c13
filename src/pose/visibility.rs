//! Which points of the depth view the colour camera sees, and where.
//!
//! A point is seen where it falls on the mask, faces the camera, and no other depth point hides it (z-buffer of the
//! colour view's own resolution, so parts thinner than two pixels may be judged wrongly).

use nalgebra::Vector3;

use crate::pose::Similarity;
use crate::view::{ColourView, Normals, Points, Size};

/// A point counts as hidden when it lies this many image pixels behind the nearest one: more than a steep slope drops
/// between neighbours, less than a nose stands before a cheek.
pub(super) const HIDDEN_BEHIND: f64 = 3.0;
/// Cosine at the rim: flatter views of a surface have no reliable pixel.
const RIM: f64 = 0.05;

/// A cloud before a colour camera. Points and normals are NaN where missing.
#[derive(Clone, Copy)]
pub(super) struct Sight<'a> {
    pub image: &'a ColourView,
    pub pose: &'a Similarity,
    pub points: &'a Points,
    pub normals: &'a Normals,
    /// Length of an image pixel at the object in units of the colour view.
    pub pixel_length: f64,
}

/// Where the points are seen; owns its memory.
#[derive(Clone, Debug)]
pub(super) struct Visibility {
    /// Continuous image column and row of each point, NaN where it is not seen.
    pub column: Vec<f32>,
    pub row: Vec<f32>,
    /// A number for each point and one for each pixel: the depths of all points and the z-buffer while it looks, after
    /// that the caller's.
    pub of_point: Vec<f32>,
    pub of_pixel: Vec<f32>,
}

impl Visibility {
    /// Memory for so many pixels and points.
    pub fn new(pixels: usize, points: usize) -> Self {
        Self {
            column: vec![f32::NAN; points],
            row: vec![f32::NAN; points],
            of_point: vec![f32::NAN; points],
            of_pixel: vec![f32::INFINITY; pixels],
        }
    }

    /// Looks anew. Allocates nothing.
    pub fn update(&mut self, sight: &Sight<'_>) {
        self.project(sight);
        self.hide(sight);
    }

    /// A point is not seen after all.
    pub fn drop(&mut self, index: usize) {
        (self.column[index], self.row[index]) = (f32::NAN, f32::NAN);
    }

    /// Places of all points that face the camera and fall on the mask, and the z-buffer.
    fn project(&mut self, sight: &Sight<'_>) {
        let (size, camera) = (sight.image.size, &sight.image.camera);
        self.of_pixel.fill(f32::INFINITY);
        let along_axis = sight.pose.rotation.tr_mul(&Vector3::z());
        for index in 0..self.column.len() {
            self.drop(index);
            if !sight.points.is_valid(index) {
                continue;
            }
            let point = sight.pose.apply(vector(sight.points.get(index)));
            let Some([column, row]) = camera.project(size, point.into()) else { continue };
            self.of_point[index] = point.z as f32;
            splat(size, &mut self.of_pixel, [column, row], self.of_point[index]);
            // Unit direction from the camera to the point, in the depth view's frame.
            let direction =
                if camera.is_orthographic() { along_axis } else { sight.pose.rotation.tr_mul(&point.normalize()) };
            // A normal that is missing (a hole not yet filled) does not exclude its point.
            if vector(sight.normals.get(index)).dot(&direction) > -RIM {
                continue;
            }
            let pixel = size.nearest(column as f32, row as f32);
            if pixel.is_some_and(|pixel| sight.image.mask[pixel]) {
                (self.column[index], self.row[index]) = (column as f32, row as f32);
            }
        }
    }

    /// Drops the points that lie behind others.
    fn hide(&mut self, sight: &Sight<'_>) {
        let tolerance = (HIDDEN_BEHIND * sight.pixel_length) as f32;
        for index in 0..self.column.len() {
            let Some(pixel) = sight.image.size.nearest(self.column[index], self.row[index]) else { continue };
            if self.of_point[index] > self.of_pixel[pixel] + tolerance {
                self.drop(index);
            }
        }
    }
}

#[inline(always)]
pub(super) fn vector(values: [f32; 3]) -> Vector3<f64> {
    Vector3::from(values.map(f64::from))
}

/// Enters a depth at the four pixels around a position, so that gaps between points let nothing through.
pub(super) fn splat(size: Size, buffer: &mut [f32], position: [f64; 2], depth: f32) {
    // A position on a pixel's centre enters that pixel alone: then the four are one, and it is entered again.
    let [left, top] = position.map(f64::floor);
    let [right, low] = position.map(f64::ceil);
    // A position may lie outside by less than a pixel; NaN fails every comparison.
    let (last_column, last_row) = ((size.width - 1) as f64, (size.height - 1) as f64);
    if !(right >= 0.0 && low >= 0.0 && left <= last_column && top <= last_row) {
        return;
    }
    let columns = [left.max(0.0), right.min(last_column)].map(|column| column as usize);
    for row in [top.max(0.0), low.min(last_row)].map(|row| row as usize) {
        for column in columns {
            let Some(buffered) = buffer.get_mut(size.index(column, row)) else { continue };
            *buffered = if depth < *buffered { depth } else { *buffered };
        }
    }
}
