//! Triangle meshes of simple bodies about the origin, in metres.

use std::f64::consts::TAU;

use nalgebra::Vector3;

/// Largest side of a cell of a flat face, metres. A lens bends edges, but hardly over so short a distance.
const LONGEST_SIDE: f64 = 0.1;

/// Triangles with normals at their corners, which need not face outwards.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    pub points: Vec<Vector3<f64>>,
    pub normals: Vec<Vector3<f64>>,
    pub triangles: Vec<[usize; 3]>,
}

impl Solid {
    /// A parallelogram from `corner` along two sides, divided into cells.
    pub fn face(corner: Vector3<f64>, a: Vector3<f64>, b: Vector3<f64>) -> Self {
        let cells = |side: &Vector3<f64>| (side.norm() / LONGEST_SIDE).ceil().max(1.0) as usize;
        Self::net([cells(&a), cells(&b)], |[u, v]| corner + u * a + v * b)
    }

    /// A cuboid with these sides.
    pub fn cuboid(sides: Vector3<f64>) -> Self {
        let mut solid = Self::default();
        for axis in 0..3 {
            let along = |axis: usize| {
                let mut side = Vector3::zeros();
                side[axis % 3] = sides[axis % 3];
                side
            };
            let (a, b) = (along(axis + 1), along(axis + 2));
            solid.add(Self::face(-0.5 * sides, a, b));
            solid.add(Self::face(0.5 * sides, -a, -b));
        }
        solid
    }

    /// A smooth surface over the unit square.
    pub fn net([columns, rows]: [usize; 2], point: impl Fn([f64; 2]) -> Vector3<f64>) -> Self {
        let mut solid = Self::default();
        for row in 0..=rows {
            for column in 0..=columns {
                solid.points.push(point([column as f64 / columns as f64, row as f64 / rows as f64]));
            }
        }
        for row in 0..rows {
            for column in 0..columns {
                let [a, b] = [0, 1].map(|down| (row + down) * (columns + 1) + column);
                solid.triangles.extend([[a, b, a + 1], [a + 1, b, b + 1]]);
            }
        }
        solid.smooth();
        solid
    }

    /// A body of revolution about y. Each profile maps 0 .. 1 to (radius, y); the surface is smooth along a profile and
    /// sharp between one and the next.
    pub fn revolved(profiles: &[&dyn Fn(f64) -> [f64; 2]], [around, along]: [usize; 2]) -> Self {
        let mut solid = Self::default();
        for profile in profiles {
            solid.add(Self::net([around, along], |[u, v]| {
                let [radius, y] = profile(v);
                let (sin, cos) = (TAU * u).sin_cos();
                Vector3::new(radius * cos, y, radius * sin)
            }));
        }
        solid
    }

    /// Flat triangles.
    pub fn faceted(points: &[Vector3<f64>], triangles: &[[usize; 3]]) -> Self {
        let mut solid = Self::default();
        for corners in triangles {
            let first = solid.points.len();
            solid.points.extend(corners.map(|corner| points[corner]));
            solid.triangles.push([first, first + 1, first + 2]);
        }
        solid.smooth();
        solid
    }

    pub fn add(&mut self, other: Self) {
        let first = self.points.len();
        self.points.extend(other.points);
        self.normals.extend(other.normals);
        self.triangles.extend(other.triangles.iter().map(|corners| corners.map(|corner| first + corner)));
    }

    /// The same body stretched along the axes.
    pub fn stretched(mut self, factors: Vector3<f64>) -> Self {
        self.points.iter_mut().for_each(|point| point.component_mul_assign(&factors));
        self.normals.iter_mut().for_each(|normal| *normal = normal.component_div(&factors).normalize());
        self
    }

    /// Computes area-weighted mean normals.
    fn smooth(&mut self) {
        let mut normals = vec![Vector3::zeros(); self.points.len()];
        for corners in &self.triangles {
            let [a, b, c] = corners.map(|corner| self.points[corner]);
            let normal = (b - a).cross(&(c - a));
            corners.iter().for_each(|&corner| normals[corner] += normal);
        }
        self.normals = normals.iter().map(|n| n.try_normalize(0.0).unwrap_or_else(Vector3::z)).collect();
    }
}

/// A prism whose regular base has this many corners, of radius and height one.
pub fn prism(corners: usize) -> Solid {
    let at = |k: usize, y: f64| {
        let (sin, cos) = (TAU * k as f64 / corners as f64).sin_cos();
        Vector3::new(cos, y, sin)
    };
    let mut solid = Solid::default();
    for k in 0..corners {
        let [a, b] = [at(k, -0.5), at(k + 1, -0.5)];
        solid.add(Solid::net([4, 4], |[u, v]| a + u * (b - a) + v * Vector3::y()));
        for y in [-0.5, 0.5] {
            let [a, b, centre] = [at(k, y), at(k + 1, y), y * Vector3::y()];
            solid.add(Solid::faceted(&[a, b, centre], &[[0, 1, 2]]));
        }
    }
    solid
}

/// An icosahedron in a ball of radius one.
pub fn icosahedron() -> Solid {
    const GOLDEN: f64 = 1.618_033_988_749_895;
    let mut points = Vec::new();
    for axis in 0..3 {
        for (near, far) in [(1.0, GOLDEN), (1.0, -GOLDEN), (-1.0, GOLDEN), (-1.0, -GOLDEN)] {
            let mut point = Vector3::zeros();
            point[axis] = near;
            point[(axis + 1) % 3] = far;
            points.push(point / GOLDEN.hypot(1.0));
        }
    }
    let edge = 2.0 / GOLDEN.hypot(1.0) + 1e-9;
    let near = |a: usize, b: usize| (points[a] - points[b]).norm() < edge;
    let mut triangles = Vec::new();
    for a in 0..12 {
        for b in a + 1..12 {
            triangles.extend((b + 1..12).filter(|&c| near(a, b) && near(b, c) && near(c, a)).map(|c| [a, b, c]));
        }
    }
    Solid::faceted(&points, &triangles)
}

/// A ring of radius one and this thickness about the y axis.
pub fn torus(thickness: f64) -> Solid {
    Solid::net([64, 24], |[u, v]| {
        let [(sin, cos), (up, out)] = [(TAU * u).sin_cos(), (TAU * v).sin_cos()];
        let radius = 1.0 + 0.5 * thickness * out;
        Vector3::new(radius * cos, 0.5 * thickness * up, radius * sin)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_have_their_sizes_and_normals() {
        let box_ = Solid::cuboid(Vector3::new(0.2, 0.3, 0.05));
        for (point, normal) in box_.points.iter().zip(&box_.normals) {
            let out = point.component_div(&Vector3::new(0.1, 0.15, 0.025));
            assert!((out.abs().max() - 1.0).abs() < 1e-12);
            assert!((out.component_mul(normal).abs().max() - 1.0).abs() < 1e-12, "{point} {normal}");
        }
        let ball = icosahedron();
        assert_eq!(ball.triangles.len(), 20);
        assert!(ball.points.iter().all(|point| (point.norm() - 1.0).abs() < 1e-12));
        let ring = torus(0.5).stretched(Vector3::new(1.0, 2.0, 1.0));
        assert!(ring.points.iter().all(|point| point.y.abs() < 0.5 + 1e-9 && point.x.hypot(point.z) < 1.25 + 1e-9));
        assert!(ring.normals.iter().all(|normal| (normal.norm() - 1.0).abs() < 1e-9));
        assert_eq!(prism(6).triangles.len(), 6 * (32 + 2));
    }
}
