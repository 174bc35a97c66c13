//! Two-dimensional Fourier transforms of a square: down the columns, transposed, down the columns again.
//!
//! Real and imaginary parts are separate planes, and each butterfly works on two whole lines of them in straight loops,
//! which simd128 runs four numbers at a time. The forward transform decimates in frequency and leaves the spectrum
//! transposed and in bit-reversed order, which does not affect products of two spectra. The inverse decimates in time
//! and takes the same steps backwards. Neither direction divides by the number of cells.
//!
//! Why not rustfft (6.4): a square of 32x32 and back takes 12.6 us instead of 7.6 with simd128 (Node 20). Its own SIMD for
//! WebAssembly takes 6.9 us, but the module for engines without SIMD must not contain that code.

use super::roots::{Root, root};

/// One line of the real part and the same line of the imaginary part.
type Lines<'a, const SIDE: usize> = [&'a mut [f32; SIDE]; 2];

/// A complex field or its spectrum, row by row.
#[derive(Clone)]
pub struct Field {
    pub re: Vec<f32>,
    pub im: Vec<f32>,
}

impl Field {
    /// A field of zeros with this many cells.
    pub fn zero(cells: usize) -> Self {
        Self { re: vec![0.0; cells], im: vec![0.0; cells] }
    }

    pub fn clear(&mut self) {
        self.re.fill(0.0);
        self.im.fill(0.0);
    }
}

/// Transforms of squares with this side in cells, a power of two; owns its roots and scratch memory.
pub struct PlaneFourier<const SIDE: usize> {
    /// exp(-2 pi i k / SIDE) for k < SIDE / 2.
    roots: Vec<Root>,
    spare: Vec<f32>,
}

impl<const SIDE: usize> PlaneFourier<SIDE> {
    pub fn new() -> Self {
        let roots = (0..SIDE / 2).map(|k| root(k, SIDE)).collect();
        Self { roots, spare: vec![0.0; SIDE * SIDE] }
    }

    /// Field to spectrum, in place.
    pub fn forward(&mut self, field: &mut Field) {
        self.decimate(field);
        self.transpose(field);
        self.decimate(field);
    }

    /// Spectrum to field, in place.
    pub fn inverse(&mut self, spectrum: &mut Field) {
        self.assemble(spectrum);
        self.transpose(spectrum);
        self.assemble(spectrum);
    }

    fn decimate(&self, field: &mut Field) {
        let mut half = SIDE / 2;
        while half > 0 {
            self.butterflies(field, half, part);
            half /= 2;
        }
    }

    fn assemble(&self, field: &mut Field) {
        let mut half = 1;
        while half < SIDE {
            self.butterflies(field, half, join);
            half *= 2;
        }
    }

    /// Applies a butterfly to all pairs of lines that are `half` apart.
    fn butterflies(&self, field: &mut Field, half: usize, one: impl Fn(Lines<'_, SIDE>, Lines<'_, SIDE>, Root)) {
        let (re, im) = (field.re.as_chunks_mut().0, field.im.as_chunks_mut().0);
        for (re, im) in re.chunks_exact_mut(2 * half).zip(im.chunks_exact_mut(2 * half)) {
            let ((re_top, re_low), (im_top, im_low)) = (re.split_at_mut(half), im.split_at_mut(half));
            for k in 0..half {
                let root = self.roots[k * (SIDE / 2 / half)];
                one([&mut re_top[k], &mut im_top[k]], [&mut re_low[k], &mut im_low[k]], root);
            }
        }
    }

    fn transpose(&mut self, field: &mut Field) {
        for plane in [&mut field.re, &mut field.im] {
            self.spare.copy_from_slice(plane);
            let from: &[[f32; SIDE]] = self.spare.as_chunks().0;
            for (row, line) in plane.as_chunks_mut::<SIDE>().0.iter_mut().enumerate() {
                (0..SIDE).for_each(|column| line[column] = from[column][row]);
            }
        }
    }
}

/// Index at which a spectrum holds the frequency opposite to the one at `index`.
pub fn opposite<const SIDE: usize>(index: usize) -> usize {
    let reversed = |k: usize| k.reverse_bits() >> (usize::BITS - SIDE.trailing_zeros());
    let of = |k: usize| reversed((SIDE - reversed(k)) % SIDE);
    of(index / SIDE) * SIDE + of(index % SIDE)
}

/// (a, b) -> (a + b, (a - b) root).
fn part<const SIDE: usize>([re, im]: Lines<'_, SIDE>, [low_re, low_im]: Lines<'_, SIDE>, [cos, sin]: Root) {
    for k in 0..SIDE {
        let (x, y) = (re[k] - low_re[k], im[k] - low_im[k]);
        re[k] += low_re[k];
        im[k] += low_im[k];
        low_re[k] = x * cos - y * sin;
        low_im[k] = x * sin + y * cos;
    }
}

/// (a, b) -> (a + b / root, a - b / root).
fn join<const SIDE: usize>([re, im]: Lines<'_, SIDE>, [low_re, low_im]: Lines<'_, SIDE>, [cos, sin]: Root) {
    for k in 0..SIDE {
        let (x, y) = (low_re[k] * cos + low_im[k] * sin, low_im[k] * cos - low_re[k] * sin);
        low_re[k] = re[k] - x;
        low_im[k] = im[k] - y;
        re[k] += x;
        im[k] += y;
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    use super::*;

    const SIDE: usize = 32;
    const CELLS: usize = SIDE * SIDE;

    /// The wave exp(-2 pi i (3 column + 5 row) / SIDE), forwards and backwards, and its single frequency.
    #[test]
    fn a_wave_has_one_frequency_and_comes_back() {
        let mut field = Field::zero(CELLS);
        for index in 0..CELLS {
            let angle = TAU * (3 * (index % SIDE) + 5 * (index / SIDE)) as f64 / SIDE as f64;
            (field.re[index], field.im[index]) = (angle.cos() as f32, angle.sin() as f32);
        }
        let (wave, mut fourier) = (field.clone(), PlaneFourier::<SIDE>::new());
        fourier.forward(&mut field);
        let large: Vec<usize> = (0..CELLS).filter(|&k| field.re[k].hypot(field.im[k]) > 1e-2).collect();
        assert_eq!(large.len(), 1);
        assert!((field.re[large[0]] - CELLS as f32).abs() < 1e-2);
        fourier.inverse(&mut field);
        for index in 0..CELLS {
            assert!((field.re[index] / CELLS as f32 - wave.re[index]).abs() < 1e-5);
            assert!((field.im[index] / CELLS as f32 - wave.im[index]).abs() < 1e-5);
        }
    }

    /// A real field has conjugate values at opposite frequencies.
    #[test]
    fn opposite_frequencies_of_a_real_field_are_conjugate() {
        let mut field = Field::zero(CELLS);
        (0..CELLS).for_each(|k| field.re[k] = ((k * k) % 17) as f32);
        PlaneFourier::<SIDE>::new().forward(&mut field);
        for index in 0..CELLS {
            let other = opposite::<SIDE>(index);
            assert!(
                (field.re[index] - field.re[other]).abs() < 0.01 && (field.im[index] + field.im[other]).abs() < 0.01
            );
        }
    }
}
