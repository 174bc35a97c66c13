//! Helpers for several tests: the data beside the project, and pictures.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

use bimodal_stereo::scenes::Relief;
use bimodal_stereo::{Light, Normals, Size};
use nalgebra::Vector3;
use proptest::prelude::ProptestConfig;
use proptest::test_runner::RngSeed;

/// Number of cases of a law. Every run has the same cases: native runs get their seed from .cargo/config.toml, and wasm
/// has no environment.
pub fn laws(cases: u32) -> ProptestConfig {
    let drawn = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
    if cfg!(target_arch = "wasm32") { ProptestConfig { rng_seed: RngSeed::Fixed(1), ..drawn } } else { drawn }
}

/// Folder of other people's data, which is never part of the project. A test that needs it is marked
/// `#[ignore = "needs ../shared/data"]`, so that no summary counts it as passed without the data. `npm test` includes
/// it if the data are there.
pub fn data_dir() -> PathBuf {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    assert!(folder.is_dir(), "no data in {}", folder.display());
    folder
}

/// A two-dimensional float32 array, row-major, with its size.
pub fn read_npy_f32(path: &Path) -> (Size, Vec<f32>) {
    let file = npyz::NpyFile::new(BufReader::new(File::open(path).expect("the file is there"))).expect("npy");
    let [height, width] = file.shape()[..] else { panic!("{} has not two dimensions", path.display()) };
    let size = Size { width: width as usize, height: height as usize };
    let order = file.order();
    let stored: Vec<f32> = file.into_vec().expect("float32");
    let values = match order {
        npyz::Order::C => stored,
        npyz::Order::Fortran => {
            let place = |(column, row)| column * size.height + row;
            (0..size.len()).map(|index| stored[place(size.position(index))]).collect()
        }
    };
    (size, values)
}

/// The bust that the paper uses.
pub fn mozart(data: &Path) -> Relief {
    let (size, heights) = read_npy_f32(&data.join("mozart/mozart256.npy"));
    Relief::new(size.width, size.height, heights).expect("a relief")
}

/// A measured light, by the number at the start of its row.
pub fn natural_light(data: &Path, index: usize) -> Light {
    let rows = read_csv(&data.join("lights/natural_lights_114.csv"));
    let row = rows.iter().find(|row| row.len() == 28 && row[0] == index as f64).expect("that light");
    Light::from_slice("light", &row[1..]).expect("a light")
}

/// Angles between the normals of two fields where both have one, degrees.
pub fn angles_between(a: &Normals, b: &Normals) -> Vec<f64> {
    let vector = |normals: &Normals, index| Vector3::from(normals.get(index).map(f64::from));
    let both = (0..a.len()).filter(|&index| a.is_valid(index) && b.is_valid(index));
    both.map(|index| vector(a, index).angle(&vector(b, index)).to_degrees()).collect()
}

/// A decoded PNG with values as stored: 0 .. 255 or 0 .. 65535.
pub struct Picture {
    pub size: Size,
    /// Number of channels: 1, 2, 3 or 4.
    pub channels: usize,
    /// Bits per channel: 8 or 16.
    pub bits: u32,
    /// Row-major, channels interleaved.
    pub values: Vec<u16>,
}

/// Reads an 8- or 16-bit PNG.
pub fn read_png(path: &Path) -> Picture {
    let file = BufReader::new(File::open(path).expect("the file is there"));
    let mut decoder = png::Decoder::new(file);
    decoder.set_transformations(png::Transformations::EXPAND);
    let mut reader = decoder.read_info().expect("PNG");
    let mut bytes = vec![0; reader.output_buffer_size().expect("a size that fits")];
    let frame = reader.next_frame(&mut bytes).expect("PNG");
    bytes.truncate(frame.buffer_size());
    let (bits, values) = match frame.bit_depth {
        png::BitDepth::Sixteen => {
            (16, bytes.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]])).collect())
        }
        _ => (8, bytes.into_iter().map(u16::from).collect()),
    };
    let size = Size { width: frame.width as usize, height: frame.height as usize };
    Picture { size, channels: frame.color_type.samples(), bits, values }
}

/// The comma-separated numbers of each line; words and lines without a number are skipped.
pub fn read_csv(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).expect("the file is there");
    let numbers = |line: &str| line.split(',').filter_map(|word| word.trim().parse().ok()).collect();
    text.lines().map(numbers).filter(|row: &Vec<f64>| !row.is_empty()).collect()
}

/// Mean of the values.
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Median of the values.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Writes an 8-bit RGB picture below the target folder and returns its path.
pub fn write_png(name: &str, size: Size, rgb: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    let file = BufWriter::new(File::create(&path).expect("the target folder can be written"));
    let mut encoder = png::Encoder::new(file, size.width as u32, size.height as u32);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header().and_then(|mut writer| writer.write_image_data(rgb)).expect("PNG");
    path
}

/// Linear colours as approximate 8-bit sRGB, for viewing.
pub fn colour_bytes(colours: &[f32]) -> Vec<u8> {
    colours.iter().map(|value| (255.0 * value.clamp(0.0, 1.0).powf(1.0 / 2.2)) as u8).collect()
}

/// Depth as grey, with the nearest in white and missing values in dark red.
pub fn depth_bytes(depth: &[f32]) -> Vec<u8> {
    let valid = || depth.iter().copied().filter(|value| !value.is_nan());
    let (near, far) = (valid().fold(f32::INFINITY, f32::min), valid().fold(f32::NEG_INFINITY, f32::max));
    let grey = |&value: &f32| {
        let shade = (255.0 - 215.0 * (value - near) / (far - near).max(f32::MIN_POSITIVE)) as u8;
        if value.is_nan() { [48, 0, 0] } else { [shade; 3] }
    };
    depth.iter().flat_map(grey).collect()
}

/// Normals as colours: red is x to the right, green y upward, blue toward the camera.
pub fn normal_bytes(normals: &Normals) -> Vec<u8> {
    let colour = |index| {
        let [x, y, z] = normals.get(index);
        [x, -y, -z].map(|part| (127.5 * (part + 1.0)) as u8)
    };
    (0..normals.len()).flat_map(colour).collect()
}

/// Pictures of one size side by side.
pub fn beside(size: Size, pictures: &[Vec<u8>]) -> (Size, Vec<u8>) {
    let rows = (0..size.height).flat_map(|row| {
        pictures.iter().flat_map(move |picture| picture[3 * size.width * row..3 * size.width * (row + 1)].to_vec())
    });
    (Size { width: size.width * pictures.len(), height: size.height }, rows.collect())
}
