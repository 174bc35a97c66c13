//! Which way a cloud's scanner looks: depth cameras along z, lidars along the x or y of their vehicle, or all around.
//!
//! A pose takes points from any frame, and most of the check looks at them in the colour camera's. What it says of the depth map itself,
//! its noise and its doubts, needs depths. They are those along the axis of the cloud's frame that is nearest to the mean direction, and
//! distances where a scanner looks all around. Of such a cloud only what the colour camera may see is kept.

use super::frame::Frame;
use super::unknowns::State;

/// Mean directions shorter than this are those of a scanner that looks all around; of a cone of 120 degrees it has 0.75.
const ALL_AROUND: f64 = 0.5;
/// Share of points behind the colour camera from which on a cloud is a scanner's. A depth camera beside it has none.
const BEHIND: f64 = 0.01;
/// How far from the image points may fall to be kept, as a share of the focal length: 8 degrees, twice what a candidate is off by.
const MARGIN: f64 = 0.14;

/// One of the six directions along the axes of a cloud's frame, or all of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ahead {
    Along { axis: usize, sign: f32 },
    Around,
}

impl Ahead {
    /// The direction nearest to the mean of those of all valid points; z where there is none.
    pub fn of(points: &[[f32; 3]]) -> Self {
        let (mut sum, mut count) = ([0.0_f64; 3], 0.0);
        for point in points.iter().filter(|point| !point[2].is_nan()) {
            let point = point.map(f64::from);
            let range = point[0].hypot(point[1]).hypot(point[2]);
            if range > 0.0 {
                (0..3).for_each(|k| sum[k] += point[k] / range);
                count += 1.0;
            }
        }
        if sum[0].hypot(sum[1]).hypot(sum[2]) < ALL_AROUND * count {
            return Self::Around;
        }
        let axis = [1, 0].into_iter().fold(2, |best, k| if sum[k].abs() > sum[best].abs() { k } else { best });
        Self::Along { axis, sign: if sum[axis] < 0.0 { -1.0 } else { 1.0 } }
    }

    /// How far ahead a point lies.
    pub fn depth(self, point: &[f32; 3]) -> f32 {
        match self {
            Self::Along { axis, sign } => sign * point[axis],
            Self::Around => point[0].hypot(point[1]).hypot(point[2]),
        }
    }
}

/// Leaves out of a scanner's cloud what none of the states puts near the image.
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
    // Candidates that see nothing are judged on all there is.
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
    fn depth_cameras_look_along_z_and_lidars_along_x_or_around() {
        let seen = |ahead: fn(f32, f32) -> [f32; 3]| {
            let mut points = vec![[f32::NAN; 3]];
            points.extend((-9..=9).flat_map(|a| (-9..=9).map(move |b| ahead(a as f32 / 10.0, b as f32 / 10.0))));
            let found = Ahead::of(&points);
            assert!(points[1..].iter().all(|point| found.depth(point) == 2.0), "{found:?}");
            found
        };
        assert_eq!(seen(|a, b| [a, b, 2.0]), Ahead::Along { axis: 2, sign: 1.0 });
        assert_eq!(seen(|a, b| [2.0, a, b]), Ahead::Along { axis: 0, sign: 1.0 });
        assert_eq!(seen(|a, b| [a, -2.0, b]), Ahead::Along { axis: 1, sign: -1.0 });
        assert_eq!(Ahead::of(&[]), Ahead::Along { axis: 2, sign: 1.0 });
        let ring: Vec<[f32; 3]> = [[2.0, 0.0, 0.0], [-2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, -2.0, 0.0]].into();
        assert_eq!((Ahead::of(&ring), Ahead::of(&ring).depth(&ring[1])), (Ahead::Around, 2.0));
    }

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
