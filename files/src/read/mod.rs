//! Files as rasters: PNG and JPEG through `image`, `.npy` by the module `npy`. The first bytes of a file give its kind.

pub mod foreign;
mod npy;
mod picture;
mod raster;

use std::fs::File;
use std::io::Read;
use std::path::Path;

use bimodal_stereo::{Light, LightGaussian, LightPrior};

use crate::problem::{Problem, Result};
pub use npy::bytes as npy_bytes;
pub use raster::{MOST_SIDE, Raster, Samples};

/// Largest file, as in js/rig/formats/limits.ts; it also bounds what is read from a device such as /dev/zero.
const MOST_BYTES: u64 = 64 << 20;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    Png,
    Jpeg,
    Npy,
}

/// The kind of a file by its first bytes.
pub fn kind_of(bytes: &[u8]) -> Option<Kind> {
    let first: [(&[u8], Kind); 3] =
        [(b"\x89PNG\r\n\x1a\n", Kind::Png), (b"\xff\xd8\xff", Kind::Jpeg), (b"\x93NUMPY", Kind::Npy)];
    first.into_iter().find(|(start, _)| bytes.starts_with(start)).map(|(_, kind)| kind)
}

/// Up to `most` bytes of a file.
pub fn head(path: &Path, most: u64) -> std::io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    File::open(path)?.take(most).read_to_end(&mut bytes)?;
    Ok(bytes)
}

pub fn whole(path: &Path) -> Result<Vec<u8>> {
    let bytes = head(path, MOST_BYTES + 1).map_err(|error| Problem::file(path, error))?;
    match bytes.len() as u64 {
        0 => Err(Problem::file(path, "it is empty")),
        length if length > MOST_BYTES => {
            Err(Problem::file(path, format!("it is larger than {} MB, the limit", MOST_BYTES >> 20)))
        }
        _ => Ok(bytes),
    }
}

/// Reads a picture or an array from a file.
pub fn raster(path: &Path) -> Result<Raster> {
    decoded(&whole(path)?).map_err(|reason| Problem::file(path, reason))
}

/// Decodes the bytes of a picture or an array. The error is the reason why they are not read.
pub fn decoded(bytes: &[u8]) -> std::result::Result<Raster, String> {
    match kind_of(bytes) {
        Some(Kind::Png) => picture::png(bytes),
        Some(Kind::Jpeg) => picture::jpeg(bytes),
        Some(Kind::Npy) => npy::read(bytes),
        None => Err(format!("it is neither a PNG nor a JPEG nor a .npy file: {}", foreign::describe(bytes))),
    }
}

/// Reads 27 numbers from a text. Everything between them is ignored, such as names of channels and coefficients.
pub fn light(path: &Path) -> Result<Light> {
    /// Largest size of a light's file, bytes; usual files have half a kilobyte.
    const MOST_TEXT: u64 = 1 << 16;
    let bytes = head(path, MOST_TEXT).map_err(|error| Problem::file(path, error))?;
    let text = String::from_utf8(bytes).map_err(|_| Problem::file(path, "it is not text"))?;
    let numbers: Vec<f64> = text
        .split(|letter: char| letter.is_whitespace() || ",;[]".contains(letter))
        .filter_map(|word| word.parse().ok())
        .collect();
    let light = Light::from_slice("light", &numbers).map_err(|error| Problem::file(path, error))?;
    light.validate("light").map_err(|error| Problem::file(path, error))?;
    Ok(light)
}

/// A Gaussian over lights from JSON. Other members, such as its source, are ignored.
pub fn light_prior(path: &Path) -> Result<LightGaussian> {
    /// Largest size of a prior's file, bytes; that of the crate's default prior has ten kilobytes.
    const MOST_TEXT: u64 = 1 << 20;
    let bytes = head(path, MOST_TEXT).map_err(|error| Problem::file(path, error))?;
    let mut file: serde_json::Value = serde_json::from_slice(&bytes).map_err(|error| Problem::file(path, error))?;
    // Other members, such as the source of the numbers, are ignored.
    if let Some(members) = file.as_object_mut() {
        members.retain(|name, _| ["mean", "covariance"].contains(&name.as_str()));
    }
    let prior: LightGaussian = serde_json::from_value(file).map_err(|error| Problem::file(path, error))?;
    LightPrior::from_slices(&prior.mean, &prior.covariance).map_err(|error| Problem::file(path, error))?;
    Ok(prior)
}
