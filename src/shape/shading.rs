//! Shape from shading with a shape prior, one normal for each pixel (Eq. 6 to 9).
//!
//! For each pixel: min over n of
//! sum_j (log S_j - [n;1]^T M_j [n;1])^2 + lambda_2 rho(|n - m|^2) + lambda_3 (n^T n - 1)^2,
//! m the normal that the other view sees there, rho the identity or Geman-McClure. The paper writes the two prior
//! terms without a square and lambda_3 linear; a least-squares solver squares them, and so do we.
//!
//! Three colours give up to eight solutions, so each pixel first looks over the whole visible hemisphere, then
//! descends by damped Gauss-Newton. The same code refines the depth view (Eq. 17, 18): its normals, turned into the
//! colour view's frame, are pixels like any other. Limits: normals have n_z < 0, and under a light of one hue a pixel
//! alone cannot tell its normal.

use crate::light::{Light, Polynomial};
use crate::view::Normals;

/// What surrounds the unknown normals: all slices have one length, one element for each pixel.
#[derive(Clone, Copy)]
pub struct ShadingProblem<'a> {
    /// log S of R, G, B; NaN leaves the pixel to its prior.
    pub log: [&'a [f32]; 3],
    /// The other view's normals in this frame, NaN where it sees nothing.
    pub prior: &'a Normals,
    /// The light, exposure included.
    pub light: &'a Light,
}

/// Weights of the terms against squared log-colour residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingWeights {
    /// lambda_2.
    pub prior: f32,
    /// lambda_3.
    pub unit: f32,
    /// |n - m| at which the prior has lost three quarters of its pull; `None` trusts it at any distance.
    pub robust: Option<f32>,
}

/// Why the pixels stopped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Terminations {
    /// The step fell below [`SMALLEST_STEP`].
    pub converged: usize,
    /// No step, however short, lowered the cost.
    pub stalled: usize,
    /// [`MOST_STEPS`] were not enough.
    pub capped: usize,
    /// Neither colour nor prior: no normal.
    pub skipped: usize,
}

/// Solver with its table of directions; holds no pixel.
#[derive(Clone, Debug)]
pub struct ShadingSolver {
    directions: Vec<[f32; 3]>,
    shades: Vec<[f32; 3]>,
}

/// Directions of the look over the hemisphere: 5 degrees apart, well inside the basin of the local solve.
const DIRECTIONS: usize = 600;
/// Flattest visible normal of the look: closer to the rim a pixel is not seen.
const RIM: f32 = -0.05;
/// Steps of one pixel in one solve; the paper allows 1000 and needs 300, Gauss-Newton needs about five.
const MOST_STEPS: usize = 30;
/// A step that short (in units of a unit normal, 0.0006 degrees) has arrived.
const SMALLEST_STEP: f32 = 1e-5;
/// First damping, relative to the diagonal.
const FIRST_DAMPING: f32 = 1e-3;
/// Damping beyond which no step is worth trying.
const LARGEST_DAMPING: f32 = 1e6;
/// Diagonal floor: a flat light must not make the system singular.
const FLOOR: f32 = 1e-9;

impl Default for ShadingSolver {
    fn default() -> Self {
        Self::new()
    }
}

impl ShadingSolver {
    /// A solver with its directions spread evenly (a Fibonacci spiral) over the visible hemisphere.
    #[must_use]
    pub fn new() -> Self {
        let golden = std::f32::consts::PI * (3.0 - 5.0_f32.sqrt());
        let directions: Vec<[f32; 3]> = (0..DIRECTIONS)
            .map(|index| {
                let z = RIM + (-1.0 - RIM) * (index as f32 + 0.5) / DIRECTIONS as f32;
                let radius = (1.0 - z * z).sqrt();
                let (sin, cos) = (golden * index as f32).sin_cos();
                [radius * cos, radius * sin, z]
            })
            .collect();
        let shades = vec![[0.0; 3]; directions.len()];
        Self { directions, shades }
    }

    /// Solves every pixel of `normals`, from its present value where it has one, else from the best of the hemisphere.
    pub fn solve(
        &mut self,
        problem: ShadingProblem<'_>,
        weights: ShadingWeights,
        normals: &mut Normals,
    ) -> Terminations {
        let polynomials = Polynomial::of(problem.light);
        for (shade, &direction) in self.shades.iter_mut().zip(&self.directions) {
            *shade = polynomials.map(|polynomial| polynomial.shade(direction));
        }
        let mut counts = Terminations::default();
        for index in 0..normals.len() {
            let pixel = Pixel::new(problem, index, weights, &polynomials);
            let Some(start) = self.start(&pixel, normals.get(index)) else {
                normals.set(index, [f32::NAN; 3]);
                counts.skipped += 1;
                continue;
            };
            let (normal, termination) = pixel.descend(start);
            match termination {
                Termination::Converged => counts.converged += 1,
                Termination::Stalled => counts.stalled += 1,
                Termination::Capped => counts.capped += 1,
            }
            normals.set(index, normalise(normal));
        }
        counts
    }

    /// The cheapest of the present normal, the prior and, where there is no present one, the hemisphere.
    fn start(&self, pixel: &Pixel<'_>, present: [f32; 3]) -> Option<[f32; 3]> {
        if pixel.log.is_none() {
            return pixel.prior.filter(|prior| prior[2] < 0.0);
        }
        let mut best = None;
        let mut least = f32::INFINITY;
        let mut offer = |normal: [f32; 3], cost: f32| {
            if cost < least {
                (best, least) = (Some(normal), cost);
            }
        };
        if present[2] < 0.0 {
            offer(present, pixel.cost(present));
        } else {
            for (&direction, &shade) in self.directions.iter().zip(&self.shades) {
                offer(direction, pixel.brightness(shade) + pixel.prior_cost(direction));
            }
        }
        if let Some(prior) = pixel.prior.filter(|prior| prior[2] < 0.0) {
            offer(prior, pixel.cost(prior));
        }
        best
    }
}

enum Termination {
    Converged,
    Stalled,
    Capped,
}

/// One pixel's terms.
pub(super) struct Pixel<'a> {
    log: Option<[f32; 3]>,
    prior: Option<[f32; 3]>,
    weights: ShadingWeights,
    polynomials: &'a [Polynomial; 3],
}

impl<'a> Pixel<'a> {
    pub(super) fn new(
        problem: ShadingProblem<'_>,
        index: usize,
        weights: ShadingWeights,
        polynomials: &'a [Polynomial; 3],
    ) -> Self {
        let log = [problem.log[0][index], problem.log[1][index], problem.log[2][index]];
        let log = log.iter().all(|value| value.is_finite()).then_some(log);
        let prior = problem.prior.is_valid(index).then(|| problem.prior.get(index));
        Self { log, prior, weights, polynomials }
    }

    fn brightness(&self, shade: [f32; 3]) -> f32 {
        self.log.map_or(0.0, |log| {
            let off = [log[0] - shade[0], log[1] - shade[1], log[2] - shade[2]];
            dot(off, off)
        })
    }

    /// log S minus prediction for each channel, `None` without a colour.
    pub(super) fn residuals(&self, normal: [f32; 3]) -> Option<[f32; 3]> {
        let log = self.log?;
        Some(std::array::from_fn(|channel| log[channel] - self.polynomials[channel].shade(normal)))
    }

    fn prior_cost(&self, normal: [f32; 3]) -> f32 {
        let Some(prior) = self.prior else { return 0.0 };
        let squared = squared_distance(normal, prior);
        let robust = match self.weights.robust {
            Some(scale) => squared / (1.0 + squared / (scale * scale)),
            None => squared,
        };
        self.weights.prior * robust
    }

    fn cost(&self, normal: [f32; 3]) -> f32 {
        let unit = dot(normal, normal) - 1.0;
        let [red, green, blue] = self.polynomials;
        self.brightness([red.shade(normal), green.shade(normal), blue.shade(normal)])
            + self.prior_cost(normal)
            + self.weights.unit * unit * unit
    }

    /// The cost around a normal.
    #[inline(never)]
    pub(super) fn linearise(&self, normal: [f32; 3]) -> Linear {
        let unit = dot(normal, normal) - 1.0;
        let mut sums = Linear { cost: self.weights.unit * unit * unit, gradient: [0.0; 3], matrix: [0.0; 6] };
        sums.add([2.0 * normal[0], 2.0 * normal[1], 2.0 * normal[2]], unit, self.weights.unit);
        if let Some(log) = self.log {
            for (polynomial, log) in self.polynomials.iter().zip(log) {
                let residual = polynomial.shade(normal) - log;
                sums.cost += residual * residual;
                sums.add(polynomial.gradient(normal), residual, 1.0);
            }
        }
        if let Some(prior) = self.prior {
            sums.cost += self.prior_cost(normal);
            let weight = self.weights.prior * self.prior_weight(squared_distance(normal, prior));
            for axis in 0..3 {
                sums.gradient[axis] += weight * (normal[axis] - prior[axis]);
            }
            for diagonal in [0, 3, 5] {
                sums.matrix[diagonal] += weight;
            }
        }
        sums
    }

    /// Derivative of rho: Geman-McClure's weight.
    fn prior_weight(&self, squared: f32) -> f32 {
        self.weights.robust.map_or(1.0, |scale| (1.0 + squared / (scale * scale)).powi(-2))
    }

    /// Damped Gauss-Newton; a step that turns the normal away from the camera counts as no descent.
    fn descend(&self, start: [f32; 3]) -> ([f32; 3], Termination) {
        let (mut normal, mut here) = (start, self.linearise(start));
        let mut damping = FIRST_DAMPING;
        for _ in 0..MOST_STEPS {
            loop {
                let step = solve_damped(here.matrix, here.gradient, damping);
                let trial = [normal[0] - step[0], normal[1] - step[1], normal[2] - step[2]];
                let length = dot(step, step).sqrt();
                let there = self.linearise(trial);
                if trial[2] < 0.0 && there.cost <= here.cost {
                    (normal, here) = (trial, there);
                    damping *= 0.1;
                    if length < SMALLEST_STEP {
                        return (normal, Termination::Converged);
                    }
                    break;
                }
                if length < SMALLEST_STEP {
                    // In f32 the last digits of the cost rise and fall; a step this short has arrived all the same.
                    return (normal, Termination::Converged);
                }
                damping *= 10.0;
                if damping > LARGEST_DAMPING || !there.cost.is_finite() && !length.is_finite() {
                    return (normal, Termination::Stalled);
                }
            }
        }
        (normal, Termination::Capped)
    }
}

/// A cost around a normal: its value, half its gradient, and the Gauss-Newton matrix (xx, xy, xz, yy, yz, zz).
pub(super) struct Linear {
    cost: f32,
    pub(super) gradient: [f32; 3],
    pub(super) matrix: [f32; 6],
}

impl Linear {
    /// One residual of derivative `row`.
    #[inline(always)]
    fn add(&mut self, [x, y, z]: [f32; 3], residual: f32, weight: f32) {
        let pull = weight * residual;
        let (by_x, by_y, by_z) = (weight * x, weight * y, weight * z);
        let gradient = [pull * x, pull * y, pull * z];
        let matrix = [by_x * x, by_x * y, by_x * z, by_y * y, by_y * z, by_z * z];
        for axis in 0..3 {
            self.gradient[axis] += gradient[axis];
        }
        for entry in 0..6 {
            self.matrix[entry] += matrix[entry];
        }
    }
}

/// Solves (A + damping diag A) x = b for a symmetric 3x3 matrix by cofactors.
fn solve_damped(matrix: [f32; 6], right: [f32; 3], damping: f32) -> [f32; 3] {
    let grow = |value: f32| value * (1.0 + damping) + FLOOR;
    let [xx, xy, xz, yy, yz, zz] = matrix;
    let (xx, yy, zz) = (grow(xx), grow(yy), grow(zz));
    let cofactors = [yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy];
    let determinant = xx * cofactors[0] + xy * cofactors[1] + xz * cofactors[2];
    let inverse = 1.0 / determinant;
    let (yy_inverse, yz_inverse, zz_inverse) = (xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy);
    [
        inverse * (cofactors[0] * right[0] + cofactors[1] * right[1] + cofactors[2] * right[2]),
        inverse * (cofactors[1] * right[0] + yy_inverse * right[1] + yz_inverse * right[2]),
        inverse * (cofactors[2] * right[0] + yz_inverse * right[1] + zz_inverse * right[2]),
    ]
}

fn dot(a: [f32; 3], b: [f32; 3]) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn squared_distance(a: [f32; 3], b: [f32; 3]) -> f32 {
    let off = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    dot(off, off)
}

fn normalise(vector: [f32; 3]) -> [f32; 3] {
    let inverse = 1.0 / dot(vector, vector).sqrt();
    vector.map(|value| value * inverse)
}

#[cfg(test)]
mod tests {
    use super::*;

    const WEIGHTS: ShadingWeights = ShadingWeights { prior: 0.05, unit: 1.0, robust: None };

    fn colourful() -> Light {
        Light([
            [-1.2, 0.1, -0.9, 0.7, 0.1, 0.2, 0.15, -0.2, -0.1],
            [-1.1, 0.8, -0.7, -0.3, -0.2, -0.15, -0.1, -0.1, 0.2],
            [-1.3, -0.6, -0.8, -0.5, 0.15, -0.1, 0.1, 0.25, 0.1],
        ])
    }

    /// Normals over the hemisphere off the solver's own directions, and their colours.
    fn sphere(light: &Light) -> (Normals, [Vec<f32>; 3]) {
        let count = 500;
        let mut normals = Normals::missing(count);
        let mut log = [(); 3].map(|()| vec![0.0; count]);
        for index in 0..count {
            let z = -0.15 - 0.84 * (index as f32 + 0.5) / count as f32;
            let (sin, cos) = (1.7 * index as f32).sin_cos();
            let radius = (1.0 - z * z).sqrt();
            let normal = [radius * cos, radius * sin, z];
            normals.set(index, normal);
            for (channel, shade) in light.shade(normal.map(f64::from)).into_iter().enumerate() {
                log[channel][index] = shade as f32;
            }
        }
        (normals, log)
    }

    fn degrees(a: &Normals, b: &Normals) -> Vec<f32> {
        (0..a.len()).map(|i| squared_distance(a.get(i), b.get(i)).sqrt().to_degrees()).collect()
    }

    #[test]
    fn a_colourful_light_gives_every_normal_without_a_prior() {
        let light = colourful();
        let (truth, log) = sphere(&light);
        let mut found = Normals::missing(truth.len());
        let prior = Normals::missing(truth.len());
        let problem = ShadingProblem { log: [&log[0], &log[1], &log[2]], prior: &prior, light: &light };
        let counts = ShadingSolver::new().solve(problem, WEIGHTS, &mut found);
        let worst = degrees(&found, &truth).into_iter().fold(0.0, f32::max);
        assert!(worst < 0.1, "worst {worst} degrees, {counts:?}");
        assert_eq!(counts.converged, truth.len());
    }

    #[test]
    fn a_wrong_prior_drags_a_pixel_and_a_robust_one_does_not() {
        let light = colourful();
        let (truth, log) = sphere(&light);
        let mut prior = truth.clone();
        for index in 0..prior.len() {
            let [x, y, z] = prior.get(index);
            prior.set(index, [-x, -y, z]);
        }
        let problem = ShadingProblem { log: [&log[0], &log[1], &log[2]], prior: &prior, light: &light };
        let mean = |robust| {
            let mut found = Normals::missing(truth.len());
            ShadingSolver::new().solve(problem, ShadingWeights { robust, ..WEIGHTS }, &mut found);
            degrees(&found, &truth).iter().sum::<f32>() / truth.len() as f32
        };
        let (plain, robust) = (mean(None), mean(Some(0.2)));
        assert!(robust < 0.3 * plain, "plain {plain}, robust {robust}");
    }

    #[test]
    fn a_pixel_without_colour_takes_its_prior_and_one_without_either_has_no_normal() {
        let light = colourful();
        let mut prior = Normals::missing(2);
        prior.set(0, [0.0, 0.6, -0.8]);
        let log = [f32::NAN; 2];
        let mut found = Normals::missing(2);
        let problem = ShadingProblem { log: [&log; 3], prior: &prior, light: &light };
        let counts = ShadingSolver::new().solve(problem, WEIGHTS, &mut found);
        assert!(squared_distance(found.get(0), [0.0, 0.6, -0.8]) < 1e-8 && !found.is_valid(1));
        assert_eq!(counts.skipped, 1);
    }
}
