//! PNG and JPEG, turned upright by EXIF and converted to sRGB by their colour profile, like js/rig/formats.

use std::io::Cursor;

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};
use moxcms::{ColorProfile, Layout, TransformOptions};

use super::raster::{MOST_SIDE, Raster, Samples, check_size};
use crate::warning::Warning;

/// Largest number of bytes for a decoder: 4096x4096 pixels of four 16-bit channels, twice.
const MOST_MEMORY: u64 = 256 << 20;
/// The gAMA value of linear numbers, and its relative tolerance.
const LINEAR: f64 = 1.0;
const SAME: f64 = 0.02;

type Result<T> = std::result::Result<T, String>;

pub fn png(bytes: &[u8]) -> Result<Raster> {
    let damaged = |error: &dyn std::fmt::Display| format!("this PNG is damaged or cut off ({error})");
    let reader = png::Decoder::new(Cursor::new(bytes)).read_info().map_err(|error| damaged(&error))?;
    let info = reader.info();
    let (has_srgb, gamma) = (info.srgb.is_some(), info.gama_chunk.map(|gamma| f64::from(gamma.into_value())));
    check_size(info.width as usize, info.height as usize)?;
    let (mut raster, profile) = decoded(bytes, ImageFormat::Png).map_err(|error| damaged(&error))?;
    // Depths have no colours, so a colour profile is ignored.
    if !raster.has_colour() {
        return Ok(raster);
    }
    match (profile, gamma) {
        _ if has_srgb => (raster.linear, raster.encoding) = (Some(false), Some("sRGB")),
        (Some(profile), _) => to_srgb(&mut raster, &profile),
        (None, Some(gamma)) if (gamma / LINEAR - 1.0).abs() < SAME => {
            (raster.linear, raster.encoding) = (Some(true), Some("linear"));
        }
        _ => {}
    }
    Ok(raster)
}

pub fn jpeg(bytes: &[u8]) -> Result<Raster> {
    // Decoders fill missing parts with grey.
    if !has_end(bytes) {
        return Err("this JPEG is cut off: its end is missing".into());
    }
    let (mut raster, profile) =
        decoded(bytes, ImageFormat::Jpeg).map_err(|error| format!("this JPEG is damaged or cut off ({error})"))?;
    raster.is_lossy = true;
    if let Some(profile) = profile {
        to_srgb(&mut raster, &profile);
    }
    Ok(raster)
}

/// Decodes pixels and the colour profile.
fn decoded(bytes: &[u8], format: ImageFormat) -> image::ImageResult<(Raster, Option<Vec<u8>>)> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), format);
    let mut limits = Limits::default();
    limits.max_image_width = Some(MOST_SIDE as u32);
    limits.max_image_height = Some(MOST_SIDE as u32);
    limits.max_alloc = Some(MOST_MEMORY);
    reader.limits(limits);
    let mut decoder = reader.into_decoder()?;
    let profile = decoder.icc_profile()?;
    let orientation = decoder.orientation()?;
    let mut picture = DynamicImage::from_decoder(decoder)?;
    picture.apply_orientation(orientation);
    Ok((raster_of(picture, orientation), profile))
}

/// The EXIF orientation in words.
const fn turned(orientation: Orientation) -> &'static str {
    match orientation {
        Orientation::NoTransforms => "not rotated",
        Orientation::FlipHorizontal => "mirrored",
        Orientation::FlipVertical => "mirrored upside down",
        Orientation::Rotate90FlipH | Orientation::Rotate270FlipH => "mirrored and rotated",
        Orientation::Rotate90 => "rotated by 90 degrees",
        Orientation::Rotate180 => "rotated by 180 degrees",
        Orientation::Rotate270 => "rotated by 270 degrees",
    }
}

fn raster_of(picture: DynamicImage, orientation: Orientation) -> Raster {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let channels = usize::from(picture.color().channel_count());
    let samples = match picture {
        DynamicImage::ImageLuma16(pixels) => Samples::U16(pixels.into_raw()),
        DynamicImage::ImageLumaA16(pixels) => Samples::U16(pixels.into_raw()),
        DynamicImage::ImageRgb16(pixels) => Samples::U16(pixels.into_raw()),
        DynamicImage::ImageRgba16(pixels) => Samples::U16(pixels.into_raw()),
        other => Samples::U8(other.into_bytes()),
    };
    let bits = if matches!(samples, Samples::U16(_)) { 16 } else { 8 };
    let (mut notes, mut warnings) = (Vec::new(), Vec::new());
    if orientation != Orientation::NoTransforms {
        let note = format!("{} as EXIF says", turned(orientation));
        let words = format!("The picture was {note}; the intrinsics must be those of the rotated picture.");
        warnings.push(Warning::new("image-turned", words));
        notes.push(note);
    }
    Raster { width, height, channels, samples, bits, is_lossy: false, linear: None, encoding: None, notes, warnings }
}

/// Whether the picture has its own end marker. Segments are skipped by their length, because a preview in one has an
/// end marker as well.
fn has_end(bytes: &[u8]) -> bool {
    let mut at = 2;
    while let Some(&[mark, kind]) = bytes.get(at..).and_then(|rest| rest.first_chunk()) {
        at += match (mark, kind) {
            (0xff, 0xd9) => return true,
            // No segment follows stuffed bytes, standalone markers and restart markers.
            (0xff, 0x00 | 0x01 | 0xd0..=0xd8) => 2,
            (0xff, 0x02..=0xfe) => match bytes.get(at + 2..at + 4) {
                Some(&[high, low]) => 2 + usize::from(u16::from_be_bytes([high, low])),
                _ => return false,
            },
            _ => 1,
        };
    }
    false
}

/// Converts the colours to sRGB, or warns that it could not.
fn to_srgb(raster: &mut Raster, profile: &[u8]) {
    match converted(raster, profile) {
        // If the profile is sRGB under another name, rounding moves colours by a step.
        Some(samples) if is_same(&samples, &raster.samples) => raster.linear = Some(false),
        Some(samples) => {
            raster.samples = samples;
            raster.linear = Some(false);
            raster.notes.push("from its colour profile to sRGB".into());
        }
        None => {
            let words = "The colour profile is not supported; colours are read as sRGB.";
            raster.warnings.push(Warning::new("colour-profile-ignored", words));
        }
    }
}

fn converted(raster: &Raster, profile: &[u8]) -> Option<Samples> {
    let layout = match raster.channels {
        3 => Layout::Rgb,
        4 => Layout::Rgba,
        _ => return None,
    };
    let from = ColorProfile::new_from_slice(profile).ok()?;
    let (to, options) = (ColorProfile::new_srgb(), TransformOptions::default());
    match &raster.samples {
        Samples::U8(data) => {
            let mut out = data.clone();
            from.create_transform_8bit(layout, &to, layout, options).ok()?.transform(data, &mut out).ok()?;
            Some(Samples::U8(out))
        }
        Samples::U16(data) => {
            let mut out = data.clone();
            from.create_transform_16bit(layout, &to, layout, options).ok()?.transform(data, &mut out).ok()?;
            Some(Samples::U16(out))
        }
        Samples::F32(_) => None,
    }
}

/// Whether nothing differs by more than one 8-bit step.
fn is_same(one: &Samples, other: &Samples) -> bool {
    match (one, other) {
        (Samples::U8(one), Samples::U8(other)) => one.iter().zip(other).all(|(a, b)| a.abs_diff(*b) <= 1),
        (Samples::U16(one), Samples::U16(other)) => one.iter().zip(other).all(|(a, b)| a.abs_diff(*b) <= 257),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::super::raster;
    use super::*;

    /// The formats' own programs wrote these files; see scripts/reference/rig-files.py.
    fn fixture(name: &str) -> Raster {
        let path = format!("{}/../tests/fixtures/rig/{name}", env!("CARGO_MANIFEST_DIR"));
        raster(path.as_ref()).unwrap()
    }

    fn levels(raster: &Raster) -> &[u8] {
        let Samples::U8(data) = &raster.samples else { panic!("8 bits") };
        data
    }

    #[test]
    fn a_wide_gamut_is_brought_to_srgb_as_lcms_does_it() {
        let (ours, theirs) = (fixture("colour-wide.png"), fixture("colour-wide-by-lcms.png"));
        assert!(ours.notes.iter().any(|note| note.contains("profile")), "{ours:?}");
        for (a, b) in levels(&ours).iter().zip(levels(&theirs)) {
            assert!(a.abs_diff(*b) <= 2, "{a} {b}");
        }
        let same = fixture("colour-srgb.png");
        assert!(same.notes.is_empty() && same.warnings.is_empty() && same.linear == Some(false), "{same:?}");
    }

    #[test]
    fn pictures_are_turned_as_exif_says() {
        let stored = fixture("turned-1.png");
        let (w, h) = (stored.width - 1, stored.height - 1);
        for turn in 2..=8 {
            let turned = fixture(&format!("turned-{turn}.png"));
            let sides = if turn < 5 { (stored.width, stored.height) } else { (stored.height, stored.width) };
            assert_eq!(((turned.width, turned.height), turned.warnings.len()), (sides, 1), "{turn}");
            for at in 0..turned.width * turned.height {
                let (x, y) = (at % turned.width, at / turned.width);
                // The stored pixel that each of the eight orientations shows at this place.
                let [column, row] = [
                    [w - x.min(w), y],
                    [w - x.min(w), h - y.min(h)],
                    [x, h - y.min(h)],
                    [y, x],
                    [y, h - x.min(h)],
                    [w - y.min(w), h - x.min(h)],
                    [w - y.min(w), x],
                ][turn - 2];
                let from = 3 * (row * stored.width + column);
                assert_eq!(levels(&turned)[3 * at..3 * at + 3], levels(&stored)[from..from + 3], "{turn} {x} {y}");
            }
        }
    }

    #[test]
    fn jpegs_are_read_progressive_and_grey_ones_too() {
        let [plain, progressive] = ["colour.jpg", "colour-progressive.jpg"].map(fixture);
        assert_eq!((plain.width, plain.channels, plain.is_lossy), (progressive.width, 3, true));
        assert_eq!(fixture("colour-grey.jpg").channels, 1);
    }

    #[test]
    fn an_end_is_the_pictures_own() {
        // A preview in a segment has an end marker as well.
        let preview = [0xff, 0xd8, 0xff, 0xe1, 0, 6, 0xff, 0xd9, 0, 0];
        assert!(!has_end(&preview));
        assert!(has_end(&[&preview[..], &[0xff, 0xda, 0, 2, 1, 0xff, 0x00, 0xff, 0xd0, 7, 0xff, 0xd9]].concat()));
    }
}
