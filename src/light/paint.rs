//! Paint: the log albedo of an object in a few colours, told from its shading (docs/method.md, section 3).
//!
//! How many paints there are is decided by evidence (Bayesian information criterion): a further one has to raise the
//! likelihood of the colours by more than its four unknowns would by chance, with tiles of neighbouring pixels counted
//! once, since errors of shading are alike there. One paint means none: then the light explains all.
//!
//! Given are log colours and the normals of the same pixels, nothing else; see [`PaintFitter::fit`].
//!
//! Limits: paint of one chromaticity whose lightness follows the shading is taken for shading, and a large cast shadow
//! with a sharp border may be taken for paint of the same hue.

use crate::light::harmonics::{HARMONICS, basis};
use crate::light::mixture::{MOST_REGIONS, Mixture, OpponentPrior, Sample, from_opponent, to_opponent};
use crate::light::{Light, LightPrior};
use crate::numeric::evenly_spread;
use crate::view::Normals;

/// Pixels that light and palette are fitted to at most, evenly spread: 51 unknowns at most, and noise averages out long
/// before.
const MOST_SAMPLES: usize = 2000;
/// Fewest pixels that a palette is looked for in.
const FEWEST_SAMPLES: usize = 100;
/// Pixels that count as one for the evidence: tiles of 8x8, as for the uncertainty of a pose (section 14) ..
const TILE: f64 = 64.0;
/// .. and tiles at most: in a larger image errors of shading are larger patches, and not more of them.
const MOST_TILES: f64 = 125.0;
/// Unknowns of one paint more: its offset in three channels, and its share.
const UNKNOWNS: f64 = 4.0;
/// Error of the shading, log units in a channel, up to which nobody asks for paint: noise, and differences of heights
/// for normals. Renders leave 0.01 to 0.03, ten painted photographs 0.1 and more.
const PURE_NOISE: f64 = 0.035;
/// Further paints that are tried although the last one did not pay: a split may pay only together with the next.
const PATIENCE: usize = 3;
/// Share of the lightness that a region's paint leaves unexplained which is paint, not shading, where there is as much
/// paint as one likes: none, half and all of it left 0.30, 0.25 and 0.26 of error on ten photographs (median).
const LIGHTNESS_SHARE: f64 = 0.5;

/// A light and the paints under it.
#[derive(Clone, Debug, PartialEq)]
pub struct Paint {
    mixture: Mixture,
    /// Whether the light was known: then the mixture has none.
    known: Option<Light>,
    /// Mean log colour, R, G, B, which the mixture is relative to.
    centre: [f64; 3],
    /// Mean shading in opponent coordinates, for pixels without a normal.
    mean_shading: [f64; 3],
    /// Share of what a region's paint leaves that is paint as well: lightness, colour.
    gains: [f64; 2],
}

/// The paint of one pixel: of its region, and with the variation inside it, log units of R, G, B.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PaintOfPixel {
    /// Offset of the paint that the pixel has; between paints the mean by probability.
    pub region: [f64; 3],
    /// The same with what seems to be paint of the rest.
    pub fine: [f64; 3],
}

/// Fits paints again and again; owns the memory of its samples.
#[derive(Clone, Debug, Default)]
pub struct PaintFitter {
    samples: Vec<Sample>,
}

impl PaintFitter {
    /// Memory for the samples.
    #[must_use]
    pub fn new() -> Self {
        Self { samples: Vec::with_capacity(MOST_SAMPLES) }
    }

    /// The paints of pixels with these `normals` (colour view's frame) and `log` colours, NaN where missing; `known` is
    /// the light where it is known up to its exposure. `None` where one paint, which is to say none, explains the
    /// colours as well.
    pub fn fit(
        &mut self,
        normals: &Normals,
        log: [&[f32]; 3],
        (prior, weight): (&LightPrior, f64),
        known: Option<&Light>,
    ) -> Option<Paint> {
        let centre = self.gather(normals, log, known);
        if self.samples.len() < FEWEST_SAMPLES {
            return None;
        }
        let prior = known.map_or_else(|| OpponentPrior::of(prior, weight), |_| OpponentPrior::known());
        let mixture = self.choose(&prior, count_of(normals, log[0]))?;
        let mut mean_shading = [0.0; 3];
        for sample in &self.samples {
            let unshaded = mixture.unshaded(sample);
            (0..3).for_each(|c| mean_shading[c] += (sample.colour[c] - unshaded[c]) / self.samples.len() as f64);
        }
        let variance = mixture.variance();
        let share = |variance: f64, scale: f64| variance / (variance + scale * scale);
        let gains = [
            LIGHTNESS_SHARE * share(variance[0], mixture.scales[0]),
            share(0.5 * (variance[1] + variance[2]), mixture.scales[1]),
        ];
        Some(Paint { mixture, known: known.copied(), centre, mean_shading, gains })
    }

    /// Evenly spread pixels that have both; colours are relative to their mean, which is returned.
    fn gather(&mut self, normals: &Normals, log: [&[f32]; 3], known: Option<&Light>) -> [f64; 3] {
        self.samples.clear();
        let mut centre = [0.0; 3];
        let usable = || (0..normals.len()).filter(|&pixel| normals.is_valid(pixel) && !log[0][pixel].is_nan());
        for pixel in evenly_spread(MOST_SAMPLES, usable) {
            let normal = normals.get(pixel).map(f64::from);
            let shading = known.map_or([0.0; 3], |light| light.shade(normal));
            let colour: [f64; 3] = std::array::from_fn(|c| f64::from(log[c][pixel]) - shading[c]);
            (0..3).for_each(|c| centre[c] += colour[c]);
            self.samples.push(Sample { basis: basis(normal), colour });
        }
        let centre = centre.map(|sum| sum / self.samples.len().max(1) as f64);
        for sample in &mut self.samples {
            sample.colour = to_opponent(std::array::from_fn(|c| sample.colour[c] - centre[c]));
        }
        centre
    }

    /// The mixture with the most evidence; `None` if that is one paint.
    fn choose(&self, prior: &OpponentPrior, pixels: usize) -> Option<Mixture> {
        let tiles = (pixels as f64 / TILE).min(MOST_TILES).max(1.0);
        let weight = tiles / self.samples.len() as f64;
        let mut mixture = Mixture::blank().fitted(&self.samples, prior, weight)?;
        let [lightness, colour] = mixture.scales;
        if (lightness * lightness + 2.0 * colour * colour) < 3.0 * PURE_NOISE * PURE_NOISE {
            return None;
        }
        let evidence =
            |mixture: &Mixture| tiles * mixture.likelihood - 0.5 * UNKNOWNS * mixture.regions as f64 * tiles.ln();
        let mut best = mixture;
        while mixture.regions < MOST_REGIONS && mixture.regions < best.regions + PATIENCE {
            let Some(further) = mixture.split(&self.samples).fitted(&self.samples, prior, weight) else { break };
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

impl Paint {
    /// Number of paints, two or more.
    #[must_use]
    pub const fn regions(&self) -> usize {
        self.mixture.regions
    }

    /// The light that the paints are offsets to, the mean colour included.
    #[must_use]
    pub fn light(&self) -> Light {
        if let Some(known) = self.known {
            return known.tinted(self.centre);
        }
        let by_harmonic: [[f64; 3]; HARMONICS] =
            std::array::from_fn(|i| from_opponent(self.mixture.light.map(|channel| channel[i])));
        Light(std::array::from_fn(|c| std::array::from_fn(|i| by_harmonic[i][c]))).tinted(self.centre)
    }

    /// Log offsets of the paints (R, G, B) and the share of the pixels that have each.
    pub fn palette(&self) -> impl Iterator<Item = ([f64; 3], f64)> {
        (0..self.regions()).map(|k| (from_opponent(self.mixture.offsets[k]), self.mixture.shares[k]))
    }

    /// The paint of a pixel by its log colour and its shading under [`light`](Self::light); without a shading by its
    /// chromaticity alone.
    #[must_use]
    pub fn of_pixel(&self, log: [f64; 3], shading: Option<[f64; 3]>) -> PaintOfPixel {
        let unshaded = match shading {
            Some(shading) => to_opponent(std::array::from_fn(|c| log[c] - shading[c])),
            None => {
                let colour = to_opponent(std::array::from_fn(|c| log[c] - self.centre[c]));
                std::array::from_fn(|c| colour[c] - self.mean_shading[c])
            }
        };
        let (responsibilities, _) = self.mixture.responsibilities(unshaded, shading.is_some());
        let region = self.mixture.mean_offset(&responsibilities);
        let [lightness, colour] = self.gains;
        let gains = [if shading.is_some() { lightness } else { 0.0 }, colour, colour];
        let fine = std::array::from_fn(|c| region[c] + gains[c] * (unshaded[c] - region[c]));
        PaintOfPixel { region: from_opponent(region), fine: from_opponent(fine) }
    }
}
