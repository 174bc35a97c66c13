//! What a check looks at.

/// What of a frame bears on the calibration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Cue {
    /// Colours within patches follow their normals.
    Shading,
    /// Depth edges on image edges.
    Edges,
    /// Mutual information of colours and patches.
    Information,
    /// The masked object on the image's mask.
    Silhouette,
}

impl Cue {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Shading, Self::Edges, Self::Information, Self::Silhouette];

    /// Its name.
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
