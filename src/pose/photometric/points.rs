//! The depth points that take part, and the sums over them.

use nalgebra::Vector3;

use super::PhotometricProblem;
use super::equations::{Equations, LightEquations};
use super::image::SplineImage;
use super::problem::Indices;
use super::residual::{Linear, Scene, Seen};
use crate::light::{COEFFICIENTS, Coefficients, HARMONICS, Light, basis};
use crate::numeric::{DOUBLE_LANES, Doubles, Real, dot, quantile};
use crate::pose::increment::{Frame, Row};
use crate::pose::similarity::Similarity;
use crate::pose::visibility::{Sight, Visibility};
use crate::view::Size;

/// Distance from the border of the mask within which points stay out, image pixels: they would enter and leave with
/// every step, and the spline is continued there.
const MARGIN: usize = 1;
/// Error of a normal, radians, at which its point has lost three quarters of its say. Errors act in the mean by their
/// square: 0.1 rad shifts the pose by some tenths of a degree whatever the light.
const NORMAL_ERROR: f64 = 0.1;
/// Points that a coarse level needs: 20 for each unknown of the pose, 30 where 27 of the light come in and can feign
/// a fit (measured on Mozart at 64x64, starts 20 and 30 degrees off).
const ENOUGH_KNOWN: usize = 100;
const ENOUGH_UNKNOWN: usize = 1000;
/// (5^(1/2) - 1) / 2.
const GOLDEN_SECTION: f64 = 0.618_033_988_749_895;
/// Points with less say than this do not vote on the noise.
const VOTER: f64 = 0.25;
/// Median of |r| over three channels of unit normal noise.
const MEDIAN_OF_THREE: f64 = 1.538_172_253_6;

/// Pose and light at one moment.
#[derive(Clone, Copy, Debug)]
pub(super) struct State {
    pub pose: Similarity,
    pub light: Light,
    /// Offset of log S on top of a known light; zero where the light is free.
    pub exposure: f64,
}

impl State {
    /// The state after a step of pose and light.
    pub fn moved(&self, frame: &Frame, step: &Row, light: &Coefficients, light_is_known: bool) -> Self {
        let pose = frame.change(step).after(&self.pose).orthonormal();
        Self { pose, ..self.relit(light, light_is_known) }
    }

    /// The state after a step of the light alone.
    pub fn relit(&self, step: &Coefficients, light_is_known: bool) -> Self {
        let mut next = *self;
        if light_is_known {
            next.exposure += step[0];
        } else {
            (0..COEFFICIENTS).for_each(|k| next.light.0[k / HARMONICS][k % HARMONICS] += step[k]);
        }
        next
    }

    pub fn exposed(&self) -> Light {
        self.light.exposed(self.exposure)
    }
}

/// How residuals are judged.
#[derive(Clone, Copy, Debug)]
pub(super) struct Robust {
    /// |r| at which a point's weight has fallen to a quarter, log units.
    pub scale: f64,
    /// Weight of the light's prior against squared residuals.
    pub prior: f64,
}

/// A fixed set of visible points; owns its memory.
pub(super) struct VisiblePoints {
    visible: Visibility,
    indices: Vec<u32>,
    sampled: bool,
    weights: Vec<f32>,
    spare: Vec<f32>,
    /// What the image shows of them while the pose stays.
    seen: Vec<Seen>,
}

impl VisiblePoints {
    pub fn new(problem: &PhotometricProblem<'_>) -> Self {
        let length = problem.points.len();
        let room = (0..length).filter(|&index| problem.points.is_valid(index)).count();
        Self {
            visible: Visibility::new(problem.image.size.len(), length),
            indices: Vec::with_capacity(room),
            sampled: false,
            weights: Vec::with_capacity(room),
            spare: Vec::with_capacity(room),
            seen: Vec::new(),
        }
    }

    pub fn len(&self) -> usize {
        self.indices.len()
    }

    /// The points that the image shows under `pose`: every 2^level-th along both axes, more where that leaves too few,
    /// and about `most` at most.
    pub fn update(
        &mut self,
        problem: &PhotometricProblem<'_>,
        pose: &Similarity,
        image: &SplineImage,
        level: usize,
        most: usize,
    ) {
        let centre = pose.apply(problem.points.centroid());
        let sight = Sight {
            image: problem.image,
            pose,
            points: problem.points,
            normals: problem.normals,
            pixel_length: problem.image.camera.focal_length().map_or(1.0, |focal_length| centre.z / focal_length),
        };
        self.visible.update(&sight, &mut |_, _, _| true);
        let enough = if problem.light.is_some() { ENOUGH_KNOWN } else { ENOUGH_UNKNOWN };
        for level in (0..=level).rev() {
            self.list(problem, image, 1 << level);
            if self.indices.len() >= enough {
                break;
            }
        }
        self.thin(problem.depth.size, most);
    }

    /// Whether the points are a sample of those that are visible.
    pub fn are_sampled(&self) -> bool {
        self.sampled
    }

    /// Leaves every k-th point, so that `most` or fewer are left of evenly spread ones: on a lattice, whose rows are
    /// shifted by the golden section of k.
    fn thin(&mut self, size: Size, most: usize) {
        let every = self.indices.len().div_ceil(most.max(1)).max(1);
        self.sampled = every > 1;
        if !self.sampled {
            return;
        }
        let shift = (GOLDEN_SECTION * every as f64).round() as usize;
        let mut kept = 0;
        for place in 0..self.indices.len() {
            let (column, row) = size.position(self.indices[place] as usize);
            if (column + shift * row).is_multiple_of(every) {
                (self.indices[kept], self.weights[kept]) = (self.indices[place], self.weights[place]);
                kept += 1;
            }
        }
        self.indices.truncate(kept);
        self.weights.truncate(kept);
    }

    /// Every `stride`-th visible point.
    fn list(&mut self, problem: &PhotometricProblem<'_>, image: &SplineImage, stride: usize) {
        self.indices.clear();
        self.weights.clear();
        let Visibility { column: columns, row: rows, .. } = &self.visible;
        for index in 0..columns.len() {
            let (column, row) = problem.depth.size.position(index);
            let position = [f64::from(columns[index]), f64::from(rows[index])];
            if column % stride != 0 || row % stride != 0 || !problem.normals.is_valid(index) {
                continue;
            }
            let error = problem.normal_error.map_or(0.0, |error| f64::from(error[index]));
            if !error.is_nan() && image.covers(position, MARGIN) {
                self.indices.push(index as u32);
                self.weights.push((1.0 + (error / NORMAL_ERROR).powi(2)).powi(-2) as f32);
            }
        }
    }

    /// The points side by side with their own weights. An odd last one comes twice, once without weight.
    fn groups(&self) -> impl Iterator<Item = (Indices, Doubles)> {
        self.indices.chunks(DOUBLE_LANES).zip(self.weights.chunks(DOUBLE_LANES)).map(|(some, weights)| {
            let (mut indices, mut shares) = ([some[0]; DOUBLE_LANES], [0.0; DOUBLE_LANES]);
            indices[..some.len()].copy_from_slice(some);
            shares.iter_mut().zip(weights).for_each(|(share, &weight)| *share = f64::from(weight));
            (indices, Doubles::from(shares))
        })
    }

    /// Centroid of the carried points and their root mean square distance from it.
    pub fn frame(&self, problem: &PhotometricProblem<'_>, pose: &Similarity) -> Frame {
        let points =
            || self.indices.iter().map(|&index| Vector3::from(problem.points.get(index as usize).map(f64::from)));
        let count = self.indices.len().max(1) as f64;
        let centre = points().sum::<Vector3<f64>>() / count;
        let spread = (points().map(|point| (point - centre).norm_squared()).sum::<f64>() / count).sqrt();
        let length = pose.scale * spread;
        Frame { centre: pose.apply(centre), length: if length > 0.0 { length } else { 1.0 } }
    }

    /// Sum of the points' own weights.
    pub fn weight(&self) -> f64 {
        self.weights.iter().map(|&weight| f64::from(weight)).sum()
    }

    /// Sum of w rho + prior; a point that left the mask costs the full robust price.
    pub fn cost(&self, problem: &PhotometricProblem<'_>, scene: &Scene<'_>, state: &State, robust: Robust) -> f64 {
        let full = Doubles::splat(robust.scale * robust.scale);
        let mut sum = Doubles::splat(0.0);
        self.each_square(problem, scene, &state.pose, |weight, shown, square| {
            let saved = Doubles::splat(1.0) - square / (full + square);
            sum = sum + weight * full * (Doubles::splat(1.0) - shown * saved);
        });
        let sum = sum.sum();
        if problem.light.is_none() { sum + robust.prior * problem.prior.squared_distance(&state.light) } else { sum }
    }

    /// Share of the weights whose residuals are below the robust scale.
    pub fn inliers(&self, problem: &PhotometricProblem<'_>, scene: &Scene<'_>, state: &State, robust: Robust) -> f64 {
        let full = Doubles::splat(robust.scale * robust.scale);
        let mut sum = Doubles::splat(0.0);
        self.each_square(problem, scene, &state.pose, |weight, shown, square| {
            sum = sum + square.less(full).keep(weight * shown);
        });
        sum.sum() / self.weight().max(f64::MIN_POSITIVE)
    }

    /// Visits the points with their weights, whether the image shows them (one or zero) and |r|^2.
    #[inline(always)]
    fn each_square(
        &self,
        problem: &PhotometricProblem<'_>,
        scene: &Scene<'_>,
        pose: &Similarity,
        mut visit: impl FnMut(Doubles, Doubles, Doubles),
    ) {
        for (indices, weight) in self.groups() {
            let seen = scene.seen(problem.carried(pose, &indices));
            let residual = scene.residual(&seen, problem.turned(pose, &indices));
            visit(weight, seen.shown, dot(residual, residual));
        }
    }

    /// The equations of pose and light.
    pub fn equations(
        &self,
        problem: &PhotometricProblem<'_>,
        scene: &Scene<'_>,
        state: &State,
        robust: Robust,
        frame: &Frame,
    ) -> Equations {
        let mut equations = Equations::new(problem.light.is_some(), scene.listens());
        self.each(problem, scene, state, robust, frame, |_, point, weight| equations.add(point, weight));
        let off = Coefficients::from(state.light.flat()) - problem.prior.mean_coefficients();
        equations.add_prior(problem.prior, robust.prior, &off);
        equations
    }

    /// Looks up what the image shows at the points, for [`light_equations`](Self::light_equations) under the same pose.
    pub fn see(&mut self, problem: &PhotometricProblem<'_>, scene: &Scene<'_>, state: &State) {
        let mut seen = std::mem::take(&mut self.seen);
        seen.clear();
        seen.reserve_exact(self.indices.len().div_ceil(DOUBLE_LANES));
        seen.extend(self.groups().map(|(indices, _)| scene.seen(problem.carried(&state.pose, &indices))));
        self.seen = seen;
    }

    /// The equations of the light alone, of the points as they were last [seen](Self::see) in this scene.
    pub fn light_equations(
        &self,
        problem: &PhotometricProblem<'_>,
        scene: &Scene<'_>,
        state: &State,
        robust: Robust,
    ) -> LightEquations {
        let mut equations = LightEquations::new(problem.light.is_some());
        for ((indices, weight), seen) in self.groups().zip(&self.seen) {
            let normals = problem.turned(&state.pose, &indices);
            let residual = scene.residual(seen, normals);
            let weight = weight * seen.shown * doubt(&residual, robust);
            equations.add(&basis(normals), &residual, weight);
        }
        let off = Coefficients::from(state.light.flat()) - problem.prior.mean_coefficients();
        equations.add_prior(problem.prior, robust.prior, &off);
        equations
    }

    /// Visits the points side by side with their indices and weights: their own times the robust ones.
    #[inline(always)]
    pub fn each(
        &self,
        problem: &PhotometricProblem<'_>,
        scene: &Scene<'_>,
        state: &State,
        robust: Robust,
        frame: &Frame,
        mut visit: impl FnMut(&Indices, &Linear, Doubles),
    ) {
        for (indices, weight) in self.groups() {
            let points = problem.carried(&state.pose, &indices);
            let linear = scene.linear(points, problem.turned(&state.pose, &indices), frame);
            visit(&indices, &linear, weight * linear.shown * doubt(&linear.residual, robust));
        }
    }

    /// Robust standard deviation of a channel's residuals, from the median of |r|; infinite without points.
    pub fn noise(&mut self, problem: &PhotometricProblem<'_>, scene: &Scene<'_>, state: &State) -> f64 {
        let mut spare = std::mem::take(&mut self.spare);
        spare.clear();
        self.each_square(problem, scene, &state.pose, |weight, shown, square| {
            let [votes, squares] = [weight * shown, square].map(Doubles::array);
            let voters = votes.into_iter().zip(squares).filter(|(vote, _)| *vote >= VOTER);
            spare.extend(voters.map(|(_, square)| square.sqrt() as f32));
        });
        self.spare = spare;
        if self.spare.is_empty() {
            return f64::INFINITY;
        }
        f64::from(quantile(&mut self.spare, 0.5)) / MEDIAN_OF_THREE
    }
}

/// Robust weights.
#[inline(always)]
fn doubt(residual: &[Doubles; 3], robust: Robust) -> Doubles {
    let one = Doubles::splat(1.0);
    let doubt = one / (one + dot(*residual, *residual) / Doubles::splat(robust.scale * robust.scale));
    doubt * doubt
}
