//! Descriptions of cameras and poses.

use bimodal_stereo::Lens;
use bimodal_stereo::nalgebra::Matrix3;

use super::calibration::{Calibration, NamedCamera, NamedPose};
use super::cameras::coefficients;
use super::numbers::{brief, fixed};

/// Largest number of cameras or poses that are described one by one.
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

/// The angle of a rotation, degrees.
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

/// A description of a text's content.
pub fn in_words(found: &Calibration) -> String {
    let parts =
        [listed(&found.cameras, "a camera", "cameras", of_camera), listed(&found.poses, "a pose", "poses", of_pose)];
    parts.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
