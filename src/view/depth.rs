//! The depth map: checked once and converted to points and normals; holes are distinguished from background
//! (docs/method/views.md).

use crate::check::positive;
use crate::error::{Error, ErrorKind, Result};
use crate::text::Brief;
use crate::view::depth_noise::DepthNoise;
use crate::view::mask::{self, FEWEST_PIXELS, components};
use crate::view::pinhole::FARTHEST;
use crate::view::smoothing::smooth;
use crate::view::{Camera, Normals, Pinhole, Points, Size, flying_pixels, normals};

/// Samples as a sensor or a file holds them.
#[derive(Clone, Debug, PartialEq)]
pub enum DepthSamples {
    /// Depth along z in stored units; NaN, infinite, zero and negative values are holes.
    Float(Vec<f32>),
    /// Depth along z in stored units; zero is a hole.
    Integer(Vec<u16>),
    /// An organised cloud: x, y, z of each pixel in stored units, NaN where missing.
    Cloud(Vec<f32>),
}

/// One depth map of the object, not yet checked.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthMap {
    /// Columns.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// Samples, row-major.
    pub samples: DepthSamples,
    /// Metres (or pixels, orthographic) of a stored unit; `None`: 1, and 0.001 for integers with a camera.
    pub unit: Option<f64>,
    /// Non-zero where the object is; `None`: pixels with depth, and holes enclosed by them.
    pub mask: Option<Vec<u8>>,
    /// The intrinsics; `None` for an orthographic view.
    pub camera: Option<Pinhole>,
    /// The caller's unit normals, interleaved; they override the computed ones.
    pub normals: Option<Vec<f32>>,
}

/// The checked depth view.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthView {
    /// Size of the map.
    pub size: Size,
    /// The mapping from points to pixels.
    pub camera: Camera,
    /// Object pixels, including holes that touch a depth.
    pub mask: Vec<bool>,
    /// Points in the depth camera's frame in metres or pixels, NaN at holes and off the mask, without the noise that
    /// neighbouring pixels share.
    pub points: Points,
    /// Depth along z as measured; empty if it equals that of the points.
    pub measured_depth: Vec<f32>,
    /// The noise of the measured depth.
    pub noise: DepthNoise,
    /// Unit normals in the depth camera's frame, NaN where missing.
    pub normals: Normals,
    /// Whether the input was an organised cloud, whose pixels have no camera rays.
    pub organised: bool,
    /// Whether the caller gave the normals.
    pub normals_given: bool,
    /// Number of pixels with a depth that trimming removed from the object.
    pub trimmed: usize,
    /// Whether the caller gave a mask.
    pub has_mask: bool,
}

/// The field of an error if the lens has no rays.
const LENS: &str = "depth.camera.distortion";
/// Metres of a stored integer if a camera is known and no unit is given: millimetres, as sensors store them.
const MILLIMETRE: f64 = 0.001;
/// Without a mask, an enclosed gap in the depth belongs to the object up to this share of the object's pixels (data not
/// recorded).
const LARGEST_HOLE: f64 = 0.02;

impl DepthView {
    /// Checks the depth map, trims it if `trim` is set, and computes points and normals.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] for sizes that disagree, [`ErrorKind::Range`] for invalid intrinsics, lenses or units,
    /// [`ErrorKind::Empty`] if fewer than 16 pixels have a depth.
    pub fn new(map: &DepthMap, trim: bool) -> Result<Self> {
        let size = Size::new("depth", map.width, map.height)?;
        if let Some(camera) = &map.camera {
            camera.validate("depth.camera")?;
        }
        let camera = map.camera.map_or(Camera::Orthographic, Camera::Pinhole);
        let unit = map.unit_or_default()?;
        let mut object = mask::checked("depth.mask", size, map.mask.as_deref())?;
        let mut points = map.points(size, camera, unit)?;
        let organised = matches!(map.samples, DepthSamples::Cloud(_));
        // The pixels of a cloud have no rays.
        let rays = if organised { Camera::Orthographic } else { camera };
        rays.keep_pixels_with_rays(LENS, size, &points.z, &mut object)?;
        for index in (0..size.len()).filter(|&index| !object[index]) {
            points.set(index, [f32::NAN; 3]);
        }
        let mut view = Self {
            size,
            camera,
            mask: object,
            normals: Normals::default(),
            points,
            measured_depth: Vec::new(),
            noise: DepthNoise::default(),
            organised,
            normals_given: map.normals.is_some(),
            trimmed: 0,
            has_mask: map.mask.is_some(),
        };
        view.require_depth()?;
        if trim && !organised {
            view.trim();
        }
        if map.mask.is_none() {
            view.mask = enclosed(size, &view.points.z);
            rays.keep_pixels_with_rays(LENS, size, &view.points.z, &mut view.mask)?;
        }
        view.drop_islands();
        if !organised {
            view.remove_noise();
        }
        view.normals = match &map.normals {
            Some(given) => given_normals(size, given)?,
            None if organised => normals::of_cloud(size, &view.points),
            None => normals::of_depth(size, camera, view.depth()),
        };
        view.require_depth()?;
        Ok(view)
    }

    fn require_depth(&self) -> Result<()> {
        if self.valid() >= FEWEST_PIXELS {
            return Ok(());
        }
        let field = if self.organised { "depth.points" } else { "depth.data" };
        Err(Error::new(
            ErrorKind::Empty,
            field,
            format!("fewer than {FEWEST_PIXELS} object pixels have a depth above zero and below {}", Brief(FARTHEST)),
        ))
    }

    /// Share of the depths that trimming removed; zero with a mask.
    pub fn trimmed_without_mask(&self) -> f64 {
        let trimmed = if self.has_mask { 0.0 } else { self.trimmed as f64 };
        trimmed / (trimmed + self.valid() as f64)
    }

    fn trim(&mut self) {
        let kept = flying_pixels::object_pixels(self.size, self.depth(), self.camera.focal_length());
        for index in 0..self.size.len() {
            if !kept[index] && !self.depth()[index].is_nan() {
                self.trimmed += 1;
                self.mask[index] = false;
                self.points.set(index, [f32::NAN; 3]);
            }
        }
    }

    /// Moves the points along their rays to remove the noise of the map, unless that noise is white. Cubics and
    /// registration average white noise themselves, and smoothing would remove relief that they need.
    fn remove_noise(&mut self) {
        let mut depth = self.points.z.clone();
        self.camera.heights_from_depth(&mut depth);
        self.noise = DepthNoise::of(self.size, &depth);
        if !self.noise.is_visible() || self.noise.is_white {
            return;
        }
        smooth(self.size, &self.noise, &mut depth);
        self.camera.depth_from_heights(&mut depth);
        if !self.camera.is_orthographic() {
            let Points { x, y, z } = &mut self.points;
            for ((x, y), (z, depth)) in x.iter_mut().zip(y).zip(z.iter().zip(&depth)) {
                (*x, *y) = (*x * depth / z, *y * depth / z);
            }
        }
        self.measured_depth = std::mem::replace(&mut self.points.z, depth);
    }

    /// Removes from the mask its components without any depth, because their distance is unknown.
    fn drop_islands(&mut self) {
        let (labels, counts) = components(self.size, |index| self.mask[index], |_, _| true);
        let mut measured = vec![false; counts.len()];
        for index in (0..self.size.len()).filter(|&index| self.mask[index]) {
            measured[labels[index]] |= !self.depth()[index].is_nan();
        }
        for (inside, &label) in self.mask.iter_mut().zip(&labels) {
            *inside &= label != usize::MAX && measured[label];
        }
    }

    /// Depth along z as measured, NaN at holes and off the mask.
    #[must_use]
    pub fn measured(&self) -> &[f32] {
        if self.measured_depth.is_empty() { self.depth() } else { &self.measured_depth }
    }

    /// Depth along z of the points, NaN at holes and off the mask.
    #[must_use]
    pub fn depth(&self) -> &[f32] {
        &self.points.z
    }

    /// Number of pixels with a depth.
    #[must_use]
    pub fn valid(&self) -> usize {
        self.depth().iter().filter(|depth| !depth.is_nan()).count()
    }
}

impl DepthMap {
    fn unit_or_default(&self) -> Result<f64> {
        match self.unit {
            Some(unit) => positive("depth.unit", unit).map(|()| unit),
            None if matches!(self.samples, DepthSamples::Integer(_)) && self.camera.is_some() => Ok(MILLIMETRE),
            None => Ok(1.0),
        }
    }

    /// Points in metres or pixels, NaN at holes. Without a ray, x and y are also NaN.
    fn points(&self, size: Size, camera: Camera, unit: f64) -> Result<Points> {
        let (field, per_pixel, length) = match &self.samples {
            DepthSamples::Float(data) => ("depth.data", 1, data.len()),
            DepthSamples::Integer(data) => ("depth.data", 1, data.len()),
            DepthSamples::Cloud(data) => ("depth.points", 3, data.len()),
        };
        require_length(field, size, per_pixel, length)?;
        let mut points = Points::missing(size.len());
        for index in 0..size.len() {
            let depth = match &self.samples {
                DepthSamples::Cloud(data) => {
                    let point = [0, 1, 2].map(|axis| (f64::from(data[3 * index + axis]) * unit) as f32);
                    if point.iter().all(|value| value.abs() < FARTHEST as f32) {
                        points.set(index, point);
                    }
                    continue;
                }
                DepthSamples::Float(data) => f64::from(data[index]),
                DepthSamples::Integer(data) => f64::from(data[index]),
            };
            let (column, row) = size.position(index);
            let point = camera.point(size, [column as f64, row as f64], depth * unit).map(|value| value as f32);
            // If the focal length is tiny, x and y may also exceed the limit.
            if point[2] > 0.0 && !point.iter().any(|value| value.abs() >= FARTHEST as f32) {
                points.set(index, point);
            }
        }
        Ok(points)
    }
}

fn require_length(field: &'static str, size: Size, per_pixel: usize, length: usize) -> Result<()> {
    if length == per_pixel * size.len() {
        return Ok(());
    }
    let (width, height, needed) = (size.width, size.height, per_pixel * size.len());
    Err(Error::new(ErrorKind::Size, field, format!("{width}x{height} pixels need {needed} values, not {length}")))
}

/// The caller's normals at unit length; those that are not finite or have no length are missing.
fn given_normals(size: Size, given: &[f32]) -> Result<Normals> {
    require_length("depth.normals", size, 3, given.len())?;
    let mut normals = Normals::missing(size.len());
    for (index, normal) in given.chunks_exact(3).enumerate() {
        let length = normal.iter().map(|value| value * value).sum::<f32>().sqrt();
        if length.is_finite() && length > 0.0 {
            normals.set(index, [normal[0] / length, normal[1] / length, normal[2] / length]);
        }
    }
    Ok(normals)
}

/// Pixels with depth, and the small gaps enclosed by them.
fn enclosed(size: Size, depth: &[f32]) -> Vec<bool> {
    let valid = depth.iter().filter(|depth| !depth.is_nan()).count();
    let (labels, counts) = components(size, |index| depth[index].is_nan(), |_, _| true);
    let mut open = vec![false; counts.len()];
    for index in 0..size.len() {
        let (column, row) = size.position(index);
        let border = column == 0 || row == 0 || column + 1 == size.width || row + 1 == size.height;
        if border && labels[index] != usize::MAX {
            open[labels[index]] = true;
        }
    }
    let is_hole = |label: usize| !open[label] && counts[label] as f64 <= LARGEST_HOLE * valid as f64;
    labels.into_iter().map(|label| label == usize::MAX || is_hole(label)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Lens;

    fn map(samples: DepthSamples) -> DepthMap {
        DepthMap { width: 10, height: 10, samples, unit: None, mask: None, camera: None, normals: None }
    }

    #[test]
    fn holes_are_never_values() {
        let mut depth = vec![5.0_f32; 100];
        for (index, hole) in [(11, 0.0), (22, f32::NAN), (33, -1.0), (44, f32::INFINITY), (66, f32::MAX)] {
            depth[index] = hole;
        }
        let view = DepthView::new(&map(DepthSamples::Float(depth)), true).unwrap();
        assert_eq!(view.valid(), 95);
        assert!(view.mask[11] && view.mask[44] && !view.points.is_valid(33));
    }

    #[test]
    fn a_part_of_the_mask_without_any_depth_is_no_hole() {
        let mut depth = vec![5.0_f32; 100];
        let mut input = map(DepthSamples::Float(Vec::new()));
        let outside = [1, 10, 11];
        input.mask = Some((0..100).map(|index| u8::from(!outside.contains(&index))).collect());
        (depth[0], depth[55]) = (f32::NAN, f32::NAN);
        input.samples = DepthSamples::Float(depth);
        let view = DepthView::new(&input, true).unwrap();
        assert!(!view.mask[0] && view.mask[55]);
    }

    #[test]
    fn an_object_before_a_wall_is_trimmed_unless_a_mask_says_that_it_is_one() {
        let is_object = |index: usize| index % 10 < 4 && index < 90;
        let depth = (0..100).map(|index| if is_object(index) { 5.0 } else { 50.0 }).collect();
        let mut input = map(DepthSamples::Float(depth));
        assert!((DepthView::new(&input, true).unwrap().trimmed_without_mask() - 0.36).abs() < 1e-9);
        assert!(DepthView::new(&input, false).unwrap().trimmed_without_mask() == 0.0);
        input.mask = Some((0..100).map(|index| u8::from(is_object(index))).collect());
        let view = DepthView::new(&input, true).unwrap();
        assert_eq!((view.valid(), view.trimmed_without_mask()), (36, 0.0));
    }

    #[test]
    fn integers_with_a_camera_are_millimetres() {
        let mut input = map(DepthSamples::Integer(vec![1500; 100]));
        input.camera = Some(Pinhole { fx: 10.0, fy: 10.0, cx: 4.5, cy: 4.5, lens: Lens::None });
        let view = DepthView::new(&input, true).unwrap();
        assert!((view.points.z[0] - 1.5).abs() < 1e-6 && (view.points.x[0] + 0.675).abs() < 1e-6);
    }

    #[test]
    fn all_nan_is_refused_by_name() {
        let error = DepthView::new(&map(DepthSamples::Float(vec![f32::NAN; 100])), true).unwrap_err();
        assert_eq!((error.kind(), error.field()), (ErrorKind::Empty, "depth.data"));
        let far = DepthView::new(&map(DepthSamples::Float(vec![1e12; 100])), true).unwrap_err();
        assert!(far.to_string().contains("below 1000000000000"), "{far}");
    }

    #[test]
    fn where_the_lens_lets_no_ray_through_is_no_depth() {
        let mut input = map(DepthSamples::Float(vec![1.0; 100]));
        // No ray lies farther than 0.385 focal lengths from the centre.
        let lens = Lens::brown(&[-1.0, 0.0, 0.0, 0.0, 0.0]).unwrap();
        let camera = Pinhole { fx: 10.0, fy: 10.0, cx: 4.5, cy: 4.5, lens };
        input.camera = Some(camera);
        assert_eq!(DepthView::new(&input, true).unwrap_err().field(), "depth.camera.distortion");
        input.camera = Some(Pinhole { fx: 14.0, fy: 14.0, ..camera });
        let view = DepthView::new(&input, true).unwrap();
        assert!(!view.mask[0] && view.depth()[0].is_nan() && view.mask[55]);
        assert!((50..100).contains(&view.valid()));
        assert!((0..100).all(|index| view.points.is_valid(index) != view.depth()[index].is_nan()));
    }

    #[test]
    fn a_zero_focal_length_is_refused_by_name() {
        let mut input = map(DepthSamples::Float(vec![1.0; 100]));
        input.camera = Some(Pinhole { fx: 0.0, fy: 10.0, cx: 4.5, cy: 4.5, lens: Lens::None });
        assert_eq!(DepthView::new(&input, true).unwrap_err().field(), "depth.camera.fx");
    }
}
