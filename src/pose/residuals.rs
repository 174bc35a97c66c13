//! Constants of residuals of log intensity that photometric registration and registration by local contrast share.

/// Smallest assumed noise of log S, log units, or 0.2 percent, the rounding of a good 8-bit image.
pub(super) const LEAST_NOISE: f64 = 0.002;
/// Error of a normal, radians, at which its point has lost three quarters of its weight. On average, errors shift the
/// pose in proportion to their square: 0.1 rad by some tenths of a degree under any light.
pub(super) const NORMAL_ERROR: f64 = 0.1;
/// First robust scale relative to that of the residuals, and the factor by which it shrinks at most from round to
/// round.
pub(super) const FIRST_SCALE: f64 = 2.0;
pub(super) const SHRINKING: f64 = 0.6;
/// Side of the object, pixels, for which the sizes of windows are stated: the square root of the number of its pixels
/// in the depth map. Windows grow with the object.
pub(super) const MEASURED_SIDE: f64 = 64.0;
