//! Varying albedo: separates the log albedo of an object, in a few colours, from its shading
//! (docs/method/image-model.md).
//!
//! The Bayesian information criterion chooses the number of albedos. A further albedo has to raise the likelihood of
//! the colours by more than its four unknowns would by chance. A tile of neighbouring pixels counts once, because
//! errors of shading are alike within it. If one albedo suffices, there is no palette, because the light alone explains the image.
//!
//! The only inputs are log colours and the normals of the same pixels; see [`AlbedoFitter::fit`].
//!
//! Limits: albedo of one chromaticity whose lightness follows the shading counts as shading, and a large cast shadow
//! with a sharp border may count as an albedo of the same chromaticity.

use crate::diagnosis::is_pure_noise;
use crate::light::colour_axes::{Axes, AxesPrior};
use crate::light::harmonics::basis;
use crate::light::mixture::{MOST_REGIONS, Mixture, Sample};
use crate::light::{Light, LightPrior};
use crate::numeric::evenly_spread;
use crate::view::Normals;

/// Maximum number of pixels to which light and palette are fitted, evenly spread. There are at most 51 unknowns, so
/// noise averages out with far fewer.
const MOST_SAMPLES: usize = 2000;
/// Minimum number of pixels for fitting a palette.
const FEWEST_SAMPLES: usize = 100;
/// Pixels that count as one for the evidence: tiles of 8x8, as for the uncertainty of a pose
/// (docs/method/uncertainty.md).
const TILE: f64 = 64.0;
/// Maximum number of tiles, because in a larger image the errors of shading form larger patches, not more patches.
const MOST_TILES: f64 = 125.0;
/// Unknowns of one more albedo: its offset in three channels, and its share.
const UNKNOWNS: f64 = 4.0;
/// Share of the remaining lightness, after subtraction of a region's albedo, that counts as albedo and not as shading; set on
/// ten photographs (docs/lab/thresholds.md).
const LIGHTNESS_SHARE: f64 = 0.5;

/// A light and the albedos under it.
#[derive(Clone, Debug, PartialEq)]
pub struct VaryingAlbedo {
    mixture: Mixture,
    /// The mixture with the scales for pixels without a normal, of whose shading only mean and variance are known.
    unseen: Mixture,
    axes: Axes,
    /// The light if it is known; the mixture then has none.
    known: Option<Light>,
    /// Mean log colour (R, G, B) that is subtracted before the mixture.
    centre: [f64; 3],
    /// Mean shading along the axes, for pixels without a normal.
    mean_shading: [f64; 3],
    /// Share of a pixel's residual from its region's albedo that counts as albedo, along each axis.
    gains: [f64; 3],
    /// The shares for pixels without a normal, whose lightness carries no information about albedo.
    unseen_gains: [f64; 3],
}

/// Log albedo of one pixel, R, G, B: that of its region, and that with the variation inside the region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelAlbedo {
    /// Offset of the pixel's albedo; between albedos, the mean by probability.
    pub region: [f64; 3],
    /// The offset `region` plus the part of the residual that seems to be albedo.
    pub fine: [f64; 3],
}

/// Fits palettes; owns the memory of its samples.
#[derive(Clone, Debug, Default)]
pub struct AlbedoFitter {
    samples: Vec<Sample>,
}

impl AlbedoFitter {
    /// Allocates the memory of the samples.
    #[must_use]
    pub fn new() -> Self {
        Self { samples: Vec::with_capacity(MOST_SAMPLES) }
    }

    /// Fits albedos to pixels with these `normals` (colour view's frame) and `log` colours, NaN where missing. `known`
    /// is the light if it is known up to its exposure. `None` if a single albedo fits the image equally well.
    pub fn fit(
        &mut self,
        normals: &Normals,
        log: [&[f32]; 3],
        (prior, weight): (&LightPrior, f64),
        known: Option<&Light>,
    ) -> Option<VaryingAlbedo> {
        let centre = self.gather(normals, log, known);
        if self.samples.len() < FEWEST_SAMPLES {
            return None;
        }
        let tiles = (count_of(normals, log[0]) as f64 / TILE).clamp(1.0, MOST_TILES);
        let prior = |axes: &Axes| known.map_or_else(|| AxesPrior::of(prior, weight, axes), |_| AxesPrior::known());
        // A single albedo under white lamps, to find the axes of the light.
        self.turn(None, &Axes::WHITE);
        let white = Mixture::blank().fitted(&self.samples, &prior(&Axes::WHITE), tiles)?;
        if is_pure_noise(white.scales) {
            return None;
        }
        let normals = self.samples.iter().map(|sample| sample.normal);
        let axes = Axes::of_shading(known.unwrap_or(&white.light(&Axes::WHITE)), normals);
        self.turn(Some(&Axes::WHITE), &axes);
        let mixture = self.choose(&prior(&axes), tiles)?;
        Some(self.found(mixture, axes, centre, known.copied()))
    }

    fn found(&self, mixture: Mixture, axes: Axes, centre: [f64; 3], known: Option<Light>) -> VaryingAlbedo {
        let (mut mean_shading, mut squares, count) = ([0.0; 3], [0.0; 3], self.samples.len() as f64);
        for sample in &self.samples {
            let (unshaded, known) =
                (mixture.unshaded(sample), known.map_or([0.0; 3], |light| light.of_basis(&sample.basis)));
            let known = axes.along(known);
            for c in 0..3 {
                let shading = sample.colour[c] - unshaded[c] + known[c];
                mean_shading[c] += shading / count;
                squares[c] += shading * shading / count;
            }
        }
        let centred = axes.along(centre);
        (0..3).for_each(|c| squares[c] -= mean_shading[c] * mean_shading[c]);
        (0..3).for_each(|c| mean_shading[c] += centred[c]);
        let mut unseen = mixture;
        for c in 0..3 {
            unseen.scales[c] = (mixture.scales[c].powi(2) + squares[c].max(0.0)).sqrt();
        }
        let variance = mixture.variance();
        let share = |mixture: &Mixture, c: usize| variance[c] / (variance[c] + mixture.scales[c] * mixture.scales[c]);
        let gains = [LIGHTNESS_SHARE * share(&mixture, 0), share(&mixture, 1), share(&mixture, 2)];
        let unseen_gains = [0.0, share(&unseen, 1), share(&unseen, 2)];
        VaryingAlbedo { mixture, unseen, axes, known, centre, mean_shading, gains, unseen_gains }
    }

    /// Collects evenly spread pixels that have both a normal and a colour. Returns the mean colour (R, G, B), which is
    /// subtracted from the samples.
    fn gather(&mut self, normals: &Normals, log: [&[f32]; 3], known: Option<&Light>) -> [f64; 3] {
        self.samples.clear();
        let mut centre = [0.0; 3];
        let usable = || (0..normals.len()).filter(|&pixel| normals.is_valid(pixel) && !log[0][pixel].is_nan());
        for pixel in evenly_spread(MOST_SAMPLES, usable) {
            let normal = normals.get(pixel).map(f64::from);
            let shading = known.map_or([0.0; 3], |light| light.shade(normal));
            let colour: [f64; 3] = std::array::from_fn(|c| f64::from(log[c][pixel]) - shading[c]);
            (0..3).for_each(|c| centre[c] += colour[c]);
            self.samples.push(Sample { normal, basis: basis(normal), colour });
        }
        let centre = centre.map(|sum| sum / self.samples.len().max(1) as f64);
        for sample in &mut self.samples {
            (0..3).for_each(|c| sample.colour[c] -= centre[c]);
        }
        centre
    }

    /// Expresses the samples' colours along the axes `to`; without `from` they are R, G, B.
    fn turn(&mut self, from: Option<&Axes>, to: &Axes) {
        for sample in &mut self.samples {
            sample.colour = to.along(from.map_or(sample.colour, |from| from.back(sample.colour)));
        }
    }

    /// The mixture with the most evidence; `None` if that has a single albedo.
    fn choose(&self, prior: &AxesPrior, tiles: f64) -> Option<Mixture> {
        let mut mixture = Mixture::blank().fitted(&self.samples, prior, tiles)?;
        let evidence =
            |mixture: &Mixture| tiles * mixture.likelihood - 0.5 * UNKNOWNS * mixture.regions as f64 * tiles.ln();
        let mut best = mixture;
        // A split may pay off only together with the next one.
        while mixture.regions < MOST_REGIONS {
            let Some(further) = mixture.split(&self.samples).fitted(&self.samples, prior, tiles) else { break };
            mixture = further;
            if evidence(&mixture) > evidence(&best) {
                best = mixture;
            }
        }
        (best.regions > 1).then_some(best)
    }
}

fn count_of(normals: &Normals, log: &[f32]) -> usize {
    (0..normals.len()).filter(|&pixel| normals.is_valid(pixel) && !log[pixel].is_nan()).count()
}

impl VaryingAlbedo {
    /// Number of albedos, two or more.
    #[cfg(test)]
    pub const fn regions(&self) -> usize {
        self.mixture.regions
    }

    /// The light relative to which the albedos are offsets, including the mean colour.
    #[must_use]
    pub fn light(&self) -> Light {
        self.known.unwrap_or_else(|| self.mixture.light(&self.axes)).tinted(self.centre)
    }

    /// The albedo of a pixel, given its log colour and its shading under [`light`](Self::light). Without a shading,
    /// chromaticity alone decides.
    #[must_use]
    pub fn of_pixel(&self, log: [f64; 3], shading: Option<[f64; 3]>) -> PixelAlbedo {
        let (mixture, gains) = match shading {
            Some(_) => (&self.mixture, &self.gains),
            None => (&self.unseen, &self.unseen_gains),
        };
        let shading = shading.map_or(self.mean_shading, |shading| self.axes.along(shading));
        let colour = self.axes.along(log);
        let unshaded: [f64; 3] = std::array::from_fn(|c| colour[c] - shading[c]);
        let (responsibilities, _) = mixture.responsibilities(unshaded, gains[0] > 0.0);
        let region = mixture.mean_offset(&responsibilities);
        let fine = std::array::from_fn(|c| region[c] + gains[c] * (unshaded[c] - region[c]));
        PixelAlbedo { region: self.axes.back(region), fine: self.axes.back(fine) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Random;

    /// Normals of a dome, 60x60, and their log colours under `light`, with `noise` and the albedo of each pixel.
    fn dome(light: &Light, noise: f64, albedo: impl Fn(usize, usize) -> [f64; 3]) -> (Normals, [Vec<f32>; 3]) {
        let side = 60;
        let mut random = Random::new(3, 0);
        let mut gaussian = || (0..12).map(|_| random.word() as f64 / u32::MAX as f64).sum::<f64>() - 6.0;
        let mut normals = Normals::missing(side * side);
        let mut log = [(); 3].map(|()| vec![f32::NAN; side * side]);
        for index in 0..side * side {
            let (column, row) = (index % side, index / side);
            let [x, y] = [column, row].map(|place| 1.8 * (place as f64 + 0.5) / side as f64 - 0.9);
            if x.hypot(y) > 0.9 {
                continue;
            }
            let normal = [x, y, -(1.0 - x * x - y * y).sqrt()];
            normals.set(index, normal.map(|value| value as f32));
            let (shade, albedo) = (light.shade(normal), albedo(column, row));
            for channel in 0..3 {
                log[channel][index] = (shade[channel] + albedo[channel] + noise * gaussian()) as f32;
            }
        }
        (normals, log)
    }

    fn fit(normals: &Normals, log: &[Vec<f32>; 3], known: Option<&Light>) -> Option<VaryingAlbedo> {
        let log = log.each_ref().map(Vec::as_slice);
        AlbedoFitter::new().fit(normals, log, (&LightPrior::natural(), 1e-6), known)
    }

    /// Stripes of three albedos, log units.
    const STRIPES: [[f64; 3]; 3] = [[0.0, 0.0, 0.0], [-0.9, -0.3, 0.2], [0.3, -0.5, -0.8]];

    fn stripes(column: usize, _: usize) -> [f64; 3] {
        STRIPES[column / 7 % 3]
    }

    #[test]
    fn a_single_albedo_is_none_whatever_the_noise() {
        let light = LightPrior::natural().mean().exposed(0.7);
        for noise in [0.0, 0.01, 0.1, 0.3] {
            let (normals, log) = dome(&light, noise, |_, _| [0.4, -0.1, 0.2]);
            assert!(fit(&normals, &log, None).is_none(), "{noise}");
        }
    }

    #[test]
    fn stripes_are_told_from_shading() {
        let light = LightPrior::natural().mean().exposed(0.7);
        let (normals, log) = dome(&light, 0.02, stripes);
        for known in [None, Some(&light)] {
            let albedo = fit(&normals, &log, known).expect("three albedos");
            let found = albedo.light();
            let usable = || (0..normals.len()).filter(|&pixel| normals.is_valid(pixel));
            let off = |pixel: usize| {
                let colours = [0, 1, 2].map(|c: usize| f64::from(log[c][pixel]));
                let shading = found.shade(normals.get(pixel).map(f64::from));
                let [region, truth] = [albedo.of_pixel(colours, Some(shading)).region, stripes(pixel % 60, 0)];
                [0, 1, 2].map(|c: usize| region[c] - truth[c])
            };
            // The albedos agree up to a common offset, which belongs to the light.
            let count = usable().count() as f64;
            for channel in 0..3 {
                let mean = usable().map(|pixel| off(pixel)[channel]).sum::<f64>() / count;
                let error = usable().map(|pixel| (off(pixel)[channel] - mean).powi(2)).sum::<f64>() / count;
                assert!(error.sqrt() < 0.02, "channel {channel}: {} of {} albedos", error.sqrt(), albedo.regions());
            }
        }
    }

    #[test]
    fn chromaticity_alone_tells_the_albedo_where_there_is_no_normal() {
        let light = LightPrior::natural().mean();
        let (normals, log) = dome(&light, 0.02, stripes);
        let albedo = fit(&normals, &log, None).expect("three albedos");
        let light = albedo.light();
        let mut same = 0;
        let usable = || (0..normals.len()).filter(|&pixel| normals.is_valid(pixel));
        for pixel in usable() {
            let colours = [0, 1, 2].map(|c: usize| f64::from(log[c][pixel]));
            let [with, without] = [Some(light.shade(normals.get(pixel).map(f64::from))), None]
                .map(|shading| albedo.of_pixel(colours, shading).region);
            same += usize::from((0..3).all(|c| (with[c] - without[c]).abs() < 0.1));
        }
        assert!(same as f64 > 0.9 * usable().count() as f64, "{same} of {}", usable().count());
    }
}
