//! Masks of the object, and their connected components.

use crate::error::{Error, ErrorKind, Result};
use crate::view::Size;

/// Smallest number of usable pixels of a view, the number in the smallest view of 4x4.
pub const FEWEST_PIXELS: usize = 16;

/// The caller's mask after its check; without a mask, every pixel.
pub fn checked(field: &'static str, size: Size, mask: Option<&[u8]>) -> Result<Vec<bool>> {
    let Some(mask) = mask else { return Ok(vec![true; size.len()]) };
    if mask.len() != size.len() {
        return Err(Error::new(
            ErrorKind::Size,
            field,
            format!("{}x{} pixels need as many mask values, not {}", size.width, size.height, mask.len()),
        ));
    }
    let mask: Vec<bool> = mask.iter().map(|&value| value != 0).collect();
    let count = mask.iter().filter(|&&inside| inside).count();
    if count < FEWEST_PIXELS {
        return Err(Error::new(ErrorKind::Empty, field, format!("must hold at least {FEWEST_PIXELS} pixels"))
            .value(count as f64));
    }
    Ok(mask)
}

/// Labels the four-connected components of `inside`; neighbours in a component must also be `joined`. Returns the label
/// of each pixel (`usize::MAX` outside) and the pixel count of each label.
pub fn components(
    size: Size,
    inside: impl Fn(usize) -> bool,
    joined: impl Fn(usize, usize) -> bool,
) -> (Vec<usize>, Vec<usize>) {
    let mut labels = vec![usize::MAX; size.len()];
    let mut counts = Vec::new();
    let mut stack = Vec::new();
    for seed in 0..size.len() {
        if labels[seed] != usize::MAX || !inside(seed) {
            continue;
        }
        let label = counts.len();
        let mut count = 0;
        labels[seed] = label;
        stack.push(seed);
        while let Some(index) = stack.pop() {
            count += 1;
            for neighbour in size.neighbours(index) {
                if labels[neighbour] == usize::MAX && inside(neighbour) && joined(index, neighbour) {
                    labels[neighbour] = label;
                    stack.push(neighbour);
                }
            }
        }
        counts.push(count);
    }
    (labels, counts)
}
