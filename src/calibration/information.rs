//! Mutual information of colours and surface patches (Viola and Wells 1997, with patches in place of a second image).
//!
//! The depth map is split into patches of similar normal and position. Under the right pose a patch shows few colours,
//! because albedo and light vary less on a surface than in a scene; under a wrong pose its colours mix with those of its
//! neighbours. The log likelihood is that of colours given patches over that of colours alone, the sum over points and
//! channels of log p(c | patch) / p(c), with both densities measured in the image under the same pose.
//!
//! Where a scanner's intensities are known, their levels group the samples once more, with lightness as the channel: what
//! reflects alike looks alike, whatever the curve between the two (Koide, Oishi, Yokozuka and Banno 2023).
//!
//! Method: histograms with linear weights, so that finite differences are smooth.

use super::intensity::LEVELS;
use super::patches::{PATCHES, Patches, Sight};
use super::unknowns::State;

/// Levels of a channel.
const BINS: usize = 16;
/// Initial count of each bin, which keeps the logarithm of an empty bin finite.
const FLOOR: f64 = 0.5;

/// The cue over the patches of one frame.
pub(super) struct Information<'a>(pub &'a Patches);

impl Information<'_> {
    /// The log likelihood at a state, tile by tile.
    pub fn evaluate(&self, sight: &Sight, state: &State, out: &mut [f64]) {
        out.fill(0.0);
        let features: Vec<[f32; 3]> =
            self.0.colours(sight, state).map(|colour| colour.map_or([f32::NAN; 3], features)).collect();
        let mut joint = vec![[FLOOR; BINS]; PATCHES];
        for channel in 0..3 {
            self.add(&features, channel, &self.0.patches, &mut joint, out);
        }
        if sight.frame.intensity.is_some() {
            self.add(&features, 0, &self.0.levels, &mut joint[..LEVELS], out);
        }
    }

    /// Adds the sum over samples of log p(c | group) / p(c) for one channel; `joint` has a row for each group.
    fn add(&self, features: &[[f32; 3]], channel: usize, groups: &[u8], joint: &mut [[f64; BINS]], out: &mut [f64]) {
        joint.iter_mut().for_each(|bins| bins.fill(FLOOR));
        for (level, &group) in features.iter().zip(groups) {
            if let (Some((bin, share)), Some(bins)) = (split(level[channel]), joint.get_mut(group as usize)) {
                bins[bin] += 1.0 - share;
                bins[bin + 1] += share;
            }
        }
        let marginal: [f64; BINS] = std::array::from_fn(|bin| joint.iter().map(|bins| bins[bin]).sum());
        let total: f64 = marginal.iter().sum();
        for bins in joint.iter_mut() {
            let own: f64 = bins.iter().sum();
            *bins = std::array::from_fn(|bin| (bins[bin] / own / (marginal[bin] / total)).ln());
        }
        for ((level, &group), &tile) in features.iter().zip(groups).zip(&self.0.tiles) {
            if let (Some((bin, share)), Some(logs)) = (split(level[channel]), joint.get(group as usize)) {
                out[tile as usize] += (1.0 - share) * logs[bin] + share * logs[bin + 1];
            }
        }
    }
}

/// Lightness and two colour differences, each about 0 .. 1.
fn features([r, g, b]: [f32; 3]) -> [f32; 3] {
    [(r + g + b) / 3.0, 0.5 + (r - g), 0.5 + (0.5 * (r + g) - b)]
}

fn split(level: f32) -> Option<(usize, f64)> {
    if level.is_nan() {
        return None;
    }
    let place = f64::from(level.clamp(0.0, 1.0)) * (BINS - 1) as f64;
    let bin = (place as usize).min(BINS - 2);
    Some((bin, place - bin as f64))
}
