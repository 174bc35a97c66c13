//! Extrinsics and motions of JavaScript, which the facade has checked for their members.

use nalgebra::{Matrix3, Vector3};

use crate::pose::Similarity;

/// The pose of twelve numbers: its rotation row by row and its translation.
pub fn pose(numbers: &[f64]) -> Similarity {
    let (rotation, translation) = numbers.split_at(9);
    Similarity {
        scale: 1.0,
        rotation: Matrix3::from_row_slice(rotation),
        translation: Vector3::from_column_slice(translation),
    }
}
