//! log S between pixels: cubic splines over the mask, with gradients (docs/method/registration.md).
//!
//! f(x, y) = sum c_ij b(x - i) b(y - j) with the cubic B-spline b and coefficients that make f pass through every pixel
//! (M. Unser: "Splines: a perfect fit for signal and image processing", IEEE Signal Processing Magazine 16, 1999: one
//! pole, 3^(1/2) - 2, forwards and backwards). The spline is exact at pixels, of fourth order between them, and twice
//! differentiable across them. Off the mask the image is first continued in straight lines, ring by ring, so that the
//! spline meets no step at the border. Values are defined only inside cells whose four pixels are all on the mask.
//!
//! Coarse levels hold the mask-normalised Gaussian mean of log S on the same raster.
//!
//! Limits: an image with detail near one pixel is not band-limited, and no interpolation recovers the values between
//! pixels. The outermost cells depend on the continuation; its influence falls to a quarter with each pixel inwards.

use std::sync::Arc;

use crate::numeric::{LANES, Lanes, Real};
use crate::view::{ColourView, Gaussian, Size};

/// Pole of the inverse filter of the cubic B-spline.
const POLE: f64 = -0.267_949_192_431_122_7;
/// Number of samples after which powers of the pole fall below the rounding of f32: 0.268^14 = 1e-8.
const HORIZON: usize = 14;
/// Number of rings of pixels in the continuation: the spline on the mask depends on the last one by 0.268^8 = 3e-5.
const RINGS: u8 = 8;
/// Number of mirrored samples of a line: one before it, two behind it.
const MIRRORED: usize = 3;

/// Number of lanes for the three colours of a sample. With four pixels in a lane it is one, and the fourth number is
/// ignored.
const CHUNKS: usize = 3_usize.div_ceil(LANES);
/// Length of a line of four samples, plus the one number that the last lanes load beyond them.
const LINE: usize = 4 * 3 + 1;

/// log S of three channels as splines over one mask.
#[derive(Clone, Debug)]
pub(super) struct SplineImage {
    size: Size,
    /// The mean of log S. The splines interpolate the difference from it, so that rounding does not depend on the
    /// exposure.
    mean: f64,
    /// For each pixel: whether the pixel and those right of, below, and diagonally below it are all on the mask.
    cells: Arc<[bool]>,
    /// R, G and B side by side. Each line and column is mirrored by one sample before and two behind, so that the
    /// sixteen coefficients around a cell always exist.
    coefficients: Vec<[f32; 3]>,
}

/// A position on the image: log S of the three channels and d log S / d (column, row).
#[derive(Clone, Copy, Debug)]
pub(super) struct ImagePoint {
    pub log: [f64; 3],
    pub gradient: [[f64; 2]; 3],
}

impl SplineImage {
    /// Splines through the Gaussian mean of a view's log S; `blur` is the sigma in pixels, zero for no blur.
    pub fn new(view: &ColourView, blur: f64) -> Self {
        Self::over(&Arc::from(cells(view)), view.log_mean(), view, blur)
    }

    /// Splines of the same view with another blur.
    pub fn blurred(&self, view: &ColourView, blur: f64) -> Self {
        Self::over(&self.cells, self.mean, view, blur)
    }

    fn over(cells: &Arc<[bool]>, mean: f64, view: &ColourView, blur: f64) -> Self {
        let mut fields = blurred(view, blur);
        fields.iter_mut().flatten().for_each(|log| *log = (f64::from(*log) - mean) as f32);
        continue_outwards(view.size, &mut fields, &view.mask);
        fields.iter_mut().for_each(|field| filter(view.size, field));
        let [red, green, blue] = &fields;
        let samples = (view.size.width + MIRRORED) * (view.size.height + MIRRORED);
        // The line has one more number, because the lanes of the last sample load one number beyond it.
        let mut coefficients = Vec::with_capacity(samples + 1);
        mirrored(view.size.height).for_each(|row| {
            mirrored(view.size.width).for_each(|column| {
                let index = view.size.index(column, row);
                coefficients.push([red[index], green[index], blue[index]]);
            });
        });
        coefficients.push([0.0; 3]);
        Self { size: view.size, mean, cells: Arc::clone(cells), coefficients }
    }

    /// Whether the cell around a position and `margin` pixels beyond it on every side are on the mask.
    pub fn covers(&self, position: [f64; 2], margin: usize) -> bool {
        let Some([left, top]) = self.cell(position) else { return false };
        let (right, low) = (left + margin, top + margin);
        if left < margin || top < margin || right + 1 >= self.size.width || low + 1 >= self.size.height {
            return false;
        }
        (top - margin..=low).all(|r| (left - margin..=right).all(|c| self.cells[self.size.index(c, r)]))
    }

    /// Size of the image.
    pub fn size(&self) -> Size {
        self.size
    }

    /// log S at a continuous position; `None` off the mask.
    pub fn value(&self, position: [f64; 2]) -> Option<[f64; 3]> {
        let [left, top] = self.whole_cell(position)?;
        let across = splat(values(position[0] - left as f64));
        let down = splat(values(position[1] - top as f64));
        let mut log = [Lanes::splat(0.0); CHUNKS];
        for (j, &share) in down.iter().enumerate() {
            add_share(&mut log, share, &sum(&across, self.line(left, top + j)));
        }
        Some(self.colours(log))
    }

    /// log S and its gradient at a continuous position; `None` off the mask.
    pub fn at(&self, position: [f64; 2]) -> Option<ImagePoint> {
        let [left, top] = self.whole_cell(position)?;
        let [along, below] = [position[0] - left as f64, position[1] - top as f64];
        let (across, down) = (splat(values(along)), splat(values(below)));
        let (across_derivative, down_derivative) = (splat(derivatives(along)), splat(derivatives(below)));
        let [mut log, mut by_column, mut by_row] = [[Lanes::splat(0.0); CHUNKS]; 3];
        for j in 0..4 {
            let line = self.line(left, top + j);
            let value = sum(&across, line);
            add_share(&mut log, down[j], &value);
            add_share(&mut by_row, down_derivative[j], &value);
            add_share(&mut by_column, down[j], &sum(&across_derivative, line));
        }
        let (by_column, by_row) = (numbers(by_column), numbers(by_row));
        let gradient = |channel: usize| [by_column[channel], by_row[channel]];
        Some(ImagePoint { log: self.colours(log), gradient: [gradient(0), gradient(1), gradient(2)] })
    }

    fn colours(&self, sums: [Lanes; CHUNKS]) -> [f64; 3] {
        let [red, green, blue] = numbers(sums);
        [red + self.mean, green + self.mean, blue + self.mean]
    }

    /// Four samples of a line around a cell, and one number more.
    #[inline(always)]
    fn line(&self, left: usize, line: usize) -> &[f32] {
        let start = 3 * (line * (self.size.width + MIRRORED) + left);
        self.coefficients.as_flattened().get(start..start + LINE).unwrap_or_default()
    }

    /// The cell around a position if its pixels are all on the mask.
    fn whole_cell(&self, position: [f64; 2]) -> Option<[usize; 2]> {
        self.cell(position).filter(|&[left, top]| self.cells[self.size.index(left, top)])
    }

    /// Left column and top row of the cell around a position on the raster.
    fn cell(&self, [column, row]: [f64; 2]) -> Option<[usize; 2]> {
        let inside = column >= 0.0
            && row >= 0.0
            && column <= (self.size.width - 1) as f64
            && row <= (self.size.height - 1) as f64;
        // The last pixel belongs to the cell before it.
        inside.then(|| [(column as usize).min(self.size.width - 2), (row as usize).min(self.size.height - 2)])
    }
}

/// Indices of a line's samples with mirrored ends: one before, two behind.
fn mirrored(length: usize) -> impl Iterator<Item = usize> + Clone {
    let last = length - 1;
    std::iter::once(1.min(last)).chain(0..length).chain([last.saturating_sub(1), last.saturating_sub(2)])
}

/// Whether a pixel and those right of and below it are on the mask; the last column and row begin no cell.
fn cells(view: &ColourView) -> Vec<bool> {
    let Size { width, height } = view.size;
    let inside = |column: usize, row: usize| view.mask[view.size.index(column, row)];
    let whole = |column: usize, row: usize| {
        column + 1 < width
            && row + 1 < height
            && inside(column, row)
            && inside(column + 1, row)
            && inside(column, row + 1)
            && inside(column + 1, row + 1)
    };
    (0..view.size.len()).map(|index| view.size.position(index)).map(|(column, row)| whole(column, row)).collect()
}

/// The four weights of the cubic B-spline at `t` in 0 .. 1 within a cell.
fn values(t: f64) -> [f64; 4] {
    let u = 1.0 - t;
    let middle = |t: f64| (0.5 * t - 1.0) * t * t + 4.0 / 6.0;
    [u * u * u / 6.0, middle(t), middle(u), t * t * t / 6.0]
}

/// Derivatives of these weights.
fn derivatives(t: f64) -> [f64; 4] {
    let u = 1.0 - t;
    let middle = |t: f64| (1.5 * t - 2.0) * t;
    [-0.5 * u * u, middle(t), -middle(u), 0.5 * t * t]
}

#[inline(always)]
fn splat(weights: [f64; 4]) -> [Lanes; 4] {
    let [first, second, third, fourth] = weights;
    [Lanes::constant(first), Lanes::constant(second), Lanes::constant(third), Lanes::constant(fourth)]
}

/// Weighted sum of the four samples of a line.
#[inline(always)]
fn sum(weights: &[Lanes; 4], line: &[f32]) -> [Lanes; CHUNKS] {
    let mut sums = [Lanes::splat(0.0); CHUNKS];
    for (chunk, sum) in sums.iter_mut().enumerate() {
        let term = |k: usize| weights[k] * Lanes::load(line, (3 * k + chunk * LANES) as isize);
        *sum = (term(0) + term(1)) + (term(2) + term(3));
    }
    sums
}

#[inline(always)]
fn add_share(sums: &mut [Lanes; CHUNKS], share: Lanes, values: &[Lanes; CHUNKS]) {
    sums.iter_mut().zip(values).for_each(|(sum, &value)| *sum = *sum + share * value);
}

/// The numbers of the three colours, without the lanes beyond them.
#[inline(always)]
fn numbers(sums: [Lanes; CHUNKS]) -> [f64; 3] {
    let number = |channel: usize| f64::from(sums[channel / LANES].array()[channel % LANES]);
    [number(0), number(1), number(2)]
}

/// Mask-normalised Gaussian means of the channels; NaN off the mask.
fn blurred(view: &ColourView, sigma: f64) -> [Vec<f32>; 3] {
    if sigma <= 0.0 {
        return view.log.clone();
    }
    Gaussian::new(view.size, sigma, Gaussian::REACH)
        .means(|index| view.mask[index], |channel, index| view.log[channel][index])
        .map(|means| means.into_iter().map(|mean| mean as f32).collect())
}

/// Continues fields beyond their mask. Each new pixel is the mean of the straight lines that reach it from its
/// neighbours, or of their values where a line has only one pixel. Pixels beyond the rings become zero.
fn continue_outwards(size: Size, fields: &mut [Vec<f32>; 3], mask: &[bool]) {
    // Zero on the mask, then the number of the ring; RINGS + 1 marks pixels not yet known.
    let mut rings: Vec<u8> = mask.iter().map(|&inside| if inside { 0 } else { RINGS + 1 }).collect();
    let mut ring: Vec<usize> = (0..mask.len()).filter(|&index| mask[index]).collect();
    for number in 1..=RINGS {
        let mut next = Vec::new();
        for near in ring.into_iter().flat_map(|index| size.neighbours(index)) {
            if rings[near] > RINGS {
                rings[near] = number;
                next.push(near);
            }
        }
        for &index in &next {
            let known = |other: &usize| rings[*other] < number;
            for field in fields.iter_mut() {
                field[index] = continued(size, field, index, known);
            }
        }
        ring = next;
    }
    for field in fields {
        field.iter_mut().zip(&rings).filter(|(_, ring)| **ring > RINGS).for_each(|(value, _)| *value = 0.0);
    }
}

/// Mean of the straight lines from the known neighbours.
fn continued(size: Size, field: &[f32], index: usize, known: impl Fn(&usize) -> bool) -> f32 {
    let (column, row) = size.position(index);
    let (mut sum, mut count) = (0.0, 0.0);
    for (right, down) in [(-1, 0), (1, 0), (0, -1), (0, 1)] {
        let value = |steps: isize| {
            let column = column.checked_add_signed(steps * right).filter(|&c| c < size.width)?;
            let row = row.checked_add_signed(steps * down).filter(|&r| r < size.height)?;
            Some(size.index(column, row)).filter(&known).map(|other| field[other])
        };
        if let Some(first) = value(1) {
            sum += value(2).map_or(first, |second| 2.0 * first - second);
            count += 1.0;
        }
    }
    sum / count
}

/// Turns pixel values into B-spline coefficients in place: rows, then columns.
fn filter(size: Size, field: &mut [f32]) {
    let mut line = vec![0.0; size.width.max(size.height)];
    let mut run = |first: usize, step: usize, length: usize| {
        let line = &mut line[..length];
        line.iter_mut().enumerate().for_each(|(k, value)| *value = f64::from(field[first + k * step]));
        filter_line(line);
        line.iter().enumerate().for_each(|(k, value)| field[first + k * step] = *value as f32);
    };
    (0..size.height).for_each(|row| run(row * size.width, 1, size.width));
    (0..size.width).for_each(|column| run(column, size.width, size.height));
}

/// Recursion along one line with mirrored ends.
fn filter_line(line: &mut [f64]) {
    let last = line.len() - 1;
    let mut power = 1.0;
    let mut start = 0.0;
    for value in line.iter().take(HORIZON) {
        start += power * value;
        power *= POLE;
    }
    line[0] = start;
    for k in 1..=last {
        line[k] += POLE * line[k - 1];
    }
    line[last] = POLE / (POLE * POLE - 1.0) * (line[last] + POLE * line[last - 1]);
    for k in (0..last).rev() {
        line[k] = POLE * (line[k + 1] - line[k]);
    }
    line.iter_mut().for_each(|value| *value *= 6.0);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{ColourImage, ColourSamples};

    /// A disc of smooth colours on 48 x 40 pixels.
    fn view() -> ColourView {
        let size = Size { width: 48, height: 40 };
        let (mut data, mut mask) = (Vec::new(), Vec::new());
        for index in 0..size.len() {
            let (column, row) = size.position(index);
            data.extend(colour([column as f64, row as f64]).map(|value| value.exp() as f32));
            mask.push(u8::from((column as f64 - 23.0).hypot(row as f64 - 19.0) < 17.0));
        }
        let image = ColourImage {
            width: size.width,
            height: size.height,
            samples: ColourSamples::RgbLinear(data),
            transfer: None,
            mask: Some(mask),
            camera: None,
        };
        ColourView::new(image).unwrap()
    }

    fn colour([x, y]: [f64; 2]) -> [f64; 3] {
        [(0.3 * x).sin() + 0.02 * y, (0.2 * x + 0.25 * y).cos(), 0.1 * x - 0.05 * y]
    }

    #[test]
    fn pixels_are_met_and_what_lies_between_is_of_fourth_order() {
        let view = view();
        let image = SplineImage::new(&view, 0.0);
        for index in (0..view.size.len()).filter(|&index| view.mask[index]) {
            let (column, row) = view.size.position(index);
            let Some(point) = image.at([column as f64, row as f64]) else { continue };
            for (log, expected) in point.log.iter().zip(view.log_at(index)) {
                assert!((log - f64::from(expected)).abs() < 2e-6);
            }
        }
        for place in [[20.3, 17.8], [25.5, 22.5], [30.1, 12.9]] {
            let point = image.at(place).unwrap();
            for (log, expected) in point.log.iter().zip(colour(place)) {
                assert!((log - expected).abs() < 1e-4, "{log} {expected}");
            }
        }
    }

    #[test]
    fn gradients_are_the_difference_quotients() {
        let image = SplineImage::new(&view(), 1.0);
        // Values are rounded to f32, so a difference over a smaller step would show only rounding.
        let small = 0.02;
        for [x, y] in [[20.3, 17.8], [25.0, 22.0], [30.1, 12.9], [9.4, 14.3]] {
            let point = image.at([x, y]).unwrap();
            for channel in 0..3 {
                let along = |a: [f64; 2], b: [f64; 2]| {
                    (image.at(b).unwrap().log[channel] - image.at(a).unwrap().log[channel]) / (2.0 * small)
                };
                let [gx, gy] = point.gradient[channel];
                assert!((gx - along([x - small, y], [x + small, y])).abs() <= 2e-5);
                assert!((gy - along([x, y - small], [x, y + small])).abs() <= 2e-5);
            }
        }
    }

    #[test]
    fn there_is_nothing_off_the_mask_and_less_within_a_margin() {
        let image = SplineImage::new(&view(), 0.0);
        assert!(
            image.at([2.0, 2.0]).is_none() && image.at([-1.0, 20.0]).is_none() && image.at([f64::NAN; 2]).is_none()
        );
        assert!(image.covers([8.5, 19.2], 0) && !image.covers([8.5, 19.2], 3) && image.covers([23.0, 19.0], 8));
    }
}
