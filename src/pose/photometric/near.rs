//! Two terms of the pose, in addition to the image residuals, near an initial pose that is trusted to some degree: the
//! object's points have to lie on the image's mask, and a Gaussian holds the pose.
//!
//! A point off the mask is a residual like any other. Far off, it costs a fixed share of the square of the robust
//! scale, which is the cost of a point whose colours do not fit at all. Pixels of the mask that no point covers cost
//! nothing, because the depth camera may not have seen that part of the object. Points beyond the frame cost nothing,
//! either, where the frame cuts the object off.
//!
//! An object that recedes shrinks into its mask and onto pixels that are easily explained. Its distance is therefore
//! freed last. On blurred levels the Gaussian almost fixes it.
//!
//! Residuals under varying albedo correlate, so the Gaussian needs a weight relative to their sums. During annealing it
//! is a constant. In the rounds with instruments it is M C, with the matrix M of the image's equations and their
//! covariance C. The solution of M (x - x1) + M C P (x - x0) = 0 is then the mean of the image's x1 and the initial x0,
//! weighted by the inverse C^-1 of the one covariance and the inverse P of the other.

use nalgebra::Vector3;

use super::problem::PhotometricProblem;
use super::weighting::CORRELATED;
use crate::pose::increment::Frame;
use crate::pose::prior::PosePrior;
use crate::pose::silhouette::{SLACK, Silhouette};
use crate::pose::similarity::Similarity;
use crate::pose::sums::Sums;
use crate::view::extent;

/// Maximum number of points that are tested against the mask.
const MOST_POINTS: usize = 2000;
/// Weight of a point off the mask relative to one whose colours do not fit; set on pairs of a statue
/// (docs/lab/thresholds.md).
const OFF_WEIGHT: f64 = 0.5;
/// Distance off the mask at which a point's weight has fallen to a quarter, pixels, for each level of the image. It is
/// about the error of the pose that the level can correct.
const SCALES: [f64; 4] = [6.0, 6.0, 12.0, 20.0];
/// Sigma of the distance on all levels but the sharp one, as a share of the prior's.
const DISTANCE_FIRST: f64 = 0.1;

/// The mask and the points tested against it; owns its memory.
pub(super) struct MaskAndPrior {
    /// `None` if the whole image is the object.
    silhouette: Option<Silhouette>,
    points: Vec<Vector3<f64>>,
    middle: Vector3<f64>,
}

/// Weights of the terms at one state.
#[derive(Clone, Copy)]
pub(super) struct MaskAndPriorWeights {
    /// Sum of the weights of all points.
    pub points: f64,
    /// The robust scale, log units.
    pub robust_scale: f64,
    /// Standard deviation of the residuals, log units.
    pub noise: f64,
    /// Level of the image.
    pub level: usize,
}

impl MaskAndPrior {
    /// Built from the mask and the points of a problem.
    pub fn new(problem: &PhotometricProblem<'_>) -> Self {
        let object = &problem.image.whole.object;
        let stride = problem.points.valid().count().div_ceil(MOST_POINTS).max(1);
        Self {
            silhouette: object.contains(&false).then(|| Silhouette::new(problem.image.size, object)),
            points: problem.points.valid().step_by(stride).collect(),
            middle: extent(problem.points.valid()).0,
        }
    }

    /// Both terms at a pose during annealing, with derivatives by the unknowns of `frame`.
    pub fn sums(
        &self,
        problem: &PhotometricProblem<'_>,
        prior: &PosePrior,
        pose: &Similarity,
        frame: &Frame,
        weights: MaskAndPriorWeights,
    ) -> Sums {
        let mut sums = self.mask(problem, pose, frame, weights);
        let MaskAndPriorWeights { noise, level, .. } = weights;
        let along = if level > 0 { DISTANCE_FIRST * prior.along } else { prior.along };
        let prior = PosePrior { along, ..*prior };
        self.add_prior(&prior, pose, frame, CORRELATED * noise * noise, &mut sums);
        sums
    }

    /// The prior alone, in squares of its sigmas.
    pub fn prior(&self, prior: &PosePrior, pose: &Similarity, frame: &Frame) -> Sums {
        let mut sums = Sums::new();
        self.add_prior(prior, pose, frame, 1.0, &mut sums);
        sums
    }

    fn add_prior(&self, prior: &PosePrior, pose: &Similarity, frame: &Frame, weight: f64, sums: &mut Sums) {
        prior.for_each(self.middle, pose, frame, |row, residual| sums.add(row, residual, weight, f64::INFINITY));
    }

    /// The points off the mask.
    pub fn mask(
        &self,
        problem: &PhotometricProblem<'_>,
        pose: &Similarity,
        frame: &Frame,
        weights: MaskAndPriorWeights,
    ) -> Sums {
        let mut sums = Sums::new();
        let Some(silhouette) = &self.silhouette else { return sums };
        let MaskAndPriorWeights { points, robust_scale, level, .. } = weights;
        let scale = SCALES[level];
        let share = OFF_WEIGHT * points / self.points.len().max(1) as f64 * (robust_scale / scale).powi(2);
        for point in &self.points {
            let point = pose.apply(*point);
            let seen = problem.image.camera.project_with_gradient(problem.image.size, point.into());
            let Some((place, slopes)) = seen else { continue };
            let (distance, [right, down]) = silhouette.smoothly_signed_at(place);
            if distance > SLACK {
                let [by_column, by_row] = slopes.map(|slope| frame.row(&point, &slope.into()));
                sums.add(&(right * by_column + down * by_row), distance - SLACK, share, scale);
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::LightPrior;
    use crate::pose::increment::{PoseVector, UNKNOWNS};
    use crate::view::{ColourImage, ColourSamples, ColourView, DepthMap, DepthSamples, DepthView, Lens, Pinhole};

    const SIDE: usize = 40;
    const WEIGHTS: MaskAndPriorWeights =
        MaskAndPriorWeights { points: 100.0, robust_scale: 0.1, noise: 0.02, level: 0 };

    fn lens() -> Pinhole {
        Pinhole { fx: 50.0, fy: 50.0, cx: 19.5, cy: 19.5, lens: Lens::None }
    }

    fn disc(radius: f64) -> Vec<u8> {
        let inside = |index: usize| {
            let [x, y] = [index % SIDE, index / SIDE].map(|at| at as f64 - 19.5);
            u8::from(x.hypot(y) < radius)
        };
        (0..SIDE * SIDE).map(inside).collect()
    }

    /// A disc at one metre in front of a mask of another size.
    fn views(mask: f64, object: f64) -> (ColourView, DepthView) {
        let image = ColourImage {
            width: SIDE,
            height: SIDE,
            samples: ColourSamples::RgbLinear(vec![0.5; 3 * SIDE * SIDE]),
            transfer: None,
            mask: Some(disc(mask)),
            camera: Some(lens()),
        };
        let depth = DepthMap {
            width: SIDE,
            height: SIDE,
            samples: DepthSamples::Float(vec![1.0; SIDE * SIDE]),
            unit: None,
            mask: Some(disc(object)),
            normals: None,
            camera: Some(lens()),
        };
        (ColourView::new(image).unwrap(), DepthView::new(&depth, false).unwrap())
    }

    fn sums(views: &(ColourView, DepthView), initial: Similarity, pose: &Similarity, frame: &Frame) -> Sums {
        let (image, depth) = views;
        let light = LightPrior::natural();
        let prior = PosePrior { pose: initial, rotation: 0.05, across: 0.02, along: 0.02 };
        let problem = PhotometricProblem {
            image,
            depth_size: depth.size,
            points: &depth.points,
            normals: &depth.normals,
            normal_error: None,
            depth_noise: depth.noise,
            light: None,
            prior: &light,
            prior_weight: 1.0,
            scale_is_held: true,
            near: Some(prior),
        };
        MaskAndPrior::new(&problem).sums(&problem, &prior, pose, frame, WEIGHTS)
    }

    const FRAME: Frame = Frame { centre: Vector3::new(0.0, 0.0, 1.0), length: 0.1 };

    #[test]
    fn what_no_point_covers_costs_nothing_and_points_off_the_mask_do() {
        let here = Similarity::identity();
        let [small, large] = [(15.0, 8.0), (8.0, 15.0)].map(|(mask, object)| views(mask, object));
        assert_eq!(sums(&small, here, &here, &FRAME).cost, 0.0);
        assert!(sums(&large, here, &here, &FRAME).cost > 0.01);
    }

    #[test]
    fn points_beyond_a_frame_that_cuts_the_object_off_cost_nothing() {
        let here = Similarity::identity();
        let beyond = Similarity { translation: Vector3::x() * 0.3, ..here };
        let [cut, whole] = [40.0, 15.0].map(|mask| views(mask, 8.0));
        assert_eq!(sums(&cut, beyond, &beyond, &FRAME).cost, 0.0);
        assert!(sums(&whole, beyond, &beyond, &FRAME).cost > 0.01);
    }

    #[test]
    fn the_gradient_is_the_difference_quotient() {
        let views = views(12.0, 12.0);
        let initial = Similarity::identity();
        let pose = Similarity { translation: Vector3::new(0.11, -0.07, 0.01), ..initial };
        let cost = |pose: &Similarity| sums(&views, initial, pose, &FRAME).cost;
        let gradient = sums(&views, initial, &pose, &FRAME).gradient;
        let small = 1e-5;
        for k in 0..UNKNOWNS - 1 {
            let moved = |by: f64| {
                let mut step = PoseVector::zeros();
                step[k] = by;
                cost(&FRAME.change(&step).after(&pose))
            };
            // Half of the derivative of the cost. The derivative of the distance is a difference over several pixels.
            let slope = (moved(small) - moved(-small)) / (4.0 * small);
            let off = (gradient[k] - slope).abs();
            assert!(off < 0.2 * gradient.norm(), "{k}: {} {slope}", gradient[k]);
        }
    }
}
