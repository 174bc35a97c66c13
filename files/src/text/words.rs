//! Cameras, poses and strange files in plain words.

use bimodal_stereo::Lens;
use bimodal_stereo::nalgebra::Matrix3;

use super::calibration::{Calibration, NamedCamera, NamedPose};
use super::cameras::coefficients;
use super::numbers::{brief, fixed};

/// How many are described one by one.
const FEW: usize = 4;
const DIGITS: usize = 5;

fn lens(camera: &NamedCamera) -> String {
    match (&camera.camera.lens, coefficients(&camera.camera.lens)) {
        (Lens::Fisheye(_), _) => "fisheye".into(),
        (_, Some(count)) => format!("Brown's distortion with {count} numbers"),
        _ => "no distortion".into(),
    }
}

fn of_camera(each: &NamedCamera) -> String {
    let name = each.name.as_ref().map(|name| format!("{name}: ")).unwrap_or_default();
    let size = each.size.map(|[width, height]| format!("{width}x{height}, ")).unwrap_or_default();
    let camera = &each.camera;
    let [fx, fy, cx, cy] = [camera.fx, camera.fy, camera.cx, camera.cy].map(|value| brief(value, DIGITS));
    format!("{name}{size}fx {fx} fy {fy} cx {cx} cy {cy}, {}", lens(each))
}

/// The turn of a rotation, degrees.
fn turn(r: &Matrix3<f64>) -> f64 {
    ((r.trace() - 1.0) / 2.0).clamp(-1.0, 1.0).acos().to_degrees()
}

fn of_pose(each: &NamedPose) -> String {
    let names = &each.names;
    let called = match (&names.from, &names.to, &names.name) {
        (Some(from), Some(to), _) => format!("from {from} to {to}: "),
        (_, _, Some(name)) => format!("{name}: "),
        _ => String::new(),
    };
    let shift = each.pose.translation.norm();
    format!("{called}{} degrees, {} mm", fixed(turn(&each.pose.rotation), 2), fixed(1000.0 * shift, 1))
}

fn listed<T>(all: &[T], one: &str, many: &str, words: impl Fn(&T) -> String) -> Option<String> {
    if all.is_empty() {
        return None;
    }
    let head = if all.len() == 1 { one.to_owned() } else { format!("{} {many}", all.len()) };
    let some: Vec<String> = all.iter().take(FEW).map(words).collect();
    Some(format!("{head} ({}{})", some.join("; "), if all.len() > FEW { "; .." } else { "" }))
}

/// What a text holds.
pub fn in_words(found: &Calibration) -> String {
    let parts =
        [listed(&found.cameras, "a camera", "cameras", of_camera), listed(&found.poses, "a pose", "poses", of_pose)];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}

/// First bytes of pictures that are not read at all, and what to do about them.
const PICTURES: [(usize, &[u8], &str); 7] = [
    (0, b"GIF8", "a GIF; save it as PNG"),
    (0, b"BM", "a BMP; save it as PNG"),
    (4, b"ftyphei", "HEIC or AVIF; save it as PNG or JPEG"),
    (4, b"ftypmif1", "HEIC or AVIF; save it as PNG or JPEG"),
    (4, b"ftypavif", "HEIC or AVIF; save it as PNG or JPEG"),
    (0, b"\xff\x4f\xff\x51", "JPEG 2000; save it as PNG"),
    (8, b"WEBP", "WebP; save it as PNG"),
];

/// The same of what is no picture.
const STRANGE: [(usize, &[u8], &str); 10] = [
    (0, b"PK\x03\x04", "a ZIP archive (.npz is one); unpack it first"),
    (0, b"\x1f\x8b", "compressed by gzip; unpack it first"),
    (0, b"\x89HDF", "HDF5; save the array as .npy"),
    (0, b"MATLAB", "a .mat file of MATLAB; save the array as .npy or 16-bit PNG"),
    (4, b"ftyp", "a video; save its frames as PNG"),
    (8, b"AVI ", "a video; save its frames as PNG"),
    (0, b"#ROSBAG", "a recording of ROS; export its images and camera_info first"),
    (0, b"SQLite format", "a recording of ROS; export its images and camera_info first"),
    (0, b"\x89MCAP", "a recording of ROS; export its images and camera_info first"),
    (0, b"%PDF", "a PDF"),
];

/// Kinds of pixels and points that the package for JavaScript reads.
const ELSEWHERE: [(usize, &[u8], &str); 12] = [
    (0, b"II*\0", "TIFF"),
    (0, b"MM\0*", "TIFF"),
    (0, b"II+\0", "BigTIFF"),
    (0, b"\x76\x2f\x31\x01", "OpenEXR"),
    (0, b"Pf", "PFM"),
    (0, b"PF", "PFM"),
    (0, b"P2", "PGM"),
    (0, b"P3", "PPM"),
    (0, b"P5", "PGM"),
    (0, b"P6", "PPM"),
    (0, b"ply", "PLY"),
    (0, b"# .PCD", "PCD"),
];

fn kind_in(kinds: &'static [(usize, &'static [u8], &'static str)], bytes: &[u8]) -> Option<&'static str> {
    let is = |(at, start, _): &&(usize, &[u8], &str)| bytes.get(*at..).is_some_and(|rest| rest.starts_with(start));
    kinds.iter().find(is).map(|(_, _, name)| *name)
}

/// The kind of a file of pixels or points that is read by the package for JavaScript alone.
pub fn read_elsewhere(bytes: &[u8]) -> Option<&'static str> {
    kind_in(&ELSEWHERE, bytes)
}

/// Whether the bytes begin a picture of a kind that is not read here.
pub fn is_strange_picture(bytes: &[u8]) -> bool {
    read_elsewhere(bytes).is_some() || kind_in(&PICTURES, bytes).is_some()
}

/// What a file that is not read seems to be.
pub fn strange(bytes: &[u8]) -> String {
    if let Some(kind) = read_elsewhere(bytes) {
        return format!("it is {kind}, which is not read here; npx bimodal-stereo check reads it");
    }
    match kind_in(&PICTURES, bytes).or_else(|| kind_in(&STRANGE, bytes)) {
        Some(kind) => format!("it is {kind}"),
        None => "its format is not supported".into(),
    }
}
