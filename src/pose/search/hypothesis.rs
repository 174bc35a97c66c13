//! A pose in terms of the search.

use nalgebra::{Matrix3, Rotation3, Vector3};

/// A rotation, an apparent size relative to the initial one, a translation in cells of the grid, and their score.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hypothesis {
    pub rotation: Matrix3<f64>,
    pub size: f64,
    pub shift: [i32; 2],
    pub score: f64,
}

impl Hypothesis {
    /// The hypothesis after a rotation about x, y and z by these angles, radians, and a growth by this natural
    /// logarithm of a factor.
    pub fn moved(&self, rotation: Vector3<f64>, growth: f64) -> Self {
        let rotation = Rotation3::new(rotation).into_inner() * self.rotation;
        Self { rotation, size: self.size * growth.exp(), ..*self }
    }

    /// The hypothesis with the higher score.
    pub fn better(self, other: Self) -> Self {
        if other.score > self.score { other } else { self }
    }
}
