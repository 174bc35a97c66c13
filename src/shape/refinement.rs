//! Shading-based refinement of the depth view (Eq. 17 to 19; docs/method/heights.md): shape from shading over the
//! pixels of the other view.
//!
//! Each depth pixel visible to the colour camera has a colour, which its normal, rotated into the colour view's frame,
//! must explain. The solver of single pixels therefore runs over the depth pixels, with the prior of Eq. 19 (the normal
//! found in the image there). The heights then follow these normals and the colours, anchored to the measured depth
//! with a weight set by its noise. Noise decreases where there is shading, holes inside the mask are filled, and
//! nothing moves elsewhere.
//!
//! Limits: an organised cloud has no depth along a ray; its normals are refined, and its points stay.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};

use super::heights::{
    Bending, COLOUR_SCALES, Effort, FAR_DAMPING, HALVING_CONFIDENCE, HeightDomain, HeightProblem, LAST_SCALE, Scratch,
};
use super::integration::{AnchorWeight, Anchors, IntegrationOptions, Integrator, Robustness, find_slopes};
use super::pixels::{ShadingProblem, ShadingSolver, ShadingWeights};
use crate::diagnosis::MIXED_NOISE;
use crate::error::Result;
use crate::light::Light;
use crate::view::{ColourView, DepthView, Normals, depth_noise, normals};

/// Error of the shading as a multiple of the image's noise. Set on Mozart at 64x64 with depth noise of half a pixel
/// under colourful and natural light (docs/lab/thresholds.md).
const SHADING_ERROR: f64 = 1.4;
/// Error of the shading that discretisation adds, as a share of the colours' spread. Set on the same data.
const DISCRETISATION: f64 = 0.065;
/// Bounds of the weight of an anchor, squared log residual per squared pixel of height. Whatever its noise, depth keeps
/// some weight and does not override the colours.
const ANCHOR_WEIGHTS: [f64; 2] = [1e-3, 10.0];
/// Share of the resistance to bending that yields to colours if these determine the surface better than its roughness does. Set on
/// Mozart at 64x64 under four lights and on photographs with quantised depth, which need all of the bending
/// (docs/lab/thresholds.md).
const GIVEN_WAY: f64 = 0.75;
/// Work at each scale of the first refinement, in which noisy depth starts far from its colours.
const FIRST: Effort = Effort { steps: 6, iterations: 40, tolerance: 0.03, damping: FAR_DAMPING };
/// Work of a refinement that continues an earlier one, at the last scale only.
const LATER: Effort = Effort { steps: 1, iterations: 20, tolerance: 0.03, damping: FAR_DAMPING };
/// Largest number of sweeps that extend slopes into a hole, and thus its largest radius in pixels.
const FILL_SWEEPS: usize = 256;

/// Input of a refinement.
#[derive(Clone, Copy)]
pub struct RefinementProblem<'a> {
    /// The measured depth view.
    pub depth: &'a DepthView,
    /// The colour view.
    pub image: &'a ColourView,
    /// Continuous image column and row of each depth pixel, NaN where the colour camera does not see it.
    pub position: [&'a [f32]; 2],
    /// Normals of the image surface in the colour view's frame.
    pub image_normals: &'a Normals,
    /// Light, rotation and weights.
    pub terms: RefinementTerms,
}

/// Input of a refinement other than rasters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RefinementTerms {
    /// The light, with exposure.
    pub light: Light,
    /// R of the pose.
    pub rotation: Matrix3<f64>,
    /// Weights of Eq. 17; `prior` is lambda_g2.
    pub weights: ShadingWeights,
    /// Error of the colours under the light, log units; zero for a known light.
    pub colour_error: f64,
}

/// Refines one depth view repeatedly; the caller lends the scratch, which has the view's size.
pub struct Refiner {
    solver: ShadingSolver,
    domain: HeightDomain,
    /// The image's log colours at the depth pixels.
    log: [Vec<f32>; 3],
    /// Standard deviation of the shading, log units.
    shading_error: f64,
    /// Weight of a measured depth relative to the shading, or to its neighbours where there is no colour.
    anchor_weight: f32,
    /// Whether the depth has been refined before, so that it starts close to its colours.
    continues: bool,
}

impl Refiner {
    /// A refiner for one depth view with the colours of one image.
    ///
    /// # Errors
    /// [`crate::ErrorKind::Empty`] if the view's mask is empty.
    pub fn new(depth: &DepthView, image: &ColourView) -> Result<Self> {
        let length = depth.size.len();
        let zeros = || vec![0.0; length];
        let shading_error = (SHADING_ERROR * image.log_noise()).hypot(DISCRETISATION * image.log_spread());
        Ok(Self {
            solver: ShadingSolver::new(),
            domain: HeightDomain::new(depth.size, depth.camera, &depth.mask)?,
            log: [zeros(), zeros(), zeros()],
            shading_error,
            anchor_weight: anchor_weight(shading_error, depth),
            continues: false,
        })
    }

    /// A refiner that continues from a depth refined by another one.
    #[must_use]
    pub fn resumed(self) -> Self {
        Self { continues: true, ..self }
    }

    /// The domain of the view's unknown heights.
    pub const fn domain(&self) -> &HeightDomain {
        &self.domain
    }

    /// Fills the holes of the measured depth smoothly, as an initial guess that gives hidden pixels a position in the
    /// image.
    ///
    /// # Errors
    /// The errors of the integration.
    pub fn fill(&self, scratch: &mut Scratch, view: &DepthView, depth: &mut [f32]) -> Result<()> {
        if view.organised {
            depth.copy_from_slice(view.depth());
            return Ok(());
        }
        find_slopes(view.size, &view.camera, &view.normals, &view.mask, &mut scratch.slopes);
        for slopes in &mut scratch.slopes {
            extend(view, slopes, &mut scratch.spare);
        }
        self.load_anchors(scratch, view, view.depth(), |_| self.anchor_weight);
        let options = IntegrationOptions { robustness: Robustness::Off, ..IntegrationOptions::default() };
        let anchors = Anchors { height: &scratch.spare, weight: AnchorWeight::PerPixel(&scratch.weight) };
        let [p, q] = &scratch.slopes;
        // The integrator is needed only once, so its memory is not kept.
        Integrator::new(view.size, &view.mask)?.integrate(p, q, Some(anchors), &options, depth)?;
        view.camera.depth_from_heights(depth);
        Ok(())
    }

    /// One refinement: `normals` (depth view's frame) and `depth` hold the current estimate and receive the new one.
    pub fn refine(
        &mut self,
        scratch: &mut Scratch,
        problem: RefinementProblem<'_>,
        normals: &mut Normals,
        depth: &mut [f32],
    ) {
        let view = problem.depth;
        self.sample_colours(problem);
        self.refine_normals(scratch, problem, normals);
        if view.organised {
            return;
        }
        // Colours that the light does not explain have a larger variance, so depth weighs more relative to them.
        let variance_inflation = (problem.terms.colour_error / self.shading_error).max(1.0).powi(2);
        let shaded = (f64::from(self.anchor_weight) * variance_inflation).min(ANCHOR_WEIGHTS[1]) as f32;
        // If the surface's resistance to bending is known, it also weighs against depth without colours.
        let unshaded = if view.noise.is_visible() { shaded } else { self.anchor_weight };
        let error = self.shading_error.max(problem.terms.colour_error);
        let bending = bending(shaded, [variance_inflation, (MIXED_NOISE / error).min(1.0).powi(2)], view);
        self.load_anchors(scratch, view, view.measured(), |has_colour| if has_colour { shaded } else { unshaded });
        find_slopes(view.size, &view.camera, normals, &view.mask, &mut scratch.slopes);
        view.camera.heights_from_depth(depth);
        let (scales, effort) = if self.continues { (&[LAST_SCALE][..], LATER) } else { (&COLOUR_SCALES[..], FIRST) };
        self.continues = true;
        let anchors = Anchors { height: &scratch.spare, weight: AnchorWeight::PerPixel(&scratch.weight) };
        for &colour_scale in scales {
            let height_problem = HeightProblem {
                log: [&self.log[0], &self.log[1], &self.log[2]],
                light: &problem.terms.light,
                rotation: &problem.terms.rotation,
                slopes: [&scratch.slopes[0], &scratch.slopes[1]],
                normal_weight: None,
                bending,
                anchors: Some(anchors),
                colour_scale,
                effort,
            };
            scratch.heights.solve(&mut self.domain, height_problem, depth);
        }
        view.camera.depth_from_heights(depth);
        normals::of_depth_into(view.size, view.camera, depth, normals);
    }

    /// Eq. 17 for each pixel by itself. An organised cloud, whose pixels have no rays, gets only this step.
    fn refine_normals(&mut self, scratch: &mut Scratch, problem: RefinementProblem<'_>, normals: &mut Normals) {
        let RefinementTerms { light, rotation, weights, .. } = &problem.terms;
        let back = rotation.transpose();
        for band in Scratch::bands(problem.depth.size) {
            scratch.resize_band(&band);
            let Scratch { prior, found, .. } = scratch;
            sample_prior(problem, &band, prior);
            normals.rotate(&band, rotation, found, 0);
            let log = self.log.each_ref().map(|channel| &channel[band.clone()]);
            self.solver.solve(ShadingProblem { log, prior, light }, *weights, found);
            for (place, index) in band.clone().enumerate() {
                if !found.is_valid(place) {
                    found.set(place, rotate(rotation, normals.get(index)));
                }
            }
            found.rotate(&(0..band.len()), &back, normals, band.start);
        }
    }

    /// Bilinear log colours at the positions of the depth pixels, from their known neighbours; NaN if all are off the
    /// mask.
    fn sample_colours(&mut self, problem: RefinementProblem<'_>) {
        let [columns, rows] = problem.position;
        let channels = problem.image.log.each_ref().map(Vec::as_slice);
        let [red, green, blue] = &mut self.log;
        let pixels = red.iter_mut().zip(green).zip(blue).zip(columns.iter().zip(rows));
        for (((red, green), blue), (&column, &row)) in pixels {
            [*red, *green, *blue] = problem.image.size.each_bilinear_of_known(channels, column, row);
        }
    }

    /// Sets anchors at the measured heights.
    fn load_anchors(&self, scratch: &mut Scratch, view: &DepthView, depth: &[f32], weight: impl Fn(bool) -> f32) {
        scratch.spare.copy_from_slice(depth);
        view.camera.heights_from_depth(&mut scratch.spare);
        for (anchor_weight, log) in scratch.weight.iter_mut().zip(&self.log[0]) {
            *anchor_weight = weight(!log.is_nan());
        }
    }
}

/// Eq. 19: the image's normal at each depth pixel of a band, in the colour view's frame.
fn sample_prior(problem: RefinementProblem<'_>, band: &Range<usize>, prior: &mut Normals) {
    let [columns, rows] = problem.position;
    for (place, index) in band.clone().enumerate() {
        let seen = problem.image.size.nearest(columns[index], rows[index]);
        prior.set(place, seen.map_or([f32::NAN; 3], |pixel| problem.image_normals.get(pixel)));
    }
}

/// The map's own prior of its surface's second differences, relative to anchors of this weight. It yields to colours in
/// proportion to their reliability.
fn bending(anchor_weight: f32, [variance_inflation, explained]: [f64; 2], view: &DepthView) -> Bending {
    if !view.noise.is_visible() {
        return Bending::FREE;
    }
    let weight = (f64::from(anchor_weight) * view.noise.smoothing() * (1.0 - GIVEN_WAY * explained)) as f32;
    Bending { weight, scale: view.noise.crease() as f32, halving: HALVING_CONFIDENCE * variance_inflation as f32 }
}

/// The weight is (shading error / depth noise)^2, because least squares weighs each by its variance.
fn anchor_weight(shading_error: f64, view: &DepthView) -> f32 {
    if view.noise.is_visible() {
        return variance_ratio(shading_error, view.noise.sigma);
    }
    let mut heights = view.depth().to_vec();
    view.camera.heights_from_depth(&mut heights);
    variance_ratio(shading_error, depth_noise::white_noise(view.size, &heights))
}

/// The ratio of the variances, limited by bounds. Depth without measurable noise gets the largest weight, however exact
/// the colours are.
fn variance_ratio(shading_error: f64, depth_noise: f64) -> f32 {
    let weight = if depth_noise > 0.0 { (shading_error / depth_noise).powi(2) } else { f64::INFINITY };
    weight.clamp(ANCHOR_WEIGHTS[0], ANCHOR_WEIGHTS[1]) as f32
}

/// Extends a field into the unknown pixels of the mask, ring by ring: each becomes the mean of its known neighbours.
fn extend(view: &DepthView, field: &mut [f32], spare: &mut [f32]) {
    for _ in 0..FILL_SWEEPS {
        spare.copy_from_slice(field);
        let mut changed = false;
        for index in (0..field.len()).filter(|&index| view.mask[index]) {
            if !spare[index].is_nan() {
                continue;
            }
            let (mut sum, mut count) = (0.0, 0.0);
            for neighbour in view.size.neighbours(index) {
                if !spare[neighbour].is_nan() {
                    sum += spare[neighbour];
                    count += 1.0;
                }
            }
            if count > 0.0 {
                field[index] = sum / count;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
}

fn rotate(rotation: &Matrix3<f64>, vector: [f32; 3]) -> [f32; 3] {
    let rotated = rotation * Vector3::from(vector.map(f64::from));
    [rotated.x as f32, rotated.y as f32, rotated.z as f32]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_depth_has_the_largest_weight_even_beside_exact_colours() {
        assert_eq!(variance_ratio(0.0, 0.0), ANCHOR_WEIGHTS[1] as f32);
        assert_eq!(variance_ratio(0.05, 0.0), ANCHOR_WEIGHTS[1] as f32);
        assert_eq!(variance_ratio(0.0, 0.5), ANCHOR_WEIGHTS[0] as f32);
        assert!((variance_ratio(0.05, 0.5) - 0.01).abs() < 1e-6);
    }
}
