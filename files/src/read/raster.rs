//! A picture or an array in memory.

use crate::warning::Warning;

/// Largest number of pixels on a side, as for all images of the library.
pub const MOST_SIDE: usize = 4096;

#[derive(Clone, Debug, PartialEq)]
pub enum Samples {
    U8(Vec<u8>),
    U16(Vec<u16>),
    F32(Vec<f32>),
}

/// Samples with interleaved channels, and what the file states about them.
#[derive(Clone, Debug)]
pub struct Raster {
    pub width: usize,
    pub height: usize,
    pub channels: usize,
    pub samples: Samples,
    /// Bits per channel.
    pub bits: u32,
    /// Whether its format is lossy (JPEG).
    pub is_lossy: bool,
    /// Whether the file states that its numbers are proportional to intensity; `None` if it states nothing.
    pub linear: Option<bool>,
    /// The PNG chunk that states the encoding: "sRGB" or "linear".
    pub encoding: Option<&'static str>,
    pub notes: Vec<String>,
    pub warnings: Vec<Warning>,
}

/// Refuses too large a size before memory is allocated.
pub(super) fn check_size(width: usize, height: usize) -> Result<(), String> {
    if width.max(height) > MOST_SIDE {
        return Err(format!("it declares {width}x{height} pixels; up to {MOST_SIDE} on a side are supported"));
    }
    Ok(())
}

impl Raster {
    /// Whether a pixel has red, green and blue.
    pub fn has_colour(&self) -> bool {
        self.channels >= 3
    }

    /// Whether the last channel is opacity.
    pub fn has_alpha(&self) -> bool {
        self.channels == 2 || self.channels == 4
    }

    /// Whether red, green and blue are equal in all pixels.
    pub fn is_grey(&self) -> bool {
        fn grey<T: PartialEq>(data: &[T], channels: usize) -> bool {
            data.chunks_exact(channels).all(|pixel| pixel[0] == pixel[1] && pixel[0] == pixel[2])
        }
        !self.has_colour()
            || match &self.samples {
                Samples::U8(data) => grey(data, self.channels),
                Samples::U16(data) => grey(data, self.channels),
                Samples::F32(data) => grey(data, self.channels),
            }
    }

    /// Maps each pixel of integers through `pick`.
    pub fn map_pixels<T>(&self, pick: impl Fn(&[u16]) -> T) -> Vec<T> {
        let wide = |data: &mut dyn Iterator<Item = u16>| {
            let all: Vec<u16> = data.collect();
            all.chunks_exact(self.channels).map(&pick).collect()
        };
        match &self.samples {
            Samples::U8(data) => wide(&mut data.iter().map(|&level| level.into())),
            Samples::U16(data) => wide(&mut data.iter().copied()),
            Samples::F32(data) => wide(&mut data.iter().map(|&value| u16::from(value > 0.0))),
        }
    }
}
