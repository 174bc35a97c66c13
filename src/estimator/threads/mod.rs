//! Threads of this process that share an estimator's work, as the page's workers do.

mod pool;
mod sharing;

pub use pool::Threads;
