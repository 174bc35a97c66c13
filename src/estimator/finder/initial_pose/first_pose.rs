//! The pose of iteration zero, from the option `start`.

use nalgebra::{Matrix3, Vector3};

use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::options::Start;
use crate::pose::Similarity;
use crate::view::{Camera, ColourView, DepthView};

/// Two orthographic masks that overlap less than this (intersection over union) are centred on each other first.
const LEAST_MASK_OVERLAP: f64 = 0.5;
/// The pose of iteration zero.
pub fn first_pose(pair: &ViewPair) -> Similarity {
    let start = pair.options.start;
    let (rotation, scale, translation) = match start {
        Start::Search | Start::Identity => (Matrix3::identity(), None, None),
        Start::Pose { rotation, scale, translation } => (rotation, scale, translation),
    };
    let scale = gauge::held_scale(pair).or(scale).unwrap_or_else(|| gauge::unit_scale(pair));
    let mut pose = Similarity { scale, rotation, translation: translation.unwrap_or_else(Vector3::zeros) };
    if translation.is_none() && !coincides(&pair.image, &pair.depth, start) {
        pose.translation = centring(&pair.image, &pair.depth, &pose);
    }
    pose
}

/// The pose of a rotation that puts the centre of the depth points on the centre of the image's object.
pub fn centred(pair: &ViewPair, rotation: Matrix3<f64>) -> Similarity {
    let scale = gauge::held_scale(pair).unwrap_or_else(|| gauge::unit_scale(pair));
    let mut pose = Similarity { scale, rotation, translation: Vector3::zeros() };
    pose.translation = centring(&pair.image, &pair.depth, &pose);
    pose
}

/// Whether the views share a frame if the pose is the identity.
pub fn shares_frame(pair: &ViewPair) -> bool {
    coincides(&pair.image, &pair.depth, Start::Identity)
}

/// Whether both views share their frame initially, so that a translation of zero is the best initial one. An initial
/// rotation rotates a view about the frame's origin, so its centre must then be moved back.
fn coincides(image: &ColourView, depth: &DepthView, start: Start) -> bool {
    start == Start::Identity
        && match (image.camera, depth.camera) {
            (Camera::Pinhole(_), Camera::Pinhole(_)) => true,
            (Camera::Orthographic, Camera::Orthographic) => mask_overlap(image, depth) >= LEAST_MASK_OVERLAP,
            _ => false,
        }
}

/// Intersection over union of both masks if the views share their frame.
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
    let rotated = pose.scale * (pose.rotation * depth.points.centroid());
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
        (Some(_), Camera::Pinhole(_)) => rotated.z,
        // A cloud in pixels is placed where its silhouette is as large as the image's.
        (Some(focal_length), Camera::Orthographic) => focal_length * pose.scale * (depth.valid() as f64 / count).sqrt(),
    };
    Vector3::from(image.camera.point(image.size, pixel, distance)) - rotated
}
