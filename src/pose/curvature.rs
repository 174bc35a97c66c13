//! Curvature of the depth map, which the albedo often follows: dirt and ambient shadow lie in hollows, wear on ridges.

use crate::pose::contrast::LocalMeans;
use crate::pose::residuals::MEASURED_SIDE;
use crate::view::{Normals, Size};

/// Sigmas of the Gaussians, depth pixels of an object of the size of [`MEASURED_SIDE`].
const SCALES: [f64; 2] = [1.5, 4.0];
/// Curvatures are clamped to this many standard deviations.
const LARGEST: f32 = 2.5;

/// Curvature of each depth pixel on a fine and a coarse scale, in standard deviations, positive where the surface bulges
/// toward the camera; zero where a neighbour is missing.
pub(super) fn curvatures(size: Size, normals: &Normals) -> [Vec<f32>; 2] {
    SCALES.map(|scale| curvature(size, normals, scale))
}

/// Divergence of the normals, smoothed by a Gaussian.
fn curvature(size: Size, normals: &Normals, scale: f64) -> Vec<f32> {
    let valid: Vec<f32> = (0..size.len()).map(|index| f32::from(u8::from(normals.is_valid(index)))).collect();
    let slope = |index: usize| if valid[index] > 0.0 { [normals.x[index], normals.y[index]] } else { [0.0; 2] };
    let slopes: Vec<[f32; 2]> = (0..size.len()).map(slope).collect();
    let count = valid.iter().sum::<f32>().max(1.0);
    let unit = f64::from(count).sqrt() / MEASURED_SIDE;
    let smooth = LocalMeans::new(size.width, size.len(), scale * unit).smoothed(&valid, &slopes);
    let divergence = |index: usize| {
        let (column, row) = size.position(index);
        let is_inside = column > 0 && row > 0 && column + 1 < size.width && row + 1 < size.height;
        if !is_inside || valid[index] == 0.0 {
            return 0.0;
        }
        let beside = [index - 1, index + 1, index - size.width, index + size.width];
        let [left, right, above, below] = beside.map(|at| smooth[at]);
        let is_whole = beside.iter().all(|&at| valid[at] > 0.0);
        if is_whole { right[0] - left[0] + below[1] - above[1] } else { 0.0 }
    };
    let mut curvature: Vec<f32> = (0..size.len()).map(divergence).collect();
    let square = curvature.iter().map(|value| value * value).sum::<f32>() / count;
    let spread = square.sqrt().max(f32::MIN_POSITIVE);
    curvature.iter_mut().for_each(|value| *value = (*value / spread).clamp(-LARGEST, LARGEST));
    curvature
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Size = Size { width: 60, height: 60 };

    /// Normals of the front of a ball, which face the camera; those of a bowl have the opposite sign of x and y.
    fn ball(sign: f32) -> Normals {
        let mut normals = Normals::missing(SIZE.len());
        for index in 0..SIZE.len() {
            let (column, row) = SIZE.position(index);
            let [x, y] = [column, row].map(|at| (at as f32 - 29.5) / 30.0);
            let square = x * x + y * y;
            if square < 0.9 {
                normals.set(index, [sign * x, sign * y, -(1.0 - square).sqrt()]);
            }
        }
        normals
    }

    #[test]
    fn balls_bulge_and_bowls_are_hollow() {
        let middle = SIZE.index(30, 30);
        let [bulging, hollow] = [1.0, -1.0].map(|sign| curvature(SIZE, &ball(sign), 1.5)[middle]);
        assert!(bulging > 0.5 && hollow < -0.5, "{bulging} {hollow}");
        assert_eq!(curvature(SIZE, &ball(1.0), 1.5)[0], 0.0);
    }
}
