//! Which way a cloud's scanner looks: depth cameras along z, lidars along the x or y of their vehicle.
//!
//! A pose takes points from any frame, and most of the check looks at them in the colour camera's. What it says of the depth map itself,
//! its noise and its doubts, needs depths, and they are those along the axis of the cloud's frame that is nearest to the mean direction.

/// One of the six directions along the axes of a cloud's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Ahead {
    axis: usize,
    sign: f32,
}

impl Ahead {
    /// The direction nearest to the mean of those of all valid points; z where there is none.
    pub fn of(points: &[[f32; 3]]) -> Self {
        let mut sum = [0.0_f64; 3];
        for point in points.iter().filter(|point| !point[2].is_nan()) {
            let point = point.map(f64::from);
            let range = point[0].hypot(point[1]).hypot(point[2]);
            if range > 0.0 {
                (0..3).for_each(|k| sum[k] += point[k] / range);
            }
        }
        let axis = [1, 0].into_iter().fold(2, |best, k| if sum[k].abs() > sum[best].abs() { k } else { best });
        Self { axis, sign: if sum[axis] < 0.0 { -1.0 } else { 1.0 } }
    }

    /// How far ahead a point lies.
    pub fn depth(self, point: &[f32; 3]) -> f32 {
        self.sign * point[self.axis]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depth_cameras_look_along_z_and_lidars_along_x() {
        let seen = |ahead: fn(f32, f32) -> [f32; 3]| {
            let mut points = vec![[f32::NAN; 3]];
            points.extend((-9..=9).flat_map(|a| (-9..=9).map(move |b| ahead(a as f32 / 10.0, b as f32 / 10.0))));
            let found = Ahead::of(&points);
            assert!(points[1..].iter().all(|point| found.depth(point) == 2.0), "{found:?}");
            found
        };
        assert_eq!(seen(|a, b| [a, b, 2.0]), Ahead { axis: 2, sign: 1.0 });
        assert_eq!(seen(|a, b| [2.0, a, b]), Ahead { axis: 0, sign: 1.0 });
        assert_eq!(seen(|a, b| [a, -2.0, b]), Ahead { axis: 1, sign: -1.0 });
        assert_eq!(Ahead::of(&[]), Ahead { axis: 2, sign: 1.0 });
    }
}
