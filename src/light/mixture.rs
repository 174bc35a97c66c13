//! Fits a light together with a palette of a given number of albedos (docs/method/image-model.md).
//!
//! log S = B(n) L + a_k + e: the light L of the image model and, for each pixel, one of a few log offsets a_k; the
//! albedo of each pixel is unknown. The error e has three coordinates. The first is along the colour direction in which
//! the shading of this light varies most with the normal (lightness, under white lamps), and absorbs wrong normals and
//! cast shadows. The other two contain hardly any such errors. Both parts have separate scales. Chromaticity therefore
//! decides the albedo of a pixel where it can, and lightness where the shading fits well enough. Student's t makes both
//! robust.
//!
//! The solver is expectation maximisation: the probabilities of the albedos for each pixel, then L and all a_k in one
//! weighted least squares. The prior over lights and another over albedos determine what the pixels leave open. A.
//! Dempster, N. Laird, D. Rubin, J. R. Stat. Soc. B 39, 1977; K. Lange, R. Little, J. Taylor: "Robust statistical
//! modeling using the t distribution", J. Am. Stat. Assoc. 84, 1989.

use super::fit::SMALLEST_SCALE;
use crate::light::Light;
use crate::light::colour_axes::{Axes, AxesPrior, principal_axis};
use crate::light::harmonics::HARMONICS;
use crate::light::prior::COEFFICIENTS;

/// Maximum number of albedos of an object, set on ten photographs (docs/lab/thresholds.md).
pub const MOST_REGIONS: usize = 8;
/// Maximum number of unknowns: a light, and three offsets for each albedo.
const MOST_UNKNOWNS: usize = COEFFICIENTS + 3 * MOST_REGIONS;
/// Degrees of freedom of Student's t, the usual choice in robust regression.
const DEGREES: f64 = 4.0;
/// Standard deviation of the prior over log offsets: most materials reflect 4 to 90 percent.
const ALBEDO_SPREAD: f64 = 1.0;
/// Maximum rounds of expectation maximisation for each number of albedos, set on ten photographs
/// (docs/lab/thresholds.md).
const ROUNDS: usize = 14;
/// Gain of log likelihood per pixel and round below which expectation maximisation has settled, set on the same
/// photographs.
const SETTLED: f64 = 1e-3;

/// A pixel: its normal, the harmonics of that normal, and its log colour along the axes.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    pub normal: [f64; 3],
    pub basis: [f64; HARMONICS],
    pub colour: [f64; 3],
}

/// A light and a palette along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixture {
    pub light: [[f64; HARMONICS]; 3],
    pub regions: usize,
    /// Log offset of each albedo.
    pub offsets: [[f64; 3]; MOST_REGIONS],
    /// Share of the pixels that have each albedo.
    pub shares: [f64; MOST_REGIONS],
    /// Scale of the error along each axis, log units.
    pub scales: [f64; 3],
    /// Mean log likelihood of a pixel, up to a constant.
    pub likelihood: f64,
}

/// u = 1 + r^2 / (nu s^2), of the first axis, and of the other two axes together.
#[inline(never)]
fn spreads(residual: [f64; 3], scales: [f64; 3]) -> [f64; 2] {
    let [first, second, third] = [0, 1, 2].map(|axis: usize| (residual[axis] / scales[axis]).powi(2) / DEGREES);
    [1.0 + first, 1.0 + second + third]
}

impl Mixture {
    /// A single albedo before any fit.
    pub const fn blank() -> Self {
        Self {
            light: [[0.0; HARMONICS]; 3],
            regions: 1,
            offsets: [[0.0; 3]; MOST_REGIONS],
            shares: [1.0; MOST_REGIONS],
            scales: [1.0; 3],
            likelihood: f64::NEG_INFINITY,
        }
    }

    /// The light for R, G, B.
    pub fn light(&self, axes: &Axes) -> Light {
        let mut light = Light([[0.0; HARMONICS]; 3]);
        for k in 0..HARMONICS {
            let coefficients = axes.back(self.light.map(|channel| channel[k]));
            (0..3).for_each(|channel| light.0[channel][k] = coefficients[channel]);
        }
        light
    }

    /// The colour of a pixel minus its shading.
    #[inline(never)]
    pub fn unshaded(&self, sample: &Sample) -> [f64; 3] {
        std::array::from_fn(|channel| {
            let shading: f64 = self.light[channel].iter().zip(&sample.basis).map(|(l, b)| l * b).sum();
            sample.colour[channel] - shading
        })
    }

    /// Probability of each albedo for a colour without its shading, and the density of that colour. Without
    /// `lightness`, differences of colour alone decide.
    #[inline(never)]
    pub fn responsibilities(&self, unshaded: [f64; 3], lightness: bool) -> ([f64; MOST_REGIONS], f64) {
        let mut densities = [0.0; MOST_REGIONS];
        for k in 0..self.regions {
            let [light, colour] = spreads(minus(unshaded, self.offsets[k]), self.scales);
            let by_light = if lightness { light * light * light.sqrt() } else { 1.0 };
            densities[k] = self.shares[k] / (by_light * colour * colour * colour);
        }
        let total: f64 = densities.iter().sum();
        densities.iter_mut().for_each(|density| *density /= total);
        (densities, total / self.scales.iter().product::<f64>())
    }

    /// Mean offset, weighted by the probabilities.
    #[inline(never)]
    pub fn mean_offset(&self, responsibilities: &[f64; MOST_REGIONS]) -> [f64; 3] {
        std::array::from_fn(|c| (0..self.regions).map(|k| responsibilities[k] * self.offsets[k][c]).sum())
    }

    /// Variance of the albedos in each coordinate.
    pub fn variance(&self) -> [f64; 3] {
        let mean = self.mean_offset(&self.shares);
        std::array::from_fn(|c| {
            (0..self.regions).map(|k| self.shares[k] * (self.offsets[k][c] - mean[c]).powi(2)).sum()
        })
    }

    /// Expectation maximisation from this mixture. The samples count as `tiles` independent ones. `None` if the system
    /// has no solution.
    pub fn fitted(mut self, samples: &[Sample], prior: &AxesPrior, tiles: f64) -> Option<Self> {
        for _ in 0..ROUNDS {
            let sums = Sums::of(&self, samples);
            let before = self.likelihood;
            self.likelihood = sums.likelihood / sums.count;
            if (self.likelihood - before).abs() < SETTLED {
                break;
            }
            self.solve(&sums, prior, tiles)?;
            self.find_scales(samples, &sums);
        }
        Some(self)
    }

    /// Solves for the light and all albedos in one system.
    fn solve(&mut self, sums: &Sums, prior: &AxesPrior, tiles: f64) -> Option<()> {
        let size = COEFFICIENTS + 3 * self.regions;
        let firmness = prior.weight * tiles / (self.scales[0] * self.scales[0]);
        let mut system = System::new(size);
        for (row, column) in (0..COEFFICIENTS).flat_map(|row| (0..=row).map(move |column| (row, column))) {
            system.matrix[row][column] = firmness * prior.precision[(row, column)];
        }
        for row in 0..COEFFICIENTS {
            system.right[row] = firmness * prior.target[row];
        }
        for channel in 0..3 {
            let class = channel.min(1);
            let scale = tiles / (sums.count * self.scales[channel] * self.scales[channel]);
            let light = channel * HARMONICS;
            for i in (0..HARMONICS).filter(|_| !prior.is_known) {
                for j in 0..=i {
                    system.matrix[light + i][light + j] += scale * sums.gram[class][i][j];
                }
                system.right[light + i] += scale * sums.colour[channel][i];
            }
            for k in 0..self.regions {
                let row = COEFFICIENTS + 3 * k + channel;
                let mass = scale * sums.mass[class][k];
                system.matrix[row][row] = mass + 1.0 / (ALBEDO_SPREAD * ALBEDO_SPREAD);
                system.right[row] = scale * sums.offset[channel][k];
                for i in (0..HARMONICS).filter(|_| !prior.is_known) {
                    system.matrix[row][light + i] = scale * sums.cross[class][k][i];
                }
            }
        }
        system.solve()?;
        self.light = std::array::from_fn(|channel| std::array::from_fn(|i| system.right[channel * HARMONICS + i]));
        for k in 0..self.regions {
            self.offsets[k] = std::array::from_fn(|channel| system.right[COEFFICIENTS + 3 * k + channel]);
        }
        Some(())
    }

    /// Updates the shares of the albedos and the scales of the residuals.
    fn find_scales(&mut self, samples: &[Sample], sums: &Sums) {
        let count = sums.count;
        let mut squares = [0.0; 3];
        for sample in samples {
            let unshaded = self.unshaded(sample);
            let (responsibilities, _) = self.responsibilities(unshaded, true);
            for k in 0..self.regions {
                let residual = minus(unshaded, self.offsets[k]);
                let [light, colour] = spreads(residual, self.scales);
                let weights = [weight_of(light, 1.0), weight_of(colour, 2.0), weight_of(colour, 2.0)];
                (0..3).for_each(|c| squares[c] += responsibilities[k] * weights[c] * residual[c] * residual[c]);
            }
        }
        self.scales = squares.map(|square| (square / count).sqrt().max(SMALLEST_SCALE));
        self.shares = std::array::from_fn(|k| sums.share[k] / count);
    }

    /// Adds one albedo: splits the one whose pixels scatter most along the direction of that scatter.
    pub fn split(&self, samples: &[Sample]) -> Self {
        let mut scatter = [[[0.0; 3]; 3]; MOST_REGIONS];
        let mut mass = [0.0; MOST_REGIONS];
        for sample in samples {
            let unshaded = self.unshaded(sample);
            let (responsibilities, _) = self.responsibilities(unshaded, true);
            for k in 0..self.regions {
                let off = minus(unshaded, self.offsets[k]);
                let off: [f64; 3] = std::array::from_fn(|c| off[c] / self.scales[c]);
                let weight = responsibilities[k];
                mass[k] += weight;
                for (row, scatter) in scatter[k].iter_mut().enumerate() {
                    (0..3).for_each(|column| scatter[column] += weight * off[row] * off[column]);
                }
            }
        }
        let (mut best, mut parent, mut step) = (-1.0, 0, [0.0; 3]);
        for k in 0..self.regions {
            let (axis, scatter) = principal_axis(&scatter[k]);
            let variance = scatter / mass[k].max(f64::MIN_POSITIVE);
            if self.shares[k] * variance > best {
                (best, parent) = (self.shares[k] * variance, k);
                step = std::array::from_fn(|c| axis[c] * variance.sqrt() * self.scales[c]);
            }
        }
        let mut split = *self;
        split.regions += 1;
        split.likelihood = f64::NEG_INFINITY;
        let last = self.regions;
        split.offsets[last] = std::array::from_fn(|c| self.offsets[parent][c] + step[c]);
        split.offsets[parent] = minus(self.offsets[parent], step);
        split.shares[parent] *= 0.5;
        split.shares[last] = split.shares[parent];
        split
    }
}

fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|c| a[c] - b[c])
}

/// Weight of a squared residual under Student's t of this many dimensions, given its [`spreads`].
fn weight_of(spread: f64, dimensions: f64) -> f64 {
    (DEGREES + dimensions) / (DEGREES * spread)
}

/// Sums of one round over the pixels. An index of length two distinguishes the first axis from the other two.
struct Sums {
    gram: [[[f64; HARMONICS]; HARMONICS]; 2],
    cross: [[[f64; HARMONICS]; MOST_REGIONS]; 2],
    mass: [[f64; MOST_REGIONS]; 2],
    colour: [[f64; HARMONICS]; 3],
    offset: [[f64; MOST_REGIONS]; 3],
    share: [f64; MOST_REGIONS],
    likelihood: f64,
    count: f64,
}

impl Sums {
    fn of(mixture: &Mixture, samples: &[Sample]) -> Self {
        let mut sums = Self {
            gram: [[[0.0; HARMONICS]; HARMONICS]; 2],
            cross: [[[0.0; HARMONICS]; MOST_REGIONS]; 2],
            mass: [[0.0; MOST_REGIONS]; 2],
            colour: [[0.0; HARMONICS]; 3],
            offset: [[0.0; MOST_REGIONS]; 3],
            share: [0.0; MOST_REGIONS],
            likelihood: 0.0,
            count: samples.len() as f64,
        };
        samples.iter().for_each(|sample| sums.add(mixture, sample));
        sums
    }

    fn add(&mut self, mixture: &Mixture, sample: &Sample) {
        let Sample { basis, colour, .. } = sample;
        let unshaded = mixture.unshaded(sample);
        let (responsibilities, density) = mixture.responsibilities(unshaded, true);
        self.likelihood += density.max(f64::MIN_POSITIVE).ln();
        let mut weights = [0.0; 2];
        for k in 0..mixture.regions {
            self.share[k] += responsibilities[k];
            let spreads = spreads(minus(unshaded, mixture.offsets[k]), mixture.scales);
            for class in 0..2 {
                let weight = responsibilities[k] * weight_of(spreads[class], (class + 1) as f64);
                weights[class] += weight;
                self.mass[class][k] += weight;
                self.cross[class][k].iter_mut().zip(basis).for_each(|(sum, b)| *sum += weight * b);
            }
            for channel in 0..3 {
                let weight = responsibilities[k] * weight_of(spreads[channel.min(1)], (channel.min(1) + 1) as f64);
                self.offset[channel][k] += weight * colour[channel];
            }
        }
        for class in 0..2 {
            for row in 0..HARMONICS {
                let weighted = weights[class] * basis[row];
                (0..=row).for_each(|column| self.gram[class][row][column] += weighted * basis[column]);
            }
        }
        for channel in 0..3 {
            let weighted = weights[channel.min(1)] * colour[channel];
            self.colour[channel].iter_mut().zip(basis).for_each(|(sum, b)| *sum += weighted * b);
        }
    }
}

/// A symmetric positive definite system: its lower triangle, and the right-hand side, which becomes the solution.
struct System {
    size: usize,
    matrix: [[f64; MOST_UNKNOWNS]; MOST_UNKNOWNS],
    right: [f64; MOST_UNKNOWNS],
}

impl System {
    const fn new(size: usize) -> Self {
        Self { size, matrix: [[0.0; MOST_UNKNOWNS]; MOST_UNKNOWNS], right: [0.0; MOST_UNKNOWNS] }
    }

    /// Solves by Cholesky factorisation in place. `None` if the matrix is not positive definite.
    fn solve(&mut self) -> Option<()> {
        let Self { size, matrix, right } = self;
        for row in 0..*size {
            for column in 0..=row {
                let inner: f64 = (0..column).map(|k| matrix[row][k] * matrix[column][k]).sum();
                let rest = matrix[row][column] - inner;
                if column < row {
                    matrix[row][column] = rest / matrix[column][column];
                } else if rest > 0.0 && rest.is_finite() {
                    matrix[row][row] = rest.sqrt();
                } else {
                    return None;
                }
            }
            let inner: f64 = (0..row).map(|k| matrix[row][k] * right[k]).sum();
            right[row] = (right[row] - inner) / matrix[row][row];
        }
        for row in (0..*size).rev() {
            let inner: f64 = (row + 1..*size).map(|k| matrix[k][row] * right[k]).sum();
            right[row] = (right[row] - inner) / matrix[row][row];
        }
        Some(())
    }
}
