//! Exact score of a template at one translation, which measures how well the template explains the colours under it.
//!
//! score = N (N / V) (1/3) ln( det(T + e) / det(E + e) ), with N cells of overlap out of V visible ones, the covariance
//! T of the balanced colours y in the overlap, and the covariance E of their residuals. Under an unknown light these
//! are the residuals of a linear fit of the nine harmonics in each channel, under a known one y - W B(n) L without a
//! common exposure. The score is the gain of log likelihood over a constant colour, so exposure and white balance
//! cancel. N / V is the share of the visible cells that lie on the mask: points that should be visible but lie off the
//! object reduce the score.
//!
//! With local contrast, the fit has three more regressors, and little of the variance is left to explain. E is then
//! divided by N less the number of coefficients, because so many coefficients explain noise as well.
//!
//! Limits: every cell counts as independent, and shadows are not modelled.

use nalgebra::{Matrix3, SMatrix, Vector3};

use super::target::Target;
use super::template::Template;
use super::values::{PADDED, Products, Sums, WITH_RELIEF, products, row_start};
use crate::light::{HARMONICS, Light, basis};

/// Variance e added to the balanced colours, whose first axis has variance one. A tilt by half the spacing of the rotations
/// leaves at least this much unexplained (docs/lab/thresholds.md).
const UNEXPLAINED: f64 = 1e-3;
/// Numbers that are added to the diagonal of the harmonics' Gram matrix, as shares of the entry itself and of the
/// weight. They prevent large coefficients of harmonics that hardly vary over the overlap.
const RIDGE: f64 = 1e-3;
const RIDGE_OF_WEIGHT: f64 = 1e-4;
/// Smallest number of cells of an overlap. Nine harmonics fit any colours of nine cells.
pub const FEWEST_CELLS: f32 = 12.0;

/// Sums over some cells of the products of the first C values.
pub type Gram<const C: usize> = SMatrix<f64, C, C>;

/// Balanced colours of a known light at every cell of a template, without their mean along the exposure.
pub struct Prediction {
    light: Light,
    /// W (1, 1, 1) with length one, the direction in which the exposure moves the colours.
    pub exposure: Vector3<f64>,
    /// The colours, in the order of the template's cells.
    pub colours: Vec<[f32; 3]>,
}

impl Prediction {
    pub fn new(light: &Light, target: &Target) -> Self {
        let exposure = (target.balance * Vector3::repeat(1.0)).normalize();
        Self { light: *light, exposure, colours: Vec::with_capacity(target.mask.len()) }
    }

    /// Shades the cells of a template. Allocates nothing.
    pub fn shade(&mut self, template: &Template, target: &Target) {
        self.colours.clear();
        let constant = basis([0.0; 3])[0];
        let (mut offset, mut total) = (0.0, 0.0);
        let colour = |sums: &Sums| {
            let log = self.light.0.map(|l| {
                l[0] * constant + (1..HARMONICS).map(|k| l[k] * f64::from(sums[k])).sum::<f64>() / f64::from(sums[0])
            });
            target.balance * (Vector3::from(log) - target.mean)
        };
        for sums in template.cells.iter().map(|&cell| &template.sums[cell as usize]) {
            let colour = colour(sums);
            offset += f64::from(sums[0]) * self.exposure.dot(&colour);
            total += f64::from(sums[0]);
            self.colours.push(colour.map(|value| value as f32).into());
        }
        let offset = (self.exposure * (offset / total)).map(|value| value as f32);
        self.colours.iter_mut().for_each(|colour| (0..3).for_each(|channel| colour[channel] -= offset[channel]));
    }
}

/// The score of a template moved by whole cells; `None` if too little overlaps.
pub fn score(template: &Template, prediction: Option<&Prediction>, target: &Target, shift: [i32; 2]) -> Option<f64> {
    let (total, residual, cells) = match prediction {
        None if template.is_by_contrast() => squares_of_fit::<WITH_RELIEF>(template, target, shift)?,
        None => squares_of_fit::<HARMONICS>(template, target, shift)?,
        Some(prediction) => squares_of_prediction(template, prediction, target, shift)?,
    };
    let floor = Matrix3::identity() * UNEXPLAINED;
    let gain = ((total / cells + floor).determinant() / (residual / cells + floor).determinant()).ln() / 3.0;
    let freedom = if template.is_by_contrast() { (cells - WITH_RELIEF as f64).max(1.0) / (cells - 1.0) } else { 1.0 };
    let gain = gain + freedom.ln();
    gain.is_finite().then(|| gain * cells * cells / f64::from(template.visible))
}

/// Sums of squares of the colours about their mean and of the residuals, and the number of cells.
type Squares = (Matrix3<f64>, Matrix3<f64>, f64);

/// The cells that a moved template and the target share, each as index in the template's list, sums, and index in the
/// target.
fn overlap<'a>(
    template: &'a Template,
    target: &'a Target,
    shift: [i32; 2],
) -> impl Iterator<Item = (usize, &'a Sums, usize)> {
    let side = target.side as i32;
    template.cells.iter().enumerate().filter_map(move |(order, &cell)| {
        let (column, row) = (cell as i32 % side + shift[0], cell as i32 / side + shift[1]);
        let inside = (0..side).contains(&column) && (0..side).contains(&row);
        let place = inside.then_some((row * side + column) as usize)?;
        (target.mask[place] > 0.0).then(|| (order, &template.sums[cell as usize], place))
    })
}

fn squares_of_fit<const C: usize>(template: &Template, target: &Target, shift: [i32; 2]) -> Option<Squares> {
    let mut gram = [0.0_f32; products(WITH_RELIEF)];
    let mut cross = [[0.0_f32; PADDED]; 3];
    let mut outer = [0.0_f32; 6];
    for (order, sums, place) in overlap(template, target, shift) {
        let mask = target.mask[place];
        gram[..products(C)].iter_mut().zip(&template.products[order]).for_each(|(sum, product)| *sum += mask * product);
        let colour = [target.colour[0][place], target.colour[1][place], target.colour[2][place]];
        for (cross, value) in cross.iter_mut().zip(colour) {
            let share = mask * value;
            (0..PADDED).for_each(|k| cross[k] += share * sums[k]);
        }
        add_outer(&mut outer, mask * sums[0], colour);
    }
    let cells = gram[0];
    let enough = cells >= FEWEST_CELLS;
    let factor = regularised::<C>(&gram).cholesky().filter(|_| enough)?;
    let cross = SMatrix::<f64, C, 3>::from_fn(|k, channel| f64::from(cross[channel][k]));
    let explained = cross.transpose() * factor.solve(&cross);
    let (outer, cells) = (symmetric(&outer), f64::from(cells));
    let sum = cross.row(0);
    Some((outer - sum.transpose() * sum / cells, outer - explained, cells))
}

/// The Gram matrix from sums of products, with the ridge.
pub fn regularised<const C: usize>(products: &Products) -> Gram<C> {
    let mut gram = Gram::from_fn(|row, column| {
        let (long, short) = (row.max(column), row.min(column));
        f64::from(products[row_start(long) + short])
    });
    for k in 1..C {
        gram[(k, k)] += RIDGE * gram[(k, k)] + RIDGE_OF_WEIGHT * gram[(0, 0)];
    }
    gram
}

fn squares_of_prediction(
    template: &Template,
    prediction: &Prediction,
    target: &Target,
    shift: [i32; 2],
) -> Option<Squares> {
    let (mut cells, mut sum, mut off) = (0.0_f32, [0.0_f32; 3], [0.0_f32; 3]);
    let (mut outer, mut left) = ([0.0_f32; 6], [0.0_f32; 6]);
    for (order, sums, place) in overlap(template, target, shift) {
        let weight = target.mask[place] * sums[0];
        let colour = [target.colour[0][place], target.colour[1][place], target.colour[2][place]];
        let shade = prediction.colours[order];
        let residual = [colour[0] - shade[0], colour[1] - shade[1], colour[2] - shade[2]];
        cells += weight;
        for channel in 0..3 {
            sum[channel] += weight * colour[channel];
            off[channel] += weight * residual[channel];
        }
        add_outer(&mut outer, weight, colour);
        add_outer(&mut left, weight, residual);
    }
    if cells < FEWEST_CELLS {
        return None;
    }
    let (sum, off, cells) = (Vector3::from(sum.map(f64::from)), Vector3::from(off.map(f64::from)), f64::from(cells));
    // The mean m along the unit vector u is removed: sum of (d - m u)(d - m u)^T with m = u . d / N.
    let exposure = prediction.exposure;
    let mean = exposure.dot(&off) / cells;
    let mixed = off * exposure.transpose() * mean;
    let residual =
        symmetric(&left) - mixed - mixed.transpose() + exposure * exposure.transpose() * (mean * mean * cells);
    Some((symmetric(&outer) - sum * sum.transpose() / cells, residual, cells))
}

fn add_outer(outer: &mut [f32; 6], weight: f32, [x, y, z]: [f32; 3]) {
    for (sum, product) in outer.iter_mut().zip([x * x, x * y, x * z, y * y, y * z, z * z]) {
        *sum += weight * product;
    }
}

fn symmetric(outer: &[f32; 6]) -> Matrix3<f64> {
    let [xx, xy, xz, yy, yz, zz] = outer.map(f64::from);
    Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz)
}
