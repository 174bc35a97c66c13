//! Shape from shading for the heights themselves: min over z of
//! sum_cells rho(|log S - S(n)|) + sum_edges w (z_j - z_i - g)^2 + sum_i a_i (z_i - anchor_i)^2
//! + sum_i kappa_i (second differences of z)^2 (docs/method/heights.md).
//!
//! The unknown is the surface, so every normal is integrable by construction. Single pixels lack this constraint, and
//! under natural light their three colours hardly distinguish one normal from another. n is the unit vector of N = a +
//! p b + q c at the centre of a cell of four pixels, with p, q the slopes of z there and (a, b, c) fixed vectors of the
//! pixel's ray (`ray_frames`); rho is Geman-McClure. The edges hold the slopes of the pixels' own normals (trapezoidal
//! rule, as in the integration), weighted by how well the colours of a single pixel determine its normal: under
//! colourful light they decide, up to the border of the mask; under natural light they hardly weigh.
//!
//! Method: Gauss-Newton on z, damped by the Laplacian (Levenberg-Marquardt). Each step uses matrix-free conjugate
//! gradients, preconditioned by the cosine solve of the enclosing rectangle. Limits: the problem is not convex, so the
//! start matters; across an occlusion edge the slope is wrong, and rho must discard it.

use super::cell_terms::CellTerms;
use super::domain::{ABOVE, BELOW, CELL, HeightDomain, INSIDE, LEFT, RIGHT};
use super::normal_operator::NormalOperator;
use super::problem::{Bending, Effort, HALVING_CONFIDENCE, HeightProblem};
use super::rasters::{padded, resize};
use crate::numeric::conjugate_gradient::{self, Limits, System, Vectors};
use crate::numeric::cosine::CosineSolver;
use crate::numeric::{LANES, Lanes, Real, robust};
use crate::shape::integration::Edges;

/// kappa, the weight of a squared second difference in pixels, relative to that of a squared log residual. Set on
/// Mozart at 64x64 with 2 % noise under the lights A, B and C, with the light known (docs/lab/thresholds.md).
const SMOOTHNESS: f32 = 1e-3;
/// Bounds of the damping, relative to the mean stiffness of the terms.
const DAMPING: [f32; 2] = [1e-4, 1e4];
/// Divisor of the damping after a step that lowered the objective, and factor after one that did not.
const DAMPING_DIVISOR: f32 = 5.0;
const DAMPING_FACTOR: f32 = 10.0;
/// Least stiffness of the preconditioner, squared log residual per squared slope, which keeps dark pixels from making
/// it singular.
const LEAST_STIFFNESS: f64 = 1e-6;
/// The solve has converged when a step lowers the objective by less than this share.
const SMALLEST_DECREASE: f64 = 1e-4;
/// The conjugate gradients of a step end when an iteration lowers the linearised objective by less than this share.
const SMALLEST_GAIN: f64 = 1e-5;

/// Solves several domains repeatedly. No two solves run at once, so all levels of both views share this memory; the
/// first solve allocates it for the largest domain.
pub struct HeightSolver {
    /// Largest number of values in a raster.
    room: usize,
    z: Vec<f32>,
    /// Heights after a step; while the step is computed, its residual.
    trial: Vec<f32>,
    anchor: Vec<f32>,
    anchor_weight: Vec<f32>,
    /// Sums of the weights of all anchors and of all edges.
    anchors_weight: f64,
    edges_weight: f64,
    operator: NormalOperator,
    /// Suggested height differences to the right and lower neighbours, and their weights.
    edges: [Edges; 2],
    step: Vec<f32>,
    right: Vec<f32>,
    direction: Vec<f32>,
    /// The operator's product with the direction. Before a direction exists, the confidence of the pixels.
    product: Vec<f32>,
    /// Scratch memory of the preconditioner.
    spectrum: Vec<f32>,
}

impl HeightSolver {
    /// A solver for `domains`. It also accepts other domains, and reallocates for a larger one.
    #[inline(never)]
    pub fn new(domains: &[&HeightDomain]) -> Self {
        let room = |domain: &&HeightDomain| padded(domain.len(), domain.width).max(domain.cosine.len());
        Self {
            room: domains.iter().map(room).max().unwrap_or(0),
            z: Vec::new(),
            trial: Vec::new(),
            anchor: Vec::new(),
            anchor_weight: Vec::new(),
            anchors_weight: 0.0,
            edges_weight: 0.0,
            operator: NormalOperator::default(),
            edges: [Edges::new(0), Edges::new(0)],
            step: Vec::new(),
            right: Vec::new(),
            direction: Vec::new(),
            product: Vec::new(),
            spectrum: Vec::new(),
        }
    }

    /// Resizes the rasters to `domain`, with arbitrary contents: a solve writes them before it reads them.
    fn resize(&mut self, domain: &HeightDomain) {
        let (length, room) = (domain.len(), self.room);
        for raster in [&mut self.z, &mut self.trial, &mut self.anchor, &mut self.anchor_weight] {
            resize(raster, length, room);
        }
        for Edges { weight, gradient } in &mut self.edges {
            resize(weight, length, room);
            resize(gradient, length, room);
        }
        for raster in [&mut self.step, &mut self.right, &mut self.direction, &mut self.product] {
            resize(raster, length, room);
        }
        resize(&mut self.spectrum, domain.cosine.len(), room);
        self.operator.resize(domain.width, length, room);
    }

    /// Improves `z` (depth in pixels, or f log Z; finite on the mask) in place; returns the final objective per pixel.
    pub fn solve(&mut self, domain: &mut HeightDomain, problem: HeightProblem<'_>, z: &mut [f32]) -> f64 {
        self.resize(domain);
        self.load(domain, problem, z);
        let terms = CellTerms::new(problem, domain.size);
        self.load_edges(domain, &terms);
        let (mut objective, mut damping) = (0.0, problem.effort.damping);
        for step in 0..problem.effort.steps {
            let (here, stiffness) = self.linearise(domain, &terms);
            if step == 0 {
                objective = here;
            }
            let Some(lower) = self.descend(domain, &terms, [objective, stiffness], &mut damping) else { break };
            let decrease = objective - lower;
            let converged = decrease < SMALLEST_DECREASE * objective;
            objective = lower;
            if converged {
                break;
            }
        }
        for (index, source) in domain.inside() {
            z[source] = self.z[index];
        }
        objective / domain.pixels as f64
    }

    /// Takes one step that lowers the objective, with as much damping as necessary, and returns the new objective.
    /// `None` if there is no such step or its expected gain is too small.
    fn descend(
        &mut self,
        domain: &mut HeightDomain,
        terms: &CellTerms<'_>,
        [objective, stiffness]: [f64; 2],
        damping: &mut f32,
    ) -> Option<f64> {
        while *damping <= DAMPING[1] {
            let limits = limits(terms.problem.effort, objective);
            let expected = self.find_step(domain, *damping * stiffness as f32, stiffness, limits);
            if expected < SMALLEST_DECREASE * objective {
                return None;
            }
            for ((trial, z), step) in self.trial.iter_mut().zip(&self.z).zip(&self.step) {
                *trial = z + step;
            }
            let lower = self.objective(domain, terms);
            if lower < objective {
                std::mem::swap(&mut self.z, &mut self.trial);
                *damping = (*damping / DAMPING_DIVISOR).max(DAMPING[0]);
                return Some(lower);
            }
            *damping *= DAMPING_FACTOR;
        }
        None
    }

    fn load(&mut self, domain: &HeightDomain, problem: HeightProblem<'_>, z: &[f32]) {
        let zero = Lanes::splat(0.0);
        let mut sum = 0.0;
        for (here, source) in domain.rows() {
            let mut row = zero;
            for column in (0..domain.columns).step_by(LANES) {
                let (index, source) = (here + column, (source + column) as isize);
                let inside = domain.flagged(index, INSIDE);
                inside.select(Lanes::load(z, source), zero).store(&mut self.z[index..]);
                let (height, weight) = problem.anchors.map_or((zero, zero), |anchors| anchors.four(source, inside));
                height.store(&mut self.anchor[index..]);
                weight.store(&mut self.anchor_weight[index..]);
                row = row + weight;
            }
            sum += f64::from(row.sum());
        }
        self.anchors_weight = sum;
    }

    /// Edges between neighbours that have their own slopes (trapezoidal rule), weighted by the lower confidence of the
    /// two.
    fn load_edges(&mut self, domain: &HeightDomain, terms: &CellTerms<'_>) {
        let (zero, slopes) = (Lanes::splat(0.0), terms.problem.slopes);
        for (here, source) in domain.rows() {
            for column in (0..domain.columns).step_by(LANES) {
                let (index, source) = (here + column, source + column);
                let suggested = slopes.map(|slopes| Lanes::load(slopes, source as isize));
                let wanted = domain.flagged(index, INSIDE) & suggested[0].finite() & suggested[1].finite();
                let confidence = if wanted.any() {
                    terms.confidence(&terms.frames(&domain.frames, index), source, suggested, wanted)
                } else {
                    zero
                };
                confidence.store(&mut self.product[index..]);
            }
        }
        self.edges_weight = 0.0;
        for (axis, strides) in [[1, 1], [domain.width, domain.size.width]].into_iter().enumerate() {
            let strides = strides.map(|stride| stride as isize);
            self.edges_weight += self.load_axis(domain, axis, strides, slopes[axis], terms.problem.bending);
        }
    }

    /// Edges and smoothness along one axis, with the distance of neighbours here and in the view; returns the sum of
    /// the edges' weights.
    fn load_axis(
        &mut self,
        domain: &HeightDomain,
        axis: usize,
        [stride, view_stride]: [isize; 2],
        slopes: &[f32],
        bending: Bending,
    ) -> f64 {
        let (zero, half) = (Lanes::splat(0.0), Lanes::splat(0.5));
        let halving = Lanes::splat(HALVING_CONFIDENCE);
        let most = Lanes::splat(SMOOTHNESS * HALVING_CONFIDENCE);
        let (known, doubted) = (Lanes::splat(bending.weight * bending.halving), Lanes::splat(bending.halving));
        let inverse_square = Lanes::splat(1.0 / (bending.scale * bending.scale));
        let [before, after] = [[LEFT, RIGHT], [ABOVE, BELOW]][axis];
        let mut sum = 0.0;
        for (here, source) in domain.rows() {
            let mut row = zero;
            for column in (0..domain.columns).step_by(LANES) {
                let (index, source) = (here + column, (source + column) as isize);
                let (place, joined) = (index as isize, domain.flagged(index, after));
                let confidence = Lanes::load(&self.product, place);
                let weight = joined.select(confidence.min(Lanes::load(&self.product, place + stride)), zero);
                let gradient = half * (Lanes::load(slopes, source) + Lanes::load(slopes, source + view_stride));
                weight.store(&mut self.edges[axis].weight[index..]);
                zero.less(weight).select(gradient, zero).store(&mut self.edges[axis].gradient[index..]);
                // kappa is smaller where a pixel's colours determine its normal.
                let (z, here) = (&self.z, Lanes::load(&self.z, place));
                let second = Lanes::load(z, place + stride) - (here + here) + Lanes::load(z, place - stride);
                let bend = known / (doubted + confidence) * robust::weight(second * second * inverse_square);
                let inner = joined & domain.flagged(index, before);
                let kappa = inner.select(most / (halving + confidence) + bend, zero);
                kappa.store(&mut self.operator.smoothness[axis][index..]);
                row = row + weight;
            }
            sum += f64::from(row.sum());
        }
        sum
    }

    /// Objective of the trial heights.
    fn objective(&self, domain: &HeightDomain, terms: &CellTerms<'_>) -> f64 {
        let (z, mut total) = (&self.trial, 0.0);
        for (here, source) in domain.rows() {
            let mut row = Lanes::splat(0.0);
            for index in (here..here + domain.columns).step_by(LANES) {
                if domain.flagged(index, u8::MAX).any() {
                    row = row + self.regularisation(z, index as isize, domain.width);
                }
                let cells = domain.flagged(index, CELL);
                if cells.any() {
                    let frames = terms.frames(&domain.frames, index);
                    let slopes = cell_slopes(z, index, domain.width);
                    row = row + terms.objective(&frames, terms.cell_log(source + index - here), slopes, cells);
                }
            }
            total += f64::from(row.sum());
        }
        total
    }

    /// All terms of a block except the colours': anchors, edges and smoothness.
    #[inline(never)]
    fn regularisation(&self, z: &[f32], at: isize, width: usize) -> Lanes {
        let here = Lanes::load(z, at);
        let mut sum = weighted_square(&self.anchor_weight, at, here - Lanes::load(&self.anchor, at));
        for (axis, stride) in [1, width as isize].into_iter().enumerate() {
            let (fall, before) = (Lanes::load(z, at + stride) - here, here - Lanes::load(z, at - stride));
            let edges = &self.edges[axis];
            sum = sum + weighted_square(&edges.weight, at, fall - Lanes::load(&edges.gradient, at));
            sum = sum + weighted_square(&self.operator.smoothness[axis], at, fall - before);
        }
        sum
    }

    /// Fills the matrix and the right-hand side; returns the objective of the heights and the mean stiffness.
    fn linearise(&mut self, domain: &HeightDomain, terms: &CellTerms<'_>) -> (f64, f64) {
        let (mut objective, mut stiffness) = (0.0_f64, 0.0_f64);
        for (here, source) in domain.rows() {
            let (mut row, mut row_stiffness) = (Lanes::splat(0.0), Lanes::splat(0.0));
            for index in (here..here + domain.columns).step_by(LANES) {
                if domain.flagged(index, u8::MAX).any() {
                    row = row + self.regularisation(&self.z, index as isize, domain.width);
                }
                let cells = domain.flagged(index, CELL);
                if cells.any() {
                    let slopes = cell_slopes(&self.z, index, domain.width);
                    let frames = terms.frames(&domain.frames, index);
                    let shading = terms.linearise(&frames, terms.cell_log(source + index - here), slopes, cells);
                    row = row + shading.objective;
                    row_stiffness = row_stiffness + shading.matrix[0] + shading.matrix[2];
                    self.operator.set_cells(index, &shading);
                }
            }
            objective += f64::from(row.sum());
            stiffness += 0.5 * f64::from(row_stiffness.sum());
        }
        for ((off, z), anchor) in self.direction.iter_mut().zip(&self.z).zip(&self.anchor) {
            *off = z - anchor;
        }
        self.operator.downhill(&self.edges, &self.z, &self.anchor_weight, &self.direction, &mut self.right);
        (objective, ((stiffness + 0.5 * self.edges_weight) / domain.pixels as f64).max(LEAST_STIFFNESS))
    }

    /// step = solution of the linearised system. Returns the decrease of the linearised objective.
    fn find_step(&mut self, domain: &mut HeightDomain, damping: f32, stiffness: f64, limits: Limits) -> f64 {
        domain.cosine.set(stiffness + f64::from(damping), self.anchors_weight / domain.pixels as f64);
        self.operator.set_edges(&self.edges, &domain.flags, [RIGHT, BELOW], damping);
        self.step.fill(0.0);
        self.trial.copy_from_slice(&self.right);
        let mut equations = HeightSystem {
            operator: &mut self.operator,
            anchor_weight: &self.anchor_weight,
            cosine: &mut domain.cosine,
            spectrum: &mut self.spectrum,
        };
        let vectors = Vectors {
            solution: &mut self.step,
            residual: &mut self.trial,
            direction: &mut self.direction,
            product: &mut self.product,
        };
        conjugate_gradient::solve(&mut equations, limits, vectors).decrease
    }
}

/// Limits of the conjugate gradients of one step.
fn limits(effort: Effort, objective: f64) -> Limits {
    Limits {
        iterations: effort.iterations,
        error: 0.0,
        relative_error: effort.tolerance * effort.tolerance,
        decrease: SMALLEST_GAIN * objective,
    }
}

/// The matrix of a step and its preconditioner. Off the mask the right-hand side is zero and no weight reads a height,
/// so extension and restriction need no code.
struct HeightSystem<'a> {
    operator: &'a mut NormalOperator,
    anchor_weight: &'a [f32],
    cosine: &'a mut CosineSolver,
    spectrum: &'a mut [f32],
}

impl System for HeightSystem<'_> {
    fn apply(&mut self, direction: &[f32], product: &mut [f32]) {
        self.operator.apply(self.anchor_weight, direction, product);
    }

    fn precondition(&mut self, residual: &[f32], solution: &mut [f32]) {
        self.cosine.solve(residual, self.spectrum, solution);
    }
}

/// Weight times square; `off` may hold anything where the weight is zero.
#[inline(always)]
fn weighted_square(weight: &[f32], at: isize, off: Lanes) -> Lanes {
    let (weight, zero) = (Lanes::load(weight, at), Lanes::splat(0.0));
    zero.less(weight).select(weight * off * off, zero)
}

/// p and q at the centre of the cells to the right of and below the pixels that begin at `index`.
#[inline(always)]
fn cell_slopes(z: &[f32], index: usize, width: usize) -> [Lanes; 2] {
    let (here, below) = (index as isize, (index + width) as isize);
    let [a, b, c, d] = [here, here + 1, below, below + 1].map(|at| Lanes::load(z, at));
    let half = Lanes::splat(0.5);
    [half * (b - a + d - c), half * (c - a + d - b)]
}

#[cfg(test)]
mod tests {
    use nalgebra::Matrix3;

    use super::*;
    use crate::light::LightPrior;
    use crate::shape::integration::{AnchorWeight, Anchors};
    use crate::view::{Camera, Size};

    /// A reused solver gives the same result as a new one.
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
            normal_weight: None,
            bending: Bending::FREE,
            anchors: None,
            colour_scale: 0.2,
            effort: Effort { steps: 4, iterations: 10, tolerance: 0.03, damping: 0.1 },
        };
        let anchors = Some(Anchors { height: &far, weight: AnchorWeight::Uniform(5.0) });
        let mut domain = HeightDomain::new(size, Camera::Orthographic, &mask).expect("a mask");
        let smaller = Size { width: 6, height: 4 };
        let mut other = HeightDomain::new(smaller, Camera::Orthographic, &mask[..smaller.len()]).expect("a mask");
        let solve = |solver: &mut HeightSolver, domain: &mut HeightDomain, problem| {
            let mut heights = vec![0.0; size.len()];
            (solver.solve(domain, problem, &mut heights), heights)
        };
        let mut used = HeightSolver::new(&[&other]);
        let (objective, anchored) = solve(&mut used, &mut domain, HeightProblem { anchors, ..free });
        // The cost of flat heights is 5 * 40^2.
        assert!(objective < 100.0 && anchored[0] > 30.0, "{objective} {}", anchored[0]);
        solve(&mut used, &mut other, free);
        let mut fresh = HeightSolver::new(&[&domain]);
        assert_eq!(solve(&mut used, &mut domain, free), solve(&mut fresh, &mut domain, free));
    }
}
