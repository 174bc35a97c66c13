//! Shape from shading with a shape prior, one normal for each pixel (Eq. 6 to 9; docs/method/normals.md).
//!
//! For each pixel: min over n of
//! sum_j (log S_j - [n;1]^T M_j [n;1])^2 + lambda_2 rho(|n - m|^2) + lambda_3 (n^T n - 1)^2,
//! where m is the other view's normal there, and rho(u) is u, or u / (1 + u / s^2) of Geman and McClure with scale s. The paper writes the two prior
//! terms without a square and lambda_3 linear; a least-squares solver squares them, as this one does.
//!
//! Three colours give up to eight solutions. A pixel without a normal therefore first compares directions over the whole
//! visible hemisphere. Every pixel then descends by damped Gauss-Newton, [`LANES`] pixels side by side. The same code refines the depth
//! view (Eq. 17, 18): its normals, rotated into the colour view's frame, are pixels like any other. Limits: normals
//! have n_z < 0, and under a light of a single chromaticity, the colours of a pixel do not determine its normal.

use crate::light::{Light, Polynomial};
use crate::numeric::{LANES, Lanes, Mask, Real, dot, robust};
use crate::view::Normals;

/// The data for the unknown normals: all slices have one length, with one element for each pixel.
#[derive(Clone, Copy)]
pub struct ShadingProblem<'a> {
    /// log S of R, G, B; a pixel with NaN depends only on its prior.
    pub log: [&'a [f32]; 3],
    /// The other view's normals in this frame, NaN where it has none.
    pub prior: &'a Normals,
    /// The light, with exposure.
    pub light: &'a Light,
}

/// Weights of the terms relative to squared log-colour residuals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShadingWeights {
    /// lambda_2.
    pub prior: f32,
    /// lambda_3.
    pub unit: f32,
    /// Scale of rho: the distance |n - m| at which the prior keeps a quarter of its weight; `None` for the identity.
    pub robust: Option<f32>,
}

/// Scale of rho, 23 degrees: more than the noise of normals, and less than the error of a wrong correspondence.
const PRIOR_SCALE: f32 = 0.4;

impl ShadingWeights {
    /// Weights with a robust prior. A prior normal that is far away, such as that of a wrong correspondence, loses its
    /// weight.
    #[must_use]
    pub const fn with_robust_prior(prior: f32, unit: f32) -> Self {
        Self { prior, unit, robust: Some(PRIOR_SCALE) }
    }
}

/// Number of pixels by the reason for which the solver ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadingReport {
    /// The step fell below `SMALLEST_STEP`.
    pub converged: usize,
    /// No step, however short, lowered the objective.
    pub stalled: usize,
    /// `MOST_DESCENT_STEPS` were not enough.
    pub capped: usize,
    /// The pixel has neither a colour nor a prior, so it gets no normal.
    pub skipped: usize,
}

/// Solver with its table of directions; holds no pixels.
#[derive(Clone, Debug)]
pub struct ShadingSolver {
    pub(crate) directions: Vec<[f32; 3]>,
    shades: Vec<[f32; 3]>,
}

/// Number of directions on the hemisphere that are compared: 5 degrees apart, well within the basin of the local solve.
const DIRECTIONS: usize = 600;
/// n_z of the steepest direction. Closer to the edge of the hemisphere, a surface is too steep to be seen in a pixel.
pub(crate) const STEEPEST_N_Z: f32 = -0.05;
/// Largest number of trials of one pixel in one solve. The paper allows 1000 and needs 300; Gauss-Newton needs about
/// five.
pub(crate) const MOST_DESCENT_STEPS: usize = 30;
/// Length of a step (in units of a unit normal, 0.06 degrees) below which it is the last one. It is taken, and leaves
/// an error of at most a tenth of its length, a hundredth of the best normals' error.
const SMALLEST_STEP: f32 = 1e-3;
/// First damping, relative to the diagonal.
const FIRST_DAMPING: f32 = 1e-3;
/// Damping beyond which no step is tried.
const LARGEST_DAMPING: f32 = 1e6;
/// Number that is added to the diagonal, in squared log residuals per squared unit of a normal, so that a flat light
/// does not make the system singular.
const LEAST_DIAGONAL: f32 = 1e-9;

impl Default for ShadingSolver {
    fn default() -> Self {
        Self::new()
    }
}

impl ShadingSolver {
    /// A solver with its directions spread evenly (a Fibonacci spiral) over the visible hemisphere.
    #[must_use]
    pub fn new() -> Self {
        let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
        let steepest = f64::from(STEEPEST_N_Z);
        let directions: Vec<[f32; 3]> = (0..DIRECTIONS)
            .map(|index| {
                let z = steepest + (-1.0 - steepest) * (index as f64 + 0.5) / DIRECTIONS as f64;
                let radius = (1.0 - z * z).sqrt();
                let (sin, cos) = (golden * index as f64).sin_cos();
                [radius * cos, radius * sin, z].map(|value| value as f32)
            })
            .collect();
        let shades = vec![[0.0; 3]; directions.len()];
        Self { directions, shades }
    }

    /// Solves every pixel of `normals`, from its current value if it has one, else from the best direction of the
    /// hemisphere.
    pub fn solve(
        &mut self,
        problem: ShadingProblem<'_>,
        weights: ShadingWeights,
        normals: &mut Normals,
    ) -> ShadingReport {
        let polynomials = Polynomial::of(problem.light);
        for (shade, &direction) in self.shades.iter_mut().zip(&self.directions) {
            *shade = polynomials.map(|polynomial| polynomial.shade(direction));
        }
        let mut counts = ShadingReport::default();
        for index in (0..normals.len()).step_by(LANES) {
            let missing = Lanes::splat(f32::NAN);
            let mut solved = [missing; 3];
            // Empty blocks are skipped, because most blocks of a raster lie off the object.
            let start = index as isize;
            let (red, prior) = (Lanes::load(problem.log[0], start), Lanes::load(&problem.prior.z, start));
            if (red.finite() | prior.finite()).any() {
                let pixels = Pixels::new(problem, index, weights, &polynomials);
                let (start, here, known) = self.start(&pixels, normals.lanes(index));
                solved = known
                    .select3(normalise(pixels.descend(start, here, known, MOST_DESCENT_STEPS, &mut counts)), solved);
            }
            solved[0].store(&mut normals.x[index..]);
            solved[1].store(&mut normals.y[index..]);
            solved[2].store(&mut normals.z[index..]);
        }
        counts.skipped = normals.len() - counts.converged - counts.stalled - counts.capped;
        counts
    }

    /// The best of the current normal, the prior and, without a current normal, the hemisphere; the objective around
    /// it; and which pixels have one.
    fn start(&self, pixels: &Pixels<'_>, present: [Lanes; 3]) -> ([Lanes; 3], LinearisedPixels, Mask) {
        let (zero, far) = (Lanes::splat(0.0), Lanes::splat(f32::INFINITY));
        let facing = present[2].less(zero);
        let here = pixels.linearise(present);
        let (mut best, mut least) = (present, facing.select(here.objective, far));
        let unknown = !facing & pixels.has_colour;
        if unknown.any() {
            for (&direction, &shade) in self.directions.iter().zip(&self.shades) {
                let [direction, shade] = [splat(direction), splat(shade)];
                let objective = pixels.brightness_term(shade) + pixels.prior_term(direction);
                let better = unknown & objective.less(least);
                (best, least) = (better.select3(direction, best), better.select(objective, least));
            }
        }
        let has_prior = pixels.has_prior & pixels.prior[2].less(zero);
        let objective = pixels.objective(pixels.prior);
        let better = has_prior & objective.less(least);
        (best, least) = (better.select3(pixels.prior, best), better.select(objective, least));
        let known = (pixels.has_colour | has_prior) & least.less(far);
        let here = if (unknown | better).any() { pixels.linearise(best) } else { here };
        (best, here, known)
    }
}

/// The terms of [`LANES`] pixels. Missing values are zero and have no weight.
pub(crate) struct Pixels<'a> {
    log: [Lanes; 3],
    prior: [Lanes; 3],
    pub(super) has_colour: Mask,
    has_prior: Mask,
    /// Weight of the colours, one for a pixel with a colour; the next field is lambda_2 for a pixel with a prior.
    colour_weight: Lanes,
    prior_weight: Lanes,
    unit_weight: Lanes,
    /// 1 / scale^2 of rho; zero for the identity.
    inverse_square_scale: Lanes,
    polynomials: &'a [Polynomial; 3],
}

impl<'a> Pixels<'a> {
    pub(crate) fn new(
        problem: ShadingProblem<'_>,
        index: usize,
        weights: ShadingWeights,
        polynomials: &'a [Polynomial; 3],
    ) -> Self {
        let [red, green, blue] = problem.log;
        let start = index as isize;
        let log = [Lanes::load(red, start), Lanes::load(green, start), Lanes::load(blue, start)];
        let has_colour = log[0].finite() & log[1].finite() & log[2].finite();
        let prior = problem.prior.lanes(index);
        let has_prior = prior[2].finite();
        let zero = Lanes::splat(0.0);
        Self {
            log: has_colour.select3(log, [zero; 3]),
            prior: has_prior.select3(prior, [zero; 3]),
            has_colour,
            has_prior,
            colour_weight: has_colour.select(Lanes::splat(1.0), zero),
            prior_weight: has_prior.select(Lanes::splat(weights.prior), zero),
            unit_weight: Lanes::splat(weights.unit),
            inverse_square_scale: Lanes::splat(weights.robust.map_or(0.0, |scale| 1.0 / (scale * scale))),
            polynomials,
        }
    }

    fn brightness_term(&self, shade: [Lanes; 3]) -> Lanes {
        self.colour_weight * squared_distance(shade, self.log)
    }

    /// Prediction minus log S for each channel.
    pub(super) fn residuals(&self, normal: [Lanes; 3]) -> [Lanes; 3] {
        let [red, green, blue] = self.polynomials;
        [red.shade(normal) - self.log[0], green.shade(normal) - self.log[1], blue.shade(normal) - self.log[2]]
    }

    fn prior_term(&self, normal: [Lanes; 3]) -> Lanes {
        let squared = squared_distance(normal, self.prior);
        robust::rho(self.prior_weight * squared, squared * self.inverse_square_scale)
    }

    pub(crate) fn objective(&self, normal: [Lanes; 3]) -> Lanes {
        let unit = dot(normal, normal) - Lanes::splat(1.0);
        let residuals = self.residuals(normal);
        self.colour_weight * dot(residuals, residuals) + self.prior_term(normal) + self.unit_weight * unit * unit
    }

    /// Linearises the objective around a normal.
    #[inline(never)]
    pub(crate) fn linearise(&self, normal: [Lanes; 3]) -> LinearisedPixels {
        let (zero, one, two) = (Lanes::splat(0.0), Lanes::splat(1.0), Lanes::splat(2.0));
        let mut sums = LinearisedPixels { objective: zero, gradient: [zero; 3], matrix: [zero; 6] };
        let unit = dot(normal, normal) - one;
        sums.add([two * normal[0], two * normal[1], two * normal[2]], unit, self.unit_weight);
        for (polynomial, log) in self.polynomials.iter().zip(self.log) {
            let (shade, slope) = polynomial.expand(normal);
            sums.add(slope, shade - log, self.colour_weight);
        }
        let squared = squared_distance(normal, self.prior);
        let attenuation = robust::attenuation(squared * self.inverse_square_scale);
        sums.objective = sums.objective + self.prior_weight * squared * attenuation;
        let weight = self.prior_weight * attenuation * attenuation;
        let [x, y, z] = sums.gradient;
        let off = [normal[0] - self.prior[0], normal[1] - self.prior[1], normal[2] - self.prior[2]];
        sums.gradient = [x + weight * off[0], y + weight * off[1], z + weight * off[2]];
        let [xx, xy, xz, yy, yz, zz] = sums.matrix;
        sums.matrix = [xx + weight, xy, xz, yy + weight, yz, zz + weight];
        sums
    }

    /// Damped Gauss-Newton; a step to a normal that faces away from the camera is rejected. The loop runs until the
    /// last of the [`LANES`] pixels has ended; the others keep their normals.
    #[inline(never)]
    pub(crate) fn descend(
        &self,
        start: [Lanes; 3],
        mut here: LinearisedPixels,
        known: Mask,
        most_steps: usize,
        counts: &mut ShadingReport,
    ) -> [Lanes; 3] {
        let (zero, tenth, ten) = (Lanes::splat(0.0), Lanes::splat(0.1), Lanes::splat(10.0));
        let shortest = Lanes::splat(SMALLEST_STEP * SMALLEST_STEP);
        let mut normal = start;
        let mut damping = Lanes::splat(FIRST_DAMPING);
        let mut moving = known;
        for _ in 0..most_steps {
            let step = solve_damped(&here, damping);
            let trial = [normal[0] - step[0], normal[1] - step[1], normal[2] - step[2]];
            let converged = moving & dot(step, step).less(shortest);
            counts.converged += converged.count();
            let facing = trial[2].less(zero);
            // The last step is not compared, because the last digits of an objective in f32 are noise.
            normal = (converged & facing).select3(trial, normal);
            moving = moving & !converged;
            if !moving.any() {
                return normal;
            }
            let there = self.linearise(trial);
            let better = moving & facing & there.objective.at_most(here.objective);
            normal = better.select3(trial, normal);
            here.replace(better, &there);
            damping = damping * better.select(tenth, ten);
            let stalled = moving & !damping.less(Lanes::splat(LARGEST_DAMPING));
            counts.stalled += stalled.count();
            moving = moving & !stalled;
        }
        counts.capped += moving.count();
        normal
    }
}

/// The objective of four pixels around their normals: its value, half its gradient, and the Gauss-Newton matrix (xx,
/// xy, xz, yy, yz, zz).
pub(crate) struct LinearisedPixels {
    objective: Lanes,
    pub(super) gradient: [Lanes; 3],
    pub(super) matrix: [Lanes; 6],
}

impl LinearisedPixels {
    /// Adds one residual with its derivatives by the normal.
    #[inline(always)]
    fn add(&mut self, [x, y, z]: [Lanes; 3], residual: Lanes, weight: Lanes) {
        let (weighted, by_x, by_y, by_z) = (weight * residual, weight * x, weight * y, weight * z);
        self.objective = self.objective + weighted * residual;
        let [gx, gy, gz] = self.gradient;
        self.gradient = [gx + weighted * x, gy + weighted * y, gz + weighted * z];
        let [xx, xy, xz, yy, yz, zz] = self.matrix;
        self.matrix = [xx + by_x * x, xy + by_x * y, xz + by_x * z, yy + by_y * y, yz + by_y * z, zz + by_z * z];
    }

    #[inline(always)]
    fn replace(&mut self, chosen: Mask, other: &Self) {
        self.objective = chosen.select(other.objective, self.objective);
        self.gradient = chosen.select3(other.gradient, self.gradient);
        for (entry, other) in self.matrix.iter_mut().zip(other.matrix) {
            *entry = chosen.select(other, *entry);
        }
    }
}

/// Solves (A + damping diag A) x = b for a symmetric 3x3 matrix by cofactors.
#[inline(always)]
fn solve_damped(linear: &LinearisedPixels, damping: Lanes) -> [Lanes; 3] {
    let LinearisedPixels { matrix: [xx, xy, xz, yy, yz, zz], gradient: right, .. } = *linear;
    let (growth, least) = (Lanes::splat(1.0) + damping, Lanes::splat(LEAST_DIAGONAL));
    let (xx, yy, zz) = (xx * growth + least, yy * growth + least, zz * growth + least);
    let cofactors = [yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy];
    let determinant = xx * cofactors[0] + xy * cofactors[1] + xz * cofactors[2];
    let inverse = Lanes::splat(1.0) / determinant;
    let (yy_inverse, yz_inverse, zz_inverse) = (xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy);
    [
        inverse * (cofactors[0] * right[0] + cofactors[1] * right[1] + cofactors[2] * right[2]),
        inverse * (cofactors[1] * right[0] + yy_inverse * right[1] + yz_inverse * right[2]),
        inverse * (cofactors[2] * right[0] + yz_inverse * right[1] + zz_inverse * right[2]),
    ]
}

#[inline(always)]
fn splat([x, y, z]: [f32; 3]) -> [Lanes; 3] {
    [Lanes::splat(x), Lanes::splat(y), Lanes::splat(z)]
}

#[inline(always)]
fn squared_distance(a: [Lanes; 3], b: [Lanes; 3]) -> Lanes {
    let off = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    dot(off, off)
}

pub(crate) fn normalise(vector: [Lanes; 3]) -> [Lanes; 3] {
    let inverse = Lanes::splat(1.0) / dot(vector, vector).sqrt();
    [vector[0] * inverse, vector[1] * inverse, vector[2] * inverse]
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

    /// Normals over the hemisphere between the solver's own directions, and their colours.
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

    fn apart(a: [f32; 3], b: [f32; 3]) -> f32 {
        (0..3).map(|axis| (a[axis] - b[axis]).powi(2)).sum::<f32>().sqrt()
    }

    fn degrees(a: &Normals, b: &Normals) -> Vec<f32> {
        (0..a.len()).map(|i| apart(a.get(i), b.get(i)).to_degrees()).collect()
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
        assert!(apart(found.get(0), [0.0, 0.6, -0.8]) < 1e-4 && !found.is_valid(1));
        assert_eq!(counts.skipped, 1);
    }
}
