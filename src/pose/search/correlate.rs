//! Scores of a template at all translations at once, by correlation: (T * I)(tau) = sum_x T(x) I(x + tau).
//!
//! Unknown light: with harmonics q_k that are orthonormal over the whole template, the explained sum of squares is
//! sum_k |q_k * y|^2 for k > 0, out of N * |y|^2 - |q_0 * y|^2. Known light: the squares of y - p expand into five
//! correlations. Both only propose translations, because harmonics orthonormal over the whole template are not
//! orthonormal over an overlap; the exact [`score`](super::score) chooses among the proposals. Two real fields share
//! each transform: the transform of f_0 + i f_1, correlated with a real field, holds the correlation of f_0 in its real
//! part and that of f_1, negated, in its imaginary part.
//!
//! Cost: 21 transforms for an unknown light, 25 with local contrast, 5 for a known light.

use super::score::{FEWEST_CELLS, Gram, Prediction, regularised};
use super::target::{CELLS, Fourier, SIDE, Target};
use super::template::Template;
use super::values::{WITH_RELIEF, products};
use crate::light::HARMONICS;
use crate::numeric::fourier::planes::{Field, opposite};
use nalgebra::Complex;

/// 1 / number of cells, because neither a transform nor its inverse divides by it.
const NORM: f32 = 1.0 / CELLS as f32;
/// Number of translations proposed for each rotation, among which the exact score chooses.
const PROPOSALS: usize = 3;
/// Smallest share of the template, or of the mask if that is smaller, that a translation has to bring into overlap.
const LEAST_TEMPLATE_OVERLAP: f32 = 0.15;
/// Number of complex fields for the values of a template, two in each.
const fn pairs(channels: usize) -> usize {
    channels.div_ceil(2)
}
/// Largest number of fields.
const PAIRS: usize = pairs(WITH_RELIEF);
/// Lower bound of sums of squares, in squares of balanced colours. It keeps their quotient and logarithm finite.
const LEAST_SQUARE: f32 = 1e-3;

/// Correlates templates with a target; owns its memory.
pub struct Correlator {
    fourier: Fourier,
    /// Index of the opposite frequency.
    mirror: Vec<u32>,
    fields: [Field; PAIRS],
    products: [Field; 2],
    /// Explained squares, then scores.
    scores: Vec<f32>,
    mean: Vec<f32>,
}

impl Correlator {
    pub fn new(fourier: Fourier) -> Self {
        Self {
            fourier,
            mirror: (0..CELLS).map(|index| opposite::<SIDE>(index) as u32).collect(),
            fields: std::array::from_fn(|_| Field::zero(CELLS)),
            products: std::array::from_fn(|_| Field::zero(CELLS)),
            scores: vec![0.0; CELLS],
            mean: vec![0.0; CELLS],
        }
    }

    /// The best translations in whole cells. Allocates nothing.
    pub fn proposals(
        &mut self,
        template: &Template,
        prediction: Option<&Prediction>,
        target: &Target,
    ) -> impl Iterator<Item = [i32; 2]> + use<> {
        let scored = match prediction {
            None if template.is_by_contrast() => self.score_fits::<WITH_RELIEF>(template, target),
            None => self.score_fits::<HARMONICS>(template, target),
            Some(prediction) => {
                self.score_prediction(template, prediction, target);
                Some(())
            }
        };
        let peaks = if scored.is_some() { self.peaks(target.side) } else { [None; PROPOSALS] };
        let side = target.side as i32;
        let signed = move |place: i32| if 2 * place >= side { place - side } else { place };
        peaks.into_iter().flatten().map(move |cell| [signed(cell as i32 % side), signed(cell as i32 / side)])
    }

    /// Computes the scores of all translations under an unknown light.
    fn score_fits<const C: usize>(&mut self, template: &Template, target: &Target) -> Option<()> {
        let weight = self.whitened::<C>(template)?;
        self.fields[..pairs(C)].iter_mut().for_each(|field| self.fourier.forward(field));
        self.scores.fill(0.0);
        self.mean.fill(0.0);
        for pair in 0..pairs(C) {
            for colour in &target.spectra.colour {
                self.pair_with_channel(pair, colour);
            }
        }
        // Coverage and |y|^2 under the template: q_0 is w over the root of its sum.
        let (spectra, [product, _]) = (&target.spectra, &mut self.products);
        for index in 0..CELLS {
            let (re, im) = even(&self.fields[0], index, self.mirror[index]);
            let (re, im) = (weight * re, weight * im);
            let (a, b) = plus_i(&spectra.mask, &spectra.square, index);
            (product.re[index], product.im[index]) = (re * a - im * b, re * b + im * a);
        }
        self.fourier.inverse(product);
        let least = least_cover(template, target);
        for index in 0..CELLS {
            let (cover, square) = (product.re[index] * NORM, product.im[index] * NORM);
            let total = square - self.mean[index] * NORM * NORM;
            let explained = self.scores[index] * NORM * NORM;
            let share = (explained / total.max(LEAST_SQUARE)).min(1.0);
            self.scores[index] = if cover < least { f32::NEG_INFINITY } else { share * cover };
        }
        Some(())
    }

    /// Fills the fields with values that are orthonormal over the template, two in each. Returns the root of the
    /// template's weight.
    fn whitened<const C: usize>(&mut self, template: &Template) -> Option<f32> {
        let mut gram = [0.0_f32; products(WITH_RELIEF)];
        for of_cell in &template.products {
            gram[..products(C)].iter_mut().zip(of_cell).for_each(|(sum, product)| *sum += product);
        }
        let lower = regularised::<C>(&gram).cholesky()?.unpack();
        let inverse = lower.solve_lower_triangular(&Gram::identity())?.map(|value| value as f32);
        // Columns of the inverse, padded to the number of places in the pairs.
        let mut columns = [[0.0; 2 * PAIRS]; C];
        (0..C).for_each(|k| columns[k][..C].copy_from_slice(inverse.column(k).as_slice()));
        self.fields[..pairs(C)].iter_mut().for_each(Field::clear);
        for &cell in &template.cells {
            let cell = cell as usize;
            let mut whitened = [0.0; 2 * PAIRS];
            for (column, sum) in columns.iter().zip(&template.sums[cell]) {
                whitened.iter_mut().zip(column).for_each(|(value, share)| *value += share * sum);
            }
            for (pair, field) in self.fields[..pairs(C)].iter_mut().enumerate() {
                (field.re[cell], field.im[cell]) = (whitened[2 * pair], whitened[2 * pair + 1]);
            }
        }
        Some(lower[(0, 0)] as f32)
    }

    /// Adds (q * y)^2 of both harmonics of a pair.
    fn pair_with_channel(&mut self, pair: usize, colour: &Field) {
        let product = &mut self.products[0];
        multiply_conjugate(&self.fields[pair], colour, product);
        self.fourier.inverse(product);
        let squares = |sums: &mut [f32], values: &[f32]| {
            sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value * value);
        };
        squares(if pair == 0 { &mut self.mean } else { &mut self.scores }, &product.re);
        squares(&mut self.scores, &product.im);
    }

    /// Computes the scores of all translations under a known light. The fields are w p_0 + i w p_1, w p_2 + i w and w
    /// |p|^2 + i w u . p, where u is the direction of the exposure.
    fn score_prediction(&mut self, template: &Template, prediction: &Prediction, target: &Target) {
        let exposure = prediction.exposure.map(|value| value as f32);
        self.fields[..3].iter_mut().for_each(Field::clear);
        let mut set = |field: usize, cell: u32, re: f32, im: f32| {
            let field = &mut self.fields[field];
            (field.re[cell as usize], field.im[cell as usize]) = (re, im);
        };
        for (&cell, &[x, y, z]) in template.cells.iter().zip(&prediction.colours) {
            let weight = template.sums[cell as usize][0];
            let along = exposure[0] * x + exposure[1] * y + exposure[2] * z;
            set(0, cell, x * weight, y * weight);
            set(1, cell, z * weight, weight);
            set(2, cell, (x * x + y * y + z * z) * weight, along * weight);
        }
        self.fields[..3].iter_mut().for_each(|field| self.fourier.forward(field));
        let spectra = &target.spectra;
        let [product, cover] = &mut self.products;
        for index in 0..CELLS {
            let at = |field: &Field| Complex::new(field.re[index], field.im[index]);
            let split = |field: &Field| {
                let mirror = self.mirror[index];
                let (even, odd) = (even(field, index, mirror), odd(field, index, mirror));
                (Complex::new(even.0, even.1), Complex::new(odd.0, odd.1))
            };
            let (x, y) = split(&self.fields[0]);
            let (z, weight) = split(&self.fields[1]);
            let (square, along) = split(&self.fields[2]);
            let [c0, c1, c2] = spectra.colour.each_ref().map(at);
            let mask = at(&spectra.mask);
            let squares = weight * at(&spectra.square) + square * mask - (x * c0 + y * c1 + z * c2) * 2.0;
            let shifted = weight * (c0 * exposure[0] + c1 * exposure[1] + c2 * exposure[2]) - along * mask;
            (product.re[index], product.im[index]) = (squares.re - shifted.im, squares.im + shifted.re);
            let seen = weight * mask;
            (cover.re[index], cover.im[index]) = (seen.re, seen.im);
        }
        self.products.iter_mut().for_each(|product| self.fourier.inverse(product));
        let least = least_cover(template, target);
        for index in 0..CELLS {
            let cover = self.products[1].re[index] * NORM;
            let (squares, shifted) = (self.products[0].re[index] * NORM, self.products[0].im[index] * NORM);
            let mean = ((squares - shifted * shifted / cover) / cover).max(0.0);
            self.scores[index] = if cover < least { f32::NEG_INFINITY } else { -(mean + LEAST_SQUARE).ln() * cover };
        }
    }

    /// Cells of the highest scores that no neighbour exceeds, best first.
    fn peaks(&self, side: usize) -> [Option<usize>; PROPOSALS] {
        let mut peaks = [None; PROPOSALS];
        for index in 0..self.scores.len() {
            let score = self.scores[index];
            let (column, row) = (index % side, index / side);
            let [left, right] = [(column + side - 1) % side, (column + 1) % side];
            let [up, down] = [(row + side - 1) % side, (row + 1) % side];
            let lower = |column: usize, row: usize| self.scores[row * side + column] <= score;
            let is_peak = lower(left, row) && lower(right, row) && lower(column, up) && lower(column, down);
            if score == f32::NEG_INFINITY || !is_peak {
                continue;
            }
            let rank = peaks.iter().position(|peak: &Option<usize>| peak.is_none_or(|peak| self.scores[peak] < score));
            if let Some(rank) = rank {
                peaks[rank..].rotate_right(1);
                peaks[rank] = Some(index);
            }
        }
        peaks
    }
}

/// Smallest number of overlapping cells.
fn least_cover(template: &Template, target: &Target) -> f32 {
    (LEAST_TEMPLATE_OVERLAP * template.visible.min(target.covered)).max(FEWEST_CELLS)
}

/// conj(f) g, cell by cell.
fn multiply_conjugate(f: &Field, g: &Field, product: &mut Field) {
    let (re, im) = (&mut product.re[..CELLS], &mut product.im[..CELLS]);
    let [a, b, c, d] = [&f.re[..CELLS], &f.im[..CELLS], &g.re[..CELLS], &g.im[..CELLS]];
    for k in 0..CELLS {
        re[k] = a[k] * c[k] + b[k] * d[k];
        im[k] = a[k] * d[k] - b[k] * c[k];
    }
}

/// The conjugate spectrum of the real part of a field, from the spectrum of the field.
fn even(field: &Field, index: usize, mirror: u32) -> (f32, f32) {
    let mirror = mirror as usize;
    (0.5 * (field.re[index] + field.re[mirror]), 0.5 * (field.im[mirror] - field.im[index]))
}

/// The conjugate spectrum of the imaginary part of a field, from the spectrum of the field.
fn odd(field: &Field, index: usize, mirror: u32) -> (f32, f32) {
    let mirror = mirror as usize;
    (0.5 * (field.im[index] + field.im[mirror]), 0.5 * (field.re[index] - field.re[mirror]))
}

/// Spectrum of a + i b from the spectra of a and b.
fn plus_i(a: &Field, b: &Field, index: usize) -> (f32, f32) {
    (a.re[index] - b.im[index], a.im[index] + b.re[index])
}
