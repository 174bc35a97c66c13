//! Units, starts and gauges: what the data cannot say, decided once and for all.
//!
//! - Scale: a metric cloud against a pixel image has s near s0 = focal length / median Z; pixels against pixels and
//!   any image with known intrinsics have s0 = 1 (handbook section 2).
//! - An orthographic image cannot see t_z: the median depth difference of the correspondences is made zero.
//! - A pinhole image cannot see the size of its surface: s is held and the surface scaled instead.

use nalgebra::{Matrix3, Vector3};

use crate::numeric::quantile;
use crate::options::{Options, Start};
use crate::pose::Similarity;
use crate::view::{Camera, ColourView, DepthView};

/// Two orthographic masks that overlap less than this (intersection over union) are centred on each other first.
const LEAST_OVERLAP: f64 = 0.5;

/// s0: what one unit of the depth view measures in the colour view.
pub fn unit_scale(image: &ColourView, depth: &DepthView) -> f64 {
    let focal_length = image.camera.focal_length().or_else(|| depth.camera.focal_length());
    match (image.camera, focal_length) {
        (Camera::Orthographic, Some(focal_length)) => focal_length / median_depth(depth),
        _ => 1.0,
    }
}

/// The scale that the registration holds, `None` where it is free.
///
/// Behind a pinhole image a change of scale is a change of the surface's size, so the pose keeps its scale.
pub fn held_scale(image: &ColourView, options: &Options) -> Option<f64> {
    options.scale.or_else(|| (!image.camera.is_orthographic()).then_some(1.0))
}

/// Length of an image pixel at the object, in units of the colour view.
pub fn pixel_length(image: &ColourView, distance: f64) -> f64 {
    image.camera.focal_length().map_or(1.0, |focal_length| distance / focal_length)
}

/// The pose of iteration zero.
pub fn first_pose(image: &ColourView, depth: &DepthView, options: &Options) -> Similarity {
    let (rotation, scale, translation) = match options.start {
        Start::Search | Start::Identity => (Matrix3::identity(), None, None),
        Start::Pose { rotation, scale, translation } => (rotation, scale, translation),
    };
    let scale = held_scale(image, options).or(scale).unwrap_or_else(|| unit_scale(image, depth));
    let mut pose = Similarity { scale, rotation, translation: translation.unwrap_or_else(Vector3::zeros) };
    if translation.is_none() && !coincides(image, depth, options.start) {
        pose.translation = centring(image, depth, &pose);
    }
    pose
}

/// Whether both views share their frame as they stand, so that no translation is the best first one. A view that is
/// turned by the start is turned about its own centre, which has to be brought back.
fn coincides(image: &ColourView, depth: &DepthView, start: Start) -> bool {
    start == Start::Identity
        && match (image.camera, depth.camera) {
            (Camera::Pinhole(_), Camera::Pinhole(_)) => true,
            (Camera::Orthographic, Camera::Orthographic) => mask_overlap(image, depth) >= LEAST_OVERLAP,
            _ => false,
        }
}

/// Intersection over union of both masks, centre on centre.
fn mask_overlap(image: &ColourView, depth: &DepthView) -> f64 {
    let (mut both, mut any) = (0_usize, image.mask.iter().filter(|&&inside| inside).count());
    for index in (0..depth.size.len()).filter(|&index| depth.mask[index]) {
        let (column, row) = depth.size.position(index);
        let [x, y] = depth.camera.ray(depth.size, [column as f64, row as f64]);
        let pixel = image.camera.project(image.size, [x, y, 0.0]);
        let inside = pixel.and_then(|[column, row]| image.size.nearest(column as f32, row as f32));
        match inside.filter(|&pixel| image.mask[pixel]) {
            Some(_) => both += 1,
            None => any += 1,
        }
    }
    both as f64 / any.max(1) as f64
}

/// The translation that puts the centre of the depth points on the centre of the image's mask.
fn centring(image: &ColourView, depth: &DepthView, pose: &Similarity) -> Vector3<f64> {
    let turned = pose.scale * (pose.rotation * depth.points.centroid());
    let (mut column, mut row, mut count) = (0.0, 0.0, 0.0);
    for index in (0..image.size.len()).filter(|&index| image.mask[index]) {
        let (c, r) = image.size.position(index);
        column += c as f64;
        row += r as f64;
        count += 1.0;
    }
    let pixel = [column / count, row / count];
    let distance = match (image.camera.focal_length(), depth.camera) {
        (None, _) => 0.0,
        (Some(_), Camera::Pinhole(_)) => turned.z,
        // A cloud in pixels of its own stands where its silhouette is as large as the image's.
        (Some(focal_length), Camera::Orthographic) => focal_length * pose.scale * (depth.valid() as f64 / count).sqrt(),
    };
    Vector3::from(image.camera.point(image.size, pixel, distance)) - turned
}

fn median_depth(depth: &DepthView) -> f64 {
    let mut values: Vec<f32> = depth.depth().iter().copied().filter(|value| !value.is_nan()).collect();
    f64::from(quantile(&mut values, 0.5))
}
