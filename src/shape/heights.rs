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
use crate::shape::cosine::CosineSolver;
use crate::shape::normal_operator::NormalOperator;
use crate::shape::poisson::{Edges, add_scaled, dot};
use crate::shape::slopes::{RayFrame, SlopeTerms};
use crate::shape::surface::Anchors;
use crate::view::{Camera, LANES, Lanes, Mask, Real, Size};

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
/// A step that lowers the cost by less than this share has arrived.
const SETTLED: f64 = 1e-4;
/// A round of conjugate gradients that promises less than this share of the cost is the last one.
const IDLE: f64 = 1e-5;

/// Costs of pixels that are summed in f32 before the sum goes on in f64: few enough to keep six digits.
const SUMMANDS: usize = 256;

/// Bits of a pixel: inside the mask; the cell of four pixels right of and below it as well; its neighbours inside.
const INSIDE: u8 = 1;
const CELL: u8 = 2;
const LEFT: u8 = 4;
const RIGHT: u8 = 8;
const ABOVE: u8 = 16;
const BELOW: u8 = 32;

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
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Gauss-Newton steps.
    pub steps: u32,
    /// Rounds of conjugate gradients in each: few settle what is fine, many what reaches over the whole object.
    pub rounds: u32,
    /// Relative residual at which they end. A step is only a direction; digits are wasted on it.
    pub tolerance: f64,
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
    /// Of the box; the rows of the rasters here are `width` long, a multiple of [`LANES`].
    columns: usize,
    width: usize,
    /// Which pixels are inside, and which of their neighbours: bits of [`INSIDE`] and so on.
    near: Vec<u8>,
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
        let (columns, height) = (rightmost - left + 1, bottom - top + 1);
        // Blocks of four must not reach into the next row.
        let width = columns.next_multiple_of(LANES);
        let length = width * height;
        let is_inside =
            |column: usize, row: usize| column < size.width && row < size.height && mask[size.index(column, row)];
        let mut near = vec![0; length];
        for (column, row) in inside_view() {
            let [right, below] = [is_inside(column + 1, row), is_inside(column, row + 1)];
            let flags = [
                (INSIDE, true),
                (CELL, right && below && is_inside(column + 1, row + 1)),
                (LEFT, is_inside(column.wrapping_sub(1), row)),
                (RIGHT, right),
                (ABOVE, is_inside(column, row.wrapping_sub(1))),
                (BELOW, below),
            ];
            near[(row - top) * width + column - left] =
                flags.into_iter().filter(|(_, holds)| *holds).map(|(flag, _)| flag).sum();
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
            columns,
            width,
            pixels: inside_view().count(),
            near,
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
        let mut report = HeightReport { first_cost: 0.0, cost: 0.0, steps: 0, settled: false };
        let mut damping = FIRST_DAMPING;
        while report.steps < problem.effort.steps && !report.settled {
            let (cost, mean_stiffness) = self.linearise(&terms);
            if report.steps == 0 {
                (report.first_cost, report.cost) = (cost, cost);
            }
            report.steps += 1;
            loop {
                let promise =
                    self.find_step(damping * mean_stiffness as f32, mean_stiffness, problem.effort, report.cost);
                if promise < SETTLED * report.cost {
                    report.settled = true;
                    break;
                }
                for ((trial, z), step) in self.trial.iter_mut().zip(&self.z).zip(&self.step) {
                    *trial = z + step;
                }
                let trial_cost = self.cost(&terms);
                if trial_cost < report.cost {
                    std::mem::swap(&mut self.z, &mut self.trial);
                    report.settled = report.cost - trial_cost < SETTLED * report.cost;
                    report.cost = trial_cost;
                    damping = (damping / 5.0).max(DAMPING[0]);
                    break;
                }
                damping *= 10.0;
                if damping > DAMPING[1] {
                    report.settled = true;
                    break;
                }
            }
        }
        for (index, source) in self.inside() {
            z[source] = self.z[index];
        }
        let share = 1.0 / self.pixels as f64;
        HeightReport { first_cost: share * report.first_cost, cost: share * report.cost, ..report }
    }

    /// The pixels of the box in turn: their places here and in the view.
    fn places(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let ([left, top], columns, width, view_width) = (self.corner, self.columns, self.width, self.size.width);
        (0..self.near.len() / width).flat_map(move |row| {
            let (here, source) = (row * width, (top + row) * view_width + left);
            (0..columns).map(move |column| (here + column, source + column))
        })
    }

    /// The same [`LANES`] at a time: the first of each.
    fn blocks(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let ([left, top], columns, width, view_width) = (self.corner, self.columns, self.width, self.size.width);
        (0..self.near.len() / width).flat_map(move |row| {
            let (here, source) = (row * width, (top + row) * view_width + left);
            (0..columns).step_by(LANES).map(move |column| (here + column, source + column))
        })
    }

    /// Who of a block has a flag.
    #[inline(always)]
    fn flagged(&self, index: usize, flag: u8) -> Mask {
        let has = |lane: usize| f32::from(self.near.get(index + lane).map_or(0, |near| near & flag));
        Lanes::splat(0.0).less(Lanes::from([has(0), has(1), has(2), has(3)]))
    }

    /// Those of [`places`](Self::places) on the mask.
    fn inside(&self) -> impl Iterator<Item = (usize, usize)> {
        self.places().filter(|&(index, _)| self.near[index] & INSIDE != 0)
    }

    /// kappa of a pixel: less where its colours fix its normal.
    fn smoothness(&self, index: usize) -> f32 {
        SMOOTHNESS * INDECISION / (INDECISION + self.confidence[index])
    }

    fn load(&mut self, problem: HeightProblem<'_>, z: &[f32]) {
        for (index, source) in self.places() {
            if self.near[index] & INSIDE != 0 {
                self.z[index] = z[source];
                (self.anchor[index], self.anchor_weight[index]) =
                    problem.anchors.map_or((0.0, 0.0), |anchors| anchors.get(source));
            }
        }
    }

    /// Edges between neighbours with suggested slopes (trapezoidal rule), as firm as the less firm of the two.
    fn load_edges(&mut self, terms: &SlopeTerms<'_>) {
        let slopes = terms.problem.slopes;
        for (index, source) in self.blocks() {
            let suggested = slopes.map(|slopes| Lanes::load(slopes, source as isize));
            let wanted = self.flagged(index, INSIDE) & suggested[0].finite() & suggested[1].finite();
            let confidence = if wanted.any() {
                terms.confidence(&terms.frames(&self.frames, index), source, suggested, wanted)
            } else {
                Lanes::splat(0.0)
            };
            confidence.store(&mut self.confidence[index..]);
        }
        let axes = [(1, 1, LEFT, RIGHT), (self.width, self.size.width, ABOVE, BELOW)];
        for (axis, (stride, view_stride, before, after)) in axes.into_iter().enumerate() {
            for (index, source) in self.places() {
                let near = self.near[index];
                let joined = near & after != 0;
                let weight = if joined { self.confidence[index].min(self.confidence[index + stride]) } else { 0.0 };
                self.operator.bend[axis][index] =
                    if joined && near & before != 0 { self.smoothness(index) } else { 0.0 };
                self.edges[axis].weight[index] = weight;
                self.edges[axis].gradient[index] =
                    if weight > 0.0 { 0.5 * (slopes[axis][source] + slopes[axis][source + view_stride]) } else { 0.0 };
            }
        }
    }

    /// Cost of the trial heights.
    fn cost(&self, terms: &SlopeTerms<'_>) -> f64 {
        let z = &self.trial;
        let colours = self.blocks().map(|(index, source)| {
            let cells = self.flagged(index, CELL);
            if !cells.any() {
                return 0.0;
            }
            let frames = terms.frames(&self.frames, index);
            let slopes = cell_slopes(z, index, self.width);
            f64::from(terms.cost(&frames, terms.cell_log(source), slopes, cells).sum())
        });
        colours.sum::<f64>() + self.resistance(z)
    }

    /// Cost of everything but the colours: anchors, edges and bends.
    fn resistance(&self, z: &[f32]) -> f64 {
        let anchors = weighted_squares(&self.anchor_weight, |at| Lanes::load(z, at) - Lanes::load(&self.anchor, at));
        let strides = [1, self.width as isize];
        let lines = strides.into_iter().zip(&self.edges).zip(&self.operator.bend).map(|((stride, edges), bend)| {
            let fall = |at: isize| Lanes::load(z, at + stride) - Lanes::load(z, at);
            weighted_squares(&edges.weight, |at| fall(at) - Lanes::load(&edges.gradient, at))
                + weighted_squares(bend, |at| fall(at) - fall(at - stride))
        });
        anchors + lines.sum::<f64>()
    }

    /// Fills the stiffness and the right-hand side; returns the cost of the heights and the mean stiffness.
    fn linearise(&mut self, terms: &SlopeTerms<'_>) -> (f64, f64) {
        let (mut costs, mut stiffnesses) = (0.0_f64, 0.0_f64);
        for (index, source) in self.blocks() {
            let cells = self.flagged(index, CELL);
            if cells.any() {
                let slopes = cell_slopes(&self.z, index, self.width);
                let frames = terms.frames(&self.frames, index);
                let shading = terms.linearise(&frames, terms.cell_log(source), slopes, cells);
                costs += f64::from(shading.cost.sum());
                let [pp, _, qq] = shading.matrix;
                stiffnesses += 0.5 * f64::from((pp + qq).sum());
                self.operator.set_cells(index, &shading);
            }
        }
        let linked: f64 = self.edges.iter().flat_map(|edges| &edges.weight).map(|&weight| f64::from(weight)).sum();
        for ((off, z), anchor) in self.direction.iter_mut().zip(&self.z).zip(&self.anchor) {
            *off = z - anchor;
        }
        self.operator.resist(&self.edges, &self.z, &self.anchor_weight, &self.direction, &mut self.right);
        (costs + self.resistance(&self.z), ((stiffnesses + 0.5 * linked) / self.pixels as f64).max(LEAST_STIFFNESS))
    }

    /// step = solution of the linearised system by preconditioned conjugate gradients. Returns by how much the
    /// linearised cost falls.
    fn find_step(&mut self, damping: f32, mean_stiffness: f64, effort: Effort, cost: f64) -> f64 {
        let anchors: f64 = self.anchor_weight.iter().map(|&weight| f64::from(weight)).sum();
        self.cosine.set(mean_stiffness + f64::from(damping), anchors / self.pixels as f64);
        self.operator.set_links(&self.edges, |index| [RIGHT, BELOW].map(|flag| self.near[index] & flag != 0), damping);
        self.step.fill(0.0);
        self.cosine.solve(&self.right, &mut self.direction);
        self.restrict_direction();
        // `trial` holds the residual: it is written anew after the step.
        self.trial.copy_from_slice(&self.right);
        let mut rho = dot(&self.trial, &self.direction);
        let target = effort.tolerance * effort.tolerance * rho;
        let mut promise = 0.0;
        for _ in 0..effort.rounds {
            self.operator.apply(&self.anchor_weight, &self.direction, &mut self.image);
            let curvature = dot(&self.direction, &self.image);
            let length = (rho / curvature) as f32;
            if !(length.is_finite() && curvature > 0.0) {
                break;
            }
            add_scaled(&mut self.step, length, &self.direction);
            let gain = rho * f64::from(length);
            promise += gain;
            if gain < IDLE * cost {
                break;
            }
            add_scaled(&mut self.trial, -length, &self.image);
            self.cosine.solve(&self.trial, &mut self.image);
            let next = dot(&self.trial, &self.image);
            if next <= target {
                break;
            }
            let turn = (next / rho) as f32;
            rho = next;
            for (direction, image) in self.direction.iter_mut().zip(&self.image) {
                *direction = image + turn * *direction;
            }
            self.restrict_direction();
        }
        promise
    }

    fn restrict_direction(&mut self) {
        for (direction, &near) in self.direction.iter_mut().zip(&self.near) {
            if near == 0 {
                *direction = 0.0;
            }
        }
    }
}

/// Sum of weight times square over all pixels; `off` may be anything where there is no weight.
#[inline(always)]
fn weighted_squares(weight: &[f32], off: impl Fn(isize) -> Lanes) -> f64 {
    let zero = Lanes::splat(0.0);
    let mut total = 0.0;
    for start in (0..weight.len()).step_by(SUMMANDS) {
        let mut sum = zero;
        for at in (start..weight.len().min(start + SUMMANDS)).step_by(LANES) {
            let (weight, off) = (Lanes::load(weight, at as isize), off(at as isize));
            sum = sum + zero.less(weight).select(weight * off * off, zero);
        }
        total += f64::from(sum.sum());
    }
    total
}

/// p and q in the middle of the cells right of and below some pixels.
#[inline(always)]
fn cell_slopes(z: &[f32], index: usize, width: usize) -> [Lanes; 2] {
    let (here, below) = (index as isize, (index + width) as isize);
    let [a, b, c, d] = [here, here + 1, below, below + 1].map(|at| Lanes::load(z, at));
    let half = Lanes::splat(0.5);
    [half * (b - a + d - c), half * (c - a + d - b)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::LightPrior;
    use crate::shape::AnchorWeight;

    /// A used solver knows nothing of what it solved before.
    #[test]
    fn anchors_of_an_earlier_solve_are_forgotten() {
        let size = Size { width: 9, height: 7 };
        let mask: Vec<bool> = (0..size.len()).map(|index| index % 11 != 5).collect();
        let colours: [Vec<f32>; 3] =
            std::array::from_fn(|channel| (0..size.len()).map(|k| 0.1 * ((k + channel) as f32).sin()).collect());
        let slopes = vec![0.2_f32; size.len()];
        let far = vec![40.0_f32; size.len()];
        let light = LightPrior::natural().mean();
        let free = HeightProblem {
            log: colours.each_ref().map(Vec::as_slice),
            light: &light,
            rotation: &Matrix3::identity(),
            slopes: [&slopes, &slopes],
            firmness: None,
            anchors: None,
            colour_scale: 0.2,
            effort: Effort { steps: 4, rounds: 10, tolerance: 0.03 },
        };
        let anchors = Some(Anchors { height: &far, weight: AnchorWeight::Uniform(5.0) });
        let solver = || HeightSolver::new(size, Camera::Orthographic, &mask).expect("a solver");
        let solve = |solver: &mut HeightSolver, problem| {
            let mut heights = vec![0.0; size.len()];
            (solver.solve(problem, &mut heights), heights)
        };
        let mut used = solver();
        let (report, anchored) = solve(&mut used, HeightProblem { anchors, ..free });
        assert!(report.cost < report.first_cost && anchored[0] > 30.0, "{report:?} {}", anchored[0]);
        assert_eq!(solve(&mut used, free), solve(&mut solver(), free));
    }
}
