//! Whole folders of a rig: frames with their cameras, and the poses between these, read like js/rig/folder.ts.
//!
//! If a file cannot be read, its frame is left out, a warning names it, and the rest of the folder is read. Limit:
//! names must say which pictures are depth maps.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use bimodal_stereo::{DepthSamples, RigView};

use crate::assign::assigned;
use crate::colour;
use crate::depth::depth_of;
use crate::pairs::{self, Pair, Pairs, base, key, name_in};
use crate::problem::{Problem, Result, shown};
use crate::read::{self, foreign, kind_of};
use crate::text::names::{Pattern, pattern};
use crate::text::numbers::shown as number;
use crate::text::{self, Calibration, NamedCamera, NamedPose, words};
use crate::warning::{Warning, Warnings};

/// Number of pairs that are read by default.
const FRAMES: usize = 20;
/// Largest number of bytes in a folder, since most files are read: enough for some hundreds of pairs.
const MOST_BYTES: u64 = 2 << 30;
/// Number of first bytes, which identify pictures.
const HEAD: u64 = 512;

static IGNORED: Pattern = Pattern::new(|| {
    pattern(
        r"(?i)(^|/)(\.|__MACOSX|thumbs\.db|readme|licen[cs]e|copying|source\.txt|changelog)|\.(md|html?|py|mjs|js|csv|bag|mp4|avi|klg)$",
    )
});
static LISTS: Pattern = Pattern::new(|| {
    pattern(r"(?i)(^|/)(rgb|depth|associat[A-Za-z0-9_]*|accelerometer|groundtruth|times?(tamps)?)\.(txt|csv)$")
});
static POSE: Pattern = Pattern::new(|| pattern("(?i)pose"));

/// Record of a file that was read.
#[derive(Clone, Debug, PartialEq)]
pub struct Reading {
    /// The name as given, or relative to the folder.
    pub name: String,
    pub path: PathBuf,
    /// A description in words.
    pub says: String,
}

/// Options for reading a folder.
#[derive(Clone, Debug, Default)]
pub struct FolderOptions {
    /// Metres for each stored number of all depth maps.
    pub unit: Option<f64>,
    /// Largest number of pairs, which are evenly spread; `None` means 20.
    pub frames: Option<usize>,
    /// Files of intrinsics, which take precedence over those in the folder.
    pub cameras: Vec<PathBuf>,
    /// Files in the folder that are not read.
    pub except: Vec<PathBuf>,
}

/// The frames of a folder and the other content of its files. The cameras are those of the files, shared by all frames.
#[derive(Clone, Debug)]
pub struct RigFolder {
    pub frames: Vec<RigView>,
    pub cameras: Vec<NamedCamera>,
    pub poses: Vec<NamedPose>,
    /// Records of the files that were read, in the folder's order.
    pub readings: Vec<Reading>,
    pub warnings: Vec<Warning>,
}

/// The cameras and poses of one file.
///
/// # Errors
/// With the file and the reason, if it is not a text or holds no camera and no pose.
pub fn read_calibration(path: &Path) -> Result<Calibration> {
    let bytes = read::whole(path)?;
    let found = match text::text_of(&bytes) {
        Some(_) if is_raster(&bytes) => Err("it is a picture where cameras or poses were expected".into()),
        Some(text) => text::read_text(&text, &path.to_string_lossy()),
        None => Err(foreign::describe(&bytes)),
    };
    found.map_err(|reason| Problem::file(path, reason))
}

/// The columns and rows cropped at the left and top of a picture, from a file "NAME_loc.txt" beside "NAME_crop.png", as
/// in the RGB-D Object Dataset: "x,y" of the crop's first pixel in the whole frame, counted from one.
///
/// # Errors
/// If such a file does not hold two numbers.
pub fn read_corner(picture: &Path) -> Result<Option<[f64; 2]>> {
    static CROP: Pattern = Pattern::new(|| pattern("(?i)_(depth|mask)?crop$"));
    let stem = picture.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let Some(crop) = CROP.find(&stem) else { return Ok(None) };
    let path = picture.with_file_name(format!("{}_loc.txt", &stem[..crop.start()]));
    if !path.is_file() {
        return Ok(None);
    }
    let text = text::text_of(&read::whole(&path)?).unwrap_or_default();
    let numbers: Option<Vec<f64>> =
        text::numbers::words_of_numbers(&text).take(3).map(text::numbers::number_in).collect();
    match numbers.as_deref() {
        Some(&[x, y]) if x >= 1.0 && y >= 1.0 => Ok(Some([x - 1.0, y - 1.0])),
        _ => Err(Problem::file(&path, "it does not give the place of a crop: two numbers, counted from 1, are needed")),
    }
}

/// Name in reports of a file given by its path.
pub fn given_name(path: &Path) -> String {
    let name = shown(path).replace('\\', "/");
    name.strip_prefix("./").map_or_else(|| name.clone(), Into::into)
}

/// Assigns cameras to the frames of a folder.
fn add_cameras(folder: &mut RigFolder) {
    let Some(first) = folder.frames.first() else { return };
    if folder.cameras.is_empty() {
        return;
    }
    let is_cloud = matches!(first.depth, DepthSamples::Cloud(_));
    let sizes = [first.image_size, first.depth_size];
    let [colour, range] = assigned(&folder.cameras, sizes, is_cloud, &mut folder.warnings)
        .map(|index| index.map(|index| folder.cameras[index].camera));
    for frame in &mut folder.frames {
        (frame.image_camera, frame.depth_camera) = (colour, range);
    }
}

fn is_raster(bytes: &[u8]) -> bool {
    kind_of(bytes).is_some() || foreign::is_foreign_picture(bytes)
}

struct Reader {
    readings: Vec<Reading>,
    warnings: Vec<Warning>,
}

impl Reader {
    /// A file's content, whose description and warnings are recorded; `None` with a warning if it cannot be read.
    fn read<T>(
        &mut self,
        (name, path): (&str, &Path),
        of: impl FnOnce() -> std::result::Result<(T, String, Warnings), String>,
    ) -> Option<T> {
        match of() {
            Ok((content, says, warnings)) => {
                self.readings.push(Reading { name: name.into(), path: path.into(), says });
                self.warnings.extend(warnings.0.iter().map(|warning| warning.of_file(name)));
                Some(content)
            }
            Err(reason) => {
                let left_out = Warning::new("file-left-out", format!("{reason} (left out)"));
                self.warnings.push(left_out.of_file(name));
                None
            }
        }
    }

    fn frame(&mut self, folder: &Path, pair: &Pair, unit: Option<f64>) -> Option<RigView> {
        let (image_path, depth_path) = (&pair.files.image, &pair.files.depth);
        let [image_name, depth_name] = [image_path, depth_path].map(|path| name_in(folder, path));
        let image = self.read((&image_name, image_path), || {
            let raster = raster(image_path)?;
            let mut warnings = Warnings::default();
            warnings.extend(raster.warnings.iter().cloned());
            if colour::looks_like_depth(&raster) {
                let words = format!(
                    "It looks like a depth map ({}-bit, grey) where a colour image was expected: were the files swapped?",
                    raster.bits
                );
                warnings.add("files-swapped", words);
            }
            let says = colour::says(&raster);
            Ok((raster, says, warnings))
        });
        let depth = self.read((&depth_name, depth_path), || {
            let raster = raster(depth_path)?;
            let size = [raster.width, raster.height];
            let depth = depth_of(raster, unit.or(pair.files.unit))?;
            let (says, warnings) = (depth.says.clone(), depth.warnings.clone());
            Ok(((size, depth), says, warnings))
        });
        let (image, (depth_size, depth)) = (image?, depth?);
        let mut view = RigView {
            name: pair.name.clone(),
            image_size: [image.width, image.height],
            image: colour::colours(&image),
            transfer: colour::transfer(&image),
            image_mask: None,
            image_camera: None,
            depth_size,
            unit: (!matches!(depth.samples, DepthSamples::Cloud(_))).then_some(depth.unit),
            depth: depth.samples,
            intensity: None,
            depth_mask: None,
            depth_camera: None,
        };
        if let Some(path) = &pair.files.any_mask {
            self.mask(&mut view, &name_in(folder, path), path);
        }
        Some(view)
    }

    fn mask(&mut self, view: &mut RigView, name: &str, path: &Path) {
        let read = self.read((name, path), || {
            let raster = raster(path)?;
            let mask = colour::mask(&raster);
            let share = mask.iter().filter(|&&inside| inside > 0).count() as f64 / mask.len() as f64;
            let mut warnings = Warnings::default();
            warnings.extend(raster.warnings.iter().cloned());
            if share == 0.0 {
                warnings.add("mask-empty", "The mask is empty: no pixel belongs to the object.");
            }
            if share == 1.0 {
                warnings.add("mask-full", "The mask covers the whole picture.");
            }
            let percent = text::numbers::fixed(100.0 * share, 1);
            let says = format!("{}, a mask of {percent} % of the pixels", colour::stored(&raster));
            Ok((([raster.width, raster.height], mask), says, warnings))
        });
        let Some((size, mask)) = read else { return };
        if size == view.image_size {
            view.image_mask = Some(mask);
        } else if size == view.depth_size {
            view.depth_mask = Some(mask);
        } else {
            let [width, height] = size;
            let words = format!("the mask is {width}x{height}, the size of neither picture; it was left out.");
            self.warnings.push(Warning::new("mask-size", words).of_file(name));
        }
    }

    fn text(&mut self, name: &str, path: &Path) -> Option<Calibration> {
        self.read((name, path), || {
            let bytes = read::whole(path).map_err(|problem| problem.reason().to_owned())?;
            let text = text::text_of(&bytes).ok_or_else(|| foreign::describe(&bytes))?;
            let found = text::read_text(&text, name)?;
            let (says, warnings) = (says(&found), found.warnings.clone());
            Ok((found, says, warnings))
        })
    }
}

fn raster(path: &Path) -> std::result::Result<read::Raster, String> {
    read::decoded(&read::whole(path).map_err(|problem| problem.reason().to_owned())?)
}

/// A description of what a text holds, with its format.
pub fn says(found: &Calibration) -> String {
    format!("{}: {}", found.format, words::in_words(found))
}

/// Evenly spread items, including the first and the last.
fn spread(all: Vec<Pair>, most: usize) -> Vec<Pair> {
    if all.len() <= most {
        return all;
    }
    let place = |index: usize| {
        if most == 1 { 0 } else { (index as f64 * (all.len() - 1) as f64 / (most - 1) as f64).round() as usize }
    };
    (0..most).map(|index| all[place(index)].clone()).collect()
}

/// Merges equal warnings of several files: a calibration of a hundred frames warns once, not a hundred times.
/// Files that were left out are merged only if they have the same reason.
fn grouped(warnings: Vec<Warning>) -> Vec<Warning> {
    fn likeness(warning: &Warning) -> (&str, &str) {
        (warning.code, if warning.code == "file-left-out" { &warning.reason } else { "" })
    }
    let mut kinds: Vec<(&str, &str)> = Vec::new();
    for kind in warnings.iter().map(likeness) {
        if !kinds.contains(&kind) {
            kinds.push(kind);
        }
    }
    let of_kind = |kind: &(&str, &str)| {
        let all = || warnings.iter().filter(|warning| likeness(warning) == *kind);
        let files: HashSet<&String> = all().filter_map(|warning| warning.field.as_ref()).collect();
        let Some(first) = all().find(|warning| warning.field.is_some()) else { return all().cloned().collect() };
        let more = if files.len() > 1 { format!(" (and {} more like it)", files.len() - 1) } else { String::new() };
        let first = Warning { message: format!("{}{more}", first.message), ..first.clone() };
        [first].into_iter().chain(all().filter(|warning| warning.field.is_none()).cloned()).collect::<Vec<_>>()
    };
    kinds.iter().flat_map(of_kind).collect()
}

/// Warns if the depth maps were read with different units, since the unit of each map is guessed separately.
fn check_units(frames: &[RigView], warnings: &mut Vec<Warning>) {
    let mut units: Vec<f64> = Vec::new();
    for unit in frames.iter().map(|frame| frame.unit.unwrap_or(1.0)) {
        if !units.contains(&unit) {
            units.push(unit);
        }
    }
    if units.len() > 1 {
        let listed: Vec<String> = units.iter().map(|unit| format!("{} mm", number(1000.0 * unit))).collect();
        warnings.push(Warning::new(
            "units-differ",
            format!(
                "The depth maps of this folder were read with different units ({}): give the unit.",
                listed.join(", ")
            ),
        ));
    }
}

/// The files of a folder that may be read, with their relative names.
fn kept(folder: &Path, options: &FolderOptions) -> Result<Vec<(String, PathBuf)>> {
    let except: HashSet<PathBuf> =
        options.except.iter().chain(&options.cameras).filter_map(|path| path.canonicalize().ok()).collect();
    let is_wanted = |path: &PathBuf| path.canonicalize().is_ok_and(|path| !except.contains(&path));
    let files = pairs::files_of(folder)?.into_iter().filter(is_wanted).map(|path| (name_in(folder, &path), path));
    let mut files: Vec<_> = files.collect();
    let bytes: u64 = files.iter().filter_map(|(_, path)| path.metadata().ok()).map(|data| data.len()).sum();
    if bytes > MOST_BYTES {
        let reason = format!(
            "it holds {:.1} GB, but at most {} are read: copy some of its pairs into a separate folder",
            bytes as f64 / 2_f64.powi(30),
            MOST_BYTES >> 30
        );
        return Err(Problem::file(folder, reason));
    }
    files.retain(|(name, _)| !IGNORED.is_match(name));
    files.sort();
    Ok(files)
}

/// Reads all files of a folder: frames with their cameras, and the poses between these.
///
/// # Errors
/// If the folder cannot be read or holds nothing readable, or if an option is out of range.
pub fn read_rig_folder(folder: &Path, options: &FolderOptions) -> Result<RigFolder> {
    if options.unit.is_some_and(|unit| !(unit > 0.0 && unit.is_finite())) {
        return Err(Problem::option("unit", "needs metres per stored number, above zero"));
    }
    if options.frames == Some(0) {
        return Err(Problem::option("frames", "needs a whole number above zero"));
    }
    let files = kept(folder, options)?;
    let named = options.cameras.iter().map(|path| (given_name(path), path.clone()));
    let is_picture = |path: &Path| read::head(path, HEAD).is_ok_and(|bytes| is_raster(&bytes));
    let (pictures, texts): (Vec<_>, Vec<_>) = files.into_iter().partition(|(_, path)| is_picture(path));
    let is_list = |name: &str| LISTS.is_match(name);
    let mut candidates: Vec<PathBuf> =
        pictures.iter().chain(texts.iter().filter(|(name, _)| is_list(name))).map(|(_, path)| path.clone()).collect();
    let Pairs { pairs, warnings } = pairs::among(folder, &mut candidates)?;
    let mut reader = Reader { readings: Vec::new(), warnings: warnings.0 };
    let keys: HashSet<String> = pairs.iter().map(|pair| pair.key.clone()).collect();
    let (count, most) = (pairs.len(), options.frames.unwrap_or(FRAMES));
    let chosen = spread(pairs, most);
    if chosen.len() < count {
        let words = format!("{} of {count} pairs are read, evenly spread.", chosen.len());
        reader.warnings.push(Warning::new("pairs-sampled", words));
    }
    let frames: Vec<RigView> = chosen.iter().filter_map(|pair| reader.frame(folder, pair, options.unit)).collect();
    let (mut cameras, mut poses) = (Vec::new(), Vec::new());
    for (name, path) in named.chain(texts.into_iter().filter(|(name, _)| !is_list(name))) {
        // A pose named like a frame is the camera's pose at that moment and does not relate two cameras.
        if POSE.is_match(&name) && keys.contains(&key(&POSE.replace_all(&name, ""))) {
            continue;
        }
        let Some(found) = reader.text(&name, &path) else { continue };
        let stem = || pairs::stem(base(&name)).to_owned();
        let of = |camera: NamedCamera| NamedCamera { name: camera.name.or_else(|| Some(stem())), ..camera };
        cameras.extend(found.cameras.into_iter().map(of));
        let is_rig = |pose: &NamedPose| {
            let is_world = |frame: &Option<String>| frame.as_deref() == Some("world");
            !is_world(&pose.names.from) && !is_world(&pose.names.to)
        };
        poses.extend(found.poses.into_iter().filter(is_rig));
    }
    let Reader { readings, warnings } = reader;
    let mut found = RigFolder { frames, cameras, poses, readings, warnings };
    add_cameras(&mut found);
    check_units(&found.frames, &mut found.warnings);
    found.warnings = grouped(found.warnings);
    if found.frames.is_empty() && found.cameras.is_empty() && found.poses.is_empty() {
        let first = found.warnings.first().map(|warning| format!(": {warning}")).unwrap_or_default();
        let reason = format!(
            "no pair of a colour image and a depth map was found in it; the names must say which is which{first}"
        );
        return Err(Problem::file(folder, reason));
    }
    Ok(found)
}
