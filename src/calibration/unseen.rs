//! Leaves out the part of a cloud that the colour camera cannot see, if the scanner looks all around.

use super::frame::Frame;
use super::unknowns::State;

/// A cloud with a larger share of its points behind the colour camera looks all around. The cloud of a depth camera has
/// no point there.
const BEHIND: f64 = 0.01;
/// Margin around the image, in focal lengths: 8 degrees, because candidates may be off by some degrees.
const MARGIN: f64 = 0.14;

/// Leaves out the points that no state projects near the image, if the cloud looks all around.
pub(super) fn leave_unseen_out(frame: &mut Frame, states: &[State]) {
    let Some(first) = states.first() else { return };
    let is_behind = |index: usize| frame.point(index).is_some_and(|point| first.pose.apply(point).z <= 0.0);
    let known = frame.points.iter().filter(|point| !point[2].is_nan()).count();
    let behind = (0..frame.points.len()).filter(|&index| is_behind(index)).count();
    if behind as f64 <= BEHIND * known as f64 {
        return;
    }
    let camera = frame.camera;
    let size = frame.planes.size;
    let (wide, high) = (MARGIN * camera.fx, MARGIN * camera.fy);
    let may_see = |index: usize| {
        frame.point(index).is_some_and(|point| {
            states.iter().any(|state| {
                camera.project(state.pose.apply(point).into()).is_some_and(|[x, y]| {
                    x > -wide && y > -high && x < size.width as f64 + wide && y < size.height as f64 + high
                })
            })
        })
    };
    let unseen: Vec<usize> = (0..frame.points.len()).filter(|&index| !may_see(index)).collect();
    // If no candidate sees any point, all points stay.
    if unseen.len() < frame.points.len() {
        unseen.into_iter().for_each(|index| frame.points[index] = [f32::NAN; 3]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::planes::Planes;
    use crate::pose::Similarity;
    use crate::view::{Lens, Pinhole, Size};

    #[test]
    fn of_a_scanner_what_lies_behind_the_camera_is_left_out_and_of_a_depth_camera_nothing() {
        let camera = Pinhole { fx: 10.0, fy: 10.0, cx: 9.5, cy: 4.5, lens: Lens::None };
        let size = Size::new("image", 20, 10).unwrap();
        let kept = |mut points: Vec<[f32; 3]>| {
            let count = points.len();
            points.resize(16, [f32::NAN; 3]);
            let planes = Planes { size, pixels: vec![[0.5; 3]; size.len()] };
            let grid = Size::new("depth", 4, 4).unwrap();
            let mut frame = Frame::new(String::new(), planes, camera, grid, points);
            leave_unseen_out(&mut frame, &[State::at(Similarity::identity())]);
            frame.points[..count].iter().map(|point| !point[2].is_nan()).collect::<Vec<_>>()
        };
        let (before, beside, aside) = ([0.0, 0.0, 2.0], [2.2, 0.0, 2.0], [9.0, 0.0, 2.0]);
        assert_eq!(kept(vec![before, beside, aside]), [true, true, true]);
        assert_eq!(kept(vec![before, beside, aside, [0.0, 0.0, -2.0]]), [true, true, false, false]);
    }
}
