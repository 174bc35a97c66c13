//! NumPy's .npy, in the few types that images and depth maps have. The same types are read by js/npy.ts.
//!
//! npyz (0.9.1) is not used, because it multiplies the sides of a shape before they can be checked, and so overflows on
//! a hostile header.

use super::raster::{Raster, Samples, check_size};

/// Smallest length of a file: the magic, two bytes of version, and two or four of header length.
const SHORTEST: usize = 10;
/// Largest number of channels: red, green, blue and alpha.
const MOST_CHANNELS: usize = 4;
const CUT_OFF: &str = "this .npy file is cut off in its header";

type Result<T> = std::result::Result<T, String>;

/// Content of the header.
struct Header<'a> {
    kind: &'a str,
    in_columns: bool,
    shape: Vec<usize>,
}

/// Reads rows x columns, or rows x columns x channels, in either order; 64-bit floats and 32-bit integers become 32-bit
/// floats.
pub fn read(bytes: &[u8]) -> Result<Raster> {
    let (text, body) = parts(bytes).ok_or(CUT_OFF)?;
    let Header { kind, in_columns, shape } = header(text)?;
    let (height, width, channels) = (shape[0], shape[1], shape.get(2).copied().unwrap_or(1));
    if channels > MOST_CHANNELS {
        return Err(format!("this .npy file has {channels} channels; 1 to {MOST_CHANNELS} are supported"));
    }
    check_size(width, height)?;
    let count = height * width * channels;
    let decoded = |size: usize| -> Result<&[u8]> {
        let needed = count * size;
        body.get(..needed).ok_or_else(|| format!("this .npy file is cut off: {} of {needed} bytes", body.len()))
    };
    let samples = match kind {
        "<f4" => Samples::F32(each(decoded(4)?, f32::from_le_bytes)),
        "<f8" => Samples::F32(each(decoded(8)?, |bytes| f64::from_le_bytes(bytes) as f32)),
        "<i4" => Samples::F32(each(decoded(4)?, |bytes| i32::from_le_bytes(bytes) as f32)),
        "<u2" => Samples::U16(each(decoded(2)?, u16::from_le_bytes)),
        "|u1" | "|b1" => Samples::U8(decoded(1)?.to_vec()),
        _ => {
            return Err(format!(
                "a .npy file of type {kind:?} is not supported; save it as float32, float64, uint16, uint8 or int32"
            ));
        }
    };
    let rows = |samples| if in_columns { in_rows(samples, [height, width, channels]) } else { samples };
    let bits = match &samples {
        Samples::U8(_) => 8,
        Samples::U16(_) => 16,
        Samples::F32(_) => 32,
    };
    Ok(Raster {
        width,
        height,
        channels,
        samples: rows(samples),
        bits,
        is_lossy: false,
        linear: None,
        encoding: None,
        notes: Vec::new(),
        warnings: Vec::new(),
    })
}

/// Header and data.
fn parts(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let is_short = *bytes.get(6)? == 1;
    let from = if is_short { SHORTEST } else { SHORTEST + 2 };
    let length = match *bytes.get(8..from)? {
        [a, b] => usize::from(u16::from_le_bytes([a, b])),
        [a, b, c, d] => u32::from_le_bytes([a, b, c, d]) as usize,
        _ => return None,
    };
    Some((bytes.get(from..from.checked_add(length)?)?, &bytes[from + length..]))
}

fn header(text: &[u8]) -> Result<Header<'_>> {
    let text = std::str::from_utf8(text).map_err(|_| "this .npy file is damaged in its header")?;
    let member = |name: &str| text.split_once(name).map(|(_, after)| after.trim_start());
    let kind = member("'descr':").and_then(|after| after.strip_prefix('\'')).and_then(|after| after.split_once('\''));
    let order = member("'fortran_order':").ok_or("this .npy file has no fortran_order")?;
    let listed = member("'shape':").and_then(|after| after.strip_prefix('(')).and_then(|after| after.split_once(')'));
    let listed = listed.map_or("", |(inside, _)| inside).trim();
    let axes: Vec<&str> = listed.split(',').map(str::trim).filter(|part| !part.is_empty()).collect();
    if axes.len() < 2 || axes.len() > 3 {
        let count = axes.len();
        return Err(format!(
            "this .npy file has {count} axes; rows and columns, or rows, columns and channels are needed"
        ));
    }
    // Only digits: parse() would also accept "+2".
    let whole = |axis: &&str| axis.bytes().all(|letter| letter.is_ascii_digit()).then(|| axis.parse::<usize>().ok())?;
    let shape: Option<Vec<usize>> = axes.iter().map(whole).map(|side| side.filter(|&side| side > 0)).collect();
    let shape =
        shape.ok_or_else(|| format!("this .npy file has the shape ({listed}); whole numbers above zero are needed"))?;
    Ok(Header { kind: kind.map_or("unknown", |(kind, _)| kind), in_columns: order.starts_with("True"), shape })
}

fn each<T, const SIZE: usize>(bytes: &[u8], decode: impl Fn([u8; SIZE]) -> T) -> Vec<T> {
    bytes.as_chunks().0.iter().map(|&chunk| decode(chunk)).collect()
}

/// Converts data from column order (the first index runs fastest) to row order.
fn in_rows(samples: Samples, [height, width, channels]: [usize; 3]) -> Samples {
    let places: Vec<usize> = (0..height * width * channels)
        .map(|at| {
            let (pixel, channel) = (at / channels, at % channels);
            pixel / width + height * (pixel % width + width * channel)
        })
        .collect();
    match samples {
        Samples::U8(data) => Samples::U8(places.iter().map(|&at| data[at]).collect()),
        Samples::U16(data) => Samples::U16(places.iter().map(|&at| data[at]).collect()),
        Samples::F32(data) => Samples::F32(places.iter().map(|&at| data[at]).collect()),
    }
}

/// A file of rows x columns, version 1: a header padded to blocks of 64 bytes, then the numbers, row by row.
pub fn bytes(width: usize, data: &[f32]) -> Vec<u8> {
    const BLOCK: usize = 64;
    let height = data.len() / width;
    let said = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': ({height}, {width}), }}");
    let length = (SHORTEST + said.len() + 1).next_multiple_of(BLOCK) - SHORTEST;
    let mut file = b"\x93NUMPY\x01\x00".to_vec();
    file.extend((length as u16).to_le_bytes());
    file.extend(format!("{said:<fill$}\n", fill = length - 1).bytes());
    file.extend(data.iter().flat_map(|value| value.to_le_bytes()));
    file
}
