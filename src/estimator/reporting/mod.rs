//! What a run reports: the report of each step and the results as pixels, in the caller's units.

pub mod measurement;
pub mod outputs;
pub mod reported;
pub mod units;
