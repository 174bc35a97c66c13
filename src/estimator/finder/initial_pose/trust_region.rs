//! An initial pose, and how far from it the answer may lie (docs/method/registration.md).
//!
//! Limits: if the views share no frame and no translation is given, only the initial rotation is trusted. Silhouettes
//! then start from the position that aligns the centres of both views.

use nalgebra::Vector3;

use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::options::{Registration, Start};
use crate::pose::{PosePrior, Similarity};
use crate::view::extent;

use super::first_pose::{first_pose, shares_frame};
use super::prior::prior;

/// Default tolerance of the object's position, in object sizes (root mean square distance of its points from their
/// centre). It is roughly the object's width. A turn by 8 degrees about a sensor at 0.8 m moves an object 0.2 m high by
/// less than this, even a slim vase.
const OBJECT_SIZES: f64 = 3.0;
/// An initial pose, and how far from it the answer may lie.
#[derive(Clone)]
pub struct TrustRegion {
    pub initial: Similarity,
    /// Degrees.
    pub degrees: f64,
    /// Centre of the depth points, in their own frame.
    middle: Vector3<f64>,
    /// Tolerance of the centre's position, in units of the colour view; infinite if no translation is given.
    distance: f64,
    /// Whether the image depends on distances.
    sees_depth: bool,
}

impl TrustRegion {
    /// The trust region of a pair with an initial pose; `None` for the paper's registration, which is not held near it.
    pub fn of(pair: &ViewPair) -> Option<Self> {
        if pair.options.registration != Registration::Joint {
            return None;
        }
        let is_placed = match pair.options.start {
            Start::Search => return None,
            Start::Identity => shares_frame(pair),
            Start::Pose { translation, .. } => translation.is_some(),
        };
        let initial = first_pose(pair);
        let (middle, spread) = extent(pair.depth.points.valid());
        let tolerance = pair.options.start_tolerance;
        let own_width = || OBJECT_SIZES * initial.scale * spread;
        let distance = if is_placed { tolerance.distance.unwrap_or_else(own_width) } else { f64::INFINITY };
        let sees_depth = !pair.image.camera.is_orthographic();
        Some(Self { initial, middle, degrees: tolerance.degrees, distance, sees_depth })
    }

    /// Whether a pose lies within the tolerance and keeps the object's size.
    pub fn holds(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        let mut moved = pose.apply(self.middle) - self.initial.apply(self.middle);
        if !self.sees_depth {
            moved.z = 0.0;
        }
        pose.degrees_to(&self.initial) <= self.degrees
            && moved.norm() <= self.distance
            && gauge::keeps_size(pair, pose, &self.initial)
    }

    /// The prior of registrations that are held near the initial pose; `None` if the image does not depend on distances or
    /// no distance is given.
    pub fn prior(&self, pair: &ViewPair) -> Option<PosePrior> {
        prior(pair, self.initial, self.degrees, Some(self.distance).filter(|distance| !distance.is_infinite()))
    }
}
