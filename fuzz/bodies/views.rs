//! Small views of one relief, and options to run them with: valid at first, then with the mistakes of sensors, files and
//! callers.

use arbitrary::{Result, Unstructured};
use bimodal_stereo::{
    ColourImage, ColourSamples, DepthMap, DepthSamples, Lens, Light, LightGaussian, LightSource, Options, Pinhole,
    Registration, Shading, Start, StartTolerance, Transfer, Weights,
};

use super::numbers::{light, number, odd, perhaps, pose, rarely, unit};

/// The longest side and the usual ones, pixels.
const LONGEST: usize = 24;
const USUAL: [usize; 2] = [12, 12];

/// Two views and the options of their run.
pub struct Pair {
    pub image: ColourImage,
    pub depth: DepthMap,
    pub options: Options,
}

pub fn pair(u: &mut Unstructured<'_>) -> Result<Pair> {
    let light = light(u)?;
    let relief = relief(u)?;
    let image = image(u, &relief, &light)?;
    // The depth view may show another surface.
    let other = if rarely(u, 4)? { self::relief(u)? } else { relief };
    let depth = depth(u, &other, [image.width, image.height])?;
    Ok(Pair { image, depth, options: options(u, &light)? })
}

/// A surface z(x, y) in pixels: a slope, a dome and waves.
#[derive(Clone, Copy)]
pub struct Relief {
    slope: [f64; 2],
    dome: f64,
    waves: f64,
    phase: f64,
}

pub fn relief(u: &mut Unstructured<'_>) -> Result<Relief> {
    let [a, b, dome, waves, phase] = [unit(u)?, unit(u)?, unit(u)?, unit(u)?, unit(u)?];
    Ok(Relief { slope: [a, b], dome: 0.02 + 0.05 * dome, waves: 1.0 + waves, phase: 3.0 * phase })
}

impl Relief {
    /// Height at x, y from the middle, and its slopes.
    fn at(&self, x: f64, y: f64) -> [f64; 3] {
        let Self { slope: [a, b], dome, waves, phase } = *self;
        let (s, c) = (0.45 * x + 0.2 * y + phase).sin_cos();
        let (t, d) = (0.6 * y - 0.15 * x).sin_cos();
        let height = a * x + b * y + dome * (x * x + y * y) + waves * (s + 0.5 * t);
        let along_x = a + 2.0 * dome * x + waves * (0.45 * c - 0.075 * d);
        let along_y = b + 2.0 * dome * y + waves * (0.2 * c + 0.3 * d);
        [height, along_x, along_y]
    }

    /// The unit normal, facing the camera.
    fn normal(&self, x: f64, y: f64) -> [f64; 3] {
        let [_, a, b] = self.at(x, y);
        let length = (a * a + b * b + 1.0).sqrt();
        [a / length, b / length, -1.0 / length]
    }
}

/// Each pixel's x and y from the middle.
fn pixels([width, height]: [usize; 2]) -> impl Iterator<Item = [f64; 2]> {
    let middle = |side: usize| (side as f64 - 1.0) / 2.0;
    (0..width * height)
        .map(move |index| [(index % width) as f64 - middle(width), (index / width) as f64 - middle(height)])
}

fn sides(u: &mut Unstructured<'_>, plain: [usize; 2]) -> Result<[usize; 2]> {
    match u.int_in_range(0..=7)? {
        0..=4 => Ok(plain),
        5 | 6 => Ok([u.int_in_range(4..=LONGEST)?, u.int_in_range(4..=LONGEST)?]),
        _ => Ok([u.int_in_range(0..=LONGEST)?, u.int_in_range(1..=LONGEST)?]),
    }
}

pub fn image(u: &mut Unstructured<'_>, relief: &Relief, light: &Light) -> Result<ColourImage> {
    let size @ [width, height] = sides(u, USUAL)?;
    let mut colours: Vec<f64> = match u.int_in_range(0..=5)? {
        0..=3 => pixels(size).flat_map(|[x, y]| light.shade(relief.normal(x, y)).map(f64::exp)).collect(),
        4 => vec![0.5; 3 * width * height],
        _ => noise(u, 3 * width * height)?,
    };
    spoil(u, &mut colours)?;
    let samples = match u.int_in_range(0..=3)? {
        0 | 1 => ColourSamples::RgbLinear(colours.iter().map(|&value| value as f32).collect()),
        // Casts from floats to integers saturate, and NaN becomes zero.
        2 => ColourSamples::Rgba8(with_alpha(&colours, |value| (400.0 * value) as u8, u8::MAX)),
        _ => ColourSamples::Rgba16(with_alpha(&colours, |value| (60000.0 * value) as u16, u16::MAX)),
    };
    let samples = match samples {
        ColourSamples::RgbLinear(data) => ColourSamples::RgbLinear(cut(u, data)?),
        ColourSamples::Rgba8(data) => ColourSamples::Rgba8(cut(u, data)?),
        ColourSamples::Rgba16(data) => ColourSamples::Rgba16(cut(u, data)?),
    };
    Ok(ColourImage {
        width,
        height,
        samples,
        transfer: *u.choose(&[None, Some(Transfer::Linear), Some(Transfer::Srgb)])?,
        mask: mask(u, size)?,
        camera: camera(u, size)?,
    })
}

pub fn depth(u: &mut Unstructured<'_>, relief: &Relief, plain: [usize; 2]) -> Result<DepthMap> {
    let size @ [width, height] = sides(u, plain)?;
    let far = 2.0 * LONGEST as f64;
    let mut depths: Vec<f64> = match u.int_in_range(0..=5)? {
        0..=3 => pixels(size).map(|[x, y]| far + relief.at(x, y)[0]).collect(),
        4 => vec![far; width * height],
        _ => noise(u, width * height)?,
    };
    spoil(u, &mut depths)?;
    let camera = camera(u, size)?;
    let samples = match u.int_in_range(0..=3)? {
        0 | 1 => DepthSamples::Float(cut(u, depths.iter().map(|&value| value as f32).collect())?),
        2 => DepthSamples::Integer(cut(u, depths.iter().map(|&value| (20.0 * value) as u16).collect())?),
        _ => {
            let points = pixels(size).zip(&depths).flat_map(|([x, y], &z)| [x, y, z].map(|value| value as f32));
            let mut points: Vec<f32> = points.collect();
            spoil(u, &mut points)?;
            DepthSamples::Cloud(cut(u, points)?)
        }
    };
    let normals = if rarely(u, 6)? {
        let normals = pixels(size).flat_map(|[x, y]| relief.normal(x, y).map(|value| value as f32));
        let mut normals: Vec<f32> = normals.collect();
        spoil(u, &mut normals)?;
        Some(cut(u, normals)?)
    } else {
        None
    };
    Ok(DepthMap { width, height, samples, unit: perhaps(u, 1.0)?, mask: mask(u, size)?, camera, normals })
}

/// Random values between 0 and 1 that follow from one seed.
fn noise(u: &mut Unstructured<'_>, count: usize) -> Result<Vec<f64>> {
    let mut state = u64::from(u.arbitrary::<u16>()?) | 1 << 20;
    Ok((0..count)
        .map(|_| {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 40) as f64 / f64::from(1 << 24)
        })
        .collect())
}

/// Replaces a few runs of values by unusual ones or by other numbers, or multiplies them.
fn spoil<T: Copy + Into<f64> + FromNumber>(u: &mut Unstructured<'_>, values: &mut [T]) -> Result<()> {
    for _ in 0..u.int_in_range(0..=4)? {
        let Some(last) = values.len().checked_sub(1) else { return Ok(()) };
        let start = u.int_in_range(0..=last)?;
        let length = u.int_in_range(1..=values.len())?;
        let step = u.int_in_range(1..=7)?;
        let kind = u.int_in_range(0..=2)?;
        let by = if kind == 0 { odd(u)? } else { number(u, 2.0)? };
        for value in values[start..].iter_mut().take(length).step_by(step) {
            *value = T::from_number(if kind == 2 { by * (*value).into() } else { by });
        }
    }
    Ok(())
}

trait FromNumber {
    fn from_number(value: f64) -> Self;
}

impl FromNumber for f64 {
    fn from_number(value: f64) -> Self {
        value
    }
}

impl FromNumber for f32 {
    fn from_number(value: f64) -> Self {
        value as Self
    }
}

fn with_alpha<T: Copy>(colours: &[f64], level: impl Fn(f64) -> T, opaque: T) -> Vec<T> {
    colours.chunks_exact(3).flat_map(|rgb| [level(rgb[0]), level(rgb[1]), level(rgb[2]), opaque]).collect()
}

/// The right length, with few exceptions.
fn cut<T>(u: &mut Unstructured<'_>, mut values: Vec<T>) -> Result<Vec<T>> {
    if u.int_in_range(0..=31)? == 31 {
        values.truncate(u.int_in_range(0..=values.len())?);
    }
    Ok(values)
}

pub fn mask(u: &mut Unstructured<'_>, size: [usize; 2]) -> Result<Option<Vec<u8>>> {
    let radius = f64::from(u.int_in_range(1_u8..=20)?);
    Ok(match u.int_in_range(0..=7)? {
        0..=2 => None,
        3 => Some(vec![255; size[0] * size[1]]),
        4 | 5 => Some(pixels(size).map(|[x, y]| u8::from(x.hypot(y) < radius)).collect()),
        6 => Some(noise(u, size[0] * size[1])?.iter().map(|&value| u8::from(value < radius / 20.0)).collect()),
        _ => {
            let mask = vec![u.arbitrary()?; size[0] * size[1]];
            Some(cut(u, mask)?)
        }
    })
}

pub fn camera(u: &mut Unstructured<'_>, size: [usize; 2]) -> Result<Option<Pinhole>> {
    if !rarely(u, 3)? {
        return Ok(None);
    }
    let [cx, cy] = size.map(|side| (side as f64 - 1.0) / 2.0);
    let mut distortion = [0.0; 5];
    for coefficient in distortion.iter_mut().take(if rarely(u, 3)? { 5 } else { 0 }) {
        let plain = 0.1 * unit(u)?;
        *coefficient = number(u, plain)?;
    }
    let focal = 1.5 * LONGEST as f64;
    Ok(Some(Pinhole {
        fx: number(u, focal)?,
        fy: number(u, focal)?,
        cx: number(u, cx)?,
        cy: number(u, cy)?,
        lens: Lens::brown(&distortion).unwrap(),
    }))
}

pub fn options(u: &mut Unstructured<'_>, of_scene: &Light) -> Result<Options> {
    let usual = Options::default();
    let start = match u.int_in_range(0..=7)? {
        0..=2 => Start::Identity,
        3 | 4 => Start::Search,
        _ => {
            let pose = pose(u)?;
            let [scale, translation] = [u.arbitrary()?, u.arbitrary()?];
            Start::Pose {
                rotation: pose.rotation,
                scale: if scale { Some(pose.scale) } else { None },
                translation: if translation { Some(pose.translation) } else { None },
            }
        }
    };
    let light = match u.int_in_range(0..=5)? {
        0..=2 => LightSource::Known(*of_scene),
        3 | 4 => LightSource::Estimate,
        _ => LightSource::Known(light(u)?),
    };
    let Weights { prior, unit, light: weight, refinement } = usual.weights;
    Ok(Options {
        light,
        start,
        start_tolerance: StartTolerance { degrees: number(u, 30.0)?, distance: perhaps(u, 5.0)? },
        scale: perhaps(u, 1.0)?,
        registration: *u.choose(&[Registration::Joint, Registration::Icp, Registration::Fixed])?,
        shading: *u.choose(&[Shading::Surface, Shading::Pixel])?,
        weights: Weights {
            prior: number(u, prior)?,
            unit: number(u, unit)?,
            light: number(u, weight)?,
            refinement: number(u, refinement)?,
        },
        stop_degrees: number(u, usual.stop_degrees)?,
        tolerance: number(u, usual.tolerance)?,
        correspondence_distance: perhaps(u, 1.0)?,
        max_iterations: if rarely(u, 8)? { u.arbitrary()? } else { usual.max_iterations },
        seed: if u.arbitrary()? { u.arbitrary()? } else { usual.seed },
        annealing: !u.arbitrary::<bool>()?,
        trim: !u.arbitrary::<bool>()?,
        prior: if rarely(u, 16)? { Some(gaussian(u)?) } else { None },
    })
}

/// Mean and covariance of lights: usually diagonal, and sometimes with 26 coefficients instead of 27.
fn gaussian(u: &mut Unstructured<'_>) -> Result<LightGaussian> {
    let count = if rarely(u, 8)? { 26 } else { 27 };
    let mean = (0..count).map(|_| number(u, -0.1)).collect::<Result<_>>()?;
    let mut covariance = vec![0.0; count * count];
    for row in 0..count {
        covariance[row * (count + 1)] = number(u, 0.2)?;
    }
    let odd = u.int_in_range(0..=count * count - 1)?;
    covariance[odd] += number(u, 0.0)?;
    Ok(LightGaussian { mean, covariance })
}
