//! The two frames of a motion P_to = R P_from + t, from the names of members and files.

use serde_json::{Map, Value};

use super::calibration::Names;
use super::names::{LONGEST, Pattern, member, pattern, text_of, words};
use super::numbers::matrix_of;

type Node = Map<String, Value>;

/// The frames named by an object.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Frames {
    pub from: Option<String>,
    pub to: Option<String>,
}

impl Frames {
    fn between(from: &str, to: &str) -> Self {
        Self { from: Some(from.into()), to: Some(to.into()) }
    }
}

/// Names of the source and the target frame of a motion.
const ENDS: [[&str; 2]; 10] = [
    ["from", "to"],
    ["fromframe", "toframe"],
    ["source", "target"],
    ["sourceframe", "targetframe"],
    ["child", "parent"],
    ["childlink", "parentlink"],
    ["sensor", "reference"],
    ["sensorframe", "referenceframe"],
    ["frame", "base"],
    ["sensorname", "targetsensorname"],
];

/// Whether an object has a rotation or a matrix of a motion.
fn is_transform(node: &Node) -> bool {
    let is_motion = |value| matrix_of(Some(value)).is_some_and(|matrix| matches!(matrix.values.len(), 12 | 16));
    member(node, &["rotation", "orientation", "quaternion"]).is_some() || node.values().any(is_motion)
}

/// The frames of a motion. ROS's transform carries points of the child frame into the parent, OpenCalib's from a sensor
/// to its target.
pub fn frames_of(node: &Node) -> Option<Frames> {
    let header = member(node, &["header"]).and_then(Value::as_object).unwrap_or(node);
    if let Some(child) = text_of(member(node, &["childframeid", "childframe"])) {
        return Some(Frames { from: Some(child), to: text_of(member(header, &["frameid", "parentframe"])) });
    }
    ENDS.iter().find_map(|[from, to]| {
        // Objects other than transforms have parents, too.
        if *from == "child" && !is_transform(node) {
            return None;
        }
        let ends = [text_of(member(node, &[from]))?, text_of(member(node, &[to]))?];
        (ends[0] != ends[1]).then(|| Frames::between(&ends[0], &ends[1]))
    })
}

/// The frames of names such as "camera_to_world", "cameraPose" and "matrix_world".
pub fn world_frames(name: &str) -> Option<Frames> {
    static TO_CAMERA: Pattern = Pattern::new(|| {
        pattern(
            r"\b(?:(?:world|w) ?(?:to|2) ?(?:camera|cam|c|view)|view matrix|(?:world|camera) view(?: transform)?)\b",
        )
    });
    static OF_WORLD: Pattern = Pattern::new(|| {
        pattern(
            r"\b(?:(?:camera|cam|c|local|object|view) ?(?:to|2) ?(?:world|w)|poses?|matrix world|location|camera transform)\b",
        )
    });
    static PLACED: Pattern = Pattern::new(|| pattern(r"\b(?:in|wrt|relative to|with respect to)\b"));
    let words = words(name).join(" ");
    // "depth_pose_in_color" names both frames.
    if PLACED.is_match(&words) {
        return None;
    }
    if TO_CAMERA.is_match(&words) {
        return Some(Frames::between("world", "camera"));
    }
    OF_WORLD.is_match(&words).then(|| Frames::between("camera", "world"))
}

/// The frames of a file whose name, or whose folder's name, says that it holds a pose of the camera in the world:
/// "pose.txt", "c2w/0.txt".
pub fn world_frames_of_file(path: &str) -> Option<Frames> {
    static PLACE: Pattern = Pattern::new(|| {
        pattern(
            r"(?i)^(?:(?:frame|image|img|rgb|colou?r|depth|camera|cam|gt|abs(?:olute)?)?[_.-]*\d*[_.-]*){0,3}poses?[_.-]*\d*$",
        )
    });
    static ENDING: Pattern = Pattern::new(|| pattern(r"(?i)\.(?:txt|npy|csv|dat|mat|tfm)$"));
    static POSE: Pattern = Pattern::new(|| pattern("(?i)[ _-]?poses?[ _-]?"));
    let mut parts = path.rsplit(['/', '\\']);
    let (stem, folder) = (parts.next().unwrap_or(""), parts.next().unwrap_or(""));
    let name: String = ENDING.replace(stem, "").chars().take(LONGEST).collect();
    let is_number = !name.is_empty() && name.bytes().all(|letter| letter.is_ascii_digit());
    if PLACE.is_match(&name) || (is_number && matches!(folder.to_lowercase().as_str(), "pose" | "poses")) {
        return Some(Frames::between("camera", "world"));
    }
    let is_counted = name.trim_end_matches(|letter: char| letter.is_ascii_digit()).chars().all(|c| !c.is_ascii_digit());
    let places = if is_counted { vec![name.as_str(), folder] } else { vec![name.as_str()] };
    places.into_iter().find_map(|place| {
        // "stereo_pose" is not the pose of a camera in the world.
        let bare = POSE.replace_all(place, "");
        let names = named(&bare, &Frames::default());
        let ends = Frames { from: names.from, to: names.to };
        let is_world = |end: &Option<String>| end.as_deref() == Some("world");
        if is_world(&ends.from) || is_world(&ends.to) { Some(ends) } else { world_frames(&bare) }
    })
}

/// Frames from a name: "depth_to_color", "color_from_depth", "T_color_depth".
pub fn named(name: &str, frames: &Frames) -> Names {
    static TOWARDS: [Pattern; 2] = [
        Pattern::new(|| pattern("(?i)^(?:T_)?([a-z0-9]+)_?_to__?([a-z0-9]+)$")),
        Pattern::new(|| pattern("(?i)^(?:T_)?([a-z0-9]+)_?2([a-z][a-z0-9]*)$")),
    ];
    static BACKWARDS: [Pattern; 2] = [
        Pattern::new(|| pattern("(?i)^(?:T_)?([a-z0-9]+)_from_([a-z0-9]+)$")),
        Pattern::new(|| pattern("(?i)^T_([a-z0-9]+)_([a-z0-9]+)$")),
    ];
    let own = (!name.is_empty()).then(|| name.to_owned());
    if frames.from.is_some() || frames.to.is_some() {
        return Names { name: own, from: frames.from.clone(), to: frames.to.clone() };
    }
    if let Some(Frames { from, to }) = world_frames(name) {
        return Names { name: own, from, to };
    }
    if let Some(found) = TOWARDS.iter().find_map(|pattern| pattern.captures(name)) {
        return Names::between(own, &found[1], &found[2]);
    }
    if let Some(found) = BACKWARDS.iter().find_map(|pattern| pattern.captures(name)) {
        return Names::between(own, &found[2], &found[1]);
    }
    Names { name: own, from: None, to: None }
}

pub fn camera_number(name: &str) -> Option<u64> {
    let digits = name.strip_prefix("cam")?;
    digits.bytes().all(|letter| letter.is_ascii_digit()).then(|| digits.parse().ok())?
}

pub fn camera_before(number: u64) -> Option<String> {
    number.checked_sub(1).map(|before| format!("cam{before}"))
}

/// Kalibr's names, where cn is the camera that holds the matrix and cnm1 the one before.
pub fn kalibr(key: &str, parent: &str) -> Option<Names> {
    let number = camera_number(parent)?;
    match key {
        "T_cn_cnm1" => {
            let before = camera_before(number)?;
            Some(Names::between(Some(format!("{parent} from {before}")), &before, parent))
        }
        "T_cam_imu" => Some(Names::between(Some(format!("{parent} from imu")), "imu", parent)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files_say_that_a_pose_is_a_place_in_the_world() {
        for path in ["pose.txt", "frame-000012.pose.txt", "a/c2w/0.txt", "pose/17.txt", "T_world_camera.txt", "w2c.npy"]
        {
            let frames = world_frames_of_file(path).unwrap_or_default();
            assert!([frames.from, frames.to].contains(&Some("world".into())), "{path}");
        }
        for path in
            ["depth_to_color.txt", "stereo_pose.txt", "T_cam_lidar.txt", "calib.txt", "poses/depth_to_color.txt"]
        {
            assert_eq!(world_frames_of_file(path), None, "{path}");
        }
    }

    #[test]
    fn frames_of_transforms_are_those_of_their_members() {
        let node = |text: &str| serde_json::from_str::<Node>(text).expect("is an object");
        let matrix = "[[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]";
        let found = frames_of(&node(&format!(r#"{{"child": "depth", "parent": "color", "matrix": {matrix}}}"#)));
        assert_eq!(found, Some(Frames::between("depth", "color")));
        assert_eq!(frames_of(&node(r#"{"child": "a", "parent": "b"}"#)), None);
        let ros = frames_of(&node(r#"{"header": {"frame_id": "base"}, "child_frame_id": "cam"}"#));
        assert_eq!(ros, Some(Frames::between("cam", "base")));
    }
}
