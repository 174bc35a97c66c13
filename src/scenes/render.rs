//! View of a mesh through a camera: depth and normals by a z-buffer, orthographic or through a pinhole.

use nalgebra::Vector3;

use super::mesh::Mesh;
use crate::pose::Similarity;
use crate::view::{Camera, Normals, Size};

/// Largest distance of a pixel centre outside a triangle that it still sees, in barycentric coordinates (no unit), so
/// that rounding opens no crack between two triangles that share an edge. Rounding of f64 at 1024 pixels is 1e-13.
pub(super) const EDGE_TOLERANCE: f64 = 1e-9;
/// A triangle whose area is smaller than this, relative to the square of its longest edge in the ray plane, is seen
/// edge on.
const EDGE_ON: f64 = 1e-12;
/// Margin in pixels around the corners of a triangle in the search for pixels that it covers, because lens distortion
/// bends its edges.
const SEARCH_MARGIN: f64 = 1.0;
/// Smallest cosine between line of sight and a normal that faces the camera; below it f32 slopes lose all digits.
const GRAZING: f64 = 1e-6;

/// A camera's view of a mesh. All fields are row-major over `size`.
#[derive(Clone, Debug)]
pub struct View {
    /// Columns and rows.
    pub size: Size,
    /// The camera of the view.
    pub camera: Camera,
    /// Depth along z in units of the placed mesh, NaN for background.
    pub depth: Vec<f64>,
    /// Unit normals that face the camera, NaN for background.
    pub normals: Vec<Vector3<f64>>,
}

impl View {
    /// Whether a pixel sees the object.
    #[must_use]
    pub fn is_valid(&self, index: usize) -> bool {
        !self.depth[index].is_nan()
    }

    /// The surface point of a pixel, in the camera's frame; NaN for background.
    #[must_use]
    pub fn point(&self, index: usize) -> Vector3<f64> {
        let (column, row) = self.size.position(index);
        self.camera.point(self.size, [column as f64, row as f64], self.depth[index]).into()
    }

    /// The mask: true where the object is visible.
    #[must_use]
    pub fn mask(&self) -> Vec<bool> {
        (0..self.size.len()).map(|index| self.is_valid(index)).collect()
    }

    /// The normals in the crate's own layout, rounded to f32.
    #[must_use]
    pub fn normals_f32(&self) -> Normals {
        let component = |axis: usize| self.normals.iter().map(|normal| normal[axis] as f32).collect();
        Normals { x: component(0), y: component(1), z: component(2) }
    }

    /// The depth rounded to f32.
    #[must_use]
    pub fn depth_f32(&self) -> Vec<f32> {
        self.depth.iter().map(|&depth| depth as f32).collect()
    }
}

/// Renders `mesh`, transformed into the camera's frame by `placement`.
///
/// Every triangle hides what lies behind it, even if its back is visible. Normals are interpolated linearly over the
/// surface (perspective-correct) and normalised again; pixels whose normal faces away from the camera are dropped.
#[must_use]
pub fn render(mesh: &Mesh, placement: &Similarity, size: Size, camera: Camera) -> View {
    let missing = Vector3::repeat(f64::NAN);
    let mut view = View { size, camera, depth: vec![f64::NAN; size.len()], normals: vec![missing; size.len()] };
    let rays: Vec<[f64; 2]> = (0..size.len())
        .map(|index| {
            let (column, row) = size.position(index);
            camera.ray(size, [column as f64, row as f64])
        })
        .collect();
    let corners: Vec<Option<Corner>> = mesh
        .vertices()
        .iter()
        .zip(mesh.normals())
        .map(|(&vertex, normal)| Corner::new(placement.apply(vertex), placement.rotation * normal, &view))
        .collect();
    for triangle in mesh.triangles() {
        // Triangles that reach behind the camera are dropped; scenes are placed in front of it.
        if let [Some(a), Some(b), Some(c)] = triangle.map(|corner| corners[corner].as_ref()) {
            draw(&mut view, &rays, [a, b, c]);
        }
    }
    for (index, &[x, y]) in rays.iter().enumerate() {
        let sight = if camera.is_orthographic() { Vector3::z() } else { Vector3::new(x, y, 1.0).normalize() };
        let normal = view.normals[index].normalize();
        let faces = normal.z < -GRAZING && normal.dot(&sight) < -GRAZING;
        view.normals[index] = if faces { normal } else { missing };
        view.depth[index] = if faces { view.depth[index] } else { f64::NAN };
    }
    view
}

/// A placed vertex.
struct Corner {
    point: Vector3<f64>,
    normal: Vector3<f64>,
    /// Column and row.
    pixel: [f64; 2],
    /// Position in the plane of [`Camera::ray`], where straight lines stay straight behind any lens.
    ray: [f64; 2],
    /// Factor that makes attributes linear over the ray plane: 1 / z for a pinhole, 1 for parallel rays.
    weight: f64,
}

impl Corner {
    /// The corner of a point; `None` behind the camera.
    fn new(point: Vector3<f64>, normal: Vector3<f64>, view: &View) -> Option<Self> {
        let pixel = view.camera.project(view.size, point.into())?;
        let weight = if view.camera.is_orthographic() { 1.0 } else { 1.0 / point.z };
        Some(Self { point, normal, pixel, ray: [point.x * weight, point.y * weight], weight })
    }
}

fn draw(view: &mut View, rays: &[[f64; 2]], corners: [&Corner; 3]) {
    let [a, b, c] = corners.map(|corner| corner.ray);
    let area = cross(a, b, c);
    let longest = square(a, b).max(square(b, c)).max(square(c, a));
    if area.abs() <= EDGE_ON * longest {
        return;
    }
    let columns = span(corners.map(|corner| corner.pixel[0]), view.size.width);
    for row in span(corners.map(|corner| corner.pixel[1]), view.size.height) {
        for column in columns.clone() {
            let index = view.size.index(column, row);
            let ray = rays[index];
            let flat = [cross(ray, b, c) / area, cross(a, ray, c) / area, cross(a, b, ray) / area];
            if flat.iter().any(|&share| share < -EDGE_TOLERANCE) {
                continue;
            }
            let shares: [f64; 3] = std::array::from_fn(|k| flat[k] * corners[k].weight);
            let total: f64 = shares.iter().sum();
            let depth = (0..3).map(|k| shares[k] * corners[k].point.z).sum::<f64>() / total;
            let hidden = view.depth[index] <= depth;
            if !hidden {
                view.depth[index] = depth;
                view.normals[index] = (0..3).map(|k| shares[k] * corners[k].normal).sum();
            }
        }
    }
}

/// Twice the signed area of a triangle.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

fn square(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2)
}

/// Pixels along a side of `length` that a triangle with these coordinates may cover.
fn span(coordinates: [f64; 3], length: usize) -> std::ops::Range<usize> {
    let [a, b, c] = coordinates;
    let first = (a.min(b).min(c) - SEARCH_MARGIN).ceil().max(0.0);
    let end = (a.max(b).max(c) + SEARCH_MARGIN).floor() + 1.0;
    // Casts to an integer saturate, so a triangle left of the view yields an empty range.
    first as usize..(end as usize).min(length)
}
