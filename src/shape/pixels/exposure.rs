//! The exposure of a known light (docs/method/image-model.md).
//!
//! A light is known only up to the exposure of the camera: log S = c + [n;1]^T M [n;1] with one c for all pixels. The
//! first c comes only from the colours. The colours of the hemisphere form a surface in log RGB, and c shifts the
//! image's colours onto it. Each solve of the normals then improves c by variable projection. The normals follow c, so
//! dF/dc = -2 sum r and d2F/dc2 = 2 sum (3 - 1^T J H^-1 J^T 1), where F is the objective and H the pixel's own
//! Gauss-Newton matrix. Under a light of a single chromaticity that surface is a line along c itself, and only the
//! prior determines c.

use nalgebra::{Matrix3, Vector3};

use super::shading::{LinearisedPixels, Pixels, ShadingProblem, ShadingWeights};
use crate::light::{Light, Polynomial};
use crate::numeric::{LANES, Lanes, Real, quantile, robust};
use crate::view::Normals;

/// Largest number of pixels, and number of directions on the hemisphere, for the first exposure. They suffice for two
/// digits.
const MOST_PIXELS: usize = 400;
const DIRECTIONS: usize = 300;
/// The first exposure is the best one of a grid around equal medians: the distance of its points, log units, and the
/// number of points on either side. A parabola then reduces the error to a fifth of that distance.
const GRID_STEP: f64 = 0.05;
const GRID_STEPS: i32 = 60;
/// Robust scale of the grid's objective in log units.
const GRID_SCALE: f64 = 0.1;
/// Weight of the squared distance from equal medians, relative to an objective of at most one. It decides only where
/// the colours do not.
const GRID_PRIOR: f64 = 1e-3;
/// Longest step in log units; the first exposure is nearer than that.
const LONGEST_STEP: f64 = 0.2;
/// Robust scale of a step: the residual, log units, at which a pixel keeps a quarter of its weight.
const STEP_SCALE: f32 = 0.1;
/// Weight of a term that holds the exposure near the first one, for each pixel, in squared log residuals. A light of
/// almost a single chromaticity leaves the exposure almost free, and this weight limits its steps.
const STEP_PRIOR: f64 = 1e-3;

/// The offset of log S that shifts the image's colours onto those of the light.
///
/// `log` holds R, G, B, with NaN off the mask; an empty image gives zero.
#[must_use]
pub fn first_exposure(light: &Light, log: [&[f32]; 3]) -> f64 {
    let usable: Vec<usize> = (0..log[0].len()).filter(|&index| !log[0][index].is_nan()).collect();
    if usable.is_empty() {
        return 0.0;
    }
    let stride = usable.len().div_ceil(MOST_PIXELS);
    let colours: Vec<[f64; 3]> =
        usable.iter().step_by(stride).map(|&index| [0, 1, 2].map(|c: usize| f64::from(log[c][index]))).collect();
    let shades = projected_hemisphere(light);
    let centre = median_of_means(&colours) - median_of_means(&shades);
    let objective = |step: f64| {
        let offset = centre + step * GRID_STEP;
        let misfit: f64 = colours.iter().map(|colour| misfit(*colour, offset, &shades)).sum();
        misfit / colours.len() as f64 + GRID_PRIOR * (step * GRID_STEP).powi(2)
    };
    let grid: Vec<f64> = (-GRID_STEPS..=GRID_STEPS).map(|step| objective(f64::from(step))).collect();
    let best = (0..grid.len()).min_by(|&a, &b| grid[a].total_cmp(&grid[b])).unwrap_or(0);
    centre + GRID_STEP * (best as f64 - f64::from(GRID_STEPS) + vertex(&grid, best))
}

/// Minimum of the parabola through a value and its neighbours, in steps from that value; zero at the ends.
fn vertex(grid: &[f64], best: usize) -> f64 {
    if best == 0 || best + 1 >= grid.len() {
        return 0.0;
    }
    let (before, at, after) = (grid[best - 1], grid[best], grid[best + 1]);
    let curvature = before - 2.0 * at + after;
    if curvature > 0.0 { 0.5 * (before - after) / curvature } else { 0.0 }
}

/// Colours of directions over the visible hemisphere, spread as on the image of a sphere: evenly over the disc.
fn projected_hemisphere(light: &Light) -> Vec<[f64; 3]> {
    let golden = std::f64::consts::PI * (3.0 - 5.0_f64.sqrt());
    (0..DIRECTIONS)
        .map(|index| {
            let radius = ((index as f64 + 0.5) / DIRECTIONS as f64).sqrt();
            let (sin, cos) = (golden * index as f64).sin_cos();
            light.shade([radius * cos, radius * sin, -(1.0 - radius * radius).sqrt()])
        })
        .collect()
}

fn median_of_means(colours: &[[f64; 3]]) -> f64 {
    let mut means: Vec<f32> = colours.iter().map(|colour| (colour.iter().sum::<f64>() / 3.0) as f32).collect();
    f64::from(quantile(&mut means, 0.5))
}

/// Robust squared distance of a colour from the nearest one of the hemisphere, between zero and one.
fn misfit(colour: [f64; 3], offset: f64, shades: &[[f64; 3]]) -> f64 {
    let squared = |shade: &[f64; 3]| (0..3).map(|c| (colour[c] - offset - shade[c]).powi(2)).sum::<f64>();
    let nearest = shades.iter().map(squared).fold(f64::INFINITY, f64::min) / (GRID_SCALE * GRID_SCALE);
    robust::saturated(nearest)
}

/// The change of the exposure after a solve of `normals`; `moved` is its distance from the first exposure.
#[must_use]
pub fn exposure_step(problem: ShadingProblem<'_>, weights: ShadingWeights, normals: &Normals, moved: f64) -> f64 {
    let polynomials = Polynomial::of(problem.light);
    let (mut slope, mut curvature, mut count) = (0.0, 0.0, 0.0);
    for first in (0..normals.len()).step_by(LANES) {
        let pixels = Pixels::new(problem, first, weights, &polynomials);
        let four = normals.lanes(first);
        let residuals = pixels.residuals(four).map(Lanes::array);
        let LinearisedPixels { gradient, matrix, .. } = pixels.linearise(four);
        let (gradient, matrix) = (gradient.map(Lanes::array), matrix.map(Lanes::array));
        let usable = (pixels.has_colour & four[2].finite()).select(Lanes::splat(1.0), Lanes::splat(0.0)).array();
        for lane in (0..LANES).filter(|&lane| usable[lane] > 0.0) {
            let residuals = residuals.map(|four| four[lane]);
            let squared: f32 = residuals.iter().map(|residual| residual * residual).sum();
            // As `robust::weight`, with one rounding less.
            let weight = f64::from(robust::weight_of_square(squared / (STEP_SCALE * STEP_SCALE)));
            let [xx, xy, xz, yy, yz, zz] = matrix.map(|four| f64::from(four[lane]));
            let gradient = Vector3::from(gradient.map(|four| f64::from(four[lane])));
            let normal = normals.get(first + lane);
            // J^T 1, the derivative of the channels' sum by the normal.
            let derivative = polynomials.iter().fold(Vector3::zeros(), |sum, polynomial| {
                sum + Vector3::from(polynomial.gradient(normal)).map(f64::from)
            });
            let Some(inverse) = Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz).try_inverse() else { continue };
            // The gradient is zero if the normal's own solve ended at a minimum. Near an occluding contour the solve
            // ends at the border of the visible hemisphere.
            let remaining = derivative.dot(&(inverse * gradient));
            slope += weight * (remaining - f64::from(residuals.iter().sum::<f32>()));
            curvature += weight * (3.0 - (derivative.transpose() * inverse * derivative)[0]).max(0.0);
            count += weight;
        }
    }
    if count == 0.0 {
        return 0.0;
    }
    ((slope - STEP_PRIOR * count * moved) / (curvature + STEP_PRIOR * count)).clamp(-LONGEST_STEP, LONGEST_STEP)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::LightPrior;
    use crate::shape::pixels::ShadingSolver;

    fn colours(light: &Light, offset: f64) -> (Normals, [Vec<f32>; 3]) {
        let count = 400;
        let mut normals = Normals::missing(count);
        let mut log = [(); 3].map(|()| vec![0.0; count]);
        for index in 0..count {
            let radius = 0.9 * ((index as f64 + 0.5) / count as f64).sqrt();
            let (sin, cos) = (1.3 * index as f64).sin_cos();
            let normal = [radius * cos, radius * sin, -(1.0 - radius * radius).sqrt()];
            normals.set(index, normal.map(|v| v as f32));
            for (channel, shade) in light.shade(normal).into_iter().enumerate() {
                log[channel][index] = (shade + offset) as f32;
            }
        }
        (normals, log)
    }

    #[test]
    fn the_exposure_of_a_colourful_light_is_found_to_the_last_digits() {
        let light = Light([
            [-1.2, 0.1, -0.9, 0.7, 0.1, 0.2, 0.15, -0.2, -0.1],
            [-1.1, 0.8, -0.7, -0.3, -0.2, -0.15, -0.1, -0.1, 0.2],
            [-1.3, -0.6, -0.8, -0.5, 0.15, -0.1, 0.1, 0.25, 0.1],
        ]);
        let weights = ShadingWeights { prior: 0.0, unit: 1.0, robust: None };
        for truth in [-2.3, 0.0, 1.9] {
            let (_, log) = colours(&light, truth);
            let log = [&log[0][..], &log[1], &log[2]];
            let first = first_exposure(&light, log);
            let mut exposure = first;
            assert!((exposure - truth).abs() < 0.1, "first exposure {exposure} for {truth}");
            let prior = Normals::missing(log[0].len());
            let mut normals = prior.clone();
            for _ in 0..6 {
                let exposed = light.exposed(exposure);
                let problem = ShadingProblem { log, prior: &prior, light: &exposed };
                ShadingSolver::new().solve(problem, weights, &mut normals);
                exposure += exposure_step(problem, weights, &normals, exposure - first);
            }
            assert!((exposure - truth).abs() < 2e-3, "ended at {exposure} for {truth}");
        }
    }

    #[test]
    fn a_light_of_one_hue_says_nothing_without_a_prior() {
        let mut light = LightPrior::natural().mean();
        light.0 = [light.0[0]; 3];
        let (normals, log) = colours(&light, 0.5);
        let none = Normals::missing(normals.len());
        let exposed = light.exposed(0.5);
        let problem = ShadingProblem { log: [&log[0], &log[1], &log[2]], prior: &none, light: &exposed };
        let weights = ShadingWeights { prior: 0.0, unit: 1.0, robust: None };
        let step = exposure_step(problem, weights, &normals, 0.0);
        assert!(step.abs() < 1e-3, "exact normals leave nothing to change, not {step}");
    }
}
