//! Conversion between the caller's units and the working units. They differ if an image without a camera is worked on
//! at another size than the caller's.

use nalgebra::Vector3;

use crate::options::{Options, Start};
use crate::pose::Similarity;
use crate::report::StepReport;
use crate::view::WorkingSize;

/// The options for the working view.
pub fn options_in(resizing: Option<&WorkingSize>, mut options: Options) -> Options {
    let Some(resizing) = resizing else { return options };
    let (unit, shift) = (resizing.unit(), resizing.shift());
    options.correspondence_distance = options.correspondence_distance.map(|distance| distance / resizing.factor());
    options.scale = options.scale.map(|scale| scale / unit);
    if let Start::Pose { scale, translation, .. } = &mut options.start {
        *scale = scale.map(|scale| scale / unit);
        *translation = translation.map(|translation| (translation - shift) / unit);
    }
    options
}

/// A pose in the caller's units.
pub fn pose_out(resizing: &WorkingSize, pose: &Similarity) -> Similarity {
    Similarity {
        scale: resizing.unit() * pose.scale,
        rotation: pose.rotation,
        translation: point_out(resizing, pose.translation),
    }
}

/// A point of the colour view's frame in the caller's units.
pub fn point_out(resizing: &WorkingSize, point: Vector3<f64>) -> Vector3<f64> {
    resizing.unit() * point + resizing.shift()
}

/// The report in the caller's units.
pub fn report_out(resizing: &WorkingSize, report: &StepReport) -> StepReport {
    let mut report = report.clone();
    report.pose = pose_out(resizing, &report.pose);
    report.rivals.iter_mut().for_each(|rival| *rival = pose_out(resizing, rival));
    if let Some(uncertainty) = &mut report.uncertainty {
        for sigma in uncertainty.translation.iter_mut().chain([&mut uncertainty.scale]).flatten() {
            *sigma *= resizing.unit();
        }
    }
    report
}
