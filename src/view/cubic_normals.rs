//! Third-order normals with their errors (docs/method/views.md): w(a, b) = sum c_jk a^j b^k, j + k <= 3, over the
//! tangent plane.
//!
//! The neighbours of a point are expressed in its tangent plane (a, b along it, w off it), and a cubic is fitted to
//! them by weighted least squares. Its slope at the point corrects the normal, twice. The neighbours are those within
//! two or three pixels, or more pixels under noise. The window with the smallest error is used. In the tangent plane,
//! the surface near an occluding contour is as smooth as one that faces the camera. A depth z(x, y) has unbounded
//! derivatives there, which bias central differences.
//!
//! The error of a normal follows from the residual of its cubic and the weight that determines its slopes. Neighbours
//! beyond a depth discontinuity are excluded. If fewer remain than a cubic needs, the first normal stays with the error
//! [`UNFITTED`]. Limits: detail finer than the window is smoothed; noise of the points passes with a gain of about a
//! half, no worse than with central differences.

use nalgebra::Vector3;

use crate::numeric::{DOUBLE_LANES, Doubles, Real, dot, noise, quantile};
use crate::view::cubic_moments::Moments;
use crate::view::{Normals, Points, Size};

/// Half widths of the windows in pixels. The first is the smallest that determines a cubic with some redundancy; the
/// second suits flat parts, the others noisy views.
const RADII: [usize; 4] = [2, 3, 5, 8];
/// Sigma of the weights along the tangent plane, in half widths. Set on Mozart (docs/lab/thresholds.md).
const SIGMA: f64 = 0.75;
/// Median error of the normals, in radians, above which windows wider than the first two are tried. Views without noise
/// stay below it (data not recorded).
const NOISY: f32 = 0.06;
/// Limit for a wider window in noisy views: the ratio of the mean square motion of the normals to the decrease of their
/// squared errors, as the fits estimate them. Pure noise gives a ratio of 0.62, its share of the estimated square. The
/// rest is the squared bias of the wider window. Up to a ratio of 1.24, the sum of bias and noise falls. The limit is a
/// little lower, because a registration averages noise over its points, but not bias.
const MOST_MOVED: f64 = 1.1;
/// Half width of the squares over which the motion of the normals is summed, in half widths of the window. Overlapping
/// windows share their noise.
const REACH: usize = 2;
/// Largest |w| of a neighbour: half the distance along the plane plus 0.3 pixel lengths. Beyond it lies another part of
/// the object.
const LARGEST_SLOPE: f64 = 0.5;
const LARGEST_OFFSET: f64 = 0.3;
/// The same limit close to the point in noisy views, standard deviations of the depth's noise; the larger of both
/// limits holds.
const NOISE_OFFSETS: f64 = 3.0;
/// Residuals up to this multiple of the estimated noise count as noise, because the estimate errs by a sixth on steep
/// or small views.
const NOISE_MARGIN: f64 = 1.25;
/// Number of rounds from a first normal. The second round starts from a normal that is accurate to a few hundredths of
/// a radian. If the normal of a narrower window is that accurate, one round from it suffices.
const ROUNDS: usize = 2;
/// Error in radians below which a normal is accurate enough for a single round. Set on Mozart at 128x128
/// (docs/lab/thresholds.md).
const CLOSE: f32 = 0.06;
/// Smallest cosine between the fitted normal and the first one; below it the fit is rejected.
const LEAST_COSINE: f64 = 0.02;
/// Largest |n_y| for which the tangents are constructed from the y axis.
const LEVEL: f64 = 0.7;
/// Error of a normal for which no cubic could be fitted, radians, which is that of a one-sided difference.
pub const UNFITTED: f32 = 0.3;

/// Improves `normals` (unit, NaN where missing) of the organised `points` in place and writes each one's error in
/// radians; NaN where there is no normal. Returns the standard deviation of the points in pixel lengths.
///
/// Each pixel takes the window of least error among those consistent with the narrower ones: a normal that moves by
/// more than its previous error is biased by the wider window (Lepski's rule). In noisy views, noise moves normals too.
/// If the noise is white, the surroundings of a pixel together show whether normals move by more than the noise
/// explains. Otherwise only the error decides.
pub fn improve(size: Size, points: &Points, normals: &mut Normals, error: &mut [f32], is_white: bool) -> f64 {
    let mut first = normals.clone();
    let (mut wide, mut wide_error) = (normals.clone(), vec![f32::NAN; error.len()]);
    let noise = noise_of(size, points);
    error.fill(f32::NAN);
    let mut excesses = Vec::new();
    let mut noisy = false;
    for radius in RADII {
        let window = Window {
            radius,
            sigma: SIGMA * radius as f64,
            offset: LARGEST_OFFSET.max(NOISE_OFFSETS * noise),
            noise: NOISE_MARGIN * noise,
        };
        fit_all(size, points, &first, error, window, |index, normal, new_error| {
            wide.set(index, normal);
            wide_error[index] = new_error;
        });
        if noisy && is_white {
            let excess = |index: usize| {
                let gained = f64::from(error[index]).powi(2) - f64::from(wide_error[index]).powi(2);
                let counts = gained > 0.0 && error[index] < UNFITTED;
                if counts { apart(&wide, normals, index).powi(2) - MOST_MOVED * gained } else { 0.0 }
            };
            excesses = (0..error.len()).map(excess).collect();
            excesses = sums_around(size, &excesses, REACH * radius);
        }
        for index in 0..error.len() {
            let agrees = match (noisy, is_white) {
                (true, true) => excesses[index] < 0.0,
                (true, false) => true,
                (false, _) => apart(&wide, normals, index) < f64::from(error[index]),
            };
            if error[index].is_nan() || (wide_error[index] < error[index] && agrees) {
                normals.set(index, wide.get(index));
                error[index] = wide_error[index];
            }
            if error[index] < CLOSE {
                first.set(index, normals.get(index));
            }
        }
        noisy = median(error.iter().copied()) >= NOISY;
        if radius > RADII[0] && !noisy {
            break;
        }
    }
    noise
}

/// Sums over squares with this half width around each pixel.
fn sums_around(size: Size, values: &[f64], reach: usize) -> Vec<f64> {
    let pass = |values: &[f64], stride: usize, count: usize| -> Vec<f64> {
        let sum = |index: usize| {
            let place = index / stride % count;
            let first = place.saturating_sub(reach);
            let start = index - (place - first) * stride;
            (0..=(place + reach).min(count - 1) - first).map(|step| values[start + step * stride]).sum()
        };
        (0..values.len()).map(sum).collect()
    };
    pass(&pass(values, 1, size.width), size.width, size.height)
}

/// Distance between two normals of a pixel.
fn apart(a: &Normals, b: &Normals, index: usize) -> f64 {
    f64::from((Vector3::from(a.get(index)) - Vector3::from(b.get(index))).norm())
}

/// Limits of the neighbours in a fit, pixel lengths.
#[derive(Clone, Copy)]
struct Window {
    radius: usize,
    sigma: f64,
    /// Largest |w| close to the point.
    offset: f64,
    /// Largest residual that counts as noise.
    noise: f64,
}

/// Standard deviation of the points, pixel lengths.
fn noise_of(size: Size, points: &Points) -> f64 {
    let mut fourths = size.runs().map(|run: [usize; noise::NEIGHBOURS]| {
        let points = run.map(|index| Vector3::from(points.get(index).map(f64::from)));
        let unit = (points[run.len() - 1] - points[0]).norm() / (run.len() - 1) as f64;
        (noise::fourth_difference(points).norm() / unit) as f32
    });
    noise::of_fourth_differences(&mut fourths, 2 * size.len())
}

/// Median of the finite values; infinite without any.
fn median(values: impl Iterator<Item = f32>) -> f32 {
    let mut values: Vec<f32> = values.filter(|value| value.is_finite()).collect();
    if values.is_empty() { f32::INFINITY } else { quantile(&mut values, 0.5) }
}

/// Visits every point that has a first normal, with the normal of its cubic and its error; `error` holds the known
/// errors, or NaN.
fn fit_all(
    size: Size,
    points: &Points,
    first: &Normals,
    error: &[f32],
    window: Window,
    mut visit: impl FnMut(usize, [f32; 3], f32),
) {
    let known = |index: usize| first.is_valid(index) && points.is_valid(index);
    let mut band = Band::new(size, window);
    for row in 0..size.height {
        band.fill(size, points, row);
        for column in (0..size.width).step_by(DOUBLE_LANES) {
            let start = size.index(column, row);
            let count = DOUBLE_LANES.min(size.width - column);
            if !(start..start + count).any(known) {
                continue;
            }
            let firsts: [[f32; 3]; DOUBLE_LANES] = std::array::from_fn(|lane| first.get(start + lane.min(count - 1)));
            let normal = [0, 1, 2].map(|axis: usize| Doubles::from(firsts.map(|first| f64::from(first[axis]))));
            let is_close = error[start..start + count].iter().all(|error| *error < CLOSE);
            let (fitted, error) = band.fit(column, normal, if is_close { 1 } else { ROUNDS });
            let (cosine, error) = (dot(fitted, normal).array(), error.array());
            for lane in (0..count).filter(|lane| known(start + lane)) {
                let fitted = fitted.map(|axis| axis.array()[lane] as f32);
                // Cosine and error are NaN if no cubic could be fitted.
                let good = cosine[lane] > LEAST_COSINE && error[lane].is_finite();
                let (normal, error) = if good { (fitted, error[lane] as f32) } else { (firsts[lane], UNFITTED) };
                visit(start + lane, normal, error.min(UNFITTED));
            }
        }
    }
}

/// The rows of points within reach of the windows of one row, padded with NaN left and right of the raster, so that no
/// index needs a check.
struct Band {
    window: Window,
    stride: usize,
    axes: [Vec<f64>; 3],
}

impl Band {
    fn new(size: Size, window: Window) -> Self {
        let stride = size.width + 2 * window.radius + DOUBLE_LANES;
        let axes = [(); 3].map(|()| vec![f64::NAN; (2 * window.radius + 1) * stride]);
        Self { window, stride, axes }
    }

    /// Copies the rows around `row`.
    fn fill(&mut self, size: Size, points: &Points, row: usize) {
        for (axis, values) in self.axes.iter_mut().zip([&points.x, &points.y, &points.z]) {
            for (place, line) in axis.chunks_exact_mut(self.stride).enumerate() {
                let line = &mut line[self.window.radius..][..size.width];
                match (row + place).checked_sub(self.window.radius).filter(|&row| row < size.height) {
                    Some(row) => {
                        let values = &values[size.index(0, row)..][..size.width];
                        line.iter_mut().zip(values).for_each(|(new, &value)| *new = f64::from(value));
                    }
                    None => line.fill(f64::NAN),
                }
            }
        }
    }

    /// The points at this offset into the band.
    #[inline(always)]
    fn points(&self, start: usize) -> [Doubles; 3] {
        let [x, y, z] = &self.axes;
        [Doubles::load(x, start), Doubles::load(y, start), Doubles::load(z, start)]
    }

    /// The normals of the cubics at `column` and its right neighbour, and their errors; NaN where missing.
    fn fit(&self, column: usize, first: [Doubles; 3], rounds: usize) -> ([Doubles; 3], Doubles) {
        let middle = column + self.window.radius * (self.stride + 1);
        let centre = self.points(middle);
        let missing = Doubles::splat(f64::INFINITY);
        let square = [middle - 1, middle + 1, middle - self.stride, middle + self.stride]
            .map(|near| subtract(self.points(near), centre))
            .into_iter()
            .fold(missing, |least, step| dot(step, step).min(least));
        let unit = square.sqrt();
        let (mut normal, mut last_error) = (first, missing);
        for _ in 0..rounds {
            let tangents = tangents(normal);
            let axes = [tangents[0], tangents[1], normal].map(|axis| scale(axis, Doubles::splat(1.0) / unit));
            let (slopes, error) = self.moments(column, centre, axes).slopes(self.window.noise);
            let tilt = |axis: usize| slopes[0] * tangents[0][axis] + slopes[1] * tangents[1][axis];
            normal = normalize([0, 1, 2].map(|axis: usize| normal[axis] - tilt(axis)));
            last_error = error;
        }
        (normal, last_error)
    }

    /// Sums over the neighbours of two points, in coordinates along their `axes`.
    #[inline(never)]
    fn moments(&self, column: usize, centre: [Doubles; 3], axes: [[Doubles; 3]; 3]) -> Moments {
        let slope = Doubles::splat(LARGEST_SLOPE * LARGEST_SLOPE);
        let flatness = Doubles::splat(-0.5 * std::f64::consts::LOG2_E / (self.window.sigma * self.window.sigma));
        let mut moments = Moments::zero();
        for row in 0..=2 * self.window.radius {
            for across in 0..=2 * self.window.radius {
                let offset = subtract(self.points(row * self.stride + column + across), centre);
                let [a, b, w] = [dot(axes[0], offset), dot(axes[1], offset), dot(axes[2], offset)];
                let far = a * a + b * b;
                let beyond = ((w * w).sqrt() - Doubles::splat(self.window.offset)).raised_to(0.0);
                // NaN fails the comparison, so a missing neighbour gets weight and position zero.
                let near = (beyond * beyond).at_most(slope * far);
                let weight = near.keep((far * flatness).exp2());
                moments.add(near.keep(Doubles::splat(1.0)), weight, near.keep(a), near.keep(b), near.keep(w));
            }
        }
        moments
    }
}

/// Unit vectors perpendicular to a normal: the first also to the y axis, or to the x axis if y is close to the normal.
fn tangents([x, y, z]: [Doubles; 3]) -> [[Doubles; 3]; 2] {
    let zero = Doubles::splat(0.0);
    let level = (y * y).less(Doubles::splat(LEVEL * LEVEL));
    let across = normalize([level.keep(zero - z), level.select(zero, z), level.select(x, zero - y)]);
    let [ax, ay, az] = across;
    [across, [y * az - z * ay, z * ax - x * az, x * ay - y * ax]]
}

fn subtract(a: [Doubles; 3], b: [Doubles; 3]) -> [Doubles; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn scale([x, y, z]: [Doubles; 3], factor: Doubles) -> [Doubles; 3] {
    [x * factor, y * factor, z * factor]
}

fn normalize(vector: [Doubles; 3]) -> [Doubles; 3] {
    scale(vector, Doubles::splat(1.0) / dot(vector, vector).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{Camera, normals};

    /// Depth of a sphere of radius 20 in an orthographic view, with its true normals.
    fn sphere() -> (Size, Points, Normals) {
        let size = Size { width: 48, height: 48 };
        let (mut points, mut truth) = (Points::missing(size.len()), Normals::missing(size.len()));
        for index in 0..size.len() {
            let (column, row) = size.position(index);
            let [x, y] = Camera::Orthographic.ray(size, [column as f64, row as f64]);
            let square = 400.0 - x * x - y * y;
            if square > 4.0 {
                let z = -square.sqrt();
                points.set(index, [x as f32, y as f32, (z + 60.0) as f32]);
                truth.set(index, [x, y, z].map(|value| (value / 20.0) as f32));
            }
        }
        (size, points, truth)
    }

    fn median_error(found: &Normals, truth: &Normals) -> f32 {
        let off =
            |index: usize| (0..3).map(|k| (found.get(index)[k] - truth.get(index)[k]).powi(2)).sum::<f32>().sqrt();
        let mut errors: Vec<f32> =
            (0..found.len()).filter(|&i| found.is_valid(i) && -truth.z[i] < 0.6).map(off).collect();
        errors.sort_by(f32::total_cmp);
        errors[errors.len() / 2]
    }

    #[test]
    fn the_rim_of_a_sphere_is_ten_times_better_than_by_differences() {
        let (size, points, truth) = sphere();
        let mut found = normals::of_cloud(size, &points);
        let before = median_error(&found, &truth);
        let mut error = vec![0.0; size.len()];
        improve(size, &points, &mut found, &mut error, true);
        let after = median_error(&found, &truth);
        assert!(after < 0.1 * before, "{before} {after}");
        for index in 0..size.len() {
            assert_eq!(error[index].is_nan(), !found.is_valid(index));
        }
    }

    /// Half a pixel of noise tilts differences by 20 degrees; the estimated errors match the true ones within a factor
    /// of two.
    #[test]
    fn noise_takes_wider_windows_and_errors_are_estimated() {
        let (size, mut points, truth) = sphere();
        let mut normal = noise::white_noise(3);
        points.z.iter_mut().for_each(|z| *z += 0.5 * normal() as f32);
        let mut found = normals::of_cloud(size, &points);
        let before = median_error(&found, &truth);
        let mut error = vec![0.0; size.len()];
        improve(size, &points, &mut found, &mut error, true);
        let after = median_error(&found, &truth);
        let estimated = median(error.iter().copied());
        assert!(after < 0.3 * before, "{before} {after}");
        assert!((0.5 * after..2.0 * after).contains(&estimated), "{after} {estimated}");
    }

    #[test]
    fn what_cannot_be_fitted_keeps_its_normal_with_the_largest_error() {
        let size = Size { width: 4, height: 4 };
        let mut points = Points::missing(size.len());
        (0..8).for_each(|k| points.set(k, [(k % 4) as f32, (k / 4) as f32, 5.0]));
        let mut found = normals::of_cloud(size, &points);
        let mut error = vec![0.0; size.len()];
        improve(size, &points, &mut found, &mut error, true);
        assert_eq!((found.get(1), error[1]), ([0.0, 0.0, -1.0], UNFITTED));
        assert!(error[12].is_nan());
    }
}
