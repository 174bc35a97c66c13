//! Workers: another thread's part in the initialisation and in the loop. They hand over numbers, and planes: rasters of
//! one number for each pixel.

mod exchange;
mod refinement;
pub mod task;
mod worker;

pub use worker::Worker;
