//! The pair in which the pose of large views is searched: both views at the resolution that distinguishing poses
//! requires, so that the search takes equally long at any size. All pixels are registered from the pose it finds.

use nalgebra::Vector3;

use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::PhotometricRegistration;
use crate::options::Start;
use crate::pose::{PhotometricReport, Similarity};
use crate::view::{ColourView, DepthView};

use super::local_optima::Choice;

/// Largest number of object pixels at which a view is searched at full resolution: a frame of 128x128. Set on views of
/// 640x480 (docs/lab/thresholds.md).
const MOST_PIXELS: usize = 128 * 128;

/// The halved pair, its photometric registration, and the transformation from its frames to those of the views.
pub struct HalvedPair {
    pub pair: ViewPair,
    pub photometric: PhotometricRegistration,
    image: Frame,
    depth: Frame,
}

/// Unit length and origin of a coarse frame, in the frame of the view.
#[derive(Clone, Copy)]
struct Frame {
    unit: f64,
    origin: Vector3<f64>,
}

impl HalvedPair {
    /// Whether nothing is known about the pose and a view is large.
    pub fn is_called_for(pair: &ViewPair) -> bool {
        pair.options.start == Start::Search && (is_large_image(&pair.image) || is_large_depth(&pair.depth))
    }

    /// The halved pair for a large view; `None` if the pair itself is searched.
    #[inline(never)]
    pub fn of(pair: &ViewPair) -> Option<Self> {
        if !Self::is_called_for(pair) {
            return None;
        }
        let halve_image =
            |view: &ColourView| is_large_image(view).then(|| (view.halved(), Frame::of_halved(view.half_origin())));
        let halve_depth =
            |view: &DepthView| is_large_depth(view).then(|| (view.halved(), Frame::of_halved(view.half_origin())));
        let image = coarsest(&pair.image, halve_image);
        let depth = coarsest(&pair.depth, halve_depth);
        let (image, image_frame) = image.unwrap_or_else(|| (pair.image.clone(), Frame::OWN));
        let (depth, depth_frame) = depth.unwrap_or_else(|| (pair.depth.clone(), Frame::OWN));
        let mut options = pair.options.clone();
        options.scale = options.scale.map(|scale| scale * depth_frame.unit / image_frame.unit);
        let pair = ViewPair { image, depth, options, prior: pair.prior.clone(), resizing: None };
        Some(Self { photometric: PhotometricRegistration::new(&pair), pair, image: image_frame, depth: depth_frame })
    }

    /// Converts a pose of the coarse pair to the views' frames.
    #[inline(never)]
    pub fn pose_out(&self, pose: &Similarity) -> Similarity {
        let Self { image, depth, .. } = self;
        let scale = pose.scale * image.unit / depth.unit;
        let translation = image.unit * pose.translation + image.origin - scale * (pose.rotation * depth.origin);
        Similarity { scale, rotation: pose.rotation, translation }
    }

    /// Converts a pose of the views to the frames of the coarse pair.
    pub fn pose_in(&self, pose: &Similarity) -> Similarity {
        let Self { image, depth, .. } = self;
        let translation = pose.translation - image.origin + pose.scale * (pose.rotation * depth.origin);
        let scale = pose.scale * depth.unit / image.unit;
        Similarity { scale, rotation: pose.rotation, translation: translation / image.unit }
    }

    /// Converts a choice in the coarse pair to the views.
    pub fn choice_out(&self, mut choice: Choice) -> Choice {
        let poses = choice.rivals.iter_mut().chain(&mut choice.ends);
        poses.for_each(|pose| *pose = self.pose_out(pose));
        Choice { best: choice.best.map(|best| self.report_out(best)), ..choice }
    }

    /// Converts a registration of the coarse pair to the views, for which it counts as a registration of sampled
    /// points.
    fn report_out(&self, mut report: Box<PhotometricReport>) -> Box<PhotometricReport> {
        report.pose = self.pose_out(&report.pose);
        report.sampled = true;
        for sigma in report.uncertainty.translation.iter_mut().flatten() {
            *sigma *= self.image.unit;
        }
        report.uncertainty.scale = report.uncertainty.scale.map(|sigma| sigma * self.image.unit / self.depth.unit);
        report
    }
}

impl Frame {
    /// The frame of the view itself.
    const OWN: Self = Self { unit: 1.0, origin: Vector3::new(0.0, 0.0, 0.0) };

    /// The frame of a halved view, measured in its pixels; the view's own frame if that is not in pixels.
    fn of_halved(origin: Option<Vector3<f64>>) -> Self {
        origin.map_or(Self::OWN, |origin| Self { unit: 2.0, origin })
    }

    /// Converts a frame that is given relative to this frame to one relative to the view.
    fn then(self, inner: Self) -> Self {
        Self { unit: self.unit * inner.unit, origin: self.origin + self.unit * inner.origin }
    }
}

fn is_large_image(view: &ColourView) -> bool {
    view.mask.iter().filter(|&&inside| inside).count() > MOST_PIXELS
}

fn is_large_depth(view: &DepthView) -> bool {
    view.valid() > MOST_PIXELS
}

/// The view, halved until it is small enough; `None` if it already is.
fn coarsest<T>(view: &T, halve: impl Fn(&T) -> Option<(T, Frame)>) -> Option<(T, Frame)> {
    let (mut coarse, mut frame) = halve(view)?;
    while let Some((coarser, inner)) = halve(&coarse) {
        (coarse, frame) = (coarser, frame.then(inner));
    }
    Some((coarse, frame))
}
