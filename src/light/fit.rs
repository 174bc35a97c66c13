//! Fits the light to normals and colours (Eq. 2; docs/method/image-model.md).
//!
//! Given normals, log S is linear in the light. The fit minimises mean_i w_i |log S_i - B(n_i) L|^2 + lambda_L h(L)
//! over L, where B holds the nine harmonics of each channel. The weights w are those of Geman and McClure with a scale
//! proportional to the median residual, so that cast shadows and wrong correspondences weigh little.

use std::ops::Range;

use crate::error::{Error, ErrorKind, Result};
use crate::light::harmonics::{HARMONICS, basis};
use crate::light::prior::{CoefficientMatrix, Coefficients, LightPrior};
use crate::light::{Light, Polynomial};
use crate::numeric::{LANES, Lanes, Real, dot, quantile, robust, thin};
use crate::view::Normals;

/// Maximum number of reweighting rounds; the weights settle in four to six (data not recorded).
const ROUNDS: usize = 8;
/// Relative change of the median residual below which the weights have settled. Their scale follows that median.
const SETTLED: f64 = 0.01;
/// Maximum number of pixels in the fit, evenly spread. There are 27 unknowns and three equations from each pixel, so
/// noise averages out with far fewer; an object that fills just under half of 128x128 is used whole.
const MOST_PIXELS: usize = 8000;
/// The robust scale in median residuals: 4.6 standard deviations of a channel under normal noise. Larger residuals keep
/// less than a quarter of their weight.
const SCALE_OF_MEDIAN: f64 = 3.0;
/// Smallest robust scale in log units, the noise of a good 8-bit image. Exact colours would make the scale zero.
pub(super) const SMALLEST_SCALE: f64 = 0.005;
/// Number of pixels whose terms are summed in f32 before the sum is added to one in f64, small enough to keep six
/// digits.
const SUMMANDS: usize = 256;
/// Maximum number of times the prior's weight is raised tenfold until the equations of the light can be solved. Sums in
/// f32 are off by up to a millionth, and on nearly flat relief a weak prior contributes less than that.
const MOST_RAISES: i32 = 10;
/// Number of products that are summed for each harmonic: those with the nine harmonics, then those with R, G, B.
const COLUMNS: usize = HARMONICS + 3;

/// A fitted light and how well it fits the image.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightFit {
    /// The light.
    pub light: Light,
    /// Median of |log S - predicted| over the pixels, in log units.
    pub residual: f64,
}

/// Fits lights; reuses the memory of its samples and weights.
#[derive(Clone, Debug, Default)]
pub struct LightFitter {
    pixels: Vec<usize>,
    /// Normals of these pixels, padded to whole [`LANES`] with pixels of weight zero.
    normals: Normals,
    /// log S minus `offset`.
    colours: [Vec<f32>; 3],
    /// Mean of log S, subtracted so that f32 keeps more digits of the rest. It changes only the exposure, which the
    /// prior does not see.
    offset: f64,
    weights: Vec<f32>,
    /// A value for each pixel, without the padding.
    residuals: Vec<f32>,
    sorted: Vec<f32>,
}

impl LightFitter {
    /// Fits 27 coefficients to the pixels that have a normal and a colour.
    ///
    /// `normals` in the colour view's frame and `log` (R, G, B) have the same length; NaN marks missing values.
    /// `weight` is lambda_L relative to the mean squared log residual. Allocates only if there are more pixels than in
    /// every earlier fit.
    ///
    /// # Errors
    /// [`ErrorKind::Degenerate`] if the normals do not determine the light and `weight` is zero, [`ErrorKind::Range`]
    /// if only a light more extreme than any real one would fit the image, as on nearly flat relief.
    pub fn fit(&mut self, normals: &Normals, log: [&[f32]; 3], prior: &LightPrior, weight: f64) -> Result<LightFit> {
        self.gather(normals, log);
        let mut light = prior.mean();
        let mut median = 0.0;
        for _ in 0..ROUNDS {
            light = self.solve(prior, weight)?;
            if self.pixels.is_empty() {
                break;
            }
            self.find_residuals(&light);
            self.sorted.clone_from(&self.residuals);
            let before = median;
            median = f64::from(quantile(&mut self.sorted, 0.5));
            if (median - before).abs() <= SETTLED * median {
                break;
            }
            let scale = (SCALE_OF_MEDIAN * median).max(SMALLEST_SCALE) as f32;
            for (weight, &residual) in self.weights.iter_mut().zip(&self.residuals) {
                let ratio = residual / scale;
                *weight = robust::weight(ratio * ratio);
            }
        }
        let light = light.exposed(self.offset);
        light.validate("light").map_err(beyond_any)?;
        Ok(LightFit { light, residual: median })
    }

    /// Collects the pixels with a normal and a colour, and stores their normals and colours side by side.
    fn gather(&mut self, normals: &Normals, log: [&[f32]; 3]) {
        self.pixels.clear();
        // A list that grows step by step takes up to three times the memory.
        self.pixels.reserve_exact(normals.len());
        self.pixels.extend((0..normals.len()).filter(|&i| normals.is_valid(i) && !log[0][i].is_nan()));
        thin(&mut self.pixels, MOST_PIXELS);
        let [red, green, blue] = &mut self.colours;
        let Normals { x, y, z } = &mut self.normals;
        let fields =
            [(x, &normals.x[..]), (y, &normals.y), (z, &normals.z), (red, log[0]), (green, log[1]), (blue, log[2])];
        let whole = self.pixels.len().next_multiple_of(LANES);
        for (gathered, field) in fields {
            gathered.clear();
            gathered.extend(self.pixels.iter().map(|&index| field[index]));
            gathered.resize(whole, 0.0);
        }
        let count = self.pixels.len();
        let sum: f64 = self.colours.iter().flatten().map(|&log| f64::from(log)).sum();
        self.offset = sum / (3 * count).max(1) as f64;
        for log in self.colours.iter_mut().flat_map(|channel| &mut channel[..count]) {
            *log = (f64::from(*log) - self.offset) as f32;
        }
        self.weights.clear();
        self.weights.resize(count, 1.0);
        self.weights.resize(whole, 0.0);
        self.residuals.resize(count, 0.0);
    }

    /// Four normals and their colours.
    #[inline(always)]
    fn four(&self, start: usize) -> ([Lanes; 3], [Lanes; 3]) {
        let load = |field: &[f32]| Lanes::load(field, start as isize);
        let [red, green, blue] = &self.colours;
        ([load(&self.normals.x), load(&self.normals.y), load(&self.normals.z)], [load(red), load(green), load(blue)])
    }

    /// Computes |log S - predicted| of each pixel.
    fn find_residuals(&mut self, light: &Light) {
        let [red, green, blue] = Polynomial::of(light);
        for start in (0..self.residuals.len()).step_by(LANES) {
            let (normal, colour) = self.four(start);
            let off = [red.shade(normal) - colour[0], green.shade(normal) - colour[1], blue.shade(normal) - colour[2]];
            dot(off, off).sqrt().store(&mut self.residuals[start..]);
        }
    }

    /// Weighted least squares with the prior: (G + lambda P) L = b + lambda P mu.
    fn solve(&self, prior: &LightPrior, weight: f64) -> Result<Light> {
        let mut sums = [[0.0; COLUMNS]; HARMONICS];
        for start in (0..self.weights.len()).step_by(SUMMANDS) {
            self.add_up(start..self.weights.len().min(start + SUMMANDS), &mut sums);
        }
        let total: f64 = self.weights.iter().map(|&weight| f64::from(weight)).sum();
        let share = if total > 0.0 { 1.0 / total } else { 0.0 };
        let (mut matrix, mut target) = (CoefficientMatrix::zeros(), Coefficients::zeros());
        for channel in 0..3 {
            for row in 0..HARMONICS {
                target[channel * HARMONICS + row] += share * sums[row][HARMONICS + channel];
                for column in 0..HARMONICS {
                    let value = share * sums[row.max(column)][row.min(column)];
                    matrix[(channel * HARMONICS + row, channel * HARMONICS + column)] += value;
                }
            }
        }
        let pull = prior.precision() * prior.mean_coefficients();
        let solved = |raises| {
            let weight = 10.0_f64.powi(raises) * weight;
            let solution = (matrix + weight * prior.precision()).cholesky()?.solve(&(target + weight * pull));
            solution.iter().all(|value| value.is_finite()).then_some(solution)
        };
        let solution = (0..=MOST_RAISES)
            .find_map(solved)
            .ok_or_else(|| Error::new(ErrorKind::Degenerate, "light", "the normals do not determine the light"))?;
        Light::from_slice("light", solution.as_slice()).map_err(beyond_any)
    }

    /// Adds the weighted products of the harmonics with each other, up to the diagonal, and with the colours.
    fn add_up(&self, samples: Range<usize>, sums: &mut [[f64; COLUMNS]; HARMONICS]) {
        let mut parts = [[Lanes::splat(0.0); COLUMNS]; HARMONICS];
        for start in samples.step_by(LANES) {
            let (normal, colour) = self.four(start);
            let weight = Lanes::load(&self.weights, start as isize);
            let basis = basis(normal);
            for (row, parts) in parts.iter_mut().enumerate() {
                let weighted = weight * basis[row];
                for (part, other) in parts.iter_mut().zip(&basis[..=row]) {
                    *part = *part + weighted * *other;
                }
                for (part, colour) in parts[HARMONICS..].iter_mut().zip(colour) {
                    *part = *part + weighted * colour;
                }
            }
        }
        for (sum, part) in sums.iter_mut().flatten().zip(parts.iter().flatten()) {
            *sum += f64::from(part.sum());
        }
    }
}

/// Replaces an error about a coefficient, because a fitted light is not an option of the caller.
fn beyond_any(_: Error) -> Error {
    Error::new(
        ErrorKind::Range,
        "light",
        "only a light more extreme than any real one would explain the colours with this shape",
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Normals over the visible hemisphere and their colours under `light`. On request every tenth colour is wrong.
    fn scene(light: &Light, spoilt: bool) -> (Normals, [Vec<f32>; 3]) {
        let count = 600;
        let mut normals = Normals::missing(count);
        let mut log = [(); 3].map(|()| vec![0.0; count]);
        for index in 0..count {
            let z = -0.1 - 0.9 * (index as f64 + 0.5) / count as f64;
            let (sin, cos) = (2.399_963 * index as f64).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let normal = [r * cos, r * sin, z];
            normals.set(index, normal.map(|v| v as f32));
            let shade = light.shade(normal);
            for channel in 0..3 {
                let spoil = if spoilt && index % 10 == 0 { 1.5 } else { 0.0 };
                log[channel][index] = (shade[channel] - spoil) as f32;
            }
        }
        (normals, log)
    }

    #[test]
    fn an_exact_scene_gives_its_light_back() {
        let mut truth = LightPrior::natural().mean().exposed(1.7);
        truth.0[2][4] += 0.2;
        for spoilt in [false, true] {
            let (normals, log) = scene(&truth, spoilt);
            let fit = LightFitter::default()
                .fit(&normals, [&log[0], &log[1], &log[2]], &LightPrior::natural(), 1e-9)
                .unwrap();
            for (found, expected) in fit.light.flat().iter().zip(truth.flat()) {
                assert!((found - expected).abs() < 2e-4, "{found} {expected}");
            }
        }
    }

    #[test]
    fn without_pixels_and_without_a_prior_there_is_no_light() {
        let none = Normals::missing(4);
        let log = [0.0_f32; 4];
        let prior = LightPrior::natural();
        assert!(LightFitter::default().fit(&none, [&log; 3], &prior, 0.0).is_err());
    }

    #[test]
    fn relief_next_to_flat_has_a_light_whatever_the_priors_spread() {
        let truth = LightPrior::natural().mean();
        let (mut normals, log) = scene(&truth, false);
        for index in 0..normals.len() {
            let [x, y, _] = normals.get(index).map(|part| 1e-3 * part);
            normals.set(index, [x, y, -1.0]);
        }
        for spread in [1e-2, 1.0, 1e4, 1e8] {
            let wide = LightPrior::new(&truth.flat(), &(spread * CoefficientMatrix::identity())).unwrap();
            let fit = LightFitter::default().fit(&normals, [&log[0], &log[1], &log[2]], &wide, 1e-6);
            assert!(
                fit.as_ref().is_ok_and(|fit| fit.residual.is_finite())
                    || fit.as_ref().is_err_and(|error| error.kind() == ErrorKind::Range),
                "{spread}: {fit:?}"
            );
        }
    }

    #[test]
    fn colours_that_a_flat_shape_cannot_have_are_said_to_be_so_in_no_options_words() {
        let (mut normals, mut log) = scene(&LightPrior::natural().mean(), false);
        log.iter_mut().flatten().for_each(|value| *value *= 1000.0);
        for index in 0..normals.len() {
            let [x, y, _] = normals.get(index).map(|part| 0.01 * part);
            normals.set(index, [x, y, -1.0]);
        }
        let fit = LightFitter::default().fit(&normals, [&log[0], &log[1], &log[2]], &LightPrior::natural(), 1e-4);
        let said = fit.unwrap_err();
        assert_eq!(said.kind(), ErrorKind::Range);
        assert_eq!(
            said.to_string(),
            "light: only a light more extreme than any real one would explain the colours with this shape"
        );
    }

    #[test]
    fn another_exposure_gives_the_same_light_at_that_exposure() {
        let truth = LightPrior::natural().mean();
        let (normals, log) = scene(&truth, false);
        let brighter = [0, 1, 2].map(|c: usize| log[c].iter().map(|v| v + 2.3).collect::<Vec<f32>>());
        let fit = |log: &[Vec<f32>; 3]| {
            LightFitter::default()
                .fit(&normals, [&log[0], &log[1], &log[2]], &LightPrior::natural(), 1e-2)
                .unwrap()
                .light
        };
        let (plain, bright) = (fit(&log).exposed(2.3), fit(&brighter));
        for (a, b) in plain.flat().iter().zip(bright.flat()) {
            assert!((a - b).abs() < 1e-4);
        }
    }
}
