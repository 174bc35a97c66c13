//! Solves (c L + s) z = f on a full rectangle, where (L z)_i is the sum of z_i - z_j over the neighbours j of i.
//!
//! Method: L has free (Neumann) borders, so the cosines cos(pi k (x + 1/2) / W) are its eigenvectors along a row, with
//! eigenvalues mu_k = 2 - 2 cos(pi k / W). A cosine transform (DCT-II) of every row leaves one tridiagonal system down
//! the columns for each k, with 2 + mu_k + s/c on its diagonal. Elimination solves it, and the inverse transform
//! (DCT-III) returns to pixels. Each row is transformed once each way, where transforms along both axes would need two
//! passes, and columns may have any length. Cost O(W H log W). Eight rows are transformed at once, see [`Rows`].
//!
//! A rectangle whose width has large prime factors is solved as part of a wider one that is zero beyond it, because a
//! preconditioner need not be exact (docs/method/normals.md).
//!
//! Why not rustdct (0.7): it transforms one row after the other. A solve, which takes most of an iteration of the
//! integration, takes 5.9 ms instead of 2.9 at 640x480 with simd128 and rustfft's SIMD for WebAssembly, and 8.0 without
//! the latter (Node 20). Without SIMD rustdct is faster (0.4 to 0.8 of the time), but current browsers load simd128.
//!
//! Limits: without a shift (s = 0) constants are in the null space. The sum of f then has to be zero (its mean is
//! ignored), and the solution has mean zero. Rounding: about 1e-6 of the largest height at 256x256 (f32 pixels, f64
//! pivots).

use std::f64::consts::PI;

use super::fourier::rows::{Complex, RowFourier, fast_length};
use crate::numeric::{LANES, Lanes, Real};

/// Direct solver for one size of rectangle; owns its plan and scratch memory.
pub struct CosineSolver {
    /// Columns of the fields.
    width: usize,
    rows: Rows,
    /// 1 / pivot for each row (slow index) and frequency (fast index); zero where the system is singular.
    reciprocals: Vec<f32>,
    /// mu_k of each frequency.
    eigenvalues: Vec<f64>,
    /// 1 / pivot of the row above, during the computation of the pivots.
    above: Vec<f64>,
    /// 1 / (c W): normalisation of the transforms and the stiffness.
    gain: f32,
    /// s / c.
    ratio: f64,
}

impl CosineSolver {
    /// Plans fields of `width` x `height` with c = 1 and s = 0; the width is a multiple of [`LANES`].
    pub fn new(width: usize, height: usize) -> Self {
        let length = fast_length(width);
        let eigenvalues = (0..length).map(|k| 4.0 * (PI * k as f64 / (2 * length) as f64).sin().powi(2)).collect();
        let mut solver = Self {
            width,
            rows: Rows::new(length),
            reciprocals: vec![0.0; length * height],
            eigenvalues,
            above: vec![0.0; length],
            gain: 0.0,
            // NaN differs from every ratio, so the first call of `set` finds the pivots.
            ratio: f64::NAN,
        };
        solver.set(1.0, 0.0);
        solver
    }

    /// Sets the stiffness c > 0 and the shift s >= 0.
    pub fn set(&mut self, stiffness: f64, shift: f64) {
        self.gain = (1.0 / (stiffness * self.above.len() as f64)) as f32;
        let ratio = shift / stiffness;
        if ratio != self.ratio {
            self.ratio = ratio;
            self.find_pivots();
        }
    }

    /// Computes the pivots of every row and frequency.
    fn find_pivots(&mut self) {
        let length = self.above.len();
        let last = self.reciprocals.len() / length - 1;
        self.above.fill(0.0);
        for (row, reciprocals) in self.reciprocals.chunks_exact_mut(length).enumerate() {
            // Diagonal without mu: s/c plus the number of neighbours above and below.
            let diagonal = self.ratio + f64::from(u8::from(row > 0)) + f64::from(u8::from(row < last));
            for ((reciprocal, above), mu) in reciprocals.iter_mut().zip(&mut self.above).zip(&self.eigenvalues) {
                *above = 1.0 / (diagonal + mu - *above);
                *reciprocal = *above as f32;
            }
        }
        if self.ratio == 0.0 {
            // The last pivot of the constant mode is zero up to rounding, because its level is free.
            self.reciprocals[last * length] = 0.0;
        }
    }

    /// Length of a spectrum: one number for each row and frequency.
    pub fn len(&self) -> usize {
        self.reciprocals.len()
    }

    /// Writes the solution for the right-hand side `field`, both `width` x `height`. `spectrum` is scratch.
    pub fn solve(&mut self, field: &[f32], spectrum: &mut [f32], solution: &mut [f32]) {
        let (several, length) = (ROWS * self.width, ROWS * self.above.len());
        for (field, spectrum) in field.chunks(several).zip(spectrum.chunks_mut(length)) {
            self.rows.forward(field, self.width, self.gain, spectrum);
        }
        self.eliminate(spectrum);
        for (solution, spectrum) in solution.chunks_mut(several).zip(spectrum.chunks(length)) {
            self.rows.inverse(spectrum, solution, self.width);
        }
    }

    /// Forward elimination and back substitution down the columns, for all frequencies side by side.
    fn eliminate(&self, field: &mut [f32]) {
        let length = self.above.len();
        let rows = field.len() / length;
        for row in 1..rows {
            let (above, here) = field[(row - 1) * length..(row + 1) * length].split_at_mut(length);
            let reciprocals = &self.reciprocals[(row - 1) * length..row * length];
            for ((value, above), reciprocal) in here.iter_mut().zip(above).zip(reciprocals) {
                *value += *above * reciprocal;
            }
        }
        let last = (rows - 1) * length;
        for (value, reciprocal) in field[last..].iter_mut().zip(&self.reciprocals[last..]) {
            *value *= reciprocal;
        }
        for row in (0..rows - 1).rev() {
            let (here, below) = field[row * length..(row + 2) * length].split_at_mut(length);
            let reciprocals = &self.reciprocals[row * length..(row + 1) * length];
            for ((value, below), reciprocal) in here.iter_mut().zip(below).zip(reciprocals) {
                *value = (*value + *below) * reciprocal;
            }
        }
        if self.ratio == 0.0 {
            let mean = field.iter().step_by(length).map(|&value| f64::from(value)).sum::<f64>() / rows as f64;
            field.iter_mut().step_by(length).for_each(|value| *value -= mean as f32);
        }
    }
}

/// Number of rows that are transformed at once.
const ROWS: usize = 2 * LANES;

/// Cosine transforms of eight rows: four in lanes, and four more as their imaginary parts.
///
/// Method (Makhoul): v holds the even samples of a row x from its start, and the odd ones backwards from its end. With
/// the Fourier transform V of v and e_k = exp(-i pi k / 2W), e_k V_k = X_k - i X_(W-k), where X is the cosine
/// transform. One transform of a + i b yields V of both rows a and b: V_k + conj V_(W-k) is twice that of a.
struct Rows {
    fourier: RowFourier,
    /// The first four rows and the other four of each sample or frequency.
    work: Vec<Complex>,
    /// cos and sin of pi k / 2W.
    turns: Vec<[f32; 2]>,
}

impl Rows {
    fn new(length: usize) -> Self {
        let turn = |k: usize| {
            let (sin, cos) = (PI * k as f64 / (2 * length) as f64).sin_cos();
            [cos as f32, sin as f32]
        };
        Self {
            fourier: RowFourier::new(length),
            work: vec![[Lanes::splat(0.0); 2]; length],
            turns: (0..=length / 2).map(turn).collect(),
        }
    }

    /// Positions in v of the samples of [`LANES`] columns from `column` on.
    fn samples(&self, column: usize) -> [usize; LANES] {
        let last = self.work.len() - 1;
        std::array::from_fn(|lane| {
            let pair = (column + lane) / 2;
            if (column + lane).is_multiple_of(2) { pair } else { last - pair }
        })
    }

    /// Sets `spectrum` to `gain` times the sums of x_n cos(pi k (n + 1/2) / W), for up to eight rows of `width`
    /// samples, with zeros beyond.
    fn forward(&mut self, rows: &[f32], width: usize, gain: f32, spectrum: &mut [f32]) {
        self.work.fill([Lanes::splat(0.0); 2]);
        for column in (0..width).step_by(LANES) {
            let places = self.samples(column);
            for half in 0..2 {
                let four = columns(rows, half * LANES * width + column, width);
                for (place, value) in places.into_iter().zip(four) {
                    self.work[place][half] = value;
                }
            }
        }
        self.fourier.transform(&mut self.work);
        self.part(gain);
        let length = self.work.len();
        for (block, values) in self.work.as_chunks::<LANES>().0.iter().enumerate() {
            for half in 0..2 {
                let four = values.map(|value| value[half]);
                set_columns(four, spectrum, (half * length + block) * LANES, length);
            }
        }
    }

    /// Inverts [`forward`](Self::forward) up to a factor of W, for up to eight `rows` of `width` samples.
    fn inverse(&mut self, spectrum: &[f32], rows: &mut [f32], width: usize) {
        let length = self.work.len();
        for (block, values) in self.work.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
            for half in 0..2 {
                let four = columns(spectrum, (half * length + block) * LANES, length);
                for (value, new) in values.iter_mut().zip(four) {
                    value[half] = new;
                }
            }
        }
        self.join();
        self.fourier.transform(&mut self.work);
        for column in (0..width).step_by(LANES) {
            let places = self.samples(column);
            for half in 0..2 {
                // The real and imaginary parts have changed places.
                let four = places.map(|place| self.work[place][1 - half]);
                set_columns(four, rows, half * LANES * width + column, width);
            }
        }
    }

    /// Turns the transform of a + i b into the cosine transforms of a and b, times `gain`.
    fn part(&mut self, gain: f32) {
        let gain_lanes = Lanes::splat(gain);
        let [a, b] = self.work[0];
        self.work[0] = [gain_lanes * a, gain_lanes * b];
        let (length, half_gain) = (self.work.len(), 0.5 * gain);
        for (k, [cos, sin]) in self.turns.iter().enumerate().skip(1) {
            let ([re, im], [other_re, other_im]) = (self.work[k], self.work[length - k]);
            let (cos, sin) = (Lanes::splat(half_gain * cos), Lanes::splat(half_gain * sin));
            let (a_re, a_im) = (re + other_re, im - other_im);
            let (b_re, b_im) = (im + other_im, other_re - re);
            self.work[k] = [cos * a_re + sin * a_im, cos * b_re + sin * b_im];
            self.work[length - k] = [sin * a_re - cos * a_im, sin * b_re - cos * b_im];
        }
    }

    /// Inverts [`part`](Self::part), with real and imaginary parts exchanged so that the forward transform acts as the
    /// inverse one.
    fn join(&mut self) {
        let [a, b] = self.work[0];
        self.work[0] = [b, a];
        let length = self.work.len();
        for (k, [cos, sin]) in self.turns.iter().enumerate().skip(1) {
            let ([a, b], [other_a, other_b]) = (self.work[k], self.work[length - k]);
            let (cos, sin) = (Lanes::splat(*cos), Lanes::splat(*sin));
            let (a_re, a_im) = (cos * a + sin * other_a, sin * a - cos * other_a);
            let (b_re, b_im) = (cos * b + sin * other_b, sin * b - cos * other_b);
            self.work[k] = [a_im + b_re, a_re - b_im];
            self.work[length - k] = [b_re - a_im, a_re + b_im];
        }
    }
}

/// [`LANES`] columns, from `start` on, of as many rows, which are `stride` apart; zeros for missing rows.
#[inline(never)]
fn columns(rows: &[f32], start: usize, stride: usize) -> [Lanes; LANES] {
    Lanes::transpose(std::array::from_fn(|row| {
        let place = start + row * stride;
        if place < rows.len() { Lanes::load(rows, place as isize) } else { Lanes::splat(0.0) }
    }))
}

/// Inverts [`columns`]; skips missing rows.
#[inline(never)]
fn set_columns(four: [Lanes; LANES], rows: &mut [f32], start: usize, stride: usize) {
    for (row, value) in Lanes::transpose(four).into_iter().enumerate() {
        if let Some(row) = rows.get_mut(start + row * stride..) {
            value.store(row);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    /// Applies (c L + s) to z in f64.
    fn apply(width: usize, height: usize, stiffness: f64, shift: f64, z: &[f64]) -> Vec<f32> {
        let mut out: Vec<f64> = z.iter().map(|value| shift * value).collect();
        for row in 0..height {
            for column in 0..width {
                let i = row * width + column;
                let right = (column + 1 < width).then_some(i + 1);
                let below = (row + 1 < height).then_some(i + width);
                for j in right.into_iter().chain(below) {
                    out[i] += stiffness * (z[i] - z[j]);
                    out[j] += stiffness * (z[j] - z[i]);
                }
            }
        }
        out.iter().map(|&value| value as f32).collect()
    }

    fn error(width: usize, height: usize, stiffness: f64, shift: f64) -> f64 {
        let mut z: Vec<f64> = (0..width * height)
            .map(|i| {
                let (x, y) = ((i % width) as f64 / width as f64, (i / width) as f64 / height as f64);
                (5.0 * x + 3.0 * y * y).sin() + 0.1 * (i as f64 * 1.7).sin()
            })
            .collect();
        let mean = z.iter().sum::<f64>() / z.len() as f64;
        z.iter_mut().for_each(|value| *value -= mean);
        let field = apply(width, height, stiffness, shift, &z);
        let mut solver = CosineSolver::new(width, height);
        solver.set(stiffness, shift);
        let mut solution = vec![f32::NAN; field.len()];
        solver.solve(&field, &mut vec![0.0; solver.len()], &mut solution);
        solution.iter().zip(&z).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn inverts_the_laplacian_of_a_rectangle() {
        for (width, height) in
            [(4, 1), (4, 7), (8, 1), (12, 2), (16, 5), (72, 81), (48, 7), (96, 31), (24, 2), (256, 256)]
        {
            for (stiffness, shift) in [(1.0, 0.0), (0.7, 0.02), (3.0, 1.5)] {
                let error = error(width, height, stiffness, shift);
                assert!(error < 1e-5, "{width}x{height}, c = {stiffness}, s = {shift}: {error:e}");
            }
        }
    }

    /// For a field that ends in zeros, the narrower solver agrees within its width.
    #[test]
    fn a_narrow_field_is_part_of_a_wide_one() {
        let (width, wider, height) = (44, 48, 11);
        let narrow: Vec<f32> = (0..width * height).map(|i| (i as f32 * 0.7).sin()).collect();
        let mut wide = vec![0.0; wider * height];
        wide.chunks_mut(wider).zip(narrow.chunks(width)).for_each(|(wide, row)| wide[..width].copy_from_slice(row));
        let solve = |width: usize, field: &[f32]| {
            let mut solver = CosineSolver::new(width, height);
            solver.set(1.0, 0.3);
            let mut solution = vec![f32::NAN; field.len()];
            solver.solve(field, &mut vec![0.0; solver.len()], &mut solution);
            solution
        };
        let (narrow, wide) = (solve(width, &narrow), solve(wider, &wide));
        assert!(narrow.chunks(width).zip(wide.chunks(wider)).all(|(narrow, wide)| *narrow == wide[..width]));
    }
}
