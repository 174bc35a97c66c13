//! A triangle mesh of a relief (docs/lab/protocols.md), from which every view of a scene is rendered.

use nalgebra::Vector3;

use super::relief::Relief;
use crate::error::{Error, ErrorKind, Result};
use crate::view::{Gaussian, Size};

/// Sigma of the smoothing of the heights in samples (docs/lab/protocols.md): it removes scanner noise and keeps
/// features.
const SMOOTHING: f64 = 1.0;
/// Reach of the smoothing kernel in sigmas; samples beyond it would have weights below 1e-4.
const SMOOTHING_REACH: f64 = 4.0;
/// Largest difference of the heights in one triangle, in samples (docs/lab/protocols.md). A larger difference is a jump
/// from one part of the object to another, without a surface in between.
const LARGEST_JUMP: f64 = 12.0;

/// Triangles with vertex normals. Unit: samples of the relief. Optical frame (x right, y down, z forward) with the
/// origin in the centre of the grid at height zero, so that z = -height.
#[derive(Clone, Debug)]
pub struct Mesh {
    /// The vertices that belong to at least one triangle.
    vertices: Vec<Vector3<f64>>,
    /// Unit normals, one for each vertex, on the side from which the relief is seen (z < 0).
    normals: Vec<Vector3<f64>>,
    /// Indices of three vertices each.
    triangles: Vec<[usize; 3]>,
    centroid: Vector3<f64>,
    radius: f64,
}

impl Mesh {
    /// Smooths the heights inside the object, spans two triangles over each cell, and gives each vertex the
    /// area-weighted mean normal of its triangles. Omits cells that touch the background and triangles with a jump.
    ///
    /// # Errors
    /// [`ErrorKind::Empty`] if no triangle is left.
    pub fn from_relief(relief: &Relief) -> Result<Self> {
        let size = relief.size();
        let object: Vec<bool> = relief.object().collect();
        let heights = smooth(relief.heights(), &object, size);
        let triangles = triangulate(&heights, &object, size);
        if triangles.is_empty() {
            return Err(Error::new(ErrorKind::Empty, "surface.heights", "the object has no surface"));
        }
        Ok(Self::from_triangles(&grid_points(&heights, size), &triangles))
    }

    /// Keeps the points that belong to a triangle.
    fn from_triangles(points: &[Vector3<f64>], triangles: &[[usize; 3]]) -> Self {
        let mut normals = vec![Vector3::zeros(); points.len()];
        for &corners in triangles {
            let [a, b, c] = corners.map(|corner| points[corner]);
            // Its length is twice the area, which serves as the weight.
            let normal = (b - a).cross(&(c - a));
            corners.iter().for_each(|&corner| normals[corner] += normal);
        }
        // A height map never folds, so the z components of a vertex's triangles all have the same sign.
        let used: Vec<usize> = (0..points.len()).filter(|&index| normals[index].z < 0.0).collect();
        let mut place = vec![usize::MAX; points.len()];
        used.iter().enumerate().for_each(|(new, &old)| place[old] = new);

        let vertices: Vec<_> = used.iter().map(|&index| points[index]).collect();
        let centroid = vertices.iter().sum::<Vector3<f64>>() / vertices.len() as f64;
        let radius = vertices.iter().map(|vertex| (vertex - centroid).norm()).fold(0.0, f64::max);
        Self {
            normals: used.iter().map(|&index| normals[index].normalize()).collect(),
            triangles: triangles.iter().map(|corners| corners.map(|corner| place[corner])).collect(),
            vertices,
            centroid,
            radius,
        }
    }

    /// Mean of the vertices, about which synthetic views are rotated.
    #[must_use]
    pub const fn centroid(&self) -> Vector3<f64> {
        self.centroid
    }

    /// Largest distance of a vertex from the centroid.
    #[must_use]
    pub const fn radius(&self) -> f64 {
        self.radius
    }

    /// The vertices.
    #[must_use]
    pub fn vertices(&self) -> &[Vector3<f64>] {
        &self.vertices
    }

    /// The unit normal of each vertex.
    #[must_use]
    pub fn normals(&self) -> &[Vector3<f64>] {
        &self.normals
    }

    /// Three vertex indices for each triangle.
    #[must_use]
    pub fn triangles(&self) -> &[[usize; 3]] {
        &self.triangles
    }
}

/// Gaussian mean over only the samples of the object, so that the background does not lower the object's border.
fn smooth(heights: &[f32], object: &[bool], size: Size) -> Vec<f64> {
    let [means] =
        Gaussian::new(size, SMOOTHING, SMOOTHING_REACH).means(|index| object[index], |_, index| heights[index]);
    means.into_iter().map(|mean| if mean.is_nan() { 0.0 } else { mean }).collect()
}

fn triangulate(heights: &[f64], object: &[bool], size: Size) -> Vec<[usize; 3]> {
    let mut triangles = Vec::with_capacity(2 * size.len());
    for row in 0..size.height - 1 {
        for column in 0..size.width - 1 {
            let first = size.index(column, row);
            let [a, b, c, d] = [first, first + 1, first + size.width, first + size.width + 1];
            if ![a, b, c, d].iter().all(|&corner| object[corner]) {
                continue;
            }
            // The vertex below comes before the one to the right, so that the cross product of the edges faces the
            // camera.
            let cell = [[a, c, b], [b, c, d]];
            triangles.extend(cell.into_iter().filter(|corners| jump(heights, corners) <= LARGEST_JUMP));
        }
    }
    triangles
}

fn jump(heights: &[f64], corners: &[usize; 3]) -> f64 {
    let [a, b, c] = corners.map(|corner| heights[corner]);
    a.max(b).max(c) - a.min(b).min(c)
}

fn grid_points(heights: &[f64], size: Size) -> Vec<Vector3<f64>> {
    let [x, y] = [size.width, size.height].map(|side| (side as f64 - 1.0) / 2.0);
    heights
        .iter()
        .enumerate()
        .map(|(index, &height)| {
            let (column, row) = size.position(index);
            Vector3::new(column as f64 - x, row as f64 - y, -height)
        })
        .collect()
}
