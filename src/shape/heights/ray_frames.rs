//! The normal at a pixel as a function of the surface's slopes (docs/method/heights.md).

use nalgebra::Vector3;

use crate::numeric::{LANES, Lanes};
use crate::view::{Camera, Size};

/// (a, b, c) of N = a + p b + q c: N points at the camera; p and q are slopes per pixel in pixels of height.
///
/// For an orthographic camera, z is depth in pixels and N = (p, q, -1). For a pinhole, z = f log Z, so that slopes are
/// alike, and with the ray r(u, v) a = r_v x r_u, b = (r_v x r) / f, c = (r x r_u) / f; multiplied by f^2, so that N
/// has a length of order one.
pub(super) type RayFrame = [[f32; 3]; 3];

/// The frame of every pixel of an orthographic camera.
pub(super) const ORTHOGRAPHIC: RayFrame = [[0.0, 0.0, -1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

/// The frames of the pixels of a box.
pub(super) enum RayFrames {
    Orthographic,
    /// Without distortion, a ray consists of its column's x and its row's y. Each is stored with its change to the next
    /// pixel.
    Pinhole {
        columns: Vec<[f64; 2]>,
        rows: Vec<[f64; 2]>,
        focal_length: f64,
    },
    /// With distortion, each pixel has its own frame.
    Distorted(Vec<RayFrame>),
}

impl RayFrames {
    /// Frames of a box of `sides` columns and rows that begins at the pixel `corner`. Columns beyond the view repeat
    /// its last one.
    pub fn new(camera: &Camera, size: Size, corner: [usize; 2], sides: [usize; 2]) -> Self {
        let Some(focal_length) = camera.focal_length() else { return Self::Orthographic };
        let last = [size.width - 1, size.height - 1];
        let place = |axis: usize, index: usize| (corner[axis] + index).min(last[axis]) as f64;
        if camera.is_straight() {
            let line = |axis: usize| {
                // Without distortion, the other axis does not matter.
                let ray = |place: f64| camera.ray(size, [place; 2])[axis];
                let places = (0..sides[axis]).map(|index| place(axis, index));
                places.map(|place| [ray(place), ray(place + 0.5) - ray(place - 0.5)]).collect()
            };
            return Self::Pinhole { columns: line(0), rows: line(1), focal_length };
        }
        let pixels = (0..sides[0] * sides[1]).map(|index| [place(0, index % sides[0]), place(1, index / sides[0])]);
        Self::Distorted(
            pixels
                .map(|pixel| frame_of(|off| camera.ray(size, [pixel[0] + off[0], pixel[1] + off[1]]), focal_length))
                .collect(),
        )
    }

    /// (a, b, c) of four pixels in a row.
    pub fn lanes(&self, index: usize) -> [[Lanes; 3]; 3] {
        let mut four = [ORTHOGRAPHIC; LANES];
        match self {
            Self::Orthographic => {}
            Self::Pinhole { columns, rows, focal_length } => {
                let (row, columns) = (rows[index / columns.len()], &columns[index % columns.len()..]);
                for (frame, &column) in four.iter_mut().zip(columns) {
                    *frame = pinhole_frame(column, row, *focal_length);
                }
            }
            Self::Distorted(frames) => {
                for (frame, own) in four.iter_mut().zip(&frames[index..]) {
                    *frame = *own;
                }
            }
        }
        let entry = |side: usize, axis: usize| Lanes::from(four.map(|frame| frame[side][axis]));
        [0, 1, 2].map(|side| [entry(side, 0), entry(side, 1), entry(side, 2)])
    }
}

/// [`frame_of`] if x changes only along a row and y only along a column.
#[inline(never)]
fn pinhole_frame([x, along_column]: [f64; 2], [y, along_row]: [f64; 2], focal_length: f64) -> RayFrame {
    let scale = focal_length * focal_length;
    [
        [0.0, 0.0, (scale * -(along_row * along_column)) as f32],
        [(focal_length * along_row) as f32, 0.0, (focal_length * -(along_row * x)) as f32],
        [0.0, (focal_length * along_column) as f32, (focal_length * -(y * along_column)) as f32],
    ]
}

fn frame_of(ray: impl Fn([f64; 2]) -> [f64; 2], focal_length: f64) -> RayFrame {
    let ray = |right: f64, down: f64| {
        let [x, y] = ray([right, down]);
        Vector3::new(x, y, 1.0)
    };
    let along_column = ray(0.5, 0.0) - ray(-0.5, 0.0);
    let along_row = ray(0.0, 0.5) - ray(0.0, -0.5);
    let here = ray(0.0, 0.0);
    let vectors = [
        focal_length * focal_length * along_row.cross(&along_column),
        focal_length * along_row.cross(&here),
        focal_length * here.cross(&along_column),
    ];
    vectors.map(|vector| vector.map(|value| value as f32).into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{Lens, Pinhole};

    /// Frames built from columns and rows equal those of each pixel's own rays.
    #[test]
    fn frames_of_rows_and_columns_are_those_of_the_rays() {
        let size = Size { width: 23, height: 17 };
        let pinhole = Pinhole { fx: 41.0, fy: 43.7, cx: 10.3, cy: 8.9, lens: Lens::None };
        let camera = Camera::Pinhole(pinhole);
        let frames = RayFrames::new(&camera, size, [3, 2], [24, 11]);
        for index in (0..24 * 11).step_by(4) {
            let four = frames.lanes(index).map(|vector| vector.map(Lanes::array));
            for lane in 0..4 {
                let (column, row) = ((3 + index % 24 + lane).min(22), 2 + index / 24);
                let ray = |[right, down]: [f64; 2]| camera.ray(size, [column as f64 + right, row as f64 + down]);
                let expected = frame_of(ray, (41.0_f64 * 43.7).sqrt());
                assert_eq!(four.map(|vector| vector.map(|axis| axis[lane])), expected);
            }
        }
    }
}
