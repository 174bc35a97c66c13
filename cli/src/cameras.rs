//! The intrinsics of a pair, read from given files or from files beside its images.

use std::path::{Path, PathBuf};

use bimodal_stereo::Pinhole;
use bimodal_stereo_files::pairs::{Files, files_beside};
use bimodal_stereo_files::{NamedCamera, Problem, Result, Warning, assigned, read_calibration, read_corner, shown};

/// Columns and rows of a pair's views.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    pub image: [usize; 2],
    pub depth: [usize; 2],
}

/// The cameras of one pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct Found {
    pub image: Option<Pinhole>,
    pub depth: Option<Pinhole>,
}

/// The cameras of the given files.
#[derive(Debug, Default)]
pub struct Cameras(Vec<(NamedCamera, PathBuf)>);

impl Cameras {
    /// Reads the given files; each must hold a camera.
    pub fn named(files: &[PathBuf]) -> Result<Self> {
        let mut all = Vec::new();
        for path in files {
            let found = read_calibration(path)?;
            if found.cameras.is_empty() {
                return Err(Problem::file(path, "it contains no camera"));
            }
            all.extend(found.cameras.into_iter().map(|camera| (with_name(camera, path), path.clone())));
        }
        Ok(Self(all))
    }

    /// The cameras of a pair: from the given files, else from those beside its images.
    pub fn of_pair(
        &self,
        files: &Files,
        sizes: Sizes,
        notes: &mut Vec<String>,
        warnings: &mut Vec<Warning>,
    ) -> Result<Found> {
        let beside = if self.0.is_empty() { beside(files)? } else { Vec::new() };
        let all = if self.0.is_empty() { &beside } else { &self.0 };
        if all.is_empty() {
            return Ok(Found::default());
        }
        let [image_corner, depth_corner] = [read_corner(&files.image)?, read_corner(&files.depth)?];
        // Crops have the cameras of whole frames, whose sizes are not stated.
        let is_crop = image_corner.is_some() || depth_corner.is_some();
        let cameras: Vec<NamedCamera> = all
            .iter()
            .map(|(camera, _)| NamedCamera { size: camera.size.filter(|_| !is_crop), ..camera.clone() })
            .collect();
        let whole = if is_crop { [[0, 0]; 2] } else { [sizes.image, sizes.depth] };
        let picked = assigned(&cameras, whole, false, warnings);
        let mut camera = |index: Option<usize>, size: [usize; 2], corner: Option<[f64; 2]>, what: &str| {
            let Some(index) = index else { return Ok(None) };
            let (named, path) = (&cameras[index], &all[index].1);
            if let Some([width, height]) = named.size.filter(|&known| known != size) {
                let [w, h] = size;
                let reason = format!(
                    "its camera is for {width}x{height} pixels, but the {what} has {w}x{h}: scale or crop the camera first"
                );
                return Err(Problem::file(path, reason));
            }
            let [left, top] = corner.unwrap_or([0.0; 2]);
            let cropped = if corner.is_some() { ", moved to its crop" } else { "" };
            notes.push(format!("{}: intrinsics of the {what}{cropped}", shown(path)));
            let Pinhole { cx, cy, .. } = named.camera;
            Ok(Some(Pinhole { cx: cx - left, cy: cy - top, ..named.camera }))
        };
        Ok(Found {
            image: camera(picked[0], sizes.image, image_corner, "image")?,
            depth: camera(picked[1], sizes.depth, depth_corner, "depth map")?,
        })
    }
}

/// A camera without a name is named after its file.
fn with_name(camera: NamedCamera, path: &Path) -> NamedCamera {
    let stem = || path.file_stem().map(|stem| stem.to_string_lossy().into_owned());
    NamedCamera { name: camera.name.or_else(stem), ..camera }
}

/// The cameras in files with camera-like names in the folders of both images. Other files beside them are ignored.
fn beside(files: &Files) -> Result<Vec<(NamedCamera, PathBuf)>> {
    let mut all = Vec::new();
    for path in files_beside(files) {
        let Ok(found) = read_calibration(&path) else { continue };
        all.extend(found.cameras.into_iter().map(|camera| (with_name(camera, &path), path.clone())));
    }
    Ok(all)
}
