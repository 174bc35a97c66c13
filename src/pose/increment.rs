//! One Gauss-Newton step of a similarity: seven unknowns about the centre of the matched points.
//!
//! The step is P -> c + e^u exp([w]) (P - c) + L v with the rotation w (radians), the translation L v and the growth u
//! (natural logarithm of the factor of the scale). c is the centroid of the points and L their root mean square
//! distance from it, so that all seven numbers are dimensionless, of similar size and hardly coupled. Residuals are
//! divided by L as well.

use nalgebra::{Matrix3, Rotation3, SMatrix, SVector, UnitQuaternion, Vector3};

use super::similarity::Similarity;
use crate::view::Camera;

/// Largest rotation of one step in radians; beyond it the linear model of a rotation is off by more than 2 %.
const LARGEST_ROTATION: f64 = 0.2;
/// Largest |u| of one step, for the same reason.
const LARGEST_GROWTH: f64 = 0.1;

/// Number of unknowns, in the order w (3), v (3), u.
pub(crate) const UNKNOWNS: usize = 7;
/// Indices of the translation along z and of the scale.
pub(crate) const TRANSLATION_Z: usize = 5;
pub(crate) const SCALE: usize = 6;
/// Sigma of an undetermined direction, radians or object sizes, large enough to be recognised as "unknown".
pub(crate) const UNKNOWN: f64 = 1e3;
/// A matrix over the unknowns.
pub(crate) type PoseMatrix = SMatrix<f64, UNKNOWNS, UNKNOWNS>;
/// One number for each unknown: a row of a Jacobian, a gradient or a step.
pub(crate) type PoseVector = SVector<f64, UNKNOWNS>;

/// c and L: the origin of the unknowns, and their unit of length.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Frame {
    pub centre: Vector3<f64>,
    pub length: f64,
}

impl Frame {
    /// Derivative of a point's position along `direction` by each unknown.
    pub fn row(&self, point: &Vector3<f64>, direction: &Vector3<f64>) -> PoseVector {
        let arm = point - self.centre;
        let by_rotation = arm.cross(direction);
        let shift = self.length * direction;
        PoseVector::from([by_rotation.x, by_rotation.y, by_rotation.z, shift.x, shift.y, shift.z, arm.dot(direction)])
    }

    /// The similarity of a step, which is shortened to stay nearly linear.
    pub fn change(&self, step: &PoseVector) -> Similarity {
        let rotation: Vector3<f64> = step.fixed_rows::<3>(0).into();
        let shift: Vector3<f64> = step.fixed_rows::<3>(3).into();
        let share = (LARGEST_ROTATION / rotation.norm()).min(LARGEST_GROWTH / step[SCALE].abs()).min(1.0);
        let rotation = Rotation3::new(rotation * share).into_inner();
        let scale = (step[SCALE] * share).exp();
        let translation = self.centre + shift * (share * self.length) - scale * (rotation * self.centre);
        Similarity { scale, rotation, translation }
    }
}

/// Axis times angle of a rotation, radians. Uses a quaternion because nalgebra takes a matrix's angle from its trace,
/// which rounding raises above three for the identity, and the angle is then NaN.
pub(crate) fn rotation_vector(rotation: &Matrix3<f64>) -> Vector3<f64> {
    UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*rotation)).scaled_axis()
}

/// Unknowns that keep their values: t_z of an orthographic image, which is a gauge, and a held scale, which includes
/// that of every pinhole image.
pub(super) fn held_unknowns(camera: &Camera, scale_is_held: bool) -> [bool; UNKNOWNS] {
    let is_gauge = camera.is_orthographic();
    std::array::from_fn(|k| match k {
        TRANSLATION_Z => is_gauge,
        SCALE => scale_is_held || !is_gauge,
        _ => false,
    })
}

/// Sets rows and columns of the unknowns that are `held` to zero.
pub(crate) fn clear_unknowns(matrix: &mut PoseMatrix, held: &[bool; UNKNOWNS]) {
    for k in (0..UNKNOWNS).filter(|&k| held[k]) {
        matrix.row_mut(k).fill(0.0);
        matrix.column_mut(k).fill(0.0);
    }
}

/// Sets rows and columns of held unknowns to zero and their diagonal to one, so that they do not move and the matrix
/// can be inverted.
pub(crate) fn fix_unknowns(matrix: &mut PoseMatrix, held: &[bool; UNKNOWNS]) {
    clear_unknowns(matrix, held);
    (0..UNKNOWNS).filter(|&k| held[k]).for_each(|k| matrix[(k, k)] = 1.0);
}

/// Sums of one step over point-to-plane or point-to-point residuals.
pub(crate) struct NormalEquations {
    frame: Frame,
    matrix: PoseMatrix,
    gradient: PoseVector,
    weight: f64,
}

/// Result of one step, in dimensionless numbers.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Increment {
    pub change: Similarity,
    /// The largest of the rotation in radians, the shift in object sizes, and the growth of the scale.
    pub size: f64,
}

impl NormalEquations {
    pub fn new(centre: Vector3<f64>, length: f64) -> Self {
        Self {
            frame: Frame { centre, length },
            matrix: PoseMatrix::zeros(),
            gradient: PoseVector::zeros(),
            weight: 0.0,
        }
    }

    /// Derivative of a point's position along `direction` by each unknown, in units of L.
    pub fn row(&self, point: &Vector3<f64>, direction: &Vector3<f64>) -> PoseVector {
        self.frame.row(point, direction) / self.frame.length
    }

    /// Adds a residual: the distance that `point` has left to move along the unit vector `direction`.
    pub fn add(&mut self, point: &Vector3<f64>, direction: &Vector3<f64>, residual: f64, weight: f64) {
        let row = self.row(point, direction);
        self.matrix.syger(weight, &row, &row, 1.0);
        self.gradient.axpy(weight * residual / self.frame.length, &row, 1.0);
        self.weight += weight;
    }

    /// Solves the equations with a damping of a share of the total weight on each unknown, and shortens the step to
    /// stay nearly linear. `None` if the sums are empty or not finite.
    pub fn solve(&self, damping: f64, scale_is_held: bool) -> Option<Increment> {
        let mut matrix = self.matrix;
        let mut gradient = self.gradient;
        matrix.fill_upper_triangle_with_lower_triangle();
        if scale_is_held {
            clear_unknowns(&mut matrix, &std::array::from_fn(|k| k == SCALE));
            gradient[SCALE] = 0.0;
        }
        for k in 0..UNKNOWNS {
            matrix[(k, k)] += damping * self.weight;
        }
        let step = solve(matrix, &gradient)?;
        let rotation: Vector3<f64> = step.fixed_rows::<3>(0).into();
        let shift: Vector3<f64> = step.fixed_rows::<3>(3).into();
        if !step.norm().is_finite() {
            return None;
        }
        let change = self.frame.change(&step);
        let size = rotation.norm().max(shift.norm()).max(step[SCALE].abs());
        Some(Increment { change, size })
    }
}

/// The Gauss-Newton step of symmetric equations, damped by a share of the diagonal (Levenberg and Marquardt); held
/// unknowns do not move. `None` if the equations determine no step.
pub(crate) fn damped_step(
    mut matrix: PoseMatrix,
    mut gradient: PoseVector,
    damping: f64,
    held: &[bool; UNKNOWNS],
) -> Option<PoseVector> {
    for k in 0..UNKNOWNS {
        matrix[(k, k)] *= 1.0 + damping;
        if held[k] {
            gradient[k] = 0.0;
        }
    }
    fix_unknowns(&mut matrix, held);
    solve(matrix, &gradient).map(|step| -step).filter(|step| step.norm().is_finite())
}

/// The solution of symmetric equations; `None` if they are not positive definite. Like the next two functions it is not
/// inlined, because every copy adds to the download.
#[inline(never)]
pub(crate) fn solve(matrix: PoseMatrix, gradient: &PoseVector) -> Option<PoseVector> {
    Some(matrix.cholesky()?.solve(gradient))
}

/// A matrix product; inlined, it would be unrolled at every call.
#[inline(never)]
pub(crate) fn product(left: &PoseMatrix, right: &PoseMatrix) -> PoseMatrix {
    left * right
}

/// The inverse, or `None` if the matrix is singular.
#[inline(never)]
pub(crate) fn inverse(matrix: &PoseMatrix) -> Option<PoseMatrix> {
    matrix.try_inverse()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_are_the_derivative_of_the_step() {
        let equations = NormalEquations::new(Vector3::new(3.0, -2.0, 40.0), 5.0);
        let (point, direction) = (Vector3::new(5.0, 1.0, 37.0), Vector3::new(0.6, 0.0, -0.8));
        let row = equations.row(&point, &direction);
        let small = 1e-6;
        for k in 0..UNKNOWNS {
            let mut step = PoseVector::zeros();
            step[k] = small;
            let rotation: Vector3<f64> = step.fixed_rows::<3>(0).into();
            let shift: Vector3<f64> = step.fixed_rows::<3>(3).into();
            let arm = Rotation3::new(rotation) * (point - equations.frame.centre) * step[SCALE].exp();
            let moved = equations.frame.centre + arm + shift * equations.frame.length;
            let slope = (moved - point).dot(&direction) / (small * equations.frame.length);
            assert!((slope - row[k]).abs() < 1e-5, "{k}: {slope} {}", row[k]);
        }
    }

    #[test]
    fn a_rotation_vector_is_a_number_even_where_rounding_turns_nothing() {
        let mut is_raised = false;
        // The test covers up to half a turn, beyond which another vector describes the same rotation.
        for k in 0..1750 {
            let vector = Vector3::new(0.001, -0.0007, 0.0013) * f64::from(k);
            let rotation = Rotation3::new(vector).into_inner();
            assert!((rotation_vector(&rotation) - vector).norm() < 1e-12, "{k}");
            let nothing = rotation * rotation.transpose();
            is_raised |= nothing.trace() > 3.0;
            // This comparison also fails for NaN.
            assert!(rotation_vector(&nothing).norm() < 1e-14, "{k}");
        }
        assert!(is_raised, "no product rounds to a trace above three");
    }

    #[test]
    fn exact_gaps_are_closed_in_a_few_steps() {
        let truth = Similarity {
            scale: 1.05,
            rotation: Rotation3::new(Vector3::new(0.1, -0.05, 0.08)).into_inner(),
            translation: Vector3::new(0.3, -0.2, 0.1),
        };
        let points: Vec<_> = (0..20).map(|k| Vector3::new((k % 3) as f64, (k % 5) as f64, (k % 7) as f64)).collect();
        let centre = points.iter().sum::<Vector3<f64>>() / 20.0;
        let mut pose = Similarity::identity();
        for _ in 0..8 {
            let mut equations = NormalEquations::new(pose.apply(centre), 3.0);
            for point in &points {
                for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                    let gap = (truth.apply(*point) - pose.apply(*point)).dot(&axis);
                    equations.add(&pose.apply(*point), &axis, gap, 1.0);
                }
            }
            pose = equations.solve(0.0, false).expect("points in space").change.after(&pose);
        }
        assert!((pose.scale - truth.scale).abs() < 1e-9 && pose.degrees_to(&truth) < 1e-7);
        assert!((pose.translation - truth.translation).norm() < 1e-8);
    }

    #[test]
    fn nothing_determines_no_step() {
        assert!(NormalEquations::new(Vector3::zeros(), 1.0).solve(1e-3, false).is_none());
    }
}
