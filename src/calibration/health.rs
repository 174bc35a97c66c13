//! How good a calibration is, in pixels.

/// Expected reprojection error, pixels of the colour image, and its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Health {
    /// Root mean square.
    pub pixels: f64,
    /// From, to.
    pub interval: [f64; 2],
}
