//! Rasters as the library's views, by the conventions of js/raster.ts and js/rig/depth.ts.

use std::path::Path;

use bimodal_stereo::{ColourImage, DepthMap, DepthSamples, Pinhole};
use bimodal_stereo_files::pairs::Files;
use bimodal_stereo_files::read::{self, Raster, Samples};
use bimodal_stereo_files::unit::{self, Sample, Unit};
use bimodal_stereo_files::{Problem, Result, Warning, colour, shown};

use crate::arguments::Arguments;
use crate::cameras::{Cameras, Sizes};

/// Both views, with notes and warnings on how they were read.
pub struct Views {
    pub image: ColourImage,
    pub depth: DepthMap,
    pub notes: Vec<String>,
    pub warnings: Vec<Warning>,
}

/// Notes and warnings about one file.
struct Said<'a> {
    path: &'a Path,
    notes: &'a mut Vec<String>,
    warnings: &'a mut Vec<Warning>,
}

impl Said<'_> {
    fn note(&mut self, words: impl AsRef<str>) {
        self.notes.push(format!("{}: {}", shown(self.path), words.as_ref()));
    }

    fn warn(&mut self, code: &'static str, words: impl AsRef<str>) {
        self.warnings.push(Warning::new(code, words.as_ref()).of_file(&shown(self.path)));
    }

    fn raster(&mut self, raster: &Raster) {
        raster.notes.iter().for_each(|note| self.note(note));
        let named = raster.warnings.iter().map(|warning| warning.of_file(&shown(self.path)));
        self.warnings.extend(named);
    }

    fn refuse<T>(&self, reason: &str) -> Result<T> {
        Err(Problem::file(self.path, reason))
    }
}

/// Reads the files of a pair. Cameras given as numbers take precedence over those of files.
pub fn read(files: &Files, arguments: &Arguments, cameras: &Cameras) -> Result<Views> {
    let (mut notes, mut warnings) = (Vec::new(), Vec::new());
    let mut said = Said { path: &files.image, notes: &mut notes, warnings: &mut warnings };
    let (mut image, rasters) = (image(arguments, &mut said)?, read::raster(&files.depth)?);
    let sizes = Sizes { image: [image.width, image.height], depth: [rasters.width, rasters.height] };
    let found = cameras.of_pair(files, sizes, said.notes, said.warnings)?;
    image.camera = arguments.image_camera.or(found.image);
    said.path = &files.depth;
    let mut depth = depth(rasters, arguments, arguments.depth_camera.or(found.depth), files.unit, &mut said)?;
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
                let words = format!("the mask is {width}x{height}, which is the size of neither view");
                warnings.push(Warning::new("mask-size", words).of_file(&shown(path)));
            }
        }
    }
    Ok(Views { image, depth, notes, warnings })
}

/// A colour image; floats are linear.
fn image(arguments: &Arguments, said: &mut Said) -> Result<ColourImage> {
    let raster = read::raster(said.path)?;
    said.raster(&raster);
    if colour::looks_like_depth(&raster) && !matches!(raster.samples, Samples::F32(_)) {
        said.warn(
            "files-swapped",
            "it looks like a depth map where a colour image was expected: were the files swapped?",
        );
    }
    Ok(ColourImage {
        width: raster.width,
        height: raster.height,
        samples: colour::colours(&raster),
        transfer: arguments.transfer.or(colour::transfer(&raster)),
        mask: None,
        camera: None,
    })
}

/// A depth map; a float array of three channels is an organised cloud.
fn depth(
    mut raster: Raster,
    arguments: &Arguments,
    camera: Option<Pinhole>,
    of_folder: Option<f64>,
    said: &mut Said,
) -> Result<DepthMap> {
    said.raster(&raster);
    // Metres have no meaning for a view measured in pixels.
    let given = arguments.depth_unit.or(camera.and(of_folder));
    if camera.is_none() && given.is_none() {
        said.note("depths are treated as pixels, because the depth map has no camera");
    }
    if let Samples::F32(data) = &mut raster.samples {
        let (data, has_unit) = (std::mem::take(data), camera.is_some());
        let (samples, unit) = match raster.channels {
            1 => float_depths(data, given, has_unit, said),
            3 => cloud(data, given, has_unit, said)?,
            count => return said.refuse(&format!("a depth map has 1 channel and a cloud 3, not {count}")),
        };
        return Ok(of(&raster, samples, unit, camera));
    }
    if raster.is_lossy {
        return said.refuse(
            "a JPEG cannot store depths: it has 8 bits and does not keep them exactly; use a 16-bit PNG or .npy",
        );
    }
    if !raster.is_grey() {
        let words = "a depth map has one value per pixel, but this picture is coloured; were the files swapped, or is it a rendering \
                     of the depth?";
        return said.refuse(words);
    }
    let data = raster.map_pixels(|pixel| pixel[0]);
    if data.iter().all(|&value| value == 0) {
        return said.refuse("it has no valid depth: all values are zero");
    }
    if camera.is_none() && given.is_none() && are_metric(&raster, &data, of_folder) {
        return Err(Problem::camera(said.path, METRIC));
    }
    if raster.bits <= 8 {
        said.warn(
            "eight-bits",
            "depths of 8 bits are coarse, and often a picture of the depth rather than the depth itself.",
        );
    }
    let (data, unit) = match camera {
        Some(_) => integer_depths(data, given, said),
        None => (data, given),
    };
    Ok(of(&raster, DepthSamples::Integer(data), unit, camera))
}

/// Message for depths that are not pixels.
const METRIC: &str = "its depths look like those of a depth camera, in millimetres, and there are no intrinsics that make points of them: \
                      name these by --cameras FILE or --depth-camera, or take the numbers for pixels by --depth-unit 1";

/// Whether whole numbers without unit and intrinsics are those of a depth camera rather than heights in pixels.
fn are_metric(raster: &Raster, data: &[u16], of_folder: Option<f64>) -> bool {
    let sample = Sample::of(data.iter().map(|&value| f64::from(value)));
    of_folder.is_some() || (raster.bits > 8 && sample.looks_like_millimetres())
}

fn of(raster: &Raster, samples: DepthSamples, unit: Option<f64>, camera: Option<Pinhole>) -> DepthMap {
    let (width, height) = (raster.width, raster.height);
    DepthMap { width, height, samples, unit, mask: None, camera, normals: None }
}

/// Whole numbers of a depth camera in metres.
fn integer_depths(mut data: Vec<u16>, given: Option<f64>, said: &mut Said) -> (Vec<u16>, Option<f64>) {
    if data.contains(&u16::MAX) {
        // 16-bit sensors store this number where they see nothing.
        data.iter_mut().filter(|value| **value == u16::MAX).for_each(|value| *value = 0);
        said.note("65535 treated as holes");
    }
    let sample = Sample::of(data.iter().map(|&value| f64::from(value)));
    if given.is_none() && sample.is_turned() {
        said.note(format!("depths read as {}", Unit::TURNED.says()));
        return (unit::turned_back(&data), Some(0.001));
    }
    let unit = chosen(given, || sample.unit_of_integers(), &sample, said);
    (data, Some(unit))
}

/// Converts floats; renderers write 1e10 where nothing was seen.
fn float_depths(
    mut data: Vec<f32>,
    given: Option<f64>,
    has_unit: bool,
    said: &mut Said,
) -> (DepthSamples, Option<f64>) {
    const BEYOND: f32 = 1e9;
    if !has_unit {
        return (DepthSamples::Float(data), given);
    }
    data.iter_mut().filter(|value| **value >= BEYOND).for_each(|value| *value = 0.0);
    let sample = Sample::of(data.iter().map(|&value| f64::from(value)));
    let unit = chosen(given, || sample.unit_of_floats(), &sample, said);
    (DepthSamples::Float(data), Some(unit))
}

/// An organised cloud.
fn cloud(data: Vec<f32>, given: Option<f64>, has_unit: bool, said: &mut Said) -> Result<(DepthSamples, Option<f64>)> {
    let depths: Vec<f64> = data.chunks_exact(3).map(|point| f64::from(point[2])).collect();
    let behind = depths.iter().filter(|&&depth| depth < 0.0).count();
    if 2 * behind > depths.len() {
        return said.refuse(
            "its points lie behind the camera (z is negative): rotate them so that z points forward and y down",
        );
    }
    let sample = Sample::of(depths.into_iter());
    let unit = if has_unit { Some(chosen(given, || sample.unit_of_floats(), &sample, said)) } else { given };
    Ok((DepthSamples::Cloud(data), unit))
}

/// The given or guessed unit, with a note if it was guessed.
fn chosen(given: Option<f64>, guess: impl Fn() -> Unit, sample: &Sample, said: &mut Said) -> f64 {
    let unit = given.map_or_else(guess, Unit::given);
    if unit.is_guessed {
        said.note(format!("depths read as {}; --depth-unit changes that", unit.says()));
    }
    if let Some(warning) = sample.warning(unit.metres) {
        said.warn("depth-range", warning);
    }
    unit.metres
}

fn mask_of_size(path: &Path, size: (usize, usize)) -> Result<Vec<u8>> {
    match mask(path)? {
        (found, mask) if found == size => Ok(mask),
        ((width, height), _) => {
            Err(Problem::file(path, format!("the mask is {width}x{height} pixels, its view {}x{}", size.0, size.1)))
        }
    }
}

/// Size and mask: pixels that are neither zero nor transparent belong to the object.
fn mask(path: &Path) -> Result<((usize, usize), Vec<u8>)> {
    let raster = read::raster(path)?;
    let mask = colour::mask(&raster);
    if mask.iter().all(|&inside| inside == 0) {
        return Err(Problem::file(path, "the mask is empty: no pixel belongs to the object"));
    }
    Ok(((raster.width, raster.height), mask))
}
