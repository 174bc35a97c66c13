//! A pool of threads with a worker for each, all of one pair.

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::estimator::pair::ViewPair;
use crate::estimator::workers::Worker;

/// The threads and their workers.
pub struct Threads {
    pub pool: ThreadPool,
    /// A worker for each thread. Once the search is over, only the first worker remains.
    pub workers: Vec<Worker>,
    /// Number of the refined shape that the first worker holds.
    pub held: Option<u32>,
    /// Number of threads.
    pub count: usize,
}

impl Threads {
    /// `None` if `count` is less than two, since a single thread has none to share with, or if the system grants no
    /// threads.
    pub fn new(pair: &ViewPair, count: usize) -> Option<Self> {
        if count < 2 {
            return None;
        }
        let pool = ThreadPoolBuilder::new().num_threads(count).build().ok()?;
        let workers = (0..count).map(|_| Worker::of(pair.clone())).collect();
        Some(Self { pool, workers, held: None, count })
    }
}
