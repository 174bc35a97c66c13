//! Sharpens chromaticity to the resolution of brightness (docs/method/views.md).
//!
//! JPEG stores colours at half the resolution of brightness, and a Bayer sensor has one colour per pixel. Where two
//! albedos meet, brightness steps, but chromaticity drifts over three or four pixels through values that belong to
//! neither. The image itself shows this: a step changes between two neighbours, whereas the change of a drift grows
//! with the distance. Each pixel then takes the mean chromaticity of the window around it in which chromaticity and
//! brightness vary least, which lies on its own side of the edge. Brightness stays unchanged.
//!
//! M. Kuwahara et al.: "Processing of RI-angiocardiographic images", Digital Processing of Biomedical Images, 1976.
//!
//! Limits: chromaticity finer than the window is lost, and a smooth change becomes a staircase of small steps. The
//! result serves to find and remove albedo, not to compare shading.

use super::{ColourView, Size};

/// Weights of R, G, B in the brightness that is stored at full resolution (ITU-R BT.601), and the exponent of its
/// encoding.
const LUMA: [f32; 3] = [0.299, 0.587, 0.114];
const GAMMA: f32 = 2.2;
/// Chromaticity is sharpened if its [`softness`] is below this share of the softness of brightness. Set on renders with
/// varying albedo, with and without JPEG (docs/lab/thresholds.md).
const SOFT: f64 = 0.85;
/// Half width of a window, pixels: a drift of four pixels fits between two windows.
const REACH: isize = 2;
/// Smallest share of a window with known colours.
const COVERED: f32 = 0.6;
/// Weight of brightness relative to chromaticity in the variance of a window. Shading varies only brightness, and
/// albedo varies both.
const BRIGHTNESS: f32 = 0.5;
/// Rounds of the filter. A single round leaves the middle of the drift.
const ROUNDS: usize = 2;

/// Chromaticity in three channels (log S minus log brightness), and log brightness.
type Shade = [f32; 4];

impl ColourView {
    /// This view with its chromaticity as sharp as its brightness; `None` if it already is.
    pub(crate) fn with_sharp_chromaticity(&self) -> Option<Self> {
        let mut shades: Vec<Shade> = (0..self.size.len()).map(|index| shade(self.log_at(index))).collect();
        if softness(self.size, &shades, 0..3) >= SOFT * softness(self.size, &shades, 3..4) {
            return None;
        }
        for _ in 0..ROUNDS {
            let windows: Vec<Option<(Shade, f32)>> =
                (0..self.size.len()).map(|index| window(self.size, &shades, index)).collect();
            for index in (0..self.size.len()).filter(|&index| self.mask[index]) {
                let around = [-REACH, 0, REACH].into_iter().flat_map(|down| {
                    [-REACH, 0, REACH].into_iter().filter_map(move |right| beside(self.size, index, right, down))
                });
                let calmest = around.filter_map(|near| windows[near]).min_by(|a, b| a.1.total_cmp(&b.1));
                if let Some(([r, g, b, _], _)) = calmest {
                    shades[index] = [r, g, b, shades[index][3]];
                }
            }
        }
        let mut log = [(); 3].map(|()| vec![f32::NAN; self.size.len()]);
        for index in (0..self.size.len()).filter(|&index| self.mask[index]) {
            let [r, g, b, bright] = shades[index];
            // The brightness of the mean chromaticity is subtracted.
            let offset = bright - brightness([r, g, b]);
            (0..3).for_each(|channel| log[channel][index] = [r, g, b][channel] + offset);
        }
        Some(Self::of(self.size, self.camera, self.mask.clone(), log, self.transfer))
    }
}

/// Logarithm of the stored brightness of a colour.
fn brightness(log: [f32; 3]) -> f32 {
    GAMMA * (0..3).map(|channel| LUMA[channel] * (log[channel] / GAMMA).exp()).sum::<f32>().ln()
}

fn shade(log: [f32; 3]) -> Shade {
    let bright = brightness(log);
    [log[0] - bright, log[1] - bright, log[2] - bright, bright]
}

fn beside(size: Size, index: usize, right: isize, down: isize) -> Option<usize> {
    let (column, row) = size.position(index);
    let (column, row) = (column.checked_add_signed(right)?, row.checked_add_signed(down)?);
    (column < size.width && row < size.height).then(|| size.index(column, row))
}

/// Squared differences of neighbours over those of pixels two apart: 1/2 for steps, 1/4 for slopes, 1 for noise.
fn softness(size: Size, shades: &[Shade], members: std::ops::Range<usize>) -> f64 {
    let (mut near, mut far) = (0.0, f64::MIN_POSITIVE);
    for index in 0..size.len() {
        for (right, down) in [(1, 0), (0, 1)] {
            let Some(end) = beside(size, index, 2 * right, 2 * down) else { continue };
            let [a, b, c] = [index, usize::midpoint(index, end), end].map(|index| shades[index]);
            for member in members.clone().filter(|_| [a, b, c].iter().all(|shade| shade[3].is_finite())) {
                near += f64::from(b[member] - a[member]).powi(2);
                far += f64::from(c[member] - a[member]).powi(2);
            }
        }
    }
    near / far
}

/// Mean and variance in the window around a pixel; `None` if too few of its pixels have a colour.
fn window(size: Size, shades: &[Shade], index: usize) -> Option<(Shade, f32)> {
    let (mut count, mut sum, mut square) = (0.0, [0.0; 4], [0.0; 4]);
    for down in -REACH..=REACH {
        for right in -REACH..=REACH {
            let Some(near) = beside(size, index, right, down).filter(|&near| shades[near][3].is_finite()) else {
                continue;
            };
            count += 1.0;
            for (member, value) in shades[near].into_iter().enumerate() {
                sum[member] += value;
                square[member] += value * value;
            }
        }
    }
    let side = (2 * REACH + 1) as f32;
    let mean = sum.map(|sum| sum / count);
    let variance = |member: usize| (square[member] / count - mean[member] * mean[member]).max(0.0);
    let all = variance(0) + variance(1) + variance(2) + BRIGHTNESS * BRIGHTNESS * variance(3);
    (count >= COVERED * side * side).then_some((mean, all))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::noise;
    use crate::view::{Camera, Transfer};

    const SIDE: usize = 40;

    /// Two albedos of one brightness gradient with 1 % noise, side by side; chromaticity drifts over `drift` pixels.
    fn two_albedos(drift: f32) -> ColourView {
        let mut dice = noise::white_noise(3);
        let mut log = [(); 3].map(|()| vec![f32::NAN; SIDE * SIDE]);
        for index in 0..SIDE * SIDE {
            let (column, row) = ((index % SIDE) as f32, (index / SIDE) as f32);
            let share = (0.5 + (column - 19.5) / drift).clamp(0.0, 1.0);
            let hue = [0.4 - 0.7 * share, 0.1, -0.3 + 0.8 * share];
            let bright = if column < 19.5 { -1.0 } else { -0.6 } + 0.01 * row + 0.01 * dice() as f32;
            let offset = bright - brightness(hue);
            (0..3).for_each(|channel| log[channel][index] = hue[channel] + offset);
        }
        let size = Size { width: SIDE, height: SIDE };
        ColourView::of(size, Camera::Orthographic, vec![true; SIDE * SIDE], log, Transfer::Srgb)
    }

    #[test]
    fn hues_that_drift_become_as_sharp_as_brightness() {
        let (sharp, soft) = (two_albedos(0.5), two_albedos(4.0));
        let again = soft.with_sharp_chromaticity().expect("hue is softer than brightness");
        let off = |view: &ColourView| -> f32 {
            let apart = |index: usize| {
                let [a, b] = [view, &sharp].map(|view| shade(view.log_at(index)));
                (0..3).map(|channel| (a[channel] - b[channel]).abs()).fold(0.0, f32::max)
            };
            (0..SIDE * SIDE).map(apart).sum::<f32>() / (SIDE * SIDE) as f32
        };
        assert!(off(&again) < 0.2 * off(&soft), "{} of {}", off(&again), off(&soft));
        for index in 0..SIDE * SIDE {
            let [before, after] = [&soft, &again].map(|view| shade(view.log_at(index))[3]);
            assert!((before - after).abs() < 1e-4, "brightness {before} became {after}");
        }
    }

    #[test]
    fn what_is_sharp_is_left_alone() {
        assert!(two_albedos(0.5).with_sharp_chromaticity().is_none());
    }
}
