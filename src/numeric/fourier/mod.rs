//! Fourier transforms, two of them: of long rows of any fast length, and of small squares.
//!
//! Why two: a square's lines are already side by side, so its butterflies run along whole lines, and products of spectra
//! do without sorting. Made of the rows' transform, four columns at a time, a 32x32 square took three times as long (51
//! instead of 17 microseconds with simd128 in Node 22, 240 instead of 50 without).

pub(crate) mod planes;
mod roots;
pub(crate) mod rows;
