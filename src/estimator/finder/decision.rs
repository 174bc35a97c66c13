//! The finder's decision: a pose, and the method that it rests on.

use crate::pose::{ContrastReport, PhotometricReport, SilhouetteReport, Similarity};
use crate::reason::FoundBy;

/// The decision.
pub struct Decision {
    pub by: Method,
    /// Other poses that fit equally well, best first; `None` if none were looked for.
    pub rivals: Option<Vec<Similarity>>,
}

/// The result that determines the pose.
pub enum Method {
    /// A single albedo explains the image.
    Photometric(Box<PhotometricReport>),
    /// The albedo varies: the pose is from local contrast.
    Contrast(Box<ContrastReport>),
    /// The albedo varies: the pose is from silhouettes.
    Silhouettes(Box<SilhouetteReport>),
    /// No pose near the initial one fits the image better, so that one is kept.
    Initial(Staying),
    /// Nothing could be registered.
    Nothing,
}

/// Whether an initial pose that is kept may be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Staying {
    /// The shading under it explains part of the image.
    Explains,
    /// The shading explains nothing, or the object is as small as a few pixels.
    ExplainsNothing,
}

impl Method {
    /// The name of the method in a reason.
    pub const fn found_by(&self) -> FoundBy {
        match self {
            Self::Silhouettes(_) => FoundBy::Silhouettes,
            Self::Contrast(_) => FoundBy::Contrast,
            Self::Photometric(_) | Self::Initial(_) | Self::Nothing => FoundBy::Image,
        }
    }
}

impl Decision {
    pub const fn of(by: Method) -> Self {
        Self { by, rivals: None }
    }

    /// The pose, if it was registered.
    pub const fn pose(&self) -> Option<&Similarity> {
        match &self.by {
            Method::Photometric(found) => Some(&found.pose),
            Method::Contrast(found) => Some(&found.pose),
            Method::Silhouettes(found) => Some(&found.pose),
            Method::Initial(_) | Method::Nothing => None,
        }
    }
}
