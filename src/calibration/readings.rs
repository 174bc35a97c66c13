//! Other readings of a candidate: the conventions in which files of extrinsics are commonly misread.
//!
//! A candidate that the frames contradict may be right in another convention. Each reading of the candidate is a pose.

use std::fmt;

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use crate::pose::{Similarity, rotation_vector};

/// Rotation from axes x forward, y left, z up to axes x right, y down, z forward.
const OPTICAL_OF_BODY: Matrix3<f64> = Matrix3::new(0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0);

/// A convention that a candidate may follow.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::IntoStaticStr)]
#[strum(serialize_all = "kebab-case")]
pub enum Reading {
    /// P_depth = R P_colour + t.
    Inverse,
    /// The rotation is stored column by column.
    TransposedRotation,
    /// The translation is the position of the colour camera in the depth camera's frame.
    CameraCentre,
    /// The quaternion's scalar comes first, but was read as the last.
    ScalarFirst,
    /// The quaternion's scalar comes last, but was read as the first.
    ScalarLast,
    /// The axes of both frames are x forward, y left, z up.
    BodyFrames,
    /// The axes of the depth frame are x forward, y left, z up.
    BodyDepth,
    /// The axes of the colour frame are x forward, y left, z up.
    BodyColour,
    /// The translation is in millimetres.
    Millimetres,
    /// Angles are in radians, but were read as degrees.
    Radians,
    /// The depth map is registered to the colour image.
    Registered,
    /// The colour image is rotated by 90 degrees clockwise.
    QuarterTurn,
    /// The colour image is rotated by 180 degrees.
    HalfTurn,
    /// The colour image is rotated by 90 degrees counter-clockwise.
    QuarterBack,
}

impl Reading {
    /// Stable name for programs.
    #[must_use]
    pub fn code(self) -> &'static str {
        self.into()
    }

    /// All conventions that are tried.
    pub(super) const ALL: [Self; 14] = [
        Self::Inverse,
        Self::TransposedRotation,
        Self::CameraCentre,
        Self::ScalarFirst,
        Self::ScalarLast,
        Self::BodyFrames,
        Self::BodyDepth,
        Self::BodyColour,
        Self::Millimetres,
        Self::Radians,
        Self::Registered,
        Self::QuarterTurn,
        Self::HalfTurn,
        Self::QuarterBack,
    ];

    /// The pose of a candidate that follows this convention; `None` if the candidate cannot follow it.
    pub(super) fn of(self, pose: &Similarity) -> Option<Similarity> {
        let Similarity { rotation, translation, .. } = *pose;
        let rigid = |rotation, translation| Some(Similarity { scale: 1.0, rotation, translation });
        let body = OPTICAL_OF_BODY;
        match self {
            Self::Inverse => Some(pose.inverse()),
            Self::TransposedRotation => rigid(rotation.transpose(), translation),
            Self::CameraCentre => rigid(rotation, -(rotation * translation)),
            Self::ScalarFirst => rigid(requaternion(&rotation, |[x, y, z, w]| [y, z, w, x])?, translation),
            Self::ScalarLast => rigid(requaternion(&rotation, |[x, y, z, w]| [w, x, y, z])?, translation),
            Self::BodyFrames => rigid(body * rotation * body.transpose(), body * translation),
            Self::BodyDepth => rigid(rotation * body.transpose(), translation),
            Self::BodyColour => rigid(body * rotation, body * translation),
            Self::Millimetres => rigid(rotation, translation / 1000.0),
            Self::Radians => {
                let turn = rotation_vector(&rotation).map(f64::to_degrees);
                let is_turn = turn.norm() <= std::f64::consts::PI;
                is_turn.then(|| rigid(Rotation3::new(turn).into_inner(), translation)).flatten()
            }
            Self::Registered => Some(Similarity::identity()),
            Self::QuarterTurn => Some(about_axis(90.0).after(pose)),
            Self::HalfTurn => Some(about_axis(180.0).after(pose)),
            Self::QuarterBack => Some(about_axis(-90.0).after(pose)),
        }
    }
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Inverse => "as its inverse, from colour to depth",
            Self::TransposedRotation => "with its rotation transposed",
            Self::CameraCentre => "with its translation as the position of the colour camera",
            Self::ScalarFirst => "with its quaternion as w x y z",
            Self::ScalarLast => "with its quaternion as x y z w",
            Self::BodyFrames => "between frames with x forward, y left and z up",
            Self::BodyDepth => "from a depth frame with x forward, y left and z up",
            Self::BodyColour => "to a colour frame with x forward, y left and z up",
            Self::Millimetres => "with its translation in millimetres",
            Self::Radians => "with its angles in radians instead of degrees",
            Self::Registered => "as the identity, the depth map being registered to the colour image",
            Self::QuarterTurn => "for a colour image rotated by 90 degrees clockwise",
            Self::HalfTurn => "for a colour image rotated by 180 degrees",
            Self::QuarterBack => "for a colour image rotated by 90 degrees counter-clockwise",
        })
    }
}

/// A rotation whose quaternion x y z w is reordered.
fn requaternion(rotation: &Matrix3<f64>, order: fn([f64; 4]) -> [f64; 4]) -> Option<Matrix3<f64>> {
    // The iterative `from_matrix` can end at the identity for half turns.
    let quaternion = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(*rotation));
    let [x, y, z, w] = order([quaternion.i, quaternion.j, quaternion.k, quaternion.w]);
    UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-9).map(|turned| turned.to_rotation_matrix().into_inner())
}

fn about_axis(degrees: f64) -> Similarity {
    let turn = Vector3::new(0.0, 0.0, degrees.to_radians());
    Similarity { scale: 1.0, rotation: Rotation3::new(turn).into_inner(), translation: Vector3::zeros() }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Writes the pose of a rig in each convention, reads it as if there were no convention, and applies the reading.
    #[test]
    fn each_reading_undoes_its_own_mistake() {
        let rotation = Rotation3::new(Vector3::new(0.3, -0.5, 0.2)).into_inner();
        let truth = Similarity { scale: 1.0, rotation, translation: Vector3::new(0.05, -0.02, 0.01) };
        let Similarity { translation, .. } = truth;
        let read = |rotation, translation| Similarity { scale: 1.0, rotation, translation };
        let quaternion = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(rotation));
        let of = |[w, x, y, z]: [f64; 4]| {
            UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)).to_rotation_matrix().into_inner()
        };
        let [w, x, y, z] = [quaternion.w, quaternion.i, quaternion.j, quaternion.k];
        let body = OPTICAL_OF_BODY.transpose();
        let turn = rotation_vector(&rotation);
        let mistakes = [
            (Reading::Inverse, truth.inverse()),
            (Reading::TransposedRotation, read(rotation.transpose(), translation)),
            (Reading::CameraCentre, read(rotation, truth.inverse().translation)),
            // One reading expects x y z w of a file with w x y z, and the other one the reverse.
            (Reading::ScalarFirst, read(of([z, w, x, y]), translation)),
            (Reading::ScalarLast, read(of([x, y, z, w]), translation)),
            (Reading::BodyFrames, read(body * rotation * body.transpose(), body * translation)),
            (Reading::BodyDepth, read(rotation * body.transpose(), translation)),
            (Reading::BodyColour, read(body * rotation, body * translation)),
            (Reading::Millimetres, read(rotation, translation * 1000.0)),
            (Reading::Radians, read(Rotation3::new(turn.map(f64::to_radians)).into_inner(), translation)),
            (Reading::QuarterTurn, about_axis(-90.0).after(&truth)),
            (Reading::HalfTurn, about_axis(180.0).after(&truth)),
            (Reading::QuarterBack, about_axis(90.0).after(&truth)),
        ];
        for (reading, mistake) in mistakes {
            let found = reading.of(&mistake).unwrap();
            assert!((found.rotation - truth.rotation).norm() < 1e-9, "{reading:?}: {}", found.rotation);
            assert!((found.translation - truth.translation).norm() < 1e-9, "{reading:?}: {}", found.translation);
        }
        assert_eq!(OPTICAL_OF_BODY * Vector3::x(), Vector3::z());
        assert_eq!(OPTICAL_OF_BODY * Vector3::y(), -Vector3::x());
        assert_eq!(OPTICAL_OF_BODY * Vector3::z(), -Vector3::y());
        assert!((about_axis(90.0).apply(Vector3::x()) - Vector3::y()).norm() < 1e-12);
        assert_eq!(mistakes.len() + 1, Reading::ALL.len());
    }
}
