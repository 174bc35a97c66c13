//! Accuracy of a calibration in pixels.

/// Expected reprojection error, pixels of the colour image, and its 95 % interval.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Health {
    /// Root mean square error.
    pub pixels: f64,
    /// Lower and upper end of the interval.
    pub interval: [f64; 2],
}
