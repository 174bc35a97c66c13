//! The colour view on the search grid: coverage and balanced, mean-free log colours of each cell, and their spectra.
//!
//! y = W (log S - mean), where W holds the principal axes of the object's colours, each divided by the root of its
//! standard deviation. This is half-way between plain and whitened differences. Plain differences show hardly anything
//! but brightness. In whitened differences the faint chromaticity of natural light counts as much as its brightness,
//! but so does noise. With local contrast, the local means of log S are removed first.
//!
//! Limits: the grid spans the mask. If the mask is the whole frame, a small object has few cells.

use nalgebra::{Matrix3, Vector3};

use super::contrast::GridContrast;
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::eigen::symmetric_eigen;
use crate::numeric::fourier::planes::{Field, PlaneFourier};
use crate::view::ColourView;

/// Side of the grid in cells. The mask spans 18, so the template can move by 14 cells before it wraps around, where the
/// overlap is negligible.
pub const SIDE: usize = 32;
/// Number of cells of the grid.
pub const CELLS: usize = SIDE * SIDE;
/// The transform of the grid.
pub type Fourier = PlaneFourier<SIDE>;
/// Number of cells across the longer side of the mask; a tilt by the spacing of the rotations moves features by about
/// two.
const ACROSS: f64 = 18.0;
/// Smallest covered share of a cell with a colour; a smaller share is a border of interpolated pixels.
const LEAST_COVER: f32 = 0.05;
/// Standard deviation in log units below which a colour axis is not amplified further: twice the noise of a good
/// camera.
const NOISE: f64 = 0.02;

/// The colour view on a square grid. Empty cells hold zeros.
pub struct Target {
    pub side: usize,
    /// Width of a cell in pixels.
    pub cell: f64,
    /// Column and row of the pixel at the centre of cell (side / 2, side / 2), which is the centre of the mask.
    pub middle: [f64; 2],
    /// Share of each cell that the mask covers.
    pub mask: Vec<f32>,
    /// Sum of these shares.
    pub covered: f32,
    /// y.
    pub colour: [Vec<f32>; 3],
    /// W, and the mean that is subtracted before it is applied.
    pub balance: Matrix3<f64>,
    pub mean: Vector3<f64>,
    /// Whether y is the local contrast.
    pub by_contrast: bool,
    /// Spectra of the mask, of mask |y|^2 and of mask y.
    pub spectra: Spectra,
}

/// Spectra of real fields, in the order of [`Fourier`].
pub struct Spectra {
    pub mask: Field,
    /// Spectrum of mask |y|^2.
    pub square: Field,
    pub colour: [Field; 3],
}

impl Target {
    /// # Errors
    /// [`ErrorKind::Degenerate`] if all colours are the same.
    pub fn new(view: &ColourView, side: usize, fourier: &mut Fourier, by_contrast: bool) -> Result<Self> {
        // This is tested on pixels, because their means over cells differ by rounding. Bright colours have large
        // logarithms.
        if view.log_spread() <= f64::from(f32::EPSILON) * (1.0 + view.log_mean().abs()) {
            return Err(flat());
        }
        let (cell, middle) = frame(view);
        let (mask, mut colour) = cells(view, side, cell, middle);
        if by_contrast {
            GridContrast::new(side).apply_to_image(&mask, &mut colour);
        }
        let (mean, covariance) = mean_and_covariance(&mask, &colour);
        let balance = balance(&covariance)?;
        for index in (0..mask.len()).filter(|&index| mask[index] > 0.0) {
            let log = Vector3::from_fn(|channel, _| f64::from(colour[channel][index]));
            let balanced = balance * (log - mean);
            (0..3).for_each(|channel| colour[channel][index] = balanced[channel] as f32);
        }
        let mut spectrum = |value: &dyn Fn(usize) -> f32| {
            let mut field = Field::zero(CELLS);
            (0..mask.len()).for_each(|index| field.re[index] = value(index));
            fourier.forward(&mut field);
            field
        };
        let square = |index: usize| mask[index] * colour.iter().map(|channel| channel[index].powi(2)).sum::<f32>();
        let spectra = Spectra {
            mask: spectrum(&|index| mask[index]),
            square: spectrum(&square),
            colour: [0, 1, 2].map(|channel: usize| spectrum(&|index| mask[index] * colour[channel][index])),
        };
        let covered = mask.iter().sum();
        Ok(Self { side, cell, middle, mask, covered, colour, balance, mean, by_contrast, spectra })
    }
}

/// Width of a cell in pixels, and the centre of the mask.
fn frame(view: &ColourView) -> (f64, [f64; 2]) {
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for index in (0..view.size.len()).filter(|&index| view.mask[index]) {
        let (column, row) = view.size.position(index);
        for (axis, place) in [column as f64, row as f64].into_iter().enumerate() {
            low[axis] = low[axis].min(place);
            high[axis] = high[axis].max(place);
        }
    }
    let extent = (high[0] - low[0]).max(high[1] - low[1]) + 1.0;
    (extent / ACROSS, [0, 1].map(|axis| (low[axis] + high[axis]) / 2.0))
}

/// Coverage and mean log colours of the cells; each pixel is distributed over the four cells around it.
fn cells(view: &ColourView, side: usize, cell: f64, middle: [f64; 2]) -> (Vec<f32>, [Vec<f32>; 3]) {
    let mut mask = vec![0.0_f32; side * side];
    let mut colour = [(); 3].map(|()| vec![0.0_f32; side * side]);
    for index in (0..view.size.len()).filter(|&index| view.mask[index]) {
        let (column, row) = view.size.position(index);
        let x = (column as f64 - middle[0]) / cell + (side / 2) as f64;
        let y = (row as f64 - middle[1]) / cell + (side / 2) as f64;
        let (right, low) = (x.fract() as f32, y.fract() as f32);
        let corner = y as usize * side + x as usize;
        for (place, share) in [
            (corner, (1.0 - right) * (1.0 - low)),
            (corner + 1, right * (1.0 - low)),
            (corner + side, (1.0 - right) * low),
            (corner + side + 1, right * low),
        ] {
            mask[place] += share;
            (0..3).for_each(|channel| colour[channel][place] += share * view.log[channel][index]);
        }
    }
    let full = (cell * cell) as f32;
    for index in 0..mask.len() {
        let kept = mask[index] > LEAST_COVER * full;
        for channel in &mut colour {
            channel[index] = if kept { channel[index] / mask[index] } else { 0.0 };
        }
        mask[index] = if kept { (mask[index] / full).min(1.0) } else { 0.0 };
    }
    (mask, colour)
}

/// Mean and covariance of the colours, weighted by the mask.
fn mean_and_covariance(mask: &[f32], colour: &[Vec<f32>; 3]) -> (Vector3<f64>, Matrix3<f64>) {
    let at = |index: usize| Vector3::from_fn(|channel, _| f64::from(colour[channel][index]));
    let total: f64 = mask.iter().map(|&weight| f64::from(weight)).sum();
    let weighted = || (0..mask.len()).map(|index| (f64::from(mask[index]) / total, at(index)));
    let mean: Vector3<f64> = weighted().map(|(weight, colour)| weight * colour).sum();
    let spread = |(weight, colour): (f64, Vector3<f64>)| weight * (colour - mean) * (colour - mean).transpose();
    (mean, weighted().map(spread).sum())
}

fn flat() -> Error {
    Error::new(ErrorKind::Degenerate, "image", "all colours are the same")
}

/// W: principal axes over the fourth root of their variance, scaled so that the first has variance one.
fn balance(covariance: &Matrix3<f64>) -> Result<Matrix3<f64>> {
    let eigen = symmetric_eigen(covariance).ok_or_else(flat)?;
    let largest = eigen.eigenvalues.max();
    if largest.is_nan() || largest <= f64::from(f32::EPSILON).powi(2) {
        return Err(flat());
    }
    let shares = eigen.eigenvalues.map(|value| (value.max(0.0) + NOISE * NOISE) / largest);
    let gains = shares.map(|share| 1.0 / (share.sqrt().sqrt() * largest.sqrt()));
    Ok(Matrix3::from_diagonal(&gains) * eigen.eigenvectors.transpose())
}
