//! The frames of a check in another reading of their views: image or depth map mirrored or rotated, intrinsics of another
//! size, another unit or kind of depth.

use super::frame::Frame;
use super::input::usual_depths;
use super::planes::Planes;
use super::readings::Reading;
use crate::view::{Pinhole, Size};

/// A principal point this far from the middle, as a share of the side, belongs to an image of another size. Those of
/// cameras lie within some two percent.
const OFF_MIDDLE: f64 = 0.05;

/// Columns and rows of the streams of common colour and depth cameras.
const STREAMS: [[f64; 2]; 22] = [
    [320.0, 180.0],
    [320.0, 240.0],
    [320.0, 288.0],
    [424.0, 240.0],
    [480.0, 270.0],
    [512.0, 424.0],
    [512.0, 512.0],
    [640.0, 360.0],
    [640.0, 480.0],
    [640.0, 576.0],
    [848.0, 480.0],
    [960.0, 540.0],
    [1024.0, 768.0],
    [1024.0, 1024.0],
    [1280.0, 720.0],
    [1280.0, 800.0],
    [1280.0, 960.0],
    [1280.0, 1024.0],
    [1920.0, 1080.0],
    [1920.0, 1440.0],
    [2048.0, 1536.0],
    [3840.0, 2160.0],
];

/// A rearrangement of a raster's pixels.
#[derive(Clone, Copy)]
enum Turn {
    Mirrored,
    /// Clockwise.
    Quarter,
    Half,
    /// Counter-clockwise.
    Back,
}

impl Turn {
    /// The size of a raster after the turn.
    const fn size(self, Size { width, height }: Size) -> Size {
        match self {
            Self::Mirrored | Self::Half => Size { width, height },
            Self::Quarter | Self::Back => Size { width: height, height: width },
        }
    }

    /// Whether the intrinsics may belong to a raster of this size after the turn: the turn must not move the middle away from
    /// the principal point.
    fn fits(self, camera: &Pinhole, size: Size) -> bool {
        off_middle(camera, self.size(size)) <= off_middle(camera, size)
    }

    /// Where a pixel of a raster of this size lies after the turn.
    const fn place(self, Size { width, height }: Size, (column, row): (usize, usize)) -> (usize, usize) {
        match self {
            Self::Mirrored => (width - 1 - column, row),
            Self::Quarter => (height - 1 - row, column),
            Self::Half => (width - 1 - column, height - 1 - row),
            Self::Back => (row, width - 1 - column),
        }
    }

    /// For each pixel after the turn, its index in a raster of this size.
    fn sources(self, size: Size) -> Vec<usize> {
        let turned = self.size(size);
        let mut sources = vec![0; size.len()];
        for index in 0..size.len() {
            let (column, row) = self.place(size, size.position(index));
            sources[turned.index(column, row)] = index;
        }
        sources
    }
}

impl Reading {
    /// The turn of the image that undoes this mistake.
    const fn image_turn(self) -> Option<Turn> {
        match self {
            Self::ImageMirrored => Some(Turn::Mirrored),
            Self::ImageQuarterTurn => Some(Turn::Back),
            Self::ImageHalfTurn => Some(Turn::Half),
            Self::ImageQuarterBack => Some(Turn::Quarter),
            _ => None,
        }
    }

    /// The turn of the depth map that undoes this mistake.
    const fn depth_turn(self) -> Option<Turn> {
        match self {
            Self::DepthMirrored => Some(Turn::Mirrored),
            Self::DepthQuarterTurn => Some(Turn::Back),
            Self::DepthHalfTurn => Some(Turn::Half),
            Self::DepthQuarterBack => Some(Turn::Quarter),
            _ => None,
        }
    }

    /// An image, possibly blurred, in this reading.
    pub(super) fn planes(self, planes: &Planes) -> Planes {
        let mut read = planes.clone();
        if let Some(turn) = self.image_turn() {
            read.size = turn.size(planes.size);
            read.pixels.iter_mut().zip(turn.sources(planes.size)).for_each(|(to, from)| *to = planes.pixels[from]);
        }
        read
    }

    /// A frame in this reading; `None` if it cannot be read so, or nothing suggests it.
    pub(super) fn frame(self, frame: &Frame) -> Option<Frame> {
        let mut read = frame.clone();
        let size = frame.planes.size;
        if let Some(turn) = self.image_turn() {
            if !turn.fits(&frame.camera, size) {
                return None;
            }
            read.planes = self.planes(&frame.planes);
            if let (Some(to), Some(mask)) = (&mut read.image_mask, &frame.image_mask) {
                to.iter_mut().zip(turn.sources(size)).for_each(|(to, from)| *to = mask[from]);
            }
            return Some(read);
        }
        if let Some(turn) = self.depth_turn() {
            if frame.depth_camera.is_some_and(|camera| !turn.fits(&camera, frame.map)) {
                return None;
            }
            turn_map(turn, frame, &mut read);
        }
        match self {
            Self::ImageResized => read.camera = resized(&frame.camera, size)?,
            Self::ImageCropped => read.camera = cropped(&frame.camera, size)?,
            Self::DepthResized => read.depth_camera = Some(resized(&frame.depth_camera?, frame.map)?),
            Self::DepthCropped => read.depth_camera = Some(cropped(&frame.depth_camera?, frame.map)?),
            Self::DepthMillimetres if median_depth(frame) <= usual_depths(frame.is_cloud)[1] => return None,
            Self::DepthMetres if median_depth(frame) >= usual_depths(frame.is_cloud)[0] => return None,
            _ => {}
        }
        self.read_points(&mut read)?;
        Some(read)
    }

    /// Reads the points anew, from their depths and the frame's raster and depth camera.
    fn read_points(self, frame: &mut Frame) -> Option<()> {
        let factor = match self {
            Self::ImageResized | Self::ImageCropped => return Some(()),
            Self::DepthMillimetres => 0.001,
            Self::DepthMetres => 1000.0,
            _ => 0.0,
        };
        for index in 0..frame.points.len() {
            let point = frame.points[index];
            frame.points[index] = if factor > 0.0 {
                point.map(|value| factor * value)
            } else if self == Self::RayLength {
                frame.depth_camera?;
                let [x, y, z] = point;
                point.map(|value| value * (z / x.hypot(y).hypot(z)))
            } else {
                on_ray(&frame.depth_camera?, frame.place(index), point[2])
            };
        }
        frame.measure_noise();
        Some(())
    }
}

/// Turns the depth map, but leaves its points on their rays.
fn turn_map(turn: Turn, frame: &Frame, read: &mut Frame) {
    (read.grid, read.map) = (turn.size(frame.grid), turn.size(frame.map));
    if read.grid != frame.grid {
        read.cell.swap(0, 1);
    }
    for (to, from) in turn.sources(frame.grid).into_iter().enumerate() {
        read.points[to] = frame.points[from];
        if !frame.places.is_empty() {
            read.places[to] = turn.place(frame.map, frame.place(from));
        }
        if let (Some(read), Some(intensity)) = (&mut read.intensity, &frame.intensity) {
            read[to] = intensity[from];
        }
    }
}

fn median_depth(frame: &Frame) -> f32 {
    let mut distances: Vec<f32> =
        frame.points.iter().filter(|point| !point[2].is_nan()).map(|[x, y, z]| x.hypot(*y).hypot(*z)).collect();
    crate::numeric::quantile(&mut distances, 0.5)
}

/// The point at a depth on the ray of a pixel; NaN without a depth or a ray.
fn on_ray(camera: &Pinhole, (column, row): (usize, usize), z: f32) -> [f32; 3] {
    match camera.ray([column as f64, row as f64]) {
        Some([x, y, along]) if along > 0.0 => [x / along, y / along, 1.0].map(|value| value as f32 * z),
        _ => [f32::NAN; 3],
    }
}

/// Distance of the principal point from the middle of a raster of this size, as a share of the side.
fn off_middle(camera: &Pinhole, Size { width, height }: Size) -> f64 {
    let off = |centre: f64, side: usize| (centre - 0.5 * (side as f64 - 1.0)).abs() / side as f64;
    off(camera.cx, width).max(off(camera.cy, height))
}

/// The size of the image to which intrinsics belong: that of a common stream, or else the one in whose middle the principal
/// point lies.
fn stated_size(camera: &Pinhole) -> [f64; 2] {
    let stated = [2.0 * camera.cx + 1.0, 2.0 * camera.cy + 1.0];
    let off = |size: &[f64; 2]| (0..2).map(|k| (stated[k] / size[k] - 1.0).abs()).fold(0.0, f64::max);
    let nearest = STREAMS.iter().min_by(|a, b| off(a).total_cmp(&off(b)));
    nearest.copied().filter(|size| off(size) <= OFF_MIDDLE).unwrap_or(stated)
}

/// The intrinsics of an image of this size if they are those of another one with the same angle of view along x.
fn resized(camera: &Pinhole, size: Size) -> Option<Pinhole> {
    let stated = stated_size(camera);
    rescaled(camera, size, stated, size.width as f64 / stated[0])
}

/// The same with the same angle of view along y, if the images differ in shape.
fn cropped(camera: &Pinhole, size: Size) -> Option<Pinhole> {
    let stated = stated_size(camera);
    let [by_width, by_height] = [size.width as f64 / stated[0], size.height as f64 / stated[1]];
    let differs = (by_width / by_height - 1.0).abs() > OFF_MIDDLE;
    differs.then(|| rescaled(camera, size, stated, by_height)).flatten()
}

/// Intrinsics of an image of the size `stated`, for one that is scaled and has its sides cut or added evenly; `None` for
/// intrinsics of the image itself.
fn rescaled(camera: &Pinhole, size: Size, stated: [f64; 2], scale: f64) -> Option<Pinhole> {
    let sides = [size.width as f64, size.height as f64];
    let is_own = off_middle(camera, size) <= OFF_MIDDLE;
    let is_valid = scale.is_finite() && scale > 0.0;
    let centre = |k: usize, own: f64| scale * (own + 0.5) + 0.5 * (sides[k] - scale * stated[k]) - 0.5;
    let [cx, cy] = [centre(0, camera.cx), centre(1, camera.cy)];
    let scaled = Pinhole { fx: scale * camera.fx, fy: scale * camera.fy, cx, cy, lens: camera.lens };
    (is_valid && !is_own).then_some(scaled)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Lens;

    const SIZE: Size = Size { width: 12, height: 8 };

    fn camera() -> Pinhole {
        Pinhole { fx: 10.0, fy: 10.0, cx: 5.5, cy: 3.5, lens: Lens::None }
    }

    /// A frame whose image and depth map name their pixels, both seen by one camera.
    fn frame_of(camera: Pinhole) -> Frame {
        let pixels = (0..SIZE.len()).map(|index| [index as f32; 3]).collect();
        let planes = Planes { size: SIZE, pixels };
        let points =
            (0..SIZE.len()).map(|index| on_ray(&camera, SIZE.position(index), 0.5 + 0.01 * index as f32)).collect();
        let mut frame = Frame::new(String::new(), planes, camera, SIZE, points);
        frame.depth_camera = Some(camera);
        frame.image_mask = Some((0..SIZE.len()).map(|index| index == 5).collect());
        frame
    }

    fn frame() -> Frame {
        frame_of(camera())
    }

    #[test]
    fn four_quarters_are_a_whole_turn_and_a_quarter_is_undone_by_the_other() {
        // Its principal point is as far from the middle of a raster of 12 by 8 as from that of one of 8 by 12.
        let frame = || frame_of(Pinhole { cx: 4.5, cy: 4.5, ..camera() });
        let is_same = |a: &Frame, b: &Frame| {
            assert_eq!((a.planes.size, a.grid, a.map), (b.planes.size, b.grid, b.map));
            assert_eq!(a.planes.pixels, b.planes.pixels);
            assert_eq!(a.image_mask, b.image_mask);
            a.points.iter().flatten().zip(b.points.iter().flatten()).for_each(|(a, b)| assert!((a - b).abs() < 1e-3));
        };
        for [quarter, half, back, mirrored] in [
            [Reading::ImageQuarterTurn, Reading::ImageHalfTurn, Reading::ImageQuarterBack, Reading::ImageMirrored],
            [Reading::DepthQuarterTurn, Reading::DepthHalfTurn, Reading::DepthQuarterBack, Reading::DepthMirrored],
        ] {
            let after =
                |readings: &[Reading]| readings.iter().fold(frame(), |frame, reading| reading.frame(&frame).unwrap());
            is_same(&after(&[quarter, quarter]), &after(&[half]));
            is_same(&after(&[quarter, back]), &frame());
            is_same(&after(&[half, half]), &frame());
            is_same(&after(&[mirrored, mirrored]), &frame());
            is_same(&after(&[mirrored, quarter, mirrored]), &after(&[back]));
        }
        // A picture that was turned clockwise has its first pixel at the upper right.
        let restored = Reading::ImageQuarterTurn.frame(&frame()).unwrap();
        assert_eq!(restored.planes.size, Size { width: 8, height: 12 });
        assert_eq!(restored.planes.pixels[0][0], 11.0);
    }

    #[test]
    fn a_quarter_turn_that_moves_the_principal_point_away_from_the_middle_is_no_reading() {
        let of_image = [Reading::ImageQuarterTurn, Reading::ImageQuarterBack];
        let of_depth = [Reading::DepthQuarterTurn, Reading::DepthQuarterBack];
        let applies = |frame: &Frame, readings: [Reading; 2]| readings.map(|reading| reading.frame(frame).is_some());
        // The intrinsics of an image of 8 by 12, from before it was turned.
        let stored = Pinhole { cx: 3.5, cy: 5.5, ..camera() };
        let mut turned = frame();
        turned.camera = stored;
        assert_eq!((applies(&turned, of_image), applies(&turned, of_depth)), ([true; 2], [false; 2]));
        turned.depth_camera = Some(stored);
        assert_eq!((applies(&frame(), of_image), applies(&turned, of_depth)), ([false; 2], [true; 2]));
        // Halves and mirrors keep the size.
        assert!(Reading::ImageHalfTurn.frame(&frame()).is_some() && Reading::DepthMirrored.frame(&frame()).is_some());
    }

    #[test]
    fn intrinsics_of_another_size_are_scaled_and_own_ones_are_kept() {
        let wide = Pinhole { fx: 20.0, fy: 20.0, cx: 11.5, cy: 7.5, lens: Lens::None };
        let found = resized(&wide, SIZE).unwrap();
        assert_eq!((found.fx, found.fy, found.cx, found.cy), (10.0, 10.0, 5.5, 3.5));
        assert!(cropped(&wide, SIZE).is_none() && resized(&camera(), SIZE).is_none());
        // Twice as high, and cut at the sides to a square.
        let square = Pinhole { cx: 7.5, ..wide };
        assert_eq!(cropped(&square, SIZE).unwrap().fx, 10.0);
        let mut frame = frame();
        frame.camera = wide;
        assert_eq!(Reading::ImageResized.frame(&frame).unwrap().camera.fx, 10.0);
        assert!(Reading::DepthResized.frame(&frame).is_none());
    }

    #[test]
    fn lengths_along_rays_and_other_units_become_depths() {
        let with = |change: fn([f32; 3]) -> [f32; 3]| {
            let mut frame = frame();
            frame.points.iter_mut().for_each(|point| *point = change(*point));
            frame
        };
        let lengths = with(|p| {
            let along = (p[0] * p[0] + p[1] * p[1] + p[2] * p[2]).sqrt() / p[2];
            p.map(|value| value * along)
        });
        let found = Reading::RayLength.frame(&lengths).unwrap();
        found.points.iter().zip(&frame().points).for_each(|(a, b)| assert!((a[2] - b[2]).abs() < 1e-3));
        let small = with(|point| point.map(|value| 0.001 * value));
        let large = with(|point| point.map(|value| 1000.0 * value));
        assert!(
            (median_depth(&Reading::DepthMetres.frame(&small).unwrap()) / median_depth(&frame()) - 1.0).abs() < 1e-5
        );
        assert!(Reading::DepthMillimetres.frame(&large).is_some());
        assert!(Reading::DepthMetres.frame(&frame()).is_none() && Reading::DepthMillimetres.frame(&frame()).is_none());
        // A cloud has no rays of pixels.
        let mut cloud = frame();
        cloud.depth_camera = None;
        let is_of_map = |reading: &Reading| reading.frame(&cloud).is_none();
        assert!([Reading::RayLength, Reading::DepthMirrored, Reading::DepthResized].iter().all(is_of_map));
    }
}
