//! Mutual information of colours and surface patches (Viola and Wells 1997, with patches in place of a second image).
//!
//! The depth map is split into patches of similar normal and position. Under the right pose a patch shows few colours,
//! because albedo and light vary less on a surface than in a scene; under a wrong pose its colours mix with those of
//! its neighbours. The log likelihood compares the density of colours within patches with that of all colours. It is
//! the sum over points and channels of log p(c | patch) / p(c), with both densities measured in the image under the
//! same pose.
//!
//! If a scanner's intensities are known, each level of them forms a group of samples, as a patch does. Its channel is
//! lightness.
//! Points of equal intensity look alike, whatever curve relates intensity to lightness (Koide, Oishi, Yokozuka and
//! Banno 2023).
//!
//! Method: histograms with linear weights, so that finite differences are smooth.

use super::intensity::LEVELS;
use super::patches::{PATCHES, Patches, Sight};

/// Number of levels of a channel.
const BINS: usize = 16;
/// Initial count of each bin, which keeps the logarithm of an empty bin finite.
const FLOOR: f64 = 0.5;

/// The cue over the patches of one frame.
pub(super) struct Information<'a>(pub &'a Patches);

impl Information<'_> {
    /// Adds the log likelihood of the samples' colours, tile by tile.
    pub fn evaluate(&self, sight: &Sight, colours: &[[f32; 3]], out: &mut [f64]) {
        let features: Vec<[f32; 3]> = colours.iter().copied().map(features).collect();
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

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;
    use crate::calibration::frame::{Frame, Projection};
    use crate::calibration::patches::group;
    use crate::calibration::planes::Planes;
    use crate::calibration::surface::samples;
    use crate::calibration::unknowns::State;
    use crate::pose::Similarity;
    use crate::view::{Lens, Pinhole, Size};

    const SIZE: Size = Size { width: 64, height: 48 };
    const FOCAL: f64 = 60.0;
    const DISTANCE: f64 = 2.0;
    /// Farthest shift, pixels.
    const FARTHEST: i32 = 3;

    /// Grey values that do not repeat.
    fn pattern(index: usize) -> f32 {
        let (column, row) = SIZE.position(index);
        let (x, y) = (column as f32, row as f32);
        0.5 + 0.25 * (0.41 * x + 0.003 * x * y).sin() + 0.2 * (0.53 * y - 0.004 * x * x).cos()
    }

    /// A textured plane as the camera sees it, with a point for each pixel that stays on the image.
    fn textured(intensity: Option<&dyn Fn(f32) -> f32>) -> Frame {
        let camera = Pinhole { fx: FOCAL, fy: FOCAL, cx: 31.5, cy: 23.5, lens: Lens::None };
        let margin = FARTHEST as usize + 1;
        let point = |index: usize| {
            let (column, row) = SIZE.position(index);
            let inside = |at: usize, side: usize| at >= margin && at + margin < side;
            if !(inside(column, SIZE.width) && inside(row, SIZE.height)) {
                return [f32::NAN; 3];
            }
            let along = |at: usize, centre: f64| ((at as f64 - centre) / FOCAL * DISTANCE) as f32;
            [along(column, 31.5), along(row, 23.5), DISTANCE as f32]
        };
        let planes = Planes { size: SIZE, pixels: (0..SIZE.len()).map(|index| [pattern(index); 3]).collect() };
        let points = (0..SIZE.len()).map(point).collect();
        let mut frame = Frame::new(String::new(), planes, camera, SIZE, points);
        frame.intensity = intensity.map(|of| (0..SIZE.len()).map(|index| of(pattern(index))).collect());
        frame
    }

    /// The log likelihood at every shift by whole pixels, the right pose first.
    fn values(frame: &Frame) -> Vec<f64> {
        let mut samples = samples(frame, SIZE.len());
        group(&mut samples);
        let right = State::at(Similarity::identity());
        let patches = Patches::new(&samples, &Projection::new(frame, &right), frame);
        let sight = Sight { frame, planes: &frame.planes };
        let of = |[x, y]: [i32; 2]| {
            let shift = Vector3::new(f64::from(x), f64::from(y), 0.0) * (DISTANCE / FOCAL);
            let mut out = vec![0.0; 100];
            let state = State::at(Similarity { translation: shift, ..Similarity::identity() });
            Information(&patches).evaluate(&sight, &patches.colours(&sight, &state), &mut out);
            out.iter().sum::<f64>()
        };
        let shifts = (-FARTHEST..=FARTHEST).flat_map(|x| (-FARTHEST..=FARTHEST).map(move |y| [x, y]));
        [[0, 0]].into_iter().chain(shifts.filter(|shift| *shift != [0, 0])).map(of).collect()
    }

    #[test]
    fn a_texture_is_found_at_the_right_pose_whatever_the_curve_of_the_intensity() {
        let plain = values(&textured(None));
        let curves: [&dyn Fn(f32) -> f32; 3] =
            [&|grey| 200.0 * grey, &|grey| -grey.powi(3), &|grey| (grey - 0.5).abs()];
        for (index, curve) in curves.into_iter().enumerate() {
            let found = values(&textured(Some(curve)));
            // The information that the intensity adds.
            let added: Vec<f64> = found.iter().zip(&plain).map(|(found, plain)| found - plain).collect();
            let next = added[1..].iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert!(added[0] > 1.2 * next && next > 0.0, "curve {index}: {} and {next}", added[0]);
            assert!(found[1..].iter().all(|value| *value < found[0]), "curve {index}");
        }
    }

    #[test]
    fn only_the_order_of_intensities_counts_and_unknown_ones_count_nowhere() {
        let linear = values(&textured(Some(&|grey| grey)));
        assert_eq!(values(&textured(Some(&|grey| (9.0 * grey).exp()))), linear);
        assert_eq!(values(&textured(Some(&|_| f32::NAN))), values(&textured(None)));
    }
}
