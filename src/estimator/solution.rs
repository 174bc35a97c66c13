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
    /// Points of the image surface; their z is its depth in the colour view's unit.
    pub image_points: Points,
    /// Refined normals, depth view's frame.
    pub depth_normals: Normals,
    /// Refined points, depth view's frame; their z is the refined depth.
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
            image_points: Points::missing(image.size.len()),
            depth_normals: depth.normals.clone(),
            depth_points: depth.points.clone(),
        }
    }

    /// The light that predicts the image: exposure included.
    pub fn exposed_light(&self) -> Light {
        self.light.exposed(self.exposure)
    }

    /// Goes back to what was kept, without allocating.
    pub fn restore(&mut self, kept: &Kept, image: &ColourView, depth: &DepthView) {
        (self.pose, self.light, self.exposure) = (kept.pose, kept.light, kept.exposure);
        self.image_normals.copy_from(&kept.image_normals);
        self.image_points.z.clone_from(&kept.image_depth);
        self.raise_image_points(image);
        self.depth_normals.copy_from(&kept.depth_normals);
        self.depth_points.z.clone_from(&kept.refined_depth);
        self.raise_depth_points(depth);
    }

    /// Points of the depth view from their z. An organised cloud keeps its own.
    pub fn raise_depth_points(&mut self, view: &DepthView) {
        if !view.organised {
            raise(view.size, &view.camera, &mut self.depth_points);
        }
    }

    /// Points of the image surface from their z.
    pub fn raise_image_points(&mut self, view: &ColourView) {
        raise(view.size, &view.camera, &mut self.image_points);
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

/// What a rejected iteration has to give back; points follow from their depths.
pub struct Kept {
    pub pose: Similarity,
    light: Light,
    exposure: f64,
    image_normals: Normals,
    image_depth: Vec<f32>,
    depth_normals: Normals,
    refined_depth: Vec<f32>,
}

impl Kept {
    /// No shape yet.
    pub fn new(pose: Similarity, light: Light) -> Self {
        let [image_normals, depth_normals] = [Normals::default(), Normals::default()];
        let [image_depth, refined_depth] = [Vec::new(), Vec::new()];
        Self { pose, light, exposure: 0.0, image_normals, image_depth, depth_normals, refined_depth }
    }

    /// Normals of the image surface, those of the working solution until its iteration finds others.
    pub const fn image_normals(&self) -> &Normals {
        &self.image_normals
    }

    /// Keeps `solution` instead; allocates the first time.
    pub fn keep(&mut self, solution: &Solution) {
        (self.pose, self.light, self.exposure) = (solution.pose, solution.light, solution.exposure);
        self.image_normals.copy_from(&solution.image_normals);
        self.image_depth.clone_from(&solution.image_points.z);
        self.depth_normals.copy_from(&solution.depth_normals);
        self.refined_depth.clone_from(&solution.depth_points.z);
    }
}

/// The points at their depths along the pixels' rays.
fn raise(size: Size, camera: &Camera, points: &mut Points) {
    let parallel = camera.is_orthographic();
    let straight = camera.pinhole().is_none_or(|pinhole| pinhole.is_undistorted());
    // Of straight rays x follows from the column and y from the row.
    let [first, second] = [0.0, 1.0].map(|place| camera.ray(size, [place; 2]));
    let step = second[0] - first[0];
    for row in 0..size.height {
        let down = first[1] + row as f64 * (second[1] - first[1]);
        for column in 0..size.width {
            let index = size.index(column, row);
            let depth = points.z[index];
            let mut point = [f32::NAN; 3];
            if !depth.is_nan() {
                let mut ray = [first[0] + column as f64 * step, down];
                if !straight {
                    ray = camera.ray(size, [column as f64, row as f64]);
                }
                let reach = if parallel { 1.0 } else { f64::from(depth) };
                point = [(ray[0] * reach) as f32, (ray[1] * reach) as f32, depth];
            }
            points.set(index, point);
        }
    }
}
