//! Results as files for other programs, like js/write.

use std::fs;
use std::path::Path;

use bimodal_stereo::{Estimator, Reason, Similarity, Status, StepReport, Surface, Uncertainty};
use serde::Serialize;

use crate::problem::{Problem, Result, shown};
use crate::read::npy_bytes;

/// Unit of lengths: metres if a view has a camera, pixels if it is orthographic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Length {
    Metres,
    Pixels,
}

impl Length {
    /// The unit of a view with or without a camera.
    pub fn of(has_camera: bool) -> Self {
        if has_camera { Self::Metres } else { Self::Pixels }
    }

    pub fn word(self) -> &'static str {
        match self {
            Self::Metres => "metres",
            Self::Pixels => "pixels",
        }
    }

    /// The symbol, as in the page's files.
    pub fn symbol(self) -> &'static str {
        match self {
            Self::Metres => "m",
            Self::Pixels => "px",
        }
    }
}

/// Steps of a stored depth, the finest first; the first one whose range covers the farthest depth is used.
const METRES: [(f64, &str); 4] = [(0.0001, "0.1 mm"), (0.001, "1 mm"), (0.01, "10 mm"), (1.0, "1 m")];
const PIXELS: [(f64, &str); 4] = [(0.001, "0.001 px"), (0.01, "0.01 px"), (0.1, "0.1 px"), (1.0, "1 px")];
const LARGEST: f64 = 65_535.0;

/// Colours of the clouds, as on the page: orange and blue.
const INKS: [[u8; 3]; 2] = [[199, 100, 26], [11, 98, 184]];

/// A file's name, its bytes, and a description.
pub type Entry = (&'static str, Vec<u8>, String);

/// Writes the results of an estimator and the files `more` into a folder; returns their paths with descriptions.
pub fn results(folder: &Path, estimator: &Estimator, more: Vec<Entry>) -> Result<Vec<String>> {
    fs::create_dir_all(folder).map_err(|error| Problem::file(folder, error))?;
    let image_length = Length::of(estimator.image().camera.pinhole().is_some());
    let depth_length = Length::of(estimator.depth().camera.pinhole().is_some());
    let (depth, width) = (estimator.refined_depth(), estimator.depth().size.width);
    let (png, says) = depth_png(depth, width, depth_length)
        .map_err(|error| Problem::file(&folder.join("refined-depth.png"), error))?;
    let run = estimator.report();
    let (length, depth_length) = (image_length.word(), depth_length.word());
    let clouds = clouds(estimator, image_length);
    let mut files: Vec<Entry> = vec![
        ("clouds.ply", clouds, format!("the picture's shape and the moved depth map, {length}")),
        ("refined-depth.png", png, format!("{says} per stored number, 0 is no depth")),
        ("refined-depth.npy", npy_bytes(width, depth), format!("{depth_length}, NaN is no depth")),
        ("pose.json", pose_json(run, image_length).into(), length.into()),
        ("depth_to_colour.txt", matrix_text(&run.pose).into(), format!("4x4 with the scale, {length}")),
        ("light.csv", light_csv(&estimator.light().flat()).into(), "nine coefficients a channel".into()),
    ];
    files.extend(more);
    let mut written = Vec::new();
    for (name, bytes, says) in files {
        let path = folder.join(name);
        fs::write(&path, bytes).map_err(|error| Problem::file(&path, error))?;
        written.push(format!("{} ({says})", shown(&path)));
    }
    Ok(written)
}

/// Depth as a 16-bit PNG, and its step in words, which is also in the file's text chunk "Unit".
pub fn depth_png(
    depth: &[f32],
    width: usize,
    length: Length,
) -> std::result::Result<(Vec<u8>, &'static str), png::EncodingError> {
    let is_there = |value: f64| value > 0.0 && value.is_finite();
    let values = || depth.iter().map(|&value| f64::from(value));
    let farthest = values().filter(|&value| is_there(value)).fold(0.0, f64::max);
    let steps = if length == Length::Metres { METRES } else { PIXELS };
    let (step, says) = steps.into_iter().find(|(step, _)| farthest / step <= LARGEST).unwrap_or(steps[3]);
    let stored = |value: f64| if is_there(value) { (value / step).round().clamp(1.0, LARGEST) as u16 } else { 0 };
    let data: Vec<u8> = values().flat_map(|value| stored(value).to_be_bytes()).collect();
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width as u32, (depth.len() / width) as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.add_text_chunk("Unit".into(), format!("{says} per stored number; 0 is no depth"))?;
    encoder.add_text_chunk("Software".into(), "bimodal-stereo".into())?;
    let mut writer = encoder.write_header()?;
    writer.write_image_data(&data)?;
    writer.finish()?;
    Ok((bytes, says))
}

/// Both clouds in the colour view's frame as a binary PLY, with a colour and a label: 0 for the picture's, 1 for the
/// depth map's.
fn clouds(estimator: &Estimator, length: Length) -> Vec<u8> {
    let clouds = [Surface::Image, Surface::Depth].map(|surface| estimator.points(surface));
    let there = |points: &'_ [f32]| points.iter().all(|value| value.is_finite());
    let points = |cloud: usize| clouds[cloud].chunks_exact(3).filter(move |point| there(point));
    let count = points(0).count() + points(1).count();
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\ncomment {}; x right, y down, z forward\n\
         comment label 0: shape from the picture\ncomment label 1: depth map, moved by the pose\n\
         element vertex {count}\nproperty float x\nproperty float y\nproperty float z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar label\nend_header\n",
        length.word()
    )
    .into_bytes();
    for (label, ink) in INKS.into_iter().enumerate() {
        for point in points(label) {
            file.extend(point.iter().flat_map(|value| value.to_le_bytes()));
            file.extend(ink);
            file.push(label as u8);
        }
    }
    file
}

/// The 4x4 matrix that maps depth points into the colour view; `numpy.loadtxt` reads it.
pub fn matrix_text(pose: &Similarity) -> String {
    let line = |row: usize| {
        let values: Vec<String> = pose.matrix().row(row).iter().map(f64::to_string).collect();
        values.join(" ") + "\n"
    };
    (0..4).map(line).collect()
}

/// Nine coefficients each of red, green and blue, one channel per line.
pub fn light_csv(light: &[f64]) -> String {
    let names: Vec<String> = (1..=9).map(|index| format!("L{index}")).collect();
    let line = |(channel, values): (&str, &[f64])| {
        let values: Vec<String> = values.iter().map(f64::to_string).collect();
        format!("{channel},{}\n", values.join(","))
    };
    let lines = ["R", "G", "B"].into_iter().zip(light.chunks_exact(9)).map(line);
    format!("channel,{}\n{}", names.join(","), lines.collect::<String>())
}

/// The pose and how far it can be trusted, for other programs, as in js/write/results.ts.
pub fn pose_json(report: &StepReport, length: Length) -> String {
    #[derive(Serialize)]
    struct Told<'a> {
        about: String,
        unit: &'static str,
        #[serde(flatten)]
        pose: &'a Similarity,
        status: Status,
        #[serde(skip_serializing_if = "Option::is_none")]
        message: Option<String>,
        #[serde(skip_serializing_if = "Option::is_none")]
        reason: &'a Option<Reason>,
        #[serde(skip_serializing_if = "Option::is_none")]
        uncertainty: &'a Option<Uncertainty>,
    }
    let StepReport { pose, status, reason, uncertainty, .. } = report;
    let sigmas = uncertainty.as_ref().map_or(
        "",
        |_| "; uncertainty is one sigma, null where the views do not determine the number, or where it was held fixed",
    );
    let about = format!(
        "P_colour = scale * rotation * P_depth + translation; rotation row by row; angles in degrees; lengths in {}{sigmas}",
        length.word()
    );
    let message = reason.as_ref().map(Reason::to_string);
    let told = Told { about, unit: length.symbol(), pose, status: *status, message, reason, uncertainty };
    // Serialising cannot fail, because the value holds only strings and numbers, and its keys are names.
    serde_json::to_string_pretty(&told).expect("can be written") + "\n"
}
