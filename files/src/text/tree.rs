//! Cameras and motions in JSON, YAML and XML from any program: ROS, OpenCV, Open3D, Kalibr, RealSense, or written by
//! hand.
//!
//! A walk over all objects recognises them by the names and shapes of their members (see `names`); the words of a name
//! that are not known become the camera's name. Walks are bounded in depth and in number of objects.

use bimodal_stereo::Similarity;
use serde_json::{Map, Value};

use super::calibration::{Calibration, NamedPose, Names, Reason};
use super::cameras::{RawCamera, camera_of};
use super::ends::{Frames, camera_before, camera_number, frames_of, kalibr, named};
use super::names::{
    self, INTRINSICS, LENS, NO_MOTION, Pattern, ROTATION, TRANSLATION, labelled, leftover, member, pattern, text_of,
};
use super::numbers::{Matrix, matrix_of, number_of, transposed};
use super::poses::{chained, is_last_row, last_column, motion, motion_of_matrix, of_quaternion, of_vector, turned};
use super::topics::by_topics;

type Node = Map<String, Value>;
type Done = Result<(), Reason>;

const MOST_NODES: usize = 50_000;
const MOST_MEMBERS: usize = 200_000;
/// Largest number of members of an object that is a camera or a motion; larger ones may contain some.
const MOST_OWN: usize = 300;
const MOST_DEPTH: usize = 24;
/// Largest number of cameras and poses of a file.
const MOST_FOUND: usize = 5000;
#[derive(Default)]
struct Search {
    found: Calibration,
    /// Names of cameras, each with the topic of its images.
    topics: Vec<(String, String)>,
    nodes: usize,
    members: usize,
}

pub fn search(value: &Value) -> Result<Calibration, Reason> {
    let mut search = Search::default();
    search.walk(value, "", &Frames::default(), 0)?;
    search.chain();
    by_topics(&search.topics, &mut search.found);
    Ok(search.found)
}

fn is_like(value: Option<&f64>, to: f64) -> bool {
    value.is_some_and(|value| (value - to).abs() < 1e-6)
}

fn is_empty(value: &Value) -> bool {
    value.is_null() || value == "" || value.as_array().is_some_and(Vec::is_empty)
}

fn short(text: &str) -> String {
    text.chars().take(40).collect()
}

/// Nine numbers as a matrix of intrinsics, row by row, whether they are given by rows or by columns.
fn intrinsics(matrix: Option<&Matrix>) -> Option<Vec<f64>> {
    let values = &matrix?.values;
    if values.len() != 9 || !is_like(values.last(), 1.0) {
        return None;
    }
    let is_triangle = |m: &[f64]| [3, 6, 7].iter().all(|&at| is_like(m.get(at), 0.0)) && !is_like(m.first(), 0.0);
    if is_triangle(values) {
        let is_rotation = is_like(values.get(2), 0.0) && is_like(values.get(5), 0.0) && is_like(values.first(), 1.0);
        return (!is_rotation).then(|| values.clone());
    }
    Some(transposed(values, 3)).filter(|turned| is_triangle(turned))
}

impl Search {
    fn walk(&mut self, value: &Value, name: &str, frames: &Frames, depth: usize) -> Done {
        if !value.is_object() && !value.is_array() {
            return Ok(());
        }
        self.nodes += 1;
        if self.nodes > MOST_NODES {
            return Err(format!("it holds more than {MOST_NODES} lists and objects"));
        }
        if depth > MOST_DEPTH {
            return Err(format!("it is nested deeper than {MOST_DEPTH}"));
        }
        if self.found.cameras.len() + self.found.poses.len() > MOST_FOUND {
            return Err(format!("it holds more than {MOST_FOUND} cameras and poses"));
        }
        if let Value::Array(list) = value {
            let holds_some = list.first().is_some_and(|first| first.is_object() || first.is_array() || first.is_null());
            return if holds_some {
                list.iter().try_for_each(|each| self.walk(each, name, frames, depth + 1))
            } else {
                Ok(())
            };
        }
        let Value::Object(node) = value else { return Ok(()) };
        self.members += node.len();
        if self.members > MOST_MEMBERS {
            return Err(format!("its objects have more than {MOST_MEMBERS} members"));
        }
        let inner = if node.len() > MOST_OWN { frames.clone() } else { self.read(node, name, frames)? };
        for (group, members) in dotted(node) {
            self.walk(&Value::Object(members), &group, frames, depth + 1)?;
        }
        for (key, value) in node {
            if matrix_of(Some(value)).is_none() {
                self.walk(value, name_of(key, name), &inner, depth + 1)?;
            }
        }
        Ok(())
    }

    /// Adds the cameras and motions among this object's members, and returns the frames that it names.
    fn read(&mut self, node: &Node, name: &str, frames: &Frames) -> Result<Frames, Reason> {
        let before = self.found.cameras.len();
        self.camera(node, name)?;
        let names: Vec<Option<&str>> = self.found.cameras[before..].iter().map(|each| each.name.as_deref()).collect();
        // In OpenCV's stereo calibration, R and T map points of camera 1 into camera 2. With other names, the order
        // has no meaning.
        let stereo = if names == [Some("1"), Some("2")] {
            Frames { from: Some("1".into()), to: Some("2".into()) }
        } else {
            frames.clone()
        };
        let inner = frames_of(node).unwrap_or(stereo);
        self.motions(node, name, &inner)?;
        if let ([camera], Some(topic)) = (&self.found.cameras[before..], text_of(member(node, &["rostopic"])))
            && let Some(name) = &camera.name
        {
            self.topics.push((name.clone(), topic));
        }
        Ok(inner)
    }

    fn add(&mut self, raw: RawCamera) -> Done {
        let camera = camera_of(raw, &mut self.found.warnings)?;
        self.found.cameras.push(camera);
        Ok(())
    }

    fn camera(&mut self, node: &Node, parent: &str) -> Done {
        let name = text_of(member(node, &["cameraname"])).or_else(|| (!parent.is_empty()).then(|| parent.to_owned()));
        let called = name.clone().unwrap_or_default();
        if let (Some(fx), Some(cx)) = (number_of(member(node, &["fx"])), number_of(member(node, &["cx", "ppx"]))) {
            let (Some(fy), Some(cy)) = (number_of(member(node, &["fy"])), number_of(member(node, &["cy", "ppy"])))
            else {
                return Err("its camera has fx and cx, but not fy and cy".into());
            };
            return self.add(RawCamera { name, focal: [fx, fy], centre: [cx, cy], ..rest(node, "")? });
        }
        let four = matrix_of(member(node, &["intrinsics"])).map(|matrix| matrix.values);
        if let (Some(model), Some(four)) = (text_of(member(node, &["cameramodel"])), four) {
            if model != "pinhole" {
                let model = short(&model);
                return Err(format!(
                    "its camera \"{called}\" has Kalibr's model \"{model}\"; only pinhole is supported"
                ));
            }
            let [fx, fy, cx, cy] = four[..] else {
                return Err(format!("its camera \"{called}\" has {} intrinsics; fu fv pu pv are needed", four.len()));
            };
            return self.add(RawCamera { name, focal: [fx, fy], centre: [cx, cy], ..rest(node, "")? });
        }
        node.keys().try_for_each(|key| self.camera_of_matrix(node, key, name.as_deref()))
    }

    fn camera_of_matrix(&mut self, node: &Node, key: &str, parent: Option<&str>) -> Done {
        let Some(label) = leftover(key, INTRINSICS) else { return Ok(()) };
        let matrix = matrix_of(node.get(key));
        let Some(k) = intrinsics(matrix.as_ref()) else {
            let is_wrong = matrix.is_some_and(|matrix| matrix.values.len() == 9) && label.is_empty() && key != "M";
            return if is_wrong {
                Err(format!("its {key} is not a matrix of intrinsics (fx 0 cx / 0 fy cy / 0 0 1)"))
            } else {
                Ok(())
            };
        };
        let others = rest(node, &label)?;
        let name = if label.is_empty() { parent.map(Into::into) } else { Some(label) };
        self.add(RawCamera { name, focal: [k[0], k[4]], centre: [k[2], k[5]], skew: k[1], ..others })
    }

    fn motions(&mut self, node: &Node, parent: &str, frames: &Frames) -> Done {
        for key in node.keys() {
            if let Some(label) = leftover(key, ROTATION) {
                self.motion_of_pair(node, key, &label, parent, frames)?;
            }
            self.motion_of_matrix(node, key, parent, frames)?;
        }
        let all = |names: &[&[&str]]| -> Option<Vec<f64>> {
            names.iter().map(|names| number_of(member(node, names))).collect()
        };
        let quaternion = all(&[&["qx"], &["qy"], &["qz"], &["qw"]]);
        let shift = all(&[&["x", "tx"], &["y", "ty"], &["z", "tz"]]);
        if let (Some(quaternion), Some(shift)) = (quaternion, shift) {
            let warnings = &mut self.found.warnings;
            let rotation = of_quaternion(std::array::from_fn(|at| quaternion[at]), warnings)?;
            self.found.poses.push(turned(&rotation, &shift, named(parent, frames), warnings, true)?);
        }
        Ok(())
    }

    fn motion_of_pair(&mut self, node: &Node, key: &str, label: &str, parent: &str, frames: &Frames) -> Done {
        let Some((other, shift)) = labelled(node, TRANSLATION, label) else { return Ok(()) };
        let parts = [parts(&node[key], &["x", "y", "z", "w"]), parts(shift, &["x", "y", "z"])];
        let [Some(r), Some(t)] = parts else { return Ok(()) };
        let own = named(&label.replace(' ', "_"), &Frames::default());
        let names = if own.from.is_some() { own } else { named(if label.is_empty() { parent } else { label }, frames) };
        if t.values.len() != 3 {
            return Err(format!("its {other} has {} numbers, not three", t.values.len()));
        }
        let warnings = &mut self.found.warnings;
        // RealSense writes these two names with flat lists, and its rotations column by column.
        let is_realsense = key == "rotation" && r.rows.is_none();
        let found = match r.values[..] {
            [x, y, z] => turned(&of_vector([x, y, z])?, &t.values, names, warnings, true)?,
            [x, y, z, w] => {
                let rotation = of_quaternion([x, y, z, w], warnings)?;
                turned(&rotation, &t.values, names, warnings, true)?
            }
            _ if r.values.len() == 9 && is_realsense => {
                motion(&transposed(&r.values, 3), &t.values, names, warnings, true)?
            }
            _ if r.values.len() == 9 => motion(&r.values, &t.values, names, warnings, true)?,
            _ => {
                return Err(format!(
                    "its {key} has {} numbers; a rotation needs 9 (matrix), 4 (quaternion) or 3 (vector or angles)",
                    r.values.len()
                ));
            }
        };
        self.found.poses.push(found);
        Ok(())
    }

    fn motion_of_matrix(&mut self, node: &Node, key: &str, parent: &str, frames: &Frames) -> Done {
        let Some(matrix) = matrix_of(node.get(key)) else { return Ok(()) };
        let length = matrix.values.len();
        if leftover(key, NO_MOTION).is_some() || leftover(key, LENS).as_deref() == Some("") {
            return Ok(());
        }
        if length != 16 && (length != 12 || matrix.rows != Some(3)) {
            return Ok(());
        }
        let is_open3d = key == "extrinsic" || key == "pose";
        let of_world = |from: &str, to: &str| named(parent, &Frames { from: Some(from.into()), to: Some(to.into()) });
        let names = match key {
            "extrinsic" => of_world("world", "camera"),
            "pose" => of_world("camera", "world"),
            _ => kalibr(key, parent).unwrap_or_else(|| named(key, frames)),
        };
        let is_flat = matrix.rows.is_none() && length == 16;
        let by_columns =
            is_flat && (is_open3d || (!is_last_row(&matrix.values[12..]) && is_last_row(&last_column(&matrix.values))));
        let values = if by_columns { transposed(&matrix.values, 4) } else { matrix.values };
        self.found.poses.push(motion_of_matrix(&values, names, &mut self.found.warnings, !is_open3d)?);
        Ok(())
    }

    /// Adds the motion from each camera to the next one, if both are related to the same inertial unit.
    fn chain(&mut self) {
        let is_between = |pose: &NamedPose, from: &str, to: &str| {
            pose.names.from.as_deref() == Some(from) && pose.names.to.as_deref() == Some(to)
        };
        for one in self.found.poses.clone() {
            let Some(to) = one.names.to.clone().filter(|_| one.names.from.as_deref() == Some("imu")) else { continue };
            let Some(before) = camera_number(&to).and_then(camera_before) else { continue };
            let Some(other) = self.found.poses.iter().find(|pose| is_between(pose, "imu", &before)) else { continue };
            if self.found.poses.iter().any(|pose| is_between(pose, &before, &to)) {
                continue;
            }
            let pose: Similarity = chained(&one.pose, &other.pose.inverse());
            let names = Names::between(Some(format!("{to} from {before}")), &before, &to);
            self.found.poses.insert(0, NamedPose { names, pose });
        }
    }
}

/// Distortion, model and size of the camera with this label.
fn rest(node: &Node, label: &str) -> Result<RawCamera, Reason> {
    let written = labelled(node, LENS, label).map(|(_, value)| value).or_else(|| member(node, &["distk1k2p1p2k3"]));
    let singles = ["k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"].map(|key| number_of(member(node, &[key])));
    let is_fisheye = number_of(member(node, &["fisheyemodel"])) == Some(1.0)
        || member(node, &["fisheye"]).is_some_and(|value| value == &Value::Bool(true));
    let written_model = || {
        text_of(member(node, &["distortionmodel", "lensmodel", "lens"])).or_else(|| text_of(member(node, &["model"])))
    };
    let model = if is_fisheye { Some("fisheye".into()) } else { written_model() };
    let listed = written.filter(|value| !value.is_object() || value.get("data").is_some());
    let listed = matrix_of(listed).map(|matrix| matrix.values);
    if let Some(written) = written
        && listed.is_none()
        && !written.is_object()
        && !written.is_string()
        && !is_empty(written)
    {
        return Err("its distortion contains something other than numbers".into());
    }
    static ANGLES: Pattern = Pattern::new(|| pattern("(?i)fisheye|kannala|equi"));
    let used: Vec<usize> =
        if ANGLES.is_match(model.as_deref().unwrap_or("")) { vec![0, 1, 4, 5] } else { (0..8).collect() };
    let by_name = || used.iter().map(|&at| singles[at].unwrap_or(0.0)).collect();
    let distortion = match listed {
        Some(listed) => listed,
        None if singles.iter().any(Option::is_some) => by_name(),
        None => Vec::new(),
    };
    let [width, height] = size_of(node, label);
    Ok(RawCamera { distortion, model, width, height, ..RawCamera::default() })
}

fn size_of(node: &Node, label: &str) -> [Option<f64>; 2] {
    if let Some([width, height]) =
        matrix_of(member(node, &["resolution", "imagesize", "size"])).as_ref().map(|matrix| &matrix.values[..])
    {
        return [Some(*width), Some(*height)];
    }
    ["width", "height"].map(|side| {
        let own: Vec<String> = [format!("image{side}"), side.to_owned()]
            .into_iter()
            .flat_map(|name| if label.is_empty() { vec![name] } else { vec![format!("{name}{label}"), name] })
            .collect();
        number_of(member(node, &own.iter().map(String::as_str).collect::<Vec<_>>()))
    })
}

/// Members named "Camera.fx", as in ORB-SLAM, grouped by the part before the dot.
fn dotted(node: &Node) -> Vec<(String, Node)> {
    static DOT: Pattern = Pattern::new(|| pattern(r"^([A-Za-z0-9_]{1,40})\.([A-Za-z0-9_]{1,40})$"));
    let mut groups: Map<String, Value> = Map::new();
    for (key, value) in node {
        let Some(found) = (key.len() <= names::LONGEST + 1).then(|| DOT.captures(key)).flatten() else { continue };
        let group = groups.entry(found[1].to_owned()).or_insert_with(|| Value::Object(Node::new()));
        if let Value::Object(members) = group {
            members.insert(found[2].to_owned(), value.clone());
        }
        if groups.len() > MOST_OWN {
            break;
        }
    }
    let members = |value| if let Value::Object(members) = value { members } else { Node::new() };
    groups.into_iter().map(|(name, value)| (name, members(value))).collect()
}

/// The name for the cameras and poses of a member. If the member's key only states a kind, it is the parent's key.
fn name_of<'a>(key: &'a str, parent: &'a str) -> &'a str {
    let is_kind = matches!(
        key,
        "transform"
            | "transforms"
            | "intrinsic"
            | "intrinsics"
            | "pose"
            | "opencv_storage"
            | "launch"
            | "parameters"
            | "ros__parameters"
            | "nodes"
    );
    if is_kind { parent } else { key }
}

/// A list or matrix, or an object with x, y, z and w.
fn parts(value: &Value, axes: &[&str]) -> Option<Matrix> {
    match value {
        Value::Object(node) if !node.contains_key("data") => {
            let values: Option<Vec<f64>> = axes.iter().map(|axis| number_of(node.get(*axis))).collect();
            values.map(|values| Matrix { values, rows: None })
        }
        _ => matrix_of(Some(value)),
    }
}
