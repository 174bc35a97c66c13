//! The decision of the finder: a pose, and the method that it rests on. The registration stage keeps the decision and
//! brings it up to date, the verdict is based on it, and the report names the method.

use crate::pose::{PhotometricReport, SilhouetteReport, Similarity};
use crate::reason::FoundBy;

use super::contrasted::Contrasted;
use super::photometric;

/// The decision.
pub struct Decision {
    pub by: Method,
    /// Other poses that fit equally well, best first; `None` if none were looked for.
    pub rivals: Option<Vec<Similarity>>,
    /// Where registrations of the same optimum ended. Their spread adds to the sigmas of a photometric registration.
    pub ends: Vec<Similarity>,
    /// Whether local contrast chose the pose because the albedo varies, so that shading need not explain the colours.
    pub by_contrast: bool,
}

/// The method that the pose rests on, with its result.
pub enum Method {
    /// A single albedo explains the image: the last photometric registration.
    Photometric(Box<PhotometricReport>),
    /// The albedo varies: the pose is from local contrast.
    Contrast(Box<Contrasted>),
    /// The albedo varies: the pose is from silhouettes.
    Silhouettes(Box<SilhouetteReport>),
    /// No pose near the initial one fits the image better, so that one is kept.
    Initial(Staying),
}

/// Whether an initial pose that is kept may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Staying {
    /// The shading under it explains part of the image.
    Explains,
    /// The shading explains nothing, or the object is as small as a few pixels.
    ExplainsNothing,
}

impl Decision {
    pub const fn of(by: Method) -> Self {
        Self { by, rivals: None, ends: Vec::new(), by_contrast: false }
    }

    /// The pose, if it was registered.
    pub const fn pose(&self) -> Option<&Similarity> {
        match &self.by {
            Method::Photometric(found) => Some(&found.pose),
            Method::Contrast(found) => Some(&found.report.pose),
            Method::Silhouettes(found) => Some(&found.pose),
            Method::Initial(_) => None,
        }
    }

    /// The result of photometric registration, if the pose rests on it.
    pub const fn photometric(&self) -> Option<&PhotometricReport> {
        match &self.by {
            Method::Photometric(found) => Some(found),
            _ => None,
        }
    }
}

impl Method {
    /// The name of the method in a reason.
    pub const fn found_by(&self) -> FoundBy {
        match self {
            Self::Silhouettes(_) => FoundBy::Silhouettes,
            Self::Contrast(_) => FoundBy::Contrast,
            Self::Photometric(_) | Self::Initial(_) => FoundBy::Image,
        }
    }

    /// Whether it would leave `pose` unchanged, whatever the shapes become.
    pub fn keeps(&self, pose: &Similarity) -> bool {
        match self {
            Self::Photometric(found) => photometric::ended_in(found, pose),
            Self::Contrast(found) => found.stands(),
            Self::Silhouettes(_) | Self::Initial(_) => true,
        }
    }
}
