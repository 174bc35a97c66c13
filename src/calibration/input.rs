//! Input of a check: frames with their cameras, validated once, and warnings about implausible ones.

use super::ahead::Ahead;
use super::frame::Frame;
use super::planes::Planes;
use super::reason::{Warning, WarningKind};
use super::sampling::{Gathered, gathered};
use super::unknowns::State;
use crate::check::positive;
use crate::error::{Error, ErrorKind, Result};
use crate::pose::Similarity;
use crate::view::{ColourSamples, DepthSamples, Lens, Pinhole, Size, Transfer, to_srgb, transfer_of};

/// Largest side of an image that is used at full size, pixels. Larger images are halved, because a depth map does not
/// determine finer detail.
const WIDEST: usize = 1000;
/// Range of depth cameras, metres.
const NEAREST: f32 = 0.1;
const FARTHEST: f32 = 20.0;
/// Largest usual median depth of organised clouds, metres; LiDARs produce such clouds as well.
const FARTHEST_OF_CLOUDS: f32 = 200.0;
/// Smallest depth that counts as missing, metres, as in all depth maps. The squares of larger depths overflow f32.
const BEYOND: f32 = crate::view::FARTHEST as f32;
/// Share of missing depths above which a depth map without a mask gets a warning.
const MANY_HOLES: f64 = 0.4;
/// Largest level of 8 bits; integer depths with a higher level have more bits.
const LEVELS_OF_A_BYTE: u16 = 255;
/// If more than this share of the neighbours differ by a tenth of their depth, the input is probably not a depth map.
const ROUGH_SHARE: f64 = 0.25;
const ROUGH_JUMP: f32 = 0.1;
/// Range of intensities, 0 .. 1, below which an image is blank.
const BLANK: f32 = 0.02;
/// Minimum number of depths in a frame.
const FEWEST_DEPTHS: usize = 200;
/// Focal length divided by the longer side of the image if no intrinsics are given, a field of view of 62 degrees.
const USUAL_FOCAL: f64 = 0.83;

/// Largest deviation of an entry of a rotation from the nearest rotation; matrices of trackers drift by 1e-3.
const ROTATION_TOLERANCE: f64 = 0.01;

/// One pair of frames, not yet validated.
#[derive(Clone, Debug)]
pub struct RigView {
    /// Name of the frame in the report.
    pub name: String,
    /// Columns and rows of the colour image.
    pub image_size: [usize; 2],
    /// Samples of the colour image.
    pub image: ColourSamples,
    /// Encoding of integer samples; `None` means that of a display.
    pub transfer: Option<Transfer>,
    /// Non-zero where the object is in the image.
    pub image_mask: Option<Vec<u8>>,
    /// Intrinsics of the colour camera; if `None`, the focal length is estimated.
    pub image_camera: Option<Pinhole>,
    /// Columns and rows of the depth map.
    pub depth_size: [usize; 2],
    /// Samples of the depth map; a cloud needs no camera.
    pub depth: DepthSamples,
    /// Metres per stored unit; `None` means 0.001 for integers and 1 otherwise.
    pub unit: Option<f64>,
    /// The strength of the return at each depth, or any other quantity of the surface's reflectivity, not necessarily an
    /// increasing one; NaN where unknown. Only its rank is used.
    pub intensity: Option<Vec<f32>>,
    /// Non-zero where depths may be used.
    pub depth_mask: Option<Vec<u8>>,
    /// Intrinsics of the depth camera, required unless the depth map is a cloud.
    pub depth_camera: Option<Pinhole>,
}

impl RigView {
    /// Whether the depths are an organised cloud, whose axes may be those of a LiDAR.
    pub(super) const fn is_cloud(&self) -> bool {
        matches!(self.depth, DepthSamples::Cloud(_))
    }

    /// The frame in the form that the check uses, and whether its colour camera is guessed. `index` is the frame's number
    /// in messages.
    ///
    /// # Errors
    /// The error names the member at fault below `frames`.
    pub(super) fn prepare(self, index: usize, warnings: &mut Vec<Warning>) -> Result<(Frame, bool)> {
        let name = self.name.clone();
        let is_cloud = self.is_cloud();
        let of = |view: &str, kind| Warning { name: name.clone(), field: format!("frames[{index}].{view}"), kind };
        let size = Size::new("image", self.image_size[0], self.image_size[1])?;
        let grid = Size::new("depth", self.depth_size[0], self.depth_size[1])?;
        for (field, mask, size) in [("image.mask", &self.image_mask, size), ("depth.mask", &self.depth_mask, grid)] {
            if let Some(mask) = mask {
                must_be(field, mask.len(), size.len())?;
            }
        }
        if let Some(intensity) = &self.intensity {
            must_be("depth.intensity", intensity.len(), grid.len())?;
        }
        let planes = Planes { size, pixels: encoded(&self.image, self.transfer, size)? };
        if planes.pixels.iter().flatten().all(|value| (value - planes.pixels[0][0]).abs() < BLANK) {
            warnings.push(of("image", WarningKind::BlankImage));
        }
        let points = points(&self, grid)?;
        let known = points.iter().filter(|point| !point[2].is_nan()).count();
        if known < FEWEST_DEPTHS {
            let message = format!("has {known} depths inside its mask; at least {FEWEST_DEPTHS} are needed");
            return Err(Error::new(ErrorKind::Empty, "depth", message));
        }
        warnings.extend(doubts(&self, grid, &points).into_iter().map(|kind| of("depth", kind)));
        let is_guessed = self.image_camera.is_none();
        if is_guessed {
            warnings.push(of("image.camera", WarningKind::IntrinsicsGuessed));
        }
        let camera = self.image_camera.unwrap_or_else(|| {
            let focal = USUAL_FOCAL * size.width.max(size.height) as f64;
            let [cx, cy] = [size.width, size.height].map(|side| (side as f64 - 1.0) / 2.0);
            Pinhole { fx: focal, fy: focal, cx, cy, lens: Lens::None }
        });
        validate(&camera, size, "image.camera")?;
        let Gathered { grid: cells, cell, points, sources } = gathered(grid, points);
        let mut frame = Frame::new(self.name, planes, camera, cells, points);
        (frame.cell, frame.map) = (cell, grid);
        frame.depth_camera = self.depth_camera.filter(|_| !is_cloud);
        frame.intensity = self.intensity.map(|all| match sources.len() {
            0 => all,
            // A cell without a sample has no source.
            _ => sources.iter().map(|&source| all.get(source).copied().unwrap_or(f32::NAN)).collect(),
        });
        frame.places = sources.into_iter().map(|index| grid.position(index)).collect();
        let mask = self.image_mask.map(|mask| mask.into_iter().map(|value| value != 0).collect::<Vec<bool>>());
        if let Some(mask) = &mask {
            frame.planes.keep_near(mask);
        }
        frame.image_mask = mask;
        frame.has_depth_mask = self.depth_mask.is_some();
        // The raster of an organised cloud may be that of either camera.
        let shares_camera = self.depth_camera.is_none_or(|own| Some(own) == self.image_camera);
        frame.may_be_registered = self.depth_size == self.image_size && shares_camera;
        while frame.planes.size.width.max(frame.planes.size.height) > WIDEST {
            frame.halve();
        }
        Ok((frame, is_guessed))
    }
}

/// Requires that a camera sees most of its image through its lens. Coefficients with a slipped decimal point fold the
/// image near its centre, or leave hardly any ray.
fn validate(camera: &Pinhole, size: Size, field: &str) -> Result<()> {
    /// Rows and columns of pixels that are tested.
    const TRIED: usize = 9;
    /// Least slope of a ray relative to that without a lens; the strongest pincushion distortions leave two thirds.
    const LEAST_SLOPE: f64 = 0.25;
    camera.validate(field)?;
    let at = |k: usize, side: usize| (k as f64 + 0.5) / TRIED as f64 * side as f64;
    let is_seen = |k: &usize| {
        let pixel = [at(k % TRIED, size.width), at(k / TRIED, size.height)];
        let straight = ((pixel[0] - camera.cx) / camera.fx).hypot((pixel[1] - camera.cy) / camera.fy);
        camera.ray(pixel).is_some_and(|[x, y, z]| x.hypot(y) >= LEAST_SLOPE * straight * z)
    };
    if 2 * (0..TRIED * TRIED).filter(is_seen).count() > TRIED * TRIED {
        return Ok(());
    }
    let message = "is not a valid lens for this image: at half of its pixels or more it folds or has no ray";
    Err(Error::new(ErrorKind::Range, "distortion", message).below(field))
}

fn must_be(field: &'static str, length: usize, needed: usize) -> Result<()> {
    if length == needed {
        return Ok(());
    }
    Err(Error::new(ErrorKind::Size, field, format!("needs {needed} values, not {length}")))
}

/// Intensities in the encoding of a display, 0 .. 1, whatever the encoding of the samples.
fn encoded(samples: &ColourSamples, transfer: Option<Transfer>, size: Size) -> Result<Vec<[f32; 3]>> {
    let encode = match transfer_of(samples, transfer) {
        Transfer::Linear => |value: f32| to_srgb(f64::from(value)) as f32,
        Transfer::Srgb => |value: f32| value,
    };
    Ok(match samples {
        ColourSamples::Rgba8(data) => {
            must_be("image.data", data.len(), 4 * size.len())?;
            data.chunks_exact(4).map(|p| [0, 1, 2].map(|k| encode(f32::from(p[k]) / 255.0))).collect()
        }
        ColourSamples::Rgba16(data) => {
            must_be("image.data", data.len(), 4 * size.len())?;
            data.chunks_exact(4).map(|p| [0, 1, 2].map(|k| encode(f32::from(p[k]) / 65535.0))).collect()
        }
        ColourSamples::RgbLinear(data) => {
            must_be("image.data", data.len(), 3 * size.len())?;
            let brightest =
                data.iter().copied().filter(|value| value.is_finite()).fold(0.0, f32::max).max(f32::MIN_POSITIVE);
            let value = |value: f32| {
                if value.is_finite() { to_srgb(f64::from((value / brightest).max(0.0))) as f32 } else { 0.0 }
            };
            data.chunks_exact(3).map(|p| [0, 1, 2].map(|k| value(p[k]))).collect()
        }
    })
}

/// Whether all coordinates of a point are numbers within the range of depths.
fn is_near(point: &[f32; 3]) -> bool {
    point.iter().all(|value| value.abs() < BEYOND)
}

const MISSING: [f32; 3] = [f32::NAN; 3];

/// Points in metres; NaN where a depth is missing, lies outside the mask, or has no ray through the lens.
fn points(view: &RigView, grid: Size) -> Result<Vec<[f32; 3]>> {
    let default = if matches!(view.depth, DepthSamples::Integer(_)) { 0.001 } else { 1.0 };
    let unit = view.unit.unwrap_or(default);
    positive("depth.unit", unit)?;
    let mut points = match &view.depth {
        DepthSamples::Cloud(data) => {
            must_be("depth.points", data.len(), 3 * grid.len())?;
            data.chunks_exact(3).map(|point| [0, 1, 2].map(|k| (f64::from(point[k]) * unit) as f32)).collect()
        }
        DepthSamples::Float(data) => {
            must_be("depth.data", data.len(), grid.len())?;
            points_of_depths(view, grid, |index| f64::from(data[index]) * unit)?
        }
        DepthSamples::Integer(data) => {
            must_be("depth.data", data.len(), grid.len())?;
            // Several cameras mark pixels without a measurement with the largest number of 16 bits.
            let level = |index: usize| if data[index] == u16::MAX { 0.0 } else { f64::from(data[index]) };
            points_of_depths(view, grid, |index| level(index) * unit)?
        }
    };
    let is_inside = |index: usize| view.depth_mask.as_ref().is_none_or(|mask| mask[index] != 0);
    for (index, point) in points.iter_mut().enumerate() {
        if !is_inside(index) || !is_near(point) || *point == [0.0; 3] {
            *point = MISSING;
        }
    }
    Ok(points)
}

/// Points on the rays of the pixels at given depths in metres.
fn points_of_depths(view: &RigView, grid: Size, depth: impl Fn(usize) -> f64) -> Result<Vec<[f32; 3]>> {
    let camera = view.depth_camera.ok_or_else(|| {
        Error::new(ErrorKind::Missing, "depth.camera", "is required: without intrinsics a depth map has no points")
    })?;
    validate(&camera, grid, "depth.camera")?;
    let point = |index: usize| {
        let z = depth(index);
        let (column, row) = grid.position(index);
        if !(z > 0.0 && z.is_finite()) {
            return MISSING;
        }
        match camera.ray([column as f64, row as f64]) {
            Some([x, y, along]) if along > 0.0 => [x / along * z, y / along * z, z].map(|value| value as f32),
            _ => MISSING,
        }
    };
    Ok((0..grid.len()).map(point).collect())
}

/// Range of usual median depths, metres.
pub(super) const fn usual_depths(is_cloud: bool) -> [f32; 2] {
    [NEAREST, if is_cloud { FARTHEST_OF_CLOUDS } else { FARTHEST }]
}

/// Plausibility checks of a depth map; each warning caps the verdict.
fn doubts(view: &RigView, grid: Size, points: &[[f32; 3]]) -> Vec<WarningKind> {
    let mut doubts = Vec::new();
    let ahead = Ahead::of(points);
    let mut depths: Vec<f32> = points.iter().map(|point| ahead.depth(point)).filter(|depth| !depth.is_nan()).collect();
    let holes = 1.0 - depths.len() as f64 / points.len() as f64;
    if holes > MANY_HOLES && view.depth_mask.is_none() {
        doubts.push(WarningKind::ManyHoles { percent: 100.0 * holes });
    }
    if let DepthSamples::Integer(data) = &view.depth
        && data.iter().all(|&level| level <= LEVELS_OF_A_BYTE)
    {
        doubts.push(WarningKind::EightBits);
    }
    let median = crate::numeric::quantile(&mut depths, 0.5);
    let usual = usual_depths(view.is_cloud());
    if !(usual[0]..=usual[1]).contains(&median) {
        let usual = usual.map(f64::from);
        doubts.push(WarningKind::UnusualDepths { metres: f64::from(median), usual });
    }
    let pairs = (0..points.len() - 1)
        .filter(|index| index % grid.width != grid.width - 1)
        .map(|index| (ahead.depth(&points[index]), ahead.depth(&points[index + 1])));
    let (mut jumps, mut count) = (0, 0);
    for (a, b) in pairs.filter(|(a, b)| !a.is_nan() && !b.is_nan()) {
        count += 1;
        jumps += usize::from((a - b).abs() > ROUGH_JUMP * a.abs());
    }
    if jumps as f64 > ROUGH_SHARE * f64::from(count.max(1)) {
        doubts.push(WarningKind::RoughDepth);
    }
    doubts
}

/// The pose with the rotation nearest to the given matrix.
pub(super) fn rigid(pose: &Similarity) -> Result<State> {
    let wrong = |member, message: &str| Error::new(ErrorKind::Range, member, message.to_owned());
    if (pose.scale - 1.0).abs() > ROTATION_TOLERANCE {
        return Err(wrong("scale", "must be 1: extrinsics do not change sizes").value(pose.scale));
    }
    // The comparison is written so that it rejects NaN.
    if !pose.translation.iter().all(|value| value.abs() < crate::view::FARTHEST) {
        return Err(wrong("translation", "must be finite, and below 1e12 m"));
    }
    let nearest = Similarity::nearest(&pose.rotation, pose.translation).ok();
    let nearest = nearest.filter(|nearest| (nearest.rotation - pose.rotation).abs().max() < ROTATION_TOLERANCE);
    let Some(nearest) = nearest else { return Err(wrong("rotation", "must be orthonormal with determinant one")) };
    Ok(State::at(Similarity { scale: 1.0, ..nearest }))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tiny focal length puts points, and with them the estimate, at infinity (found by the fuzzer).
    #[test]
    fn points_beyond_all_distances_are_missing() {
        // The smaller focal length is not a valid one; the larger one is tiny, but valid.
        let camera = |fx| Pinhole { fx, fy: 20.0, cx: 10.5, cy: 8.0, lens: Lens::None };
        let size = [16, 16];
        let grid = Size::new("depth", 16, 16).unwrap();
        let view = |fx, depth| RigView {
            name: String::new(),
            image_size: size,
            image: ColourSamples::Rgba8(vec![]),
            transfer: None,
            image_mask: None,
            image_camera: None,
            depth_size: size,
            depth,
            unit: None,
            intensity: None,
            depth_mask: None,
            depth_camera: Some(camera(fx)),
        };
        for far in [1.0, 1e12, 3e38, f32::INFINITY] {
            for depth in [DepthSamples::Float(vec![far; 256]), DepthSamples::Cloud(vec![far; 3 * 256])] {
                let is_map = matches!(depth, DepthSamples::Float(_));
                for fx in [1e-45, 2e-11] {
                    let found = points(&view(fx, depth.clone()), grid);
                    // A cloud needs no camera.
                    assert_eq!(found.is_err(), is_map && fx < 1e-12, "{far} {fx}");
                    let mut coordinates = found.unwrap_or_default().into_iter().flatten();
                    assert!(coordinates.all(|value| value.is_nan() || value.abs() < BEYOND), "{far} {fx}");
                }
            }
        }
    }

    #[test]
    fn slipped_decimal_points_are_no_lens() {
        let size = Size::new("image", 640, 480).unwrap();
        let with = |lens| Pinhole { fx: 525.0, fy: 525.0, cx: 319.5, cy: 239.5, lens };
        let brown = |k1| Lens::Brown([k1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]);
        for lens in [Lens::None, brown(-0.4), brown(0.5), Lens::Fisheye([0.1, -0.05, 0.0, 0.0])] {
            assert_eq!(validate(&with(lens), size, "camera"), Ok(()));
        }
        // A wide fisheye lens, whose border sees to the side.
        let wide = Pinhole { fx: 200.0, fy: 200.0, ..with(Lens::Fisheye([0.0; 4])) };
        assert_eq!(validate(&wide, size, "camera"), Ok(()));
        for lens in
            [brown(-40.0), brown(1e6), Lens::Fisheye([-60.0, 0.0, 0.0, 0.0]), Lens::Fisheye([1e6, 0.0, 0.0, 0.0])]
        {
            let error = validate(&with(lens), size, "camera").unwrap_err();
            assert_eq!((error.kind(), error.field()), (ErrorKind::Range, "camera.distortion"));
        }
    }
}
