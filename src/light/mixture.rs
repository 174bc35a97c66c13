//! Light and a palette of paints together, for one number of regions (docs/method.md, section 3).
//!
//! log S = B(n) L + a_k + e: the light L of section 2, and for each pixel one of a few log offsets a_k, nobody knows
//! which. The error e falls into lightness, where cast shadows and wrong normals go, and two differences of colour,
//! where lamps of one colour leave hardly any. Both have a scale of their own, so colour decides which paint a pixel
//! has wherever it can, and lightness where shading is good enough to. Student's t makes both robust.
//!
//! Expectation maximisation: shares of the paints for each pixel, then L and all a_k in one weighted least squares. The
//! prior over lights and one over paints hold what the pixels leave open.
//! A. Dempster, N. Laird, D. Rubin, J. R. Stat. Soc. B 39, 1977; K. Lange, R. Little, J. Taylor: "Robust statistical
//! modeling using the t distribution", J. Am. Stat. Assoc. 84, 1989.

use crate::light::harmonics::HARMONICS;
use crate::light::prior::{COEFFICIENTS, CoefficientMatrix, Coefficients, LightPrior};

/// Most paints of an object. Each of ten photographs was as well explained by eight as by more (docs/method.md, 16).
pub const MOST_REGIONS: usize = 8;
/// Most unknowns: a light and three offsets for each paint.
const MOST_UNKNOWNS: usize = COEFFICIENTS + 3 * MOST_REGIONS;
/// Lightness and two differences of colour by R, G, B: orthonormal rows.
const OPPONENT: [[f64; 3]; 3] = [
    [0.577_350_269_189_625_8, 0.577_350_269_189_625_8, 0.577_350_269_189_625_8],
    [std::f64::consts::FRAC_1_SQRT_2, -std::f64::consts::FRAC_1_SQRT_2, 0.0],
    [0.408_248_290_463_863, 0.408_248_290_463_863, -0.816_496_580_927_726],
];
/// Degrees of freedom of Student's t: the usual choice of robust regression.
const DEGREES: f64 = 4.0;
/// Smallest scale in log units: the noise of a good 8-bit image. Exact colours would make it zero.
const SMALLEST_SCALE: f64 = 0.005;
/// Standard deviation of a paint's log offset: most paints reflect 4 to 90 percent.
const PAINT_SPREAD: f64 = 1.0;
/// Rounds of expectation maximisation for each number of regions, and the gain of log likelihood for each pixel below
/// which it has settled: more changed no figure of ten photographs.
const ROUNDS: usize = 14;
const SETTLED: f64 = 1e-3;

/// A pixel: the harmonics of its normal, and its log colour in opponent coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    pub basis: [f64; HARMONICS],
    pub colour: [f64; 3],
}

/// R, G, B to lightness and differences of colour.
pub fn to_opponent(rgb: [f64; 3]) -> [f64; 3] {
    OPPONENT.map(|row| row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2])
}

/// And back.
pub fn from_opponent(values: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|channel| (0..3).map(|row| OPPONENT[row][channel] * values[row]).sum())
}

/// The prior over lights in opponent coordinates; zero where the light is known.
pub struct OpponentPrior {
    precision: CoefficientMatrix,
    target: Coefficients,
    is_known: bool,
    /// lambda_L against the mean squared error of lightness.
    weight: f64,
}

impl OpponentPrior {
    /// Of an unknown light.
    pub fn of(prior: &LightPrior, weight: f64) -> Self {
        let turn = CoefficientMatrix::from_fn(|row, column| {
            let same = row % HARMONICS == column % HARMONICS;
            if same { OPPONENT[row / HARMONICS][column / HARMONICS] } else { 0.0 }
        });
        let precision = turn * prior.precision() * turn.transpose();
        let target = precision * (turn * prior.mean_coefficients());
        Self { precision, target, is_known: false, weight }
    }

    /// Of a light that is taken off the colours before.
    pub fn known() -> Self {
        Self { precision: CoefficientMatrix::identity(), target: Coefficients::zeros(), is_known: true, weight: 1.0 }
    }
}

/// Light and palette in opponent coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mixture {
    pub light: [[f64; HARMONICS]; 3],
    pub regions: usize,
    /// Log offset of each paint.
    pub offsets: [[f64; 3]; MOST_REGIONS],
    /// Share of the pixels that have it.
    pub shares: [f64; MOST_REGIONS],
    /// Scales of lightness and of the differences of colour, log units.
    pub scales: [f64; 2],
    /// Log likelihood of a pixel, at the mean and up to a constant.
    pub likelihood: f64,
}

/// u = 1 + r^2 / (nu s^2) of lightness and colour.
fn spreads([lightness, first, second]: [f64; 3], scales: [f64; 2]) -> [f64; 2] {
    let squares = [lightness * lightness, first * first + second * second];
    [0, 1].map(|k| 1.0 + squares[k] / (DEGREES * scales[k] * scales[k]))
}

impl Mixture {
    /// One paint, nothing known.
    pub const fn blank() -> Self {
        Self {
            light: [[0.0; HARMONICS]; 3],
            regions: 1,
            offsets: [[0.0; 3]; MOST_REGIONS],
            shares: [1.0; MOST_REGIONS],
            scales: [1.0; 2],
            likelihood: f64::NEG_INFINITY,
        }
    }

    /// What is left of a colour without its shading.
    pub fn unshaded(&self, sample: &Sample) -> [f64; 3] {
        std::array::from_fn(|channel| {
            let shading: f64 = self.light[channel].iter().zip(&sample.basis).map(|(l, b)| l * b).sum();
            sample.colour[channel] - shading
        })
    }

    /// Probability of each paint for a colour without its shading, and its density. Without `lightness` the differences
    /// of colour alone decide.
    pub fn responsibilities(&self, unshaded: [f64; 3], lightness: bool) -> ([f64; MOST_REGIONS], f64) {
        let mut densities = [0.0; MOST_REGIONS];
        let [light_scale, colour_scale] = self.scales;
        for k in 0..self.regions {
            let [light, colour] = spreads(minus(unshaded, self.offsets[k]), self.scales);
            let by_light = if lightness { light * light * light.sqrt() } else { 1.0 };
            densities[k] = self.shares[k] / (by_light * colour * colour * colour);
        }
        let total: f64 = densities.iter().sum();
        densities.iter_mut().for_each(|density| *density /= total);
        (densities, total / (light_scale * colour_scale * colour_scale))
    }

    /// Mean paint by the probabilities.
    pub fn mean_offset(&self, responsibilities: &[f64; MOST_REGIONS]) -> [f64; 3] {
        std::array::from_fn(|c| (0..self.regions).map(|k| responsibilities[k] * self.offsets[k][c]).sum())
    }

    /// Variance of the paints in each coordinate.
    pub fn variance(&self) -> [f64; 3] {
        let mean = self.mean_offset(&self.shares);
        std::array::from_fn(|c| {
            (0..self.regions).map(|k| self.shares[k] * (self.offsets[k][c] - mean[c]).powi(2)).sum()
        })
    }

    /// Expectation maximisation from here. A pixel counts as `weight` of an independent one. `None` where the system has
    /// no solution.
    pub fn fitted(mut self, samples: &[Sample], prior: &OpponentPrior, weight: f64) -> Option<Self> {
        for _ in 0..ROUNDS {
            let sums = Sums::of(&self, samples);
            let before = self.likelihood;
            self.likelihood = sums.likelihood / sums.count;
            if (self.likelihood - before).abs() < SETTLED {
                break;
            }
            self.solve(&sums, prior, weight)?;
            self.find_scales(samples, &sums);
        }
        Some(self)
    }

    /// Light and paints in one system.
    fn solve(&mut self, sums: &Sums, prior: &OpponentPrior, weight: f64) -> Option<()> {
        let size = COEFFICIENTS + 3 * self.regions;
        let firmness = prior.weight * weight * sums.count / (self.scales[0] * self.scales[0]);
        let mut system = System::new(size);
        for (row, column) in (0..COEFFICIENTS).flat_map(|row| (0..=row).map(move |column| (row, column))) {
            system.matrix[row][column] = firmness * prior.precision[(row, column)];
        }
        for row in 0..COEFFICIENTS {
            system.right[row] = firmness * prior.target[row];
        }
        for channel in 0..3 {
            let class = channel.min(1);
            let scale = weight / (self.scales[class] * self.scales[class]);
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
                system.matrix[row][row] = mass + 1.0 / (PAINT_SPREAD * PAINT_SPREAD);
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

    /// Shares of the paints, and scales of what light and paints leave.
    fn find_scales(&mut self, samples: &[Sample], sums: &Sums) {
        let count = sums.count;
        let mut squares = [0.0; 2];
        for sample in samples {
            let unshaded = self.unshaded(sample);
            let (responsibilities, _) = self.responsibilities(unshaded, true);
            for k in 0..self.regions {
                let residual = minus(unshaded, self.offsets[k]);
                let [light, colour] = spreads(residual, self.scales);
                let [lightness, first, second] = residual.map(|value| value * value);
                squares[0] += responsibilities[k] * weight_of(light, 1.0) * lightness;
                squares[1] += responsibilities[k] * weight_of(colour, 2.0) * (first + second);
            }
        }
        self.scales = [squares[0] / count, squares[1] / (2.0 * count)].map(|square| square.sqrt().max(SMALLEST_SCALE));
        self.shares = std::array::from_fn(|k| sums.share[k] / count);
    }

    /// One paint more: the one whose pixels scatter most is split along the direction in which they do.
    pub fn split(&self, samples: &[Sample]) -> Self {
        let mut scatter = [[[0.0; 3]; 3]; MOST_REGIONS];
        let mut mass = [0.0; MOST_REGIONS];
        let whitening = [self.scales[0], self.scales[1], self.scales[1]];
        for sample in samples {
            let unshaded = self.unshaded(sample);
            let (responsibilities, _) = self.responsibilities(unshaded, true);
            for k in 0..self.regions {
                let off = minus(unshaded, self.offsets[k]);
                let off: [f64; 3] = std::array::from_fn(|c| off[c] / whitening[c]);
                let weight = responsibilities[k];
                mass[k] += weight;
                for (row, scatter) in scatter[k].iter_mut().enumerate() {
                    (0..3).for_each(|column| scatter[column] += weight * off[row] * off[column]);
                }
            }
        }
        let (mut best, mut parent, mut step) = (-1.0, 0, [0.0; 3]);
        for k in 0..self.regions {
            let (axis, variance) = principal_axis(&scatter[k], mass[k]);
            if self.shares[k] * variance > best {
                (best, parent) = (self.shares[k] * variance, k);
                step = std::array::from_fn(|c| axis[c] * variance.sqrt() * whitening[c]);
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

/// Weight of a squared residual in Student's t of so many dimensions, by [`spreads`].
fn weight_of(spread: f64, dimensions: f64) -> f64 {
    (DEGREES + dimensions) / (DEGREES * spread)
}

/// Axis of largest scatter and the variance along it, by the power method; a few rounds are enough for a direction.
fn principal_axis(scatter: &[[f64; 3]; 3], mass: f64) -> ([f64; 3], f64) {
    let mut axis = [0.5, 0.6, 0.62];
    let mut variance = 0.0;
    for _ in 0..12 {
        let turned = scatter.map(|row| row.iter().zip(axis).map(|(s, a)| s * a).sum::<f64>());
        let length = turned.iter().map(|value| value * value).sum::<f64>().sqrt();
        if length <= 0.0 {
            break;
        }
        axis = turned.map(|value| value / length);
        variance = length / mass.max(f64::MIN_POSITIVE);
    }
    (axis, variance)
}

/// What one round sums over the pixels; the first index of a pair tells lightness from colour.
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

    fn add(&mut self, mixture: &Mixture, Sample { basis, colour }: &Sample) {
        let unshaded = mixture.unshaded(&Sample { basis: *basis, colour: *colour });
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

/// A symmetric positive definite system, its lower triangle, and the right side, which becomes the solution.
struct System {
    size: usize,
    matrix: [[f64; MOST_UNKNOWNS]; MOST_UNKNOWNS],
    right: [f64; MOST_UNKNOWNS],
}

impl System {
    const fn new(size: usize) -> Self {
        Self { size, matrix: [[0.0; MOST_UNKNOWNS]; MOST_UNKNOWNS], right: [0.0; MOST_UNKNOWNS] }
    }

    /// By Cholesky's factor, in place. `None` unless it is positive definite.
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
