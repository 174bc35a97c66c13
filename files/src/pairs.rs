//! Finds the pairs of a folder, like js/rig/folder.ts: by time stamps (TUM RGB-D), by similar names, or by their order.
//!
//! Limits: pictures are not opened to find out their kind, and at least one of a pair must be named as a depth map.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use regex_lite::Regex;
use walkdir::{DirEntry, WalkDir};

use crate::problem::{Problem, Result, plain, shown};
use crate::read;
use crate::read::foreign::is_foreign_picture;
use crate::warning::{Warning, Warnings};

/// Time stamps farther apart than this, in seconds, are not a pair; TUM's own tool uses the same value.
const APART: f64 = 0.02;
const TUM_UNIT: f64 = 1.0 / 5000.0;
/// Deepest level of nested folders.
const DEEPEST: usize = 8;
const MOST_FILES: usize = 200_000;
/// Number of first bytes, which identify pictures.
const HEAD: u64 = 16;
/// Largest number of bytes of a list of frames.
const MOST_LIST: u64 = 64 << 20;

fn pattern(text: &str) -> Regex {
    Regex::new(text).expect("is a constant")
}
static DEPTH: LazyLock<Regex> = LazyLock::new(|| pattern("(?i)depth|dpt|range([^a-z]|$)|disp"));
static MASK: LazyLock<Regex> = LazyLock::new(|| pattern("(?i)mask|segm"));
static COLOUR: LazyLock<Regex> = LazyLock::new(|| pattern("(?i)colou?r|rgb|image|img"));
static KINDS: LazyLock<Regex> =
    LazyLock::new(|| pattern("(?i)depth|dpt|colou?r|rgb|image|img|mask|crop|registered|aligned"));
/// Names of pictures, whatever the files contain; their readers report faults.
static PICTURE: LazyLock<Regex> = LazyLock::new(|| pattern(r"(?i)\.(png|jpe?g|npy)$"));
static ENDING: LazyLock<Regex> = LazyLock::new(|| pattern(r"(?i)\.[a-z0-9]{1,5}$"));

/// The files of a pair.
#[derive(Clone, Debug)]
pub struct Files {
    pub image: PathBuf,
    pub depth: PathBuf,
    pub image_mask: Option<PathBuf>,
    pub depth_mask: Option<PathBuf>,
    /// The mask belongs to the view of the same size.
    pub any_mask: Option<PathBuf>,
    /// Metres for each stored number, if the folder states it.
    pub unit: Option<f64>,
}

/// One pair, and the common part of its files' names.
#[derive(Clone, Debug)]
pub struct Pair {
    pub name: String,
    /// The common part of its files' names.
    pub key: String,
    pub files: Files,
}

impl Pair {
    /// Name of the folder for its results.
    pub fn folder_name(&self) -> String {
        let safe = |letter: char| if letter.is_ascii_alphanumeric() || "-_.".contains(letter) { letter } else { '_' };
        let name: String = self.name.chars().map(safe).collect();
        if name.trim_matches('.').is_empty() { "pair".into() } else { name }
    }
}

#[derive(Debug)]
pub struct Pairs {
    pub pairs: Vec<Pair>,
    pub warnings: Warnings,
}

/// All pairs in the order of their names, without anything below `except`, which holds the results of an earlier run.
pub fn pairs(folder: &Path, except: Option<&Path>) -> Result<Pairs> {
    let mut files = below(folder, except.and_then(|path| path.canonicalize().ok()).as_deref())?;
    let Pairs { pairs, warnings } = among(folder, &mut files)?;
    if pairs.is_empty() {
        let words = format!(
            "no pair of a colour image and a depth map was found among its {} files; the names must say which is which",
            files.len()
        );
        return Err(Problem::file(folder, words));
    }
    Ok(Pairs { pairs: unique(pairs), warnings })
}

/// The pairs among files of a folder; sorts the files by name.
pub fn among(folder: &Path, files: &mut [PathBuf]) -> Result<Pairs> {
    files.sort_by_cached_key(|path| natural(&name_in(folder, path)));
    let mut warnings = Warnings::default();
    let pairs = match tum(folder, files, &mut warnings)? {
        Some(pairs) => pairs,
        None => by_names(folder, files, &mut warnings),
    };
    Ok(Pairs { pairs, warnings })
}

/// All files below a folder.
pub fn files_of(folder: &Path) -> Result<Vec<PathBuf>> {
    below(folder, None)
}

/// The files below a folder, without hidden ones and links to folders.
fn below(folder: &Path, except: Option<&Path>) -> Result<Vec<PathBuf>> {
    let is_hidden = |entry: &DirEntry| entry.depth() > 0 && entry.file_name().to_string_lossy().starts_with('.');
    let is_except = |entry: &DirEntry| {
        except.is_some() && entry.file_type().is_dir() && entry.path().canonicalize().ok().as_deref() == except
    };
    let walk = WalkDir::new(folder).max_depth(DEEPEST + 1).into_iter();
    let mut files = Vec::new();
    for entry in walk.filter_entry(|entry| !is_hidden(entry) && !is_except(entry)) {
        let entry = entry.map_err(|error| {
            let reason = error.io_error().map_or_else(|| error.to_string(), ToString::to_string);
            Problem::file(error.path().unwrap_or(folder), reason)
        })?;
        // A link counts as its target.
        if !entry.file_type().is_dir() && entry.path().is_file() {
            files.push(entry.into_path());
        }
        if files.len() > MOST_FILES {
            return Err(Problem::file(folder, format!("it holds more than {MOST_FILES} files")));
        }
    }
    Ok(files)
}

/// Text files with camera-like names in the folders of both images, and in their parent if these are side by side.
pub fn files_beside(files: &Files) -> Vec<PathBuf> {
    static CAMERA: LazyLock<Regex> =
        LazyLock::new(|| pattern(r"(?i)(calib|camera|intrinsic|cam_?info|^k\b).*\.(json|ya?ml|xml|txt)$|^k\.txt$"));
    let mut folders: Vec<&Path> = [&files.image, &files.depth].into_iter().filter_map(|path| path.parent()).collect();
    folders.dedup();
    if let [one, other] = folders[..]
        && one.parent() == other.parent()
    {
        folders.extend(one.parent());
    }
    let mut found = Vec::new();
    for folder in folders {
        let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().take(MOST_FILES);
        let named = entries.filter(|entry| CAMERA.is_match(&entry.file_name().to_string_lossy()));
        found.extend(named.map(|entry| entry.path()).filter(|path| path.is_file()));
    }
    found.sort();
    found
}

/// The path relative to the folder.
pub fn name_in(folder: &Path, path: &Path) -> String {
    path.strip_prefix(folder).unwrap_or(path).to_string_lossy().replace('\\', "/")
}

/// The last part of a path.
pub fn base(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

/// A name without its extension.
pub fn stem(name: &str) -> &str {
    ENDING.find(name).map_or(name, |ending| &name[..ending.start()])
}

/// Sorts numbers in names by value and capitals beside their small letters; natord and alphanumeric-sort put all
/// capitals first.
fn natural(name: &str) -> Vec<(String, u64, String)> {
    static PIECES: LazyLock<Regex> = LazyLock::new(|| pattern("[0-9]{1,18}|[^0-9]+"));
    let piece = |piece: &str| match piece.parse() {
        Ok(number) => (String::new(), number, piece.to_owned()),
        Err(_) => (piece.to_lowercase(), 0, piece.to_owned()),
    };
    PIECES.find_iter(name).map(|found| piece(found.as_str())).collect()
}

/// A name without the parts that distinguish the files of a frame.
fn common(name: &str) -> String {
    KINDS.replace_all(&ENDING.replace(name, ""), " ").into_owned()
}

/// The common key of the files of one frame: letters of any script, in either case, and numbers without leading zeros.
pub fn key(name: &str) -> String {
    let left = common(base(name)).to_lowercase();
    let words = left.split(|letter: char| !letter.is_alphanumeric() && letter != '.').map(|word| {
        let word = word.trim_matches('.');
        let digits = word.bytes().take_while(|&letter| letter == b'0').count();
        let follows = word.as_bytes().get(digits).is_some_and(u8::is_ascii_digit);
        // Keeps one zero of a number that is zero.
        &word[if follows { digits } else { digits.saturating_sub(1) }..]
    });
    words.filter(|word| !word.is_empty() && *word != "mm").collect::<Vec<_>>().join(" ")
}

/// TUM's lists: a time stamp and a path on each line.
fn listed(path: &Path) -> Result<Vec<(f64, String)>> {
    let bytes = read::head(path, MOST_LIST).map_err(|error| Problem::file(path, error))?;
    let text = String::from_utf8_lossy(&bytes);
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    lines
        .map(|line| {
            let (time, file) = line.split_once(char::is_whitespace).unwrap_or((line, ""));
            match (time.parse::<f64>(), file.trim()) {
                (Ok(time), file) if time.is_finite() && !file.is_empty() => Ok((time, file.to_owned())),
                _ => Err(Problem::file(path, format!("it lists time stamps and files, and {line:.60?} is neither"))),
            }
        })
        .collect()
}

/// The pairs of rgb.txt and depth.txt, if both exist.
fn tum(folder: &Path, files: &[PathBuf], warnings: &mut Warnings) -> Result<Option<Vec<Pair>>> {
    let list = |name: &str| files.iter().find(|path| base(&name_in(folder, path)).eq_ignore_ascii_case(name));
    let (Some(colours), Some(depths)) = (list("rgb.txt"), list("depth.txt")) else { return Ok(None) };
    let root = colours.parent().unwrap_or(folder);
    let found = by_time(listed(colours)?, listed(depths)?);
    if found.is_empty() {
        let words = format!("none of its time stamps lies within {} ms of one in {}", 1000.0 * APART, shown(depths));
        return Err(Problem::file(colours, words));
    }
    let (count, there) = (found.len(), files.iter().collect::<HashSet<_>>());
    let pairs: Vec<Pair> = found
        .into_iter()
        .map(|(time, colour, depth)| {
            pair(time.to_string(), &root.join(colour), &root.join(depth), None, Some(TUM_UNIT))
        })
        .filter(|pair| there.contains(&pair.files.image) && there.contains(&pair.files.depth))
        .collect();
    if pairs.len() < count {
        let missing = count - pairs.len();
        warnings.add(
            "pairs-missing",
            format!("{missing} of the {count} pairs that rgb.txt and depth.txt list are not in the folder."),
        );
    }
    Ok(Some(pairs))
}

/// The nearest pairs of two lists sorted by time.
fn by_time(mut colours: Vec<(f64, String)>, mut depths: Vec<(f64, String)>) -> Vec<(f64, String, String)> {
    colours.sort_by(|a, b| a.0.total_cmp(&b.0));
    depths.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut from = 0;
    let mut found = Vec::new();
    for (time, colour) in colours {
        let apart = |index: usize| depths.get(index).map_or(f64::INFINITY, |(other, _)| (other - time).abs());
        while from + 1 < depths.len() && apart(from + 1) <= apart(from) {
            from += 1;
        }
        if apart(from) <= APART {
            found.push((time, colour, depths[from].1.clone()));
            from += 1;
        }
    }
    found
}

/// Pairs by similar names or, if these differ throughout, by their order.
fn by_names(folder: &Path, files: &[PathBuf], warnings: &mut Warnings) -> Vec<Pair> {
    let is_picture = |path: &&PathBuf| {
        PICTURE.is_match(&path.to_string_lossy())
            || read::head(path, HEAD).is_ok_and(|bytes| read::kind_of(&bytes).is_some() || is_foreign_picture(&bytes))
    };
    let named = |path: &PathBuf| (name_in(folder, path), path.clone());
    let (masks, others): (Vec<_>, Vec<_>) =
        files.iter().filter(is_picture).map(named).partition(|(name, _)| MASK.is_match(name));
    let (depths, colours): (Vec<_>, Vec<_>) = others
        .into_iter()
        .partition(|(name, _)| DEPTH.is_match(base(name)) || (DEPTH.is_match(name) && !COLOUR.is_match(base(name))));
    let mask_of = |wanted: &str| {
        let only = || masks.first().filter(|(name, _)| masks.len() == 1 && key(name).is_empty());
        masks.iter().find(|(name, _)| key(name) == wanted).or_else(only).map(|(_, path)| path.clone())
    };
    let of = |name: String, colour: &Path, depth: &Path| pair(name.clone(), colour, depth, mask_of(&name), None);
    let partners = partners(&colours, &depths);
    let paired = || depths.iter().zip(&partners).filter_map(|(depth, colour)| Some((depth, &colours[(*colour)?])));
    let pairs: Vec<Pair> = paired().map(|((name, depth), (_, colour))| of(key(name), colour, depth)).collect();
    if !pairs.is_empty() || depths.len() != colours.len() {
        let taken: HashSet<&PathBuf> = paired().flat_map(|((_, depth), (_, colour))| [depth, colour]).collect();
        let lone = colours.iter().chain(&depths).filter(|(_, path)| !pairs.is_empty() && !taken.contains(path));
        let is_ambiguous = |(name, _): &(String, PathBuf)| {
            depths.iter().any(|(depth, _)| depth == name) && colours.iter().any(|(other, _)| key(other) == key(name))
        };
        for file in lone {
            let name = plain(&file.0);
            if is_ambiguous(file) {
                warnings.push(
                    Warning::new("names-ambiguous", "several files have names like this one; it was left out.")
                        .of_file(&name),
                );
            } else {
                warnings.push(
                    Warning::new("file-alone", "its name matches no other file or more than one; it was left out.")
                        .of_file(&name),
                );
            }
        }
        return pairs;
    }
    if depths.len() > 1 {
        let count = depths.len();
        warnings.add("pairs-by-order", format!(
            "No depth map has a name like a colour image's. The {count} images and depth maps were paired in the order of their names."
        ));
    }
    depths.iter().zip(&colours).map(|((name, depth), (_, colour))| of(key(name), colour, depth)).collect()
}

/// The colour image of each depth map: the image with a similar name. If several names differ only in case and signs,
/// the whole paths are compared, without the words for "colour" and "depth".
fn partners(colours: &[(String, PathBuf)], depths: &[(String, PathBuf)]) -> Vec<Option<usize>> {
    let mut alike: HashMap<String, (Vec<usize>, usize)> = HashMap::new();
    for (index, (name, _)) in colours.iter().enumerate() {
        alike.entry(key(name)).or_default().0.push(index);
    }
    depths.iter().for_each(|(name, _)| alike.entry(key(name)).or_default().1 += 1);
    let partner = |(name, _): &(String, PathBuf)| {
        let (theirs, count) = &alike[&key(name)];
        if let ([only], 1) = (&theirs[..], count) {
            return Some(*only);
        }
        let mut exact = theirs.iter().filter(|&&index| common(&colours[index].0) == common(name));
        exact.next().filter(|_| exact.next().is_none()).copied()
    };
    depths.iter().map(partner).collect()
}

fn pair(name: String, image: &Path, depth: &Path, any_mask: Option<PathBuf>, unit: Option<f64>) -> Pair {
    let stem = || image.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let files = Files { image: image.into(), depth: depth.into(), image_mask: None, depth_mask: None, any_mask, unit };
    Pair { name: if name.is_empty() { stem() } else { name.clone() }, key: name, files }
}

/// Numbers pairs of the same name, so that none overwrites another's results.
fn unique(mut pairs: Vec<Pair>) -> Vec<Pair> {
    let mut seen: HashMap<String, usize> = HashMap::new();
    for pair in &mut pairs {
        let count = seen.entry(pair.folder_name()).or_default();
        *count += 1;
        if *count > 1 {
            pair.name = format!("{} ({count})", pair.name);
        }
    }
    pairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_a_frame_have_a_key_in_common() {
        for (one, other) in [
            ("rgb_1.png", "depth_1.png"),
            ("color/000012.jpg", "depth/12.png"),
            ("frame-000000.color.png", "frame-000000.depth.png"),
            ("Bust Image.PNG", "bust_depth_mm.npy"),
        ] {
            assert_eq!(key(one), key(other), "{one} {other}");
        }
        assert_eq!(key("rgb_0.png"), "0");
        assert_ne!(key("rgb_1.png"), key("depth_10.png"));
    }

    #[test]
    fn names_of_any_script_and_names_alike_find_their_own() {
        let names =
            ["\u{e4}", "\u{f6}", "\u{82b1}\u{74f6}", "\u{1f600}", "\u{1f601}", "a", "A", "a!", "one/1", "two/1"];
        let files = |kind: &str| names.map(|name| (format!("{name}_{kind}.png"), PathBuf::new()));
        let found = partners(&files("rgb"), &files("depth"));
        assert_eq!(found, (0..names.len()).map(Some).collect::<Vec<_>>());
        // A file that may belong to several others belongs to none.
        let ambiguous = ["a_rgb.png", "A-rgb.png"].map(|name| (name.to_owned(), PathBuf::new()));
        assert_eq!(partners(&ambiguous, &[("a.depth.png".to_owned(), PathBuf::new())]), [None]);
    }

    #[test]
    fn numbers_in_names_count_by_value() {
        let mut names = ["depth_10.png", "depth_9.png", "depth_1.png"];
        names.sort_by_cached_key(|name| natural(name));
        assert_eq!(names, ["depth_1.png", "depth_9.png", "depth_10.png"]);
    }

    #[test]
    fn nearest_time_stamps_are_pairs_once() {
        let list = |times: &[f64]| times.iter().map(|&time| (time, time.to_string())).collect::<Vec<_>>();
        let found = by_time(list(&[1.0, 1.03, 2.0]), list(&[1.01, 1.035, 1.5]));
        let pairs: Vec<_> = found.iter().map(|(_, colour, depth)| (colour.as_str(), depth.as_str())).collect();
        assert_eq!(pairs, [("1", "1.01"), ("1.03", "1.035")]);
    }
}
