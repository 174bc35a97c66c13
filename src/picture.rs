//! Results as screen pixels: normals as colours, numbers through a colour map. A pixel has four bytes: red, green, blue
//! and opacity. Pixels without a value are transparent.

use crate::error::{Error, ErrorKind, Result};
use crate::numeric::quantile;
use crate::view::Normals;

/// The layers of [`Estimator::draw`](crate::Estimator::draw).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layer {
    /// Normals of the image surface.
    Normals,
    /// Depth of the image surface.
    Depth,
    /// Residuals of the shading model in the image's log colours.
    Residual,
    /// Refined depth of the depth view.
    Refined,
    /// Refined normals of the depth view.
    RefinedNormals,
}

impl Layer {
    /// All layers in the order of the data flow.
    pub const ALL: [Self; 5] = [Self::Normals, Self::Depth, Self::Residual, Self::Refined, Self::RefinedNormals];

    /// The name in JavaScript.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Normals => "normals",
            Self::Depth => "depth",
            Self::Residual => "residual",
            Self::Refined => "refined",
            Self::RefinedNormals => "refinedNormals",
        }
    }
}

/// Perceptually uniform colour maps, readable without red-green vision (van der Walt, Smith and Firing 2015).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColourMap {
    /// Colours from dark blue to yellow.
    #[default]
    Viridis,
    /// Colours from black to light yellow, for values that should be zero.
    Magma,
}

impl ColourMap {
    /// All maps.
    pub const ALL: [Self; 2] = [Self::Viridis, Self::Magma];

    /// The name in JavaScript.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Viridis => "viridis",
            Self::Magma => "magma",
        }
    }

    fn table(self) -> [[u8; 4]; STEPS] {
        let gradient = match self {
            Self::Viridis => colorous::VIRIDIS,
            Self::Magma => colorous::MAGMA,
        };
        std::array::from_fn(|step| {
            let colorous::Color { r, g, b } = gradient.eval_continuous(step as f64 / LAST);
            [r, g, b, OPAQUE]
        })
    }
}

/// Number of colours of a map, one for each value of a channel.
const STEPS: usize = 256;
const LAST: f64 = (STEPS - 1) as f64;
const OPAQUE: u8 = 255;
const CLEAR: [u8; 4] = [0; 4];
/// Largest number of values from which an automatic range is derived.
const MOST_SAMPLES: usize = 4096;
/// Share of the values below and above an automatic range, so that single outliers do not flatten everything else.
const OUTLIERS: f64 = 0.01;

/// Red is to the right, green up, and blue towards the camera. The frame's y points down and its z away.
pub(crate) fn draw_normals(normals: &Normals, rgba: &mut Vec<u8>) {
    let Normals { x, y, z } = normals;
    let byte = |value: f32| (0.5 * LAST as f32 * (1.0 + value)).round() as u8;
    let pixels = x
        .iter()
        .zip(y)
        .zip(z)
        .flat_map(|((&x, &y), &z)| if x.is_nan() { CLEAR } else { [byte(x), byte(-y), byte(-z), OPAQUE] });
    rgba.clear();
    rgba.extend(pixels);
}

/// Values outside `range` take its end colours. The default range covers all values except a hundredth at either end.
///
/// # Errors
/// A range that is empty or not finite.
pub(crate) fn draw_numbers(values: &[f32], range: Option<[f64; 2]>, map: ColourMap, rgba: &mut Vec<u8>) -> Result<()> {
    let [from, to] = match range {
        Some(range) => checked(range)?,
        None => automatic(values),
    };
    let table = map.table();
    let (from, factor) = (from as f32, (LAST / (to - from)) as f32);
    let pixels = values.iter().flat_map(|&value| {
        // The cast to u8 saturates at both ends.
        if value.is_nan() { CLEAR } else { table[((value - from) * factor).round() as u8 as usize] }
    });
    rgba.clear();
    rgba.extend(pixels);
    Ok(())
}

fn checked(range: [f64; 2]) -> Result<[f64; 2]> {
    for value in range {
        if !value.is_finite() {
            return Err(Error::new(ErrorKind::Range, "options.range", "must be finite").value(value));
        }
    }
    if range[0] >= range[1] {
        return Err(Error::new(ErrorKind::Range, "options.range", "must be in ascending order").value(range[1]));
    }
    Ok(range)
}

/// The range is never empty.
fn automatic(values: &[f32]) -> [f64; 2] {
    let every = values.len().div_ceil(MOST_SAMPLES).max(1);
    let mut some: Vec<f32> = values.iter().step_by(every).copied().filter(|value| value.is_finite()).collect();
    if some.is_empty() {
        return [0.0, 1.0];
    }
    let [from, to] = [OUTLIERS, 1.0 - OUTLIERS].map(|share| f64::from(quantile(&mut some, share)));
    if to > from { [from, to] } else { [from - 0.5, from + 0.5] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_go_through_matplotlib_s_colours() {
        // Bytes of matplotlib 3.10: cm.viridis and cm.magma at 0, 128 and 255.
        let ends = [
            (ColourMap::Viridis, [[68, 1, 84], [33, 145, 140], [253, 231, 37]]),
            (ColourMap::Magma, [[0, 0, 4], [183, 55, 121], [252, 253, 191]]),
        ];
        for (map, colours) in ends {
            let mut rgba = vec![];
            draw_numbers(&[-7.0, 128.0, 300.0, f32::NAN], Some([0.0, 255.0]), map, &mut rgba).unwrap();
            for (pixel, [r, g, b]) in rgba.chunks(4).zip(colours) {
                for (found, wanted) in pixel.iter().zip([r, g, b, 255u8]) {
                    assert!(found.abs_diff(wanted) <= 2, "{map:?}: {pixel:?} for {:?}", [r, g, b]);
                }
            }
            assert_eq!(rgba[12..], CLEAR);
        }
    }

    #[test]
    fn an_outlier_leaves_the_range_alone_and_nothing_has_one() {
        let mut values: Vec<f32> = (0..1000).map(|k| k as f32).collect();
        values[0] = 1e9;
        let [from, to] = automatic(&values);
        assert!((5.0..20.0).contains(&from) && (980.0..1000.0).contains(&to), "{from} to {to}");
        assert_eq!(automatic(&[f32::NAN; 4]), [0.0, 1.0]);
        assert_eq!(automatic(&[3.0; 4]), [2.5, 3.5]);
    }

    #[test]
    fn a_normal_towards_the_camera_is_blue() {
        let normals = Normals { x: vec![0.0, 1.0, f32::NAN], y: vec![0.0; 3], z: vec![-1.0, 0.0, 0.0] };
        let mut rgba = vec![];
        draw_normals(&normals, &mut rgba);
        assert_eq!(rgba, [128, 128, 255, 255, 255, 128, 128, 255, 0, 0, 0, 0]);
    }

    #[test]
    fn a_range_has_a_width() {
        for range in [[1.0, 1.0], [2.0, 1.0], [f64::NAN, 1.0], [0.0, f64::INFINITY]] {
            let error = draw_numbers(&[1.0], Some(range), ColourMap::Viridis, &mut vec![]).unwrap_err();
            assert!(error.to_string().contains("options.range"), "{error}");
        }
    }
}
