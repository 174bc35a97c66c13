//! One frame of a rig from a request.

use super::cameras::Rig;
use super::colour::{SAMPLES, develop, radiance};
use super::depth::{Seen, look, measure};
use super::illumination::Illumination;
use super::layout::{Layout, layout};
use super::raster::Rays;
use crate::calibration::RigCamera;
use crate::check::not_negative;
use crate::error::{Error, ErrorKind, Result};
use crate::pose::Similarity;
use crate::scenes::flaws::Chance;
use crate::scenes::{LARGEST_VIEW, SMALLEST_VIEW};
use crate::view::Size;

/// Streams of random numbers: one for the rig, and so many for each frame.
const RIG_STREAM: u64 = 1 << 32;
const STREAMS: u64 = 4;

/// What is seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RigKind {
    /// Three to six bodies of 8 to 25 cm at 0.6 to 1.2 m, a wall 0.3 m or more behind them.
    Objects,
    /// A crumpled sheet or a draped cloth before a wall.
    Sheet,
    /// Boxes on a table, some on top of others.
    Boxes,
    /// Walls, a floor and furniture at 1.5 to 4 m.
    Room,
}

impl RigKind {
    /// All of them.
    pub const ALL: [Self; 4] = [Self::Objects, Self::Sheet, Self::Boxes, Self::Room];

    /// Lower-case name.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Objects => "objects",
            Self::Sheet => "sheet",
            Self::Boxes => "boxes",
            Self::Room => "room",
        }
    }
}

/// Which frame of which rig to make.
#[derive(Clone, Debug, PartialEq)]
pub struct RigRequest {
    /// What is seen.
    pub kind: RigKind,
    /// Of the rig: cameras, lenses and extrinsics.
    pub seed: u64,
    /// Frames of one seed share the rig; what is seen, its light and the noise are others.
    pub frame: u32,
    /// Sides of 16 to 1024 pixels; without one, 640x480 or 960x540 by the seed.
    pub colour_size: Option<Size>,
    /// Sides of 16 to 1024 pixels; without one, 512x424 or 640x480 by the seed.
    pub depth_size: Option<Size>,
    /// Factor of either sensor's noise; with 0 depth is exact to half a millimetre, with holes.
    pub noise: f64,
}

impl RigRequest {
    /// A frame with the sensors' own noise and sizes.
    #[must_use]
    pub const fn new(kind: RigKind, seed: u64, frame: u32) -> Self {
        Self { kind, seed, frame, colour_size: None, depth_size: None, noise: 1.0 }
    }

    /// # Errors
    /// [`ErrorKind::Size`] or [`ErrorKind::Range`] naming the first field out of range.
    pub fn validate(&self) -> Result<()> {
        let sides = SMALLEST_VIEW..=LARGEST_VIEW;
        for (field, size) in [("colourSize", self.colour_size), ("depthSize", self.depth_size)] {
            if size.is_some_and(|size| !sides.contains(&size.width) || !sides.contains(&size.height)) {
                let message = format!("sides must lie within {SMALLEST_VIEW} .. {LARGEST_VIEW} pixels");
                return Err(Error::new(ErrorKind::Size, field, message));
            }
        }
        not_negative("noise", self.noise)
    }

    fn chance(&self, stream: u64) -> Chance {
        Chance::of_stream(self.seed, RIG_STREAM + stream)
    }
}

/// What both cameras of a rig give, and the truth.
#[derive(Clone, Debug)]
pub struct RigFrame {
    /// What is seen.
    pub kind: RigKind,
    /// RGBA, 8 bits of sRGB each, row-major.
    pub colour: Vec<u8>,
    /// Columns and rows of the colour image.
    pub colour_size: Size,
    /// Its camera.
    pub colour_camera: RigCamera,
    /// Millimetres along z, 0 where nothing was measured.
    pub depth: Vec<u16>,
    /// Columns and rows of the depth map.
    pub depth_size: Size,
    /// Its camera.
    pub depth_camera: RigCamera,
    /// The extrinsics: P_colour = R P_depth + t, metres, scale 1.
    pub pose: Similarity,
    /// Depth of the surfaces at the pixels' centres without any flaw, metres; NaN where nothing is.
    pub true_depth: Vec<f32>,
}

/// Makes a frame.
///
/// # Errors
/// As [`RigRequest::validate`].
pub fn render(request: &RigRequest) -> Result<RigFrame> {
    request.validate()?;
    let rig = Rig::random(request.colour_size, request.depth_size, &mut request.chance(0));
    let [mut scene, mut light, mut image, mut sensor] =
        [1, 2, 3, 4].map(|stream| request.chance(STREAMS * u64::from(request.frame) + stream));
    let Layout { stage, view, target } = layout(request.kind, &mut scene);
    let light = Illumination::random(&stage, target, &mut light);

    let rays = Rays::new(&rig.colour, rig.colour_size, SAMPLES);
    let hits = rays.meet(&stage, &view);
    let linear = radiance(&stage, &light, &view, &rays, &hits, rig.colour_size);
    let seen: Seen = look(&stage, &rig.pose.inverse().after(&view), &rig);
    Ok(RigFrame {
        kind: request.kind,
        colour: develop(&linear, request.noise, &mut image),
        colour_size: rig.colour_size,
        colour_camera: rig.colour,
        depth: measure(&seen, rig.depth_size, request.noise, &mut sensor),
        depth_size: rig.depth_size,
        depth_camera: rig.depth,
        pose: rig.pose,
        true_depth: seen.depth,
    })
}
