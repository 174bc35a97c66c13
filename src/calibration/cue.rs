//! The cues of a check.

/// A property of the frames that constrains the calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Cue {
    /// Colours within a patch follow the normals.
    Shading,
    /// Depth edges lie on image edges.
    Edges,
    /// Mutual information of colours and patches is large.
    Information,
    /// The masked object lies on the image's mask.
    Silhouette,
}

impl Cue {
    /// All cues.
    pub const ALL: [Self; 4] = [Self::Shading, Self::Edges, Self::Information, Self::Silhouette];

    /// Name of the cue.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Shading => "shading",
            Self::Edges => "edges",
            Self::Information => "information",
            Self::Silhouette => "silhouette",
        }
    }
}
