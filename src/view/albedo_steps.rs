//! Removes the albedo that shows at its edges from an image: regions between sharp changes of colour are brought to one
//! level.
//!
//! Shading changes slowly from pixel to pixel; albedo changes abruptly, and mostly in chromaticity. Two neighbours
//! therefore lie in different regions if their log colours differ by more than shading explains. The difference across
//! their common border, minus the slope on either side, is the difference of their albedos; the median over the border
//! is used. Least squares over all borders gives a log offset for each region, up to a common one.
//!
//! E. Land, J. McCann: "Lightness and retinex theory", Journal of the Optical Society of America 61, 1971.
//!
//! Limits: gradual changes of albedo stay, and so do differences of albedo that no border shows. A sufficiently sharp
//! edge of the relief looks like an edge of albedo. Regions of a few pixels, which mix two albedos, leave the mask.

use std::cmp::Reverse;

use super::ColourView;
use crate::numeric::quantile;

/// Difference of chromaticity (log colours less the channels' mean) above which two neighbours have an edge of albedo
/// between them, log units; four sigmas of the noise are added. The shading of a smooth surface does not reach this
/// limit. No other value was tried.
const CHROMATICITY_STEP: f32 = 0.06;
/// The same limit for brightness (the channels' mean), log units. No other value was tried.
const LOG_STEP: f32 = 0.22;
/// Smallest number of pixels of a region.
const SMALLEST_REGION: usize = 6;
/// Largest number of regions; beyond these, the smallest leave the mask.
const MOST_REGIONS: usize = 240;
/// Smallest number of pairs of pixels along a border.
const FEWEST_PAIRS: usize = 3;
/// Widest border of mixed pixels between two regions.
const WIDEST_BORDER: usize = 3;
/// The albedo counts as varying if at least this share of the pixels lies outside the largest region.
const LEAST_ALBEDO: f64 = 0.03;
/// Weight that ties each region to the mean; one pair of pixels across a border has the weight one. It matters only for
/// regions without borders.
const LOOSE_TIE: f64 = 1e-3;

/// Regions share one albedo if their chromaticities (log colours less the channels' mean) differ by less than this, log
/// units, and their brightness by less than [`SAME_BRIGHTNESS`].
const SAME_CHROMATICITY: f64 = 0.1;
/// The same bound for brightness (the channels' mean), log units. Edges of the relief between regions shift brightness,
/// but hardly chromaticity.
const SAME_BRIGHTNESS: f64 = 0.4;
/// Number of rounds in which albedos are joined and compared again. A comparison takes all borders between two albedos
/// together.
const PALETTE_ROUNDS: usize = 2;

/// Largest number of sweeps over the borders, and the change of a log offset that ends them.
const MOST_SWEEPS: usize = 2000;
const SETTLED_OFFSET: f64 = 1e-5;

/// Label of a pixel that belongs to no region.
const NONE: u32 = u32::MAX;

impl ColourView {
    /// This view without the albedo that shows at its edges; `None` if there is no such albedo.
    #[must_use]
    pub(crate) fn without_albedo_steps(&self) -> Option<Self> {
        let mut regions = Regions::new(self);
        let painted = regions.pixels() - regions.sizes.first().copied().unwrap_or(0);
        if regions.sizes.len() < 2 || (painted as f64) < LEAST_ALBEDO * regions.pixels() as f64 {
            return None;
        }
        let mut offsets = regions.offsets(self);
        for _ in 0..PALETTE_ROUNDS {
            regions.join(&offsets);
            offsets = regions.offsets(self);
        }
        let mut log = self.log.clone();
        let mask: Vec<bool> = regions.of_pixel.iter().map(|&region| region != NONE).collect();
        for (index, &region) in regions.of_pixel.iter().enumerate() {
            for channel in 0..3 {
                log[channel][index] = if region == NONE {
                    f32::NAN
                } else {
                    log[channel][index] - offsets[channel][region as usize] as f32
                };
            }
        }
        Some(Self::of(self.size, self.camera, mask, log, self.transfer))
    }

    /// Whether an edge of albedo or the border of an object lies between two neighbours.
    fn is_edge(&self, a: usize, b: usize, noise: f32) -> bool {
        let step: [f32; 3] = std::array::from_fn(|channel| self.log[channel][b] - self.log[channel][a]);
        let mean = step.iter().sum::<f32>() / 3.0;
        let hue = step.iter().fold(0.0, |most, value| f32::max(most, (value - mean).abs()));
        hue > CHROMATICITY_STEP + noise || mean.abs() > LOG_STEP + noise
    }
}

/// Whether two log albedos count as one.
fn is_one_albedo(a: &[f64; 3], b: &[f64; 3]) -> bool {
    let off: [f64; 3] = std::array::from_fn(|channel| a[channel] - b[channel]);
    let brightness = off.iter().sum::<f64>() / 3.0;
    brightness.abs() < SAME_BRIGHTNESS && off.iter().all(|value| (value - brightness).abs() < SAME_CHROMATICITY)
}

/// The border between two regions.
struct Border {
    regions: [usize; 2],
    /// Number of pixel pairs along the border.
    pairs: f64,
    /// log albedo of the second region minus that of the first.
    step: [f64; 3],
}

/// Regions, each with one albedo. At first each region is connected.
struct Regions {
    of_pixel: Vec<u32>,
    /// Number of pixels of each region, largest first.
    sizes: Vec<usize>,
}

impl Regions {
    fn new(view: &ColourView) -> Self {
        let noise = 4.0 * view.edge_noise();
        let mut of_pixel = vec![NONE; view.size.len()];
        let mut found: Vec<(usize, u32)> = Vec::new();
        let mut open = Vec::new();
        for seed in 0..of_pixel.len() {
            if !view.mask[seed] || of_pixel[seed] != NONE {
                continue;
            }
            let label = found.len() as u32;
            let mut pixels = 0;
            of_pixel[seed] = label;
            open.push(seed);
            while let Some(pixel) = open.pop() {
                pixels += 1;
                for near in view.size.neighbours(pixel) {
                    if view.mask[near] && of_pixel[near] == NONE && !view.is_edge(pixel, near, noise) {
                        of_pixel[near] = label;
                        open.push(near);
                    }
                }
            }
            found.push((pixels, label));
        }
        let labels = found.len();
        found.sort_by_key(|&(pixels, _)| Reverse(pixels));
        found.truncate(MOST_REGIONS);
        found.retain(|(pixels, _)| *pixels >= SMALLEST_REGION);
        let mut names = vec![NONE; labels];
        (0..).zip(&found).for_each(|(name, &(_, label))| names[label as usize] = name);
        of_pixel.iter_mut().filter(|label| **label != NONE).for_each(|label| *label = names[*label as usize]);
        Self { of_pixel, sizes: found.into_iter().map(|(pixels, _)| pixels).collect() }
    }

    /// Merges all regions of the same albedo, given the log albedo of each.
    fn join(&mut self, offsets: &[Vec<f64>; 3]) {
        let offset = |region: usize| offsets.each_ref().map(|channel| channel[region]);
        let mut palette: Vec<(usize, [f64; 3])> = Vec::new();
        let mut sizes: Vec<usize> = Vec::new();
        let mut names = Vec::with_capacity(self.sizes.len());
        for (region, &size) in self.sizes.iter().enumerate() {
            let known = palette.iter().find(|(_, known)| is_one_albedo(known, &offset(region))).map(|(name, _)| *name);
            let name = known.unwrap_or_else(|| {
                palette.push((sizes.len(), offset(region)));
                sizes.push(0);
                sizes.len() - 1
            });
            sizes[name] += size;
            names.push(name as u32);
        }
        for region in self.of_pixel.iter_mut().filter(|region| **region != NONE) {
            *region = names[*region as usize];
        }
        self.sizes = sizes;
    }

    fn pixels(&self) -> usize {
        self.sizes.iter().sum()
    }

    /// log albedo of each region in each channel, with mean zero over the pixels: least squares over the borders by
    /// damped Jacobi sweeps, in which each region moves halfway to the mean that its neighbours imply.
    fn offsets(&self, view: &ColourView) -> [Vec<f64>; 3] {
        let borders = self.borders(view);
        [0, 1, 2].map(|channel: usize| {
            let mut offsets = vec![0.0; self.sizes.len()];
            let mut sums = vec![(0.0, 0.0); self.sizes.len()];
            for _ in 0..MOST_SWEEPS {
                sums.fill((0.0, LOOSE_TIE));
                for &Border { regions: [a, b], pairs, step } in &borders {
                    sums[a].0 += pairs * (offsets[b] - step[channel]);
                    sums[b].0 += pairs * (offsets[a] + step[channel]);
                    sums[a].1 += pairs;
                    sums[b].1 += pairs;
                }
                let mut change = 0.0_f64;
                for (offset, &(sum, weight)) in offsets.iter_mut().zip(&sums) {
                    // Each region takes half of its step: full steps of all regions at once would oscillate for ever.
                    let next = 0.5 * (*offset + sum / weight);
                    change = change.max((next - *offset).abs());
                    *offset = next;
                }
                if change < SETTLED_OFFSET {
                    break;
                }
            }
            let weighted = offsets.iter().zip(&self.sizes).map(|(offset, &size)| offset * size as f64);
            let mean = weighted.sum::<f64>() / self.pixels() as f64;
            offsets.iter().map(|offset| offset - mean).collect()
        })
    }

    /// The albedo difference across each border that is long enough.
    fn borders(&self, view: &ColourView) -> Vec<Border> {
        let mut steps = self.steps(view);
        steps.sort_by_key(|&(regions, _)| Reverse(regions));
        let long = steps.chunk_by(|a, b| a.0 == b.0).filter(|border| border.len() >= FEWEST_PAIRS);
        long.map(|border| Border {
            regions: border[0].0.map(|region| region as usize),
            pairs: border.len() as f64,
            step: [0, 1, 2].map(|channel: usize| {
                let mut values: Vec<f32> = border.iter().map(|(_, step)| step[channel]).collect();
                f64::from(quantile(&mut values, 0.5))
            }),
        })
        .collect()
    }

    /// For each pair of regions, the albedo of the second relative to the first at each place of their border.
    fn steps(&self, view: &ColourView) -> Vec<([u32; 2], [f32; 3])> {
        let mut all = Vec::new();
        let (width, height) = (view.size.width as isize, view.size.height as isize);
        for pixel in 0..self.of_pixel.len() {
            let first = self.of_pixel[pixel];
            if first == NONE {
                continue;
            }
            let (column, row) = view.size.position(pixel);
            for (right, down) in [(1, 0), (0, 1)] {
                let at = |steps: isize| {
                    let (column, row) = (column as isize + right * steps, row as isize + down * steps);
                    let inside = (0..width).contains(&column) && (0..height).contains(&row);
                    inside.then(|| view.size.index(column as usize, row as usize))
                };
                // The next pixel of another region, beyond mixed pixels that belong to none.
                let across = (1..=1 + WIDEST_BORDER as isize)
                    .map_while(|steps| at(steps).map(|other| (steps, other)))
                    .find(|(_, other)| self.of_pixel[*other] != NONE);
                let Some((steps, other)) = across.filter(|(_, other)| self.of_pixel[*other] != first) else { continue };
                let second = self.of_pixel[other];
                let before = at(-1).filter(|&before| self.of_pixel[before] == first);
                let after = at(steps + 1).filter(|&after| self.of_pixel[after] == second);
                let step = [0, 1, 2].map(|channel: usize| {
                    let log = &view.log[channel];
                    let here = before.map(|before| log[pixel] - log[before]);
                    let there = after.map(|after| log[after] - log[other]);
                    let slope = match (here, there) {
                        (Some(here), Some(there)) => 0.5 * (here + there),
                        (one, two) => one.or(two).unwrap_or(0.0),
                    };
                    let step = log[other] - log[pixel] - steps as f32 * slope;
                    if first < second { step } else { -step }
                });
                all.push(([first.min(second), first.max(second)], step));
            }
        }
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::noise;
    use crate::view::{ColourImage, ColourSamples};

    const SIDE: usize = 48;

    /// A ball under a soft lamp with 1 % noise; `albedo` is its log albedo by position.
    fn ball(albedo: impl Fn(usize, usize) -> [f64; 3]) -> ColourView {
        let mut dice = noise::white_noise(5);
        let (mut data, mut mask) = (Vec::new(), Vec::new());
        for index in 0..SIDE * SIDE {
            let (column, row) = (index % SIDE, index / SIDE);
            let [x, y] = [column, row].map(|place| (place as f64 - 23.5) / 22.0);
            mask.push(u8::from(x * x + y * y < 1.0));
            let shade = [0.5 * x - 0.3 * y, 0.4 * x - 0.3 * y, 0.3 * x - 0.35 * y];
            let log = albedo(column, row);
            data.extend((0..3).map(|channel| (shade[channel] + log[channel] + 0.01 * dice()).exp() as f32));
        }
        let samples = ColourSamples::RgbLinear(data);
        let image = ColourImage { width: SIDE, height: SIDE, samples, transfer: None, mask: Some(mask), camera: None };
        ColourView::new(image).unwrap()
    }

    fn checks(column: usize, row: usize) -> [f64; 3] {
        let albedos = [[0.0, 0.0, 0.0], [-0.9, 0.2, 0.3], [0.1, -0.8, 0.2], [-1.0, -1.0, -1.0]];
        albedos[(column / 9 + 3 * (row / 7)) % 4]
    }

    #[test]
    fn painted_squares_are_brought_to_one_level() {
        let (bare, painted) = (ball(|_, _| [0.0; 3]), ball(checks));
        let clean = painted.without_albedo_steps().expect("the albedo varies");
        for channel in 0..3 {
            let off: Vec<f64> = (0..SIDE * SIDE)
                .filter(|&index| clean.mask[index])
                .map(|index| f64::from(clean.log[channel][index] - bare.log[channel][index]))
                .collect();
            let mean = off.iter().sum::<f64>() / off.len() as f64;
            let spread = (off.iter().map(|off| (off - mean).powi(2)).sum::<f64>() / off.len() as f64).sqrt();
            // Error of medians over borders of seven pixels with 1 % noise, along a chain of about six squares.
            assert!(spread < 0.03, "channel {channel}: {spread}");
        }
        let kept = clean.mask.iter().filter(|&&inside| inside).count();
        assert!(kept as f64 > 0.95 * bare.mask.iter().filter(|&&inside| inside).count() as f64);
    }

    #[test]
    fn with_a_single_albedo_there_is_nothing_to_take_away() {
        assert!(ball(|_, _| [0.0; 3]).without_albedo_steps().is_none());
        // A gradual change is not an edge.
        assert!(ball(|column, _| [0.01 * column as f64, 0.0, 0.0]).without_albedo_steps().is_none());
    }
}
