//! Whether the depth map shows a hollow, or its depths grow towards the camera: mirrored, it has another pose that is as good.

use crate::reason::Reason;
use crate::view::{DepthView, is_hollow};

/// Of a depth map most of whose occluding contours face inward.
pub fn hollow(depth: &DepthView) -> Option<Reason> {
    is_hollow(depth.size, &depth.points.z, &depth.normals).then_some(Reason::Hollow)
}
