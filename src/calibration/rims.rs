//! Depth discontinuities: where a near surface ends in front of a farther one, in the colour camera's view.
//!
//! A pixel of the depth map is on a discontinuity if the next pixel with a depth, along its row or column, lies clearly
//! farther from the colour camera. The next pixel may lie beyond a hole: a depth camera that is offset from its projector
//! or its own colour camera misses depths on one side of each near object. The far side of a discontinuity is not used,
//! because it begins wherever this hole ends.

use super::frame::{Frame, Projection};

/// Distance in pixels within which the next depth is looked for. Beside an object 0.3 m in front of its wall, a Kinect
/// (baseline 75 mm) has a hole of 15 to 30 pixels. An object at half a metre in front of a wall at two metres has one of
/// 60 pixels, and its discontinuities on that side are not found. In a gathered map these are cells.
const WIDEST_HOLE: usize = 40;
/// Neighbours to each side that determine the local map from raster to image.
const REACH: isize = 2;
/// Minimum number of near pixels that determine this map.
const FEWEST_NEIGHBOURS: usize = 4;

/// A point of a depth discontinuity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rim {
    /// Index of the near pixel in the depth map.
    pub index: usize,
    /// Position at which the near surface ends on the image: half a depth pixel beyond the near pixel.
    pub pixel: [f64; 2],
    /// Unit normal of the discontinuity on the image, away from the near surface.
    pub normal: [f64; 2],
    /// Distance on the image along the normal, in pixels, from the near pixel to the next one of the raster. The near
    /// surface ends anywhere in between.
    pub gap: f64,
}

/// All depth discontinuities that the colour camera sees.
pub(super) fn find(frame: &Frame, projection: &Projection) -> Vec<Rim> {
    let near = |index: usize| {
        let depth = projection.positions[index][2];
        !depth.is_nan() && !projection.is_hidden[index] && ends_before_farther(frame, projection, index)
    };
    (0..frame.grid.len()).filter(|&index| near(index)).filter_map(|index| rim(frame, projection, index)).collect()
}

fn depth(projection: &Projection, index: usize) -> f64 {
    f64::from(projection.positions[index][2])
}

/// Whether any of the next pixels with a depth is clearly farther than the continued surface.
fn ends_before_farther(frame: &Frame, projection: &Projection, index: usize) -> bool {
    let grid = frame.grid;
    let (column, row) = grid.position(index);
    let here = depth(projection, index);
    let gap = frame.clear_gap(here);
    // Distance of neighbours in memory, and the number of pixels to the end of the raster ahead and behind.
    let ways = [
        (1, grid.width - 1 - column, column),
        (-1, column, grid.width - 1 - column),
        (grid.width as isize, grid.height - 1 - row, row),
        (-(grid.width as isize), row, grid.height - 1 - row),
    ];
    ways.into_iter().any(|(stride, ahead, behind)| {
        let at = |steps: isize| depth(projection, index.wrapping_add_signed(stride * steps));
        let mut steps = 1..=ahead.min(WIDEST_HOLE) as isize;
        let Some(steps) = steps.find(|&steps| !at(steps).is_nan()) else { return false };
        let farther = at(steps) - here;
        // Most pixels stop here: a continued slope only reduces the distance.
        if farther <= gap {
            return false;
        }
        // Slope of the surface over the two pixels on the other side.
        let before = if behind < 2 { f64::NAN } else { at(-2) };
        let slope = if before.is_nan() { 0.0 } else { ((here - before) / 2.0).max(0.0) };
        farther - slope.min(gap) * steps as f64 > gap
    })
}

/// The pixels around a pixel on a depth discontinuity.
#[derive(Default)]
struct Neighbourhood {
    /// Sum of the offsets on the raster of farther and missing pixels, less those of near and nearer ones: the direction
    /// away from the near surface.
    away: [f64; 2],
    /// Number of near pixels, their moments on the raster (xx, xy, yy), and their offsets on the image times those on the
    /// raster, row by row.
    count: usize,
    moments: [f64; 3],
    by_image: [[f64; 2]; 2],
}

impl Neighbourhood {
    fn of(frame: &Frame, projection: &Projection, index: usize) -> Self {
        let grid = frame.grid;
        let (column, row) = grid.position(index);
        let here = depth(projection, index);
        let gap = frame.clear_gap(here);
        let centre = projection.pixels[index];
        let mut sums = Self::default();
        for down in -REACH..=REACH {
            for right in -REACH..=REACH {
                let (column, row) = (column as isize + right, row as isize + down);
                if column < 0 || row < 0 || column as usize >= grid.width || row as usize >= grid.height {
                    continue;
                }
                let other = grid.index(column as usize, row as usize);
                let is_near = (depth(projection, other) - here).abs() <= gap;
                let offset = [right as f64, down as f64];
                // Nearer pixels belong to something in front of the discontinuity.
                let side = if is_near || depth(projection, other) < here { -1.0 } else { 1.0 };
                (0..2).for_each(|k| sums.away[k] += side * offset[k]);
                let pixel = projection.pixels[other];
                if is_near && !pixel[0].is_nan() {
                    sums.add(offset, [0, 1].map(|k| f64::from(pixel[k] - centre[k])));
                }
            }
        }
        sums
    }

    fn add(&mut self, [x, y]: [f64; 2], on_image: [f64; 2]) {
        let [xx, xy, yy] = self.moments;
        self.moments = [xx + x * x, xy + x * y, yy + y * y];
        (0..2).for_each(|k| {
            self.by_image[k] = [self.by_image[k][0] + on_image[k] * x, self.by_image[k][1] + on_image[k] * y];
        });
        self.count += 1;
    }

    /// The unit direction away from the near surface on the raster, and the fitted derivative of the position on the
    /// image with respect to that on the raster, row by row.
    fn fitted(&self) -> Option<([f64; 2], [[f64; 2]; 2])> {
        let [xx, xy, yy] = self.moments;
        let length = self.away[0].hypot(self.away[1]);
        let determinant = xx * yy - xy * xy;
        if self.count < FEWEST_NEIGHBOURS || length < 1.0 || determinant < 1e-6 * xx * yy {
            return None;
        }
        let map = self.by_image.map(|[x, y]| [(x * yy - y * xy) / determinant, (y * xx - x * xy) / determinant]);
        Some((self.away.map(|value| value / length), map))
    }
}

/// Position and normal of the depth discontinuity at a near pixel.
fn rim(frame: &Frame, projection: &Projection, index: usize) -> Option<Rim> {
    let centre = projection.pixels[index];
    if centre[0].is_nan() {
        return None;
    }
    let (away, [[a, b], [c, d]]) = Neighbourhood::of(frame, projection, index).fitted()?;
    // Normals transform by the inverse transpose.
    let sign = (a * d - b * c).signum();
    let normal = [sign * (d * away[0] - c * away[1]), sign * (a * away[1] - b * away[0])];
    let length = normal[0].hypot(normal[1]);
    let normal = normal.map(|value| value / length);
    let outwards = (a * away[0] + b * away[1]) * normal[0] + (c * away[0] + d * away[1]) * normal[1];
    if outwards.is_nan() || outwards <= 0.0 {
        return None;
    }
    let pixel = [0, 1].map(|k| f64::from(centre[k]) + 0.5 * outwards * normal[k]);
    Some(Rim { index, pixel, normal, gap: outwards })
}
