//! Results as files that other programs read, as js/write has them.

use std::fs;
use std::path::Path;

use bimodal_stereo::{Similarity, Surface};
use bimodal_stereo_files::read::npy_bytes;
use bimodal_stereo_files::{Problem, Result, shown};

use crate::estimate::{Length, Outcome};
use crate::report::{self, Layout};

/// Steps of a stored depth, the finest first; the first that reaches the farthest depth is taken.
const METRES: [(f64, &str); 4] = [(0.0001, "0.1 mm"), (0.001, "1 mm"), (0.01, "10 mm"), (1.0, "1 m")];
const PIXELS: [(f64, &str); 4] = [(0.001, "0.001 px"), (0.01, "0.01 px"), (0.1, "0.1 px"), (1.0, "1 px")];
const LARGEST: f64 = 65_535.0;

/// The clouds' inks on the page: orange and blue.
const INKS: [[u8; 3]; 2] = [[199, 100, 26], [11, 98, 184]];

/// Writes everything into a folder; says what.
pub fn results(folder: &Path, found: &Outcome) -> Result<Vec<String>> {
    fs::create_dir_all(folder).map_err(|error| Problem::file(folder, error))?;
    let estimator = &found.estimator;
    let (depth, width) = (estimator.refined_depth(), estimator.depth().size.width);
    let (png, says) = depth_png(depth, width, found.depth_length)
        .map_err(|error| Problem::file(&folder.join("refined-depth.png"), error))?;
    let run = estimator.report();
    let (length, depth_length) = (found.image_length.word(), found.depth_length.word());
    let files: [(&str, Vec<u8>, String); 7] = [
        ("clouds.ply", clouds(found), format!("the picture's shape and the moved depth map, {length}")),
        ("refined-depth.png", png, format!("{says} per stored number, 0 is no depth")),
        ("refined-depth.npy", npy_bytes(width, depth), format!("{depth_length}, NaN is no depth")),
        ("pose.json", report::pose_json(run, found.image_length).into(), length.into()),
        ("depth_to_colour.txt", matrix_text(&run.pose).into(), format!("4x4 with the scale, {length}")),
        ("light.csv", light_csv(&estimator.light().flat()).into(), "nine coefficients a channel".into()),
        ("report.json", report::json(found, Layout::Lines).into(), "as --json".into()),
    ];
    let mut written = Vec::new();
    for (name, bytes, says) in files {
        let path = folder.join(name);
        fs::write(&path, bytes).map_err(|error| Problem::file(&path, error))?;
        written.push(format!("{} ({says})", shown(&path)));
    }
    Ok(written)
}

/// Depth as a PNG of 16 bits, and its step in words, which the file's remark "Unit" says too.
fn depth_png(
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

/// Both clouds in the colour view's frame as a binary PLY, with a colour and a label: 0 the picture's, 1 the depth map's.
fn clouds(found: &Outcome) -> Vec<u8> {
    let clouds = [Surface::Image, Surface::Depth].map(|surface| found.estimator.points(surface));
    let there = |points: &'_ [f32]| points.iter().all(|value| value.is_finite());
    let points = |cloud: usize| clouds[cloud].chunks_exact(3).filter(move |point| there(point));
    let count = points(0).count() + points(1).count();
    let mut file = format!(
        "ply\nformat binary_little_endian 1.0\ncomment {}; x right, y down, z forward\n\
         comment label 0: shape from the picture\ncomment label 1: depth map, moved by the pose\n\
         element vertex {count}\nproperty float x\nproperty float y\nproperty float z\n\
         property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar label\nend_header\n",
        found.image_length.word()
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

/// The 4x4 matrix that carries depth points into the colour view; `numpy.loadtxt` reads it.
fn matrix_text(pose: &Similarity) -> String {
    let line = |row: usize| {
        let values: Vec<String> = pose.matrix().row(row).iter().map(f64::to_string).collect();
        values.join(" ") + "\n"
    };
    (0..4).map(line).collect()
}

/// Nine coefficients of red, of green and of blue, one channel a line.
fn light_csv(light: &[f64]) -> String {
    let names: Vec<String> = (1..=9).map(|index| format!("L{index}")).collect();
    let line = |(channel, values): (&str, &[f64])| {
        let values: Vec<String> = values.iter().map(f64::to_string).collect();
        format!("{channel},{}\n", values.join(","))
    };
    let lines = ["R", "G", "B"].into_iter().zip(light.chunks_exact(9)).map(line);
    format!("channel,{}\n{}", names.join(","), lines.collect::<String>())
}
