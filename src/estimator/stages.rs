//! The stages of one iteration: each reads the solution so far and writes its own part of it.

use nalgebra::Vector3;

use super::merit::Candidate;
use super::{Estimator, gauge, merit};
use crate::error::{Error, ErrorKind, Result};
use crate::light::{Light, Polynomial};
use crate::numeric::{LANES, Lanes, quantile};
use crate::options::{LightSource, Registration, Weights};
use crate::pose::{CorrespondenceProblem, IcpOptions, IcpProblem, RansacOptions, Similarity, ransac};
use crate::shape::{ImageShapeProblem, ImageShapeSolver, ShadingWeights, first_exposure};
use crate::view::{ColourView, Normals, Points};

/// Median log residual up to which a fitted light counts as explaining the colours: noise and discretisation.
const EXPLAINED: f64 = 0.07;
/// Solves of normals and exposure in the first iteration, which starts from a look at the colours alone.
const FIRST_EXPOSURE_ROUNDS: usize = 4;
/// ICP pairs points up to this distance at first, image pixels, once there is a pose to start from.
const FIRST_DISTANCE: f64 = 8.0;
/// ICP pairs points up to this distance in the end, image pixels: twice the paper's threshold, weighted robustly.
const FINAL_DISTANCE: f64 = 2.0;
/// Pairs within this distance agree with a pose, image pixels: the paper's threshold.
const CONSENSUS_DISTANCE: f64 = 1.0;
/// Most pairs that are asked for a consensus, evenly spread.
const MOST_VOTERS: usize = 2000;
/// A correspondence is accepted within this multiple of the robust spread of the surfaces' distances.
const SPREADS: f64 = 3.0;

impl Estimator {
    /// Everything that iteration zero needs: holes guessed, points raised, correspondences by the first pose.
    pub(super) fn prepare(&mut self) -> Result<()> {
        let Self { refiner, scratch, depth, solution, .. } = self;
        scratch.resize(depth.size.len());
        refiner.fill(scratch, depth, &mut solution.depth_points.z)?;
        solution.raise_depth_points(depth);
        if let LightSource::Known(light) = self.options.light {
            let log = &self.image.log;
            self.first_exposure = first_exposure(&light, [&log[0], &log[1], &log[2]]);
            self.solution.exposure = self.first_exposure;
        }
        self.update_correspondences();
        self.fit_light()?;
        self.kept.keep(&self.solution);
        self.measure();
        Ok(())
    }

    /// Light from the depth view's normals where the present pose puts them (Eq. 2). A known light is left alone: its
    /// exposure follows with the normals.
    pub(super) fn fit_light(&mut self) -> Result<()> {
        self.carry_normals();
        if self.options.light == LightSource::Estimate {
            let log = &self.image.log;
            let weight = self.options.weights.light;
            let fit = self.fitter.fit(&self.carried_normals, [&log[0], &log[1], &log[2]], &self.prior, weight)?;
            self.solution.light = fit.light;
            self.unexplained = fit.residual;
        }
        if let Some(found) = self.colours_found() {
            (self.solution.light, self.solution.exposure) = (found.light, found.exposure);
        }
        Ok(())
    }

    /// Normals of the colour view (Eq. 6 to 9).
    pub(super) fn shade(&mut self) -> Result<()> {
        let known = self.options.light != LightSource::Estimate;
        let rounds = if known && self.report.iteration == 0 { FIRST_EXPOSURE_ROUNDS } else { 1 };
        for _ in 0..rounds {
            let light = self.solution.exposed_light();
            let problem =
                shape_problem(&self.image, &self.carried_normals, &light, &self.options.weights, self.unexplained);
            self.shape.solve_normals(&problem, &mut self.solution.image_normals);
            // The registration has found the exposure together with the pose.
            if known && self.colours_found().is_none() {
                let moved = self.solution.exposure - self.first_exposure;
                self.solution.exposure +=
                    ImageShapeSolver::exposure_step(&problem, &self.solution.image_normals, moved);
            }
        }
        Ok(())
    }

    /// Weights of the refinement's normals.
    pub(super) fn refinement_weights(&self) -> ShadingWeights {
        let Weights { refinement, unit, .. } = self.options.weights;
        ShadingWeights::with_robust_prior((refinement * variance_inflation(self.unexplained)) as f32, unit as f32)
    }

    /// Heights of the colour view from its normals.
    pub(super) fn raise_surface(&mut self) -> Result<()> {
        let light = self.solution.exposed_light();
        let problem =
            shape_problem(&self.image, &self.carried_normals, &light, &self.options.weights, self.unexplained);
        let (normals, points) = (&mut self.solution.image_normals, &mut self.solution.image_points);
        self.shape.solve_surface(&mut self.scratch, &problem, normals, &mut points.z)?;
        if self.image.camera.is_orthographic() {
            let middle = median_of(&self.solution.image_points.z, &mut self.scratch.spare).unwrap_or(0.0);
            self.solution.image_points.z.iter_mut().for_each(|depth| *depth -= middle);
        } else {
            self.match_distance();
        }
        self.solution.raise_image_points(&self.image);
        self.settle_gauge();
        Ok(())
    }

    /// Pose (Eq. 12 to 16), then the correspondences that it gives.
    pub(super) fn register(&mut self) -> Result<()> {
        if self.pixel_length() <= 0.0 {
            return Err(Error::new(ErrorKind::Degenerate, "pose", "puts the object behind the colour camera"));
        }
        let before = self.pose();
        self.proposed_change = 0.0;
        let registration = self.registration();
        if registration == Registration::Joint {
            self.register_colours(&before)?;
            self.proposed_change = before.degrees_to(&self.solution.pose);
        }
        if registration == Registration::Icp {
            let found = self.match_surfaces(before)?;
            self.proposed_change = before.degrees_to(&found);
            self.solution.pose = if self.trust < 1.0 {
                before.towards(&found, self.trust, self.solution.depth_points.centroid())
            } else {
                found
            };
            self.hold_scale();
        }
        self.settle_gauge();
        self.update_correspondences();
        Ok(())
    }

    /// ICP, then the consensus of its pairs: of both poses the one with the lower merit over the same pairs.
    fn match_surfaces(&mut self, start: Similarity) -> Result<Similarity> {
        let pixel = self.pixel_length();
        let problem = IcpProblem {
            depth_points: &self.solution.depth_points,
            depth_normals: &self.solution.depth_normals,
            image_points: &self.solution.image_points,
            image_normals: &self.solution.image_normals,
            image_size: self.image.size,
            start,
        };
        let scale_is_held = self.options.scale.is_some() && self.image.camera.is_orthographic();
        let options = IcpOptions {
            scale_is_held,
            first_distance: (self.report.iteration > 0).then_some(FIRST_DISTANCE * pixel),
            final_distance: FINAL_DISTANCE * pixel,
            ..IcpOptions::default()
        };
        let found = self.icp.register(&problem, &options)?;
        let mut uncertainty = found.information.uncertainty(found.rms, &found.pose, &self.image.camera);
        // Behind a pinhole image the matching frees a scale that is the surface's, not the pose's.
        uncertainty.scale = uncertainty.scale.filter(|_| gauge::held_scale(&self.image, &self.options).is_none());
        self.report.uncertainty = Some(uncertainty);
        let [depth_points, image_points] = &mut self.paired_points;
        self.icp.paired_points(&problem, depth_points, image_points, MOST_VOTERS);
        let consensus = RansacOptions {
            threshold: CONSENSUS_DISTANCE * pixel,
            scale: scale_is_held.then_some(start.scale),
            seed: self.options.seed,
            ..RansacOptions::default()
        };
        // Pairs that agree on nothing leave the pose to ICP.
        let agreed = ransac(depth_points, image_points, &consensus).map_or(found.pose, |report| report.pose);
        // The jury is fixed before the poses are compared: the points that the start sees.
        let jury: Vec<u32> = self.jury().collect();
        let light = self.solution.exposed_light();
        let merit = |pose: &Similarity| {
            let candidate = Candidate { pose, ..self.candidate(&light) };
            merit::energy(&self.image, &self.depth, &jury, candidate).total()
        };
        let better = if merit(&agreed) < merit(&found.pose) { agreed } else { found.pose };
        self.refused = found.information.is_degenerate()
            || merit::worsens(merit(&start), merit(&better), start.degrees_to(&better));
        Ok(if self.refused { start } else { better })
    }

    /// Length of an image pixel at the object.
    pub(super) fn pixel_length(&self) -> f64 {
        if self.image.camera.is_orthographic() {
            return 1.0;
        }
        gauge::pixel_length(&self.image, self.solution.carried_centre().z)
    }

    /// Projects the depth points, hides what is occluded, and drops what is too far from the image surface.
    pub(super) fn update_correspondences(&mut self) {
        let pixel = self.pixel_length();
        let problem = CorrespondenceProblem {
            image: &self.image,
            depth: &self.depth,
            pose: &self.solution.pose,
            depth_points: &self.solution.depth_points,
            depth_normals: &self.solution.depth_normals,
            image_points: &self.solution.image_points,
            image_normals: &self.solution.image_normals,
            distance: self.options.correspondence_distance.map(|distance| distance * pixel),
            pixel_length: pixel,
            spreads: SPREADS,
        };
        self.correspondences.update(&problem);
    }

    /// Normals of the depth view at the image pixels: R n_R of Eq. 9.
    fn carry_normals(&mut self) {
        let rotation = self.solution.pose.rotation.cast::<f32>();
        for (pixel, &index) in self.correspondences.depth_of_pixel().iter().enumerate() {
            let carried = usize::try_from(index).ok().map(|index| self.solution.depth_normals.get(index));
            let normal = carried.map_or([f32::NAN; 3], |normal| (rotation * Vector3::from(normal)).into());
            self.carried_normals.set(pixel, normal);
        }
    }

    /// Overlap, inliers and residuals of the present correspondences.
    pub(super) fn measure(&mut self) {
        let light = Polynomial::of(&self.solution.exposed_light());
        let rotation = self.solution.pose.rotation.cast::<f32>();
        self.scratch.spare.clear();
        for start in (0..self.residual.len()).step_by(LANES) {
            let mut normals = [[f32::NAN; LANES]; 3];
            let mut is_carried = [false; LANES];
            for lane in 0..LANES {
                let pixel = start + lane;
                if !self.image.mask.get(pixel).is_some_and(|&inside| inside) {
                    continue;
                }
                let index = usize::try_from(self.correspondences.depth_of_pixel()[pixel]).ok();
                let index = index.filter(|&index| self.depth.normals.is_valid(index));
                is_carried[lane] = index.is_some();
                let normal = match index {
                    Some(index) => (rotation * Vector3::from(self.depth.normals.get(index))).into(),
                    None => self.solution.image_normals.get(pixel),
                };
                [normals[0][lane], normals[1][lane], normals[2][lane]] = normal;
            }
            let residuals = merit::residuals(&self.image, start, &light, normals.map(Lanes::from));
            residuals.store(&mut self.residual[start..]);
            let carried = residuals.array().into_iter().zip(is_carried).filter(|(_, carried)| *carried);
            self.scratch.spare.extend(carried.map(|(residual, _)| residual));
        }
        self.report.overlap = self.correspondences.count() as f64 / self.depth.valid().max(1) as f64;
        self.report.inliers = self.correspondences.inliers();
        if !self.scratch.spare.is_empty() {
            let residuals = &mut self.scratch.spare;
            let scale = merit::SPREADS_OF_MEDIAN * quantile(residuals, 0.5);
            let (sum, count) =
                residuals.iter().filter(|&&r| r <= scale).fold((0.0, 0.0), |(s, c), &r| (s + f64::from(r), c + 1.0));
            self.report.residual = sum / f64::max(count, 1.0);
        }
    }

    /// Behind a pinhole image the pose keeps its scale and the surface takes the rest.
    fn hold_scale(&mut self) {
        let Some(held) = gauge::held_scale(&self.image, &self.options) else { return };
        let factor = held / self.solution.pose.scale;
        if self.image.camera.is_orthographic() || factor == 1.0 {
            return;
        }
        self.solution.pose.scale = held;
        self.solution.pose.translation *= factor;
        for depth in &mut self.solution.image_points.z {
            *depth *= factor as f32;
        }
        self.solution.raise_image_points(&self.image);
    }

    /// Orthographic gauge: the median depth difference of the overlap is zero.
    fn settle_gauge(&mut self) {
        if self.image.camera.is_orthographic()
            && let Some(difference) = self.median_gap(|image, depth| image - depth)
        {
            self.solution.pose.translation.z += difference;
        }
    }

    /// Pinhole gauge: the image surface stands as far away as the depth points that fall on it.
    fn match_distance(&mut self) {
        let ratio = self.median_gap(|image, depth| depth / image);
        let Some(ratio) = ratio.filter(|ratio| *ratio > 0.0) else { return };
        for depth in &mut self.solution.image_points.z {
            *depth *= ratio as f32;
        }
    }

    /// Median over the correspondences of a function of the image surface's depth and the depth point's.
    fn median_gap(&mut self, gap: impl Fn(f64, f64) -> f64) -> Option<f64> {
        let (row, shift) =
            (self.solution.pose.scale * self.solution.pose.rotation.row(2), self.solution.pose.translation.z);
        let Points { x, y, z } = &self.solution.depth_points;
        self.scratch.spare.clear();
        for (&index, &depth) in self.correspondences.depth_of_pixel().iter().zip(&self.solution.image_points.z) {
            let Ok(index) = usize::try_from(index) else { continue };
            if !depth.is_nan() {
                let [x, y, z] = [f64::from(x[index]), f64::from(y[index]), f64::from(z[index])];
                self.scratch.spare.push(gap(f64::from(depth), row[0] * x + row[1] * y + row[2] * z + shift) as f32);
            }
        }
        (!self.scratch.spare.is_empty()).then(|| f64::from(quantile(&mut self.scratch.spare, 0.5)))
    }
}

/// Colours that even the fitted light leaves unexplained (texture, cast shadows) have so many times the usual variance.
fn variance_inflation(unexplained: f64) -> f64 {
    (unexplained / EXPLAINED).max(1.0).powi(2)
}

fn shape_problem<'a>(
    image: &'a ColourView,
    prior: &'a Normals,
    light: &'a Light,
    weights: &Weights,
    unexplained: f64,
) -> ImageShapeProblem<'a> {
    ImageShapeProblem {
        image,
        light,
        prior,
        prior_weight: weights.prior,
        unit_weight: weights.unit,
        variance_inflation: variance_inflation(unexplained),
    }
}

fn median_of(values: &[f32], spare: &mut Vec<f32>) -> Option<f32> {
    spare.clear();
    spare.extend(values.iter().filter(|value| !value.is_nan()));
    (!spare.is_empty()).then(|| quantile(spare, 0.5))
}
