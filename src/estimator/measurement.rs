//! What an iteration leaves unexplained: |log S - predicted| pixel by pixel, and its robust mean.

use nalgebra::Vector3;

use super::objective;
use super::pair::ViewPair;
use super::solution::Solution;
use crate::light::Polynomial;
use crate::numeric::{LANES, Lanes, quantile};
use crate::pose::Correspondences;

/// Residuals within this multiple of their median enter the robust mean.
const MOST_MEDIANS: f32 = 3.0;

/// Residuals of the image's pixels; NaN off the mask.
pub struct Residuals(Vec<f32>);

impl Residuals {
    /// None yet, for so many pixels.
    pub fn new(pixels: usize) -> Self {
        Self(vec![f32::NAN; pixels])
    }

    pub fn of_pixels(&self) -> &[f32] {
        &self.0
    }

    /// Predicts each pixel from the measured normal of the depth view where it reaches, from the image's own normal
    /// elsewhere. Returns the robust mean over the pixels that the depth view reaches, if there are any.
    pub fn measure(
        &mut self,
        pair: &ViewPair,
        solution: &Solution,
        correspondences: &Correspondences,
        spare: &mut Vec<f32>,
    ) -> Option<f64> {
        let light = Polynomial::of(&solution.light.total());
        let rotation = solution.pose.rotation.cast::<f32>();
        spare.clear();
        for start in (0..self.0.len()).step_by(LANES) {
            let mut normals = [[f32::NAN; LANES]; 3];
            let mut is_reached = [false; LANES];
            for lane in 0..LANES {
                let pixel = start + lane;
                if !pair.image.mask.get(pixel).is_some_and(|&inside| inside) {
                    continue;
                }
                let index = usize::try_from(correspondences.depth_of_pixel()[pixel]).ok();
                let index = index.filter(|&index| pair.depth.normals.is_valid(index));
                is_reached[lane] = index.is_some();
                let normal = match index {
                    Some(index) => (rotation * Vector3::from(pair.depth.normals.get(index))).into(),
                    None => solution.image.normals.get(pixel),
                };
                [normals[0][lane], normals[1][lane], normals[2][lane]] = normal;
            }
            let residuals = objective::residuals(&pair.image, start, &light, normals.map(Lanes::from));
            residuals.store(&mut self.0[start..]);
            let reached = residuals.array().into_iter().zip(is_reached).filter(|(_, reached)| *reached);
            spare.extend(reached.map(|(residual, _)| residual));
        }
        (!spare.is_empty()).then(|| robust_mean(spare))
    }
}

fn robust_mean(residuals: &mut [f32]) -> f64 {
    let most = MOST_MEDIANS * quantile(residuals, 0.5);
    let (sum, count) =
        residuals.iter().filter(|&&r| r <= most).fold((0.0, 0.0), |(sum, count), &r| (sum + f64::from(r), count + 1.0));
    sum / f64::max(count, 1.0)
}
