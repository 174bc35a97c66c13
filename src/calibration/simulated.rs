//! Scenes for tests: an image and a depth map of one raster, seen from one place.

use super::cue::Cue;
use super::frame::Frame;
use super::planes::Planes;
use super::registration::Scene;
use crate::view::{Lens, Pinhole, Size};

/// A scene of one frame whose depth and grey value are functions of column and row. The principal point is the middle.
pub(super) fn scene(
    size: Size,
    focal: f64,
    depth: impl Fn([usize; 2]) -> f64,
    grey: impl Fn([usize; 2]) -> f32,
    cues: &[Cue],
) -> Scene {
    let [cx, cy] = [size.width, size.height].map(|length| 0.5 * (length as f64 - 1.0));
    let camera = Pinhole { fx: focal, fy: focal, cx, cy, lens: Lens::None };
    let place = |index: usize| <[usize; 2]>::from(size.position(index));
    let point = |index: usize| {
        let z = depth(place(index));
        let [x, y] = place(index).map(|along| along as f64);
        [(x - cx) / focal * z, (y - cy) / focal * z, z].map(|value| value as f32)
    };
    let pixels = (0..size.len()).map(|index| [grey(place(index)); 3]).collect();
    let points = (0..size.len()).map(point).collect();
    let frame = Frame::new(String::new(), Planes { size, pixels }, camera, size, points);
    Scene::new(vec![frame], cues.to_vec(), false)
}
