//! A frame with the points and depth edges of a pose over its image.

use super::discontinuities;
use super::frame::Projection;
use super::input::RigView;
use super::input::rigid;
use crate::error::Result;
use crate::pose::Similarity;

/// The points and depth edges of a frame, projected into its image by a calibration.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    /// Column, row, depth in metres of each visible point.
    pub points: Vec<f32>,
    /// x, y, z of the same points in the colour camera's frame, metres.
    pub positions: Vec<f32>,
    /// Column, row of each point of a depth edge.
    pub edges: Vec<f32>,
}

/// Projects a frame into its image by a pose, in the pixels of the image as given.
///
/// # Errors
/// As [`CalibrationCheck::new`](crate::CalibrationCheck::new).
pub fn overlay(view: RigView, pose: &Similarity) -> Result<Overlay> {
    let (frame, _) = view.prepare(0, &mut vec![])?;
    let state = rigid(pose).map_err(|error| error.below("pose"))?;
    let projection = Projection::new(&frame, &state);
    // Converts pixels of a halved image to those of the image as given.
    let original = |value: f64| ((value + 0.5) * frame.pixel - 0.5) as f32;
    let size = frame.planes.size;
    let is_seen = |index: &usize| {
        let [column, row] = projection.pixels[*index];
        !projection.is_hidden[*index] && size.nearest(column, row).is_some()
    };
    let (mut points, mut positions) = (vec![], vec![]);
    for index in (0..frame.points.len()).filter(is_seen) {
        let [column, row] = projection.pixels[index].map(f64::from);
        points.extend([original(column), original(row), projection.positions[index][2]]);
        positions.extend(projection.positions[index]);
    }
    let edges = discontinuities::find(&frame, &projection);
    Ok(Overlay {
        points,
        positions,
        edges: edges.iter().flat_map(|discontinuity| discontinuity.pixel.map(original)).collect(),
    })
}
