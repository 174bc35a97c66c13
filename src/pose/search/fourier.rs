//! Two-dimensional Fourier transforms of a square: rows, transposed, rows again.
//!
//! A spectrum stays transposed, which products of two spectra do not mind; the inverse transposes it back. Neither
//! direction divides by the number of cells.

use rustfft::algorithm::Radix4;
use rustfft::{Fft, FftDirection, num_complex::Complex32};

/// A value of a field or of its spectrum.
pub type Complex = Complex32;

/// Plans and scratch of one side length.
pub struct Fourier {
    side: usize,
    forward: Radix4<f32>,
    inverse: Radix4<f32>,
    turned: Vec<Complex>,
    scratch: Vec<Complex>,
}

impl Fourier {
    /// `side` is a power of two.
    pub fn new(side: usize) -> Self {
        let [forward, inverse] = [FftDirection::Forward, FftDirection::Inverse].map(|way| Radix4::new(side, way));
        let scratch = forward.get_inplace_scratch_len().max(inverse.get_inplace_scratch_len());
        let empty = Complex::default();
        Self { side, forward, inverse, turned: vec![empty; side * side], scratch: vec![empty; scratch] }
    }

    /// Field to transposed spectrum, in place.
    pub fn forward(&mut self, field: &mut [Complex]) {
        self.forward.process_with_scratch(field, &mut self.scratch);
        self.transpose(field);
        self.forward.process_with_scratch(field, &mut self.scratch);
    }

    /// Transposed spectrum to field, in place.
    pub fn inverse(&mut self, spectrum: &mut [Complex]) {
        self.inverse.process_with_scratch(spectrum, &mut self.scratch);
        self.transpose(spectrum);
        self.inverse.process_with_scratch(spectrum, &mut self.scratch);
    }

    fn transpose(&mut self, field: &mut [Complex]) {
        self.turned.copy_from_slice(field);
        for (row, line) in field.chunks_exact_mut(self.side).enumerate() {
            for (column, value) in line.iter_mut().enumerate() {
                *value = self.turned[column * self.side + row];
            }
        }
    }
}
