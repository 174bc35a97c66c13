//! Memory that a pair of views needs, checked before any of it is allocated.

use crate::error::{Error, ErrorKind, Result};
use crate::text::Fixed;
use crate::view::Size;

/// Bytes for one pixel of either view, all stages and the initialisation together, with the module's own megabyte. Set
/// on pairs at 640x480 whose object fills the frame; `tests/contract/memory.test.mjs` measures it. Lens distortion and
/// noisy depth take more, and in smaller views the megabyte counts for more.
const BYTES_PER_PIXEL: f64 = 220.0;
/// Bytes for one pixel of either view in a [`Worker`](super::Worker), which has a separate module. Set at 640x480,
/// where refinement takes more than the search.
const WORKER_BYTES_PER_PIXEL: f64 = 110.0;
/// Largest number of bytes of a pair: a quarter of a wasm module's limit, and what a phone's browser grants a page.
const MOST_BYTES: f64 = 1e9;

/// Refuses pairs that are too large.
///
/// # Errors
/// [`ErrorKind::Memory`] with the larger view as its field.
pub fn check(image: Size, depth: Size) -> Result<()> {
    let [image, depth] = [image, depth].map(|size| size.len() as f64);
    let bytes = BYTES_PER_PIXEL * (image + depth);
    if bytes <= MOST_BYTES {
        return Ok(());
    }
    let field = if image >= depth { "image" } else { "depth" };
    let [needed, granted] = [bytes, MOST_BYTES].map(|bytes| Fixed(bytes / 1e6, 0));
    let message = format!("the pair would take {needed} MB, but may take only {granted}: use smaller views");
    Err(Error::new(ErrorKind::Memory, field, message))
}

/// Largest number of image pixels that fit in memory with a depth map of this size.
pub fn most_image_pixels(depth: Size) -> usize {
    (MOST_BYTES / BYTES_PER_PIXEL - depth.len() as f64).max(0.0) as usize
}

/// Number of a pair's workers that fit in memory beside its estimator.
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
