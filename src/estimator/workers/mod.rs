//! Workers: another thread's part in the search and in the loop. They exchange numbers and planes, which are rasters of
//! one number for each pixel.

mod exchange;
mod refinement;
mod worker;

pub use worker::Worker;
