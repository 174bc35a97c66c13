//! What photometric registration and registration by local contrast expect of residuals of log intensity alike.

/// Noise of log S that is always allowed for, log units: half a percent, the rounding of a good 8-bit image.
pub(super) const LEAST_NOISE: f64 = 0.002;
/// Error of a normal, radians, at which its point has lost three quarters of its weight. Errors act in the mean by their
/// square: 0.1 rad shifts the pose by some tenths of a degree whatever the light.
pub(super) const NORMAL_ERROR: f64 = 0.1;
/// The first robust scale over that of the residuals, and the factor by which it shrinks from round to round, at most.
pub(super) const FIRST_SCALE: f64 = 2.0;
pub(super) const SHRINKING: f64 = 0.6;
/// Depth pixels of the object for which windows on the depth map are stated, root of their number; windows grow with the object.
pub(super) const MEASURED_SIDE: f64 = 64.0;
