//! Two views of one surface with a known pose between them (docs/lab/protocols.md).

use nalgebra::{Matrix3, Vector3};

use super::flaws::{Chance, Purpose, keep_columns, punch_holes};
use super::lights;
use super::mesh::Mesh;
use super::relief::Relief;
use super::render::{View, render};
use crate::check::{not_negative, positive};
use crate::error::{Error, ErrorKind, Result};
use crate::light::Light;
use crate::pose::{Angles, Similarity};
use crate::view::{Camera, ColourImage, ColourSamples, DepthMap, DepthSamples, Normals, Points, Size};

/// Smallest side of a view in pixels; on a smaller one no built-in surface keeps its features.
pub const SMALLEST_VIEW: usize = 16;
/// Largest side of a view in pixels: four pixels for each sample of the 256 grid, beyond which triangles show.
pub const LARGEST_VIEW: usize = 1024;
/// Smallest depth of the centroid of an orthographic view, in radii of the object. It replaces the side of the view if
/// that is smaller, and keeps depths well above zero, which marks a hole.
const CLEARANCE: f64 = 1.25;
/// Default rotation about y in degrees: that of the paper's Table 1.
const DEFAULT_BETA: f64 = 20.0;

/// Options of a sample. The default is the protocol's simplest case: 64 x 64, colourful light, beta = 20 degrees.
#[derive(Clone, Debug, PartialEq)]
pub struct SampleRequest {
    /// Light of the colour view.
    pub light: Light,
    /// Size of both views, with sides of 16 .. 1024 pixels. The surface is scaled to fit: size / 256 on the 256 grid.
    pub size: Size,
    /// R_g, the rotation of the true pose, see [`Angles::rotation`].
    pub rotation: Matrix3<f64>,
    /// s of the true pose; the depth view is 1 / s times as large.
    pub scale: f64,
    /// Share of the depth map's valid columns that is kept, centred; above 0, at most 1.
    pub overlap: f64,
    /// Sigma of the Gaussian noise on log S.
    pub noise: f64,
    /// Sigma of the Gaussian noise on depth in units of the depth map (pixels if it is orthographic).
    pub depth_noise: f64,
    /// Share of the valid depth pixels lost in holes, at least 0 and below 1; they stay in the mask.
    pub holes: f64,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Camera of the colour view. For a pinhole the centroid lies at depth fx, so that a pixel there measures one unit.
    pub image_camera: Camera,
    /// Camera of the depth view. For a pinhole the centroid lies at depth fx / scale.
    pub depth_camera: Camera,
}

impl Default for SampleRequest {
    fn default() -> Self {
        Self {
            light: lights::COLOURFUL,
            size: Size { width: 64, height: 64 },
            rotation: Angles { beta: DEFAULT_BETA, ..Angles::default() }.rotation(),
            scale: 1.0,
            overlap: 1.0,
            noise: 0.0,
            depth_noise: 0.0,
            holes: 0.0,
            seed: 1,
            image_camera: Camera::Orthographic,
            depth_camera: Camera::Orthographic,
        }
    }
}

/// A pair of views with a known pose.
#[derive(Clone, Debug)]
pub struct Sample {
    /// The view of the colour camera.
    pub image: SampleImage,
    /// The view of the depth camera.
    pub depth: SampleDepth,
    /// The light of the colour view.
    pub light: Light,
    /// Transforms points of the depth view into the frame of the colour view.
    pub pose: Similarity,
    /// The true values.
    pub truth: Truth,
}

impl Sample {
    /// The colour view as input of the estimator.
    #[must_use]
    pub fn colour_image(&self) -> ColourImage {
        ColourImage {
            width: self.image.size.width,
            height: self.image.size.height,
            samples: ColourSamples::RgbLinear(self.image.colours.clone()),
            transfer: None,
            mask: Some(self.image.mask.iter().map(|&inside| u8::from(inside)).collect()),
            camera: self.image.camera.pinhole(),
        }
    }

    /// The depth view as input of the estimator.
    #[must_use]
    pub fn depth_map(&self) -> DepthMap {
        let (samples, normals) = match &self.depth.data {
            DepthData::Map(depth) => (DepthSamples::Float(depth.clone()), None),
            DepthData::Cloud { points, normals } => {
                (DepthSamples::Cloud(points.interleaved()), Some(normals.interleaved()))
            }
        };
        DepthMap {
            width: self.depth.size.width,
            height: self.depth.size.height,
            samples,
            unit: None,
            mask: Some(self.depth.mask.iter().map(|&inside| u8::from(inside)).collect()),
            camera: self.depth.camera.pinhole(),
            normals,
        }
    }
}

/// A colour view.
#[derive(Clone, Debug)]
pub struct SampleImage {
    /// Columns and rows.
    pub size: Size,
    /// Linear R, G, B interleaved, 3 * `size.len()`; zero outside the mask.
    pub colours: Vec<f32>,
    /// True on the object.
    pub mask: Vec<bool>,
    /// Orthographic or pinhole.
    pub camera: Camera,
}

/// A depth view.
#[derive(Clone, Debug)]
pub struct SampleDepth {
    /// Columns and rows.
    pub size: Size,
    /// The measurement.
    pub data: DepthData,
    /// True on the object, including holes.
    pub mask: Vec<bool>,
    /// Orthographic or pinhole.
    pub camera: Camera,
}

/// A depth map or an organised cloud.
#[derive(Clone, Debug)]
pub enum DepthData {
    /// Depth along z for each pixel, NaN where missing.
    Map(Vec<f32>),
    /// A point and a unit normal for each pixel, NaN where missing. Normals may face away from the depth camera.
    Cloud {
        /// Points in the depth camera's frame.
        points: Points,
        /// Unit normals, which face the camera of the grid.
        normals: Normals,
    },
}

/// True values without noise and holes, NaN outside the masks.
#[derive(Clone, Debug)]
pub struct Truth {
    /// Unit normals of the colour view, in its frame.
    pub image_normals: Normals,
    /// Depth of the colour view.
    pub image_depth: Vec<f32>,
    /// Unit normals of the depth view, in its own frame.
    pub depth_normals: Normals,
    /// Depth of the depth view.
    pub depth: Vec<f32>,
}

/// A surface that can be viewed from any pose.
#[derive(Clone, Debug)]
pub struct Scene {
    mesh: Mesh,
    /// Grid of the relief in samples.
    grid: Size,
}

impl Scene {
    /// # Errors
    /// [`ErrorKind::Empty`] if the relief has no surface (see [`Mesh::from_relief`]).
    pub fn new(relief: &Relief) -> Result<Self> {
        Ok(Self { mesh: Mesh::from_relief(relief)?, grid: relief.size() })
    }

    /// The mesh, in samples.
    #[must_use]
    pub const fn mesh(&self) -> &Mesh {
        &self.mesh
    }

    /// The surface rotated by `rotation` about its centroid, scaled to the view (times `scale`) and seen by `camera`.
    ///
    /// The centroid keeps its position without rotation. Its depth is fx * scale for a pinhole, and the larger side of
    /// the view for an orthographic camera (1.25 radii of the object if that is more).
    #[must_use]
    pub fn view(&self, rotation: &Matrix3<f64>, scale: f64, size: Size, camera: Camera) -> View {
        render(&self.mesh, &self.placement(rotation, scale, size, camera), size, camera)
    }

    /// The transformation of the mesh into the frame of a camera.
    fn placement(&self, rotation: &Matrix3<f64>, scale: f64, size: Size, camera: Camera) -> Similarity {
        let scaled = scale * self.fit(size);
        let place = self.place(scale, size, camera);
        let translation = place - scaled * (rotation * self.mesh.centroid());
        Similarity { scale: scaled, rotation: *rotation, translation }
    }

    /// Pixels per sample.
    fn fit(&self, size: Size) -> f64 {
        (size.width as f64 / self.grid.width as f64).min(size.height as f64 / self.grid.height as f64)
    }

    /// Position of the centroid in the frame of a camera.
    fn place(&self, scale: f64, size: Size, camera: Camera) -> Vector3<f64> {
        let fit = self.fit(size);
        let centre = fit * self.mesh.centroid();
        match camera {
            Camera::Orthographic => {
                let depth = (CLEARANCE * scale * fit * self.mesh.radius()).max(size.width.max(size.height) as f64);
                Vector3::new(centre.x, centre.y, depth)
            }
            Camera::Pinhole(pinhole) => scale * Vector3::new(centre.x, centre.y, pinhole.fx),
        }
    }

    /// A pair of views. The colour view is the surface as it is; the depth view is the surface under R_g^T, 1 / s times
    /// as large. The pose transforms the second exactly into the first: t = C_image - s R_g C_depth with the centroid C
    /// of each view.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] or [`ErrorKind::Range`] with the field at fault, [`ErrorKind::Empty`] if a view sees nothing
    /// of the surface.
    pub fn sample(&self, request: &SampleRequest) -> Result<Sample> {
        request.validate()?;
        let SampleRequest { size, rotation, scale, .. } = *request;
        let inverse = rotation.transpose();
        let image = self.view(&Matrix3::identity(), 1.0, size, request.image_camera);
        let depth = self.view(&inverse, 1.0 / scale, size, request.depth_camera);

        let mut mask = depth.mask();
        if !mask.contains(&true) {
            let message = "the depth camera sees only the back of the surface";
            return Err(Error::new(ErrorKind::Empty, "angles", message));
        }
        keep_columns(&mut mask, size, request.overlap);
        if !mask.contains(&true) || !image.mask().contains(&true) {
            return Err(Error::new(ErrorKind::Empty, "size", "a view sees nothing of the surface"));
        }
        let mut truth = Truth {
            image_normals: image.normals_f32(),
            image_depth: image.depth_f32(),
            depth_normals: depth.normals_f32(),
            depth: depth.depth_f32(),
        };
        for index in (0..size.len()).filter(|&index| !mask[index]) {
            truth.depth[index] = f32::NAN;
            truth.depth_normals.set(index, [f32::NAN; 3]);
        }
        let places = [self.place(1.0, size, request.image_camera), self.place(1.0 / scale, size, request.depth_camera)];
        Ok(Sample {
            image: shade(&image, request),
            depth: SampleDepth {
                size,
                data: DepthData::Map(measure(&depth, &mask, request)),
                mask,
                camera: request.depth_camera,
            },
            light: request.light,
            pose: Similarity { scale, rotation, translation: places[0] - scale * (rotation * places[1]) },
            truth,
        })
    }
}

impl SampleRequest {
    /// # Errors
    /// [`ErrorKind::Size`] or [`ErrorKind::Range`] with the first field out of range.
    pub fn validate(&self) -> Result<()> {
        let sides = SMALLEST_VIEW..=LARGEST_VIEW;
        if !sides.contains(&self.size.width) || !sides.contains(&self.size.height) {
            let Size { width, height } = self.size;
            let message =
                format!("sides must lie within {SMALLEST_VIEW} .. {LARGEST_VIEW} pixels, not {width}x{height}");
            return Err(Error::new(ErrorKind::Size, "size", message));
        }
        self.light.validate("light")?;
        positive("scale", self.scale)?;
        Similarity { scale: self.scale, rotation: self.rotation, translation: Vector3::zeros() }.validate("pose")?;
        check_overlap(self.overlap)?;
        not_negative("noise", self.noise)?;
        not_negative("depthNoise", self.depth_noise)?;
        if !(0.0..1.0).contains(&self.holes) {
            return Err(Error::new(ErrorKind::Range, "holes", "must be at least 0 and below 1").value(self.holes));
        }
        for (name, camera) in [("image.camera", self.image_camera), ("depth.camera", self.depth_camera)] {
            if let Camera::Pinhole(pinhole) = camera {
                pinhole.validate(name)?;
            }
        }
        Ok(())
    }
}

pub(super) fn check_overlap(overlap: f64) -> Result<()> {
    positive("overlap", overlap)?;
    if overlap <= 1.0 {
        return Ok(());
    }
    Err(Error::new(ErrorKind::Range, "overlap", "must be at most 1").value(overlap))
}

/// S = exp(log S + noise) for every normal.
fn shade(view: &View, request: &SampleRequest) -> SampleImage {
    let mut chance = Chance::new(request.seed, Purpose::Brightness);
    let mut colours = vec![0.0; 3 * view.size.len()];
    for (index, colour) in colours.chunks_exact_mut(3).enumerate().filter(|&(index, _)| view.is_valid(index)) {
        let log = request.light.shade(view.normals[index].into());
        for (channel, log) in colour.iter_mut().zip(log) {
            *channel = (log + request.noise * chance.gaussian()).exp() as f32;
        }
    }
    SampleImage { size: view.size, colours, mask: view.mask(), camera: view.camera }
}

/// Depth with noise and holes inside `mask`.
fn measure(view: &View, mask: &[bool], request: &SampleRequest) -> Vec<f32> {
    let mut chance = Chance::new(request.seed, Purpose::Depth);
    let mut depth: Vec<f32> = view
        .depth
        .iter()
        .zip(mask)
        .map(|(&depth, &kept)| if kept { (depth + request.depth_noise * chance.gaussian()) as f32 } else { f32::NAN })
        .collect();
    punch_holes(&mut depth, view.size, request.holes, &mut Chance::new(request.seed, Purpose::Holes));
    depth
}
