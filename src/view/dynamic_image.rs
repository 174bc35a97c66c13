//! Conversion of pictures of the crate [`image`] to unchecked views. The caller adds cameras, masks, units and normals.
//!
//! ```
//! use bimodal_stereo::image::{DynamicImage, ImageBuffer, Luma};
//! use bimodal_stereo::{ColourImage, DepthMap, Lens, Pinhole};
//!
//! // In place of image::open("colour.png")? and image::open("depth.png")?.
//! let colours = DynamicImage::new_rgb8(64, 48);
//! let depths = DynamicImage::from(ImageBuffer::<Luma<u16>, _>::from_pixel(64, 48, Luma([812])));
//!
//! let camera = Some(Pinhole { fx: 60.0, fy: 60.0, cx: 31.5, cy: 23.5, lens: Lens::None });
//! let image = ColourImage { camera, ..ColourImage::try_from(&colours)? };
//! let depth = DepthMap { camera, unit: Some(0.001), ..DepthMap::try_from(&depths)? };
//! assert_eq!((image.width, depth.height), (64, 48));
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```

use image::DynamicImage;
use image::metadata::CicpTransferCharacteristics;

use crate::error::{Error, ErrorKind, Result};
use crate::view::{ColourImage, ColourSamples, DepthMap, DepthSamples, Transfer};

impl TryFrom<&DynamicImage> for ColourImage {
    type Error = Error;

    /// The picture's colours; grey pictures get three equal channels. Fully transparent pixels do not belong to the
    /// object.
    ///
    /// Floats are linear. Integers are linear if the picture's colour space is linear. Otherwise 8 bits are sRGB and 16
    /// bits are guessed ([`ColourImage::transfer`]), because the crate `image` labels every picture without a colour
    /// space as sRGB.
    ///
    /// # Errors
    /// [`ErrorKind::Unsupported`] for a pixel format that this release does not know.
    fn try_from(picture: &DynamicImage) -> Result<Self> {
        let samples = match levels("image.data", picture)? {
            Levels::Bytes(rgba) => ColourSamples::Rgba8(rgba),
            Levels::Words(rgba) => ColourSamples::Rgba16(rgba),
            Levels::Floats(rgba) => {
                // Floats have no fourth channel, so zero marks an unused pixel.
                let colours = rgba.as_chunks().0.iter().map(|&[r, g, b, a]| if a > 0.0 { [r, g, b] } else { [0.0; 3] });
                ColourSamples::RgbLinear(colours.flatten().collect())
            }
        };
        let is_linear = picture.color_space().transfer == CicpTransferCharacteristics::Linear;
        Ok(Self {
            width: picture.width() as usize,
            height: picture.height() as usize,
            samples,
            transfer: is_linear.then_some(Transfer::Linear),
            mask: None,
            camera: None,
        })
    }
}

impl TryFrom<&DynamicImage> for DepthMap {
    type Error = Error;

    /// The picture's stored numbers, whatever its colour space is. Zeros, fully transparent pixels and floats that are
    /// not finite are holes. The unit is [`DepthMap::unit`]'s default until it is set.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] with the first pixel whose channels differ, because such a picture is not a depth map.
    /// [`ErrorKind::Unsupported`] for a pixel format that this release does not know.
    fn try_from(picture: &DynamicImage) -> Result<Self> {
        let samples = match levels("depth.data", picture)? {
            Levels::Bytes(rgba) => DepthSamples::Integer(grey(&rgba, |a, b| a == b)?.map(u16::from).collect()),
            Levels::Words(rgba) => DepthSamples::Integer(grey(&rgba, |a, b| a == b)?.collect()),
            // The channels are compared as bits, because a hole may be NaN, which equals nothing.
            Levels::Floats(rgba) => {
                DepthSamples::Float(grey(&rgba, |a: f32, b: f32| a.to_bits() == b.to_bits())?.collect())
            }
        };
        Ok(Self {
            width: picture.width() as usize,
            height: picture.height() as usize,
            samples,
            unit: None,
            mask: None,
            camera: None,
            normals: None,
        })
    }
}

/// R, G, B, A of each pixel, with the picture's number of bits.
enum Levels {
    Bytes(Vec<u8>),
    Words(Vec<u16>),
    Floats(Vec<f32>),
}

fn levels(field: &'static str, picture: &DynamicImage) -> Result<Levels> {
    use DynamicImage as Picture;
    Ok(match picture {
        Picture::ImageLuma8(_) | Picture::ImageLumaA8(_) | Picture::ImageRgb8(_) | Picture::ImageRgba8(_) => {
            Levels::Bytes(picture.to_rgba8().into_raw())
        }
        Picture::ImageLuma16(_) | Picture::ImageLumaA16(_) | Picture::ImageRgb16(_) | Picture::ImageRgba16(_) => {
            Levels::Words(picture.to_rgba16().into_raw())
        }
        Picture::ImageRgb32F(_) | Picture::ImageRgba32F(_) => Levels::Floats(picture.to_rgba32f().into_raw()),
        _ => {
            let message = format!("has pixels of an unknown kind, {:?}", picture.color());
            return Err(Error::new(ErrorKind::Unsupported, field, message));
        }
    })
}

/// The single value of each pixel, zero if it is transparent.
fn grey<T: Copy + Default + PartialEq>(rgba: &[T], is_same: impl Fn(T, T) -> bool) -> Result<impl Iterator<Item = T>> {
    let pixels = rgba.as_chunks().0;
    if let Some(index) = pixels.iter().position(|&[r, g, b, _]| !is_same(r, g) || !is_same(g, b)) {
        let message = "must have one number per pixel, but this picture is coloured";
        return Err(Error::new(ErrorKind::Range, "depth.data", message).at(index));
    }
    Ok(pixels.iter().map(|&[depth, _, _, alpha]| if alpha == T::default() { T::default() } else { depth }))
}

#[cfg(test)]
mod tests {
    use image::{ImageBuffer, Luma, LumaA, Rgb, Rgba};

    use super::*;

    /// The test covers every 8-bit level, and as many 16-bit levels.
    fn grey_bytes() -> DynamicImage {
        ImageBuffer::from_fn(16, 16, |x, y| Luma([(16 * y + x) as u8])).into()
    }

    fn grey_words() -> DynamicImage {
        ImageBuffer::from_fn(16, 16, |x, y| Luma([(4097 * y + 251 * x) as u16])).into()
    }

    fn colours(picture: impl Into<DynamicImage>) -> (ColourSamples, Option<Transfer>) {
        let ColourImage { samples, transfer, .. } = ColourImage::try_from(&picture.into()).unwrap();
        (samples, transfer)
    }

    fn depths(picture: impl Into<DynamicImage>) -> Result<DepthSamples> {
        DepthMap::try_from(&picture.into()).map(|map| map.samples)
    }

    #[test]
    fn digits_are_kept_whatever_the_channels() {
        let levels: Vec<u8> = (0..=255).collect();
        let opaque: Vec<u8> = levels.iter().flat_map(|&level| [level, level, level, 255]).collect();
        assert_eq!(colours(grey_bytes()), (ColourSamples::Rgba8(opaque.clone()), None));
        assert_eq!(colours(grey_bytes().to_rgb8()), (ColourSamples::Rgba8(opaque), None));
        let words: Vec<u16> = (0..256).map(|index| 4097 * (index / 16) + 251 * (index % 16)).collect();
        let opaque: Vec<u16> = words.iter().flat_map(|&level| [level, level, level, u16::MAX]).collect();
        assert_eq!(colours(grey_words()), (ColourSamples::Rgba16(opaque), None));
        for picture in [grey_words(), grey_words().to_luma_alpha16().into(), grey_words().to_rgb16().into()] {
            assert_eq!(depths(picture).unwrap(), DepthSamples::Integer(words.clone()));
        }
        let bytes = DepthSamples::Integer(levels.into_iter().map(u16::from).collect());
        assert_eq!(depths(grey_bytes()).unwrap(), bytes);
        assert_eq!(depths(grey_bytes().to_rgba8()).unwrap(), bytes);
    }

    #[test]
    fn floats_are_linear_and_depths_keep_their_holes() {
        let picture = ImageBuffer::from_fn(2, 1, |x, _| Rgb([0.25, 3.5, x as f32]));
        assert_eq!(colours(picture), (ColourSamples::RgbLinear(vec![0.25, 3.5, 0.0, 0.25, 3.5, 1.0]), None));
        let picture = ImageBuffer::from_fn(3, 1, |x, _| Rgb([[1.75, f32::NAN, f32::INFINITY][x as usize]; 3]));
        let DepthSamples::Float(found) = depths(picture).unwrap() else { panic!("floats") };
        assert!(found[0] == 1.75 && found[1].is_nan() && found[2].is_infinite(), "{found:?}");
    }

    #[test]
    fn what_is_transparent_is_not_there() {
        let picture = ImageBuffer::from_fn(2, 1, |x, _| Rgba([0.5, 0.5, 0.5, x as f32]));
        assert_eq!(colours(picture.clone()).0, ColourSamples::RgbLinear(vec![0.0, 0.0, 0.0, 0.5, 0.5, 0.5]));
        assert_eq!(depths(picture).unwrap(), DepthSamples::Float(vec![0.0, 0.5]));
        let picture = ImageBuffer::from_fn(2, 1, |x, _| LumaA([700, x as u16]));
        assert_eq!(depths(picture).unwrap(), DepthSamples::Integer(vec![0, 700]));
    }

    #[test]
    fn a_coloured_picture_is_no_depth_map() {
        let picture = ImageBuffer::from_fn(4, 2, |x, y| Rgb([7_u8, 7, if (x, y) == (1, 1) { 8 } else { 7 }]));
        let error = depths(picture).unwrap_err();
        assert_eq!((error.kind(), error.field(), error.index()), (ErrorKind::Range, "depth.data", Some(5)));
    }

    #[test]
    fn a_linear_colour_space_is_heeded() {
        let mut picture = grey_words();
        picture.set_color_space(image::metadata::Cicp::SRGB_LINEAR).unwrap();
        let words: Vec<u16> = (0..256).map(|index| 4097 * (index / 16) + 251 * (index % 16)).collect();
        assert_eq!(colours(picture.clone()).1, Some(Transfer::Linear));
        assert_eq!(depths(picture).unwrap(), DepthSamples::Integer(words));
    }
}
