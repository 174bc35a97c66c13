//! The viewing direction of a cloud's scanner. Depth cameras look along z, and LiDARs along x or y of their vehicle, or
//! all around.
//!
//! The check works in the colour camera's frame, except where it measures the noise of the depth map and tests its
//! plausibility. These need depths in the scanner's frame: the coordinate along the axis nearest to the mean direction,
//! or the distance if the scanner looks all around.

/// Length of the mean unit direction below which a scanner looks all around; directions that fill a cone of 120 degrees
/// have a mean of length 0.75.
const ALL_AROUND: f64 = 0.5;

/// A direction along an axis of the cloud's frame, or all directions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ahead {
    Along { axis: usize, sign: f32 },
    Around,
}

impl Ahead {
    /// The axis nearest to the mean direction of all valid points; z without any valid point.
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

    /// Depth of a point along the viewing direction, or its distance for a scanner that looks all around.
    pub fn depth(self, point: &[f32; 3]) -> f32 {
        match self {
            Self::Along { axis, sign } => sign * point[axis],
            Self::Around => point[0].hypot(point[1]).hypot(point[2]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
}
