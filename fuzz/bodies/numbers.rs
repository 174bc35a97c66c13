//! Numbers, poses and lights, plain and unusual.

use arbitrary::{Result, Unstructured};
use bimodal_stereo::nalgebra::{Matrix3, Vector3};
use bimodal_stereo::{Angles, Light, Similarity, scenes};

/// Critical values: NaN, infinities, both zeros, denormals, numbers whose squares overflow or underflow, and whole numbers
/// that an index or a rounded f32 cannot hold.
const ODD: [f64; 24] = [
    f64::NAN,
    f64::INFINITY,
    f64::NEG_INFINITY,
    0.0,
    -0.0,
    5e-324,
    f64::MIN_POSITIVE,
    f64::EPSILON,
    f64::MAX,
    f64::MIN,
    1e-200,
    1e200,
    1e-45,
    1e-38,
    1e-20,
    1e20,
    3.4e38,
    1e12,
    -1.0,
    -1e-9,
    2_147_483_648.0,
    4_294_967_296.0,
    9_007_199_254_740_992.0,
    1.844_674_407_370_955_2e19,
];

/// `plain` or a number near it, a number from -100 to 100, one of [`ODD`], or any bits. Zero bytes give `plain`.
pub fn number(u: &mut Unstructured<'_>, plain: f64) -> Result<f64> {
    Ok(match u.int_in_range(0..=7)? {
        0..=3 => plain,
        4 => plain * (1.0 + f64::from(u.arbitrary::<i8>()?) / 256.0),
        5 => f64::from(u.arbitrary::<i16>()?) / 328.0,
        6 => *u.choose(&ODD)?,
        _ => f64::from_bits(u.arbitrary()?),
    })
}

/// One of [`ODD`], or any bits.
pub fn odd(u: &mut Unstructured<'_>) -> Result<f64> {
    if u.arbitrary()? { Ok(f64::from_bits(u.arbitrary()?)) } else { Ok(*u.choose(&ODD)?) }
}

/// True once in `times`, and never if the bytes are exhausted.
pub fn rarely(u: &mut Unstructured<'_>, times: u8) -> Result<bool> {
    Ok(u.int_in_range(1..=times)? == times)
}

/// `None`, or a number.
pub fn perhaps(u: &mut Unstructured<'_>, plain: f64) -> Result<Option<f64>> {
    if u.arbitrary()? { number(u, plain).map(Some) } else { Ok(None) }
}

/// A number between about -1 and 1.
pub fn unit(u: &mut Unstructured<'_>) -> Result<f64> {
    Ok(f64::from(u.arbitrary::<i8>()?) / 127.0)
}

pub fn vector(u: &mut Unstructured<'_>, plain: f64) -> Result<Vector3<f64>> {
    Ok(Vector3::new(number(u, plain)?, number(u, plain)?, number(u, plain)?))
}

/// Mostly a rotation.
pub fn rotation(u: &mut Unstructured<'_>) -> Result<Matrix3<f64>> {
    let mut rotation = Matrix3::identity();
    match u.int_in_range(0..=7)? {
        0..=2 => {}
        3..=6 => {
            let degrees = |u: &mut Unstructured<'_>| Ok(180.0 * unit(u)?);
            rotation = Angles { alpha: degrees(u)?, beta: degrees(u)?, gamma: degrees(u)? }.rotation();
        }
        _ => {
            for entry in rotation.iter_mut() {
                *entry = number(u, *entry)?;
            }
        }
    }
    Ok(rotation)
}

pub fn pose(u: &mut Unstructured<'_>) -> Result<Similarity> {
    Ok(Similarity { scale: number(u, 1.0)?, rotation: rotation(u)?, translation: vector(u, 0.0)? })
}

/// A built-in light with a few coefficients changed.
pub fn light(u: &mut Unstructured<'_>) -> Result<Light> {
    let mut light =
        scenes::light(u.choose(&["colourful", "window", "overcast"])?).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..u.int_in_range(0..=3)? {
        let (channel, k) = (u.int_in_range(0..=2)?, u.int_in_range(0..=8)?);
        light.0[channel][k] = number(u, 3.0 * light.0[channel][k])?;
    }
    Ok(light)
}

/// Points in a box, a few of them unusual.
pub fn points(u: &mut Unstructured<'_>, count: usize) -> Result<Vec<Vector3<f64>>> {
    let mut points = Vec::with_capacity(count);
    for _ in 0..count {
        points.push(Vector3::new(unit(u)?, unit(u)?, unit(u)?) * 20.0);
    }
    for _ in 0..u.int_in_range(0..=2)? {
        if let Some(index) = count.checked_sub(1) {
            points[u.int_in_range(0..=index)?] = vector(u, 1.0)?;
        }
    }
    Ok(points)
}
