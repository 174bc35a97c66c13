//! Converts hypotheses on the grid to poses. Without intrinsics, the colour camera sees parallel rays, and the centre
//! of a pose moves in the image plane at z = 0. With intrinsics, the centre moves in a plane of constant distance. It
//! is the distance from the depth camera, or the distance at which both silhouettes have the same area. Scale and
//! distance then cannot be distinguished, so the scale is held and the distance varies.

use nalgebra::Vector3;

use super::cloud::Cloud;
use super::hypothesis::Hypothesis;
use super::problem::SearchProblem;
use super::target::Target;
use super::template::GridProjection;
use crate::pose::similarity::Similarity;
use crate::view::{Camera, Size};

/// The cameras and the initial values of scale and distance.
pub struct Geometry {
    camera: Camera,
    image: Size,
    /// s at an apparent size of one.
    scale: f64,
    /// Distance of the cloud's centre from a pinhole, in units of the colour view.
    distance: Option<f64>,
    /// That distance if both silhouettes have the same area.
    distance_of_area: Option<f64>,
    ray: [f64; 2],
}

impl Geometry {
    pub fn new(problem: &SearchProblem<'_>, target: &Target, cloud: &Cloud) -> Self {
        let SearchProblem { image, depth, .. } = *problem;
        let scale = problem.scale.unwrap_or(problem.unit_scale);
        let ray = image.camera.ray(image.size, target.middle);
        let seen = image.mask.iter().filter(|&&inside| inside).count();
        let focal_length = image.camera.focal_length();
        // Length of a depth pixel at the object.
        let pixel = depth.camera.focal_length().map_or(1.0, |focal_length| cloud.centre.z / focal_length);
        let of_area = |focal_length: f64| focal_length * scale * pixel * (depth.valid() as f64 / seen as f64).sqrt();
        let distance_of_area = focal_length.map(of_area);
        let distance = match depth.camera {
            Camera::Pinhole(_) => focal_length.map(|_| scale * cloud.centre.z),
            Camera::Orthographic => distance_of_area,
        };
        let ray = if distance.is_some() { ray } else { [0.0; 2] };
        Self { camera: image.camera, image: image.size, scale, distance, distance_of_area, ray }
    }

    /// Takes the distance at which both silhouettes have the same area.
    pub const fn place_by_area(&mut self) {
        self.distance = self.distance_of_area;
    }

    /// Takes the distance of the centre from a given pose.
    pub fn place_at(&mut self, initial: &Similarity, cloud: &Cloud) {
        self.distance = self.distance.map(|_| initial.apply(cloud.centre).z);
    }

    /// Whether the distance varies instead of the scale, as it does behind a pinhole.
    pub const fn has_distance(&self) -> bool {
        self.distance.is_some()
    }

    /// Projection of the cloud onto a grid with cells of `cell` pixels, at an apparent size.
    pub fn projection(&self, size: f64, cell: f64) -> GridProjection {
        let (pixels, inverse_distance) = match (self.camera.focal_length(), self.distance) {
            (Some(focal_length), Some(distance)) => (focal_length * self.scale / distance, self.scale / distance),
            _ => (self.scale, 0.0),
        };
        GridProjection {
            magnification: (size * pixels / cell) as f32,
            ray: self.ray.map(|value| value as f32),
            inverse_distance: (size * inverse_distance) as f32,
            offset: [0.0; 2],
        }
    }

    /// Apparent size of a pose behind a pinhole, and where it puts the centre of the cloud, in cells from the middle;
    /// `None` if the camera does not see it.
    pub fn size_and_place(&self, pose: &Similarity, cloud: &Cloud, target: &Target) -> Option<(f64, [f64; 2])> {
        let centre = pose.apply(cloud.centre);
        let pixel = self.camera.project(self.image, centre.into())?;
        let place = [0, 1].map(|axis| (pixel[axis] - target.middle[axis]) / target.cell);
        Some((self.distance? / centre.z, place))
    }

    /// The pose of a hypothesis.
    pub fn pose(&self, hypothesis: &Hypothesis, cloud: &Cloud, target: &Target) -> Similarity {
        let pixel = [0, 1].map(|axis| target.middle[axis] + f64::from(hypothesis.shift[axis]) * target.cell);
        let (scale, distance) = match self.distance {
            None => (self.scale * hypothesis.size, 0.0),
            Some(distance) => (self.scale, distance / hypothesis.size),
        };
        let centre = Vector3::from(self.camera.point(self.image, pixel, distance));
        Similarity {
            scale,
            rotation: hypothesis.rotation,
            translation: centre - scale * (hypothesis.rotation * cloud.centre),
        }
    }
}
