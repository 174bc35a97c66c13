//! Threads of this process that share an estimator's work.

mod pool;
mod sharing;

pub use pool::Threads;
