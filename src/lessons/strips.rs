//! Characteristic strips: classical shape from shading under one known lamp (Horn 1970). For lessons; the estimate itself
//! works with normals of single pixels and a surface fit.
//!
//! With slopes p, q of the depth and the reflectance map R(p, q), a strip follows
//!
//! > x' = R_p, y' = R_q, z' = p R_p + q R_q, p' = E_x, q' = E_y
//!
//! from a ring around a singular point, where the surface faces the lamp. The curvature there follows from that of the
//! picture, up to the sign that makes a bump or a dent. Limits: an orthographic picture, one lamp, albedo 1; a strip ends
//! where the surface faces away from the lamp or the camera, or where the picture contradicts it.

use nalgebra::{Matrix2, SymmetricEigen, Vector2, Vector3};

use crate::error::{Error, ErrorKind, Result};
use crate::view::Size;

use super::lamp::Lamp;

/// Radius of the first ring, pixels, within which the picture's curvature is measured.
const RING: f64 = 3.0;
/// Length of a step in the picture, pixels.
const STEP: f64 = 0.25;
/// Number of steps after which a strip ends in any case, because it has then crossed the largest picture.
const MOST_STEPS: usize = 4096;
/// Largest number of strips of one call.
const MOST_STRIPS: usize = 360;
/// Intensity, as a share of the lamp's strength, below which a slope is no longer determined by the picture.
const DARKEST: f64 = 0.05;
/// Gradient of the reflectance map below which a strip has no direction.
const FLAT: f64 = 0.02;
/// Difference between the picture and the strip's own intensity at which it ends.
const CONTRADICTION: f64 = 0.1;

/// A picture of a surface of albedo 1 under one lamp.
#[derive(Clone, Copy, Debug)]
pub struct ShadedImage<'a> {
    /// Size of the picture in pixels.
    pub size: Size,
    /// Intensities row by row, NaN outside the object.
    pub values: &'a [f32],
    /// The lamp, of strength 1.
    pub lamp: Lamp,
}

/// Whether the surface around a singular point is assumed to be a bump or a dent, which the picture does not show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The surface is nearer in the middle.
    Bump,
    /// The surface is farther in the middle.
    Dent,
}

/// Points (column, row, depth) along each strip from a singular point, whose depth is zero.
///
/// # Errors
/// [`ErrorKind::Size`] if there are not as many values as pixels; [`ErrorKind::Range`] if the point does not lie in the
/// picture, if no surface faces the lamp there, or if there are more strips than 360.
pub fn characteristic_strips(
    image: ShadedImage<'_>,
    centre: [f64; 2],
    form: Form,
    count: usize,
) -> Result<Vec<Vec<[f32; 3]>>> {
    if image.values.len() != image.size.len() {
        let message = format!("{} pixels need as many values, not {}", image.size.len(), image.values.len());
        return Err(Error::new(ErrorKind::Size, "values", message));
    }
    if count > MOST_STRIPS {
        return Err(Error::new(ErrorKind::Range, "count", format!("at most {MOST_STRIPS} strips, not {count}")));
    }
    let centre = Vector2::from(centre);
    let first = Singular::at(&image, centre, form)
        .ok_or_else(|| Error::new(ErrorKind::Range, "centre", "no surface around this pixel faces the lamp"))?;
    let bearing = |index: usize| std::f64::consts::TAU * index as f64 / count as f64;
    Ok((0..count).map(|index| strip(&image, centre, &first, bearing(index))).collect())
}

/// The surface at a singular point up to its second order.
struct Singular {
    slopes: Vector2<f64>,
    curvature: Matrix2<f64>,
}

impl Singular {
    fn at(image: &ShadedImage<'_>, centre: Vector2<f64>, form: Form) -> Option<Self> {
        let Lamp(lamp) = image.lamp;
        if !lamp.iter().all(|part| part.is_finite()) || lamp.z > -DARKEST {
            return None;
        }
        let slopes = Vector2::new(-lamp.x / lamp.z, -lamp.y / lamp.z);
        // E = 1 - d' H K H d / 2 with the curvature H of the surface and K of the reflectance map.
        let bend = reflectance_bend(slopes);
        let half = square_root(bend)?;
        let inverse = half.try_inverse()?;
        let curvature = inverse * square_root(half * picture_bend(image, centre)? * half)? * inverse;
        let sign = match form {
            Form::Bump => 1.0,
            Form::Dent => -1.0,
        };
        Some(Self { slopes, curvature: sign * curvature })
    }
}

/// Minus the second derivatives of the reflectance map at its maximum, where these are the lamp's slopes.
fn reflectance_bend(slopes: Vector2<f64>) -> Matrix2<f64> {
    let w = 1.0 + slopes.norm_squared();
    (Matrix2::identity() - slopes * slopes.transpose() / w) / w
}

/// Minus the second derivatives of the picture at a bright spot, by least squares over the ring's disc: 1 - E is a
/// quadratic form there.
fn picture_bend(image: &ShadedImage<'_>, centre: Vector2<f64>) -> Option<Matrix2<f64>> {
    let mut normal = nalgebra::Matrix3::zeros();
    let mut right = Vector3::zeros();
    let reach = RING as i32;
    for (dx, dy) in (-reach..=reach).flat_map(|dy| (-reach..=reach).map(move |dx| (f64::from(dx), f64::from(dy)))) {
        let value = sampled(image, centre + Vector2::new(dx, dy))?;
        let terms = Vector3::new(0.5 * dx * dx, dx * dy, 0.5 * dy * dy);
        normal += terms * terms.transpose();
        right += terms * (1.0 - value);
    }
    let [a, b, c]: [f64; 3] = (normal.try_inverse()? * right).into();
    Some(Matrix2::new(a, b, b, c))
}

/// The positive square root of a symmetric matrix; None if it has a negative eigenvalue.
fn square_root(matrix: Matrix2<f64>) -> Option<Matrix2<f64>> {
    let eigen = SymmetricEigen::new(matrix);
    let all_positive = eigen.eigenvalues.iter().all(|&value| value > 0.0);
    all_positive.then(|| {
        let roots = Matrix2::from_diagonal(&eigen.eigenvalues.map(f64::sqrt));
        eigen.eigenvectors * roots * eigen.eigenvectors.transpose()
    })
}

/// One strip from the ring outward.
fn strip(image: &ShadedImage<'_>, centre: Vector2<f64>, first: &Singular, bearing: f64) -> Vec<[f32; 3]> {
    let away = RING * Vector2::new(bearing.cos(), bearing.sin());
    let mut slopes = first.slopes + first.curvature * away;
    let mut place = centre + away;
    let mut depth = first.slopes.dot(&away) + 0.5 * away.dot(&(first.curvature * away));
    let mut points = vec![[centre.x as f32, centre.y as f32, 0.0], [place.x as f32, place.y as f32, depth as f32]];
    let outward = gradient_of_reflectance(image.lamp, slopes).dot(&away).signum();
    for _ in 0..MOST_STEPS {
        let Some((half_place, half_slopes)) = advanced(image, (place, slopes), (place, slopes), 0.5 * outward * STEP)
        else {
            break;
        };
        let Some((next, next_slopes)) = advanced(image, (place, slopes), (half_place, half_slopes), outward * STEP)
        else {
            break;
        };
        depth += half_slopes.dot(&(next - place));
        (place, slopes) = (next, next_slopes);
        points.push([place.x as f32, place.y as f32, depth as f32]);
    }
    points
}

type State = (Vector2<f64>, Vector2<f64>);

/// A step from one state with the derivatives at another; None where the strip ends.
fn advanced(image: &ShadedImage<'_>, (place, slopes): State, at: State, step: f64) -> Option<State> {
    let intensity = sampled(image, at.0)?;
    let gradient = gradient_of_reflectance(image.lamp, at.1);
    let length = gradient.norm();
    let off = intensity - reflectance(image.lamp, at.1);
    if intensity < DARKEST || length < FLAT || off.abs() > CONTRADICTION {
        return None;
    }
    let change = gradient_of_image(image, at.0)? * (step / length);
    let moved = slopes + change;
    // Moves the slopes back onto the curve of slopes with the picture's intensity, so that errors do not add up.
    let next = place + gradient * (step / length);
    let there = gradient_of_reflectance(image.lamp, moved);
    let rest = sampled(image, next)? - reflectance(image.lamp, moved);
    let back = there * (rest / there.norm_squared().max(FLAT * FLAT));
    Some((next, moved + back))
}

/// R(p, q): the intensity of a surface with these slopes.
fn reflectance(lamp: Lamp, slopes: Vector2<f64>) -> f64 {
    let length = (1.0 + slopes.norm_squared()).sqrt();
    (lamp.0.xy().dot(&slopes) - lamp.0.z) / length
}

fn gradient_of_reflectance(lamp: Lamp, slopes: Vector2<f64>) -> Vector2<f64> {
    let squared = 1.0 + slopes.norm_squared();
    lamp.0.xy() / squared.sqrt() - slopes * (reflectance(lamp, slopes) / squared)
}

/// Central differences over one pixel to either side.
fn gradient_of_image(image: &ShadedImage<'_>, at: Vector2<f64>) -> Option<Vector2<f64>> {
    let along = |by: Vector2<f64>| Some(0.5 * (sampled(image, at + by)? - sampled(image, at - by)?));
    Some(Vector2::new(along(Vector2::x())?, along(Vector2::y())?))
}

/// Bilinear interpolation; None outside the object.
fn sampled(image: &ShadedImage<'_>, at: Vector2<f64>) -> Option<f64> {
    let Size { width, height } = image.size;
    let [x, y] = [at.x.floor(), at.y.floor()];
    if !(x >= 0.0 && y >= 0.0 && x + 1.0 < width as f64 && y + 1.0 < height as f64) {
        return None;
    }
    let index = image.size.index(x as usize, y as usize);
    let value = |offset: usize| f64::from(image.values[index + offset]);
    let [u, v] = [at.x - x, at.y - y];
    let upper = value(0) + u * (value(1) - value(0));
    let lower = value(width) + u * (value(width + 1) - value(width));
    Some(upper + v * (lower - upper)).filter(|value| value.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: Size = Size { width: 129, height: 129 };
    const RADIUS: f64 = 60.0;
    const MIDDLE: f64 = 64.0;

    /// A ball under a lamp, with its depth.
    fn ball(lamp: Lamp) -> (Vec<f32>, impl Fn(f64, f64) -> f64) {
        let depth = |x: f64, y: f64| -(RADIUS * RADIUS - (x - MIDDLE).powi(2) - (y - MIDDLE).powi(2)).sqrt();
        let shade = |index| {
            let (column, row) = SIZE.position(index);
            let [x, y] = [column as f64 - MIDDLE, row as f64 - MIDDLE].map(|part| part / RADIUS);
            lamp.shade([x, y, -(1.0 - x * x - y * y).sqrt()].map(|part| part as f32))
        };
        ((0..SIZE.len()).map(shade).collect(), depth)
    }

    #[test]
    fn strips_of_a_ball_lie_on_it() {
        for lamp in [[0.0, 0.0, -1.0], [0.3, -0.4, -0.866], [-0.6, 0.0, -0.8]].map(Vector3::from) {
            let lamp = Lamp(lamp.normalize());
            let (values, depth) = ball(lamp);
            let bright = [lamp.0.x, lamp.0.y].map(|part| MIDDLE + RADIUS * part);
            let image = ShadedImage { size: SIZE, values: &values, lamp };
            let strips = characteristic_strips(image, bright, Form::Bump, 24).unwrap();
            let mut farthest: f64 = 0.0;
            for [x, y, z] in strips.iter().flatten().map(|point| point.map(f64::from)) {
                farthest = farthest.max((x - MIDDLE).hypot(y - MIDDLE));
                let expected = depth(x, y) - depth(bright[0], bright[1]);
                // The tolerance is two percent of the radius; near its border the ball is seen edge on.
                if (x - MIDDLE).hypot(y - MIDDLE) < 0.9 * RADIUS {
                    assert!((z - expected).abs() < 0.02 * RADIUS, "{lamp:?} at {x}, {y}: {z} {expected}");
                }
            }
            assert!(farthest > 0.9 * RADIUS, "{farthest}");
        }
    }

    #[test]
    fn a_dent_is_the_mirrored_bump() {
        let lamp = Lamp(-Vector3::z());
        let (values, _) = ball(lamp);
        let image = ShadedImage { size: SIZE, values: &values, lamp };
        let [bump, dent] =
            [Form::Bump, Form::Dent].map(|form| characteristic_strips(image, [MIDDLE; 2], form, 12).unwrap());
        for (up, down) in bump.iter().flatten().zip(dent.iter().flatten()) {
            assert!((up[2] + down[2]).abs() < 1e-3, "{up:?} {down:?}");
        }
    }

    #[test]
    fn what_cannot_be_followed_is_refused() {
        let lamp = Lamp(-Vector3::z());
        let (values, _) = ball(lamp);
        let kind = |values: &[f32], centre, count| {
            characteristic_strips(ShadedImage { size: SIZE, values, lamp }, centre, Form::Bump, count)
                .map_err(|error| error.kind())
        };
        assert_eq!(kind(&values[1..], [MIDDLE; 2], 4), Err(ErrorKind::Size));
        assert_eq!(kind(&values, [-5.0, 3.0], 4), Err(ErrorKind::Range));
        assert_eq!(kind(&values, [f64::NAN; 2], 4), Err(ErrorKind::Range));
        assert_eq!(kind(&values, [MIDDLE; 2], 361), Err(ErrorKind::Range));
        // A flat surface has no bright spot.
        assert_eq!(kind(&vec![1.0; SIZE.len()], [MIDDLE; 2], 4), Err(ErrorKind::Range));
        assert_eq!(kind(&values, [MIDDLE; 2], 0), Ok(Vec::new()));
    }
}
