//! Rims: where a near surface ends before a farther one, as the colour camera would see it.
//!
//! A pixel of the depth map is on a rim if the next one that has a depth, along its row or column, lies clearly farther
//! from the colour camera. Next ones are looked for across holes: a depth camera that is offset from its projector or its
//! own colours has a shadow of missing depth on one side of all that is near. Far sides of rims are not used; they start
//! wherever that shadow ends.

use super::frame::{Frame, Projection};

/// Holes up to this many pixels wide are looked across: the shadow of an object 0.3 m before its wall is 15 to 30 pixels of a
/// Kinect (baseline 75 mm) wide. One half a metre away before a wall at two has 60, and loses that side of its rims.
const WIDEST_HOLE: usize = 40;
/// Neighbours to each side that say how rim and image lie to each other.
const REACH: isize = 2;
/// Near pixels that determine the map from raster to image at a rim.
const FEWEST_NEIGHBOURS: usize = 4;

/// A point of a rim.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rim {
    /// Index of the near pixel in the depth map.
    pub index: usize,
    /// Where the near surface ends on the image: half a depth pixel beyond the near pixel.
    pub pixel: [f64; 2],
    /// Unit normal of the rim on the image, away from the near surface.
    pub normal: [f64; 2],
    /// Distance along the normal from the near pixel to the next on the raster: the near surface ends anywhere in between.
    pub gap: f64,
}

/// All rims that the colour camera sees.
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

/// Whether any of the next pixels with a depth is clearly farther than the surface goes on.
fn ends_before_farther(frame: &Frame, projection: &Projection, index: usize) -> bool {
    let grid = frame.grid;
    let (column, row) = grid.position(index);
    let here = depth(projection, index);
    let gap = frame.clear_gap(here);
    // Distance of neighbours in memory, pixels from here to the raster's end, and to its other end.
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
        // Of all pixels but a few hundred this is enough: a surface that falls away makes it less.
        if farther <= gap {
            return false;
        }
        // How steeply the surface falls away already, over the two pixels before.
        let before = if behind < 2 { f64::NAN } else { at(-2) };
        let slope = if before.is_nan() { 0.0 } else { ((here - before) / 2.0).max(0.0) };
        farther - slope.min(gap) * steps as f64 > gap
    })
}

/// The pixels around one on a rim.
#[derive(Default)]
struct Neighbourhood {
    /// Sum of the offsets on the raster of farther pixels, less those of near and nearer ones: away from the near surface.
    away: [f64; 2],
    /// Near pixels, their moments on the raster (xx, xy, yy), and their offsets on the image times those on the raster, row by row.
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
                // Nearer ones belong to something before the rim.
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

    /// The unit direction away from the near surface on the raster, and the fitted map d image / d raster, row by row.
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

/// Position and normal of the rim at a near pixel.
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
