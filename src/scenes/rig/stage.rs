//! Everything that is visible in one frame: placed triangles, each with its albedo.

use nalgebra::Vector3;

use super::paint::Paint;
use super::solids::Solid;
use crate::pose::Similarity;

/// Triangles in the world frame: x right, y down along gravity, z forward, metres; the rig is near the origin.
#[derive(Clone, Debug, Default)]
pub struct Stage {
    pub points: Vec<Vector3<f64>>,
    /// Unit normals, one for each point, on either side of the surface.
    pub normals: Vec<Vector3<f64>>,
    pub triangles: Vec<Triangle>,
    pub paints: Vec<Paint>,
}

#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    pub corners: [u32; 3],
    pub paint: u32,
}

impl Stage {
    pub fn put(&mut self, solid: &Solid, placement: &Similarity, paint: Paint) {
        let first = self.points.len();
        self.points.extend(solid.points.iter().map(|&point| placement.apply(point)));
        self.normals.extend(solid.normals.iter().map(|normal| placement.rotation * normal));
        let paint_index = self.paints.len() as u32;
        self.paints.push(paint);
        self.triangles.extend(
            solid
                .triangles
                .iter()
                .map(|corners| Triangle { corners: corners.map(|corner| (first + corner) as u32), paint: paint_index }),
        );
    }
}
