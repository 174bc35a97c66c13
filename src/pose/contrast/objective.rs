//! E of a pose and its light, and its equations: local contrast, mask, occluding contour, apparent size.
//!
//! A round fixes everything discrete: the visible samples, their weights in the local means, and the occluding contour.
//! E is then smooth.

use nalgebra::Vector3;

use super::equations::{Equations, Lights, Reduced, SHADES};
use super::local_means::LocalMeans;
use super::prediction::Prediction;
use super::problem::ContrastProblem;
use super::samples::Samples;
use super::seen::Seen;
use crate::numeric::{quantile, robust};
use crate::pose::increment::{Frame, PoseVector, SCALE, UNKNOWNS};
use crate::pose::residuals::LEAST_NOISE;
use crate::pose::silhouette::{OUTSIDE_WEIGHT, SLACK, Silhouette};
use crate::pose::similarity::Similarity;
use crate::pose::spline_image::SplineImage;

/// Robust scale of points off the mask, pixels.
const BESIDE_SCALE: f64 = 3.0;
/// Weight of the distance between occluding contour and silhouette.
const CONTOUR_WEIGHT: f64 = 1.0;
/// Robust scale of the distance between occluding contour and silhouette, pixels. It is tighter than [`BESIDE_SCALE`], because
/// contours inside the mask, where one part of the object hides another, do not belong to the silhouette.
const CONTOUR_SCALE: f64 = 1.5;
/// Weight of the same distance during the instrumental rounds. Silhouettes bring the pose close, but their bias of part of a pixel would
/// then pull it off (docs/lab/thresholds.md).
const SETTLING_CONTOUR_WEIGHT: f64 = 0.1;
/// Weight of ln^2 of the apparent size relative to the initial one. An increase by 20 % costs about a sixth of the
/// contrast. Without this term a registration slides to a pose with a small object.
const SIZE_WEIGHT: f64 = 5.0;
/// Weight of ln^2 of the scale relative to that of the units, where poses are compared. A scale that is a quarter
/// larger or smaller costs little.
const UNIT_WEIGHT: f64 = 1.0;
/// Ratio of the robust scale to the noise of a channel: three sigmas of three channels.
const SCALE_OVER_NOISE: f64 = robust::SCALE_IN_SIGMAS * robust::NORM_OF_CHANNELS;
/// Smallest share of its weight that a sample keeps in the local means; without any weight it would have no mean.
const LEAST_SHARE: f64 = 1e-4;
/// Number of reweighted fits of the light at the beginning of a round.
const LIGHT_FITS: usize = 3;
/// Minimum number of samples.
const FEWEST: u32 = 30;

/// Number of values v, one for each channel, and of their derivatives by the pose.
const CHANNELS: usize = 3;
const DERIVATIVES: usize = CHANNELS * UNKNOWNS;

/// A pose and its light.
#[derive(Clone, Copy)]
pub(super) struct State {
    pub pose: Similarity,
    pub light: Lights,
}

/// One resolution of image and local means.
pub(super) struct Level {
    pub image: SplineImage,
    pub means: LocalMeans,
    /// The harmonics, blurred like the image.
    pub shades: Vec<[f32; SHADES]>,
}

/// E and its parts, for one round after the other; owns its memory.
pub(super) struct Objective {
    pub samples: Samples,
    pub seen: Seen,
    silhouette: Silhouette,
    /// Number of pixels on the mask's border, by which the sum over contour points is divided.
    border: f64,
    /// Five values for each grid pixel. They are its weight in the local means (zero if it takes no part), the harmonics without their
    /// local means, the latest v, v without its local means, and the derivatives of v.
    weights: Vec<f32>,
    shades: Vec<[f32; SHADES]>,
    seen_values: Vec<[f32; CHANNELS]>,
    values: Vec<[f32; CHANNELS]>,
    derivatives: Vec<[f32; DERIVATIVES]>,
    prediction: Prediction,
    /// Whether the derivatives are those of the prediction. Shading, not the silhouette, then determines the pose.
    has_instruments: bool,
    squares: Vec<f32>,
    /// Sum of the weights of samples on and off the mask, and of those off it.
    all: f64,
    beside: f64,
    /// The squared robust scale.
    scale: f64,
    /// Scale of the initial pose, the apparent size in an orthographic image.
    size: f64,
    unit: f64,
}

impl Objective {
    /// `unit` is the length, in pixels, in which distances to the silhouette are counted.
    pub fn new(problem: &ContrastProblem<'_>, samples: Samples, silhouette: Silhouette, seen: Seen, unit: f64) -> Self {
        let length = samples.grid.len();
        Self {
            seen,
            border: silhouette.border().max(1) as f64,
            silhouette,
            weights: vec![0.0; length],
            shades: vec![[0.0; SHADES]; length],
            seen_values: vec![[0.0; CHANNELS]; length],
            values: vec![[0.0; CHANNELS]; length],
            derivatives: vec![[0.0; DERIVATIVES]; length],
            prediction: Prediction::new(length),
            has_instruments: false,
            squares: Vec::with_capacity(samples.list.len()),
            all: 0.0,
            beside: 0.0,
            scale: f64::INFINITY,
            size: problem.unit_scale,
            unit,
            samples,
        }
    }

    /// Sets the apparent size of a pose as the one that E expects.
    pub const fn expect_size(&mut self, start: &Similarity) {
        self.size = start.scale;
    }

    /// Length in which distances are counted, pixels.
    pub const fn unit(&self) -> f64 {
        self.unit
    }

    /// Selects whether the equations use the gradient of the prediction as instruments instead of that of the image.
    pub fn use_instruments(&mut self, has_instruments: bool) {
        self.has_instruments = has_instruments;
    }

    /// Sets the robust scale for a noise, log units.
    pub fn set_noise(&mut self, noise: f64) {
        self.scale = (SCALE_OVER_NOISE * noise).powi(2);
    }

    /// Fixes the samples that are visible from a pose and fits its light; `None` if too few are visible.
    pub fn begin(&mut self, problem: &ContrastProblem<'_>, level: &mut Level, state: &mut State) -> Option<Frame> {
        self.seen.look(problem, &self.samples, &state.pose);
        let (mut middle, mut square, mut count) = (Vector3::zeros(), 0.0, 0);
        self.weights.fill(0.0);
        (self.all, self.beside) = (0.0, 0.0);
        for (sample, _) in self.samples.list.iter().zip(&self.seen.visible).filter(|(_, visible)| **visible) {
            let Some(place) = problem.place(&state.pose, &sample.point) else { continue };
            let weight = self.samples.weight[sample.cell];
            if let Some(value) = level.image.value(place) {
                self.weights[sample.cell] = weight;
                self.seen_values[sample.cell] = value.map(|value| value as f32);
                self.all += f64::from(weight);
                middle += sample.point;
                square += sample.point.norm_squared();
                count += 1;
            } else if self.silhouette.at(place).0 > SLACK {
                self.all += f64::from(weight);
                self.beside += f64::from(weight);
            }
        }
        if count < FEWEST {
            return None;
        }
        middle /= f64::from(count);
        let radius = (square / f64::from(count) - middle.norm_squared()).max(0.0).sqrt();
        self.fit(level, state);
        Some(Frame { centre: state.pose.apply(middle), length: (state.pose.scale * radius).max(f64::MIN_POSITIVE) })
    }

    /// Updates light, noise and weights in turn.
    fn fit(&mut self, level: &mut Level, state: &mut State) {
        for _ in 0..LIGHT_FITS {
            self.take_means(level);
            self.relight(state);
            let noise = self.noise(&state.light);
            self.set_noise(noise);
            self.relight(state);
            for sample in &self.samples.list {
                let cell = sample.cell;
                if self.weights[cell] > 0.0 {
                    let share = robust::weight(self.square(cell, &state.light) / self.scale).max(LEAST_SHARE);
                    self.weights[cell] = self.samples.weight[cell] * share as f32;
                }
            }
        }
        self.take_means(level);
    }

    /// Recomputes the local means of the latest values under the present weights.
    fn take_means(&mut self, level: &mut Level) {
        level.means.weigh(&self.weights);
        self.shades.copy_from_slice(&level.shades);
        level.means.remove(&mut self.shades);
        self.values.copy_from_slice(&self.seen_values);
        level.means.remove(&mut self.values);
    }

    fn residual(&self, cell: usize, light: &Lights) -> [f64; CHANNELS] {
        let shades = &self.shades[cell];
        std::array::from_fn(|channel| {
            let shade: f64 = shades.iter().zip(&light[channel]).map(|(shade, l)| f64::from(*shade) * l).sum();
            f64::from(self.values[cell][channel]) - shade
        })
    }

    fn square(&self, cell: usize, light: &Lights) -> f64 {
        self.residual(cell, light).iter().map(|r| r * r).sum()
    }

    /// Grid pixels that take part.
    fn cells(&self) -> impl Iterator<Item = usize> {
        self.samples.list.iter().map(|sample| sample.cell).filter(|&cell| self.weights[cell] > 0.0)
    }

    /// One reweighted fit of the light.
    fn relight(&self, state: &mut State) {
        let mut equations = Equations::new();
        for cell in self.cells() {
            let residual = self.residual(cell, &state.light);
            let square: f64 = residual.iter().map(|r| r * r).sum();
            let weight = f64::from(self.samples.weight[cell]) * robust::weight(square / self.scale);
            equations.add_shades(&self.shades[cell], residual, weight);
        }
        if let Some(step) = equations.light_step() {
            state.light.iter_mut().zip(step).for_each(|(light, step)| *light += step);
        }
    }

    /// Robust standard deviation of the residuals of a channel.
    pub fn noise(&mut self, light: &Lights) -> f64 {
        let mut squares = std::mem::take(&mut self.squares);
        squares.clear();
        squares.extend(self.cells().map(|cell| self.square(cell, light) as f32));
        let median = if squares.is_empty() { 0.0 } else { quantile(&mut squares, 0.5) };
        self.squares = squares;
        (f64::from(median).sqrt() / robust::MEDIAN_OF_THREE).max(LEAST_NOISE)
    }

    /// The contrast term of E: 0 if shading explains everything, 1 if it explains nothing.
    fn unexplained(&self, light: &Lights) -> f64 {
        let cost =
            |cell| f64::from(self.samples.weight[cell]) * robust::saturated(self.square(cell, light) / self.scale);
        (self.beside + self.cells().map(cost).sum::<f64>()) / self.all
    }

    /// E.
    pub fn value(&mut self, problem: &ContrastProblem<'_>, level: &mut Level, state: &State) -> f64 {
        for sample in &self.samples.list {
            if self.weights[sample.cell] > 0.0 {
                let place = problem.place(&state.pose, &sample.point);
                if let Some(value) = place.and_then(|place| level.image.value(place)) {
                    self.seen_values[sample.cell] = value.map(|value| value as f32);
                }
            }
        }
        self.values.copy_from_slice(&self.seen_values);
        level.means.remove(&mut self.values);
        self.unexplained(&state.light) + self.silhouettes(problem, &state.pose) + self.size_term(&state.pose)
    }

    /// E with an additional term that holds the scale near that of the units, if it is free.
    pub fn compared(&mut self, problem: &ContrastProblem<'_>, level: &mut Level, state: &State) -> f64 {
        self.expect_size(&state.pose);
        self.value(problem, level, state) + units_term(problem, &state.pose)
    }

    /// The value by which poses are ranked: this E with the contrast term divided by its value without any light. E
    /// itself would prefer a cloud that shrinks to a part of the image with little contrast, although no light explains
    /// that contrast.
    pub fn ranked(&mut self, problem: &ContrastProblem<'_>, level: &mut Level, state: &State) -> f64 {
        let value = self.compared(problem, level, state);
        let left = self.unexplained(&state.light);
        let all = self.unexplained(&Lights::default());
        if all > 0.0 { value - left + left / all } else { f64::INFINITY }
    }

    fn size_term(&self, pose: &Similarity) -> f64 {
        SIZE_WEIGHT * (pose.scale / self.size).ln().powi(2)
    }

    /// Cost of points off the mask, and of the occluding contour off its border.
    fn silhouettes(&self, problem: &ContrastProblem<'_>, pose: &Similarity) -> f64 {
        let rho = |u: f64, scale: f64| robust::rho(u * u, (u / scale).powi(2));
        let beside = |sample: &super::samples::Sample| match problem.place(pose, &sample.point) {
            Some(place) => rho((self.silhouette.at(place).0 - SLACK).max(0.0) / self.unit, BESIDE_SCALE),
            None => BESIDE_SCALE.powi(2),
        };
        let cost = |point: &Vector3<f64>| match problem.place(pose, point) {
            Some(place) => rho(self.silhouette.signed_at(place).0 / self.unit, CONTOUR_SCALE),
            None => CONTOUR_SCALE.powi(2),
        };
        let beside: f64 = self.samples.list.iter().map(beside).sum();
        let contour: f64 = self.seen.contour.iter().map(cost).sum();
        OUTSIDE_WEIGHT * beside / self.samples.list.len() as f64 + self.contour_weight() * contour
    }

    /// Weight of one contour point. It grows with the stride, because wider strides yield fewer points.
    fn contour_weight(&self) -> f64 {
        let weight = if self.has_instruments { SETTLING_CONTOUR_WEIGHT } else { CONTOUR_WEIGHT };
        weight * self.samples.stride as f64 / self.border
    }

    /// The equations of a step with the light eliminated.
    pub fn linearise(
        &mut self,
        problem: &ContrastProblem<'_>,
        level: &mut Level,
        frame: &Frame,
        state: &State,
    ) -> Option<Reduced> {
        let mut equations = Equations::new();
        if self.has_instruments {
            let (samples, visible) = (&self.samples, &self.seen.visible);
            self.prediction.predict(problem, samples, visible, &level.shades, (&state.pose, &state.light));
        }
        self.enter_samples(problem, level, frame, state);
        self.for_each_silhouette(problem, frame, &state.pose, |_, row, off, weight| {
            equations.add_row(row, off, weight)
        });
        self.values.copy_from_slice(&self.seen_values);
        level.means.remove(&mut self.values);
        level.means.remove(&mut self.derivatives);
        self.for_each_score(&state.light, |cell, residual, weight, rows| {
            equations.add(&self.shades[cell], residual, rows, weight);
        });
        let mut row = PoseVector::zeros();
        row[SCALE] = 1.0;
        let growth = (state.pose.scale / self.size).ln();
        equations.add_row(&row, growth, SIZE_WEIGHT);
        equations.reduced()
    }

    /// Stores v and its derivatives.
    fn enter_samples(&mut self, problem: &ContrastProblem<'_>, level: &Level, frame: &Frame, state: &State) {
        for sample in &self.samples.list {
            let point = state.pose.apply(sample.point);
            let Some((place, by_pose)) = by_pose(problem, &point, frame) else { continue };
            let cell = sample.cell;
            if self.weights[cell] == 0.0 {
                continue;
            }
            self.derivatives[cell].fill(0.0);
            let Some(colours) = level.image.at(place) else { continue };
            self.seen_values[cell] = colours.log.map(|log| log as f32);
            let (rows, _) = self.derivatives[cell].as_chunks_mut::<UNKNOWNS>();
            let gradient = if self.has_instruments { self.prediction.gradient(cell) } else { colours.gradient };
            for (row, [by_column, by_row]) in rows.iter_mut().zip(gradient) {
                let derivative = by_column * by_pose[0] + by_row * by_pose[1];
                row.iter_mut().zip(&derivative).for_each(|(out, value)| *out = *value as f32);
            }
        }
    }

    /// Calls `visit` with position, derivative, residual and weight of each point off the mask and of each contour
    /// point.
    pub fn for_each_silhouette(
        &self,
        problem: &ContrastProblem<'_>,
        frame: &Frame,
        pose: &Similarity,
        mut visit: impl FnMut([f64; 2], &PoseVector, f64, f64),
    ) {
        let (beside, contour) = (OUTSIDE_WEIGHT / self.samples.list.len() as f64, self.contour_weight());
        for sample in &self.samples.list {
            let Some((place, by_pose)) = by_pose(problem, &pose.apply(sample.point), frame) else { continue };
            let (distance, slope) = self.silhouette.at(place);
            if distance > SLACK {
                let off = (distance - SLACK) / self.unit;
                let row = (slope[0] * by_pose[0] + slope[1] * by_pose[1]) / self.unit;
                visit(place, &row, off, beside * robust::weight((off / BESIDE_SCALE).powi(2)));
            }
        }
        for point in &self.seen.contour {
            let Some((place, by_pose)) = by_pose(problem, &pose.apply(*point), frame) else { continue };
            let (distance, slope) = self.silhouette.signed_at(place);
            let off = distance / self.unit;
            let row = (slope[0] * by_pose[0] + slope[1] * by_pose[1]) / self.unit;
            visit(place, &row, off, contour * robust::weight((off / CONTOUR_SCALE).powi(2)));
        }
    }

    /// Calls `visit` with grid pixel, residuals, weight and derivatives of each sample that takes part.
    pub fn for_each_score(
        &self,
        light: &Lights,
        mut visit: impl FnMut(usize, [f64; CHANNELS], f64, &[[f32; UNKNOWNS]]),
    ) {
        for cell in self.cells() {
            let residual = self.residual(cell, light);
            let square: f64 = residual.iter().map(|r| r * r).sum();
            let own = f64::from(self.samples.weight[cell]) / (self.scale * self.all);
            let (rows, _) = self.derivatives[cell].as_chunks::<UNKNOWNS>();
            visit(cell, residual, own * robust::weight(square / self.scale), rows);
        }
    }

    /// Harmonics of a grid pixel with their local means removed.
    pub fn shades(&self, cell: usize) -> &[f32; SHADES] {
        &self.shades[cell]
    }
}

/// Cost of a scale that differs from that of the units, where poses are compared.
fn units_term(problem: &ContrastProblem<'_>, pose: &Similarity) -> f64 {
    let growth = (pose.scale / problem.unit_scale).ln();
    if problem.scale_is_held { 0.0 } else { UNIT_WEIGHT * growth * growth }
}

/// Position in the image of a point of the colour view, and its derivative by each unknown.
pub(in crate::pose) fn by_pose(
    problem: &ContrastProblem<'_>,
    point: &Vector3<f64>,
    frame: &Frame,
) -> Option<([f64; 2], [PoseVector; 2])> {
    let (place, by_point) =
        problem.image.camera.project_with_gradient(problem.image.size, [point.x, point.y, point.z])?;
    Some((place, by_point.map(|by_point| frame.row(point, &by_point.into()))))
}
