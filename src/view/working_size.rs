//! Matches the resolutions of the two views: a photograph finer than the depth map is reduced until one of its pixels
//! covers about as much of the object as one of the depth map's (docs/method/views.md).
//!
//! A working pixel is the mean of the linear intensities over a square of the photograph, whose side need not be whole.
//! Each pixel is weighted by its usable area in the square. Results are carried back to the photograph's pixels.
//! Normals of a coarse depth map cannot explain finer colours, which would be noise to the model and cost memory and
//! time. Views of similar resolution stay unchanged, and so does a depth map that is finer than the image.

use nalgebra::Vector3;

use super::colour::{self, ColourImage, ColourSamples, ColourView};
use super::{Camera, DepthMap, DepthSamples, Normals, Pinhole, Size};
use crate::error::Result;

/// Smallest ratio of resolutions at which the image is reduced. The areas of two masks do not determine smaller ratios,
/// because both views differ.
const UNLIKE: f64 = 1.25;
/// Smallest share of a working pixel that usable image pixels must cover.
const COVERED: f64 = 0.5;
/// Largest share of a working pixel that counts as rounding error and adds no further column.
const SLIVER: f64 = 1e-6;
/// Margin around the object in working pixels, if the image is cut to its mask.
const MARGIN: usize = 4;

/// Converts between the caller's image and the working image.
#[derive(Clone, Debug, PartialEq)]
pub struct WorkingSize {
    full: Size,
    working: Size,
    /// Side of a working pixel in the caller's pixels.
    factor: f64,
    /// First column and row of the caller's image in the working image.
    origin: [usize; 2],
    is_orthographic: bool,
    /// The usable pixels of the caller's image.
    mask: Vec<bool>,
}

impl WorkingSize {
    /// The working view, and its conversion if it is not the caller's image. The view has at most `most` pixels if a
    /// photograph finer than the depth map can be reduced that far.
    ///
    /// # Errors
    /// The errors of [`ColourView::new`].
    pub fn of(image: ColourImage, depth: &DepthMap, most: usize) -> Result<(ColourView, Option<Self>)> {
        let (full, object) = colour::checked(&image)?;
        let area = Area::of(full, image.mask.is_some().then_some(&object[..]));
        let own = (depth.width * depth.height).max(1);
        let mut factor = factor(&image, &object, depth);
        while area.working(factor).len() > most && area.working(factor).len() > own {
            factor += 1.0;
        }
        if factor <= 1.0 && full.len() <= most {
            return Ok((ColourView::new(image)?, None));
        }
        let working = area.working(factor);
        let is_orthographic = image.camera.is_none();
        let mut resizing = Self { full, working, factor, origin: area.origin, is_orthographic, mask: object };
        let transfer = colour::transfer_of(&image.samples, image.transfer);
        let reduced = resizing.reduce(&image, transfer);
        let view = ColourView::new(reduced)?.with_transfer(transfer);
        Ok((view, Some(resizing)))
    }

    /// Means of linear intensity; leaves the usable pixels in the mask.
    fn reduce(&mut self, image: &ColourImage, transfer: colour::Transfer) -> ColourImage {
        let Size { width, height } = self.working;
        let mut samples = vec![0.0; 3 * self.working.len()];
        let mut mask = vec![0; self.working.len()];
        for working in 0..self.working.len() {
            let (column, row) = self.working.position(working);
            let (mut sum, mut usable) = ([0.0_f64; 3], 0.0);
            for (row, height) in self.span(row, 1) {
                for (column, width) in self.span(column, 0) {
                    let pixel = self.full.index(column, row);
                    let linear = if self.mask[pixel] { image.samples.linear(pixel, transfer) } else { None };
                    self.mask[pixel] = linear.is_some();
                    if let Some(linear) = linear {
                        let area = width * height;
                        usable += area;
                        (0..3).for_each(|channel| sum[channel] += area * f64::from(linear[channel]));
                    }
                }
            }
            if usable >= COVERED * self.factor * self.factor {
                mask[working] = u8::MAX;
                (0..3).for_each(|c| samples[3 * working + c] = (sum[c] / usable) as f32);
            }
        }
        let samples = ColourSamples::RgbLinear(samples);
        let camera = image.camera.map(|camera| self.camera(camera));
        ColourImage { width, height, samples, transfer: None, mask: Some(mask), camera }
    }

    /// The caller's columns (rows along axis 1) that a working one covers, each with its covered share.
    fn span(&self, at: usize, axis: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
        let side = [self.full.width, self.full.height][axis] as f64;
        let start = self.origin[axis] as f64 + at as f64 * self.factor;
        let end = (start + self.factor).min(side);
        let share = move |pixel: usize| (pixel, end.min(pixel as f64 + 1.0) - start.max(pixel as f64));
        (start as usize..end.ceil() as usize).map(share)
    }

    fn camera(&self, Pinhole { fx, fy, cx, cy, lens }: Pinhole) -> Pinhole {
        let side = self.factor;
        let place = |centre: f64, origin: usize| (centre - origin as f64 + 0.5) / side - 0.5;
        let [cx, cy] = [place(cx, self.origin[0]), place(cy, self.origin[1])];
        Pinhole { fx: fx / side, fy: fy / side, cx, cy, lens }
    }

    /// Length of a unit of the working view in the caller's units: behind a pinhole, both are metres.
    #[must_use]
    pub fn unit(&self) -> f64 {
        if self.is_orthographic { self.factor } else { 1.0 }
    }

    /// Size of the image as given.
    #[must_use]
    pub const fn full(&self) -> Size {
        self.full
    }

    /// Side of a working pixel in the caller's pixels.
    #[must_use]
    pub const fn factor(&self) -> f64 {
        self.factor
    }

    /// Position of the working view's origin in the caller's view: the centres of two images without a camera differ if
    /// one is cut.
    #[must_use]
    pub fn shift(&self) -> Vector3<f64> {
        if !self.is_orthographic {
            return Vector3::zeros();
        }
        let middle = |side: usize| 0.5 * (side as f64 - 1.0);
        let side = self.factor;
        let shift = |origin: usize, working: usize, full: usize| {
            origin as f64 + side * middle(working) + 0.5 * (side - 1.0) - middle(full)
        };
        let [column, row] = self.origin;
        Vector3::new(
            shift(column, self.working.width, self.full.width),
            shift(row, self.working.height, self.full.height),
            0.0,
        )
    }

    /// Continuous column and row in the working view of a pixel of the caller's view.
    fn place(&self, pixel: usize) -> [f32; 2] {
        let (column, row) = self.full.position(pixel);
        let place = |at: usize, origin: usize, side: usize| {
            let place = (at as f64 - origin as f64 + 0.5) / self.factor - 0.5;
            place.clamp(0.0, (side - 1) as f64) as f32
        };
        [place(column, self.origin[0], self.working.width), place(row, self.origin[1], self.working.height)]
    }

    /// The working pixels around a position, ring by ring from the nearest.
    fn around(&self, column: f32, row: f32) -> impl Iterator<Item = usize> + use<> {
        let size = self.working;
        let offsets = (1..=2).flat_map(|ring| {
            (-ring..=ring).flat_map(move |down| (-ring..=ring).map(move |right| [right as f32, down as f32]))
        });
        offsets.filter_map(move |[right, down]| size.nearest(column + right, row + down))
    }

    /// A field at the caller's pixels, times `unit`: bilinear, with the nearest known value at borders, NaN off the
    /// mask.
    #[must_use]
    pub fn carry(&self, field: &[f32], unit: f64) -> Vec<f32> {
        let mut carried = vec![f32::NAN; self.full.len()];
        // Before the first iteration the field is empty, and searching it around each of 12 million pixels would take
        // seconds.
        if field.iter().all(|value| value.is_nan()) {
            return carried;
        }
        for pixel in (0..self.full.len()).filter(|&pixel| self.mask[pixel]) {
            let [column, row] = self.place(pixel);
            let mut value = self.working.bilinear_of_known(field, column, row);
            if value.is_nan() {
                value = self
                    .around(column, row)
                    .map(|beside| field[beside])
                    .find(|beside| !beside.is_nan())
                    .unwrap_or(value);
            }
            carried[pixel] = unit as f32 * value;
        }
        carried
    }

    /// Unit normals at the caller's pixels.
    #[must_use]
    pub fn carry_normals(&self, normals: &Normals) -> Normals {
        let [x, y, z] = [&normals.x, &normals.y, &normals.z].map(|axis| self.carry(axis, 1.0));
        let mut carried = Normals { x, y, z };
        for pixel in 0..carried.len() {
            let normal = carried.get(pixel);
            let length = normal.iter().map(|value| value * value).sum::<f32>().sqrt();
            carried.set(pixel, normal.map(|value| value / length));
        }
        carried
    }

    /// Three interleaved channels at the caller's pixels.
    #[must_use]
    pub fn carry_colours(&self, interleaved: &[f32]) -> Vec<f32> {
        let [x, y, z] = [0, 1, 2].map(|channel| {
            let plane: Vec<f32> = interleaved.iter().skip(channel).step_by(3).copied().collect();
            self.carry(&plane, 1.0)
        });
        Normals { x, y, z }.interleaved()
    }

    /// Indices at the nearest working pixel, -1 for none.
    #[must_use]
    pub fn carry_indices(&self, indices: &[i32]) -> Vec<i32> {
        let nearest = |pixel: usize| {
            let [column, row] = self.place(pixel);
            self.working.nearest(column, row).map_or(-1, |working| indices[working])
        };
        (0..self.full.len()).map(|pixel| if self.mask[pixel] { nearest(pixel) } else { -1 }).collect()
    }
}

/// The part of an image that becomes the working image.
struct Area {
    origin: [usize; 2],
    size: [usize; 2],
}

impl Area {
    /// The box around the mask, or everything without a mask.
    fn of(full: Size, mask: Option<&[bool]>) -> Self {
        let mut area = Self { origin: [0, 0], size: [full.width, full.height] };
        let Some(mask) = mask else { return area };
        let (mut low, mut high) = ([usize::MAX; 2], [0; 2]);
        for pixel in (0..full.len()).filter(|&pixel| mask[pixel]) {
            let place = [pixel % full.width, pixel / full.width];
            for axis in 0..2 {
                (low[axis], high[axis]) = (low[axis].min(place[axis]), high[axis].max(place[axis]));
            }
        }
        for axis in 0..2 {
            area.origin[axis] = low[axis].saturating_sub(MARGIN);
            area.size[axis] = (high[axis] + 1 + MARGIN).min(area.size[axis]) - area.origin[axis];
        }
        area
    }

    fn working(&self, factor: f64) -> Size {
        let across = |side: usize| (side as f64 / factor - SLIVER).ceil() as usize;
        let [width, height] = self.size.map(|side| across(side).max(super::raster::SMALLEST_SIDE));
        Size { width, height }
    }
}

/// Width of a depth pixel at the object, in image pixels. It follows from both focal lengths, else from the areas of
/// both masks, else from the sizes of the views, and is at most the last of these.
fn factor(image: &ColourImage, object: &[bool], depth: &DepthMap) -> f64 {
    let count = |inside: &[bool]| inside.iter().filter(|&&inside| inside).count();
    let frames = ratio(object.len(), depth.width * depth.height);
    let footprint = match (image.camera, depth.camera) {
        (Some(fine), Some(coarse)) => {
            let focal_length = |camera| Camera::Pinhole(camera).focal_length().unwrap_or(1.0);
            focal_length(fine) / focal_length(coarse)
        }
        _ if image.mask.is_some() => ratio(count(object), measured(depth)),
        _ => frames,
    };
    let factor = footprint.min(frames);
    // A ratio of NaN changes nothing.
    if factor >= UNLIKE { factor } else { 1.0 }
}

/// Ratio of the pixels' sides.
fn ratio(fine: usize, coarse: usize) -> f64 {
    (fine as f64 / coarse.max(1) as f64).sqrt()
}

/// Number of the depth map's pixels with a depth.
fn measured(depth: &DepthMap) -> usize {
    let inside =
        |index: usize| depth.mask.as_ref().is_none_or(|mask| mask.get(index).is_some_and(|&inside| inside != 0));
    let known = |index: usize| match &depth.samples {
        DepthSamples::Float(data) => data.get(index).is_some_and(|&value| value > 0.0 && value.is_finite()),
        DepthSamples::Integer(data) => data.get(index).is_some_and(|&value| value > 0),
        DepthSamples::Cloud(data) => data.get(3 * index + 2).is_some_and(|value| value.is_finite()),
    };
    (0..depth.width * depth.height).filter(|&index| inside(index) && known(index)).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Lens;

    const MOST: usize = 4_000_000;

    fn image(width: usize, height: usize) -> ColourImage {
        let samples = ColourSamples::RgbLinear((0..3 * width * height).map(|index| 1.0 + (index % 7) as f32).collect());
        ColourImage { width, height, samples, transfer: None, mask: None, camera: None }
    }

    fn depth(width: usize, height: usize) -> DepthMap {
        let samples = DepthSamples::Float(vec![5.0; width * height]);
        DepthMap { width, height, samples, unit: None, mask: None, camera: None, normals: None }
    }

    fn camera(focal_length: f64) -> Option<Pinhole> {
        Some(Pinhole { fx: focal_length, fy: focal_length, cx: 20.0, cy: 20.0, lens: Lens::None })
    }

    fn factor_of(image: &ColourImage, depth: &DepthMap, most: usize) -> f64 {
        WorkingSize::of(image.clone(), depth, most).unwrap().1.map_or(1.0, |resizing| resizing.factor())
    }

    #[test]
    fn the_factor_is_that_of_the_footprints_and_never_more_than_that_of_the_frames() {
        for (side, expected) in [(40, 1.0), (48, 1.0), (60, 1.5), (72, 1.8), (80, 2.0), (158, 3.95), (20, 1.0)] {
            let found = factor_of(&image(side, side), &depth(40, 40), MOST);
            assert!((found - expected).abs() < 1e-12, "{side}: {found}");
        }
        // A tenth of the columns in a frame of the same size does not make the map coarser.
        let mut narrow = depth(40, 40);
        narrow.mask = Some((0..1600).map(|index| u8::from(index % 40 < 4)).collect());
        let mut whole = image(40, 40);
        whole.mask = Some(vec![1; 1600]);
        assert_eq!(factor_of(&whole, &narrow, MOST), 1.0);
        // Focal lengths take precedence over masks, and a cut frame does not make an image coarser.
        let (mut metric, mut cut) = (image(120, 120), image(40, 40));
        (metric.camera, cut.camera) = (camera(300.0), camera(300.0));
        let mut coarse = depth(40, 40);
        coarse.camera = camera(100.0);
        assert_eq!([factor_of(&metric, &coarse, MOST), factor_of(&cut, &coarse, MOST)], [3.0, 1.0]);
        coarse.camera = camera(290.0);
        assert_eq!(factor_of(&metric, &coarse, MOST), 1.0);
        // An image that does not fit is reduced as long as it has more pixels than the depth map.
        let (mut wide, mut narrow) = (image(72, 72), depth(20, 20));
        (wide.camera, narrow.camera) = (camera(300.0), camera(300.0));
        assert_eq!([MOST, 450, 100].map(|most| factor_of(&wide, &narrow, most)), [1.0, 4.0, 4.0]);
    }

    #[test]
    fn an_object_in_a_corner_keeps_its_place() {
        let mut fine = image(123, 90);
        fine.mask = Some((0..123 * 90).map(|index| u8::from(index % 123 > 40 && index / 123 > 30)).collect());
        let mut coarse = depth(30, 22);
        coarse.mask = Some((0..30 * 22).map(|index| u8::from(index % 30 > 9 && index / 30 > 6)).collect());
        let (view, resizing) = WorkingSize::of(fine, &coarse, MOST).unwrap();
        let resizing = resizing.expect("four times as fine");
        let full = Size { width: 123, height: 90 };
        assert!((resizing.factor() - 4.1).abs() < 0.1 && resizing.factor().fract() > 0.0, "{}", resizing.factor());
        for working in [0, 40, view.size.len() - 1] {
            let (column, row) = view.size.position(working);
            // The centre of the covered area, in the frame of either view.
            let middle =
                |at: usize, axis: usize| resizing.origin[axis] as f64 + resizing.factor() * (at as f64 + 0.5) - 0.5;
            let expected = Camera::Orthographic.ray(full, [middle(column, 0), middle(row, 1)]);
            let [x, y] = Camera::Orthographic.ray(view.size, [column as f64, row as f64]);
            let found = resizing.unit() * Vector3::new(x, y, 0.0) + resizing.shift();
            assert!((found.x - expected[0]).abs() + (found.y - expected[1]).abs() < 1e-9, "{found} {expected:?}");
        }
    }

    #[test]
    fn working_pixels_share_the_image_out_among_them() {
        for side in [50, 60, 71, 72, 80, 158] {
            let (view, resizing) = WorkingSize::of(image(side, side), &depth(40, 40), MOST).unwrap();
            assert_eq!(view.size, Size { width: 40, height: 40 }, "{side}");
            let resizing = resizing.expect("finer than the depth map");
            let mut shares = vec![0.0; side];
            for (pixel, share) in (0..view.size.width).flat_map(|at| resizing.span(at, 0)) {
                assert!(share > 0.0, "{side}: {pixel}");
                shares[pixel] += share;
            }
            assert!(shares.iter().all(|share: &f64| (share - 1.0).abs() < 1e-9), "{side}: {shares:?}");
        }
    }

    #[test]
    fn a_working_pixel_is_the_mean_over_its_area() {
        // In this case a working pixel covers one and a half image pixels along both axes.
        let ramp: Vec<_> = (0..60 * 60).flat_map(|pixel| [(pixel % 60) as f32 + 1.0; 3]).collect();
        let fine = ColourImage { samples: ColourSamples::RgbLinear(ramp), ..image(60, 60) };
        let (view, _) = WorkingSize::of(fine, &depth(40, 40), MOST).unwrap();
        // The first covers column 1 and half of column 2, and the next the other half and column 3.
        for (column, expected) in [(0, (1.0 + 0.5 * 2.0) / 1.5), (1, (0.5 * 2.0 + 3.0) / 1.5)] {
            let found = f64::from(view.log[0][view.size.index(column, 20)]).exp();
            assert!((found - expected).abs() < 1e-5, "{found} {expected}");
        }
    }
}
