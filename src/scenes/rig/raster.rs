//! The first triangle that each ray of a camera meets: a z-buffer in the plane of the rays' slopes, where straight
//! lines stay straight behind any lens.
//!
//! Limits: triangles that reach behind the near plane or beyond the fold of the lens are dropped. Surfaces around the
//! camera are therefore cut into small ones (`solids`).

use nalgebra::Vector3;

use super::stage::Stage;
use crate::pose::Similarity;
use crate::scenes::render::EDGE_TOLERANCE;
use crate::view::{Lens, Pinhole, Size};

/// Smallest depth that is drawn, metres.
const NEAR: f64 = 0.1;
/// Distance, in samples of a row, between exactly computed rays. Cubic polynomials interpolate between them, with an
/// error of 1e-4 pixels at 160 columns and far less at 640.
const NODES: usize = 8;
/// Margin around the bounding box of a triangle's corners, samples: a constant because of rounding, and a share of the
/// triangle's size because a lens bends its edges.
const MARGIN: f64 = 0.5;
const MARGIN_SHARE: f64 = 0.05;
/// The mark of a ray that meets nothing.
pub const NOTHING: u32 = u32::MAX;

/// The rays of a camera, `samples` x `samples` for each pixel.
pub struct Rays {
    camera: Pinhole,
    samples: f64,
    /// Size of the raster of samples.
    pub size: Size,
    /// x / z and y / z; NaN where the lens lets no ray through.
    slopes: Vec<[f32; 2]>,
    /// Smallest and largest value of either slope. Points beyond are not visible, wherever the lens model would project
    /// them.
    bounds: [[f64; 2]; 2],
}

/// First hits of the rays of a camera.
pub struct Hits {
    /// Index of the triangle, or [`NOTHING`].
    pub triangles: Vec<u32>,
    /// Depth along z in metres, infinite for background.
    pub depth: Vec<f32>,
}

/// A point that a ray meets, in the frame of the stage.
pub struct Hit {
    pub triangle: usize,
    pub point: Vector3<f64>,
    /// Unit normal facing the camera.
    pub normal: Vector3<f64>,
    /// Cosine of the angle between normal and line of sight.
    pub cosine: f64,
}

impl Rays {
    pub fn new(camera: &Pinhole, size: Size, samples: usize) -> Self {
        let size = Size { width: size.width * samples, height: size.height * samples };
        let nowhere = [f64::INFINITY, f64::NEG_INFINITY];
        let slopes = Vec::with_capacity(size.len());
        let mut rays = Self { camera: *camera, samples: samples as f64, size, slopes, bounds: [nowhere; 2] };
        let count = size.width.div_ceil(NODES) + 3;
        let mut nodes = vec![[0.0; 2]; count];
        for row in 0..size.height {
            // One node before the first sample, two beyond the last.
            for (k, node) in nodes.iter_mut().enumerate() {
                let column = NODES as f64 * (k as f64 - 1.0);
                *node = rays.slopes_at([column, row as f64]).unwrap_or([f64::NAN; 2]);
            }
            for column in 0..size.width {
                let share = (column % NODES) as f64 / NODES as f64;
                let near = &nodes[column / NODES..column / NODES + 4];
                let weights = cubic(share);
                rays.slopes.push([0, 1].map(|axis| (0..4).map(|k| weights[k] * near[k][axis]).sum::<f64>() as f32));
            }
        }
        for (axis, [least, largest]) in rays.bounds.iter_mut().enumerate() {
            // The minimum ignores NaN.
            for slope in rays.slopes.iter().map(|slopes| f64::from(slopes[axis])) {
                (*least, *largest) = (least.min(slope), largest.max(slope));
            }
        }
        rays
    }

    /// A view without a lens and with one sample per pixel, for a lamp or a projector.
    pub fn straight(focal_length: f64, size: Size) -> Self {
        let [cx, cy] = [size.width, size.height].map(|side| 0.5 * (side as f64 - 1.0));
        Self::new(&Pinhole { fx: focal_length, fy: focal_length, cx, cy, lens: Lens::None }, size, 1)
    }

    /// Slopes of the ray through a position among the samples.
    fn slopes_at(&self, position: [f64; 2]) -> Option<[f64; 2]> {
        let pixel = position.map(|part| (part + 0.5) / self.samples - 0.5);
        let [x, y, z] = self.camera.ray(pixel)?;
        (z > 0.0).then(|| [x / z, y / z])
    }

    /// Position among the samples of a point in the camera's frame.
    pub fn position(&self, point: Vector3<f64>) -> Option<[f64; 2]> {
        let pixel = self.camera.project(point.into()).filter(|_| point.z > NEAR)?;
        Some(pixel.map(|part| (part + 0.5) * self.samples - 0.5))
    }

    /// First hits on a stage that `placement` transforms into the camera's frame.
    pub fn meet(&self, stage: &Stage, placement: &Similarity) -> Hits {
        let mut hits = Hits { triangles: vec![NOTHING; self.size.len()], depth: vec![f32::INFINITY; self.size.len()] };
        let corners: Vec<Option<Corner>> = stage.points.iter().map(|&p| self.corner(placement.apply(p))).collect();
        for (index, triangle) in stage.triangles.iter().enumerate() {
            if let [Some(a), Some(b), Some(c)] = triangle.corners.map(|corner| corners[corner as usize].as_ref()) {
                self.draw([a, b, c], index as u32, &mut hits);
            }
        }
        hits
    }

    fn corner(&self, point: Vector3<f64>) -> Option<Corner> {
        let position = self.position(point)?;
        let inverse = 1.0 / point.z;
        Some(Corner { slopes: [point.x * inverse, point.y * inverse], inverse, position })
    }

    fn draw(&self, corners: [&Corner; 3], triangle: u32, hits: &mut Hits) {
        if (0..2).any(|axis| {
            let [a, b, c] = corners.map(|corner| corner.slopes[axis]);
            let [least, largest] = self.bounds[axis];
            a.max(b).max(c) < least || a.min(b).min(c) > largest
        }) {
            return;
        }
        let Some([first, second, third]) = barycentric(corners.map(|corner| corner.slopes)) else { return };
        let inverse: [f64; 3] = std::array::from_fn(|k| {
            first[k] * corners[0].inverse + second[k] * corners[1].inverse + third[k] * corners[2].inverse
        });
        let columns = span(corners.map(|corner| corner.position[0]), self.size.width);
        if columns.is_empty() {
            return;
        }
        let at = |plane: &[f64; 3], [x, y]: [f64; 2]| plane[0] * x + plane[1] * y + plane[2];
        for row in span(corners.map(|corner| corner.position[1]), self.size.height) {
            let line = self.size.index(columns.start, row)..self.size.index(columns.end, row);
            let found = hits.depth[line.clone()].iter_mut().zip(&mut hits.triangles[line.clone()]);
            for (slopes, (depth, seen)) in self.slopes[line].iter().zip(found) {
                let slopes = slopes.map(f64::from);
                let least = at(&first, slopes).min(at(&second, slopes)).min(at(&third, slopes));
                if least >= -EDGE_TOLERANCE {
                    let met = (1.0 / at(&inverse, slopes)) as f32;
                    if met < *depth {
                        (*depth, *seen) = (met, triangle);
                    }
                }
            }
        }
    }

    /// The point that sample `index` sees, from the result of `meet` with the same placement.
    pub fn hit(&self, stage: &Stage, placement: &Similarity, hits: &Hits, index: usize) -> Option<Hit> {
        let triangle = hits.triangles[index];
        if triangle == NOTHING {
            return None;
        }
        let [x, y] = self.slopes[index].map(f64::from);
        let back = placement.inverse();
        let sight = Vector3::new(x, y, 1.0);
        let point = back.apply(f64::from(hits.depth[index]) * sight);
        let corners = stage.triangles[triangle as usize].corners.map(|corner| corner as usize);
        let normal = normal_at(corners.map(|k| stage.points[k]), corners.map(|k| stage.normals[k]), point);
        let cosine = -normal.dot(&(back.rotation * sight)) / sight.norm();
        Some(Hit { triangle: triangle as usize, point, normal: normal * cosine.signum(), cosine: cosine.abs() })
    }
}

/// A corner of a triangle in the camera's frame.
struct Corner {
    slopes: [f64; 2],
    /// 1 / z, which is linear over the slopes.
    inverse: f64,
    /// Position among the samples.
    position: [f64; 2],
}

/// The barycentric coordinates of a triangle as linear functions a x + b y + c; `None` if it is seen edge on.
fn barycentric([a, b, c]: [[f64; 2]; 3]) -> Option<[[f64; 3]; 3]> {
    let area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    let side = |from: [f64; 2], to: [f64; 2]| {
        [(from[1] - to[1]) / area, (to[0] - from[0]) / area, (from[0] * to[1] - from[1] * to[0]) / area]
    };
    (area.abs() > f64::MIN_POSITIVE).then(|| [side(b, c), side(c, a), side(a, b)])
}

/// The interpolated unit normal at a point of a triangle.
fn normal_at([a, b, c]: [Vector3<f64>; 3], normals: [Vector3<f64>; 3], point: Vector3<f64>) -> Vector3<f64> {
    let across = (b - a).cross(&(c - a));
    let area = across.norm_squared().max(f64::MIN_POSITIVE);
    let second = (point - a).cross(&(c - a)).dot(&across) / area;
    let third = (b - a).cross(&(point - a)).dot(&across) / area;
    let normal = (1.0 - second - third) * normals[0] + second * normals[1] + third * normals[2];
    normal.try_normalize(0.0).unwrap_or_else(|| normals[0])
}

/// Weights of Lagrange's cubic through values at -1, 0, 1, 2.
fn cubic(t: f64) -> [f64; 4] {
    [
        -t * (t - 1.0) * (t - 2.0) / 6.0,
        (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
        -(t + 1.0) * t * (t - 2.0) / 2.0,
        (t + 1.0) * t * (t - 1.0) / 6.0,
    ]
}

/// Samples along a side of `length` that a triangle with these coordinates may cover.
fn span(coordinates: [f64; 3], length: usize) -> std::ops::Range<usize> {
    let [a, b, c] = coordinates;
    let (low, high) = (a.min(b).min(c), a.max(b).max(c));
    let margin = MARGIN + MARGIN_SHARE * (high - low);
    // The numbers are clamped before the casts, which would saturate.
    let within = |position: f64| position.max(0.0).min(length as f64) as usize;
    within((low - margin).ceil())..within((high + margin).floor() + 1.0)
}

#[cfg(test)]
mod tests {
    use nalgebra::{Matrix3, Rotation3};

    use super::*;
    use crate::scenes::flaws::Chance;
    use crate::scenes::rig::pattern::Albedo;
    use crate::scenes::rig::solids::Solid;

    const SIZE: Size = Size { width: 160, height: 120 };

    /// A camera with all of Brown's terms, and a square wall that it sees obliquely.
    fn wall() -> (Pinhole, Stage, Similarity) {
        let lens = Lens::Brown([0.1, -0.06, 0.001, -0.0008, 0.004, 0.0, 0.0, 0.0]);
        let camera = Pinhole { fx: 130.0, fy: 131.0, cx: 81.0, cy: 58.5, lens };
        let mut stage = Stage::default();
        let placement = Similarity { translation: Vector3::new(0.2, 0.1, 1.3), ..Similarity::identity() };
        let face = Solid::face(Vector3::new(-4.0, -4.0, 0.0), 8.0 * Vector3::x(), 8.0 * Vector3::y());
        let albedo = Albedo::plain(&placement, &mut Chance::of_stream(1, 1));
        stage.put(&face, &placement, albedo);
        let rotation = Rotation3::from_euler_angles(0.3, -0.4, 0.1).into_inner();
        (camera, stage, Similarity { scale: 1.0, rotation, translation: Vector3::new(0.1, -0.05, 0.2) })
    }

    /// Depth at a pixel of a plane through `point`, in closed form.
    fn depth_of_plane(ray: [f64; 3], point: Vector3<f64>, normal: Vector3<f64>) -> f64 {
        normal.dot(&point) / normal.dot(&Vector3::from(ray))
    }

    #[test]
    fn the_depth_of_a_plane_is_the_analytic_one() {
        let (camera, stage, placement) = wall();
        let rays = Rays::new(&camera, SIZE, 1);
        let hits = rays.meet(&stage, &placement);
        let (point, normal) = (placement.apply(Vector3::new(0.0, 0.0, 1.3)), placement.rotation * Vector3::z());
        for index in 0..SIZE.len() {
            let (column, row) = SIZE.position(index);
            let ray = camera.ray([column as f64, row as f64]).unwrap();
            let expected = depth_of_plane(ray, point, normal);
            // Depth and the slopes of the rays are stored in f32.
            let found = f64::from(hits.depth[index]);
            assert!((found - expected).abs() < 1e-6 * expected, "{column} {row}: {found} {expected}");
            let hit = rays.hit(&stage, &placement, &hits, index).unwrap();
            assert!((hit.point.z - 1.3).abs() < 2e-6 && (hit.normal + Vector3::z()).norm() < 1e-9);
            let cosine = -normal.dot(&Vector3::from(ray)) / Vector3::from(ray).norm();
            assert!((hit.cosine - cosine.abs()).abs() < 1e-6);
        }
    }

    #[test]
    fn finer_rays_lie_evenly_within_their_pixels() {
        let (camera, ..) = wall();
        let rays = Rays::new(&camera, SIZE, 2);
        for (column, row) in [(0, 0), (17, 5), (319, 239), (160, 121)] {
            let [x, y] = rays.slopes[rays.size.index(column, row)].map(f64::from);
            let [right, down] = camera.project([x, y, 1.0]).unwrap();
            let expected = [column, row].map(|part| part as f64 / 2.0 - 0.25);
            assert!((right - expected[0]).hypot(down - expected[1]) < 1e-4, "{column} {row}: {right} {down}");
            let [back, up] = rays.position(Vector3::new(2.0 * x, 2.0 * y, 2.0)).unwrap();
            assert!((back - column as f64).hypot(up - row as f64) < 2e-4);
        }
    }

    /// Compares with the intersections of every ray with every triangle.
    #[test]
    fn the_nearest_triangle_is_met() {
        let (camera, mut stage, placement) = wall();
        let mut chance = Chance::of_stream(3, 0);
        for _ in 0..8 {
            let spot =
                Vector3::new(chance.between([-0.5, 0.6]), chance.between([-0.3, 0.4]), chance.between([0.7, 1.3]));
            let turn = Rotation3::from_euler_angles(chance.between([0.0, 3.0]), chance.between([0.0, 3.0]), 0.0);
            let place = Similarity { scale: 1.0, rotation: turn.into_inner(), translation: spot };
            let albedo = Albedo::plain(&place, &mut chance);
            stage.put(&Solid::cuboid(Vector3::new(0.2, 0.1, 0.15)), &place, albedo);
        }
        let rays = Rays::new(&camera, SIZE, 1);
        let hits = rays.meet(&stage, &placement);
        let placed: Vec<Vector3<f64>> = stage.points.iter().map(|&point| placement.apply(point)).collect();
        let mut boxes = 0;
        for index in (0..SIZE.len()).step_by(13) {
            let [x, y] = rays.slopes[index].map(f64::from);
            let ray = Vector3::new(x, y, 1.0);
            let depths = stage.triangles.iter().filter_map(|triangle| {
                let [a, b, c] = triangle.corners.map(|corner| placed[corner as usize]);
                // The ray meets the triangle where ray t = a + u (b - a) + v (c - a).
                let solution = Matrix3::from_columns(&[ray, a - b, a - c]).lu().solve(&a)?;
                let [t, u, v] = solution.into();
                (t > 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0).then_some(t)
            });
            let nearest = depths.fold(f64::INFINITY, f64::min);
            let found = f64::from(hits.depth[index]);
            assert!((found - nearest).abs() < 1e-5 || nearest.is_infinite(), "{index}: {found} {nearest}");
            boxes += usize::from(rays.hit(&stage, &placement, &hits, index).is_some_and(|hit| hit.point.z < 1.29));
        }
        assert!(boxes > 100, "{boxes}");
    }
}
