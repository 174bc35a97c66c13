//! What goes into a registration by local contrast, and what comes out.

use nalgebra::Vector3;

use crate::pose::increment::UNKNOWNS;
use crate::pose::similarity::Similarity;
use crate::pose::uncertainty::Uncertainty;
use crate::view::{ColourView, DepthView, Normals};

/// What is registered. Points and normals (depth view's frame) are NaN where missing.
#[derive(Clone, Copy)]
pub struct ContrastProblem<'a> {
    /// The colour view.
    pub image: &'a ColourView,
    /// Where the object is in it, pixels without a usable colour included.
    pub object: &'a [bool],
    /// The depth view.
    pub depth: &'a DepthView,
    /// Its normals.
    pub normals: &'a Normals,
    /// One sigma of each normal in radians; NaN leaves the point out.
    pub normal_error: &'a [f32],
    /// The scale that the units of both views give, where it is not known: the prior's middle.
    pub unit_scale: f64,
    /// Whether the scale of the start is kept.
    pub scale_is_held: bool,
}

impl ContrastProblem<'_> {
    /// Unknowns that keep their values: t_z of an orthographic image, which is a gauge, and a scale that is held.
    pub(super) fn held(&self) -> [bool; UNKNOWNS] {
        let gauge = self.image.camera.is_orthographic();
        [false, false, false, false, false, gauge, self.scale_is_held || !gauge]
    }

    /// Whether the image has a pinhole camera.
    pub(super) fn is_metric(&self) -> bool {
        !self.image.camera.is_orthographic()
    }

    /// Where the image sees a point of the depth view.
    pub(super) fn place(&self, pose: &Similarity, point: &Vector3<f64>) -> Option<[f64; 2]> {
        self.image.camera.project(self.image.size, pose.apply(*point).into())
    }
}

#[cfg(test)]
impl<'a> ContrastProblem<'a> {
    /// Of two views as they are, both in pixels.
    pub fn of_views(image: &'a ColourView, depth: &'a DepthView, normal_error: &'a [f32]) -> Self {
        let (object, normals) = (image.object(), &depth.normals);
        Self { image, object, depth, normals, normal_error, unit_scale: 1.0, scale_is_held: false }
    }
}

/// What the registration found.
#[derive(Clone, Debug)]
pub struct ContrastReport {
    /// The pose; its t_z is that of the start for an orthographic image.
    pub pose: Similarity,
    /// E, as all ends of the search are compared by it: 0 where shading and outline explain all, about 1 where shading
    /// explains nothing.
    pub objective: f64,
    /// One sigma of the pose's own numbers.
    pub uncertainty: Uncertainty,
}
