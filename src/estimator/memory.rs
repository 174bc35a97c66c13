//! How much memory a pair of views will take, asked before any of it is allocated.

use crate::error::{Error, ErrorKind, Result};
use crate::text::Fixed;
use crate::view::Size;

/// Bytes that one pixel of either view takes, all stages and the initialisation together. Measured on pairs at 640x480
/// (`tests/contract/memory.test.mjs` watches it), the module's own megabyte included: 180 of each view's pixels where
/// the object covers a third of the frame, 210 where it fills it. A lens with distortion adds up to 52, a noisy depth
/// map, whose pose its surface settles, up to 35; of smaller views the megabyte is a larger share: 222 at 480x360.
const BYTES_PER_PIXEL: f64 = 220.0;
/// Bytes that one pixel of either view takes in a [`Worker`](super::Worker), which has a module of its own. Measured at
/// 640x480: 75 while it searches; while it refines 84 where the object covers a third of the frame, 98 where it covers
/// most of it.
const WORKER_BYTES_PER_PIXEL: f64 = 110.0;
/// Most bytes of a pair: a quarter of what a wasm module may have, and what a phone's browser grants a page.
const MOST_BYTES: f64 = 1e9;

/// Refuses pairs that are too large.
///
/// # Errors
/// [`ErrorKind::Memory`] naming the larger view.
pub fn check(image: Size, depth: Size) -> Result<()> {
    let [image, depth] = [image, depth].map(|size| size.len() as f64);
    let bytes = BYTES_PER_PIXEL * (image + depth);
    if bytes <= MOST_BYTES {
        return Ok(());
    }
    let field = if image >= depth { "image" } else { "depth" };
    let [needed, granted] = [bytes, MOST_BYTES].map(|bytes| Fixed(bytes / 1e6, 0));
    let message = format!("the pair would take {needed} MB and may take {granted}: hand over smaller views");
    Err(Error::new(ErrorKind::Memory, field, message))
}

/// Image pixels that fit beside a depth map.
pub fn most_image_pixels(depth: Size) -> usize {
    (MOST_BYTES / BYTES_PER_PIXEL - depth.len() as f64).max(0.0) as usize
}

/// How many workers of a pair fit beside its estimator.
pub fn workers_afforded(image: Size, depth: Size) -> u32 {
    let pixels = (image.len() + depth.len()) as f64;
    ((MOST_BYTES / pixels - BYTES_PER_PIXEL) / WORKER_BYTES_PER_PIXEL).max(0.0) as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn usual_cameras_fit_and_the_larger_view_is_named() {
        let [small, full, large] =
            [(640, 480), (1920, 1080), (4000, 3000)].map(|(width, height)| Size { width, height });
        assert!(check(small, small).is_ok() && check(full, small).is_ok());
        let refused = |image, depth| check(image, depth).unwrap_err();
        assert_eq!((refused(large, small).kind(), refused(large, small).field()), (ErrorKind::Memory, "image"));
        assert_eq!(refused(small, large).field(), "depth");
    }
}
