//! Everything that is visible in one frame: placed triangles, each with its albedo.

use nalgebra::Vector3;

use super::pattern::Albedo;
use super::solids::Solid;
use crate::pose::Similarity;

/// Triangles in the world frame: x right, y down along gravity, z forward, metres; the rig is near the origin.
#[derive(Clone, Debug, Default)]
pub struct Stage {
    pub points: Vec<Vector3<f64>>,
    /// Unit normals, one for each point, on either side of the surface.
    pub normals: Vec<Vector3<f64>>,
    pub triangles: Vec<Triangle>,
    pub albedos: Vec<Albedo>,
}

#[derive(Clone, Copy, Debug)]
pub struct Triangle {
    pub corners: [u32; 3],
    pub albedo: u32,
}

impl Stage {
    pub fn put(&mut self, solid: &Solid, placement: &Similarity, albedo: Albedo) {
        let first = self.points.len();
        self.points.extend(solid.points.iter().map(|&point| placement.apply(point)));
        self.normals.extend(solid.normals.iter().map(|normal| placement.rotation * normal));
        let albedo_index = self.albedos.len() as u32;
        self.albedos.push(albedo);
        self.triangles.extend(
            solid.triangles.iter().map(|corners| Triangle {
                corners: corners.map(|corner| (first + corner) as u32),
                albedo: albedo_index,
            }),
        );
    }
}
