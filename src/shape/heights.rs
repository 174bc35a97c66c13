//! Shape from shading for the heights themselves: min over z of
//! sum_cells rho(|log S - S(n)|) + sum_edges w (z_j - z_i - g)^2 + sum_i a_i (z_i - anchor_i)^2
//! + sum_i kappa_i (second differences of z)^2.
//!
//! The unknown is the surface, so every normal is integrable by construction: under natural light, where three colours
//! hardly tell one normal from another, this is what a pixel alone does not know. n is the unit vector of
//! N = a + p b + q c in the middle of a cell of four pixels, with p, q the slopes of z there and (a, b, c) fixed
//! vectors of the pixel's ray (`RayFrame`); rho is Geman-McClure. The edges carry what the pixels' own normals say
//! (trapezoidal rule, as in the integration), as firmly as the colours of one pixel fix its normal: under colourful
//! light they do the work, to the rim of the mask, under natural light they are silent.
//!
//! Method: Gauss-Newton on z, damped by the Laplacian; each step by conjugate gradients, matrix-free, preconditioned
//! by the cosine solve of the enclosing rectangle. Limits: not convex, so the start matters; across an occlusion edge
//! the slope is wrong and rho has to discard it.

use nalgebra::Matrix3;

use crate::error::{Error, ErrorKind, Result};
use crate::light::Light;
use crate::shape::cosine::{CosineSolver, fast_width};
use crate::shape::normal_operator::NormalOperator;
use crate::shape::poisson::Edges;
use crate::shape::slopes::{RayFrame, SlopeTerms};
use crate::shape::surface::Anchors;
use crate::view::{Camera, Size};

/// kappa: squared log residual per squared second difference in pixels (handbook section 5).
const SMOOTHNESS: f32 = 1e-3;
/// Confidence (squared log residual per squared slope) at which the smoothness has lost half its weight: a light whose
/// colours change by 0.1 for a slope of one.
const INDECISION: f32 = 0.01;
/// Damping of the first step and its bounds, relative to the mean stiffness of the terms.
const FIRST_DAMPING: f32 = 0.1;
const DAMPING: [f32; 2] = [1e-4, 1e4];
/// Least stiffness of the preconditioner: dark pixels must not make it singular.
const LEAST_STIFFNESS: f64 = 1e-6;
/// Relative residual of the conjugate gradients of one step. A step is only a direction; digits are wasted on it.
const STEP_TOLERANCE: f64 = 0.03;
/// A step that lowers the cost by less than this share has arrived.
const SETTLED: f64 = 1e-4;

/// What a surface has to explain; all fields are rasters of the view, NaN where unknown.
#[derive(Clone, Copy)]
pub struct HeightProblem<'a> {
    /// log S of R, G, B.
    pub log: [&'a [f32]; 3],
    /// The light, exposure included.
    pub light: &'a Light,
    /// Turns this view's normals into the light's frame.
    pub rotation: &'a Matrix3<f64>,
    /// Slopes p, q that the pixels' own normals suggest, in pixels of height per pixel. They hold where the colours of
    /// a pixel alone fix its normal, and count for nothing where they do not.
    pub slopes: [&'a [f32]; 2],
    /// Weight of each pixel's own normal beyond what its colours give, in squared log residual: lambda_2 where a prior
    /// normal stands behind it. `None`: nowhere.
    pub firmness: Option<&'a [f32]>,
    /// Heights that the surface is drawn to.
    pub anchors: Option<Anchors<'a>>,
    /// Log residual at which a pixel has lost three quarters of its pull.
    pub colour_scale: f32,
    /// Cap on the work.
    pub effort: Effort,
}

/// Caps on the work of a solve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Gauss-Newton steps.
    pub steps: u32,
    /// Rounds of conjugate gradients in each: few settle what is fine, many what reaches over the whole object.
    pub rounds: u32,
}

/// What a solve did.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightReport {
    /// Cost before the first step, per pixel.
    pub first_cost: f64,
    /// Cost after the last one, per pixel.
    pub cost: f64,
    /// Steps taken.
    pub steps: u32,
    /// Whether the cost had settled before the cap.
    pub settled: bool,
}

/// Solves one mask again and again; owns all memory.
pub struct HeightSolver {
    size: Size,
    /// Left column and top row of the mask's bounding box.
    corner: [usize; 2],
    width: usize,
    inside: Vec<bool>,
    pixels: usize,
    cosine: CosineSolver,
    z: Vec<f32>,
    trial: Vec<f32>,
    anchor: Vec<f32>,
    anchor_weight: Vec<f32>,
    operator: NormalOperator,
    /// Suggested height differences to the right and lower neighbour, and their weights.
    edges: [Edges; 2],
    confidence: Vec<f32>,
    step: Vec<f32>,
    right: Vec<f32>,
    direction: Vec<f32>,
    image: Vec<f32>,
    /// (a, b, c) of each pixel for a pinhole camera, empty for an orthographic one.
    frames: Vec<RayFrame>,
}

impl HeightSolver {
    /// A solver for the pixels of `mask`.
    ///
    /// # Errors
    /// [`ErrorKind::Empty`] where the mask holds no pixel.
    pub fn new(size: Size, camera: Camera, mask: &[bool]) -> Result<Self> {
        let inside_view = || (0..size.len()).filter(|&index| mask[index]).map(|index| size.position(index));
        let bounds = |values: &mut dyn Iterator<Item = usize>| {
            values.fold((usize::MAX, 0), |(low, high), value| (low.min(value), high.max(value)))
        };
        let (left, rightmost) = bounds(&mut inside_view().map(|(column, _)| column));
        let (top, bottom) = bounds(&mut inside_view().map(|(_, row)| row));
        if left > rightmost {
            return Err(Error::new(ErrorKind::Empty, "mask", "holds no pixel"));
        }
        let (width, height) = (fast_width(rightmost - left + 1), bottom - top + 1);
        let length = width * height;
        let mut inside = vec![false; length];
        for (column, row) in inside_view() {
            inside[(row - top) * width + column - left] = true;
        }
        let frames = match camera {
            Camera::Orthographic => Vec::new(),
            Camera::Pinhole(_) => (0..length)
                .map(|index| {
                    let column = (left + index % width).min(size.width - 1);
                    RayFrame::at(&camera, size, size.index(column, top + index / width))
                })
                .collect(),
        };
        let zeros = || vec![0.0; length];
        Ok(Self {
            size,
            corner: [left, top],
            width,
            pixels: inside.iter().filter(|&&inside| inside).count(),
            inside,
            cosine: CosineSolver::new(width, height),
            z: zeros(),
            trial: zeros(),
            anchor: zeros(),
            anchor_weight: zeros(),
            operator: NormalOperator::new(width, length),
            edges: [Edges::new(length), Edges::new(length)],
            confidence: zeros(),
            step: zeros(),
            right: zeros(),
            direction: zeros(),
            image: zeros(),
            frames,
        })
    }

    /// Improves `z` (depth in pixels, or f log Z; finite on the mask) in place.
    pub fn solve(&mut self, problem: HeightProblem<'_>, z: &mut [f32]) -> HeightReport {
        self.load(problem, z);
        let terms = SlopeTerms::new(problem, self.size);
        self.load_edges(&terms);
        let first_cost = self.cost(&terms, false);
        let mut cost = first_cost;
        let mut damping = FIRST_DAMPING;
        let (mut steps, mut settled) = (0, false);
        while steps < problem.effort.steps && !settled {
            steps += 1;
            let mean_stiffness = self.linearise(&terms);
            loop {
                self.find_step(damping * mean_stiffness as f32, mean_stiffness, problem.effort.rounds);
                for ((trial, z), step) in self.trial.iter_mut().zip(&self.z).zip(&self.step) {
                    *trial = z + step;
                }
                let trial_cost = self.cost(&terms, true);
                if trial_cost < cost {
                    std::mem::swap(&mut self.z, &mut self.trial);
                    settled = cost - trial_cost < SETTLED * cost;
                    cost = trial_cost;
                    damping = (damping / 5.0).max(DAMPING[0]);
                    break;
                }
                damping *= 10.0;
                if damping > DAMPING[1] {
                    settled = true;
                    break;
                }
            }
        }
        for index in (0..self.z.len()).filter(|&index| self.inside[index]) {
            z[self.source(index)] = self.z[index];
        }
        let share = 1.0 / self.pixels as f64;
        HeightReport { first_cost: share * first_cost, cost: share * cost, steps, settled }
    }

    /// kappa of a pixel: less where its colours fix its normal.
    fn smoothness(&self, index: usize) -> f32 {
        SMOOTHNESS * INDECISION / (INDECISION + self.confidence[index])
    }

    fn source(&self, index: usize) -> usize {
        let [left, top] = self.corner;
        self.size.index(left + index % self.width, top + index / self.width)
    }

    fn load(&mut self, problem: HeightProblem<'_>, z: &[f32]) {
        for index in 0..self.z.len() {
            (self.z[index], self.anchor[index], self.anchor_weight[index]) = (0.0, 0.0, 0.0);
            if self.inside[index] {
                let source = self.source(index);
                self.z[index] = z[source];
                if let Some(anchors) = problem.anchors {
                    (self.anchor[index], self.anchor_weight[index]) = anchors.get(source);
                }
            }
        }
    }

    /// Edges between neighbours with suggested slopes (trapezoidal rule), as firm as the less firm of the two.
    fn load_edges(&mut self, terms: &SlopeTerms<'_>) {
        let slopes = terms.problem.slopes;
        for index in 0..self.z.len() {
            let source = self.source(index);
            self.confidence[index] = 0.0;
            if self.inside[index] && !slopes[0][source].is_nan() && !slopes[1][source].is_nan() {
                let frame = terms.frame(&self.frames, index);
                self.confidence[index] = terms.confidence(frame, source, [slopes[0][source], slopes[1][source]]);
            }
        }
        for (axis, stride, view_stride) in [(0, 1, 1), (1, self.width, self.size.width)] {
            for index in 0..self.z.len() {
                let (plus, _, _) = self.stencil(index, stride);
                let joined = self.inside[index] && plus != index;
                let weight = if joined { self.confidence[index].min(self.confidence[plus]) } else { 0.0 };
                let source = self.source(index);
                self.operator.bend[axis][index] =
                    if matches!(self.stencil(index, stride), (_, _, 0.5)) && self.inside[index] {
                        self.smoothness(index)
                    } else {
                        0.0
                    };
                self.edges[axis].weight[index] = weight;
                self.edges[axis].gradient[index] =
                    if weight > 0.0 { 0.5 * (slopes[axis][source] + slopes[axis][source + view_stride]) } else { 0.0 };
            }
        }
    }

    /// Neighbours of a pixel along an axis (`stride` 1 or `width`) for its slope, and the slope's factor.
    fn stencil(&self, index: usize, stride: usize) -> (usize, usize, f32) {
        let before =
            index >= stride && (stride != 1 || !index.is_multiple_of(self.width)) && self.inside[index - stride];
        let after = index + stride < self.inside.len()
            && (stride != 1 || !(index + 1).is_multiple_of(self.width))
            && self.inside[index + stride];
        match (before, after) {
            (true, true) => (index + stride, index - stride, 0.5),
            (true, false) => (index, index - stride, 1.0),
            (false, true) => (index + stride, index, 1.0),
            (false, false) => (index, index, 0.0),
        }
    }

    /// The four pixels of the cell right of and below a pixel, where all are inside.
    fn cell(&self, index: usize) -> Option<[usize; 4]> {
        let cell = [index, index + 1, index + self.width, index + self.width + 1];
        let usable = !(index + 1).is_multiple_of(self.width) && cell[3] < self.inside.len();
        (usable && cell.iter().all(|&pixel| self.inside[pixel])).then_some(cell)
    }

    /// Cost of the current heights, or of the trial.
    fn cost(&self, terms: &SlopeTerms<'_>, trial: bool) -> f64 {
        let z = if trial { &self.trial } else { &self.z };
        let mut sum = 0.0_f64;
        for index in (0..z.len()).filter(|&index| self.inside[index]) {
            if let Some(cell) = self.cell(index) {
                sum +=
                    f64::from(terms.cost(terms.frame(&self.frames, index), self.source(index), cell_slopes(z, cell)));
            }
            sum += f64::from(self.anchor_weight[index] * (z[index] - self.anchor[index]).powi(2));
            for ((stride, edges), bend) in [1, self.width].into_iter().zip(&self.edges).zip(&self.operator.bend) {
                if edges.weight[index] > 0.0 {
                    let off = z[index + stride] - z[index] - edges.gradient[index];
                    sum += f64::from(edges.weight[index] * off * off);
                }
                if bend[index] > 0.0 {
                    sum += f64::from(bend[index] * (z[index + stride] - 2.0 * z[index] + z[index - stride]).powi(2));
                }
            }
        }
        sum
    }

    /// Fills the stiffness and the right-hand side; returns the mean stiffness.
    fn linearise(&mut self, terms: &SlopeTerms<'_>) -> f64 {
        self.right.fill(0.0);
        let mut sum = 0.0_f64;
        for index in 0..self.z.len() {
            if !self.inside[index] {
                continue;
            }
            if let Some(cell) = self.cell(index) {
                let (matrix, gradient) = terms.linearise(
                    terms.frame(&self.frames, index),
                    terms.cell_log(self.source(index)),
                    cell_slopes(&self.z, cell),
                );
                for (stiffness, value) in self.operator.stiffness.iter_mut().zip(matrix) {
                    stiffness[index] = value;
                }
                sum += f64::from(0.5 * (matrix[0] + matrix[2]));
                scatter(&mut self.right, cell, [-gradient[0], -gradient[1]]);
            }
            for ((stride, edges), bend) in [1, self.width].into_iter().zip(&self.edges).zip(&self.operator.bend) {
                if edges.weight[index] > 0.0 {
                    let off = self.z[index + stride] - self.z[index] - edges.gradient[index];
                    self.right[index + stride] -= edges.weight[index] * off;
                    self.right[index] += edges.weight[index] * off;
                    sum += 0.5 * f64::from(edges.weight[index]);
                }
                if bend[index] > 0.0 {
                    let (plus, minus) = (index + stride, index - stride);
                    let moment = bend[index] * (self.z[plus] - 2.0 * self.z[index] + self.z[minus]);
                    self.right[plus] -= moment;
                    self.right[index] += 2.0 * moment;
                    self.right[minus] -= moment;
                }
            }
            self.right[index] += self.anchor_weight[index] * (self.anchor[index] - self.z[index]);
        }
        (sum / self.pixels as f64).max(LEAST_STIFFNESS)
    }

    /// step = solution of the linearised system by preconditioned conjugate gradients.
    fn find_step(&mut self, damping: f32, mean_stiffness: f64, rounds: u32) {
        let anchors: f64 = self.anchor_weight.iter().map(|&weight| f64::from(weight)).sum();
        self.cosine.set(mean_stiffness + f64::from(damping), anchors / self.pixels as f64);
        self.operator.set_links(&self.edges, &self.inside, damping);
        self.step.fill(0.0);
        self.direction.copy_from_slice(&self.right);
        self.cosine.solve(&mut self.direction);
        self.restrict_direction();
        // `trial` holds the residual: it is written anew after the step.
        self.trial.copy_from_slice(&self.right);
        let mut rho = dot(&self.trial, &self.direction);
        let target = STEP_TOLERANCE * STEP_TOLERANCE * rho;
        for _ in 0..rounds {
            self.operator.apply(&self.anchor_weight, &self.direction, &mut self.image);
            let curvature = dot(&self.direction, &self.image);
            let length = (rho / curvature) as f32;
            if !(length.is_finite() && curvature > 0.0) {
                return;
            }
            add_scaled(&mut self.step, length, &self.direction);
            add_scaled(&mut self.trial, -length, &self.image);
            self.image.copy_from_slice(&self.trial);
            self.cosine.solve(&mut self.image);
            let next = dot(&self.trial, &self.image);
            if next <= target {
                return;
            }
            let turn = (next / rho) as f32;
            rho = next;
            for (direction, image) in self.direction.iter_mut().zip(&self.image) {
                *direction = image + turn * *direction;
            }
            self.restrict_direction();
        }
    }

    fn restrict_direction(&mut self) {
        for (direction, &inside) in self.direction.iter_mut().zip(&self.inside) {
            if !inside {
                *direction = 0.0;
            }
        }
    }
}

fn dot(a: &[f32], b: &[f32]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(*a) * f64::from(*b)).sum()
}

fn add_scaled(target: &mut [f32], factor: f32, source: &[f32]) {
    for (target, source) in target.iter_mut().zip(source) {
        *target += factor * source;
    }
}

/// p and q in the middle of a cell.
fn cell_slopes(z: &[f32], [a, b, c, d]: [usize; 4]) -> [f32; 2] {
    [0.5 * (z[b] - z[a] + z[d] - z[c]), 0.5 * (z[c] - z[a] + z[d] - z[b])]
}

/// Adds what a force on the slopes of a cell does to its heights: the transpose of [`cell_slopes`].
fn scatter(heights: &mut [f32], [a, b, c, d]: [usize; 4], [p, q]: [f32; 2]) {
    heights[a] -= 0.5 * (p + q);
    heights[b] += 0.5 * (p - q);
    heights[c] += 0.5 * (q - p);
    heights[d] += 0.5 * (p + q);
}
