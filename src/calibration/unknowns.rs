//! The unknowns of a check, and the derivatives of pixels with respect to them.
//!
//! P -> c + exp([w]) (P - c) + v about the scene's centre c, in the colour camera's frame; the edge bias, in pixels
//! d_0 + d_x n_x + d_y n_y at a depth discontinuity with the normal n; and ln f of the colour camera if it is unknown. A
//! depth camera removes or adds a strip at depth discontinuities. One part of the strip's width is the same everywhere.
//! Another part differs from side to side, since the shadow of a stereo pair lies to one side, and a maker's
//! registration may be off. The unit of each unknown moves the scene's pixels by one pixel, root mean square. All
//! unknowns are then comparable, and steps, derivatives and tolerances have one size.

use nalgebra::{Rotation3, SMatrix, SVector, Vector3};

use crate::numeric::eigen::Eigen;
use crate::pose::{Similarity, rotation_vector};
use crate::view::Pinhole;

/// Number of unknowns: w (3), v (3), d (3), ln f.
pub(super) const UNKNOWNS: usize = 10;
/// Number of unknowns of the pose, which come first.
pub(super) const POSE: usize = 6;
/// Number of components of the edge bias, and the index of the first.
pub(super) const SIDES: usize = 3;
pub(super) const BIAS: usize = 6;
pub(super) const FOCAL: usize = 9;

pub(super) type Vector = SVector<f64, UNKNOWNS>;
pub(super) type Matrix = SMatrix<f64, UNKNOWNS, UNKNOWNS>;

/// Adds a row's square to `matrix`. This function and the next two are not inlined, because each inlined copy would add a
/// kilobyte to the .wasm file.
#[inline(never)]
pub(super) fn add_square(matrix: &mut Matrix, row: &Vector, weight: f64) {
    for k in 0..UNKNOWNS {
        for j in 0..UNKNOWNS {
            matrix[(j, k)] += row[j] * row[k] * weight;
        }
    }
}

/// The solution of a positive definite system.
#[inline(never)]
pub(super) fn solve(matrix: &Matrix, right: &Vector) -> Option<Vector> {
    matrix.cholesky().map(|factors| factors.solve(right))
}

/// V f(L) V^T of the eigendecomposition V L V^T of a symmetric matrix.
#[inline(never)]
pub(super) fn spectral(eigen: &Eigen<UNKNOWNS>, of: fn(f64) -> f64) -> Matrix {
    eigen.eigenvectors * Matrix::from_diagonal(&eigen.eigenvalues.map(of)) * eigen.eigenvectors.transpose()
}

/// Least motion in pixels per radian or metre, which keeps units finite if no point lies in front of the camera.
const LEAST_MOTION: f64 = 1e-6;

/// The state of a check: the extrinsics and the other unknowns.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub pose: Similarity,
    /// Edge bias d_0, d_x, d_y in pixels of the colour image.
    pub bias: [f64; SIDES],
    /// Factor of the colour camera's focal length.
    pub focal: f64,
}

impl State {
    pub fn at(pose: Similarity) -> Self {
        Self { pose, bias: [0.0; SIDES], focal: 1.0 }
    }

    /// Derivatives of the edge bias at a discontinuity with this normal with respect to its components.
    pub fn sides(normal: [f64; 2]) -> [f64; SIDES] {
        [1.0, normal[0], normal[1]]
    }

    /// Edge bias at a discontinuity with this normal, pixels along the normal.
    pub fn bias_along(&self, normal: [f64; 2]) -> f64 {
        self.bias.iter().zip(Self::sides(normal)).map(|(bias, side)| bias * side).sum()
    }

    pub fn camera(&self, camera: &Pinhole) -> Pinhole {
        Pinhole { fx: camera.fx * self.focal, fy: camera.fy * self.focal, ..*camera }
    }
}

/// The centre c and the units.
#[derive(Clone, Copy, Debug)]
pub(super) struct Units {
    /// Mean x and y of the points and their median depth, in the colour camera's frame, metres.
    pub middle: Vector3<f64>,
    /// Size of one unit of each unknown in radians, metres, pixels, and ln f.
    pub of: Vector,
}

impl Units {
    /// The units, each of which moves a cloud by one pixel. The points of the cloud are in the colour camera's frame.
    pub fn new(points: &[Vector3<f64>], camera: &Pinhole) -> Self {
        let mut depths: Vec<f32> = points.iter().map(|point| point.z as f32).collect();
        let mean = points.iter().sum::<Vector3<f64>>() / points.len().max(1) as f64;
        let depth = if depths.is_empty() { 1.0 } else { f64::from(crate::numeric::quantile(&mut depths, 0.5)) };
        let middle = Vector3::new(mean.x, mean.y, depth);
        let mut units = Self { middle, of: Vector::repeat(1.0) };
        let mut squares = Vector::zeros();
        let mut count = 0.0;
        for point in points {
            if let Some((_, rows)) = units.rows(point, camera) {
                squares += rows[0].component_mul(&rows[0]) + rows[1].component_mul(&rows[1]);
                count += 1.0;
            }
        }
        for k in (0..UNKNOWNS).filter(|k| !(BIAS..BIAS + SIDES).contains(k)) {
            units.of[k] = 1.0 / (squares[k] / f64::max(count, 1.0)).sqrt().max(LEAST_MOTION);
        }
        units
    }

    /// Pixel of a point in the colour camera's frame, and the derivatives of its column and row with respect to the
    /// unknowns.
    pub fn rows(&self, point: &Vector3<f64>, camera: &Pinhole) -> Option<([f64; 2], [Vector; 2])> {
        let (pixel, gradient) = camera.project_with_gradient([point.x, point.y, point.z])?;
        let arm = point - self.middle;
        let from_centre = [pixel[0] - camera.cx, pixel[1] - camera.cy];
        let rows = [0, 1].map(|axis| {
            let direction = Vector3::from(gradient[axis]);
            let turn = arm.cross(&direction);
            Vector::from([
                turn.x,
                turn.y,
                turn.z,
                direction.x,
                direction.y,
                direction.z,
                0.0,
                0.0,
                0.0,
                from_centre[axis],
            ])
            .component_mul(&self.of)
        });
        Some((pixel, rows))
    }

    /// The state after a step.
    pub fn step(&self, state: &State, step: &Vector) -> State {
        let step = step.component_mul(&self.of);
        let rotation = Rotation3::new(step.fixed_rows::<3>(0).into_owned()).into_inner();
        let shift: Vector3<f64> = step.fixed_rows::<3>(3).into();
        let translation = self.middle + shift - rotation * self.middle;
        State {
            pose: Similarity { scale: 1.0, rotation, translation }.after(&state.pose).orthonormal(),
            bias: std::array::from_fn(|k| state.bias[k] + step[BIAS + k]),
            focal: state.focal * step[FOCAL].exp(),
        }
    }

    /// The step from one state to another (the inverse of [`step`](Self::step)).
    pub fn between(&self, from: &State, to: &State) -> Vector {
        let rotation = rotation_vector(&(to.pose.rotation * from.pose.rotation.transpose()));
        let moved = to.pose.apply(from.pose.inverse().apply(self.middle)) - self.middle;
        Vector::from([
            rotation.x,
            rotation.y,
            rotation.z,
            moved.x,
            moved.y,
            moved.z,
            to.bias[0] - from.bias[0],
            to.bias[1] - from.bias[1],
            to.bias[2] - from.bias[2],
            (to.focal / from.focal).ln(),
        ])
        .component_div(&self.of)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Lens;

    #[test]
    fn a_step_and_the_difference_of_states_are_inverse_and_each_side_has_its_own_bias() {
        let camera = Pinhole { fx: 500.0, fy: 500.0, cx: 320.0, cy: 240.0, lens: Lens::None };
        let cloud = [[-0.3, -0.2, 1.0], [0.3, -0.2, 1.2], [0.0, 0.3, 0.9]].map(Vector3::from);
        let units = Units::new(&cloud, &camera);
        let start = State::at(Similarity::identity());
        let step = Vector::from_fn(|k, _| 0.3 * k as f64 - 1.1);
        let state = units.step(&start, &step);
        assert!((units.between(&start, &state) - step).norm() < 1e-6, "{}", units.between(&start, &state));
        let [whole, across, down] = state.bias;
        let sides = [([1.0, 0.0], whole + across), ([-1.0, 0.0], whole - across), ([0.0, 1.0], whole + down)];
        for (normal, bias) in sides {
            assert!((state.bias_along(normal) - bias).abs() < 1e-12, "{normal:?}");
        }
        assert_eq!([BIAS, BIAS + SIDES], [POSE, FOCAL]);
    }
}
