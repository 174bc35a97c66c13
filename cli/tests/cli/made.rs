//! Files of a scene with a known answer, and runs of the program on them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use bimodal_stereo::scenes::{self, DepthData, Relief, Sample, SampleRequest};
use npyz::WriterBuilder;
use serde_json::Value;
use tempfile::TempDir;

/// Side of the views, pixels; with a known light the pose settles in few iterations.
pub const SIDE: usize = 48;

/// A folder with the files of one pair.
pub struct Made {
    pub folder: TempDir,
    pub sample: Sample,
}

impl Made {
    pub fn path(&self, name: &str) -> String {
        self.folder.path().join(name).to_str().unwrap().to_owned()
    }
}

/// The files of the bust.
pub fn bust() -> Made {
    made(&scenes::surface("bust").unwrap())
}

/// The files of a ball's half, whose pose is not observable.
pub fn ball() -> Made {
    let side = 64;
    let radius = 24.0_f32;
    let height = |at: usize| {
        let [x, y] = [at % side, at / side].map(|place| place as f32 - 31.5);
        (radius * radius - x * x - y * y).max(0.0).sqrt()
    };
    made(&Relief::new(side, side, (0..side * side).map(height).collect()).unwrap())
}

/// Writes image.png (16 bits, linear), depth.npy and light.csv.
fn made(relief: &Relief) -> Made {
    let size = bimodal_stereo::Size::new("size", SIDE, SIDE).unwrap();
    let request = SampleRequest { light: scenes::light("colourful").unwrap(), size, ..SampleRequest::default() };
    let sample = scenes::Scene::new(relief).unwrap().sample(&request).unwrap();
    let folder = TempDir::new().unwrap();
    write_image(&folder.path().join("image.png"), &sample);
    write_depth(&folder.path().join("depth.npy"), &sample);
    let light: Vec<String> = sample.light.flat().iter().map(f64::to_string).collect();
    fs::write(folder.path().join("light.csv"), light.join("\n")).unwrap();
    Made { folder, sample }
}

pub fn write_image(path: &Path, sample: &Sample) {
    let colours = &sample.image.colours;
    let brightest = colours.iter().fold(0.0_f32, |most, &value| most.max(value));
    let levels = colours.iter().flat_map(|value| ((60_000.0 * value / brightest) as u16).to_be_bytes());
    write_png(path, SIDE, png::ColorType::Rgb, png::BitDepth::Sixteen, &levels.collect::<Vec<u8>>());
}

pub fn write_depth(path: &Path, sample: &Sample) {
    let DepthData::Map(depth) = &sample.depth.data else { panic!("an orthographic view is a map") };
    let mut file = Vec::new();
    let options = npyz::WriteOptions::new().default_dtype().shape(&[SIDE as u64; 2]);
    let mut writer = options.writer(&mut file).begin_nd().unwrap();
    writer.extend(depth.iter().copied()).unwrap();
    writer.finish().unwrap();
    fs::write(path, file).unwrap();
}

pub fn write_png(path: &Path, width: usize, colour: png::ColorType, bits: png::BitDepth, data: &[u8]) {
    let bytes = colour.samples() * if bits == png::BitDepth::Sixteen { 2 } else { 1 };
    let mut encoder =
        png::Encoder::new(fs::File::create(path).unwrap(), width as u32, (data.len() / (width * bytes)) as u32);
    encoder.set_color(colour);
    encoder.set_depth(bits);
    encoder.write_header().unwrap().write_image_data(data).unwrap();
}

/// The result of a run of the program.
pub struct Ran {
    pub code: i32,
    pub out: String,
    pub err: String,
}

impl Ran {
    pub fn json(&self) -> Value {
        serde_json::from_str(&self.out).unwrap_or_else(|error| panic!("{error}: {}{}", self.out, self.err))
    }
}

pub fn run(arguments: &[&str]) -> Ran {
    let output = Command::new(env!("CARGO_BIN_EXE_bimodal-stereo")).args(arguments).output().unwrap();
    let Output { status, stdout, stderr } = output;
    let err = String::from_utf8(stderr).unwrap();
    assert!(!err.contains("panicked"), "{arguments:?}: {err}");
    Ran { code: status.code().expect("was not killed"), out: String::from_utf8(stdout).unwrap(), err }
}

/// Runs on the pair of a folder, from an initial pose near the answer with the light known.
pub fn run_pair(made: &Made, more: &[&str]) -> Ran {
    let [image, depth, light] = ["image.png", "depth.npy", "light.csv"].map(|name| made.path(name));
    run(&[&[image.as_str(), &depth, "--light", &light, "--start", "identity", "--scale", "1"], more].concat())
}

/// All files below a folder, by name.
pub fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

pub fn copied(from: &Made, name: &str, to: PathBuf) {
    fs::create_dir_all(to.parent().unwrap()).unwrap();
    fs::copy(from.path(name), to).unwrap();
}
