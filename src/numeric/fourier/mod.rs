//! Fourier transforms, two of them: of long rows of any fast length, and of small squares.
//!
//! Why two: a square's lines are already side by side, so its butterflies run along whole lines, and products of
//! spectra need no sorted order. Made of the rows' transform, four columns at a time, a 32x32 square took three times
//! as long with simd128 and five times without (Node 20).

pub(crate) mod planes;
mod roots;
pub(crate) mod rows;
