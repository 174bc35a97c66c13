//! Reads a colour image (PNG) and a depth map (16-bit PNG, or .npy of float32); finds the pose and the refined depth.
//!
//! cargo run --release --example files -- IMAGE.png DEPTH.png|DEPTH.npy [REFINED.npy]
//!
//! Both views are orthographic and the unit is the pixel; with `camera: Some(Pinhole { .. })` in either they are metric.

use std::error::Error;
use std::fs::File;
use std::io::{BufReader, BufWriter};

use bimodal_stereo::{
    Angles, ColourImage, ColourSamples, DepthMap, DepthSamples, Estimator, Options, Status, StepReport,
};
use npyz::WriterBuilder;

type Outcome<T> = Result<T, Box<dyn Error>>;

/// Width, height, colour type and samples of a PNG; 16-bit samples are kept in full.
fn read_png(path: &str) -> Outcome<(usize, usize, png::ColorType, png::BitDepth, Vec<u8>)> {
    let mut decoder = png::Decoder::new(BufReader::new(File::open(path)?));
    decoder.set_transformations(png::Transformations::ALPHA);
    let mut reader = decoder.read_info()?;
    let mut bytes = vec![0; reader.output_buffer_size().ok_or("it is too large")?];
    let frame = reader.next_frame(&mut bytes)?;
    bytes.truncate(frame.buffer_size());
    Ok((frame.width as usize, frame.height as usize, frame.color_type, frame.bit_depth, bytes))
}

/// PNG stores the higher byte first.
fn words(bytes: &[u8]) -> impl Iterator<Item = u16> + '_ {
    bytes.chunks_exact(2).map(|pair| u16::from_be_bytes([pair[0], pair[1]]))
}

fn read_image(path: &str) -> Outcome<ColourImage> {
    let (width, height, kind, bits, bytes) = read_png(path)?;
    if kind != png::ColorType::Rgba {
        return Err("it is grey, but the light is estimated from red, green and blue".into());
    }
    let samples = match bits {
        png::BitDepth::Sixteen => ColourSamples::Rgba16(words(&bytes).collect()),
        _ => ColourSamples::Rgba8(bytes),
    };
    Ok(ColourImage { width, height, samples, transfer: None, mask: None, camera: None })
}

fn read_depth(path: &str) -> Outcome<DepthMap> {
    let (width, height, samples) = if path.ends_with(".npy") {
        let file = npyz::NpyFile::new(BufReader::new(File::open(path)?))?;
        let (&[height, width], npyz::Order::C) = (file.shape(), file.order()) else {
            return Err("rows x columns in C order are needed".into());
        };
        (width as usize, height as usize, DepthSamples::Float(file.into_vec()?))
    } else {
        let (width, height, kind, bits, bytes) = read_png(path)?;
        if (kind, bits) != (png::ColorType::GrayscaleAlpha, png::BitDepth::Sixteen) {
            return Err("a depth map is grey and has 16 bits".into());
        }
        // Every second number is the alpha.
        (width, height, DepthSamples::Integer(words(&bytes).step_by(2).collect()))
    };
    Ok(DepthMap { width, height, samples, unit: None, mask: None, camera: None, normals: None })
}

fn write_depth(path: &str, [height, width]: [usize; 2], depth: &[f32]) -> Outcome<()> {
    let options = npyz::WriteOptions::new().default_dtype().shape(&[height as u64, width as u64]);
    let mut writer = options.writer(BufWriter::new(File::create(path)?)).begin_nd()?;
    writer.extend(depth.iter().copied())?;
    Ok(writer.finish()?)
}

fn print(report: &StepReport) {
    let Angles { alpha, beta, gamma } = Angles::of(&report.pose.rotation);
    println!("{} after {} iterations", report.status.name(), report.iteration);
    println!("s {:.4}, alpha {alpha:.2}, beta {beta:.2}, gamma {gamma:.2} degrees", report.pose.scale);
    println!("t {:.2?}", report.pose.translation.as_slice());
    if let Some(uncertainty) = &report.uncertainty {
        println!("one sigma about x, y, z: {:.2?} degrees", uncertainty.rotation_degrees);
    }
    if let Some(reason) = &report.reason {
        println!("{reason}");
    }
}

fn main() -> Outcome<()> {
    let paths: Vec<String> = std::env::args().skip(1).collect();
    let (image, depth, refined) = match paths.as_slice() {
        [image, depth] => (image, depth, None),
        [image, depth, refined] => (image, depth, Some(refined)),
        _ => return Err("needed: IMAGE.png DEPTH.png|DEPTH.npy [REFINED.npy]".into()),
    };
    let named = |path: &str, error: Box<dyn Error>| format!("{path}: {error}");
    let depth = read_depth(depth).map_err(|error| named(depth, error))?;
    let image = read_image(image).map_err(|error| named(image, error))?;

    let size = [depth.height, depth.width];
    let mut estimator = Estimator::new(image, &depth, Options::default())?;
    while estimator.report().status == Status::Running {
        estimator.step();
    }
    print(estimator.report());
    if let Some(path) = refined {
        write_depth(path, size, estimator.refined_depth()).map_err(|error| named(path, error))?;
    }
    Ok(())
}
