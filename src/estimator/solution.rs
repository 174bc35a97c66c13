//! The solution of an iteration, and the part of the last accepted one that is kept.

use super::pair::ViewPair;
use crate::light::Light;
use crate::numeric::quantile;
use crate::pose::Similarity;
use crate::view::{Camera, ColourView, DepthView, Normals, Points, Size};

/// Pose, light and both shapes.
#[derive(Clone, Debug)]
pub struct Solution {
    pub pose: Similarity,
    pub light: ExposedLight,
    /// The surface of the image, in the colour view's frame and unit.
    pub image: Shape,
    /// The refined surface of the depth view, in its own frame and unit.
    pub depth: Shape,
}

/// A light, and the offset of log S on top of it.
#[derive(Clone, Copy, Debug)]
pub struct ExposedLight {
    pub light: Light,
    pub exposure: f64,
}

impl ExposedLight {
    /// The light that predicts the image, with exposure.
    pub fn total(&self) -> Light {
        self.light.exposed(self.exposure)
    }
}

/// Normals and points of the surface that one view sees, pixel by pixel; the points' z is the depth.
#[derive(Clone, Debug)]
pub struct Shape {
    pub normals: Normals,
    pub points: Points,
}

impl Solution {
    /// Starts with only the pose and the measured depth known.
    pub fn new(pair: &ViewPair, pose: Similarity, light: Light) -> Self {
        let ViewPair { image, depth, .. } = pair;
        let pixels = image.size.len();
        Self {
            pose,
            light: ExposedLight { light, exposure: 0.0 },
            image: Shape { normals: Normals::missing(pixels), points: Points::missing(pixels) },
            depth: Shape { normals: depth.normals.clone(), points: depth.points.clone() },
        }
    }

    /// Goes back to the accepted solution, without allocating.
    pub fn restore(&mut self, accepted: &Accepted, pair: &ViewPair) {
        (self.pose, self.light) = (accepted.pose, accepted.light);
        self.image.normals.copy_from(&accepted.image_normals);
        self.image.points.z.clone_from(&accepted.image_depth);
        self.image.place_image_points(&pair.image);
        self.depth.normals.copy_from(&accepted.depth_normals);
        self.depth.points.z.clone_from(&accepted.refined_depth);
        self.depth.place_depth_points(&pair.depth);
    }
}

impl Shape {
    /// Places the points of the image surface at their depths.
    pub fn place_image_points(&mut self, view: &ColourView) {
        place(view.size, &view.camera, &mut self.points);
    }

    /// Moves all depths so that their median is zero.
    pub fn centre_depth(&mut self, spare: &mut Vec<f32>) {
        spare.clear();
        spare.extend(self.points.z.iter().filter(|depth| !depth.is_nan()));
        let middle = if spare.is_empty() { 0.0 } else { quantile(spare, 0.5) };
        self.points.z.iter_mut().for_each(|depth| *depth -= middle);
    }

    /// Multiplies all depths.
    pub fn scale_depth(&mut self, factor: f64) {
        self.points.z.iter_mut().for_each(|depth| *depth *= factor as f32);
    }

    /// Places the points of the depth view at their depths. An organised cloud keeps its points.
    pub fn place_depth_points(&mut self, view: &DepthView) {
        if !view.organised {
            place(view.size, &view.camera, &mut self.points);
        }
    }
}

/// Places points at their depths along the pixels' rays.
fn place(size: Size, camera: &Camera, points: &mut Points) {
    let parallel = camera.is_orthographic();
    let straight = camera.is_straight();
    // For straight rays, x follows from the column and y from the row.
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

/// The last accepted iteration. A rejected iteration restores it, and the next iteration is compared with it. Points
/// follow from their depths.
pub struct Accepted {
    pub pose: Similarity,
    pub light: ExposedLight,
    image_normals: Normals,
    image_depth: Vec<f32>,
    depth_normals: Normals,
    refined_depth: Vec<f32>,
    /// Depth points over which the next iteration is compared with it.
    evaluated: Vec<u32>,
}

impl Accepted {
    /// No shape yet; capacity for this many evaluation points.
    pub fn new(solution: &Solution, points: usize) -> Self {
        Self {
            pose: solution.pose,
            light: solution.light,
            image_normals: Normals::default(),
            image_depth: Vec::new(),
            depth_normals: Normals::default(),
            refined_depth: Vec::new(),
            evaluated: Vec::with_capacity(points),
        }
    }

    /// Normals of the accepted image surface.
    pub const fn image_normals(&self) -> &Normals {
        &self.image_normals
    }

    /// Normals and depths of the image surface.
    pub fn image(&self) -> (&Normals, &[f32]) {
        (&self.image_normals, &self.image_depth)
    }

    /// Normals and depths of the refined depth view.
    pub fn depth(&self) -> (&Normals, &[f32]) {
        (&self.depth_normals, &self.refined_depth)
    }

    /// The depth points over which the next iteration is compared with this one.
    pub fn evaluated(&self) -> &[u32] {
        &self.evaluated
    }

    /// Sets the evaluation points.
    pub fn compared_over(&mut self, points: impl Iterator<Item = u32>) {
        self.evaluated.clear();
        self.evaluated.extend(points);
    }

    /// Accepts `solution`; allocates only the first time.
    pub fn accept(&mut self, solution: &Solution) {
        (self.pose, self.light) = (solution.pose, solution.light);
        self.image_normals.copy_from(&solution.image.normals);
        self.image_depth.clone_from(&solution.image.points.z);
        self.depth_normals.copy_from(&solution.depth.normals);
        self.refined_depth.clone_from(&solution.depth.points.z);
    }
}
