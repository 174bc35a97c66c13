//! What the finder decides: a pose, and which measurement it rests on.

use crate::pose::{ContrastReport, OutlineReport, PhotometricReport, Similarity};
use crate::reason::FoundBy;

/// The answer.
pub struct Decision {
    pub by: Method,
    /// Other poses that fit as well, best first; none where they were not looked for.
    pub rivals: Option<Vec<Similarity>>,
}

/// What the pose rests on.
pub enum Method {
    /// A single albedo explains the image.
    Image(Box<PhotometricReport>),
    /// The albedo varies: local contrast ..
    Contrast(Box<ContrastReport>),
    /// .. or silhouettes.
    Silhouettes(Box<OutlineReport>),
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
    /// As a reason names it.
    pub const fn found_by(&self) -> FoundBy {
        match self {
            Self::Silhouettes(_) => FoundBy::Silhouettes,
            Self::Contrast(_) => FoundBy::Contrast,
            Self::Image(_) | Self::Initial(_) | Self::Nothing => FoundBy::Image,
        }
    }
}

impl Decision {
    pub const fn of(by: Method) -> Self {
        Self { by, rivals: None }
    }
}
