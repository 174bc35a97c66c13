//! Rasters as the views that the library takes, by the conventions of js/raster.ts and js/rig/depth.ts.

use std::path::Path;

use bimodal_stereo::{ColourImage, ColourSamples, DepthMap, DepthSamples, Pinhole, Transfer};

use crate::arguments::Arguments;
use crate::files::Files;
use crate::problem::{Problem, Result, shown};
use crate::read::{self, Raster, Samples};
use crate::unit::{self, Sample, Unit};

/// Both views, and what is to be said about how they were read.
pub struct Views {
    pub image: ColourImage,
    pub depth: DepthMap,
    pub notes: Vec<String>,
    pub warnings: Vec<String>,
}

/// What is said of one file.
struct Said<'a> {
    path: &'a Path,
    notes: &'a mut Vec<String>,
    warnings: &'a mut Vec<String>,
}

impl Said<'_> {
    fn note(&mut self, words: impl AsRef<str>) {
        self.notes.push(format!("{}: {}", shown(self.path), words.as_ref()));
    }

    fn warn(&mut self, words: impl AsRef<str>) {
        self.warnings.push(format!("{}: {}", shown(self.path), words.as_ref()));
    }

    fn raster(&mut self, raster: &Raster) {
        raster.notes.iter().for_each(|note| self.note(note));
        raster.warnings.iter().for_each(|warning| self.warn(warning));
    }

    fn refuse<T>(&self, reason: &str) -> Result<T> {
        Err(Problem::file(self.path, reason))
    }
}

/// Reads the files of a pair.
pub fn read(files: &Files, arguments: &Arguments) -> Result<Views> {
    let (mut notes, mut warnings) = (Vec::new(), Vec::new());
    let mut said = Said { path: &files.image, notes: &mut notes, warnings: &mut warnings };
    let mut image = image(arguments, &mut said)?;
    said.path = &files.depth;
    let mut depth = depth(arguments, files.unit, &mut said)?;
    let (image_size, depth_size) = ((image.width, image.height), (depth.width, depth.height));
    if let Some(path) = &files.image_mask {
        image.mask = Some(mask_of_size(path, image_size)?);
    }
    if let Some(path) = &files.depth_mask {
        depth.mask = Some(mask_of_size(path, depth_size)?);
    }
    if let Some(path) = &files.any_mask {
        match mask(path)? {
            (size, mask) if size == image_size => image.mask = Some(mask),
            (size, mask) if size == depth_size => depth.mask = Some(mask),
            ((width, height), _) => {
                warnings
                    .push(format!("{}: the mask is {width}x{height}, which is the size of neither view", shown(path)));
            }
        }
    }
    Ok(Views { image, depth, notes, warnings })
}

/// A colour image; floats are linear.
fn image(arguments: &Arguments, said: &mut Said) -> Result<ColourImage> {
    let raster = read::raster(said.path)?;
    said.raster(&raster);
    if raster.bits > 8 && raster.channels != 4 && raster.is_grey() && !matches!(raster.samples, Samples::F32(_)) {
        said.warn("it looks like a depth map where a colour image was asked for: were the files swapped?");
    }
    let colour = |data: &[u16], channel: usize| data[if raster.has_colour() { channel } else { 0 }];
    let rgba = |opaque: u16| {
        raster.map_pixels(|pixel| {
            let alpha = if raster.has_alpha() { pixel[pixel.len() - 1] } else { opaque };
            [colour(pixel, 0), colour(pixel, 1), colour(pixel, 2), alpha]
        })
    };
    let samples = match &raster.samples {
        Samples::U8(_) => ColourSamples::Rgba8(rgba(255).into_iter().flatten().map(|level| level as u8).collect()),
        Samples::U16(_) => ColourSamples::Rgba16(rgba(u16::MAX).into_iter().flatten().collect()),
        Samples::F32(data) => {
            let pick = |pixel: &[f32]| [0, 1, 2].map(|channel| pixel[if raster.has_colour() { channel } else { 0 }]);
            ColourSamples::RgbLinear(data.chunks_exact(raster.channels).flat_map(pick).collect())
        }
    };
    let of_file = raster.linear.map(|linear| if linear { Transfer::Linear } else { Transfer::Srgb });
    let camera = arguments.image_camera;
    let transfer = arguments.transfer.or(of_file);
    Ok(ColourImage { width: raster.width, height: raster.height, samples, transfer, mask: None, camera })
}

/// A depth map; a float array of three channels is an organised cloud.
fn depth(arguments: &Arguments, of_folder: Option<f64>, said: &mut Said) -> Result<DepthMap> {
    let mut raster = read::raster(said.path)?;
    said.raster(&raster);
    let camera = arguments.depth_camera;
    // Metres are nothing to a view that is measured in pixels.
    let told = arguments.depth_unit.or(camera.and(of_folder));
    if camera.is_none() && told.is_none() {
        said.note("depths are taken for pixels, as there is no --depth-camera");
    }
    if let Samples::F32(data) = &mut raster.samples {
        let (data, has_unit) = (std::mem::take(data), camera.is_some());
        let (samples, unit) = match raster.channels {
            1 => float_depths(data, told, has_unit, said),
            3 => cloud(data, told, has_unit, said)?,
            count => return said.refuse(&format!("a depth map has 1 channel and a cloud 3, not {count}")),
        };
        return Ok(of(&raster, samples, unit, camera));
    }
    if raster.is_lossy {
        return said
            .refuse("a JPEG keeps no depths: it has 8 bits, and not even these exactly; use a PNG of 16 bits or .npy");
    }
    if !raster.is_grey() {
        let words = "a depth map has one value for each pixel, and this picture is coloured; were the files swapped, or is it a rendering \
                     of the depth?";
        return said.refuse(words);
    }
    let data = raster.map_pixels(|pixel| pixel[0]);
    if data.iter().all(|&value| value == 0) {
        return said.refuse("no pixel of it holds a depth: all are zero");
    }
    if raster.bits <= 8 {
        said.warn("depths of 8 bits are coarse, and often a picture of the depth, not the depth.");
    }
    let (data, unit) = match camera {
        Some(_) => integer_depths(data, told, said),
        None => (data, told),
    };
    Ok(of(&raster, DepthSamples::Integer(data), unit, camera))
}

fn of(raster: &Raster, samples: DepthSamples, unit: Option<f64>, camera: Option<Pinhole>) -> DepthMap {
    let (width, height) = (raster.width, raster.height);
    DepthMap { width, height, samples, unit, mask: None, camera, normals: None }
}

/// Whole numbers of a depth camera in metres.
fn integer_depths(mut data: Vec<u16>, told: Option<f64>, said: &mut Said) -> (Vec<u16>, Option<f64>) {
    if data.contains(&u16::MAX) {
        // What a 16-bit sensor says where it is blind.
        data.iter_mut().filter(|value| **value == u16::MAX).for_each(|value| *value = 0);
        said.note("65535 taken for holes");
    }
    let sample = Sample::of(data.iter().map(|&value| f64::from(value)));
    if told.is_none() && sample.is_turned() {
        said.note("depths read as millimetres with their bits turned by three (SUN RGB-D; guessed)");
        return (unit::turned_back(&data), Some(0.001));
    }
    let unit = chosen(told, || sample.unit_of_integers(), &sample, said);
    (data, Some(unit))
}

/// Floats; renderers write 1e10 where they saw nothing.
fn float_depths(mut data: Vec<f32>, told: Option<f64>, has_unit: bool, said: &mut Said) -> (DepthSamples, Option<f64>) {
    const BEYOND: f32 = 1e9;
    if !has_unit {
        return (DepthSamples::Float(data), told);
    }
    data.iter_mut().filter(|value| **value >= BEYOND).for_each(|value| *value = 0.0);
    let sample = Sample::of(data.iter().map(|&value| f64::from(value)));
    let unit = chosen(told, || sample.unit_of_floats(), &sample, said);
    (DepthSamples::Float(data), Some(unit))
}

/// An organised cloud.
fn cloud(data: Vec<f32>, told: Option<f64>, has_unit: bool, said: &mut Said) -> Result<(DepthSamples, Option<f64>)> {
    let depths: Vec<f64> = data.chunks_exact(3).map(|point| f64::from(point[2])).collect();
    let behind = depths.iter().filter(|&&depth| depth < 0.0).count();
    if 2 * behind > depths.len() {
        return said
            .refuse("its points lie behind the camera (z is negative): turn them so that z looks forward, y down");
    }
    let sample = Sample::of(depths.into_iter());
    let unit = if has_unit { Some(chosen(told, || sample.unit_of_floats(), &sample, said)) } else { told };
    Ok((DepthSamples::Cloud(data), unit))
}

/// The unit that was told, or guessed, and what is to be said of it.
fn chosen(told: Option<f64>, guess: impl Fn() -> Unit, sample: &Sample, said: &mut Said) -> f64 {
    let unit = told.unwrap_or_else(|| {
        let Unit { metres, says } = guess();
        said.note(format!("depths read as {says} (guessed; --depth-unit says it)"));
        metres
    });
    if let Some(warning) = sample.warning(unit) {
        said.warn(warning);
    }
    unit
}

fn mask_of_size(path: &Path, size: (usize, usize)) -> Result<Vec<u8>> {
    match mask(path)? {
        (found, mask) if found == size => Ok(mask),
        ((width, height), _) => {
            Err(Problem::file(path, format!("the mask is {width}x{height} pixels, its view {}x{}", size.0, size.1)))
        }
    }
}

/// Size and mask: whatever is neither zero nor transparent belongs to the object.
fn mask(path: &Path) -> Result<((usize, usize), Vec<u8>)> {
    let raster = read::raster(path)?;
    let half = if raster.bits == 8 { 0x80 } else { 0x8000 };
    let visible = if raster.has_colour() { 3 } else { 1 };
    let is_float = matches!(raster.samples, Samples::F32(_));
    let mask: Vec<u8> = raster.map_pixels(|pixel| {
        let is_lit = pixel[..visible].iter().any(|&level| level > 0);
        let is_opaque = is_float || !raster.has_alpha() || pixel[pixel.len() - 1] >= half;
        u8::from(is_lit && is_opaque)
    });
    if mask.iter().all(|&inside| inside == 0) {
        return Err(Problem::file(path, "the mask is empty: no pixel belongs to the object"));
    }
    Ok(((raster.width, raster.height), mask))
}
