//! Text files of cameras and poses: recognises their format by its words, and extracts cameras and poses.
//!
//! | file | content |
//! |---|---|
//! | `calibration` | the result |
//! | `numbers` | numbers and matrices in their many notations |
//! | `cameras`, `poses` | checked cameras and motions |
//! | `ends` | the two frames of a motion |
//! | `names`, `tree` | members of JSON, YAML and XML by their names |
//! | `plain`, `realsense`, `ros`, `colmap` | matrices and trajectories, and the formats of these programs |
//! | `words` | descriptions of cameras and poses |

mod calibration;
mod cameras;
mod colmap;
mod ends;
pub(crate) mod names;
pub mod numbers;
mod plain;
pub mod poses;
mod realsense;
mod ros;
mod topics;
mod tree;
pub mod words;

use serde::Deserialize;
use serde_json::{Map, Value};

pub use calibration::{Calibration, NamedCamera, NamedPose, Names};

use calibration::Reason;

/// Largest number of characters of a text with cameras or poses; a trajectory of ten thousand poses has a million.
const MOST_TEXT: usize = 4 << 20;
/// Largest number of characters of YAML: calibrations have a few thousand.
const MOST_YAML: usize = 1 << 18;
const NO_FORM: &str = "it is text in an unknown format";

/// The text of a file; `None` if its bytes are not text.
pub fn text_of(bytes: &[u8]) -> Option<String> {
    if bytes.len() > MOST_TEXT {
        return None;
    }
    let wide = |bytes: &[u8], order: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.as_chunks().0.iter().map(|&pair| order(pair)).collect();
        String::from_utf16(&units).ok()
    };
    let text = match bytes {
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes)?,
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes)?,
        _ => String::from_utf8(bytes.to_vec()).ok()?,
    };
    // Control characters distinguish binary data from text.
    let is_binary = |letter: char| matches!(letter, '\0'..='\x08' | '\x0e'..='\x1f');
    (!text.contains(is_binary)).then_some(text)
}

/// Poses of a file that holds only numbers, whose name may say that its only pose is a camera's pose in the world.
fn placed(mut found: Calibration, path: &str) -> Calibration {
    let [NamedPose { names: Names { from: None, to: None, .. }, pose }] = &found.poses[..] else { return found };
    let Some(frames) = ends::world_frames_of_file(path) else { return found };
    let is_place = frames.to.as_deref() == Some("world");
    let pose = if is_place { *pose } else { pose.inverse() };
    let from = if is_place { frames.from } else { frames.to };
    found.poses = vec![NamedPose { names: Names { name: None, from, to: Some("world".into()) }, pose }];
    const SAID: &str = "Its name says that it is the pose of a camera in the world (camera to world), which was not used as extrinsics between two cameras. If it does relate two cameras, name the file depth_to_color.txt or the like.";
    found.warnings.add("camera-to-world", SAID);
    found
}

/// Content of a text, with its format; the file's name may state the meaning of its numbers.
pub fn read_text(text: &str, path: &str) -> Result<Calibration, Reason> {
    let text = text.trim_start_matches('\u{feff}').trim();
    if text.is_empty() {
        return Err("it is empty or has only spaces".into());
    }
    if ros::is_publisher(text) {
        return ros::read_publishers(text);
    }
    if ros::is_echo(text) {
        return ros::read_echo(text);
    }
    if realsense::is_enumeration(text) {
        return realsense::read(text);
    }
    if text.starts_with('<') {
        return searched(&xml(text)?, "XML");
    }
    if colmap::is_colmap(text) {
        return colmap::read(text);
    }
    if let Some(found) = plain::read(text)? {
        return Ok(placed(found, path));
    }
    if text.starts_with(['{', '[']) {
        return searched(&json(text)?, "JSON");
    }
    searched(&yaml(text)?, "YAML")
}

fn searched(value: &Value, format: &str) -> Result<Calibration, Reason> {
    const NEITHER: &str = "neither a camera (camera_matrix, K, fx fy cx cy, intrinsics) nor a transform (R and T, T_.., rotation and translation, a 4x4 matrix)";
    let is_text = |value: &Value| !value.is_object() && !value.is_array();
    if is_text(value) || value.as_array().is_some_and(|all| all.iter().all(is_text)) {
        return Err(NO_FORM.into());
    }
    let mut found = tree::search(value)?;
    if found.cameras.is_empty() && found.poses.is_empty() {
        return Err(format!("it is {format}, but holds {NEITHER} by a known name"));
    }
    found.format = format.into();
    Ok(found)
}

fn json(text: &str) -> Result<Value, Reason> {
    // Python writes these three words, which JSON does not allow. They are not valid values of a calibration.
    static NONE: names::Pattern = names::Pattern::new(|| names::pattern(r"-?\bInfinity\b|\bNaN\b"));
    let plain = NONE.replace_all(text, "null");
    serde_json::from_str(&plain).map_err(|error| format!("this JSON is damaged or cut off ({error})"))
}

fn yaml(text: &str) -> Result<Value, Reason> {
    if text.len() > MOST_YAML {
        return Err(format!("it is text of {} characters in an unknown format", text.chars().count()));
    }
    let plain = with_colons(&plain_yaml(text));
    let documents: Result<Vec<_>, _> =
        serde_yaml_ng::Deserializer::from_str(&plain).map(serde_yaml_ng::Value::deserialize).collect();
    let mut documents = documents.map_err(|error| format!("{NO_FORM}, or damaged (as YAML: {error})"))?;
    let value = if documents.len() == 1 { documents.remove(0) } else { serde_yaml_ng::Value::Sequence(documents) };
    Ok(plain_value(value))
}

/// OpenCV's YAML begins with "%YAML:1.0", which is not valid YAML, and tags its matrices, as Python does its tuples.
fn plain_yaml(text: &str) -> String {
    static HEAD: names::Pattern = names::Pattern::new(|| names::pattern(r"(?m)^%YAML.*$"));
    static TAG: names::Pattern =
        names::Pattern::new(|| names::pattern(r"!!(?:opencv-[A-Za-z0-9_-]+|python/[A-Za-z0-9_:./]+)"));
    let text = HEAD.replace(text, "");
    let text = TAG.replace_all(&text, "");
    let line = |line: &str| {
        let tabs = line.len() - line.trim_start_matches('\t').len();
        format!("{}{}", "  ".repeat(tabs), &line[tabs..])
    };
    text.split('\n').map(line).collect::<Vec<_>>().join("\n")
}

/// Settings written as "fx = 500", line by line, are YAML except for the sign.
fn with_colons(text: &str) -> String {
    static COLON: names::Pattern = names::Pattern::new(|| names::pattern(r"(?m)^[ \t]*[A-Za-z0-9_.]{1,80}[ \t]*:"));
    static EQUAL: names::Pattern =
        names::Pattern::new(|| names::pattern(r"(?m)^([ \t]*[A-Za-z0-9_.]{1,80})[ \t]*=[ \t]*"));
    if COLON.is_match(text) { text.into() } else { EQUAL.replace_all(text, "$1: ").into_owned() }
}

/// YAML as JSON: tags are dropped, and keys become text.
fn plain_value(value: serde_yaml_ng::Value) -> Value {
    use serde_yaml_ng::Value as Yaml;
    match value {
        Yaml::Null => Value::Null,
        Yaml::Bool(value) => value.into(),
        Yaml::Number(number) => number.as_f64().into(),
        Yaml::String(text) => text.into(),
        Yaml::Sequence(list) => list.into_iter().map(plain_value).collect(),
        Yaml::Mapping(members) => {
            let key = |key: Yaml| match key {
                Yaml::String(text) => text,
                Yaml::Number(number) => number.to_string(),
                Yaml::Bool(value) => value.to_string(),
                _ => String::new(),
            };
            members.into_iter().map(|(name, value)| (key(name), plain_value(value))).collect::<Map<_, _>>().into()
        }
        Yaml::Tagged(tagged) => plain_value(tagged.value),
    }
}

/// Elements as plain values: those with children as objects (repeated ones and OpenCV's `<_>` as lists), others as
/// their text.
fn xml(text: &str) -> Result<Value, Reason> {
    const MOST_ELEMENTS: u32 = 300_000;
    const MOST_DEPTH: usize = 32;
    let options = roxmltree::ParsingOptions { allow_dtd: false, nodes_limit: MOST_ELEMENTS, ..Default::default() };
    // Launch files and fragments of them may hold several elements side by side, which XML does not allow.
    let text = text.split_once("?>").filter(|_| text.starts_with("<?")).map_or(text, |(_, rest)| rest);
    let whole = format!("<_all>{text}</_all>");
    // The parser would report a declaration below an element as damage.
    if ["<!DOCTYPE", "<![CDATA["].iter().any(|declaration| text.contains(declaration)) {
        return Err(
            "this XML declares a document type or raw data, which is not supported, because no calibration needs it"
                .to_owned(),
        );
    }
    let document = roxmltree::Document::parse_with_options(&whole, options)
        .map_err(|error| format!("this XML is damaged or cut off ({error})"))?;
    plain_element(document.root_element(), MOST_DEPTH)
}

fn plain_element(element: roxmltree::Node<'_, '_>, depth: usize) -> Result<Value, Reason> {
    let Some(depth) = depth.checked_sub(1) else { return Err("this XML is nested deeper than 32".into()) };
    let children: Vec<_> = element.children().filter(roxmltree::Node::is_element).collect();
    if children.is_empty() {
        let text: Vec<&str> =
            element.children().filter(roxmltree::Node::is_text).filter_map(|node| node.text()).collect();
        return Ok(text.join(" ").trim().into());
    }
    if children.iter().all(|child| child.tag_name().name() == "_") {
        return children.into_iter().map(|child| plain_element(child, depth)).collect();
    }
    let mut all: Map<String, Value> = Map::new();
    for child in children {
        let name = child.tag_name().name().to_owned();
        let value = plain_element(child, depth)?;
        match all.entry(name).or_insert_with(|| Value::Array(Vec::new())) {
            Value::Array(values) => values.push(value),
            _ => unreachable!("all members are lists until the end"),
        }
    }
    let single = |value: Value| match value {
        Value::Array(mut values) if values.len() == 1 => values.remove(0),
        other => other,
    };
    Ok(all.into_iter().map(|(name, values)| (name, single(values))).collect::<Map<_, _>>().into())
}
