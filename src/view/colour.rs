//! The colour image: checked once and converted to log intensities over a mask (docs/method/views.md).

use crate::error::{Error, ErrorKind, Result};
use crate::numeric::{noise, quantile};
use crate::view::mask::{self, FEWEST_PIXELS};
use crate::view::{Camera, Pinhole, Size};

/// How integers encode intensity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transfer {
    /// IEC 61966-2-1.
    Srgb,
    /// Proportional to intensity.
    Linear,
}

/// Samples as a file or a canvas holds them.
#[derive(Clone, Debug, PartialEq)]
pub enum ColourSamples {
    /// R, G, B, A of each pixel, 8 bit.
    Rgba8(Vec<u8>),
    /// R, G, B, A of each pixel, 16 bit.
    Rgba16(Vec<u16>),
    /// R, G, B of each pixel, linear and above zero.
    RgbLinear(Vec<f32>),
}

/// One colour image of the object, not yet checked.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourImage {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Samples, row-major.
    pub samples: ColourSamples,
    /// Encoding of integer samples; `None`: sRGB for 8 bit, guessed for 16 bit.
    pub transfer: Option<Transfer>,
    /// Non-zero where the object is; `None`: everywhere.
    pub mask: Option<Vec<u8>>,
    /// The intrinsics; `None` for an orthographic view.
    pub camera: Option<Pinhole>,
}

/// The checked colour view: natural logarithms of linear intensity, where they exist.
#[derive(Clone, Debug, PartialEq)]
pub struct ColourView {
    /// Size of the image.
    pub size: Size,
    /// The mapping from points to pixels.
    pub camera: Camera,
    /// Object pixels with usable colours.
    pub mask: Vec<bool>,
    /// log S of R, G, B; NaN off the mask.
    pub log: [Vec<f32>; 3],
    /// The encoding with which integers were decoded; floats are linear.
    pub transfer: Transfer,
    /// The whole frame; empty in views that were derived from another view.
    pub whole: WholeFrame,
    log_spread: f64,
    log_noise: f64,
}

/// The input of silhouettes and edges.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WholeFrame {
    /// The caller's mask, including black and saturated pixels; all pixels if there is no mask.
    pub object: Vec<bool>,
    /// Brightness as displayed, 0 .. 1 for integers, also outside the object; empty without intrinsics.
    pub grey: Vec<f32>,
}

/// Darkest usable 8-bit level, below which one quantisation step exceeds a quarter of the intensity.
const DARKEST_LEVEL_8: u8 = 4;
/// Darkest usable 16-bit level: level 4 of a 12-bit sensor, whose steps are 16 times coarser.
const DARKEST_LEVEL_16: u16 = 64;

impl ColourView {
    /// Checks the image and takes its logarithms. The mask excludes pixels that are black, saturated, transparent, or
    /// over 10000 times brighter or darker than the median.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] for sizes that disagree, [`ErrorKind::Range`] for invalid intrinsics or lenses,
    /// [`ErrorKind::Empty`] if fewer than 16 pixels are usable.
    pub fn new(image: ColourImage) -> Result<Self> {
        let (size, object) = checked(&image)?;
        let transfer = transfer_of(&image.samples, image.transfer);
        let grey = |index| image.samples.grey(index);
        let grey = if image.camera.is_some() { (0..size.len()).map(grey).collect() } else { Vec::new() };
        let whole = WholeFrame { object: object.clone(), grey };
        let mut log = [(); 3].map(|()| vec![f32::NAN; size.len()]);
        let mut usable = vec![false; size.len()];
        for index in (0..size.len()).filter(|&index| object[index]) {
            if let Some(linear) = image.samples.linear(index, transfer) {
                usable[index] = true;
                for channel in 0..3 {
                    log[channel][index] = linear[channel].ln();
                }
            }
        }
        leave_out_far_from_median(&log, &mut usable);
        let camera = image.camera.map_or(Camera::Orthographic, Camera::Pinhole);
        camera.keep_pixels_with_rays("image.camera.distortion", size, &log[0], &mut usable)?;
        for index in (0..size.len()).filter(|&index| !usable[index]) {
            log.iter_mut().for_each(|channel| channel[index] = f32::NAN);
        }
        if usable.iter().filter(|&&usable| usable).count() < FEWEST_PIXELS {
            return Err(Error::new(
                ErrorKind::Empty,
                "image.data",
                format!("fewer than {FEWEST_PIXELS} object pixels are neither black nor saturated"),
            ));
        }
        Ok(Self { whole, ..Self::of(size, camera, usable, log, transfer) })
    }

    /// Whether this is a camera's whole frame: it has intrinsics and no mask, and over half of its first and last rows
    /// have usable colours.
    pub fn is_whole_frame(&self) -> bool {
        let (width, whole) = (self.size.width, &self.whole.object);
        let shown = |row: &[bool]| row.iter().filter(|&&is_shown| is_shown).count();
        let edges = shown(&self.mask[..width]) + shown(&self.mask[self.mask.len() - width..]);
        !self.camera.is_orthographic() && edges > width && !whole.is_empty() && !whole.contains(&false)
    }

    /// The object: the caller's mask, or else the pixels with usable colours.
    pub(crate) fn object(&self) -> &[bool] {
        if self.whole.object.contains(&false) { &self.whole.object } else { &self.mask }
    }

    /// A view of these logarithms, which are NaN off the mask.
    pub(super) fn of(size: Size, camera: Camera, mask: Vec<bool>, log: [Vec<f32>; 3], transfer: Transfer) -> Self {
        // The logarithms are computed once, because the preparation of every stage needs them.
        let (log_spread, log_noise) = (spread_of(&log), noise_of(size, &log));
        Self { size, camera, mask, log, transfer, whole: WholeFrame::default(), log_spread, log_noise }
    }

    /// The same view for an image with another encoding.
    pub(super) fn with_transfer(self, transfer: Transfer) -> Self {
        Self { transfer, ..self }
    }

    /// Mean of log S over the mask and the three channels, which a change of exposure shifts.
    #[must_use]
    pub fn log_mean(&self) -> f64 {
        let inside = || self.log.iter().flatten().filter(|log| log.is_finite()).map(|&log| f64::from(log));
        inside().sum::<f64>() / inside().count().max(1) as f64
    }

    /// Standard deviation of log S over the mask, the three channels together (root of the sum of their variances).
    #[must_use]
    pub const fn log_spread(&self) -> f64 {
        self.log_spread
    }

    /// Standard deviation of the noise of log S in one channel, from fourth differences along rows and columns; printed
    /// texture counts as noise.
    #[must_use]
    pub const fn log_noise(&self) -> f64 {
        self.log_noise
    }

    /// The same view with `share` of each channel's median intensity added: log(I + share median I). This reduces the
    /// weight of the dark end, where logarithms amplify unmodelled light.
    #[must_use]
    pub(crate) fn lifted(&self, share: f32) -> Self {
        let log = self.log.each_ref().map(|channel| {
            let mut known: Vec<f32> = channel.iter().copied().filter(|log| !log.is_nan()).collect();
            let added = share * quantile(&mut known, 0.5).exp();
            channel.iter().map(|log| (log.exp() + added).ln()).collect()
        });
        Self::of(self.size, self.camera, self.mask.clone(), log, self.transfer)
    }

    /// Standard deviation of the noise in a difference of neighbours. The median ignores edges of albedo, because most
    /// neighbours share one albedo.
    pub(super) fn edge_noise(&self) -> f32 {
        let mut steps: Vec<f32> = (self.size.runs())
            .filter(|pair| pair.iter().all(|&index| self.mask[index]))
            .map(|[first, second]| {
                let step = self.log.each_ref().map(|channel| channel[second] - channel[first]);
                (step[0] - step[1]).abs().max((step[1] - step[2]).abs()) * std::f32::consts::FRAC_1_SQRT_2
            })
            .collect();
        if steps.is_empty() { 0.0 } else { quantile(&mut steps, 0.5) }
    }

    /// log S of the three channels at a pixel, NaN off the mask.
    #[must_use]
    pub fn log_at(&self, index: usize) -> [f32; 3] {
        [self.log[0][index], self.log[1][index], self.log[2][index]]
    }
}

/// Size and object mask of an image whose parts are consistent.
pub(super) fn checked(image: &ColourImage) -> Result<(Size, Vec<bool>)> {
    let size = Size::new("image", image.width, image.height)?;
    if let Some(camera) = &image.camera {
        camera.validate("image.camera")?;
    }
    let object = mask::checked("image.mask", size, image.mask.as_deref())?;
    let (channels, length) = match &image.samples {
        ColourSamples::Rgba8(data) => (4, data.len()),
        ColourSamples::Rgba16(data) => (4, data.len()),
        ColourSamples::RgbLinear(data) => (3, data.len()),
    };
    if length != channels * size.len() {
        return Err(Error::new(
            ErrorKind::Size,
            "image.data",
            format!("{}x{} pixels need {} samples, not {length}", size.width, size.height, channels * size.len()),
        ));
    }
    Ok((size, object))
}

/// Largest deviation of log intensity from the channel's median, log units: a factor of 10000. This exceeds the contrast
/// of any picture of one object; floats beyond it mark missing pixels.
const FARTHEST_FROM_MEDIAN: f32 = 9.21;

fn leave_out_far_from_median(log: &[Vec<f32>; 3], usable: &mut [bool]) {
    for channel in log {
        let mut known: Vec<f32> = channel.iter().copied().filter(|log| !log.is_nan()).collect();
        if known.is_empty() {
            return;
        }
        let middle = quantile(&mut known, 0.5);
        for (usable, log) in usable.iter_mut().zip(channel) {
            *usable &= (log - middle).abs() <= FARTHEST_FROM_MEDIAN;
        }
    }
}

fn spread_of(log: &[Vec<f32>; 3]) -> f64 {
    let spread = |channel: &[f32]| {
        let inside = || channel.iter().filter(|log| !log.is_nan()).map(|&log| f64::from(log));
        let count = inside().count().max(1) as f64;
        let mean = inside().sum::<f64>() / count;
        inside().map(|log| (log - mean).powi(2)).sum::<f64>() / count
    };
    log.iter().map(|channel| spread(channel)).sum::<f64>().sqrt()
}

fn noise_of(size: Size, log: &[Vec<f32>; 3]) -> f64 {
    let fourth = |channel: &[f32], run: [usize; noise::NEIGHBOURS]| {
        noise::fourth_difference(run.map(|index| f64::from(channel[index]))) as f32
    };
    let mut fourths = log.iter().flat_map(|channel| size.runs().map(|run| fourth(channel, run)));
    noise::of_fourth_differences(&mut fourths, 6 * size.len())
}

impl ColourSamples {
    /// Linear intensity of a pixel; `None` if it is black, saturated, transparent or not a number.
    pub(super) fn linear(&self, index: usize, transfer: Transfer) -> Option<[f32; 3]> {
        match self {
            Self::Rgba8(data) => {
                let pixel = &data[4 * index..4 * index + 4];
                let usable =
                    pixel[3] > 0 && pixel[..3].iter().all(|&level| (DARKEST_LEVEL_8..u8::MAX).contains(&level));
                usable.then(|| [0, 1, 2].map(|c| decode(f32::from(pixel[c]) / f32::from(u8::MAX), transfer)))
            }
            Self::Rgba16(data) => {
                let pixel = &data[4 * index..4 * index + 4];
                let usable =
                    pixel[3] > 0 && pixel[..3].iter().all(|&level| (DARKEST_LEVEL_16..u16::MAX).contains(&level));
                usable.then(|| [0, 1, 2].map(|c| decode(f32::from(pixel[c]) / f32::from(u16::MAX), transfer)))
            }
            Self::RgbLinear(data) => {
                let pixel = [data[3 * index], data[3 * index + 1], data[3 * index + 2]];
                pixel.iter().all(|&value| value.is_finite() && value > 0.0).then_some(pixel)
            }
        }
    }
}

impl ColourSamples {
    /// Mean of a pixel's channels as displayed: integers as stored, the square root of linear floats.
    fn grey(&self, index: usize) -> f32 {
        let grey = match self {
            Self::Rgba8(data) => (0..3).map(|c| f32::from(data[4 * index + c]) / f32::from(u8::MAX)).sum::<f32>() / 3.0,
            Self::Rgba16(data) => {
                (0..3).map(|c| f32::from(data[4 * index + c]) / f32::from(u16::MAX)).sum::<f32>() / 3.0
            }
            Self::RgbLinear(data) => (data[3 * index..3 * index + 3].iter().sum::<f32>() / 3.0).max(0.0).sqrt(),
        };
        if grey.is_finite() { grey } else { 0.0 }
    }
}

/// The given transfer, or else the default: floats are linear, 8 bit is sRGB, and 16 bit is sRGB exactly if widened
/// from 8 bit.
pub(crate) fn transfer_of(samples: &ColourSamples, given: Option<Transfer>) -> Transfer {
    /// An 8-bit level widened to 16 bit is a multiple of 257.
    const WIDENED: u16 = 257;
    match (samples, given) {
        (ColourSamples::RgbLinear(_), _) => Transfer::Linear,
        (_, Some(transfer)) => transfer,
        (ColourSamples::Rgba8(_), None) => Transfer::Srgb,
        (ColourSamples::Rgba16(data), None) if data.iter().all(|level| level % WIDENED == 0) => Transfer::Srgb,
        (ColourSamples::Rgba16(_), None) => Transfer::Linear,
    }
}

/// Encoded value in 0 .. 1 to linear intensity (IEC 61966-2-1 for sRGB).
fn decode(value: f32, transfer: Transfer) -> f32 {
    match transfer {
        Transfer::Linear => value,
        Transfer::Srgb if value <= 0.040_45 => value / 12.92,
        Transfer::Srgb => ((f64::from(value) + 0.055) / 1.055).powf(2.4) as f32,
    }
}

/// Linear intensity to the encoding of a display: the inverse curve of IEC 61966-2-1.
pub(crate) fn to_srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Lens;

    fn image(samples: ColourSamples) -> ColourImage {
        ColourImage { width: 4, height: 4, samples, transfer: None, mask: None, camera: None }
    }

    #[test]
    fn srgb_middle_grey_is_a_fifth_of_white() {
        let view = ColourView::new(image(ColourSamples::Rgba8([119, 119, 119, 255].repeat(16)))).unwrap();
        assert!((view.log[0][0].exp() - 0.1845).abs() < 1e-3);
    }

    #[test]
    fn a_frame_that_is_filled_is_whole_unless_a_mask_says_what_the_object_is() {
        let camera = Some(Pinhole { fx: 8.0, fy: 8.0, cx: 3.5, cy: 3.5, lens: Lens::None });
        let is_middle = |index: usize| (2..6).contains(&(index % 8)) && (2..6).contains(&(index / 8));
        let grey = |dark: bool, index: usize| if dark && !is_middle(index) { 0 } else { 90 };
        let levels =
            |dark: bool| (0..64).flat_map(|index| [[grey(dark, index); 3].as_slice(), &[255]].concat()).collect();
        let frame = |dark, mask, camera| {
            let samples = ColourSamples::Rgba8(levels(dark));
            let image = ColourImage { width: 8, height: 8, mask, camera, ..image(samples) };
            ColourView::new(image).unwrap().is_whole_frame()
        };
        assert!(frame(false, None, camera));
        // An object in front of black, one given by a mask, and an image without a camera.
        assert!(!frame(true, None, camera));
        assert!(!frame(false, Some((0..64).map(|index| u8::from(is_middle(index))).collect()), camera));
        assert!(!frame(false, None, None));
    }

    /// Stripes count as noise whichever way the camera is held.
    #[test]
    fn noise_is_the_same_however_the_view_is_held() {
        let side = 12;
        let pixel = |column: usize, row: usize| {
            [0.5_f32, 0.4, 0.3].map(|grey| grey * (1.0 + 0.2 * (column % 3) as f32 + 0.01 * row as f32))
        };
        let view = |turned: bool| {
            let place = |index: usize| if turned { (index / side, index % side) } else { (index % side, index / side) };
            let data = (0..side * side).map(place).flat_map(|(column, row)| pixel(column, row)).collect();
            let image = ColourImage { width: side, height: side, ..image(ColourSamples::RgbLinear(data)) };
            ColourView::new(image).unwrap()
        };
        let (upright, turned) = (view(false), view(true));
        assert!(upright.log_noise() > 0.0);
        assert_eq!(upright.log_noise(), turned.log_noise());
        assert_eq!(upright.edge_noise(), turned.edge_noise());
    }

    #[test]
    fn sixteen_bit_is_guessed_from_its_levels() {
        let widened = image(ColourSamples::Rgba16([257 * 100, 257 * 90, 257 * 80, 65535].repeat(16)));
        assert_eq!(ColourView::new(widened).unwrap().transfer, Transfer::Srgb);
        let fine = image(ColourSamples::Rgba16([20001, 30002, 10003, 65535].repeat(16)));
        assert_eq!(ColourView::new(fine).unwrap().transfer, Transfer::Linear);
    }

    #[test]
    fn black_and_saturated_pixels_are_masked() {
        let mut data = [100_u8, 100, 100, 255].repeat(18);
        data[0] = 0;
        data[5] = 255;
        let mut wide = image(ColourSamples::Rgba8(data));
        (wide.width, wide.height) = (6, 3);
        assert_eq!(ColourView::new(wide.clone()).unwrap_err().kind(), ErrorKind::Size);
        let mut data = [100_u8, 100, 100, 255].repeat(24);
        data[0] = 0;
        data[5] = 255;
        wide.samples = ColourSamples::Rgba8(data);
        wide.height = 4;
        let view = ColourView::new(wide).unwrap();
        assert_eq!(view.mask.iter().filter(|&&usable| usable).count(), 22);
    }

    #[test]
    fn black_and_saturated_pixels_belong_to_the_object_of_a_mask() {
        let mut data = [100_u8, 100, 100, 255].repeat(24);
        (data[0], data[5]) = (0, 255);
        let mask = (0..24).map(|index| u8::from(index < 20)).collect();
        let mut masked = image(ColourSamples::Rgba8(data));
        (masked.width, masked.height, masked.mask) = (6, 4, Some(mask));
        let view = ColourView::new(masked.clone()).unwrap();
        assert_eq!(view.object().iter().filter(|&&inside| inside).count(), 20);
        masked.mask = None;
        let view = ColourView::new(masked).unwrap();
        assert_eq!(view.object(), view.mask);
    }

    #[test]
    fn pixels_far_from_the_median_are_masked() {
        let mut data = vec![0.5_f32; 3 * 24];
        (data[0], data[4], data[8]) = (f32::MAX, 6e3, 1e-30);
        let mut linear = image(ColourSamples::RgbLinear(data));
        (linear.width, linear.height) = (6, 4);
        let view = ColourView::new(linear).unwrap();
        assert_eq!(view.mask[..4], [false, false, false, true]);
        assert_eq!(view.log_spread(), 0.0);
    }

    #[test]
    fn an_all_black_image_is_refused_by_name() {
        let error = ColourView::new(image(ColourSamples::Rgba8([0, 0, 0, 255].repeat(16)))).unwrap_err();
        assert_eq!((error.kind(), error.field()), (ErrorKind::Empty, "image.data"));
    }

    #[test]
    fn a_wrong_length_is_refused_by_name() {
        let error = ColourView::new(image(ColourSamples::RgbLinear(vec![1.0; 47]))).unwrap_err();
        assert_eq!((error.kind(), error.field()), (ErrorKind::Size, "image.data"));
    }
}
