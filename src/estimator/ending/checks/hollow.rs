//! Detects a hollow depth map or depths that grow towards the camera. Mirrored, such a map has another pose that fits
//! as well.

use crate::reason::Reason;
use crate::view::{DepthView, is_hollow};

/// The reason to cap a verdict if most occluding contours of the depth map face inward.
pub fn hollow(depth: &DepthView) -> Option<Reason> {
    is_hollow(depth.size, &depth.points.z, &depth.normals).then_some(Reason::Hollow)
}
