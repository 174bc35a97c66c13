//! The native half of `npm run bench`: answers requests line by line, so that its runs alternate with those of the
//! browser and a busy machine slows both equally.
//!
//! `scene PATH` reads a scene, `run START SHADING MOST` runs the loop from "near" or "search" with "surface" or "pixel"
//! through at most MOST iterations; each answer is one line of JSON. Without the argument `requests`, as in a plain
//! `cargo bench`, it does nothing, since there are no requests.

mod common;

use std::error::Error;
use std::fmt::Write as _;
use std::io::{BufRead, Write as _, stdin, stdout};

use bimodal_stereo::{ColourImage, ColourSamples, DepthMap, DepthSamples, Shading, Similarity, Stage, Start};
use common::{Run, Scene, Timed, near};
use nalgebra::{Matrix3, Vector3};

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Number of values of a pose in a scene's file: s, R row by row, t.
const POSE: usize = 13;

fn main() -> Outcome<()> {
    if !std::env::args().any(|word| word == "requests") {
        return Ok(());
    }
    let mut scene = None;
    for line in stdin().lock().lines() {
        let line = line?;
        let words: Vec<&str> = line.split(' ').collect();
        let answer = match (words[..].split_first(), &scene) {
            (Some((&"scene", [path])), _) => {
                scene = Some(read(path)?);
                "{}".into()
            }
            (Some((&"run", [start, shading, most])), Some(scene)) => {
                let start = if *start == "search" { Start::Search } else { near(scene) };
                let shading = if *shading == "pixel" { Shading::Pixel } else { Shading::Surface };
                json(&common::run(scene, start, shading, most.parse()?)?)?
            }
            _ => return Err(format!("no request: {line:?}").into()),
        };
        writeln!(stdout(), "{answer}")?;
        stdout().flush()?;
    }
    Ok(())
}

fn json(run: &Run) -> Outcome<String> {
    let Run { stages, status, iterations, degrees, milliseconds, preparation } = run;
    let slices = stages.iter().filter(|timed| timed.stage == Stage::Search).map(|timed| timed.milliseconds);
    let slice = slices.fold(0.0, f64::max);
    let mut list = String::new();
    for Timed { stage, iteration, milliseconds } in stages {
        let comma = if list.is_empty() { "" } else { "," };
        let stage = stage.name();
        write!(list, r#"{comma}{{"stage":"{stage}","iteration":{iteration},"milliseconds":{milliseconds}}}"#)?;
    }
    let status = status.name();
    let times = format!(r#""milliseconds":{milliseconds},"preparation":{preparation},"longestSlice":{slice}"#);
    Ok(format!(r#"{{"status":"{status}","iterations":{iterations},"degrees":{degrees},{times},"stages":[{list}]}}"#))
}

/// Little-endian: width and height (u32), the pose (f64), linear RGB and depth (f32, NaN off the masks).
fn read(path: &str) -> Outcome<Scene> {
    let bytes = std::fs::read(path)?;
    let side = |at: usize| u32::from_le_bytes(bytes[4 * at..4 * at + 4].try_into().expect("four bytes")) as usize;
    let (width, height) = (side(0), side(1));
    let (pose, views) = bytes[8..].split_at(8 * POSE);
    let pose: Vec<f64> =
        pose.chunks_exact(8).map(|chunk| f64::from_le_bytes(chunk.try_into().expect("eight bytes"))).collect();
    let views: Vec<f32> =
        views.chunks_exact(4).map(|chunk| f32::from_le_bytes(chunk.try_into().expect("four bytes"))).collect();
    let (colours, depth) = views.split_at(3 * width * height);
    let inside = |value: &f32| u8::from(!value.is_nan());
    Ok(Scene {
        image: ColourImage {
            width,
            height,
            mask: Some(colours.chunks_exact(3).map(|colour| inside(&colour[0])).collect()),
            samples: ColourSamples::RgbLinear(colours.to_vec()),
            transfer: None,
            camera: None,
        },
        depth: DepthMap {
            width,
            height,
            mask: Some(depth.iter().map(inside).collect()),
            samples: DepthSamples::Float(depth.to_vec()),
            unit: None,
            camera: None,
            normals: None,
        },
        pose: Similarity {
            scale: pose[0],
            rotation: Matrix3::from_row_slice(&pose[1..10]),
            translation: Vector3::from_row_slice(&pose[10..]),
        },
    })
}
