//! min over z of sum_e w_e (z_j - z_i - g_e)^2 + sum_i a_i (z_i - t_i)^2 over the edges e = (i, j) of a masked raster:
//! a weighted discrete Poisson equation (docs/method/normals.md).
//!
//! Method: conjugate gradients on the normal equations (L_w + diag a) z = b, preconditioned by the rectangle: extend
//! the residual by zero, solve (c L + s) there by [`CosineSolver`], restrict. Here c is the mean weight of the edges
//! and s the mean weight of the anchors. On a full rectangle with equal weights this is the inverse, and one iteration
//! gives the answer. On a mask, the condition number does not grow with the resolution, only with the raggedness of the
//! mask: 5 to 10 iterations for compact objects with holes, 20 for scattered pixels. Weights near zero along a line (a
//! discontinuity of n pixels) act as a crack unknown to the rectangle; the condition number then grows with n, and the
//! iterations with its square root.
//!
//! Limits: a pixel without edge and anchor is undetermined and keeps its value; each component without anchors is
//! determined up to a constant. Pixels are f32, sums f64: relative tolerances below 1e-6 are not reached.

use super::terms::Edges;
use crate::numeric::LANES;
use crate::numeric::conjugate_gradient::{self, End, Limits, System, Vectors};
use crate::numeric::cosine::CosineSolver;
use crate::numeric::vector::{dot, sum_of};

/// Why a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IntegrationTermination {
    /// The relative residual is within the tolerance.
    Converged,
    /// The maximum number of iterations was reached; the heights are the best so far and usable.
    IterationCap,
    /// There was no edge and no anchor.
    Empty,
    /// Numbers overflowed; the heights are unusable.
    Breakdown,
}

/// Report of one solve.
#[derive(Clone, Copy, Debug)]
pub struct PoissonReport {
    pub iterations: u32,
    pub residual: f64,
    pub termination: IntegrationTermination,
}

/// The system on a rectangle, with the memory of its solver.
pub struct Poisson {
    /// Columns of the raster, at least as many as requested.
    pub width: usize,
    pub right: Edges,
    pub down: Edges,
    /// a_i >= 0.
    pub anchor_weight: Vec<f32>,
    /// t_i, finite.
    pub anchor: Vec<f32>,
    /// Current heights; the next solve starts from them.
    pub z: Vec<f32>,
    cosine: CosineSolver,
    residual: Vec<f32>,
    direction: Vec<f32>,
    product: Vec<f32>,
    spectrum: Vec<f32>,
    flux: Flux,
}

impl Poisson {
    /// A system without edges or anchors for a raster of at least `columns` x `rows`; it may be wider.
    pub fn new(columns: usize, rows: usize) -> Self {
        let (width, height) = (columns.next_multiple_of(LANES), rows);
        let length = width * height;
        let cosine = CosineSolver::new(width, height);
        Self {
            width,
            right: Edges::new(length),
            down: Edges::new(length),
            anchor_weight: vec![0.0; length],
            anchor: vec![0.0; length],
            z: vec![0.0; length],
            spectrum: vec![0.0; cosine.len()],
            cosine,
            residual: vec![0.0; length],
            direction: vec![0.0; length],
            product: vec![0.0; length],
            flux: Flux::new(width),
        }
    }

    /// Fits the preconditioner to the current weights; `pixels` is the number of pixels in the domain.
    pub fn precondition(&mut self, pixels: usize) {
        let edges = self.right.weight.iter().chain(&self.down.weight);
        let (count, sum) =
            edges.filter(|&&w| w > 0.0).fold((0usize, 0.0), |(count, sum), &w| (count + 1, sum + f64::from(w)));
        let anchors: f64 = self.anchor_weight.iter().map(|&a| f64::from(a)).sum();
        let stiffness = if count == 0 { 1.0 } else { sum / count as f64 };
        self.cosine.set(stiffness, anchors / pixels.max(1) as f64);
    }

    /// Runs conjugate gradients from the current heights until the error is below `tolerance`, or for `cap` iterations.
    ///
    /// The error is measured in the norm that is minimised, estimated by the preconditioner, relative to that of the
    /// data, (sum w g^2 + sum a t^2)^(1/2).
    pub fn solve(&mut self, tolerance: f64, cap: u32) -> PoissonReport {
        let data = self.squared_data();
        self.find_residual();
        let limits =
            Limits { iterations: cap, error: tolerance * tolerance * data, relative_error: 0.0, decrease: 0.0 };
        let mut equations = PoissonSystem {
            edges: [&self.right, &self.down],
            anchor_weight: &self.anchor_weight,
            flux: &mut self.flux,
            cosine: &mut self.cosine,
            spectrum: &mut self.spectrum,
        };
        let vectors = Vectors {
            solution: &mut self.z,
            residual: &mut self.residual,
            direction: &mut self.direction,
            product: &mut self.product,
        };
        let solved = conjugate_gradient::solve(&mut equations, limits, vectors);
        let (error, termination) = match solved.end {
            End::Converged => (solved.error, IntegrationTermination::Converged),
            End::Breakdown => (solved.error, IntegrationTermination::Breakdown),
            End::Capped => {
                equations.precondition(&self.residual, &mut self.product);
                match dot(&self.residual, &self.product) {
                    error if error <= limits.error => (error, IntegrationTermination::Converged),
                    error if error.is_finite() => (error, IntegrationTermination::IterationCap),
                    error => (error, IntegrationTermination::Breakdown),
                }
            }
        };
        let residual = if data > 0.0 { (error.max(0.0) / data).sqrt() } else { 0.0 };
        PoissonReport { iterations: solved.iterations, residual, termination }
    }

    /// sum w g^2 + sum a t^2.
    fn squared_data(&self) -> f64 {
        let term = |weight: &[f32], value: &[f32]| sum_of(weight, value, |w, v| f64::from(w) * f64::from(v).powi(2));
        term(&self.right.weight, &self.right.gradient)
            + term(&self.down.weight, &self.down.gradient)
            + term(&self.anchor_weight, &self.anchor)
    }

    /// residual = b - (L_w + a) z: minus half the gradient of the objective.
    fn find_residual(&mut self) {
        self.flux.divergence([&self.right, &self.down], true, &self.z, &mut self.residual);
        let anchors = self.anchor_weight.iter().zip(&self.anchor).zip(&self.z);
        for (out, ((a, t), z)) in self.residual.iter_mut().zip(anchors) {
            *out += a * (t - z);
        }
    }
}

/// L_w + diag a and its preconditioner. Off the domain the residual is zero and no edge reads a height, so extension
/// and restriction need no code.
struct PoissonSystem<'a> {
    edges: [&'a Edges; 2],
    anchor_weight: &'a [f32],
    flux: &'a mut Flux,
    cosine: &'a mut CosineSolver,
    spectrum: &'a mut [f32],
}

impl System for PoissonSystem<'_> {
    fn apply(&mut self, direction: &[f32], product: &mut [f32]) {
        self.flux.divergence(self.edges, false, direction, product);
        for ((out, a), d) in product.iter_mut().zip(self.anchor_weight).zip(direction) {
            *out = a * d - *out;
        }
    }

    fn precondition(&mut self, residual: &[f32], solution: &mut [f32]) {
        self.cosine.solve(residual, self.spectrum, solution);
    }
}

/// Scratch rows of the divergence.
struct Flux {
    width: usize,
    /// Flux into each pixel from the left, one longer than a row; both ends stay zero.
    right: Vec<f32>,
    /// Flux through the lower side of the row above and of this row.
    above: Vec<f32>,
    below: Vec<f32>,
    zeros: Vec<f32>,
}

impl Flux {
    fn new(width: usize) -> Self {
        Self {
            width,
            right: vec![0.0; width + 1],
            above: vec![0.0; width],
            below: vec![0.0; width],
            zeros: vec![0.0; width],
        }
    }

    /// out_i = sum of w (z_j - z_i - g) over the edges that leave i, minus those that enter it; g is included if
    /// `with_gradient`.
    fn divergence(&mut self, [right, down]: [&Edges; 2], with_gradient: bool, z: &[f32], out: &mut [f32]) {
        let width = self.width;
        self.above.fill(0.0);
        for (row, out) in out.chunks_exact_mut(width).enumerate() {
            let here = row * width..(row + 1) * width;
            let (gx, gy) = if with_gradient {
                (&right.gradient[here.clone()], &down.gradient[here.clone()])
            } else {
                (&self.zeros[..], &self.zeros[..])
            };
            let z_here = &z[here.clone()];
            flux(&right.weight[here.clone()], z_here, &z_here[1..], gx, &mut self.right[1..width]);
            match z.get(here.end..here.end + width) {
                Some(z_below) => flux(&down.weight[here], z_here, z_below, gy, &mut self.below),
                None => self.below.fill(0.0),
            }
            let vertical = self.below.iter().zip(&self.above);
            for ((out, sides), (below, above)) in out.iter_mut().zip(self.right.windows(2)).zip(vertical) {
                *out = sides[1] - sides[0] + below - above;
            }
            std::mem::swap(&mut self.above, &mut self.below);
        }
    }
}

/// out = w (next - here - g), up to the length of the shortest slice.
fn flux(weight: &[f32], here: &[f32], next: &[f32], gradient: &[f32], out: &mut [f32]) {
    let ends = here.iter().zip(next).zip(gradient);
    for ((out, w), ((here, next), g)) in out.iter_mut().zip(weight).zip(ends) {
        *out = w * (next - here - g);
    }
}
