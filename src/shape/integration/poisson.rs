//! min over z of sum_e w_e (z_j - z_i - g_e)^2 + sum_i a_i (z_i - t_i)^2 over the edges e = (i, j) of a masked raster.
//!
//! Method: conjugate gradients on the normal equations (L_w + diag a) z = b, preconditioned by the rectangle: extend
//! the residual by zero, solve (c L + s) there by [`CosineSolver`], restrict; c is the mean weight of the edges and s
//! the mean weight of the anchors. On a full rectangle with equal weights that is the inverse and one iteration is the
//! answer. On a mask the condition number does not grow with the resolution, only with how ragged the mask is: 5 to 10
//! iterations for compact objects with holes, 20 for scattered pixels. Weights near zero along a line (a discontinuity
//! of n pixels) act as a crack the rectangle knows nothing of; the condition then grows with n, the iterations with its
//! root.
//!
//! Limits: what no edge and no anchor touches is not determined and keeps whatever it holds; each component without
//! anchors is determined up to a constant. Pixels are f32, sums f64: relative tolerances below 1e-6 are not reached.

use crate::numeric::LANES;
use crate::numeric::cosine::CosineSolver;
use crate::numeric::vector::{add_scaled, dot, sum_of};

/// Why a solve ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Termination {
    /// The relative residual is within the tolerance.
    Converged,
    /// The cap on iterations came first; the heights are the best so far and usable.
    IterationCap,
    /// There was no edge and no anchor to work on.
    Empty,
    /// Numbers ran out of range; the heights are not to be used.
    Breakdown,
}

/// What one solve did.
#[derive(Clone, Copy, Debug)]
pub struct Solved {
    pub iterations: u32,
    pub residual: f64,
    pub termination: Termination,
}

/// Edge e from a pixel to its right or lower neighbour, stored at the pixel.
pub struct Edges {
    /// w_e >= 0; zero where there is no edge, which includes the last column (row).
    pub weight: Vec<f32>,
    /// g_e.
    pub gradient: Vec<f32>,
}

impl Edges {
    pub fn new(length: usize) -> Self {
        Self { weight: vec![0.0; length], gradient: vec![0.0; length] }
    }
}

/// The system on a rectangle and the memory of its solver.
pub struct Poisson {
    /// Columns of the raster, at least those asked for.
    pub width: usize,
    pub right: Edges,
    pub down: Edges,
    /// a_i >= 0.
    pub anchor_weight: Vec<f32>,
    /// t_i, finite.
    pub anchor: Vec<f32>,
    /// Current heights; the next solve starts from them.
    pub z: Vec<f32>,
    solver: CosineSolver,
    residual: Vec<f32>,
    direction: Vec<f32>,
    /// Preconditioned residual, then the system applied to the direction: never needed at once.
    work: Vec<f32>,
    spectrum: Vec<f32>,
    flux: Flux,
}

impl Poisson {
    /// A system without edges or anchors for a raster of at least `columns` x `rows`; it may be wider.
    pub fn new(columns: usize, rows: usize) -> Self {
        let (width, height) = (columns.next_multiple_of(LANES), rows);
        let length = width * height;
        let solver = CosineSolver::new(width, height);
        Self {
            width,
            right: Edges::new(length),
            down: Edges::new(length),
            anchor_weight: vec![0.0; length],
            anchor: vec![0.0; length],
            z: vec![0.0; length],
            spectrum: vec![0.0; solver.len()],
            solver,
            residual: vec![0.0; length],
            direction: vec![0.0; length],
            work: vec![0.0; length],
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
        self.solver.set(stiffness, anchors / pixels.max(1) as f64);
    }

    /// Conjugate gradients from the current heights until the error is below `tolerance`, or `cap` iterations.
    ///
    /// The error is measured in the norm that is minimised, estimated by the preconditioner, relative to that of the
    /// data (sum w g^2 + sum a t^2)^(1/2).
    pub fn solve(&mut self, tolerance: f64, cap: u32) -> Solved {
        let data = self.data_energy();
        let done = |iterations, rho: f64, termination| Solved {
            iterations,
            residual: if data > 0.0 { (rho.max(0.0) / data).sqrt() } else { 0.0 },
            termination,
        };
        let target = tolerance * tolerance * data;
        self.find_residual();
        let mut rho = self.precondition_residual();
        self.direction.copy_from_slice(&self.work);
        for iteration in 0..cap {
            if rho <= target {
                return done(iteration, rho, Termination::Converged);
            }
            self.apply();
            let curvature = dot(&self.direction, &self.work);
            let step = rho / curvature;
            if !(step.is_finite() && curvature > 0.0) {
                return done(iteration, rho, Termination::Breakdown);
            }
            add_scaled(&mut self.z, step as f32, &self.direction);
            add_scaled(&mut self.residual, -step as f32, &self.work);
            let next = self.precondition_residual();
            let turn = (next / rho) as f32;
            rho = next;
            self.direction.iter_mut().zip(&self.work).for_each(|(d, s)| *d = s + turn * *d);
        }
        let ended = if rho <= target {
            Termination::Converged
        } else if rho.is_finite() {
            Termination::IterationCap
        } else {
            Termination::Breakdown
        };
        done(cap, rho, ended)
    }

    /// sum w g^2 + sum a t^2.
    fn data_energy(&self) -> f64 {
        let term = |weight: &[f32], value: &[f32]| sum_of(weight, value, |w, v| f64::from(w) * f64::from(v).powi(2));
        term(&self.right.weight, &self.right.gradient)
            + term(&self.down.weight, &self.down.gradient)
            + term(&self.anchor_weight, &self.anchor)
    }

    /// residual = b - (L_w + a) z: half the downhill gradient of what is minimised.
    fn find_residual(&mut self) {
        self.flux.divergence([&self.right, &self.down], true, &self.z, &mut self.residual);
        let anchors = self.anchor_weight.iter().zip(&self.anchor).zip(&self.z);
        for (out, ((a, t), z)) in self.residual.iter_mut().zip(anchors) {
            *out += a * (t - z);
        }
    }

    /// work = (L_w + a) direction.
    fn apply(&mut self) {
        self.flux.divergence([&self.right, &self.down], false, &self.direction, &mut self.work);
        for ((out, a), d) in self.work.iter_mut().zip(&self.anchor_weight).zip(&self.direction) {
            *out = a * d - *out;
        }
    }

    /// work = preconditioned residual; returns its product with the residual. Off the domain the residual is zero and
    /// no edge reads a height, so that extension and restriction need no code.
    fn precondition_residual(&mut self) -> f64 {
        self.solver.solve(&self.residual, &mut self.spectrum, &mut self.work);
        dot(&self.work, &self.residual)
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

    /// out_i = sum of w (z_j - z_i - g) over the edges that leave i minus those that enter it; g counts
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

/// out = w (next - here - g), as long as the shortest.
fn flux(weight: &[f32], here: &[f32], next: &[f32], gradient: &[f32], out: &mut [f32]) {
    let ends = here.iter().zip(next).zip(gradient);
    for ((out, w), ((here, next), g)) in out.iter_mut().zip(weight).zip(ends) {
        *out = w * (next - here - g);
    }
}
