//! The pair that the initialisation works on: where views are large, both at the resolution that telling one pose from
//! another needs, so that the opening takes as long at any size. The pose that it finds is a start for all pixels.

use nalgebra::Vector3;

use crate::estimator::pair::ViewPair;
use crate::estimator::stages::ColourRegistration;
use crate::options::Start;
use crate::pose::{PhotometricReport, Similarity};
use crate::view::{ColourView, DepthView};

/// Object pixels up to which a view is searched as it is: a frame of 128x128. On random scenes of that size poses are
/// found within 0.07 degrees at the median, and a registration of all pixels starts from within degrees.
const MOST_PIXELS: usize = 128 * 128;

/// A coarser pair, the registration by its colours, and the way from its frames to those of the views.
pub struct Opening {
    pub pair: ViewPair,
    pub colours: ColourRegistration,
    image: Frame,
    depth: Frame,
}

/// Length of a unit of a coarse frame, and its origin, in the view's own.
#[derive(Clone, Copy)]
struct Frame {
    unit: f64,
    origin: Vector3<f64>,
}

impl Opening {
    /// Whether nothing is known of the pose and a view is large.
    pub fn is_called_for(pair: &ViewPair) -> bool {
        pair.options.start == Start::Search && (is_large_image(&pair.image) || is_large_depth(&pair.depth))
    }

    /// That of a pair whose views are large; `None` where it is worked on as it is.
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
        let pair = ViewPair { image, depth, options, prior: pair.prior.clone(), way: None };
        Some(Self { colours: ColourRegistration::new(&pair), pair, image: image_frame, depth: depth_frame })
    }

    /// A pose of the coarse pair as one of the views.
    #[inline(never)]
    pub fn pose_out(&self, pose: &Similarity) -> Similarity {
        let Self { image, depth, .. } = self;
        let scale = pose.scale * image.unit / depth.unit;
        let translation = image.unit * pose.translation + image.origin - scale * (pose.rotation * depth.origin);
        Similarity { scale, rotation: pose.rotation, translation }
    }

    /// A registration of the coarse pair: one of a part of what the views hold.
    pub fn report_out(&self, mut report: Box<PhotometricReport>) -> Box<PhotometricReport> {
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
    /// That of the view itself.
    const OWN: Self = Self { unit: 1.0, origin: Vector3::new(0.0, 0.0, 0.0) };

    /// That of a halved view, whose pixels are its unit where it has an origin to say.
    fn of_halved(origin: Option<Vector3<f64>>) -> Self {
        origin.map_or(Self::OWN, |origin| Self { unit: 2.0, origin })
    }

    /// A frame within this one as one of the view itself.
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

/// The view halved as often as it can be; `None` where it is small enough.
fn coarsest<T>(view: &T, halve: impl Fn(&T) -> Option<(T, Frame)>) -> Option<(T, Frame)> {
    let (mut coarse, mut frame) = halve(view)?;
    while let Some((coarser, inner)) = halve(&coarse) {
        (coarse, frame) = (coarser, frame.then(inner));
    }
    Some((coarse, frame))
}
