//! Detects a hollow depth map, such as a bowl seen from inside, or a map whose larger numbers are nearer.
//!
//! At the occluding contours of a solid object, where it turns away from the camera, the normals face outward. In a map
//! with mirrored depths they face inward. The image cannot distinguish the two, because mirrored depth gives the same
//! image if light and pose are also mirrored in depth.
//!
//! Limits: a relief that ends before it turns away has no occluding contours and is not judged.

use crate::reason::Reason;
use crate::view::{DepthView, Normals, Size};

/// Distance, in pixels, at which pixels without depth are searched, because the normals of the last pixel are
/// one-sided.
const BEYOND: isize = 2;
/// Outward component of a normal above which a border pixel lies on an occluding contour. The surface has then turned
/// away by 37 degrees.
const LEAST_OUTWARD: f32 = 0.6;
/// Ratio of inward to outward contour pixels above which a map counts as hollow. Set on random scenes, their mirrored
/// versions and a capture of a bowl (docs/lab/thresholds.md). Solid objects have inward contour pixels where the map
/// lacks the far part of a surface that is seen from the side.
const HOLLOW: f64 = 1.5;
/// Smallest number of contour pixels for a verdict.
const FEWEST: usize = 12;

/// Directions of the eight pixels that are checked for depth.
const AROUND: [[isize; 2]; 8] = [[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1]];

/// The reason to cap a verdict if most occluding contours of the depth map face inward. Mirrored, such a map has another
/// pose that fits as well.
pub fn hollow(depth: &DepthView) -> Option<Reason> {
    is_hollow(depth.size, &depth.points.z, &depth.normals).then_some(Reason::Hollow)
}

/// Whether most occluding contours face inward. `depths` are NaN where missing.
fn is_hollow(size: Size, depths: &[f32], normals: &Normals) -> bool {
    let (mut inward, mut outward) = (0_usize, 0_usize);
    for index in (0..size.len()).filter(|&index| normals.x[index].is_finite()) {
        let [x, y] = out(size, depths, index);
        let length = x.hypot(y);
        if length == 0.0 {
            continue;
        }
        let along = (normals.x[index] * x + normals.y[index] * y) / length;
        inward += usize::from(along < -LEAST_OUTWARD);
        outward += usize::from(along > LEAST_OUTWARD);
    }
    inward >= FEWEST && inward as f64 > HOLLOW * outward as f64
}

/// Outward direction from a border pixel; zero for other pixels. Pixels outside the frame are unknown and do not count.
fn out(size: Size, depths: &[f32], index: usize) -> [f32; 2] {
    let (column, row) = size.position(index);
    let mut sum = [0.0; 2];
    for [right, down] in AROUND {
        let beside = (column.checked_add_signed(BEYOND * right), row.checked_add_signed(BEYOND * down));
        let (Some(u), Some(v)) = beside else { continue };
        if u < size.width && v < size.height && depths[size.index(u, v)].is_nan() {
            sum = [sum[0] + right as f32, sum[1] + down as f32];
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{DepthMap, DepthSamples};

    const SIDE: usize = 40;

    /// Judges a map of depths, NaN where missing.
    fn judged(depth: impl Fn(f32, f32) -> f32) -> bool {
        let middle = (SIDE as f32 - 1.0) / 2.0;
        let at = |index: usize| depth((index % SIDE) as f32 - middle, (index / SIDE) as f32 - middle);
        let samples = DepthSamples::Float((0..SIDE * SIDE).map(at).collect());
        let map = DepthMap { width: SIDE, height: SIDE, samples, unit: None, mask: None, camera: None, normals: None };
        let view = DepthView::new(&map, true).expect("a depth map");
        is_hollow(view.size, &view.points.z, &view.normals)
    }

    /// Depth of a ball's near side, measured from its nearest point.
    fn ball(x: f32, y: f32, radius: f32) -> f32 {
        radius - (radius * radius - x * x - y * y).sqrt()
    }

    #[test]
    fn a_ball_is_solid_and_its_mirror_image_hollow() {
        assert!(!judged(|x, y| 100.0 + ball(x, y, 16.0)));
        assert!(judged(|x, y| 100.0 - ball(x, y, 16.0)));
    }

    #[test]
    fn a_bowl_that_shows_its_outside_as_well_is_solid() {
        // The far half of the bowl shows the inside, the near half the outside.
        assert!(!judged(|x, y| 100.0 + ball(x, y, 16.0) * if y < 0.0 { -1.0 } else { 1.0 }));
    }

    #[test]
    fn what_has_no_contour_is_not_judged() {
        assert!(!judged(|x, y| if x.abs() < 15.0 && y.abs() < 15.0 { 100.0 + 0.3 * x } else { f32::NAN }));
        // A bowl that fills the frame has its border outside.
        assert!(!judged(|x, y| 100.0 - ball(x, y, 40.0)));
    }
}
