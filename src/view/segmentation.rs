//! A suggested mask of the object in a colour image, from a rectangle around it or from a few strokes.
//!
//! Method: the random walker with prior models (Grady 2005) in the rounds of GrabCut (Rother, Kolmogorov and Blake
//! 2004). A round measures the histograms of the colours of object and background, then minimises
//!
//! sum_i (p_i (1 - x_i)^2 + (1 - p_i) x_i^2) / REACH^2 + sum_ij w_ij (x_i - x_j)^2
//!
//! over the share x_i of the object in each pixel, where p_i is the share that only the pixel's colour suggests, and
//! w_ij = exp(-|c_i - c_j|^2 / (2 mean |c - c'|^2)) couples neighbours of similar colour. Pixels with x above one half
//! are the object of the next round. The sum is quadratic, so conjugate gradients find its only minimum.
//!
//! Why no library: no well-kept crate or npm package offers GrabCut without OpenCV (8 MB), and general crates for
//! maximal flows hold a graph in hash maps.
//!
//! Limits: an object whose colours are those of the background is not found; strokes help only near themselves. Pictures
//! beyond [`LONGEST`] are segmented at a lower resolution.

use std::ops::Range;

use super::couplings::{Couplings, MARKED, REACH};
use super::mask::{FEWEST_PIXELS, components};
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::conjugate_gradient::{Limits, System, Vectors, solve};
use crate::view::Size;

/// Longest side in pixels at which colours are compared. In larger pictures a pixel stands for a block, eight pixels
/// wide at 12 megapixels, which is narrower than a brush.
const LONGEST: usize = 512;
/// Bins along each colour channel. 16 of them distinguish shades and fill with the pixels of a small object.
const BINS: usize = 16;
/// Share of both histograms that is spread over all colours, so that a colour that occurs in neither of them decides
/// nothing.
const UNSEEN: f32 = 0.01;
/// Largest number of rounds; GrabCut mostly settles after five to ten.
const ROUNDS: u32 = 12;
/// A round is the last if it changes at most this share of the pixels.
const RESTING: f64 = 1e-3;
/// Share of the object's area below which an island or a hole is noise.
const SPECK: f64 = 0.01;
/// Largest number of iterations of the solve in a round, which needs x to a hundredth.
const SOLVE: Limits = Limits { iterations: 80, error: 0.0, relative_error: 1e-4, decrease: 0.0 };

/// The knowledge about a pixel, in the order of OpenCV's GrabCutClasses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// Certainly background.
    Background,
    /// Certainly the object.
    Object,
    /// Background as long as nothing else is known.
    ProbablyBackground,
    /// The object as long as nothing else is known.
    ProbablyObject,
}

impl Mark {
    const ALL: [Self; 4] = [Self::Background, Self::Object, Self::ProbablyBackground, Self::ProbablyObject];

    const fn is_object(self) -> bool {
        matches!(self, Self::Object | Self::ProbablyObject)
    }

    const fn is_certain(self) -> bool {
        matches!(self, Self::Background | Self::Object)
    }
}

/// The progress of a segmentation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SegmentationReport {
    /// Rounds so far.
    pub rounds: u32,
    /// Share of the pixels that the last round changed.
    pub changed: f64,
    /// Share of the picture that is the object.
    pub share: f64,
    /// Whether another round would change little, or none is allowed.
    pub is_done: bool,
}

/// A segmentation, one round after the other.
pub struct Segmentation {
    size: Size,
    /// The size at which colours are compared, and the pixels of the picture for which one of its pixels stands.
    small: Size,
    factor: usize,
    /// Bin of each small pixel.
    bins: Vec<u16>,
    marks: Vec<Mark>,
    is_object: Vec<bool>,
    /// x of each small pixel.
    shares: Vec<f32>,
    couplings: Couplings,
    scratch: [Vec<f32>; 3],
    rounds: u32,
    changed: f64,
}

impl Segmentation {
    /// `colours` are R, G, B, A of each pixel with 8 bits of sRGB, `marks` the numbers of [`Mark`].
    ///
    /// # Errors
    /// [`ErrorKind::Size`] if an array has another length or a side is zero, [`ErrorKind::Range`] for an unknown mark,
    /// [`ErrorKind::Empty`] if the marks hold fewer than 16 pixels of object or of background.
    pub fn new(size: Size, colours: &[u8], marks: &[u8]) -> Result<Self> {
        check(size, colours, marks)?;
        let factor = size.width.max(size.height).div_ceil(LONGEST);
        let small = Size { width: size.width.div_ceil(factor), height: size.height.div_ceil(factor) };
        let blocks = || (0..small.len()).map(|index| block(size, small, factor, index));
        let means: Vec<[f32; 3]> = blocks().map(|block| mean_colour(size, colours, block)).collect();
        let marks: Vec<Mark> = blocks().map(|block| mark_of(size, marks, block)).collect();
        let is_object: Vec<bool> = marks.iter().map(|mark| mark.is_object()).collect();
        let count = is_object.iter().filter(|&&inside| inside).count();
        if count.min(small.len() - count) < FEWEST_PIXELS {
            let message = format!("must hold at least {FEWEST_PIXELS} pixels of the object and of the background");
            return Err(Error::new(ErrorKind::Empty, "marks", message).value(count as f64));
        }
        Ok(Self {
            size,
            small,
            factor,
            bins: means.iter().map(bin_of).collect(),
            shares: is_object.iter().map(|&inside| f32::from(u8::from(inside))).collect(),
            couplings: Couplings::new(small, &means),
            marks,
            is_object,
            scratch: std::array::from_fn(|_| vec![0.0; small.len()]),
            rounds: 0,
            changed: 1.0,
        })
    }

    /// Runs one round unless the segmentation is done.
    pub fn step(&mut self) -> SegmentationReport {
        if self.is_done() {
            return self.report();
        }
        let suggested = self.suggestions();
        self.couplings.weigh(|index| self.marks[index].is_certain());
        let [residual, direction, product] = &mut self.scratch;
        self.couplings.apply(&self.shares, residual);
        for (index, value) in residual.iter_mut().enumerate() {
            let (weight, wanted) = match self.marks[index] {
                mark if mark.is_certain() => (MARKED, f32::from(u8::from(mark.is_object()))),
                _ => (1.0, suggested[usize::from(self.bins[index])]),
            };
            *value = weight * wanted / (REACH * REACH) - *value;
        }
        solve(&mut self.couplings, SOLVE, Vectors { solution: &mut self.shares, residual, direction, product });
        let mut changed = 0_usize;
        for (inside, &share) in self.is_object.iter_mut().zip(&self.shares) {
            changed += usize::from(*inside != (share > 0.5));
            *inside = share > 0.5;
        }
        self.rounds += 1;
        self.changed = changed as f64 / self.small.len() as f64;
        self.report()
    }

    /// The progress so far.
    #[must_use]
    pub fn report(&self) -> SegmentationReport {
        let count = self.is_object.iter().filter(|&&inside| inside).count();
        SegmentationReport {
            rounds: self.rounds,
            changed: self.changed,
            share: count as f64 / self.small.len() as f64,
            is_done: self.is_done(),
        }
    }

    fn is_done(&self) -> bool {
        self.rounds >= ROUNDS || self.changed < RESTING
    }

    /// The mask of the picture: 255 on the object, 0 elsewhere, without islands and holes below a hundredth of the
    /// object that no mark requires.
    #[must_use]
    pub fn mask(&self) -> Vec<u8> {
        let mut shares = self.shares.clone();
        let count = self.is_object.iter().filter(|&&inside| inside).count();
        let smallest = (SPECK * count as f64) as usize;
        for is_object in [true, false] {
            let (labels, counts) = components(self.small, |index| self.is_object[index] == is_object, |_, _| true);
            let asked = if is_object { Mark::Object } else { Mark::Background };
            let mut stays: Vec<bool> = counts.iter().map(|&count| count > smallest).collect();
            let labelled = || labels.iter().enumerate().filter(|&(_, &label)| label != usize::MAX);
            labelled().filter(|&(index, _)| self.marks[index] == asked).for_each(|(_, &label)| stays[label] = true);
            for (index, &label) in labelled() {
                if !stays[label] {
                    shares[index] = f32::from(u8::from(!is_object));
                }
            }
        }
        (0..self.size.len()).map(|index| if self.finer(&shares, index) > 0.5 { u8::MAX } else { 0 }).collect()
    }

    /// The share at a pixel of the picture, linear between the centres of small ones.
    fn finer(&self, shares: &[f32], index: usize) -> f32 {
        let (column, row) = self.size.position(index);
        let place = |at: usize, length: usize| {
            let at = ((at as f32 + 0.5) / self.factor as f32 - 0.5).max(0.0).min((length - 1) as f32);
            let low = (at as usize).min(length.saturating_sub(2));
            (low, (low + 1).min(length - 1), at - low as f32)
        };
        let (left, right, across) = place(column, self.small.width);
        let (up, down, along) = place(row, self.small.height);
        let line = |row: usize| {
            let [a, b] = [left, right].map(|column| shares[self.small.index(column, row)]);
            a + across * (b - a)
        };
        line(up) + along * (line(down) - line(up))
    }

    /// The share of the object that each colour suggests.
    fn suggestions(&self) -> Vec<f32> {
        let mut counts = [vec![0.0_f32; BINS.pow(3)], vec![0.0_f32; BINS.pow(3)]];
        for (&bin, &inside) in self.bins.iter().zip(&self.is_object) {
            counts[usize::from(inside)][usize::from(bin)] += 1.0;
        }
        let [background, object] = counts.map(density);
        object.iter().zip(&background).map(|(object, background)| object / (object + background)).collect()
    }
}

fn check(size: Size, colours: &[u8], marks: &[u8]) -> Result<()> {
    for (field, found, each) in [("image.data", colours.len(), 4), ("marks", marks.len(), 1)] {
        if size.len() == 0 || found != each * size.len() {
            let message =
                format!("{}x{} pixels need {} values, not {found}", size.width, size.height, each * size.len());
            return Err(Error::new(ErrorKind::Size, field, message));
        }
    }
    match marks.iter().position(|&mark| usize::from(mark) >= Mark::ALL.len()) {
        Some(index) => {
            let error = Error::new(ErrorKind::Range, "marks", "must be 0, 1, 2 or 3");
            Err(error.at(index).value(f64::from(marks[index])))
        }
        None => Ok(()),
    }
}

/// Columns and rows of the picture for which a small pixel stands.
fn block(size: Size, small: Size, factor: usize, index: usize) -> [Range<usize>; 2] {
    let (column, row) = small.position(index);
    let part = |at: usize, length: usize| factor * at..(factor * (at + 1)).min(length);
    [part(column, size.width), part(row, size.height)]
}

fn mean_colour(size: Size, colours: &[u8], [columns, rows]: [Range<usize>; 2]) -> [f32; 3] {
    let count = (columns.len() * rows.len()) as f32;
    let mut sums = [0.0; 3];
    for index in rows.flat_map(|row| columns.clone().map(move |column| size.index(column, row))) {
        (0..3).for_each(|k| sums[k] += f32::from(colours[4 * index + k]));
    }
    sums.map(|sum| sum / count)
}

/// The mark of a block: a certain one if there is any, else that of its first pixel. A stroke may be thinner than a
/// block.
fn mark_of(size: Size, marks: &[u8], [columns, rows]: [Range<usize>; 2]) -> Mark {
    let first = Mark::ALL[usize::from(marks[size.index(columns.start, rows.start)])];
    rows.flat_map(|row| columns.clone().map(move |column| size.index(column, row)))
        .map(|index| Mark::ALL[usize::from(marks[index])])
        .find(|mark| mark.is_certain())
        .unwrap_or(first)
}

fn bin_of(colour: &[f32; 3]) -> u16 {
    let [r, g, b] = colour.map(|value| (value as usize * BINS / 256).min(BINS - 1));
    ((r * BINS + g) * BINS + b) as u16
}

/// A histogram as a density: smoothed by (1, 2, 1) / 4 along each channel, and with a share for unseen colours.
fn density(mut counts: Vec<f32>) -> Vec<f32> {
    for stride in [1, BINS, BINS * BINS] {
        let before = counts.clone();
        for (bin, count) in counts.iter_mut().enumerate() {
            let place = bin / stride % BINS;
            let low = if place > 0 { before[bin - stride] } else { before[bin] };
            let high = if place + 1 < BINS { before[bin + stride] } else { before[bin] };
            *count = 0.25 * (low + high) + 0.5 * before[bin];
        }
    }
    let total = counts.iter().sum::<f32>().max(1.0);
    let rest = UNSEEN / counts.len() as f32;
    counts.into_iter().map(|count| (1.0 - UNSEEN) * count / total + rest).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Random;
    #[cfg(target_arch = "wasm32")]
    use wasm_bindgen_test::wasm_bindgen_test as test;

    const DISC: [f64; 3] = [170.0, 90.0, 60.0];
    const GROUND: [f64; 3] = [80.0, 110.0, 140.0];

    /// A disc of a third of the side on another colour, under Gaussian noise of this many levels.
    fn disc(size: Size, noise: f64) -> (Vec<u8>, Vec<bool>) {
        let mut random = Random::new(4, 0);
        let mut gaussian =
            || (-2.0 * (1.0 - random.uniform()).ln()).sqrt() * (std::f64::consts::TAU * random.uniform()).cos();
        let radius = size.width.min(size.height) as f64 / 3.0;
        let middle = [size.width, size.height].map(|side| 0.5 * (side as f64 - 1.0));
        let truth: Vec<bool> = (0..size.len())
            .map(|index| {
                let (column, row) = size.position(index);
                (column as f64 - middle[0]).hypot(row as f64 - middle[1]) < radius
            })
            .collect();
        let pixels = truth.iter().flat_map(|&inside| {
            let colour = if inside { DISC } else { GROUND };
            let [r, g, b] = colour.map(|value| (value + noise * gaussian()).round().clamp(0.0, 255.0) as u8);
            [r, g, b, u8::MAX]
        });
        (pixels.collect(), truth)
    }

    fn inside(size: Size, margin: f64) -> Vec<u8> {
        let near = |at: usize, side: usize| (at as f64 / side as f64 - 0.5).abs() < 0.5 - margin;
        (0..size.len())
            .map(|index| {
                let (column, row) = size.position(index);
                if near(column, size.width) && near(row, size.height) { 3 } else { 0 }
            })
            .collect()
    }

    fn run(size: Size, colours: &[u8], marks: &[u8]) -> (Vec<u8>, SegmentationReport) {
        let mut found = Segmentation::new(size, colours, marks).unwrap();
        while !found.step().is_done {}
        (found.mask(), found.report())
    }

    /// Intersection over union.
    fn agreement(mask: &[u8], truth: &[bool]) -> f64 {
        let both = mask.iter().zip(truth).filter(|&(&mask, &inside)| mask > 0 && inside).count();
        let either = mask.iter().zip(truth).filter(|&(&mask, &inside)| mask > 0 || inside).count();
        both as f64 / either as f64
    }

    #[test]
    fn a_disc_under_noise_is_found_from_a_rectangle_around_it() {
        let size = Size { width: 160, height: 120 };
        for noise in [0.0, 10.0, 25.0] {
            let (colours, truth) = disc(size, noise);
            let (mask, report) = run(size, &colours, &inside(size, 0.08));
            let agreement = agreement(&mask, &truth);
            assert!(agreement > 0.97, "{noise}: {agreement} {report:?}");
            assert!(report.rounds < ROUNDS && report.changed < RESTING, "{report:?}");
        }
    }

    #[test]
    fn two_strokes_do_as_well_and_stay() {
        let size = Size { width: 160, height: 120 };
        let (colours, truth) = disc(size, 15.0);
        let mut marks = vec![2; size.len()];
        (60..100).for_each(|column| marks[size.index(column, 60)] = 1);
        (0..160).for_each(|column| marks[size.index(column, 4)] = 0);
        // A stroke of background crosses the object, and a stroke of the object lies outside.
        (60..100).for_each(|column| marks[size.index(column, 66)] = 0);
        (2..12).for_each(|column| marks[size.index(column, 100)] = 1);
        let (mask, _) = run(size, &colours, &marks);
        assert!(agreement(&mask, &truth) > 0.95);
        let kept = |column: usize, row: usize| mask[size.index(column, row)] > 0;
        assert!((60..100).all(|column| kept(column, 60) && !kept(column, 66)));
        assert!((2..12).all(|column| kept(column, 100)));
    }

    #[test]
    fn a_large_picture_is_segmented_at_a_lower_resolution() {
        let size = Size { width: 1300, height: 700 };
        let (colours, truth) = disc(size, 25.0);
        let (mask, _) = run(size, &colours, &inside(size, 0.06));
        assert!(agreement(&mask, &truth) > 0.98);
    }

    #[test]
    fn what_cannot_be_segmented_is_refused_with_its_field() {
        let size = Size { width: 40, height: 30 };
        let (colours, _) = disc(size, 0.0);
        let marks = inside(size, 0.1);
        let refused = |size, colours: &[u8], marks: &[u8]| {
            let error = Segmentation::new(size, colours, marks).err().unwrap();
            (error.kind(), error.field().to_owned())
        };
        let other = Size { width: 41, height: 30 };
        assert_eq!(refused(other, &colours, &marks), (ErrorKind::Size, "image.data".into()));
        assert_eq!(refused(size, &colours, &marks[1..]), (ErrorKind::Size, "marks".into()));
        assert_eq!(refused(Size { width: 0, height: 0 }, &[], &[]).0, ErrorKind::Size);
        assert_eq!(refused(size, &colours, &[0; 1200]), (ErrorKind::Empty, "marks".into()));
        assert_eq!(refused(size, &colours, &[1; 1200]), (ErrorKind::Empty, "marks".into()));
        assert_eq!(refused(size, &colours, &[4; 1200]), (ErrorKind::Range, "marks".into()));
    }

    #[test]
    fn a_picture_of_one_colour_keeps_its_marks_and_ends() {
        let size = Size { width: 40, height: 30 };
        let colours = vec![90; 4 * size.len()];
        let (mask, report) = run(size, &colours, &inside(size, 0.2));
        assert!(report.is_done && report.rounds <= ROUNDS);
        assert_eq!(mask.len(), size.len());
    }
}
