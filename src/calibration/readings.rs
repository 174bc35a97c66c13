//! Other readings of a candidate and of the views: the conventions in which files of a rig are commonly misread.
//!
//! A candidate that the frames contradict may be right in another convention. Some readings change the candidate
//! ([`Reading::of`]), others change how the image or the depth map is stored or described (`reframed`).

use std::fmt;

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion, Vector3};

use crate::pose::{Similarity, rotation_vector};

/// Rotation from axes x forward, y left, z up to axes x right, y down, z forward.
const OPTICAL_OF_BODY: Matrix3<f64> = Matrix3::new(0.0, -1.0, 0.0, 0.0, 0.0, -1.0, 1.0, 0.0, 0.0);

/// A convention that a candidate, an image or a depth map may follow.
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
    /// The translation is in metres, but was read as millimetres.
    Metres,
    /// Angles are in radians, but were read as degrees.
    Radians,
    /// Angles are in degrees, but were read as radians.
    Degrees,
    /// The depth map is registered to the colour image.
    Registered,
    /// The colour image is rotated by 90 degrees clockwise.
    QuarterTurn,
    /// The colour image is rotated by 180 degrees.
    HalfTurn,
    /// The colour image is rotated by 90 degrees counter-clockwise.
    QuarterBack,
    /// The colour image is mirrored.
    ImageMirrored,
    /// The colour image is stored rotated by 90 degrees clockwise, and the intrinsics are those before the rotation.
    ImageQuarterTurn,
    /// The same, rotated by 180 degrees.
    ImageHalfTurn,
    /// The same, rotated by 90 degrees counter-clockwise.
    ImageQuarterBack,
    /// The colour camera's intrinsics belong to an image of another size that is as wide in angle.
    ImageResized,
    /// The colour camera's intrinsics belong to an image of another shape that is as high in angle.
    ImageCropped,
    /// The depth map is mirrored.
    DepthMirrored,
    /// The depth map is stored rotated by 90 degrees clockwise, and the intrinsics are those before the rotation.
    DepthQuarterTurn,
    /// The same, rotated by 180 degrees.
    DepthHalfTurn,
    /// The same, rotated by 90 degrees counter-clockwise.
    DepthQuarterBack,
    /// The depth camera's intrinsics belong to a depth map of another size that is as wide in angle.
    DepthResized,
    /// The depth camera's intrinsics belong to a depth map of another shape that is as high in angle.
    DepthCropped,
    /// Depths are distances from the camera along the rays instead of z.
    RayLength,
    /// Depths are in millimetres, but were read as metres.
    DepthMillimetres,
    /// Depths are in metres, but were read as millimetres.
    DepthMetres,
}

impl Reading {
    /// Stable name for programs.
    #[must_use]
    pub fn code(self) -> &'static str {
        self.into()
    }

    /// The readings that change the candidate.
    pub(super) const POSES: [Self; 16] = [
        Self::Inverse,
        Self::TransposedRotation,
        Self::CameraCentre,
        Self::ScalarFirst,
        Self::ScalarLast,
        Self::BodyFrames,
        Self::BodyDepth,
        Self::BodyColour,
        Self::Millimetres,
        Self::Metres,
        Self::Radians,
        Self::Degrees,
        Self::Registered,
        Self::QuarterTurn,
        Self::HalfTurn,
        Self::QuarterBack,
    ];

    /// The readings of the views that the input itself suggests: a principal point far from the middle, or unusual depths.
    pub(super) const SUGGESTED: [Self; 6] = [
        Self::ImageResized,
        Self::ImageCropped,
        Self::DepthResized,
        Self::DepthCropped,
        Self::DepthMillimetres,
        Self::DepthMetres,
    ];

    /// The other readings of the views, of which only the fit can tell.
    pub(super) const VIEWS: [Self; 9] = [
        Self::ImageMirrored,
        Self::ImageQuarterTurn,
        Self::ImageHalfTurn,
        Self::ImageQuarterBack,
        Self::DepthMirrored,
        Self::DepthQuarterTurn,
        Self::DepthHalfTurn,
        Self::DepthQuarterBack,
        Self::RayLength,
    ];

    /// The poses of a candidate that follows this convention; none if the candidate cannot follow it, or if the
    /// convention is not one of poses.
    pub(super) fn of(self, pose: &Similarity) -> Vec<Similarity> {
        if self == Self::Degrees {
            return in_degrees(pose);
        }
        self.one_of(pose).into_iter().collect()
    }

    /// The pose that this reading approaches if it shrinks a part of the candidate: the one without this part.
    pub(super) fn limit(self, read: &Similarity) -> Option<Similarity> {
        match self {
            Self::Degrees => Some(Similarity { rotation: Matrix3::identity(), ..*read }),
            Self::Millimetres => Some(Similarity { translation: Vector3::zeros(), ..*read }),
            _ => None,
        }
    }

    fn one_of(self, pose: &Similarity) -> Option<Similarity> {
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
            Self::Metres => rigid(rotation, translation * 1000.0),
            Self::Radians => {
                let turn = rotation_vector(&rotation).map(f64::to_degrees);
                let is_turn = turn.norm() <= std::f64::consts::PI;
                is_turn.then(|| rigid(Rotation3::new(turn).into_inner(), translation)).flatten()
            }
            Self::Registered => Some(Similarity::identity()),
            Self::QuarterTurn => Some(about_axis(90.0).after(pose)),
            Self::HalfTurn => Some(about_axis(180.0).after(pose)),
            Self::QuarterBack => Some(about_axis(-90.0).after(pose)),
            _ => None,
        }
    }
}

impl fmt::Display for Reading {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Inverse => "if read as its inverse, from colour to depth",
            Self::TransposedRotation => "if read with its rotation transposed",
            Self::CameraCentre => "if read with its translation as the position of the colour camera",
            Self::ScalarFirst => "if read with its quaternion as w x y z",
            Self::ScalarLast => "if read with its quaternion as x y z w",
            Self::BodyFrames => "if read between frames with x forward, y left and z up",
            Self::BodyDepth => "if read from a depth frame with x forward, y left and z up",
            Self::BodyColour => "if read to a colour frame with x forward, y left and z up",
            Self::Millimetres => "if read with its translation in millimetres",
            Self::Metres => "if read with its translation in metres instead of millimetres",
            Self::Radians => "if read with its angles in radians instead of degrees",
            Self::Degrees => "if read with its angles in degrees instead of radians",
            Self::Registered => "if read as the identity, the depth map being registered to the colour image",
            Self::QuarterTurn => "if read for a colour image rotated by 90 degrees clockwise",
            Self::HalfTurn => "if read for a colour image rotated by 180 degrees",
            Self::QuarterBack => "if read for a colour image rotated by 90 degrees counter-clockwise",
            Self::ImageMirrored => "once the colour image is mirrored left to right",
            Self::ImageQuarterTurn => "once the colour image is rotated by 90 degrees counter-clockwise",
            Self::ImageHalfTurn => "once the colour image is rotated by 180 degrees",
            Self::ImageQuarterBack => "once the colour image is rotated by 90 degrees clockwise",
            Self::ImageResized => "once the colour camera's intrinsics are scaled to the width of the image",
            Self::ImageCropped => "once the colour camera's intrinsics are scaled to the height of the image",
            Self::DepthMirrored => "once the depth map is mirrored left to right",
            Self::DepthQuarterTurn => "once the depth map is rotated by 90 degrees counter-clockwise",
            Self::DepthHalfTurn => "once the depth map is rotated by 180 degrees",
            Self::DepthQuarterBack => "once the depth map is rotated by 90 degrees clockwise",
            Self::DepthResized => "once the depth camera's intrinsics are scaled to the width of the depth map",
            Self::DepthCropped => "once the depth camera's intrinsics are scaled to the height of the depth map",
            Self::RayLength => "once depths are read as distances along the rays instead of z",
            Self::DepthMillimetres => "once depths are read as millimetres",
            Self::DepthMetres => "once depths are read as metres",
        })
    }
}

/// The poses whose rotation vectors, in degrees, are read as radians as this pose. A rotation vector of radians does not show
/// whole turns, so each number of turns gives another pose.
fn in_degrees(pose: &Similarity) -> Vec<Similarity> {
    /// Largest number of whole turns: vectors of up to 28 degrees, more than between the cameras of a common rig.
    const TURNS: i8 = 4;
    let turn = rotation_vector(&pose.rotation);
    let Some(axis) = turn.try_normalize(1e-9) else { return vec![] };
    let pose_of = |turns: i8| {
        let degrees = turn.norm() + f64::from(turns) * std::f64::consts::TAU;
        Similarity { rotation: Rotation3::new(axis * degrees.to_radians()).into_inner(), ..*pose }
    };
    (-TURNS..=TURNS).map(pose_of).collect()
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
            (Reading::Metres, read(rotation, translation / 1000.0)),
            (Reading::Radians, read(Rotation3::new(turn.map(f64::to_radians)).into_inner(), translation)),
            (Reading::QuarterTurn, about_axis(-90.0).after(&truth)),
            (Reading::HalfTurn, about_axis(180.0).after(&truth)),
            (Reading::QuarterBack, about_axis(90.0).after(&truth)),
        ];
        for (reading, mistake) in mistakes {
            let [found] = reading.of(&mistake)[..] else { panic!("{reading:?} has several poses") };
            assert!((found.rotation - truth.rotation).norm() < 1e-9, "{reading:?}: {}", found.rotation);
            assert!((found.translation - truth.translation).norm() < 1e-9, "{reading:?}: {}", found.translation);
        }
        assert_eq!(OPTICAL_OF_BODY * Vector3::x(), Vector3::z());
        assert_eq!(OPTICAL_OF_BODY * Vector3::y(), -Vector3::x());
        assert_eq!(OPTICAL_OF_BODY * Vector3::z(), -Vector3::y());
        assert!((about_axis(90.0).apply(Vector3::x()) - Vector3::y()).norm() < 1e-12);
        // Registered needs no mistake, and angles in degrees have a separate test.
        assert_eq!(mistakes.len() + 2, Reading::POSES.len());
    }

    #[test]
    fn degrees_read_as_radians_are_found_whatever_the_number_of_turns() {
        let translation = Vector3::new(0.05, -0.02, 0.01);
        for degrees in [Vector3::new(0.4, -1.0, 0.3), Vector3::new(2.0, 3.5, -1.0), Vector3::new(-12.0, 15.0, 4.0)] {
            let pose = |vector| Similarity { scale: 1.0, rotation: Rotation3::new(vector).into_inner(), translation };
            let truth = pose(degrees.map(f64::to_radians));
            let found = Reading::Degrees.of(&pose(degrees));
            let nearest = found.iter().map(|found| (found.rotation - truth.rotation).norm()).fold(f64::MAX, f64::min);
            assert!(nearest < 1e-9, "{degrees}: {nearest}");
            assert!(found.iter().all(|found| found.translation == translation));
        }
    }
}
