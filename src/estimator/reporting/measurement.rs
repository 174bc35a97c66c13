//! Residuals of an iteration: |log S - predicted| for each pixel, and their robust mean.

use nalgebra::Matrix3;

use crate::estimator::objective;
use crate::estimator::pair::ViewPair;
use crate::estimator::solution::Solution;
use crate::estimator::stages::AlbedoStage;
use crate::light::{Light, Polynomial};
use crate::numeric::{LANES, Lanes, quantile};
use crate::pose::Correspondences;
use crate::view::Normals;

/// Residuals within this multiple of their median enter the robust mean.
const MOST_MEDIANS: f32 = 3.0;

/// Residuals of the image's pixels; NaN off the mask.
pub struct PixelResiduals(Vec<f32>);

impl PixelResiduals {
    /// No residuals yet, for this number of pixels.
    pub fn new(pixels: usize) -> Self {
        Self(vec![f32::NAN; pixels])
    }

    pub fn of_pixels(&self) -> &[f32] {
        &self.0
    }

    /// Predicts each pixel from the measured normal of the corresponding depth point, or else from the image's own
    /// normal. Returns the robust mean over the pixels that the depth view reaches, if there are any.
    pub fn measure(
        &mut self,
        pair: &ViewPair,
        albedo: &AlbedoStage,
        solution: &Solution,
        correspondences: &Correspondences,
        spare: &mut Vec<f32>,
    ) -> Option<f64> {
        let light = Polynomial::of(&shading_light(albedo, solution));
        let albedo = albedo.found().map(|found| &found.albedo);
        let seen = SeenNormals::new(pair, solution, correspondences);
        spare.clear();
        for start in (0..self.0.len()).step_by(LANES) {
            let mut normals = [[f32::NAN; LANES]; 3];
            let mut is_reached = [false; LANES];
            for lane in 0..LANES {
                let pixel = start + lane;
                if pair.image.mask.get(pixel).is_some_and(|&inside| inside) {
                    let (normal, reached) = seen.of_pixel(pixel);
                    is_reached[lane] = reached;
                    [normals[0][lane], normals[1][lane], normals[2][lane]] = normal;
                }
            }
            let residuals = objective::residuals(&pair.image, albedo, start, &light, normals.map(Lanes::from));
            residuals.store(&mut self.0[start..]);
            let reached = residuals.array().into_iter().zip(is_reached).filter(|(_, reached)| *reached);
            spare.extend(reached.map(|(residual, _)| residual));
        }
        (!spare.is_empty()).then(|| robust_mean(spare))
    }
}

/// The normals from which the image's pixels are predicted, in the colour view's frame.
struct SeenNormals<'a> {
    measured: &'a Normals,
    own: &'a Normals,
    correspondences: &'a Correspondences,
    rotation: Matrix3<f32>,
}

impl<'a> SeenNormals<'a> {
    fn new(pair: &'a ViewPair, solution: &'a Solution, correspondences: &'a Correspondences) -> Self {
        let rotation = solution.pose.rotation.cast::<f32>();
        Self { measured: &pair.depth.normals, own: &solution.image.normals, correspondences, rotation }
    }

    /// The measured normal if the depth view reaches the pixel, else the image's own; and whether it is the measured
    /// one.
    fn of_pixel(&self, pixel: usize) -> ([f32; 3], bool) {
        match self.correspondences.normal_at(pixel, self.measured) {
            Some(normal) => ((self.rotation * normal).into(), true),
            None => (self.own.get(pixel), false),
        }
    }
}

/// The light of the shading, with exposure and tint.
fn shading_light(albedo: &AlbedoStage, solution: &Solution) -> Light {
    solution.light.total().tinted(albedo.found().map_or([0.0; 3], |found| found.tint))
}

/// Log shading of each image pixel, R, G, B interleaved, as predicted for [`PixelResiduals`]. NaN off the mask.
pub fn shading(
    pair: &ViewPair,
    albedo: &AlbedoStage,
    solution: &Solution,
    correspondences: &Correspondences,
) -> Vec<f32> {
    let light = shading_light(albedo, solution);
    let seen = SeenNormals::new(pair, solution, correspondences);
    let of_pixel = |(pixel, &inside): (usize, &bool)| {
        let normal = if inside { seen.of_pixel(pixel).0 } else { [f32::NAN; 3] };
        light.shade(normal.map(f64::from)).map(|log| log as f32)
    };
    pair.image.mask.iter().enumerate().flat_map(of_pixel).collect()
}

fn robust_mean(residuals: &mut [f32]) -> f64 {
    let most = MOST_MEDIANS * quantile(residuals, 0.5);
    let (sum, count) =
        residuals.iter().filter(|&&r| r <= most).fold((0.0, 0.0), |(sum, count), &r| (sum + f64::from(r), count + 1.0));
    sum / f64::max(count, 1.0)
}
