//! The reason for a run's status: a value with its numbers, turned into words only on output.

use std::fmt;

use crate::error::Error;
use crate::pose::Direction;
use crate::text::{Brief, Fixed};

/// Why a run ended, why its answer cannot be trusted, or the outcome of the last step of a run that continues.
///
/// Its [`code`](Reason::code) is stable; its [`Display`](fmt::Display) is the message for people, and may change.
#[derive(Clone, Debug, PartialEq, strum::IntoStaticStr, strum::VariantNames)]
#[strum(serialize_all = "kebab-case")]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(tag = "code", rename_all = "kebab-case", rename_all_fields = "camelCase")
)]
#[non_exhaustive]
pub enum Reason {
    /// The search over all poses is running.
    Searching {
        /// Share of its work done, 0 .. 100.
        percent: f64,
        /// The current activity.
        activity: Activity,
    },
    /// The search is over.
    SearchDone {
        /// The method that found the pose.
        by: FoundBy,
        /// Number of other poses that fit the image equally well.
        rivals: u32,
    },
    /// The last iteration was rejected.
    TakenBack {
        /// The objective before it.
        before: f64,
        /// The objective that it would have left.
        after: f64,
    },
    /// The registration of the last iteration found no better pose.
    PoseStays,

    /// With a fixed pose, another iteration would worsen the shapes.
    ShapesStay,
    /// Successive iterations found no better pose.
    NoBetterPose {
        /// Number of those iterations.
        iterations: u32,
    },
    /// The maximum number of iterations was reached.
    IterationCap {
        /// The cap.
        iterations: u32,
    },

    /// Too few depth pixels have a counterpart in the image.
    LittleOverlap {
        /// Share of the valid depth pixels that have one.
        percent: f64,
    },
    /// No pose within the tolerance of the initial one fits the image better.
    InitialPoseKept,
    /// A rotation has practically no effect on the image.
    NotObservable {
        /// The least certain direction.
        weakest: Direction,
    },
    /// The rotation is less certain than required.
    RotationUncertain {
        /// Sigma about the least certain axis.
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::finite"))]
        sigma_degrees: f64,
        /// The least certain direction.
        weakest: Direction,
    },
    /// A single albedo does not fit the image; the pose is from silhouettes, which leave its rotation uncertain.
    AlbedoVaries {
        /// Sigma about the least certain axis.
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::finite"))]
        sigma_degrees: f64,
        /// The least certain direction.
        weakest: Direction,
    },
    /// As [`AlbedoVaries`](Self::AlbedoVaries), but the silhouettes do not constrain one direction at all, in which the
    /// pose keeps its initial value.
    SilhouetteBlind {
        /// The direction that keeps its initial value.
        weakest: Direction,
    },
    /// A single albedo does not fit the image, and local contrast and silhouette do not fit the pose.
    ContrastUnexplained {
        /// The objective of both: 0 if they fit perfectly, about 100 if shading explains none of the contrast.
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::finite"))]
        percent: f64,
    },
    /// Light and normals fit too little of the image.
    Unexplained {
        /// Unexplained share of the spread of the log image.
        #[cfg_attr(feature = "serde", serde(serialize_with = "crate::serial::finite"))]
        percent: f64,
    },
    /// Too few points agree with the pose.
    FewInliers {
        /// Share of the points that agree.
        percent: f64,
    },
    /// The depth map is hollow, or its depths grow towards the camera.
    Hollow,
    /// Other poses fit the image equally well.
    Rivals {
        /// Number of those poses.
        count: u32,
        /// Rotation to the nearest one.
        nearest_degrees: f64,
    },
    /// Trimming removed much of a depth map without a mask.
    MissingDepthMask {
        /// Removed share of the depths.
        percent: f64,
    },
    /// The search used a whole frame without a mask.
    MissingImageMask,
    /// The relief fits the image better in another unit.
    OtherUnit {
        /// The factor by which it would be deeper.
        times: f64,
    },

    /// The search found no pose that fits the image.
    NoPose {
        /// Whether the scale was held; otherwise it was searched around the ratio of the units.
        scale_is_held: bool,
    },
    /// The image pulls the apparent size of the object too far from that of the initial pose.
    SizeRunsAway {
        /// The factor between the two sizes.
        times: f64,
    },
    /// The pose puts the object behind the colour camera.
    BehindCamera,
    /// A stage of the loop failed.
    StageFailed {
        /// The error of the stage.
        error: Error,
    },
}

/// The current activity of the search.
#[derive(Clone, Copy, Debug, PartialEq, Eq, strum::IntoStaticStr, strum::VariantNames)]
#[strum(serialize_all = "kebab-case")]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Activity {
    /// Preparing the views.
    Preparing,
    /// Comparing rotations, translations and scales.
    Comparing,
    /// Registering the best candidates.
    Registering,
    /// Comparing local contrast, because a single albedo does not fit the image.
    ComparingContrast,
    /// Comparing silhouettes, because a single albedo does not fit the image.
    ComparingSilhouettes,
}

/// The method that found a pose.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum FoundBy {
    /// The image, under a single albedo.
    Image,
    /// Local contrast.
    Contrast,
    /// Silhouettes.
    Silhouettes,
}

impl Reason {
    /// The codes of all reasons.
    pub const CODES: &'static [&'static str] = <Self as strum::VariantNames>::VARIANTS;

    /// Stable name for programs.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.into()
    }
}

impl From<Error> for Reason {
    fn from(error: Error) -> Self {
        Self::StageFailed { error }
    }
}

/// Smallest sigma, degrees, for which a decimal is meaningless.
const COARSE: f64 = 5.0;
/// Beginning of the message for every pose from silhouettes.
const BY_SILHOUETTES: &str = "pose from silhouettes, because a single albedo does not fit the image";

impl fmt::Display for Reason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let whole = |value: f64| Fixed(value, 0);
        match self {
            Self::Searching { percent, activity } => write!(f, "{} %: {activity}", whole(*percent)),
            Self::SearchDone { by, rivals } => write_found(f, *by, *rivals),
            Self::TakenBack { before, after } => write!(
                f,
                "iteration rejected: the objective would have risen from {} to {}; the next one takes half the step",
                Fixed(*before, 4),
                Fixed(*after, 4)
            ),
            Self::PoseStays => f.write_str("the registration found no better pose"),
            Self::ShapesStay => f.write_str("another iteration would worsen the shapes under this pose"),
            Self::NoBetterPose { iterations } => write!(f, "{iterations} iterations in a row found no better pose"),
            Self::IterationCap { iterations } => write!(f, "the limit of {iterations} iterations was reached"),
            Self::LittleOverlap { percent } => {
                write!(f, "only {} % of the depth pixels have a counterpart in the image", Fixed(*percent, 1))
            }
            Self::InitialPoseKept => f.write_str(
                "no pose within the tolerance fits the image better than the initial pose, which was kept",
            ),
            Self::NotObservable { weakest } => {
                write!(f, "{weakest} is not observable: within the noise, changing it changes nothing in the image")
            }
            Self::RotationUncertain { sigma_degrees, weakest } => {
                let sigma = Fixed(*sigma_degrees, u32::from(*sigma_degrees < COARSE));
                write!(f, "the rotation is uncertain by {sigma} degrees (one sigma): {weakest}")
            }
            Self::AlbedoVaries { sigma_degrees, weakest } => {
                let sigma = Fixed(*sigma_degrees, 1);
                write!(f, "{BY_SILHOUETTES}; the rotation is uncertain by {sigma} degrees (one sigma): {weakest}")
            }
            Self::SilhouetteBlind { weakest } => {
                write!(f, "{BY_SILHOUETTES}; they do not constrain {weakest}: its initial value was kept")
            }
            Self::ContrastUnexplained { percent } => write!(
                f,
                "a single albedo does not fit the image, and local contrast and silhouette do not fit the pose (objective {} %)",
                whole(*percent)
            ),
            Self::Unexplained { percent } => {
                write!(f, "light and normals leave {} % of the spread of the colours unexplained", whole(*percent))
            }
            Self::FewInliers { percent } => write!(f, "only {} % of the points agree with the pose", whole(*percent)),
            Self::Hollow => f.write_str(
                "surface normals at the depth map's silhouette face inward: the object is concave, or the depth is \
                 inverted; mirrored in depth it fits the image equally well",
            ),
            Self::Rivals { count, nearest_degrees } => {
                write_rivals(f, *count)?;
                let nearest = whole(*nearest_degrees);
                if *count == 1 { write!(f, ", {nearest} degrees away") } else { write!(f, ", the nearest {nearest} degrees away") }
            }
            Self::MissingDepthMask { percent } => write!(
                f,
                "{} % of the depths were left out as background, which is a guess: set a mask of the depth map",
                whole(*percent)
            ),
            Self::MissingImageMask => f.write_str("the object is not segmented in the image: set a mask of the image"),
            Self::OtherUnit { times } => {
                let times = Fixed(*times, if *times < 1.0 { 2 } else { 1 });
                write!(f, "relief about {times} times as deep fits the image better: check the unit of the depths")
            }
            Self::NoPose { scale_is_held: true } => {
                f.write_str("no pose fits the image with the depth map's normals")
            }
            Self::NoPose { scale_is_held: false } => f.write_str(
                "no pose fits the image with the depth map's normals at 0.7 to 1.4 times the scale that the units give; \
                 set another scale",
            ),
            Self::SizeRunsAway { times } => write!(
                f,
                "the apparent size that fits the image differs from that of the initial pose by a factor of more than two (got {})",
                Brief(*times)
            ),
            Self::BehindCamera => f.write_str("the pose puts the object behind the colour camera"),
            Self::StageFailed { error } => error.fmt(f),
        }
    }
}

fn write_found(f: &mut fmt::Formatter<'_>, by: FoundBy, rivals: u32) -> fmt::Result {
    f.write_str("100 %: ")?;
    match (rivals, by) {
        (0, FoundBy::Image) => f.write_str("one pose fits the image best"),
        (0, FoundBy::Contrast) => {
            f.write_str("a single albedo does not fit the image; local contrast determines the pose")
        }
        (0, FoundBy::Silhouettes) => {
            f.write_str("a single albedo does not fit the image; silhouettes determine the pose")
        }
        (count, _) => write_rivals(f, count),
    }
}

fn write_rivals(f: &mut fmt::Formatter<'_>, count: u32) -> fmt::Result {
    match count {
        1 => f.write_str("one other pose fits the image equally well"),
        count => write!(f, "{count} other poses fit the image equally well"),
    }
}

impl fmt::Display for Activity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Preparing => "preparing the search",
            Self::Comparing => "comparing rotations, translations and scales",
            Self::Registering => "registering the best candidates",
            Self::ComparingContrast => "comparing local contrast, because a single albedo does not fit the image",
            Self::ComparingSilhouettes => "comparing silhouettes, because a single albedo does not fit the image",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_are_names_for_programs() {
        assert_eq!(Reason::Rivals { count: 1, nearest_degrees: 9.0 }.code(), "rivals");
        assert_eq!(Reason::CODES.iter().filter(|code| **code == "albedo-varies").count(), 1);
        let is_name = |code: &str| code.chars().all(|letter| letter.is_ascii_lowercase() || letter == '-');
        assert!(Reason::CODES.iter().all(|code| is_name(code)), "{:?}", Reason::CODES);
    }

    #[test]
    fn one_rival_is_no_plural() {
        let words = |count| Reason::Rivals { count, nearest_degrees: 12.4 }.to_string();
        assert_eq!(words(1), "one other pose fits the image equally well, 12 degrees away");
        assert_eq!(words(2), "2 other poses fit the image equally well, the nearest 12 degrees away");
    }

    #[test]
    fn small_sigmas_have_a_decimal() {
        let words = |sigma_degrees| {
            let weakest = Direction::default();
            Reason::RotationUncertain { sigma_degrees, weakest }.to_string()
        };
        assert_eq!(words(1.62), "the rotation is uncertain by 1.6 degrees (one sigma): unknown");
        assert_eq!(words(6.2), "the rotation is uncertain by 6 degrees (one sigma): unknown");
    }

    #[cfg(feature = "serde")]
    #[test]
    fn a_reason_leaves_as_its_code_with_its_numbers() {
        let plain = |reason: Reason| serde_json::to_value(reason).unwrap();
        let rivals = Reason::Rivals { count: 2, nearest_degrees: 40.5 };
        assert_eq!(plain(rivals), serde_json::json!({ "code": "rivals", "count": 2, "nearestDegrees": 40.5 }));
        let uncertain = Reason::RotationUncertain { sigma_degrees: f64::NAN, weakest: Direction::default() };
        let expected = serde_json::json!({ "code": "rotation-uncertain", "sigmaDegrees": null, "weakest": "unknown" });
        assert_eq!(plain(uncertain), expected);
        for reason in [Reason::Hollow, Reason::PoseStays, Reason::NoBetterPose { iterations: 6 }] {
            assert_eq!(plain(reason.clone())["code"], reason.code());
        }
    }
}
