//! Sums over the points of a registration at one state of pose and light: objective, linearised equations, noise, share
//! of inliers.

use super::equations::{Equations, LightEquations, ReducedSystem};
use super::normal_noise::NormalNoise;
use super::points::VisiblePoints;
use super::problem::{Indices, PhotometricProblem};
use super::relief::{Relief, ReliefSums};
use super::residual::{ColourModel, LinearisedPoints, Samples};
use super::state::State;
use super::weighting::Weighting;
use crate::light::{Coefficients, basis};
use crate::numeric::{DOUBLE_LANES, Doubles, Real, dot, quantile, robust};
use crate::pose::increment::Frame;

/// Smallest weight of a point that counts for the noise. Residuals of other points come from their normals, not from
/// the image.
const LEAST_WEIGHT_FOR_NOISE: f64 = 0.25;

/// The residuals of some points at one state, on one level of the image.
pub(super) struct Evaluation<'a> {
    pub problem: &'a PhotometricProblem<'a>,
    pub points: &'a VisiblePoints,
    pub relief: Option<&'a Relief>,
    /// The image model under the light of the state.
    pub model: ColourModel<'a>,
    pub state: &'a State,
    pub weighting: Weighting,
}

/// Variance of a normal along one tangent, relative to the square of the error that its cubic fit reports. That error
/// covers both tangents together, and treats the Gaussian weights of a window as inverse variances, so that its square
/// is 1 / 0.62 of the variance that white noise leaves (0.617 to 0.634 for windows of 2 to 8 pixels, by summation).
const NOISE_VARIANCE: f64 = 0.31;

impl Evaluation<'_> {
    /// Sum of w rho + prior.
    pub fn objective(&self) -> f64 {
        let sum = self.data_term();
        if self.problem.light.is_some() {
            return sum;
        }
        sum + self.weighting.prior * self.problem.prior.squared_distance(&self.state.light)
    }

    /// Sum of w rho. A point that left the mask counts with the largest rho, the square of the robust scale.
    pub fn data_term(&self) -> f64 {
        let squared_scale = self.squared_scale();
        let mut sum = Doubles::splat(0.0);
        self.for_each_square(|weight, shown, square| {
            sum = sum + weight * squared_scale * robust::saturated_if_shown(square, squared_scale, shown);
        });
        sum.sum()
    }

    /// Share of the weights whose residuals are below the robust scale.
    pub fn inlier_share(&self) -> f64 {
        let squared_scale = self.squared_scale();
        let mut sum = Doubles::splat(0.0);
        self.for_each_square(|weight, shown, square| {
            sum = sum + square.less(squared_scale).keep(weight * shown);
        });
        sum.sum() / self.points.weight().max(f64::MIN_POSITIVE)
    }

    /// Robust standard deviation of a channel's residuals, from the median of |r|; infinite without points.
    pub fn noise(&self, scratch: &mut Vec<f32>) -> f64 {
        scratch.clear();
        self.for_each_square(|weight, shown, square| {
            let [weights, squares] = [weight * shown, square].map(Doubles::array);
            let counted = weights.into_iter().zip(squares).filter(|(weight, _)| *weight >= LEAST_WEIGHT_FOR_NOISE);
            scratch.extend(counted.map(|(_, square)| square.sqrt() as f32));
        });
        if scratch.is_empty() {
            return f64::INFINITY;
        }
        f64::from(quantile(scratch, 0.5)) / robust::MEDIAN_OF_THREE
    }

    /// The equations of the pose with the light eliminated; `None` if the points do not determine the light.
    pub fn reduced_system(&self, frame: &Frame) -> Option<ReducedSystem> {
        self.system_without_noise(frame, None)
    }

    /// The equations by instrumental variables, minus the contribution of white noise of the normals. This noise biases
    /// the light towards less contrast, and with it the pose. The contribution is kept if the light would be
    /// undetermined without it.
    pub fn unbiased_system(&self, frame: &Frame) -> Option<ReducedSystem> {
        let noise = self.problem.depth_noise;
        self.system_without_noise(frame, self.problem.normal_error.filter(|_| noise.is_white && noise.is_visible()))
    }

    // Not inlined, because every copy adds to the download.
    #[inline(never)]
    fn system_without_noise(&self, frame: &Frame, errors: Option<&[f32]>) -> Option<ReducedSystem> {
        let (problem, pose) = (self.problem, &self.state.pose);
        let mut equations = Equations::new(problem.light.is_some(), self.model.has_instruments());
        let mut noise = NormalNoise::new();
        self.for_each_linearised(frame, |indices, points, weight| {
            equations.add(points, weight);
            let Some(errors) = errors else { return };
            let error = Doubles::from(indices.map(|index| f64::from(errors[index as usize])));
            noise.add(problem.normals(pose, indices), Doubles::splat(NOISE_VARIANCE) * error * error * weight);
        });
        equations.add_prior(problem.prior, self.weighting.prior, &self.off_the_mean_light());
        if errors.is_none() {
            return equations.reduce();
        }
        let noise = noise.matrix();
        equations.take_off(noise, &self.state.light);
        equations.reduce().or_else(|| {
            equations.take_off(-noise, &self.state.light);
            equations.reduce()
        })
    }

    /// log S at the points, for [`light_equations`](Self::light_equations) under the same pose.
    pub fn sample(&self, samples: &mut Vec<Samples>) {
        samples.clear();
        samples.reserve_exact(self.points.len().div_ceil(DOUBLE_LANES));
        let points = self.points.lane_groups().map(|(indices, _)| self.problem.points(&self.state.pose, &indices));
        samples.extend(points.map(|points| self.model.sample(points)));
    }

    /// The equations of the light under a fixed pose; `samples` belong to the same points under this pose.
    pub fn light_equations(&self, samples: &[Samples]) -> LightEquations {
        let mut equations = LightEquations::new(self.problem.light.is_some());
        for ((indices, weight), samples) in self.points.lane_groups().zip(samples) {
            let normals = self.problem.normals(&self.state.pose, &indices);
            let residual = self.less_albedo(&indices, self.model.residual(samples, normals));
            let weight = weight * samples.shown * self.robust_weight(&residual);
            equations.add(&basis(normals), &residual, weight);
        }
        equations.add_prior(self.problem.prior, self.weighting.prior, &self.off_the_mean_light());
        equations
    }

    /// Visits the points side by side with their indices and weights: each point's weight times its robust weight.
    #[inline(always)]
    pub fn for_each_linearised(&self, frame: &Frame, mut visit: impl FnMut(&Indices, &LinearisedPoints, Doubles)) {
        let (problem, pose) = (self.problem, &self.state.pose);
        for (indices, weight) in self.points.lane_groups() {
            let points = problem.points(pose, &indices);
            let mut linearised = self.model.linearise(points, problem.normals(pose, &indices), frame);
            linearised.residual = self.less_albedo(&indices, linearised.residual);
            visit(&indices, &linearised, weight * linearised.shown * self.robust_weight(&linearised.residual));
        }
    }

    /// Visits the points with their weights, whether the image shows them (one or zero), and |r|^2.
    #[inline(always)]
    fn for_each_square(&self, mut visit: impl FnMut(Doubles, Doubles, Doubles)) {
        let (problem, pose) = (self.problem, &self.state.pose);
        for (indices, weight) in self.points.lane_groups() {
            let samples = self.model.sample(problem.points(pose, &indices));
            let residual = self.model.residual(&samples, problem.normals(pose, &indices));
            let residual = self.less_albedo(&indices, residual);
            visit(weight, samples.shown, dot(residual, residual));
        }
    }

    /// Sums for a fit of the albedo that follows the relief.
    pub fn relief_sums(&self, samples: &[Samples]) -> ReliefSums {
        let mut sums = ReliefSums::new();
        let Some(relief) = self.relief else { return sums };
        for ((indices, weight), samples) in self.points.lane_groups().zip(samples) {
            let normals = self.problem.normals(&self.state.pose, &indices);
            let residual = self.less_albedo(&indices, self.model.residual(samples, normals));
            let weight = (weight * samples.shown * self.robust_weight(&residual)).array();
            let residual = residual.map(Doubles::array);
            for (lane, &index) in indices.iter().enumerate().filter(|(lane, _)| weight[*lane] > 0.0) {
                relief.add(
                    &mut sums,
                    index as usize,
                    [0, 1, 2].map(|channel: usize| residual[channel][lane]),
                    weight[lane],
                );
            }
        }
        sums
    }

    /// Residuals minus the albedo that follows the relief.
    #[inline(always)]
    fn less_albedo(&self, indices: &Indices, residual: [Doubles; 3]) -> [Doubles; 3] {
        let Some(relief) = self.relief else { return residual };
        let albedo = indices.map(|index| relief.albedo(index as usize));
        std::array::from_fn(|channel| {
            residual[channel] - Doubles::from(std::array::from_fn(|lane| f64::from(albedo[lane][channel])))
        })
    }

    #[inline(always)]
    fn robust_weight(&self, residual: &[Doubles; 3]) -> Doubles {
        robust::weight(dot(*residual, *residual) / self.squared_scale())
    }

    /// The square of the robust scale, which is the largest rho.
    #[inline(always)]
    fn squared_scale(&self) -> Doubles {
        Doubles::splat(self.weighting.robust_scale * self.weighting.robust_scale)
    }

    fn off_the_mean_light(&self) -> Coefficients {
        Coefficients::from(self.state.light.flat()) - self.problem.prior.mean_coefficients()
    }
}
