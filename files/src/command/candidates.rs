//! The extrinsics to be checked, from their files.

use std::path::{Path, PathBuf};

use bimodal_stereo::Similarity;

use super::arguments::Arguments;
use super::frames::{is_backwards, is_of_carrier};
use crate::problem::{Problem, Result, own_name};
use crate::rig::{Reading, given_name, read_calibration, says};
use crate::text::{Calibration, NamedPose};
use crate::warning::{Warning, Warnings};

pub struct Candidates {
    /// The candidates by name; the first one is the calibration to be checked.
    pub poses: Vec<(String, Similarity)>,
    pub readings: Vec<Reading>,
    /// Calibration files that hold cameras as well.
    pub cameras: Vec<PathBuf>,
}

/// The error about a file of poses between a sensor and its carrier or its target.
fn of_carriers(path: &Path, pose: &NamedPose) -> Problem {
    let [from, to] = [&pose.names.from, &pose.names.to].map(|name| name.as_deref().unwrap_or("another frame"));
    let words = format!(
        "it relates {from} to {to}, one of which is no sensor of the pictures (but an inertial unit, a body, a vehicle, \
         a robot or a calibration target); extrinsics relate the depth camera or the LiDAR to the colour camera. Give \
         that pose as a 4x4 matrix, in a file named depth_to_color.txt or lidar_to_camera.txt"
    );
    Problem::file(path, words)
}

pub fn candidates(arguments: &Arguments, warnings: &mut Warnings) -> Result<Candidates> {
    let mut found = Candidates { poses: Vec::new(), readings: Vec::new(), cameras: Vec::new() };
    let mut read = Vec::new();
    for path in &arguments.calibration {
        let one = read_calibration(path)?;
        let name = given_name(path);
        warnings.extend(one.warnings.0.iter().map(|warning| warning.of_file(&name)));
        found.readings.push(Reading { name: name.clone(), path: path.clone(), says: says(&one) });
        if !one.cameras.is_empty() {
            found.cameras.push(path.clone());
        }
        read.push((path, name, one));
    }
    for (path, name, one) in read {
        add(path, &name, one, arguments.inverted, &mut found.poses, warnings)?;
    }
    Ok(found)
}

fn add(
    path: &Path,
    name: &str,
    calibration: Calibration,
    is_inverted: bool,
    poses: &mut Vec<(String, Similarity)>,
    warnings: &mut Warnings,
) -> Result<()> {
    let Some(first) = calibration.poses.first() else {
        return Err(Problem::file(path, "it contains no extrinsics"));
    };
    let between: Vec<&NamedPose> = calibration.poses.iter().filter(|pose| !is_of_carrier(pose)).collect();
    if between.is_empty() {
        return Err(of_carriers(path, first));
    }
    let is_only = between.len() == 1;
    for (index, pose) in between.into_iter().enumerate() {
        let own = match (&pose.names.name, &pose.names.from, &pose.names.to) {
            (Some(name), ..) => name.clone(),
            (None, Some(from), Some(to)) => format!("{from} to {to}"),
            _ => format!("pose {}", index + 1),
        };
        let title = if is_only { own_name(path) } else { format!("{}, {own}", own_name(path)) };
        let turns = is_inverted || is_backwards(pose);
        if turns && !is_inverted {
            let [from, to] = [&pose.names.from, &pose.names.to].map(|name| name.as_deref().unwrap_or(""));
            let words = format!("it maps {from} to {to}; its inverse was checked.");
            warnings.push(Warning::new("inverse-checked", words).of_file(name));
        }
        // Two files may have the same name, and JavaScript puts names that are numbers first.
        let is_number = title.bytes().all(|letter| letter.is_ascii_digit());
        let mut unique = if is_number { format!("\"{title}\"") } else { title };
        while poses.iter().any(|(known, _)| *known == unique) {
            unique.push('\'');
        }
        poses.push((unique, if turns { pose.pose.inverse() } else { pose.pose }));
    }
    Ok(())
}
