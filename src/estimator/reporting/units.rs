//! Conversion between the caller's units and the working units. They differ if an image without a camera is worked on
//! at another size than the caller's.

use nalgebra::Vector3;

use crate::options::{Options, Start};
use crate::pose::Similarity;
use crate::report::StepReport;
use crate::view::WorkingSize;

/// The options for the working view.
pub fn options_in(way: Option<&WorkingSize>, mut options: Options) -> Options {
    let Some(way) = way else { return options };
    let (unit, shift) = (way.unit(), way.shift());
    options.correspondence_distance = options.correspondence_distance.map(|distance| distance / way.factor());
    options.scale = options.scale.map(|scale| scale / unit);
    if let Start::Pose { scale, translation, .. } = &mut options.start {
        *scale = scale.map(|scale| scale / unit);
        *translation = translation.map(|translation| (translation - shift) / unit);
    }
    options
}

/// A pose in the caller's units.
pub fn pose_out(way: &WorkingSize, pose: &Similarity) -> Similarity {
    Similarity {
        scale: way.unit() * pose.scale,
        rotation: pose.rotation,
        translation: point_out(way, pose.translation),
    }
}

/// A point of the colour view's frame in the caller's units.
pub fn point_out(way: &WorkingSize, point: Vector3<f64>) -> Vector3<f64> {
    way.unit() * point + way.shift()
}

/// The report in the caller's units.
pub fn report_out(way: &WorkingSize, report: &StepReport) -> StepReport {
    let mut report = report.clone();
    report.pose = pose_out(way, &report.pose);
    report.rivals.iter_mut().for_each(|rival| *rival = pose_out(way, rival));
    if let Some(uncertainty) = &mut report.uncertainty {
        for sigma in uncertainty.translation.iter_mut().chain([&mut uncertainty.scale]).flatten() {
            *sigma *= way.unit();
        }
    }
    report
}
