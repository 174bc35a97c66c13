//! What one iteration produces and the next one may have to give back.

use nalgebra::Vector3;

use crate::light::Light;
use crate::pose::Similarity;
use crate::view::{Camera, ColourView, DepthView, Normals, Points, Size};

/// Pose, light and both shapes.
#[derive(Clone, Debug)]
pub struct Solution {
    /// Pose.
    pub pose: Similarity,
    /// Light without exposure.
    pub light: Light,
    /// Offset of log S on top of `light`.
    pub exposure: f64,
    /// Normals of the image surface, colour view's frame.
    pub image_normals: Normals,
    /// Depth of the image surface in the colour view's unit.
    pub image_depth: Vec<f32>,
    /// Points of the image surface.
    pub image_points: Points,
    /// Refined normals, depth view's frame.
    pub depth_normals: Normals,
    /// Refined depth.
    pub refined_depth: Vec<f32>,
    /// Refined points, depth view's frame.
    pub depth_points: Points,
}

impl Solution {
    /// Nothing known but the pose and the measured depth.
    pub fn new(image: &ColourView, depth: &DepthView, pose: Similarity, light: Light) -> Self {
        Self {
            pose,
            light,
            exposure: 0.0,
            image_normals: Normals::missing(image.size.len()),
            image_depth: vec![f32::NAN; image.size.len()],
            image_points: Points::missing(image.size.len()),
            depth_normals: depth.normals.clone(),
            refined_depth: depth.depth.clone(),
            depth_points: depth.points.clone(),
        }
    }

    /// The light that predicts the image: exposure included.
    pub fn exposed_light(&self) -> Light {
        self.light.exposed(self.exposure)
    }

    /// Takes everything over from another solution of the same sizes without allocating.
    pub fn copy_from(&mut self, other: &Self) {
        self.pose = other.pose;
        self.light = other.light;
        self.exposure = other.exposure;
        self.image_depth.clone_from(&other.image_depth);
        self.refined_depth.clone_from(&other.refined_depth);
        for (mine, theirs) in [
            (&mut self.image_normals, &other.image_normals),
            (&mut self.image_points, &other.image_points),
            (&mut self.depth_normals, &other.depth_normals),
            (&mut self.depth_points, &other.depth_points),
        ] {
            mine.x.clone_from(&theirs.x);
            mine.y.clone_from(&theirs.y);
            mine.z.clone_from(&theirs.z);
        }
    }

    /// Points of both surfaces from their depths. An organised cloud keeps its own.
    pub fn raise_depth_points(&mut self, view: &DepthView) {
        if !view.organised {
            raise(view.size, &view.camera, &self.refined_depth, &mut self.depth_points);
        }
    }

    /// Points of the image surface from its depth.
    pub fn raise_image_points(&mut self, view: &ColourView) {
        raise(view.size, &view.camera, &self.image_depth, &mut self.image_points);
    }

    /// Centre of the depth points in the colour view's frame.
    pub fn carried_centre(&self) -> Vector3<f64> {
        self.pose.apply(self.depth_points.centroid())
    }

    /// The depth point at `index` in the colour view's frame.
    pub fn carried(&self, index: usize) -> Vector3<f64> {
        self.pose.apply(Vector3::from(self.depth_points.get(index).map(f64::from)))
    }
}

fn raise(size: Size, camera: &Camera, depth: &[f32], points: &mut Points) {
    for (index, &depth) in depth.iter().enumerate() {
        let (column, row) = size.position(index);
        let point = if depth.is_nan() {
            [f32::NAN; 3]
        } else {
            camera.point(size, [column as f64, row as f64], f64::from(depth)).map(|value| value as f32)
        };
        points.set(index, point);
    }
}
