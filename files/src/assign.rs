//! Assigns the cameras that were read to the pictures: by their names, by the size of their images, and last by their
//! order.

use bimodal_stereo::Pinhole;

use crate::text::NamedCamera;
use crate::text::names::{Pattern, pattern};
use crate::text::numbers::{DIGITS, brief};
use crate::warning::Warning;

static COLOUR: Pattern = Pattern::new(|| pattern(r"(?i)colou?r|rgb|\bhr\b"));
static DEPTH: Pattern = Pattern::new(|| pattern(r"(?i)depth|dpt|\bir\b|infra|tof|\blr\b"));

/// The cameras of colour images and of depth maps of these sizes, as indices into the list, with a warning if the
/// choice was a guess. If `is_cloud`, depth maps need no camera.
pub fn assigned(
    cameras: &[NamedCamera],
    [image, depth]: [[usize; 2]; 2],
    is_cloud: bool,
    warnings: &mut Vec<Warning>,
) -> [Option<usize>; 2] {
    let mut warn = |code, words: &str| warnings.push(Warning::new(code, words));
    let all = || 0..cameras.len();
    let fits = |index: usize, size: [usize; 2]| cameras[index].size == Some(size);
    let is_unsized = |index: usize| cameras[index].size.is_none();
    let by_name = |is: &Pattern, is_not: &Pattern| {
        all().find(|&index| {
            let words = cameras[index].name.as_deref().unwrap_or("").replace(['_', '.', '-'], " ");
            is.is_match(&words) && !is_not.is_match(&words)
        })
    };
    let (mut colour, mut range) = (by_name(&COLOUR, &DEPTH), by_name(&DEPTH, &COLOUR));
    if colour.is_none() && range.is_none() && cameras.len() == 1 {
        if image == depth {
            (colour, range) = (Some(0), Some(0));
            warn(
                "camera-shared",
                "Only one camera's intrinsics were found; they are used for both pictures, as if these were registered to each other.",
            );
        } else if fits(0, depth) {
            range = Some(0);
        } else {
            colour = Some(0);
        }
    }
    let free = |index: &usize, taken: [Option<usize>; 2]| !taken.contains(&Some(*index));
    let pick = |taken: [Option<usize>; 2], is: &dyn Fn(usize) -> bool| {
        all().filter(|index| free(index, taken)).find(|&index| is(index))
    };
    colour = colour.or_else(|| pick([colour, range], &|index| fits(index, image) && !fits(index, depth)));
    range = range.or_else(|| pick([colour, range], &|index| fits(index, depth) && !fits(index, image)));
    if colour.is_none() && range.is_none() && cameras.len() > 1 {
        warn(
            "cameras-by-order",
            "The names do not say which camera is which; the first was used for colour and the second for depth.",
        );
        (colour, range) = (Some(0), Some(1));
    }
    if cameras.len() > 1 {
        colour = colour.or_else(|| pick([colour, range], &|index| is_unsized(index) || fits(index, image)));
        range = range.or_else(|| pick([colour, range], &|index| is_unsized(index) || fits(index, depth)));
    }
    if colour.is_none() {
        warn(
            "colour-camera-missing",
            "The colour camera's intrinsics are missing; its focal length has to be estimated.",
        );
    }
    if range.is_none() && !is_cloud {
        warn(
            "depth-camera-missing",
            "The depth camera's intrinsics are missing; without them depths cannot be turned into points.",
        );
    }
    for (index, [width, height], what) in [(colour, image, "colour images"), (range, depth, "depth maps")] {
        if let Some([w, h]) = index.and_then(|index| cameras[index].size).filter(|&size| size != [width, height]) {
            warn(
                "camera-size",
                &format!(
                    "The intrinsics of the {what} are for {w}x{h} pixels, but these pictures have {width}x{height}: scale or crop the intrinsics first."
                ),
            );
        }
        let Some(NamedCamera { camera: Pinhole { cx, cy, .. }, size: None, .. }) = index.map(|index| &cameras[index])
        else {
            continue;
        };
        if *cx > width as f64 || *cy > height as f64 {
            warn(
                "principal-point",
                &format!(
                    "The intrinsics of the {what} have their principal point outside the picture ({}, {} of {width}x{height}): they may be for another size.",
                    brief(*cx, DIGITS),
                    brief(*cy, DIGITS)
                ),
            );
        }
    }
    [colour, range]
}
