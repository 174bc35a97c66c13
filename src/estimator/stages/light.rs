//! The light stage (Eq. 2): fits the light to the depth view's normals under the current pose.

use super::albedo::AlbedoStage;
use crate::diagnosis::MIXED_NOISE;
use crate::error::Result;
use crate::estimator::pair::ViewPair;
use crate::estimator::solution::Solution;
use crate::light::{Light, LightFitter};
use crate::pose::{Correspondences, Similarity};
use crate::shape::first_exposure;
use crate::view::{ColourView, Normals};

/// Input of the stages after the light, besides the solution.
#[derive(Clone, Copy)]
pub struct Inputs<'a> {
    pub pair: &'a ViewPair,
    /// The image without the albedo, from which shape is found.
    pub colours: &'a ColourView,
    /// The light stage, which has the depth view's normals at the image's pixels and the variance of the colours.
    pub fitted: &'a LightStage,
    pub correspondences: &'a Correspondences,
    /// Whether this is the first iteration.
    pub is_first: bool,
}

impl<'a> Inputs<'a> {
    /// The input of an iteration, numbered from zero.
    pub fn of(
        pair: &'a ViewPair,
        albedo: &'a AlbedoStage,
        fitted: &'a LightStage,
        correspondences: &'a Correspondences,
        iteration: u32,
    ) -> Self {
        Self { pair, colours: albedo.colours(pair), fitted, correspondences, is_first: iteration == 0 }
    }
}

/// Fits the light, and derives how much the colours weigh against the priors.
pub struct LightStage {
    fitter: LightFitter,
    /// R n_R of Eq. 9: normals of the depth view at the image's pixels, colour view's frame, NaN where no depth point
    /// falls.
    depth_normals: Normals,
    /// Exposure of a known light from the colours alone, before any normal is known.
    first_exposure: f64,
    /// Median log residual under the fitted light; zero for a known light.
    residual: f64,
}

impl LightStage {
    /// Allocates for this number of image pixels.
    pub fn new(pixels: usize) -> Self {
        Self {
            fitter: LightFitter::default(),
            depth_normals: Normals::missing(pixels),
            first_exposure: 0.0,
            residual: 0.0,
        }
    }

    /// The initial exposure of a known light.
    pub fn find_first_exposure(&mut self, pair: &ViewPair) -> f64 {
        self.first_exposure = pair.known_light().map_or(0.0, |light| first_exposure(light, pair.log()));
        self.first_exposure
    }

    /// Transfers the depth view's normals to the image's pixels, and fits the light to them and to the colours without
    /// the albedo. `None` for a known light, whose exposure is found with the normals.
    pub fn fit(
        &mut self,
        pair: &ViewPair,
        colours: &ColourView,
        solution: &Solution,
        correspondences: &Correspondences,
    ) -> Result<Option<Light>> {
        self.bring_normals(pair, &solution.depth.normals, &solution.pose, correspondences);
        if pair.known_light().is_some() {
            return Ok(None);
        }
        let weight = pair.options.weights.light;
        let fit =
            self.fitter.fit(&self.depth_normals, colours.log.each_ref().map(Vec::as_slice), &pair.prior, weight)?;
        self.residual = fit.residual;
        Ok(Some(fit.light))
    }

    /// Transfers `normals` of the depth view to the image's pixels.
    pub fn bring_normals(
        &mut self,
        pair: &ViewPair,
        normals: &Normals,
        pose: &Similarity,
        correspondences: &Correspondences,
    ) {
        let rotation = pose.rotation.cast::<f32>();
        for (pixel, &inside) in pair.image.mask.iter().enumerate() {
            let normal = if inside { correspondences.normal_at(pixel, normals) } else { None };
            self.depth_normals.set(pixel, normal.map_or([f32::NAN; 3], |normal| (rotation * normal).into()));
        }
    }

    /// Normals of the depth view at the image's pixels, colour view's frame, as used by the last fit.
    pub const fn depth_normals(&self) -> &Normals {
        &self.depth_normals
    }

    /// Difference of an exposure from the one that the colours alone suggest.
    pub fn exposure_change(&self, exposure: f64) -> f64 {
        exposure - self.first_exposure
    }

    /// Median log residual under the fitted light; zero for a known light.
    pub const fn residual(&self) -> f64 {
        self.residual
    }

    /// Factor by which the variance of the colours exceeds its usual value. Colours that even the fitted light does not
    /// explain (texture, cast shadows) weigh less, so priors weigh more.
    pub fn variance_inflation(&self) -> f64 {
        (self.residual / MIXED_NOISE).max(1.0).powi(2)
    }
}
