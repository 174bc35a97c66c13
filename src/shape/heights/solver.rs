//! Shape from shading for the heights themselves: min over z of
//! sum_cells rho(|log S - S(n)|) + sum_edges w (z_j - z_i - g)^2 + sum_i a_i (z_i - anchor_i)^2
//! + sum_i kappa_i (second differences of z)^2.
//!
//! The unknown is the surface, so every normal is integrable by construction: under natural light, where three colours
//! hardly tell one normal from another, this is what a pixel alone does not know. n is the unit vector of
//! N = a + p b + q c in the middle of a cell of four pixels, with p, q the slopes of z there and (a, b, c) fixed
//! vectors of the pixel's ray (`ray_frames`); rho is Geman-McClure. The edges carry what the pixels' own normals say
//! (trapezoidal rule, as in the integration), as firmly as the colours of one pixel fix its normal: under colourful
//! light they do the work, to the rim of the mask, under natural light they are silent.
//!
//! Method: Gauss-Newton on z, damped by the Laplacian; each step by conjugate gradients, matrix-free, preconditioned
//! by the cosine solve of the enclosing rectangle. Limits: not convex, so the start matters; across an occlusion edge
//! the slope is wrong and rho has to discard it.

use nalgebra::Matrix3;

use super::cell_terms::SlopeTerms;
use super::domain::{ABOVE, BELOW, CELL, HeightDomain, INSIDE, LEFT, RIGHT};
use super::normal_operator::{NormalOperator, padded};
use crate::light::Light;
use crate::numeric::vector::{add_scaled, dot};
use crate::numeric::{LANES, Lanes, Real};
use crate::shape::Anchors;
use crate::shape::integration::Edges;

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

/// Solves one domain or another, again and again. No two solves run at once, so that all levels of both views lend
/// themselves this one's memory; it is allocated by the first solve, for the largest domain.
pub struct HeightSolver {
    /// Most values that a raster will have to hold.
    room: usize,
    z: Vec<f32>,
    trial: Vec<f32>,
    anchor: Vec<f32>,
    anchor_weight: Vec<f32>,
    /// Sums of the weights of all anchors and of all edges.
    anchored: f64,
    linked: f64,
    operator: NormalOperator,
    /// Suggested height differences to the right and lower neighbour, and their weights.
    edges: [Edges; 2],
    step: Vec<f32>,
    right: Vec<f32>,
    direction: Vec<f32>,
    /// The operator's product with the direction, and before there is one the pixels' confidence.
    image: Vec<f32>,
    /// What the preconditioner works on.
    spectrum: Vec<f32>,
}

impl HeightSolver {
    /// A solver whose domains are `domains`. It takes others, too, and allocates again for one that is larger.
    #[inline(never)]
    pub fn new(domains: &[&HeightDomain]) -> Self {
        let room = |domain: &&HeightDomain| padded(domain.len(), domain.width).max(domain.cosine.len());
        Self {
            room: domains.iter().map(room).max().unwrap_or(0),
            z: Vec::new(),
            trial: Vec::new(),
            anchor: Vec::new(),
            anchor_weight: Vec::new(),
            anchored: 0.0,
            linked: 0.0,
            operator: NormalOperator::default(),
            edges: [Edges::new(0), Edges::new(0)],
            step: Vec::new(),
            right: Vec::new(),
            direction: Vec::new(),
            image: Vec::new(),
            spectrum: Vec::new(),
        }
    }

    /// Makes the rasters those of `domain`, with anything in them: a solve writes them before it reads them.
    fn fit(&mut self, domain: &HeightDomain) {
        let (length, room) = (domain.len(), self.room);
        for raster in [&mut self.z, &mut self.trial, &mut self.anchor, &mut self.anchor_weight] {
            fit(raster, length, room);
        }
        for Edges { weight, gradient } in &mut self.edges {
            fit(weight, length, room);
            fit(gradient, length, room);
        }
        for raster in [&mut self.step, &mut self.right, &mut self.direction, &mut self.image] {
            fit(raster, length, room);
        }
        fit(&mut self.spectrum, domain.cosine.len(), room);
        self.operator.fit(domain.width, length, room);
    }

    /// Improves `z` (depth in pixels, or f log Z; finite on the mask) in place.
    pub fn solve(&mut self, domain: &mut HeightDomain, problem: HeightProblem<'_>, z: &mut [f32]) -> HeightReport {
        self.fit(domain);
        self.load(domain, problem, z);
        let terms = SlopeTerms::new(problem, domain.size);
        self.load_edges(domain, &terms);
        let mut report = HeightReport { first_cost: 0.0, cost: 0.0, steps: 0, settled: false };
        let mut damping = FIRST_DAMPING;
        while report.steps < problem.effort.steps && !report.settled {
            let (cost, mean_stiffness) = self.linearise(domain, &terms);
            if report.steps == 0 {
                (report.first_cost, report.cost) = (cost, cost);
            }
            report.steps += 1;
            loop {
                let promise = self.find_step(
                    domain,
                    damping * mean_stiffness as f32,
                    mean_stiffness,
                    problem.effort,
                    report.cost,
                );
                if promise < SETTLED * report.cost {
                    report.settled = true;
                    break;
                }
                for ((trial, z), step) in self.trial.iter_mut().zip(&self.z).zip(&self.step) {
                    *trial = z + step;
                }
                let trial_cost = self.cost(domain, &terms);
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
        for (index, source) in domain.inside() {
            z[source] = self.z[index];
        }
        let share = 1.0 / domain.pixels as f64;
        HeightReport { first_cost: share * report.first_cost, cost: share * report.cost, ..report }
    }

    fn load(&mut self, domain: &HeightDomain, problem: HeightProblem<'_>, z: &[f32]) {
        let zero = Lanes::splat(0.0);
        let mut anchored = 0.0;
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
            anchored += f64::from(row.sum());
        }
        self.anchored = anchored;
    }

    /// Edges between neighbours with suggested slopes (trapezoidal rule), as firm as the less firm of the two.
    fn load_edges(&mut self, domain: &HeightDomain, terms: &SlopeTerms<'_>) {
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
                confidence.store(&mut self.image[index..]);
            }
        }
        self.linked = 0.0;
        for (axis, strides) in [[1, 1], [domain.width, domain.size.width]].into_iter().enumerate() {
            self.linked += self.load_axis(domain, axis, strides.map(|stride| stride as isize), slopes[axis]);
        }
    }

    /// Edges and bends along one axis, whose neighbours are so far apart here and in the view; the sum of the edges' weights.
    fn load_axis(
        &mut self,
        domain: &HeightDomain,
        axis: usize,
        [stride, view_stride]: [isize; 2],
        slopes: &[f32],
    ) -> f64 {
        let (zero, half) = (Lanes::splat(0.0), Lanes::splat(0.5));
        let (smoothness, indecision) = (Lanes::splat(SMOOTHNESS * INDECISION), Lanes::splat(INDECISION));
        let [before, after] = [[LEFT, RIGHT], [ABOVE, BELOW]][axis];
        let mut linked = 0.0;
        for (here, source) in domain.rows() {
            let mut row = zero;
            for column in (0..domain.columns).step_by(LANES) {
                let (index, source) = (here + column, (source + column) as isize);
                let (place, joined) = (index as isize, domain.flagged(index, after));
                let confidence = Lanes::load(&self.image, place);
                let weight = joined.select(confidence.min(Lanes::load(&self.image, place + stride)), zero);
                let gradient = half * (Lanes::load(slopes, source) + Lanes::load(slopes, source + view_stride));
                weight.store(&mut self.edges[axis].weight[index..]);
                zero.less(weight).select(gradient, zero).store(&mut self.edges[axis].gradient[index..]);
                // kappa: less where a pixel's colours fix its normal.
                let bend =
                    (joined & domain.flagged(index, before)).select(smoothness / (indecision + confidence), zero);
                bend.store(&mut self.operator.bend[axis][index..]);
                row = row + weight;
            }
            linked += f64::from(row.sum());
        }
        linked
    }

    /// Cost of the trial heights.
    fn cost(&self, domain: &HeightDomain, terms: &SlopeTerms<'_>) -> f64 {
        let (z, mut total) = (&self.trial, 0.0);
        for (here, source) in domain.rows() {
            let mut row = Lanes::splat(0.0);
            for index in (here..here + domain.columns).step_by(LANES) {
                if domain.flagged(index, u8::MAX).any() {
                    row = row + self.resistance(z, index as isize, domain.width);
                }
                let cells = domain.flagged(index, CELL);
                if cells.any() {
                    let frames = terms.frames(&domain.frames, index);
                    let slopes = cell_slopes(z, index, domain.width);
                    row = row + terms.cost(&frames, terms.cell_log(source + index - here), slopes, cells);
                }
            }
            total += f64::from(row.sum());
        }
        total
    }

    /// Cost of everything but the colours in a block: anchors, edges and bends.
    #[inline(never)]
    fn resistance(&self, z: &[f32], at: isize, width: usize) -> Lanes {
        let here = Lanes::load(z, at);
        let mut cost = weighted_square(&self.anchor_weight, at, here - Lanes::load(&self.anchor, at));
        for (axis, stride) in [1, width as isize].into_iter().enumerate() {
            let (fall, before) = (Lanes::load(z, at + stride) - here, here - Lanes::load(z, at - stride));
            let edges = &self.edges[axis];
            cost = cost + weighted_square(&edges.weight, at, fall - Lanes::load(&edges.gradient, at));
            cost = cost + weighted_square(&self.operator.bend[axis], at, fall - before);
        }
        cost
    }

    /// Fills the stiffness and the right-hand side; returns the cost of the heights and the mean stiffness.
    fn linearise(&mut self, domain: &HeightDomain, terms: &SlopeTerms<'_>) -> (f64, f64) {
        let (mut cost, mut stiffness) = (0.0_f64, 0.0_f64);
        for (here, source) in domain.rows() {
            let (mut row_cost, mut row_stiffness) = (Lanes::splat(0.0), Lanes::splat(0.0));
            for index in (here..here + domain.columns).step_by(LANES) {
                if domain.flagged(index, u8::MAX).any() {
                    row_cost = row_cost + self.resistance(&self.z, index as isize, domain.width);
                }
                let cells = domain.flagged(index, CELL);
                if cells.any() {
                    let slopes = cell_slopes(&self.z, index, domain.width);
                    let frames = terms.frames(&domain.frames, index);
                    let shading = terms.linearise(&frames, terms.cell_log(source + index - here), slopes, cells);
                    row_cost = row_cost + shading.cost;
                    row_stiffness = row_stiffness + shading.matrix[0] + shading.matrix[2];
                    self.operator.set_cells(index, &shading);
                }
            }
            cost += f64::from(row_cost.sum());
            stiffness += 0.5 * f64::from(row_stiffness.sum());
        }
        for ((off, z), anchor) in self.direction.iter_mut().zip(&self.z).zip(&self.anchor) {
            *off = z - anchor;
        }
        self.operator.resist(&self.edges, &self.z, &self.anchor_weight, &self.direction, &mut self.right);
        (cost, ((stiffness + 0.5 * self.linked) / domain.pixels as f64).max(LEAST_STIFFNESS))
    }

    /// step = solution of the linearised system by preconditioned conjugate gradients. Returns by how much the
    /// linearised cost falls.
    fn find_step(
        &mut self,
        domain: &mut HeightDomain,
        damping: f32,
        mean_stiffness: f64,
        effort: Effort,
        cost: f64,
    ) -> f64 {
        domain.cosine.set(mean_stiffness + f64::from(damping), self.anchored / domain.pixels as f64);
        self.operator.set_links(&self.edges, &domain.near, [RIGHT, BELOW], damping);
        self.step.fill(0.0);
        domain.cosine.solve(&self.right, &mut self.spectrum, &mut self.image);
        self.direction.fill(0.0);
        self.direct(domain, 0.0);
        // `trial` holds the residual: it is written anew after the step.
        self.trial.copy_from_slice(&self.right);
        let mut rho = dot(&self.trial, &self.direction);
        let target = effort.tolerance * effort.tolerance * rho;
        let mut promise = 0.0;
        for round in 1..=effort.rounds {
            self.operator.apply(&self.anchor_weight, &self.direction, &mut self.image);
            let curvature = dot(&self.direction, &self.image);
            let length = (rho / curvature) as f32;
            if !(length.is_finite() && curvature > 0.0) {
                break;
            }
            add_scaled(&mut self.step, length, &self.direction);
            let gain = rho * f64::from(length);
            promise += gain;
            if gain < IDLE * cost || round == effort.rounds {
                break;
            }
            add_scaled(&mut self.trial, -length, &self.image);
            domain.cosine.solve(&self.trial, &mut self.spectrum, &mut self.image);
            let next = dot(&self.trial, &self.image);
            if next <= target {
                break;
            }
            self.direct(domain, (next / rho) as f32);
            rho = next;
        }
        promise
    }

    /// direction = image + turn * direction on the mask.
    fn direct(&mut self, domain: &HeightDomain, turn: f32) {
        let (turn, zero) = (Lanes::splat(turn), Lanes::splat(0.0));
        for index in (0..domain.near.len()).step_by(LANES) {
            let [direction, image] = [&self.direction, &self.image].map(|raster| Lanes::load(raster, index as isize));
            let inside = domain.flagged(index, u8::MAX);
            inside.select(image + turn * direction, zero).store(&mut self.direction[index..]);
        }
    }
}

/// Makes a raster one of `length` numbers, whatever they are; there will be `room` for more.
#[inline(never)]
pub(super) fn fit(raster: &mut Vec<f32>, length: usize, room: usize) {
    raster.reserve_exact(room.saturating_sub(raster.len()));
    raster.resize(length, 0.0);
}

/// The same of zeros.
#[inline(never)]
pub(super) fn clear(raster: &mut Vec<f32>, length: usize, room: usize) {
    fit(raster, length, room);
    raster.fill(0.0);
}

/// Weight times square; `off` may be anything where there is no weight.
#[inline(always)]
fn weighted_square(weight: &[f32], at: isize, off: Lanes) -> Lanes {
    let (weight, zero) = (Lanes::load(weight, at), Lanes::splat(0.0));
    zero.less(weight).select(weight * off * off, zero)
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
    use crate::view::{Camera, Size};

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
        let mut domain = HeightDomain::new(size, Camera::Orthographic, &mask).expect("a mask");
        let smaller = Size { width: 6, height: 4 };
        let mut other = HeightDomain::new(smaller, Camera::Orthographic, &mask[..smaller.len()]).expect("a mask");
        let solve = |solver: &mut HeightSolver, domain: &mut HeightDomain, problem| {
            let mut heights = vec![0.0; size.len()];
            (solver.solve(domain, problem, &mut heights), heights)
        };
        let mut used = HeightSolver::new(&[&other]);
        let (report, anchored) = solve(&mut used, &mut domain, HeightProblem { anchors, ..free });
        assert!(report.cost < report.first_cost && anchored[0] > 30.0, "{report:?} {}", anchored[0]);
        solve(&mut used, &mut other, free);
        let mut fresh = HeightSolver::new(&[&domain]);
        assert_eq!(solve(&mut used, &mut domain, free), solve(&mut fresh, &mut domain, free));
    }
}
