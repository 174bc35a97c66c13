//! The reason for each verdict, and warnings about the input. Both are values with numbers and become sentences where
//! they leave the crate.

use std::fmt;

use super::health::Health;
use super::readings::Reading;
use crate::pose::{Axis, Unknown};
use crate::text::{Brief, Fixed};

/// The reason for a verdict. Its [`code`](CheckReason::code) is stable; its [`Display`](fmt::Display) is the sentence for
/// people.
#[derive(Clone, Debug, PartialEq, strum::IntoStaticStr, strum::VariantNames)]
#[strum(serialize_all = "kebab-case")]
#[non_exhaustive]
pub enum CheckReason {
    /// Consistent: all of the interval lies within the tolerance.
    WithinTolerance(Margin),
    /// Consistent: nothing contradicts the candidate, and the scene would show errors above `shown` pixels.
    NothingAgainst {
        /// Error of the candidate.
        margin: Margin,
        /// Errors above this many pixels would show.
        shown: f64,
    },
    /// Off: all of the interval lies beyond the tolerance.
    OffTarget {
        /// Error of the candidate.
        margin: Margin,
        /// Difference from the estimate.
        offset: Offset,
    },
    /// Off: the candidate fits if it is read in another convention.
    Misread {
        /// The convention in which the candidate fits.
        reading: Reading,
        /// Error of the candidate in that convention.
        margin: Margin,
    },
    /// Off: the candidate puts no points onto the image.
    NoPointsOnImage,
    /// Undecided: poses that fit about as well contradict each other on the candidate.
    BetweenOptima(Margin),
    /// Undecided: a guessed colour camera can explain the error.
    GuessedCamera {
        /// Error of the candidate.
        margin: Margin,
        /// Largest error that the guess can explain, pixels.
        explained: f64,
    },
    /// Undecided: the scene hardly constrains one of the six parameters of the pose.
    Unconstrained {
        /// Error of the candidate.
        margin: Margin,
        /// The parameter.
        weakest: Unknown,
    },
    /// Undecided: the interval holds errors within the tolerance and errors beyond it.
    TooClose(Margin),
    /// Off: the candidate puts no points onto the image, and the best fit too few to rely on.
    NoPoseOnImage,
    /// Undecided: the estimate puts few of the depth points onto the image.
    LittleOverlap {
        /// Share of the depth points on the image, percent.
        percent: f64,
    },
    /// Undecided: no cue finds anything to compare.
    NoEvidence,
    /// Undecided: no candidate was given.
    NoCandidate {
        /// Error of the estimate.
        pixels: f64,
    },
    /// Consistent, but with a warning about the input.
    Doubtful {
        /// The first warning.
        warning: Box<Warning>,
        /// The reason for the verdict without the warning.
        reason: Box<CheckReason>,
    },
}

/// A reprojection error and the tolerance, pixels of the colour image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Margin {
    /// The error.
    pub health: Health,
    /// The largest error that passes.
    pub tolerance: f64,
}

/// Difference between a candidate and the estimate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Offset {
    /// Angle of the rotation.
    pub degrees: f64,
    /// The axis with the largest part of the rotation.
    pub about: Axis,
    /// Shift of the centre of the scene.
    pub millimetres: f64,
    /// The axis with the largest part of the shift.
    pub along: Axis,
    /// Distance of the centre of the scene, metres.
    pub distance: f64,
}

impl CheckReason {
    /// The codes of all reasons.
    pub const CODES: &'static [&'static str] = <Self as strum::VariantNames>::VARIANTS;

    /// Stable name for programs.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.into()
    }
}

impl fmt::Display for CheckReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::WithinTolerance(margin) => write!(f, "Its error is {margin}; {}.", margin.limit()),
            Self::NothingAgainst { margin, shown } => write!(
                f,
                "Nothing contradicts it, and an error above {} px would show. Its error is {margin}; the interval ends above \
                 the limit of {} px because the estimate is uncertain, too.",
                Fixed(*shown, 1),
                Fixed(margin.tolerance, 1)
            ),
            Self::OffTarget { margin, offset } => write!(f, "Off by about {offset}: {margin}; {}.", margin.limit()),
            Self::Misread { reading, margin } => {
                write!(
                    f,
                    "Off as given, but it fits far better {reading}: its error is then {margin}; {}.",
                    margin.limit()
                )
            }
            Self::NoPointsOnImage | Self::NoPoseOnImage => {
                f.write_str("Off, or read in a wrong convention: it puts no points onto the image.")
            }
            Self::BetweenOptima(margin) => write!(
                f,
                "Its error relative to the best fit is {margin}, but another pose fits about as well and leads to a different verdict."
            ),
            Self::GuessedCamera { margin, explained } => write!(
                f,
                "Its error is {margin}; the guessed colour camera alone can explain up to {} px.",
                Fixed(*explained, 0)
            ),
            Self::Unconstrained { margin, weakest } => write!(
                f,
                "This scene hardly constrains {weakest}, so the error is too uncertain to decide: {margin}; {}.",
                margin.limit()
            ),
            Self::TooClose(margin) => {
                write!(f, "Its error is too uncertain to decide: {margin}; {}.", margin.limit())
            }
            Self::LittleOverlap { percent } => {
                write!(f, "The best fit puts only {} % of the depth points onto the image.", Fixed(*percent, 0))
            }
            Self::NoEvidence => f.write_str("None of the chosen cues finds anything to compare."),
            Self::NoCandidate { pixels } => {
                write!(f, "No candidate was given; the estimate is good to {} px.", Fixed(*pixels, 1))
            }
            Self::Doubtful { warning, reason } => {
                write!(f, "It would be consistent without this warning: {warning} {reason}")
            }
        }
    }
}

impl Margin {
    fn limit(&self) -> impl fmt::Display {
        format!("the limit is {} px", Fixed(self.tolerance, 1))
    }
}

impl fmt::Display for Margin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [low, high] = self.health.interval.map(|value| Fixed(value, 1));
        write!(f, "{} px at the scene's depth (95 %: {low} to {high})", Fixed(self.health.pixels, 1))
    }
}

impl fmt::Display for Offset {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { degrees, about, millimetres, along, distance } = *self;
        // A rotation about a camera moves the scene in proportion to its distance.
        write!(
            f,
            "{} degrees (mostly about {about}) and {} mm (mostly along {along}) at the centre of the scene, {} m away",
            Fixed(degrees, 2),
            Fixed(millimetres, 1),
            Fixed(distance, 2)
        )
    }
}

/// A warning about the input. It caps the verdict: no candidate is consistent if the input may have been misread.
#[derive(Clone, Debug, PartialEq)]
pub struct Warning {
    /// The frame or the candidate at fault; empty if all frames are.
    pub name: String,
    /// Path of the member at fault in the JavaScript contract.
    pub field: String,
    /// The kind of warning.
    pub kind: WarningKind,
}

/// The kind of a warning. Its [`code`](WarningKind::code) is stable; the [`Display`](fmt::Display) of a [`Warning`] is
/// the sentence for people.
#[derive(Clone, Copy, Debug, PartialEq, strum::IntoStaticStr, strum::VariantNames)]
#[strum(serialize_all = "kebab-case")]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize),
    serde(tag = "code", rename_all = "kebab-case", rename_all_fields = "camelCase")
)]
#[non_exhaustive]
pub enum WarningKind {
    /// The image is blank.
    BlankImage,
    /// The intrinsics of the colour camera are missing.
    IntrinsicsGuessed,
    /// Many depths of a depth map without a mask are missing.
    ManyHoles {
        /// Share of the pixels.
        percent: f64,
    },
    /// No level of an integer depth map exceeds 255.
    EightBits,
    /// The median depth is outside the range of depth cameras.
    UnusualDepths {
        /// The median depth.
        metres: f64,
        /// The range of usual depths.
        usual: [f64; 2],
    },
    /// The depth map is as rough as a photograph.
    RoughDepth,
    /// The cameras are farther apart than those of any rig.
    FarApart {
        /// Distance between the cameras, metres.
        metres: f64,
    },
    /// The inverse of the candidate fits.
    FitsInverted {
        /// Expected error of the candidate, pixels.
        pixels: f64,
        /// Expected error of its inverse, pixels.
        inverted_pixels: f64,
    },
    /// The distortion of the colour camera was probably left out.
    LensLeftOut {
        /// The first radial coefficient.
        k1: f64,
    },
}

impl Warning {
    pub(super) fn of_candidate(name: &str, kind: WarningKind) -> Self {
        Self { name: name.to_owned(), field: format!("candidates.{name}"), kind }
    }
}

impl WarningKind {
    /// The codes of all warnings.
    pub const CODES: &'static [&'static str] = <Self as strum::VariantNames>::VARIANTS;

    /// Stable name for programs.
    #[must_use]
    pub fn code(&self) -> &'static str {
        self.into()
    }
}

/// Limits of the median depth, metres. Above the first the unit is probably the millimetre, and below the second it is
/// probably a thousand times too small.
const MILLIMETRES: f64 = 100.0;
const KILOMETRES: f64 = 0.02;

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if !self.name.is_empty() {
            write!(f, "{}: ", self.name)?;
        }
        match self.kind {
            WarningKind::BlankImage => f.write_str("the image is blank."),
            WarningKind::IntrinsicsGuessed => {
                f.write_str("the colour camera's intrinsics are not given; its focal length is estimated.")
            }
            WarningKind::ManyHoles { percent } => write!(f, "{} % of the depth map is missing.", Fixed(percent, 0)),
            WarningKind::EightBits => f.write_str("the depth map has 8 bits, too coarse for a calibration."),
            WarningKind::UnusualDepths { metres, usual } => {
                let [nearest, farthest] = usual.map(Brief);
                write!(f, "depths are {} m at the median, outside {nearest} to {farthest} m", Brief(metres))?;
                if metres > MILLIMETRES {
                    f.write_str(": are they in millimetres?")
                } else if metres < KILOMETRES {
                    f.write_str(": is its unit a thousand times larger?")
                } else {
                    Ok(())
                }
            }
            WarningKind::RoughDepth => f.write_str("the depth map is as rough as a photograph; are the files swapped?"),
            WarningKind::FarApart { metres } => {
                write!(f, "its cameras are {} m apart; is the translation in millimetres?", Fixed(metres, 1))
            }
            WarningKind::FitsInverted { pixels, inverted_pixels } => write!(
                f,
                "fits inverted ({} px instead of {}): it seems to map colour to depth, P_depth = R P_colour + t; invert it.",
                Fixed(inverted_pixels, 1),
                Fixed(pixels, 1)
            ),
            WarningKind::LensLeftOut { k1 } => write!(
                f,
                "Depth edges fit the image's clearly better behind a lens of k1 about {}: was its distortion left out?",
                Fixed(k1, 2)
            ),
        }
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Warning {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(serde::Serialize)]
        struct Explained<'a> {
            #[serde(flatten)]
            kind: WarningKind,
            message: String,
            field: &'a str,
        }
        Explained { kind: self.kind, message: self.to_string(), field: &self.field }.serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_names_what_it_is_about() {
        let kind = WarningKind::ManyHoles { percent: 43.2 };
        let warning = Warning { name: "frame 1".into(), field: "frames[0].depth".into(), kind };
        assert_eq!(
            (warning.kind.code(), warning.to_string().as_str()),
            ("many-holes", "frame 1: 43 % of the depth map is missing.")
        );
        let doubtful =
            CheckReason::Doubtful { warning: Box::new(warning), reason: Box::new(CheckReason::NoPoseOnImage) };
        assert_eq!(doubtful.code(), "doubtful");
        assert!(
            doubtful.to_string().starts_with("It would be consistent without this warning: frame 1: "),
            "{doubtful}"
        );
    }

    #[test]
    fn an_interval_that_ends_above_the_limit_is_explained() {
        let margin = Margin { health: Health { pixels: 2.7, interval: [1.0, 4.8] }, tolerance: 3.5 };
        let reason = CheckReason::NothingAgainst { margin, shown: 3.1 };
        assert_eq!(
            reason.to_string(),
            "Nothing contradicts it, and an error above 3.1 px would show. Its error is 2.7 px at the scene's depth (95 %: \
             1.0 to 4.8); the interval ends above the limit of 3.5 px because the estimate is uncertain, too."
        );
    }

    #[cfg(feature = "serde")]
    #[test]
    fn a_warning_leaves_with_its_code_words_field_and_numbers() {
        let kind = WarningKind::FitsInverted { pixels: 30.0, inverted_pixels: 0.5 };
        let warning = Warning { name: "mine".into(), field: "candidates.mine".into(), kind };
        let expected = serde_json::json!({
            "code": "fits-inverted", "pixels": 30.0, "invertedPixels": 0.5,
            "message": warning.to_string(), "field": "candidates.mine",
        });
        assert_eq!(serde_json::to_value(&warning).unwrap(), expected);
    }
}
