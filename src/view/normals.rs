//! n = (dP/drow x dP/dcolumn) / |...|: normals of a depth map or an organised cloud P(column, row) (docs/method/views.md).
//!
//! Method: central differences of the points along both axes, which include camera and distortion, and one-sided
//! differences at holes and borders. For noisy depth, the slopes of the weighted least-squares plane P = c + a column +
//! b row over a window are an alternative. The winding of the grid orients the normal. For a depth map it then faces
//! the camera; for a rotated organised cloud it may rightly face away from it.
//!
//! Discontinuities: a step between neighbours is not used if it is longer than four times the median of the (up to)
//! four steps around the pixel along the same axis. Lengths are in space, so a flat region has the steps of its
//! sampling. Smaller steps from quantisation or noise do not count as jumps.
//!
//! Limits: second order inside (error z'''/6 per pixel), first order at borders and holes. A structure of one or two
//! pixels has no steps around it for comparison and keeps its jumps. The plane fit is first order where its window is
//! asymmetric, and rounds edges off within its radius. NaN if an axis has no usable neighbour.

use crate::numeric::{LANES, Lanes, Real};
use crate::view::{Camera, Normals, Points, Size};

/// Length of the longest usable step, in units of the median step around it. Smooth shapes stay below three up to the
/// last pixel before their occluding contour; a fold of 75 degrees against a flat surround just passes.
const LONGEST_STEP: f64 = 4.0;
/// Widest window of a plane fit, in pixels from its centre.
const LARGEST_RADIUS: usize = 16;
/// Least determinant of a plane's two slopes, as a share of its diagonal, below which the window is a line.
const LEAST_DETERMINANT: f64 = 1e-3;

/// The method that estimates normals from points.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Estimate {
    /// Central differences.
    Differences,
    /// Local plane with biweight weights over a disc of this radius in pixels (1 to 16).
    PlaneFit {
        /// Radius in pixels.
        radius: usize,
    },
}

/// Unit normals by central differences of a depth map (row-major, along z, in metres or pixels, NaN at holes).
#[must_use]
pub fn of_depth(size: Size, camera: Camera, depth: &[f32]) -> Normals {
    let mut normals = Normals::missing(size.len());
    of_depth_into(size, camera, depth, &mut normals);
    normals
}

/// [`of_depth`] into the caller's memory. Allocates nothing. With lens distortion, [`points_of_depth`] and
/// [`from_points`] are faster, because each pixel's ray is found once instead of nine times.
pub fn of_depth_into(size: Size, camera: Camera, depth: &[f32], normals: &mut Normals) {
    of_depth_rows(size, camera, depth, 0, normals);
}

/// [`of_depth_into`] for as many pixels as `normals` holds, starting at the row `first`.
pub(crate) fn of_depth_rows(size: Size, camera: Camera, depth: &[f32], first: usize, normals: &mut Normals) {
    let rows = normals.len() / size.width;
    if camera.is_orthographic()
        && depth.len() == size.len()
        && normals.len() == rows * size.width
        && first + rows <= size.height
    {
        return of_orthographic(size, depth, first, normals);
    }
    let point = |index| depth.get(index).and_then(|&depth| point_at(size, &camera, depth, index));
    Grid { size, point }.estimate(Estimate::Differences, first * size.width, normals);
}

/// Unit normals of an organised cloud by central differences, oriented by the grid.
#[must_use]
pub fn of_cloud(size: Size, points: &Points) -> Normals {
    let mut normals = Normals::missing(size.len());
    from_points(size, points, Estimate::Differences, &mut normals);
    normals
}

/// Unit normals of an organised cloud over `size`, NaN where missing. Allocates nothing.
pub fn from_points(size: Size, points: &Points, estimate: Estimate, normals: &mut Normals) {
    let point = |index| {
        let point = if index < points.len() { points.get(index).map(f64::from) } else { return None };
        point.iter().all(|value| value.is_finite()).then_some(point)
    };
    Grid { size, point }.estimate(estimate, 0, normals);
}

/// Points of a depth map in the camera's frame (row-major, depth along z, in metres or pixels); NaN at holes.
pub fn points_of_depth(size: Size, camera: &Camera, depth: &[f32], points: &mut Points) {
    for (index, &depth) in depth.iter().enumerate().take(points.len().min(size.len())) {
        let point = point_at(size, camera, depth, index);
        points.set(index, point.map_or([f32::NAN; 3], |point| point.map(|value| value as f32)));
    }
}

/// Orthographic depth may have any sign; only positive depth is in front of a pinhole camera.
fn point_at(size: Size, camera: &Camera, depth: f32, index: usize) -> Option<Vector> {
    let (column, row) = size.position(index);
    let usable = depth.is_finite() && (camera.is_orthographic() || depth > 0.0);
    usable.then(|| camera.point(size, [column as f64, row as f64], f64::from(depth)))
}

type Vector = [f64; 3];
/// Column and row.
type Pixel = (usize, usize);

/// Points over a raster, `None` where missing.
struct Grid<F> {
    size: Size,
    point: F,
}

impl<F: Fn(usize) -> Option<Vector>> Grid<F> {
    /// Estimates the normals of the pixels, starting at `first`.
    fn estimate(&self, estimate: Estimate, first: usize, normals: &mut Normals) {
        for index in 0..(self.size.len() - first).min(normals.len()) {
            let pixel = self.size.position(first + index);
            let slopes = match estimate {
                Estimate::Differences => self.differences(pixel),
                Estimate::PlaneFit { radius } => self.plane(pixel, radius.clamp(1, LARGEST_RADIUS)),
            };
            let normal = slopes.and_then(|[along_column, along_row]| unit(cross(along_row, along_column)));
            normals.set(index, normal.map_or([f32::NAN; 3], |normal| normal.map(|value| value as f32)));
        }
    }

    /// The point `right` columns and `down` rows from a pixel, if there is one.
    fn beside(&self, (column, row): Pixel, right: isize, down: isize) -> Option<Vector> {
        let column = column.checked_add_signed(right).filter(|&column| column < self.size.width)?;
        let row = row.checked_add_signed(down).filter(|&row| row < self.size.height)?;
        (self.point)(self.size.index(column, row))
    }

    /// The five points along an axis, with the pixel in the middle.
    fn line(&self, pixel: Pixel, right: isize, down: isize) -> [Option<Vector>; 5] {
        [-2, -1, 0, 1, 2].map(|step| self.beside(pixel, step * right, step * down))
    }

    /// dP/dcolumn and dP/drow.
    fn differences(&self, pixel: Pixel) -> Option<[Vector; 2]> {
        self.beside(pixel, 0, 0)?;
        Some([slope(self.line(pixel, 1, 0))?, slope(self.line(pixel, 0, 1))?])
    }

    /// Slopes of the plane P - P_0 = c + a column + b row over the usable points within `radius`.
    fn plane(&self, pixel: Pixel, radius: usize) -> Option<[Vector; 2]> {
        let centre = self.beside(pixel, 0, 0)?;
        let steps = [self.line(pixel, 1, 0), self.line(pixel, 0, 1)].map(median_step);
        let longest = LONGEST_STEP * LONGEST_STEP * steps[0].unwrap_or(0.0).max(steps[1].unwrap_or(0.0));
        let reach = (radius + 1) as f64;
        let radius = radius as isize;
        // Moments of weight, column u and row v, and their products with the point.
        let (mut w0, mut wu, mut wv, mut wuu, mut wuv, mut wvv) = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0);
        let (mut p0, mut pu, mut pv) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        for down in -radius..=radius {
            for right in -radius..=radius {
                let (u, v) = (right as f64, down as f64);
                let far = (u * u + v * v) / (reach * reach);
                let Some(point) = self.beside(pixel, right, down).filter(|_| far < 1.0) else { continue };
                let offset = minus(point, centre);
                if square(offset) > longest * (u * u + v * v) {
                    continue;
                }
                let weight = (1.0 - far) * (1.0 - far);
                w0 += weight;
                wu += weight * u;
                wv += weight * v;
                wuu += weight * u * u;
                wuv += weight * u * v;
                wvv += weight * v * v;
                for axis in 0..3 {
                    p0[axis] += weight * offset[axis];
                    pu[axis] += weight * u * offset[axis];
                    pv[axis] += weight * v * offset[axis];
                }
            }
        }
        // The centre has weight one, so w0 > 0; eliminating c leaves a 2x2 system.
        let (uu, uv, vv) = (wuu - wu * wu / w0, wuv - wu * wv / w0, wvv - wv * wv / w0);
        let determinant = uu * vv - uv * uv;
        if determinant.is_nan() || determinant <= LEAST_DETERMINANT * wuu * wvv {
            return None;
        }
        let ru: Vector = std::array::from_fn(|axis| pu[axis] - wu * p0[axis] / w0);
        let rv: Vector = std::array::from_fn(|axis| pv[axis] - wv * p0[axis] / w0);
        Some([
            std::array::from_fn(|axis| (vv * ru[axis] - uv * rv[axis]) / determinant),
            std::array::from_fn(|axis| (uu * rv[axis] - uv * ru[axis]) / determinant),
        ])
    }
}

/// Central differences of an orthographic depth map, whose steps along an axis are (1, dz): four pixels at a time and
/// in f32, because the difference of two neighbouring depths is exact there. Starts from the row `first`.
fn of_orthographic(size: Size, depth: &[f32], first: usize, normals: &mut Normals) {
    let (one, missing) = (Lanes::splat(1.0), Lanes::splat(f32::NAN));
    for row in first..first + normals.len() / size.width {
        // Two rows above, this row, and two below.
        let rows = [-2, -1, 0, 1, 2].map(|step| {
            let row = row.wrapping_add_signed(step);
            if row < size.height { &depth[row * size.width..][..size.width] } else { &[] }
        });
        for column in (0..size.width).step_by(LANES) {
            let start = (row - first) * size.width + column;
            let end = start + LANES.min(size.width - column);
            let place = column as isize;
            let mut normal = [missing; 3];
            if Lanes::load(rows[2], place).finite().any() {
                let p = lane_slope([-2, -1, 0, 1, 2].map(|step| Lanes::load(rows[2], place + step)));
                let q = lane_slope(rows.map(|row| Lanes::load(row, place)));
                let inverse = one / (p * p + q * q + one).sqrt();
                normal = [p * inverse, q * inverse, Lanes::splat(0.0) - inverse];
            }
            normal[0].store(&mut normals.x[start..end]);
            normal[1].store(&mut normals.y[start..end]);
            normal[2].store(&mut normals.z[start..end]);
        }
    }
}

/// [`slope`] of five depths in a line, a pixel apart; NaN where missing.
#[inline(never)]
fn lane_slope(line: [Lanes; 5]) -> Lanes {
    let far = Lanes::splat(f32::INFINITY);
    let lengths = |step: Lanes| {
        let square = Lanes::splat(1.0) + step * step;
        square.finite().select(square, far)
    };
    let (before, after) = (line[2] - line[1], line[3] - line[2]);
    let [a, b, c, d] = [lengths(line[1] - line[0]), lengths(before), lengths(after), lengths(line[4] - line[3])];
    let (b_first, d_first) = (b.less(a), d.less(c));
    let (low, high) = (b_first.select(b, a), b_first.select(a, b));
    let (other_low, other_high) = (d_first.select(d, c), d_first.select(c, d));
    let (least, more) = {
        let other_first = other_low.less(low);
        (other_first.select(other_low, low), other_first.select(low, other_low))
    };
    let rest = other_high.less(high).select(other_high, high);
    // The median is the shorter of one or two steps, and the second of three or four. If the third exists, there are at
    // least three.
    let second = rest.less(more).select(rest, more);
    let third = rest.less(more).select(more, rest);
    let median = third.less(far).select(second, least);
    let longest = Lanes::splat((LONGEST_STEP * LONGEST_STEP) as f32) * median;
    let usable = |length: Lanes| length.less(far) & length.at_most(longest);
    let (has_before, has_after) = (usable(b), usable(c));
    let either = has_before.select(before, has_after.select(after, Lanes::splat(f32::NAN)));
    (has_before & has_after).select(Lanes::splat(0.5) * (before + after), either)
}

/// Lower median of the squared lengths of the steps between five points in a line.
fn median_step(line: [Option<Vector>; 5]) -> Option<f64> {
    let mut squares = [f64::INFINITY; 4];
    let mut count = 0;
    for pair in line.windows(2) {
        if let (Some(a), Some(b)) = (pair[0], pair[1]) {
            let square = square(minus(b, a));
            // Insertion sort, because for four numbers a general sort is slow and large in wasm.
            let mut place = count;
            while place > 0 && squares[place - 1] > square {
                squares[place] = squares[place - 1];
                place -= 1;
            }
            squares[place] = square;
            count += 1;
        }
    }
    (count > 0).then(|| squares[(count - 1) / 2])
}

/// Derivative at the middle of five points, from the neighbours that no jump separates from it.
fn slope(line: [Option<Vector>; 5]) -> Option<Vector> {
    let longest = LONGEST_STEP * LONGEST_STEP * median_step(line)?;
    let middle = line[2]?;
    let usable = |neighbour: Option<Vector>| neighbour.filter(|&point| square(minus(point, middle)) <= longest);
    match (usable(line[1]), usable(line[3])) {
        (Some(before), Some(after)) => Some(minus(after, before).map(|value| value / 2.0)),
        (Some(before), None) => Some(minus(middle, before)),
        (None, Some(after)) => Some(minus(after, middle)),
        (None, None) => None,
    }
}

fn minus(a: Vector, b: Vector) -> Vector {
    std::array::from_fn(|axis| a[axis] - b[axis])
}

fn cross([ax, ay, az]: Vector, [bx, by, bz]: Vector) -> Vector {
    [ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx]
}

fn square([x, y, z]: Vector) -> f64 {
    x * x + y * y + z * z
}

/// The vector at unit length, if it has a direction.
fn unit(vector: Vector) -> Option<Vector> {
    let length = square(vector).sqrt();
    (length.is_finite() && length > 0.0).then(|| vector.map(|value| value / length))
}
