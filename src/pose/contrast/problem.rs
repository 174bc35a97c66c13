//! Input and output of a registration by local contrast.

use nalgebra::Vector3;

use crate::pose::increment::{Frame, PoseMatrix, UNKNOWNS, held_unknowns};
use crate::pose::similarity::Similarity;
use crate::pose::uncertainty::Uncertainty;
use crate::view::{ColourView, DepthView, Normals};

/// Input of the registration. Points and normals (depth view's frame) are NaN where missing.
#[derive(Clone, Copy)]
pub struct ContrastProblem<'a> {
    /// The colour view, orthographic.
    pub image: &'a ColourView,
    /// Mask of the object in the image, including pixels without a usable colour.
    pub object: &'a [bool],
    /// The depth view.
    pub depth: &'a DepthView,
    /// Normals of the depth view.
    pub normals: &'a Normals,
    /// One sigma of each normal in radians; points with NaN are left out.
    pub normal_error: &'a [f32],
    /// The scale given by the units of both views, mean of the prior over an unknown scale.
    pub unit_scale: f64,
    /// Whether the scale keeps its initial value.
    pub scale_is_held: bool,
}

impl ContrastProblem<'_> {
    /// Unknowns that keep their values.
    pub(in crate::pose) fn held(&self) -> [bool; UNKNOWNS] {
        held_unknowns(&self.image.camera, self.scale_is_held)
    }

    /// Image position of a point of the depth view.
    pub(in crate::pose) fn place(&self, pose: &Similarity, point: &Vector3<f64>) -> Option<[f64; 2]> {
        self.image.camera.project(self.image.size, pose.apply(*point).into())
    }
}

#[cfg(test)]
impl<'a> ContrastProblem<'a> {
    /// A problem of two unchanged views, both in pixels.
    pub fn of_views(image: &'a ColourView, depth: &'a DepthView, normal_error: &'a [f32]) -> Self {
        let (object, normals) = (image.object(), &depth.normals);
        Self { image, object, depth, normals, normal_error, unit_scale: 1.0, scale_is_held: false }
    }
}

/// Result of the registration.
#[derive(Clone, Debug)]
pub struct ContrastReport {
    /// The pose; t_z keeps its initial value.
    pub pose: Similarity,
    /// E with the term of the units: 0 if shading and silhouette explain everything, about 1 if shading explains
    /// nothing.
    pub objective: f64,
    /// One sigma of each number of the pose.
    pub uncertainty: Uncertainty,
    /// Covariance of the unknowns in this frame, zero for held ones.
    pub(in crate::pose) covariance: PoseMatrix,
    pub(in crate::pose) frame: Frame,
}

impl ContrastReport {
    /// A report with these sigmas and no covariance.
    #[cfg(test)]
    pub fn of(pose: Similarity, objective: f64, uncertainty: Uncertainty) -> Self {
        let frame = Frame { centre: Vector3::zeros(), length: 1.0 };
        Self { pose, objective, uncertainty, covariance: PoseMatrix::zeros(), frame }
    }
}
