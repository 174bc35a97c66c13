//! Rigid motions from files: checked, orthonormal to the last digit, in metres, P_to = R P_from + t.

use bimodal_stereo::Similarity;
use bimodal_stereo::nalgebra::{Matrix3, Vector3};

use super::calibration::{NamedPose, Names, Reason};
use super::numbers::{precise, shown};
use crate::warning::Warnings;

/// Largest element of R R^T - 1 of a rotation. Truncated digits or a drifted calibration cause smaller ones.
const ROTATION_TOLERANCE: f64 = 1e-2;
/// Largest such element without a warning: 0.06 degrees, the rounding of four digits.
const ROUNDING: f64 = 1e-3;
/// Largest distance between cameras of one rig, metres: a longer shift is in millimetres.
const LONGEST: f64 = 10.0;

/// The nearest rotation, by Newton's iteration for the polar factor: it converges quadratically, and four steps from
/// 1e-2 are exact.
fn nearest(matrix: Matrix3<f64>) -> Matrix3<f64> {
    (0..6).fold(matrix, |r, _| r.try_inverse().map_or(r, |inverse| (r + inverse.transpose()) / 2.0))
}

/// Nine numbers as a rotation, with a warning if they had to be changed.
pub fn rotation_of(values: &[f64], warnings: &mut Warnings) -> Result<Matrix3<f64>, Reason> {
    if values.len() != 9 || !values.iter().all(|value| value.is_finite()) {
        return Err("a rotation has nine numbers".into());
    }
    let matrix = Matrix3::from_row_slice(values);
    let differences = (matrix * matrix.transpose() - Matrix3::identity()).abs();
    // If squares overflow, the differences are NaN.
    let off = if differences.iter().any(|one| one.is_nan()) { f64::INFINITY } else { differences.max() };
    if off > ROTATION_TOLERANCE {
        return Err(format!("its matrix is not a rotation: R R^T differs from 1 by {}", precise(off, 2)));
    }
    if matrix.determinant() < 0.0 {
        return Err("its rotation mirrors (the determinant is -1): an axis or the handedness is swapped".into());
    }
    if off > ROUNDING {
        warnings.add(
            "rotation-adjusted",
            format!(
                "The rotation matrix is not quite orthonormal (R R^T differs from 1 by {}); the nearest rotation is used.",
                precise(off, 2)
            ),
        );
    }
    Ok(nearest(matrix))
}

/// A rotation from a quaternion x, y, z, w.
pub fn of_quaternion(values: [f64; 4], warnings: &mut Warnings) -> Result<Matrix3<f64>, Reason> {
    let length = values.iter().map(|value| value * value).sum::<f64>().sqrt();
    if (length - 1.0).abs() > ROTATION_TOLERANCE || length.is_nan() {
        return Err(format!("its quaternion has the length {}, not 1", precise(length, 3)));
    }
    if (length - 1.0).abs() > ROUNDING {
        warnings.add(
            "quaternion-normalised",
            format!("The quaternion has length {} and was normalised.", precise(length, 4)),
        );
    }
    let [a, b, c, d] = values.map(|value| value / length);
    Ok(Matrix3::new(
        1.0 - 2.0 * (b * b + c * c),
        2.0 * (a * b - c * d),
        2.0 * (a * c + b * d),
        2.0 * (a * b + c * d),
        1.0 - 2.0 * (a * a + c * c),
        2.0 * (b * c - a * d),
        2.0 * (a * c - b * d),
        2.0 * (b * c + a * d),
        1.0 - 2.0 * (a * a + b * b),
    ))
}

/// A rotation from a rotation vector in rad.
pub fn of_vector([x, y, z]: [f64; 3]) -> Result<Matrix3<f64>, Reason> {
    let angle = x.hypot(y).hypot(z);
    if angle < 1e-12 {
        return Ok(Matrix3::new(1.0, -z, y, z, 1.0, -x, -y, x, 1.0));
    }
    let half = (angle / 2.0).sin() / angle;
    of_quaternion([x * half, y * half, z * half, (angle / 2.0).cos()], &mut Warnings::default())
}

/// A rotation from ROS 1's yaw, pitch and roll in rad: about fixed axes in the order roll (x), pitch (y), yaw (z).
pub fn of_yaw_pitch_roll([yaw, pitch, roll]: [f64; 3]) -> Matrix3<f64> {
    let ((sy, cy), (sp, cp), (sr, cr)) = (yaw.sin_cos(), pitch.sin_cos(), roll.sin_cos());
    Matrix3::new(
        cy * cp,
        cy * sp * sr - sy * cr,
        cy * sp * cr + sy * sr,
        sy * cp,
        sy * sp * sr + cy * cr,
        sy * sp * cr - cy * sr,
        -sp,
        cp * sr,
        cp * cr,
    )
}

/// A shift in metres. `is_rig` states that the shift is between two cameras rather than a camera and the world. A shift
/// that is too long for a rig is then read in millimetres.
pub fn shift_of(values: &[f64], is_rig: bool, warnings: &mut Warnings) -> Result<Vector3<f64>, Reason> {
    if values.len() != 3 || !values.iter().all(|value| value.is_finite() && value.abs() < 1e9) {
        return Err("a translation has three numbers".into());
    }
    let shift = Vector3::from_column_slice(values);
    if !is_rig || shift.norm() <= LONGEST {
        return Ok(shift);
    }
    warnings.add(
        "translation-unit-guessed",
        format!("The translation is {} units long and was guessed to be in millimetres.", precise(shift.norm(), 4)),
    );
    Ok(shift / 1000.0)
}

/// A named pose from a rotation and a translation.
pub fn motion(
    rotation: &[f64],
    translation: &[f64],
    names: Names,
    warnings: &mut Warnings,
    is_rig: bool,
) -> Result<NamedPose, Reason> {
    let rotation = rotation_of(rotation, warnings)?;
    let translation = shift_of(translation, is_rig, warnings)?;
    Ok(NamedPose { names, pose: Similarity { scale: 1.0, rotation, translation } })
}

/// A named pose from a rotation that was computed from other numbers.
pub fn turned(
    rotation: &Matrix3<f64>,
    translation: &[f64],
    names: Names,
    warnings: &mut Warnings,
    is_rig: bool,
) -> Result<NamedPose, Reason> {
    motion(rotation.transpose().as_slice(), translation, names, warnings, is_rig)
}

/// Whether a row is the last one of a motion's matrix, 0 0 0 1.
pub fn is_last_row(row: &[f64]) -> bool {
    row.len() == 4
        && row.iter().enumerate().all(|(index, value)| (value - f64::from(u8::from(index == 3))).abs() < 1e-6)
}

/// The last column of 16 numbers.
pub fn last_column(values: &[f64]) -> Vec<f64> {
    values.iter().skip(3).step_by(4).copied().collect()
}

/// A motion from 12 or 16 numbers, row by row.
pub fn motion_of_matrix(
    values: &[f64],
    names: Names,
    warnings: &mut Warnings,
    is_rig: bool,
) -> Result<NamedPose, Reason> {
    if values.len() != 12 && values.len() != 16 {
        return Err(format!("a transform has 3x4 or 4x4 numbers, not {}", values.len()));
    }
    if values.len() == 16 && !is_last_row(&values[12..]) {
        if is_last_row(&last_column(values)) {
            return Err("its matrix is transposed: the translation is in the last row".into());
        }
        let row: Vec<String> = values[12..].iter().map(|&value| shown(value)).collect();
        return Err(format!("its matrix ends in the row {}, not in 0 0 0 1", row.join(" ")));
    }
    let rotation = [0, 1, 2, 4, 5, 6, 8, 9, 10].map(|index| values[index]);
    motion(&rotation, &[values[3], values[7], values[11]], names, warnings, is_rig)
}

/// The composition of rigid motions: first `b`, then `a`.
pub fn chained(a: &Similarity, b: &Similarity) -> Similarity {
    a.after(b)
}
