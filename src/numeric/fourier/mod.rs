//! Two kinds of Fourier transforms: of long rows of any fast length, and of small squares.
//!
//! Why two: the lines of a square are already side by side, so its butterflies run along whole lines, and products of
//! spectra need no sorted order. Building the transform of a square from that of rows, four columns at a time, would be
//! several times slower.

pub(crate) mod planes;
mod roots;
pub(crate) mod rows;
