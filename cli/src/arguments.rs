//! The arguments of the command. Names and defaults are those of the library's options.

use std::path::PathBuf;

use bimodal_stereo::{Angles, Lens, LightSource, Options, Pinhole, Registration, Shading, Start, Transfer};
use bimodal_stereo_files::pairs::Files;
use bimodal_stereo_files::{Problem, Result, read};
use clap::Parser;

const USAGE: &str = "bimodal-stereo [estimate] [OPTIONS] IMAGE DEPTH
       bimodal-stereo [estimate] [OPTIONS] FOLDER
       bimodal-stereo check FOLDER --calibration FILE [OPTIONS]";

const AFTER: &str = "\
A folder holds pairs with similar names (rgb_1.png and depth_1.png, color/0001.jpg and depth/0001.png) and their masks, or TUM RGB-D's
rgb.txt and depth.txt. Each pair is reported in one line of text or JSON.

The intrinsics are those of --image-camera and --depth-camera, else of --cameras, else of files beside the images that are called
calib, camera, intrinsics or K. If NAME_loc.txt lies beside NAME_crop.png, the camera is that of the whole frame.

`bimodal-stereo check --help` is the manual of the check of a rig's calibration.

Exit code: 0 converged, 1 lost or ambiguous, 2 undecided (the cap on iterations came first), 3 the input is bad. A folder has the worst
code of its pairs, in the order 3, 1, 2, 0.

The pose maps depth points into the colour view: P_colour = s R P_depth + t, R = Rx(alpha) Ry(beta) Rz(gamma); x right, y down, z
forward. A view without a camera is orthographic and measured in pixels, one with a camera in metres.";

/// Finds the pose between a colour image and a depth map of the same object, taken from different places.
#[derive(Debug, Parser)]
#[command(name = "bimodal-stereo", version, override_usage = USAGE, after_help = AFTER, max_term_width = 132)]
pub struct Arguments {
    /// A colour image (PNG, JPEG, .npy) and a depth map (PNG of 16 bits, .npy), or a folder of such pairs
    #[arg(required = true, num_args = 1..=2, value_names = ["IMAGE|FOLDER", "DEPTH"])]
    input: Vec<PathBuf>,

    /// Writes clouds (PLY), refined depth (16-bit PNG and .npy), pose, light and report into FOLDER, which is created
    #[arg(long, value_name = "FOLDER")]
    pub out: Option<PathBuf>,

    /// Prints the report as JSON with the names of the JavaScript package, one line for each pair of a folder
    #[arg(long)]
    pub json: bool,

    /// Intrinsics of the colour camera in pixels: fx,fy,cx,cy and, if needed, OpenCV's k1,k2,p1,p2,k3[,k4,k5,k6]
    #[arg(long, value_name = "FX,FY,CX,CY[,K1..]", value_parser = camera)]
    pub image_camera: Option<Pinhole>,

    /// Intrinsics of the depth camera
    #[arg(long, value_name = "FX,FY,CX,CY[,K1..]", value_parser = camera)]
    pub depth_camera: Option<Pinhole>,

    /// Intrinsics of one or both cameras in a file of OpenCV, ROS, Kalibr, Open3D and others [default: those beside the
    /// images]
    #[arg(long, value_name = "FILE")]
    pub cameras: Vec<PathBuf>,

    /// Unit of the depth map's numbers, in metres (0.001 for millimetres), or in pixels if it has no camera [default:
    /// guessed, or 1 without a camera]
    #[arg(long, value_name = "UNIT", value_parser = positive)]
    pub depth_unit: Option<f64>,

    /// A picture of the image's size: pixels that are neither black nor transparent belong to the object
    #[arg(long, value_name = "FILE")]
    image_mask: Option<PathBuf>,

    /// A picture of the depth map's size that marks the object in the same way
    #[arg(long, value_name = "FILE")]
    depth_mask: Option<PathBuf>,

    /// How the image's numbers encode intensity: srgb or linear [default: as the file states, else guessed]
    #[arg(long, value_name = "CURVE", value_parser = transfer)]
    pub transfer: Option<Transfer>,

    /// Initial pose: search (everywhere), identity, or ALPHA,BETA,GAMMA in degrees
    #[arg(long, value_name = "START", default_value = "search", value_parser = start, allow_hyphen_values = true)]
    start: Start,

    /// A known light: a text of 27 numbers, nine for each of R, G, B, such as the light.csv that --out writes
    #[arg(long, value_name = "FILE")]
    light: Option<PathBuf>,

    /// If the light is estimated, a prior over lights that replaces the one over natural lights: JSON with "mean", 27
    /// numbers, and "covariance", 27x27 numbers
    #[arg(long, value_name = "FILE", conflicts_with = "light")]
    light_prior: Option<PathBuf>,

    /// Holds the scale s at this number [default: estimated]
    #[arg(long, value_name = "S", value_parser = positive)]
    scale: Option<f64>,

    /// How the pose is refined: joint (directly from the image), icp (as in the paper) or fixed (the initial pose is
    /// kept)
    #[arg(long, value_name = "WAY", default_value = "joint", value_parser = registration)]
    registration: Registration,

    /// How the shape of the image is found: surface (as a whole) or pixel (each pixel by itself, as in the paper)
    #[arg(long, value_name = "WAY", default_value = "surface", value_parser = shading)]
    shading: Shading,

    /// The largest sigma of the rotation at which a run converges, in degrees; above it the pose is ambiguous
    #[arg(long, value_name = "DEGREES", default_value_t = Options::default().tolerance, value_parser = positive)]
    tolerance: f64,

    /// Ends after this many iterations
    #[arg(long, value_name = "N", default_value_t = Options::default().max_iterations)]
    pub max_iterations: u32,

    /// Threads that share the work; the answer does not depend on their number [default: one for each processor]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..))]
    workers: Option<u16>,

    /// Seed of all random numbers
    #[arg(long, value_name = "N", default_value_t = Options::default().seed)]
    seed: u64,
}

/// The input: one pair of files, or a folder of pairs.
pub enum Input {
    Pair(Files),
    Folder(PathBuf),
}

impl Arguments {
    /// A pair or a folder, which contains its masks.
    pub fn input(&self) -> Result<Input> {
        match self.input.as_slice() {
            [folder] if folder.is_dir() => {
                if self.image_mask.is_some() || self.depth_mask.is_some() {
                    return Err(Problem::option(
                        "--image-mask, --depth-mask",
                        "belong to one pair; the masks of a folder are in the folder",
                    ));
                }
                Ok(Input::Folder(folder.clone()))
            }
            [one] if one.exists() => {
                Err(Problem::file(one, "is not a folder; a pair needs both an image and a depth map"))
            }
            [one] => Err(Problem::file(one, "there is no such folder")),
            [image, depth, ..] => Ok(Input::Pair(Files {
                image: image.clone(),
                depth: depth.clone(),
                image_mask: self.image_mask.clone(),
                depth_mask: self.depth_mask.clone(),
                any_mask: None,
                unit: None,
            })),
            [] => Err(Problem::option("IMAGE", "is needed")),
        }
    }

    /// Number of threads that share the work.
    pub fn workers(&self) -> usize {
        let processors = || std::thread::available_parallelism().map_or(1, usize::from);
        self.workers.map_or_else(processors, usize::from)
    }

    /// The options of the loop.
    pub fn options(&self) -> Result<Options> {
        let light = match &self.light {
            Some(path) => LightSource::Known(read::light(path)?),
            None => LightSource::Estimate,
        };
        Ok(Options {
            light,
            prior: self.light_prior.as_deref().map(read::light_prior).transpose()?,
            start: self.start,
            scale: self.scale,
            registration: self.registration,
            shading: self.shading,
            tolerance: self.tolerance,
            max_iterations: self.max_iterations,
            seed: self.seed,
            ..Options::default()
        })
    }
}

fn numbers(text: &str) -> std::result::Result<Vec<f64>, String> {
    text.split(',').map(|part| part.trim().parse().map_err(|_| format!("{part:?} is not a number"))).collect()
}

fn camera(text: &str) -> std::result::Result<Pinhole, String> {
    let numbers = numbers(text)?;
    let (&[fx, fy, cx, cy], lens) = numbers.split_first_chunk().ok_or("needs fx,fy,cx,cy")?;
    if !matches!(lens.len(), 0..=5 | 8) {
        return Err("needs fx,fy,cx,cy, and after them up to k1,k2,p1,p2,k3, or all of k1,k2,p1,p2,k3,k4,k5,k6".into());
    }
    let mut coefficients = [0.0; 8];
    coefficients[..lens.len()].copy_from_slice(lens);
    let lens = Lens::brown(&coefficients).map_err(|error| error.to_string())?;
    let camera = Pinhole { fx, fy, cx, cy, lens };
    camera.validate("camera").map_err(|error| error.to_string())?;
    Ok(camera)
}

fn positive(text: &str) -> std::result::Result<f64, String> {
    match text.parse() {
        Ok(number) if f64::is_finite(number) && number > 0.0 => Ok(number),
        _ => Err("needs a number above zero".into()),
    }
}

fn transfer(text: &str) -> std::result::Result<Transfer, String> {
    match text {
        "srgb" => Ok(Transfer::Srgb),
        "linear" => Ok(Transfer::Linear),
        _ => Err("must be srgb or linear".into()),
    }
}

fn start(text: &str) -> std::result::Result<Start, String> {
    match text {
        "search" => Ok(Start::Search),
        "identity" => Ok(Start::Identity),
        _ => match numbers(text).as_deref() {
            Ok(&[alpha, beta, gamma]) if [alpha, beta, gamma].iter().all(|angle| angle.is_finite()) => {
                let rotation = Angles { alpha, beta, gamma }.rotation();
                Ok(Start::Pose { rotation, scale: None, translation: None })
            }
            _ => Err("must be search, identity or three angles in degrees".into()),
        },
    }
}

fn registration(text: &str) -> std::result::Result<Registration, String> {
    match text {
        "joint" => Ok(Registration::Joint),
        "icp" => Ok(Registration::Icp),
        "fixed" => Ok(Registration::Fixed),
        _ => Err("must be joint, icp or fixed".into()),
    }
}

fn shading(text: &str) -> std::result::Result<Shading, String> {
    match text {
        "surface" => Ok(Shading::Surface),
        "pixel" => Ok(Shading::Pixel),
        _ => Err("must be surface or pixel".into()),
    }
}
