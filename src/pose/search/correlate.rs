//! Scores of a template at all translations at once, by correlation: (T * I)(tau) = sum_x T(x) I(x + tau).
//!
//! Unknown light: with harmonics q_k made orthonormal over the whole template, the explained sum of squares is
//! sum_k |q_k * y|^2 for k > 0, out of N * |y|^2 - |q_0 * y|^2. Known light: the squares of y - p expand into five
//! correlations. Both only propose translations: orthonormal over the whole template is not orthonormal over an overlap,
//! and [`judge`](super::judge) has the last word. Two real fields share each transform.
//!
//! Cost: 20 transforms for an unknown light, 5 for a known one.

use super::fourier::{Complex, Fourier};
use super::judge::{FEWEST_CELLS, Gram, Prediction, regularised};
use super::target::Target;
use super::template::{PRODUCTS, Template};
use crate::light::HARMONICS;

/// Translations proposed for each rotation; the exact score picks one of them.
const PROPOSALS: usize = 3;
/// Least share of the template, or of the mask where that is smaller, that a translation has to bring into overlap.
const LEAST_OVERLAP: f32 = 0.15;
/// Complex fields that hold the nine harmonics, two in each.
const PAIRS: usize = HARMONICS.div_ceil(2);
/// Keeps logarithm and quotient of squares finite, in squares of balanced colours.
const LEAST_SQUARE: f32 = 1e-3;

/// Memory of the correlations.
pub struct Correlator {
    fourier: Fourier,
    /// Index of the opposite frequency.
    mirror: Vec<u32>,
    fields: [Vec<Complex>; PAIRS],
    products: [Vec<Complex>; 2],
    /// Explained squares, then scores.
    scores: Vec<f32>,
    mean: Vec<f32>,
}

impl Correlator {
    pub fn new(side: usize, fourier: Fourier) -> Self {
        let cells = side * side;
        let field = || vec![Complex::default(); cells];
        let opposite = |index: usize| (side - index) % side;
        let mirror = |index: usize| (opposite(index / side) * side + opposite(index % side)) as u32;
        Self {
            fourier,
            mirror: (0..cells).map(mirror).collect(),
            fields: std::array::from_fn(|_| field()),
            products: std::array::from_fn(|_| field()),
            scores: vec![0.0; cells],
            mean: vec![0.0; cells],
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
            None => self.fitted(template, target),
            Some(prediction) => {
                self.predicted(template, prediction, target);
                Some(())
            }
        };
        let peaks = if scored.is_some() { self.peaks(target.side) } else { [None; PROPOSALS] };
        let side = target.side as i32;
        let signed = move |place: i32| if 2 * place >= side { place - side } else { place };
        peaks.into_iter().flatten().map(move |cell| [signed(cell as i32 % side), signed(cell as i32 / side)])
    }

    fn fitted(&mut self, template: &Template, target: &Target) -> Option<()> {
        let weight = self.whitened(template)?;
        self.fields.iter_mut().for_each(|field| self.fourier.forward(field));
        self.scores.fill(0.0);
        self.mean.fill(0.0);
        for pair in 0..PAIRS {
            self.pair_with_two_channels(pair, target);
            self.pair_with_third_channel(pair, target);
        }
        // Coverage and |y|^2 under the template: q_0 is w over the root of its sum.
        let spectra = &target.spectra;
        for index in 0..self.mirror.len() {
            let opposite = self.fields[0][self.mirror[index] as usize];
            let first = (self.fields[0][index].conj() + opposite) * (0.5 * weight);
            self.products[0][index] = first * plus_i(spectra.mask[index], spectra.energy[index]);
        }
        self.fourier.inverse(&mut self.products[0]);
        let least = least_cover(template, target);
        let norm = 1.0 / self.mirror.len() as f32;
        for index in 0..self.scores.len() {
            let Complex { re: cover, im: energy } = self.products[0][index] * norm;
            let total = energy - self.mean[index] * norm * norm;
            let explained = self.scores[index] * norm * norm;
            let share = (explained / total.max(LEAST_SQUARE)).min(1.0);
            self.scores[index] = if cover < least { f32::NEG_INFINITY } else { share * cover };
        }
        Some(())
    }

    /// Harmonics made orthonormal over the template, two in each field; returns the root of the template's weight.
    fn whitened(&mut self, template: &Template) -> Option<f32> {
        let mut gram = [0.0_f32; PRODUCTS];
        for products in &template.products {
            gram.iter_mut().zip(products).for_each(|(sum, product)| *sum += product);
        }
        let lower = regularised(&gram).cholesky()?.unpack();
        let inverse = lower.solve_lower_triangular(&Gram::identity())?.map(|value| value as f32);
        self.fields.iter_mut().for_each(|field| field.fill(Complex::default()));
        for (cell, sums) in template.cells.iter().map(|&cell| (cell as usize, &template.sums[cell as usize])) {
            let whitened = |k: usize| (0..=k).map(|column| inverse[(k, column)] * sums[column]).sum::<f32>();
            for (pair, field) in self.fields.iter_mut().enumerate() {
                let odd = if 2 * pair + 1 < HARMONICS { whitened(2 * pair + 1) } else { 0.0 };
                field[cell] = Complex::new(whitened(2 * pair), odd);
            }
        }
        Some(lower[(0, 0)] as f32)
    }

    /// Adds |q * (y_0 + i y_1)|^2 of both harmonics of a pair.
    fn pair_with_two_channels(&mut self, pair: usize, target: &Target) {
        let [first, second, _] = &target.spectra.colour;
        let [even, odd] = &mut self.products;
        for index in 0..self.mirror.len() {
            let (here, opposite) = (self.fields[pair][index].conj(), self.fields[pair][self.mirror[index] as usize]);
            let colour = plus_i(first[index], second[index]) * 0.5;
            even[index] = (here + opposite) * colour;
            odd[index] = times_i(here - opposite) * colour;
        }
        for (parity, product) in self.products.iter_mut().enumerate().take(HARMONICS - 2 * pair) {
            self.fourier.inverse(product);
            let sums = if pair + parity == 0 { &mut self.mean } else { &mut self.scores };
            sums.iter_mut().zip(product).for_each(|(sum, value)| *sum += value.norm_sqr());
        }
    }

    /// Adds (q * y_2)^2 of both harmonics of a pair.
    fn pair_with_third_channel(&mut self, pair: usize, target: &Target) {
        let product = &mut self.products[0];
        for index in 0..self.mirror.len() {
            product[index] = self.fields[pair][index].conj() * target.spectra.colour[2][index];
        }
        self.fourier.inverse(product);
        for (index, value) in product.iter().enumerate() {
            let even = if pair == 0 { &mut self.mean } else { &mut self.scores };
            even[index] += value.re * value.re;
            self.scores[index] += value.im * value.im;
        }
    }

    /// Fields w p_0 + i w p_1, w p_2 + i w and w |p|^2 + i w u . p, with u the direction of the exposure.
    fn predicted(&mut self, template: &Template, prediction: &Prediction, target: &Target) {
        let exposure = prediction.exposure.map(|value| value as f32);
        self.fields[..3].iter_mut().for_each(|field| field.fill(Complex::default()));
        for (&cell, &[x, y, z]) in template.cells.iter().zip(&prediction.colours) {
            let weight = template.sums[cell as usize][0];
            let along = exposure[0] * x + exposure[1] * y + exposure[2] * z;
            self.fields[0][cell as usize] = Complex::new(x, y) * weight;
            self.fields[1][cell as usize] = Complex::new(z, 1.0) * weight;
            self.fields[2][cell as usize] = Complex::new(x * x + y * y + z * z, along) * weight;
        }
        self.fields[..3].iter_mut().for_each(|field| self.fourier.forward(field));
        let spectra = &target.spectra;
        for index in 0..self.mirror.len() {
            let opposite = self.mirror[index] as usize;
            let split = |field: &[Complex]| {
                let (here, opposite) = (field[index].conj(), field[opposite]);
                ((here + opposite) * 0.5, times_i(here - opposite) * 0.5)
            };
            let (x, y) = split(&self.fields[0]);
            let (z, weight) = split(&self.fields[1]);
            let (square, along) = split(&self.fields[2]);
            let (c0, c1, c2) = (spectra.colour[0][index], spectra.colour[1][index], spectra.colour[2][index]);
            let mask = spectra.mask[index];
            let squares = weight * spectra.energy[index] + square * mask - (x * c0 + y * c1 + z * c2) * 2.0;
            let shifted = weight * (c0 * exposure[0] + c1 * exposure[1] + c2 * exposure[2]) - along * mask;
            self.products[0][index] = plus_i(squares, shifted);
            self.products[1][index] = weight * mask;
        }
        self.products.iter_mut().for_each(|product| self.fourier.inverse(product));
        let least = least_cover(template, target);
        let norm = 1.0 / self.mirror.len() as f32;
        for index in 0..self.scores.len() {
            let cover = self.products[1][index].re * norm;
            let Complex { re: squares, im: shifted } = self.products[0][index] * norm;
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
            let near = lower(left, row) && lower(right, row) && lower(column, up) && lower(column, down);
            if score == f32::NEG_INFINITY || !near {
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

/// Cells that have to overlap.
fn least_cover(template: &Template, target: &Target) -> f32 {
    (LEAST_OVERLAP * template.visible.min(target.covered)).max(FEWEST_CELLS)
}

/// a + i b.
fn plus_i(a: Complex, b: Complex) -> Complex {
    Complex::new(a.re - b.im, a.im + b.re)
}

/// i a.
fn times_i(a: Complex) -> Complex {
    Complex::new(-a.im, a.re)
}
