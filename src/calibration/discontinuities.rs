//! Depth discontinuities: places in the colour camera's view where a near surface ends in front of a farther one.
//!
//! A pixel of the depth map is on a discontinuity if the next pixel with a depth, along its row or column, lies clearly behind the
//! continuation of the pixel's own surface, as seen from the colour camera. The next pixel may lie beyond a hole: a depth camera that is
//! offset from its projector or its own colour camera misses depths on one side of each near object. The far side of a discontinuity is not
//! used, because it begins wherever this hole ends.

use super::frame::{Frame, Projection};

/// Distance in pixels of the depth map within which the next depth is searched. Beside an object 0.3 m in front of its
/// wall, a Kinect (baseline 75 mm) has a hole of 15 to 30 pixels. An object at half a metre in front of a wall at two
/// metres has one of 60 pixels, and its discontinuities on that side are not found.
const WIDEST_HOLE: usize = 40;
/// Distances to the pixel on the near side from which the slope of the surface is measured, in the order of preference.
/// Two pixels average the steps of a quantised map; the other distances serve if that pixel has no depth.
const BEHIND: [isize; 4] = [2, 1, 3, 4];
/// Neighbours to each side that determine the local map from raster to image.
const REACH: isize = 2;
/// Pixels to each side along which a boundary counts as straight.
const STRAIGHT: usize = 8;
/// Minimum number of near pixels that determine this map.
const FEWEST_NEIGHBOURS: usize = 4;

/// A point of a depth discontinuity.
#[derive(Clone, Copy, Debug)]
pub(super) struct Discontinuity {
    /// Index of the near pixel in the depth map.
    pub index: usize,
    /// Position at which the near surface ends on the image: in the middle of the gap.
    pub pixel: [f64; 2],
    /// Unit normal of the discontinuity on the image, away from the near surface.
    pub normal: [f64; 2],
    /// Distance along the normal on the image, in pixels, from the near pixel to the next pixel of the raster beyond
    /// the near surface. The surface ends anywhere in between.
    pub gap: f64,
    /// Number of neighbours along a row or column of the raster, including the pixel itself, whose surface ends in the
    /// same gap. The position of a straight boundary in its gap is one unknown for all of them.
    pub in_gap: f64,
}

/// All depth discontinuities that the colour camera sees.
pub(super) fn find(frame: &Frame, projection: &Projection) -> Vec<Discontinuity> {
    let width = frame.grid.width as isize;
    let is_continued = |index: usize| {
        let here = depth(projection, index);
        let gap = frame.clear_gap(here);
        // At the border of the raster, a wrong neighbour takes the place of none.
        [1, -1, width, -width].into_iter().all(|stride| {
            let beside = projection.positions.get(index.wrapping_add_signed(stride));
            beside.is_some_and(|position| f64::from(position[2]) - here <= gap)
        })
    };
    let is_near =
        |index: &usize| !projection.is_hidden[*index] && !depth(projection, *index).is_nan() && !is_continued(*index);
    let mut found: Vec<Discontinuity> = vec![];
    let mut directions = vec![usize::MAX; frame.grid.len()];
    for index in (0..frame.grid.len()).filter(is_near) {
        if let Some((discontinuity, direction)) = discontinuity(frame, projection, index) {
            directions[index] = direction;
            found.push(discontinuity);
        }
    }
    found
        .iter_mut()
        .for_each(|discontinuity| discontinuity.in_gap = count_in_gap(frame, &directions, discontinuity.index) as f64);
    found
}

/// The number of neighbours, including the pixel itself, along a row or column of the raster whose surface ends in the
/// same gap: a boundary between two rows continues along the row, one between two columns along the column.
fn count_in_gap(frame: &Frame, directions: &[usize], index: usize) -> usize {
    let (direction, (column, row)) = (directions[index], frame.grid.position(index));
    let is_between_rows = direction >= 2;
    let (at, length, stride) =
        if is_between_rows { (column, frame.grid.width, 1) } else { (row, frame.grid.height, frame.grid.width) };
    let of = |place: (usize, usize)| if is_between_rows { place.1 } else { place.0 };
    let line = of(frame.place(index));
    let neighbours = at.saturating_sub(STRAIGHT)..(at + STRAIGHT + 1).min(length);
    let is_in_gap = |other: &usize| {
        let other = index + other * stride - at * stride;
        directions[other] == direction && of(frame.place(other)) == line
    };
    neighbours.filter(is_in_gap).count()
}

fn depth(projection: &Projection, index: usize) -> f64 {
    f64::from(projection.positions[index][2])
}

/// In each of the four directions, the step on the raster to the next pixel beyond the near surface, if the next depth is
/// clearly farther than the continued surface.
fn ends_before_farther(frame: &Frame, projection: &Projection, index: usize) -> [Option<[f64; 2]>; 4] {
    let grid = frame.grid;
    let (column, row) = grid.position(index);
    let here = depth(projection, index);
    let gap = frame.clear_gap(here);
    let hole = frame.cell.map(|side| WIDEST_HOLE.div_ceil(side));
    // Step on the raster, distance of neighbours in memory, the widest hole, and the number of pixels to the end of the
    // raster ahead and behind.
    let directions = [
        ([1.0, 0.0], 1, hole[0], grid.width - 1 - column, column),
        ([-1.0, 0.0], -1, hole[0], column, grid.width - 1 - column),
        ([0.0, 1.0], grid.width as isize, hole[1], grid.height - 1 - row, row),
        ([0.0, -1.0], -(grid.width as isize), hole[1], row, grid.height - 1 - row),
    ];
    directions.map(|(beside, stride, hole, ahead, behind)| {
        let at = |steps: isize| depth(projection, index.wrapping_add_signed(stride * steps));
        let mut steps = 1..=ahead.min(hole) as isize;
        let steps = steps.find(|&steps| !at(steps).is_nan())?;
        // A continued slope only reduces the distance.
        if at(steps) - here <= gap {
            return None;
        }
        let is_known = |&back: &isize| back as usize <= behind && !at(-back).is_nan();
        // One sample does not show whether the surface recedes like a floor.
        let back = BEHIND.into_iter().find(is_known)?;
        // Planes are linear in the inverse depth.
        let slope = ((1.0 / here - 1.0 / at(-back)) / back as f64).min(0.0);
        let continued = 1.0 / here + slope * steps as f64;
        let is_beyond = continued > 0.0 && at(steps) - 1.0 / continued > gap;
        // Beyond a hole, the surface ends before the first missing pixel.
        let step = if steps == 1 { frame.step(index, index.wrapping_add_signed(stride)) } else { beside };
        is_beyond.then_some(step)
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
                // Nearer pixels belong to an object in front of the discontinuity.
                let side = if is_near || depth(projection, other) < here { -1.0 } else { 1.0 };
                (0..2).for_each(|k| sums.away[k] += side * offset[k]);
                let pixel = projection.pixels[other];
                if is_near && !pixel[0].is_nan() {
                    sums.add(frame.step(index, other), [0, 1].map(|k| f64::from(pixel[k] - centre[k])));
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

/// The place along the normal at which the near surface ends, from the steps to the pixels beyond it.
struct Gap {
    /// The direction on the raster that is nearest to the normal.
    direction: usize,
    gap: f64,
}

impl Gap {
    /// A step s at an angle a to the normal covers |s| cos a along the normal. The gap follows from the mean of the
    /// inverse squares of these lengths, weighted by the fourth power of the cosine. The nearest sample beyond counts
    /// most. A sample in the direction of the boundary, which only noise puts beyond it, has a cosine near zero and
    /// hardly counts.
    fn of(ends: &[Option<[f64; 2]>; 4], normal: [f64; 2], on_image: impl Fn([f64; 2]) -> [f64; 2]) -> Option<Self> {
        let (mut precision, mut weights, mut best) = (0.0, 0.0, (0.0, 0));
        for (direction, step) in ends.iter().enumerate() {
            let Some(step) = step else { continue };
            let [x, y] = on_image(*step);
            let (along, length) = (x * normal[0] + y * normal[1], x.hypot(y));
            let cosine = along / length;
            if cosine > 0.0 {
                precision += cosine.powi(2) / length.powi(2);
                weights += cosine.powi(4);
                if cosine > best.0 {
                    best = (cosine, direction);
                }
            }
        }
        (weights > 0.0).then(|| Self { direction: best.1, gap: (weights / precision).sqrt() })
    }
}

/// Position and normal of the depth discontinuity at a near pixel, and the direction on the raster in which the surface
/// ends first.
fn discontinuity(frame: &Frame, projection: &Projection, index: usize) -> Option<(Discontinuity, usize)> {
    let ends = ends_before_farther(frame, projection, index);
    let centre = projection.pixels[index];
    if centre[0].is_nan() || ends == [None; 4] {
        return None;
    }
    let (away, [[a, b], [c, d]]) = Neighbourhood::of(frame, projection, index).fitted()?;
    // Normals transform by the inverse transpose.
    let sign = (a * d - b * c).signum();
    let normal = [sign * (d * away[0] - c * away[1]), sign * (a * away[1] - b * away[0])];
    let length = normal[0].hypot(normal[1]);
    let normal = normal.map(|value| value / length);
    let Gap { direction, gap } = Gap::of(&ends, normal, |[x, y]| [a * x + b * y, c * x + d * y])?;
    let pixel = [0, 1].map(|k| f64::from(centre[k]) + 0.5 * gap * normal[k]);
    Some((Discontinuity { index, pixel, normal, gap, in_gap: 1.0 }, direction))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::planes::Planes;
    use crate::calibration::unknowns::State;
    use crate::pose::Similarity;
    use crate::view::{Lens, Pinhole, Size};

    /// The discontinuities that a camera at the depth camera's place sees, on cells of a raster of 64 by 48 rays with
    /// this depth along them.
    fn seen(cell: [usize; 2], depth: impl Fn([f64; 2]) -> f64) -> Vec<Discontinuity> {
        let camera = Pinhole { fx: 60.0, fy: 60.0, cx: 31.5, cy: 23.5, lens: Lens::None };
        let size = Size { width: 64, height: 48 };
        let grid = Size { width: size.width / cell[0], height: size.height / cell[1] };
        let point = |index: usize| {
            let (column, row) = grid.position(index);
            let ray =
                [((column * cell[0]) as f64 - camera.cx) / camera.fx, ((row * cell[1]) as f64 - camera.cy) / camera.fy];
            let z = depth(ray);
            [ray[0] * z, ray[1] * z, z].map(|value| value as f32)
        };
        let points = (0..grid.len()).map(point).collect();
        let planes = Planes { size, pixels: vec![[0.5; 3]; size.len()] };
        let mut frame = Frame::new(String::new(), planes, camera, grid, points);
        frame.cell = cell;
        frame.places =
            (0..grid.len()).map(|index| grid.position(index)).map(|(x, y)| (x * cell[0], y * cell[1])).collect();
        let projection = Projection::new(&frame, &State::at(Similarity::identity()));
        find(&frame, &projection)
    }

    /// A floor 0.4 m below the camera in front of a wall 5 m away.
    fn floor([_, y]: [f64; 2]) -> f64 {
        if y > 0.08 { 0.4 / y } else { 5.0 }
    }

    #[test]
    fn a_floor_that_recedes_between_coarse_rows_has_no_discontinuity() {
        for rows in [1, 2, 4, 6] {
            let found = seen([1, rows], floor);
            assert!(found.is_empty(), "{rows}: {}", found.len());
        }
    }

    /// Between coarse rows an oblique boundary passes the samples of a row at different distances: the next sample of the
    /// row may be nearer than the next row.
    #[test]
    fn an_oblique_boundary_lies_within_the_gap_of_each_of_its_samples() {
        for rows in [1, 2, 4] {
            // Samples lie half a pixel off the centres, so that none lies on the boundary.
            let found = seen([1, rows], |[x, y]| if 60.0 * (x + y) < -0.5 { 1.0 } else { 3.0 });
            let inner: Vec<_> =
                found.iter().filter(|discontinuity| (8.0..40.0).contains(&discontinuity.pixel[1])).collect();
            assert!(inner.len() >= 25, "{rows}: {}", inner.len());
            let off = |discontinuity: &&Discontinuity| {
                (discontinuity.pixel[0] - 31.5 + discontinuity.pixel[1] - 23.5 + 0.5) * 0.5_f64.sqrt()
            };
            let mean = inner.iter().map(off).sum::<f64>() / inner.len() as f64;
            assert!(mean.abs() < 0.35, "{rows}: {mean}");
            let outside =
                inner.iter().filter(|discontinuity| off(discontinuity).abs() > 0.5 * discontinuity.gap + 0.1).count();
            assert!(outside == 0, "{rows}: {outside} of {}", inner.len());
            // Rows of the raster are this far apart along the normal; a normal that is fitted to few samples errs.
            let spacing = rows as f64 * 0.5_f64.sqrt();
            let mean = inner.iter().map(|discontinuity| discontinuity.gap).sum::<f64>() / inner.len() as f64;
            assert!(
                mean < 1.05 * spacing && inner.iter().all(|discontinuity| discontinuity.gap <= rows as f64),
                "{rows}: {mean}"
            );
            let nearest = inner.iter().filter(|discontinuity| discontinuity.gap < 0.8 * spacing).count();
            assert!(rows == 1 || nearest >= inner.len() / rows - 1, "{rows}: {nearest} of {}", inner.len());
        }
    }

    #[test]
    fn a_straight_boundary_along_the_raster_has_many_in_one_gap() {
        let found = seen([1, 4], |[_, y]| if y < 0.1 { 1.0 } else { 3.0 });
        assert!(found.len() > 50, "{}", found.len());
        let inner = found.iter().filter(|discontinuity| (12.0..52.0).contains(&discontinuity.pixel[0]));
        assert!(
            inner.clone().all(|discontinuity| discontinuity.in_gap == 17.0),
            "{:?}",
            inner.map(|discontinuity| discontinuity.in_gap).collect::<Vec<_>>()
        );
        let oblique = seen([1, 1], |[x, y]| if 60.0 * (x + y) < -0.5 { 1.0 } else { 3.0 });
        assert!(
            oblique.iter().all(|discontinuity| discontinuity.in_gap < 3.0),
            "{:?}",
            oblique.iter().map(|discontinuity| discontinuity.in_gap).collect::<Vec<_>>()
        );
    }

    #[test]
    fn a_surface_ends_within_the_gap_between_two_samples() {
        for columns in [1, 2, 4] {
            let found = seen([columns, 1], |[x, _]| if x.abs() < 0.2 { 1.0 } else { 3.0 });
            // Both sides of the box are found in nearly all rows. Above and below, the raster ends.
            assert!(found.len() >= 90, "{columns}: {}", found.len());
            for discontinuity in found.into_iter().filter(|discontinuity| (2.5..44.5).contains(&discontinuity.pixel[1]))
            {
                assert!(
                    (discontinuity.gap - columns as f64).abs() < 0.05 * columns as f64,
                    "{columns}: {}",
                    discontinuity.gap
                );
                let side = (discontinuity.pixel[0] - 31.5).signum();
                assert!((discontinuity.normal[0] - side).abs() < 1e-6);
                // The box ends between x = 0.2 and the next sample of the wall.
                let beyond = discontinuity.pixel[0] * side - 31.5 * side - 12.0;
                assert!(beyond.abs() <= columns as f64, "{columns}: {beyond}");
            }
        }
    }
}
