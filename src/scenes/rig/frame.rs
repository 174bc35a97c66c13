//! One frame of a rig from a request.

use super::cameras::Rig;
use super::colour::{SAMPLES, develop, radiance};
use super::depth::{Seen, look, measure};
use super::illumination::Illumination;
use super::layout::{Layout, RigKind, layout};
use super::raster::{Hits, Rays};
use super::stage::Stage;
use crate::check::not_negative;
use crate::error::{Error, ErrorKind, Result};
use crate::pose::Similarity;
use crate::scenes::flaws::Chance;
use crate::scenes::{LARGEST_VIEW, SMALLEST_VIEW};
use crate::view::{Pinhole, Size};

/// Number of streams of random numbers of each frame. The rig has a separate stream, beyond those of any frame.
#[derive(Clone, Copy)]
enum Stream {
    Layout,
    Light,
    Image,
    Sensor,
}
const STREAMS: u64 = 4;
const RIG_STREAM: u64 = 1 << 40;

/// Selects a frame of a rig.
#[derive(Clone, Debug, PartialEq)]
pub struct RigRequest {
    /// Kind of scene.
    pub kind: RigKind,
    /// Seed of the rig: cameras, lenses and extrinsics. It also enters the frames.
    pub seed: u64,
    /// Number of the frame. Frames of one seed share the rig; scene, light and noise differ.
    pub frame: u32,
    /// Sides of 16 to 1024 pixels; `None` is 640x480 or 960x540, depending on the seed.
    pub colour_size: Option<Size>,
    /// Sides of 16 to 1024 pixels; `None` is 512x424 or 640x480, depending on the seed.
    pub depth_size: Option<Size>,
    /// Factor on the noise of both sensors. With 0, depth is exact to half a millimetre and still has holes.
    pub noise: f64,
    /// Moves the scene in front of the rig, in the colour camera's frame, metres; scale 1.
    pub motion: Similarity,
}

impl RigRequest {
    /// A frame with typical noise and default sizes.
    #[must_use]
    pub fn new(kind: RigKind, seed: u64, frame: u32) -> Self {
        Self { kind, seed, frame, colour_size: None, depth_size: None, noise: 1.0, motion: Similarity::identity() }
    }

    /// # Errors
    /// [`ErrorKind::Size`] or [`ErrorKind::Range`] with the first field out of range.
    pub fn validate(&self) -> Result<()> {
        let sides = SMALLEST_VIEW..=LARGEST_VIEW;
        for (field, size) in [("colourSize", self.colour_size), ("depthSize", self.depth_size)] {
            if size.is_some_and(|size| !sides.contains(&size.width) || !sides.contains(&size.height)) {
                let message = format!("sides must lie within {SMALLEST_VIEW} .. {LARGEST_VIEW} pixels");
                return Err(Error::new(ErrorKind::Size, field, message));
            }
        }
        if self.motion.scale != 1.0 {
            let message = "must be 1: a motion does not change sizes";
            return Err(Error::new(ErrorKind::Range, "motion.scale", message).value(self.motion.scale));
        }
        self.motion.validate("motion")?;
        not_negative("noise", self.noise)
    }

    fn of_rig(&self) -> Chance {
        Chance::of_stream(self.seed, RIG_STREAM)
    }

    fn of_frame(&self, stream: Stream) -> Chance {
        Chance::of_stream(self.seed, STREAMS * u64::from(self.frame) + stream as u64)
    }
}

/// Outputs of both cameras of a rig, and the true values.
#[derive(Clone, Debug)]
pub struct RigFrame {
    /// Kind of scene.
    pub kind: RigKind,
    /// RGBA, 8 bits of sRGB each, row-major.
    pub colour: Vec<u8>,
    /// Columns and rows of the colour image.
    pub colour_size: Size,
    /// Camera of the colour image.
    pub colour_camera: Pinhole,
    /// Millimetres along z, 0 where nothing was measured.
    pub depth: Vec<u16>,
    /// Columns and rows of the depth map.
    pub depth_size: Size,
    /// Camera of the depth map.
    pub depth_camera: Pinhole,
    /// The extrinsics: P_colour = R P_depth + t, metres, scale 1.
    pub pose: Similarity,
    /// Depth of the surfaces at the pixels' centres without any flaw, metres; NaN for background.
    pub true_depth: Vec<f32>,
}

/// Renders a frame.
///
/// # Errors
/// Those of [`RigRequest::validate`].
pub fn render(request: &RigRequest) -> Result<RigFrame> {
    request.validate()?;
    let Views { rig, stage, view, light, rays, hits, seen } = Views::of(request);
    let linear = radiance(&stage, &light, &view, &rays, &hits, rig.colour_size);
    Ok(RigFrame {
        kind: request.kind,
        colour: develop(&linear, request.noise, &mut request.of_frame(Stream::Image)),
        colour_size: rig.colour_size,
        colour_camera: rig.colour,
        depth: measure(&seen, rig.depth_size, request.noise, &mut request.of_frame(Stream::Sensor)),
        depth_size: rig.depth_size,
        depth_camera: rig.depth,
        pose: rig.pose,
        true_depth: seen.depth,
    })
}

/// Both views before their sensors, with the rig and the scene.
struct Views {
    rig: Rig,
    stage: Stage,
    /// The transformation from the world to the colour camera.
    view: Similarity,
    light: Illumination,
    rays: Rays,
    hits: Hits,
    seen: Seen,
}

impl Views {
    fn of(request: &RigRequest) -> Self {
        let rig = Rig::random(request.colour_size, request.depth_size, &mut request.of_rig());
        let Layout { stage, view, target } = layout(request.kind, &mut request.of_frame(Stream::Layout));
        let view = request.motion.after(&view);
        let light = Illumination::random(&stage, target, &mut request.of_frame(Stream::Light));
        let rays = Rays::new(&rig.colour, rig.colour_size, SAMPLES);
        let hits = rays.meet(&stage, &view);
        let seen = look(&stage, &rig.pose.inverse().after(&view), &rig);
        Self { rig, stage, view, light, rays, hits, seen }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    /// Points of the depth camera, transformed by the true pose into the colour image, have the colours that albedo and
    /// light give them there. Under a pose two degrees off they do not.
    #[test]
    fn both_views_agree_under_the_true_pose_alone() {
        for (kind, seed) in RigKind::ALL.into_iter().zip(3..) {
            let size = Some(Size { width: 640, height: 480 });
            let request = RigRequest { colour_size: size, depth_size: size, ..RigRequest::new(kind, seed, 0) };
            let Views { rig, stage, view, light, rays, hits, seen } = Views::of(&request);
            let linear = radiance(&stage, &light, &view, &rays, &hits, rig.colour_size);
            let turned = nalgebra::Rotation3::new(Vector3::new(0.0, 0.035, 0.0)).into_inner() * rig.pose.rotation;
            let [true_pose, off] = [rig.pose, Similarity { rotation: turned, ..rig.pose }];
            let agreement = |pose: &Similarity| {
                let (mut same, mut all) = (0, 0);
                for index in (0..rig.depth_size.len()).step_by(37) {
                    let (column, row) = rig.depth_size.position(index);
                    let depth = f64::from(seen.depth[index]);
                    let Some([x, y, _]) = rig.depth.ray([column as f64, row as f64]) else { continue };
                    let point = depth * Vector3::new(x, y, 1.0);
                    let carried = pose.apply(point);
                    let Some([right, down]) = rig.colour.project(carried.into()) else { continue };
                    let Some(pixel) = rig.colour_size.nearest(right as f32, down as f32) else { continue };
                    let Some([sample, line]) = rays.position(carried) else { continue };
                    let Some(sample) = rays.size.nearest(sample as f32, line as f32) else { continue };
                    // Points hidden from the colour camera are skipped.
                    if f64::from(hits.depth[sample]) < 0.99 * carried.z {
                        continue;
                    }
                    let world = view.inverse().apply(carried);
                    let Some(hit) = rays.hit(&stage, &view, &hits, sample) else { continue };
                    let mut expected = light.sky(hit.normal);
                    light.add_lamps(world, hit.normal, &mut expected);
                    let albedo = stage.albedos[stage.triangles[hit.triangle].albedo as usize].albedo(world);
                    let close = (0..3).all(|k| {
                        let (found, expected) = (f64::from(linear[3 * pixel + k]), expected[k] * albedo[k]);
                        (found - expected).abs() < 0.03 * expected
                    }) && (f64::from(hits.depth[sample]) / carried.z - 1.0).abs() < 0.01;
                    same += usize::from(close);
                    all += 1;
                }
                same as f64 / f64::from(all.max(1))
            };
            let [right, wrong] = [agreement(&true_pose), agreement(&off)];
            // The other pixels see several albedos or things.
            assert!(right > 0.93 && wrong < right - 0.04, "{kind:?}: {right} {wrong}");
        }
    }

    #[test]
    fn the_curve_of_srgb_is_undone_by_its_inverse() {
        let linear: Vec<f32> = (0..300).map(|k| k as f32 / 300.0).collect();
        let bytes = develop(&linear, 0.0, &mut Chance::of_stream(0, 0));
        assert_eq!(bytes.len(), 400);
        assert!(bytes.iter().skip(3).step_by(4).all(|&alpha| alpha == 255));
        // The 97th percentile of the greens lies at 0.8 of white: 0.8^(1 / 2.4) on the curve.
        let greens: Vec<u8> = bytes.iter().skip(1).step_by(4).copied().collect();
        assert!((f64::from(greens[97]) - 230.8).abs() < 4.0, "{}", greens[97]);
    }
}
