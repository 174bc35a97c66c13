//! Which way a pose leads, and whether it relates two sensors, by the names of its frames.

use crate::text::NamedPose;
use crate::text::names::{Pattern, pattern};

static COLOUR: Pattern = Pattern::new(|| pattern("(?i)colou?r|rgb"));
static DEPTH: Pattern = Pattern::new(|| pattern(r"(?i)depth|infra|(?:^|[_/ ])ir(?:[_/ \d]|$)|tof"));
static LIDAR: Pattern =
    Pattern::new(|| pattern("(?i)velodyne|lidar|laser|ouster|livox|hesai|pandar|rslidar|robosense"));
static CAMERA: Pattern = Pattern::new(|| pattern("(?i)cam"));

/// Frames of no camera and no LiDAR: the inertial unit, the body, a vehicle, a robot and its hand, and the target of a
/// calibration.
static CARRIER: Pattern = Pattern::new(|| {
    pattern(concat!(
        r"(?i)^(?:b|body|i|imu\w*|base(?:[_ ]?(?:link|footprint))?|rig|vehicle|ego(?:[_ ]?vehicle)?|car|robot\w*|",
        r"hand|gripper|flange|tool\d*|\w+_(?:hand|gripper|flange|tool\d*)|gps|ins|oxts|",
        r"(?:april|aru|charu)\w*|tag\w*|marker\w*|(?:chess|checker|calib\w*)?_?board|target|pattern|object|table)$"
    ))
});

fn ends(pose: &NamedPose) -> [&str; 2] {
    [&pose.names.from, &pose.names.to].map(|name| name.as_deref().unwrap_or(""))
}

fn is_colour(name: &str) -> bool {
    COLOUR.is_match(name) && !DEPTH.is_match(name)
}

fn is_depth(name: &str) -> bool {
    DEPTH.is_match(name) && !COLOUR.is_match(name)
}

fn is_lidar(name: &str) -> bool {
    LIDAR.is_match(name) && !CAMERA.is_match(name)
}

/// Whether a pose leads away from the colour camera, or into the depth camera or a LiDAR.
pub fn is_backwards(pose: &NamedPose) -> bool {
    let [from, to] = ends(pose);
    if is_colour(from) {
        return !is_colour(to);
    }
    if is_depth(to) {
        return !is_depth(from) && !is_lidar(from);
    }
    is_lidar(to) && !from.is_empty() && !is_lidar(from) && !is_depth(from)
}

/// Whether a pose relates a sensor to its carrier or its target, so that it does not relate two sensors.
pub fn is_of_carrier(pose: &NamedPose) -> bool {
    ends(pose).into_iter().any(|name| CARRIER.is_match(name))
}

#[cfg(test)]
mod tests {
    use bimodal_stereo::Similarity;

    use super::*;
    use crate::text::Names;

    fn pose(from: &str, to: &str) -> NamedPose {
        NamedPose { names: Names::between(None, from, to), pose: Similarity::identity() }
    }

    #[test]
    fn poses_from_colour_and_into_depth_or_a_lidar_are_backwards() {
        for (from, to) in [("color", "depth"), ("rgb", "left"), ("cam0", "depth"), ("camera", "lidar")] {
            assert!(is_backwards(&pose(from, to)), "{from} to {to}");
            assert!(!is_backwards(&pose(to, from)), "{to} to {from}");
        }
    }

    #[test]
    fn carriers_and_targets_are_no_sensors() {
        for name in ["base_link", "imu0", "tool0", "apriltag_3", "checkerboard", "panda_hand"] {
            assert!(is_of_carrier(&pose("camera", name)), "{name}");
        }
        for name in ["velodyne", "depth", "left", "cam1"] {
            assert!(!is_of_carrier(&pose("camera", name)), "{name}");
        }
    }
}
