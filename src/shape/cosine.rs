//! (c L + s) z = f on a full rectangle, where (L z)_i = sum over the neighbours j of i of (z_i - z_j).
//!
//! Method: L has free (Neumann) borders, so the cosines cos(pi k (x + 1/2) / W) are its eigenvectors along a row, with
//! eigenvalues mu_k = 2 - 2 cos(pi k / W). A cosine transform (DCT-II) of every row leaves, for each k, one tridiagonal
//! system down the columns with 2 + mu_k + s/c on its diagonal; elimination solves it, the inverse transform (DCT-III)
//! returns. One transform of every row and back, against two for the transform along both axes, and columns of any
//! length at no extra price. Cost O(W H log W).
//!
//! Limits: without a shift (s = 0) constants are in the null space: f has to sum to zero (its mean is ignored)
//! and the answer has mean zero. Rounding: about 1e-6 of the largest height at 256x256 (f32 pixels, f64 pivots).

use std::f64::consts::PI;
use std::sync::Arc;

use rustdct::algorithm::Type2And3ConvertToFft;
use rustdct::{Dct2, Dct3, RequiredScratch};
use rustfft::algorithm::butterflies::{Butterfly3, Butterfly4, Butterfly8};
use rustfft::algorithm::{Dft, Radix4};
use rustfft::{Fft, FftDirection};

/// The shortest row of at least `width` pixels that the transform handles well: once, twice or three times a power of four.
pub fn fast_width(width: usize) -> usize {
    let power = |factor: usize| {
        let two = width.max(1).div_ceil(factor).next_power_of_two();
        factor * (two << (two.trailing_zeros() % 2))
    };
    [1, 2, 3].map(power).into_iter().min().unwrap_or(width)
}

/// A Fourier transform of `length` values. rustfft's planner would bring code for every length there is, a third of the
/// whole wasm, and its own choice of the smallest transforms another 5 kB (gzipped); here fast widths get what
/// they need, and others the definition itself.
fn fourier(length: usize) -> Arc<dyn Fft<f32>> {
    let forward = FftDirection::Forward;
    let (odd, doublings) = (length >> length.trailing_zeros(), length.trailing_zeros());
    let smallest: Arc<dyn Fft<f32>> = match (odd, doublings % 2, doublings) {
        (1, 0, 2..) => Arc::new(Butterfly4::new(forward)),
        (1, 1, 3..) => Arc::new(Butterfly8::new(forward)),
        (3, 0, _) => Arc::new(Butterfly3::new(forward)),
        _ => return Arc::new(Dft::new(length, forward)),
    };
    let fours = (length / smallest.len()).trailing_zeros() / 2;
    Arc::new(Radix4::new_with_base(fours, smallest))
}

/// Direct solver for one size of rectangle; owns its plan and its scratch memory.
pub struct CosineSolver {
    width: usize,
    transform: Type2And3ConvertToFft<f32>,
    scratch: Vec<f32>,
    /// mu_k for each frequency.
    eigenvalues: Vec<f64>,
    /// 1 / pivot of each row (slow) and frequency (fast); zero where the system is singular.
    reciprocals: Vec<f32>,
    /// 1 / pivot of the row above, while they are found.
    above: Vec<f64>,
    /// 2 / (c W): the transforms' normalisation and the stiffness.
    gain: f32,
    /// s / c.
    ratio: f64,
}

impl CosineSolver {
    /// Plans rectangles of `width` x `height` with c = 1 and s = 0.
    pub fn new(width: usize, height: usize) -> Self {
        let transform = Type2And3ConvertToFft::new(fourier(width));
        let scratch = vec![0.0; transform.get_scratch_len()];
        let eigenvalues = (0..width).map(|k| 4.0 * (PI * k as f64 / (2 * width) as f64).sin().powi(2)).collect();
        let mut solver = Self {
            width,
            transform,
            scratch,
            eigenvalues,
            reciprocals: vec![0.0; width * height],
            above: vec![0.0; width],
            gain: 0.0,
            // No ratio yet: whatever is set first differs.
            ratio: f64::NAN,
        };
        solver.set(1.0, 0.0);
        solver
    }

    /// Sets the stiffness c > 0 and the shift s >= 0.
    pub fn set(&mut self, stiffness: f64, shift: f64) {
        self.gain = (2.0 / (stiffness * self.width as f64)) as f32;
        let ratio = shift / stiffness;
        if ratio != self.ratio {
            self.ratio = ratio;
            self.find_pivots();
        }
    }

    /// The elimination's pivots of every row and frequency.
    fn find_pivots(&mut self) {
        let last = self.reciprocals.len() / self.width - 1;
        self.above.fill(0.0);
        for (row, reciprocals) in self.reciprocals.chunks_exact_mut(self.width).enumerate() {
            // Diagonal without mu: s/c and the number of neighbours above and below.
            let diagonal = self.ratio + f64::from(u8::from(row > 0)) + f64::from(u8::from(row < last));
            for ((reciprocal, above), mu) in reciprocals.iter_mut().zip(&mut self.above).zip(&self.eigenvalues) {
                *above = 1.0 / (diagonal + mu - *above);
                *reciprocal = *above as f32;
            }
        }
        if self.ratio == 0.0 {
            // The last pivot of the constant mode is zero up to rounding: its level is free.
            self.reciprocals[last * self.width] = 0.0;
        }
    }

    /// Replaces the right-hand side in `field` (`width` x `height`) by the solution.
    pub fn solve(&mut self, field: &mut [f32]) {
        let width = self.width;
        for row in field.chunks_exact_mut(width) {
            self.transform.process_dct2_with_scratch(row, &mut self.scratch);
            row.iter_mut().for_each(|value| *value *= self.gain);
        }
        self.eliminate(field);
        for row in field.chunks_exact_mut(width) {
            self.transform.process_dct3_with_scratch(row, &mut self.scratch);
        }
    }

    /// Forward elimination and back substitution down the columns, all frequencies side by side.
    fn eliminate(&self, field: &mut [f32]) {
        let width = self.width;
        let rows = field.len() / width;
        for row in 1..rows {
            let (above, here) = field[(row - 1) * width..(row + 1) * width].split_at_mut(width);
            let reciprocals = &self.reciprocals[(row - 1) * width..row * width];
            for ((value, above), reciprocal) in here.iter_mut().zip(above).zip(reciprocals) {
                *value += *above * reciprocal;
            }
        }
        let last = (rows - 1) * width;
        for (value, reciprocal) in field[last..].iter_mut().zip(&self.reciprocals[last..]) {
            *value *= reciprocal;
        }
        for row in (0..rows - 1).rev() {
            let (here, below) = field[row * width..(row + 2) * width].split_at_mut(width);
            let reciprocals = &self.reciprocals[row * width..(row + 1) * width];
            for ((value, below), reciprocal) in here.iter_mut().zip(below).zip(reciprocals) {
                *value = (*value + *below) * reciprocal;
            }
        }
        if self.ratio == 0.0 {
            let mean = field.iter().step_by(width).map(|&value| f64::from(value)).sum::<f64>() / rows as f64;
            field.iter_mut().step_by(width).for_each(|value| *value -= mean as f32);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// (c L + s) z in f64.
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
        let mut field = apply(width, height, stiffness, shift, &z);
        let mut solver = CosineSolver::new(width, height);
        solver.set(stiffness, shift);
        solver.solve(&mut field);
        field.iter().zip(&z).map(|(a, b)| (f64::from(*a) - b).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn inverts_the_laplacian_of_a_rectangle() {
        for (width, height) in
            [(1, 1), (1, 7), (9, 1), (2, 2), (16, 5), (60, 81), (48, 7), (96, 31), (24, 2), (256, 256)]
        {
            for (stiffness, shift) in [(1.0, 0.0), (0.7, 0.02), (3.0, 1.5)] {
                let error = error(width, height, stiffness, shift);
                assert!(error < 1e-5, "{width}x{height}, c = {stiffness}, s = {shift}: {error:e}");
            }
        }
    }

    #[test]
    fn fast_widths_are_not_much_longer() {
        assert_eq!([1, 7, 11, 64, 97, 150, 612].map(fast_width), [1, 8, 12, 64, 128, 192, 768]);
    }
}
