//! Rasters as colours and masks, by the conventions of js/raster.ts.

use bimodal_stereo::{ColourSamples, Transfer};

use crate::read::{Raster, Samples};

/// Colours at the image's size; floats are linear.
pub fn colours(raster: &Raster) -> ColourSamples {
    let colour = |data: &[u16], channel: usize| data[if raster.has_colour() { channel } else { 0 }];
    let rgba = |opaque: u16| {
        raster.map_pixels(|pixel| {
            let alpha = if raster.has_alpha() { pixel[pixel.len() - 1] } else { opaque };
            [colour(pixel, 0), colour(pixel, 1), colour(pixel, 2), alpha]
        })
    };
    match &raster.samples {
        Samples::U8(_) => ColourSamples::Rgba8(rgba(255).into_iter().flatten().map(|level| level as u8).collect()),
        Samples::U16(_) => ColourSamples::Rgba16(rgba(u16::MAX).into_iter().flatten().collect()),
        Samples::F32(data) => {
            let pick = |pixel: &[f32]| [0, 1, 2].map(|channel| pixel[if raster.has_colour() { channel } else { 0 }]);
            ColourSamples::RgbLinear(data.chunks_exact(raster.channels).flat_map(pick).collect())
        }
    }
}

/// The encoding of intensity that the file states.
pub fn transfer(raster: &Raster) -> Option<Transfer> {
    raster.linear.map(|linear| if linear { Transfer::Linear } else { Transfer::Srgb })
}

/// 1 for pixels that are neither zero nor transparent, 0 for all others.
pub fn mask(raster: &Raster) -> Vec<u8> {
    let half = if raster.bits == 8 { 0x80 } else { 0x8000 };
    let visible = if raster.has_colour() { 3 } else { 1 };
    let is_float = matches!(raster.samples, Samples::F32(_));
    raster.map_pixels(|pixel| {
        let is_lit = pixel[..visible].iter().any(|&level| level > 0);
        let is_opaque = is_float || !raster.has_alpha() || pixel[pixel.len() - 1] >= half;
        u8::from(is_lit && is_opaque)
    })
}

/// Whether the raster is typical of depth cameras: one channel of more than 8 bits.
pub fn looks_like_depth(raster: &Raster) -> bool {
    raster.bits > 8 && raster.channels != 4 && raster.is_grey()
}

/// Size and kind of the stored numbers, in words.
pub fn stored(raster: &Raster) -> String {
    const CHANNELS: [&str; 5] = ["", "grey", "grey with alpha", "RGB", "RGB with alpha"];
    let float = if matches!(raster.samples, Samples::F32(_)) { " float" } else { "" };
    // Decoders turn a grey JPEG into colours.
    let channels = if raster.is_lossy { "RGB" } else { CHANNELS.get(raster.channels).unwrap_or(&"") };
    format!("{}x{}, {}-bit{float} {channels}", raster.width, raster.height, raster.bits)
}

/// Size and kind with the notes on how the raster was read.
pub fn says(raster: &Raster) -> String {
    let notes = raster.encoding.into_iter().map(Into::into).chain(raster.notes.iter().cloned());
    [stored(raster)].into_iter().chain(notes).collect::<Vec<_>>().join(", ")
}
