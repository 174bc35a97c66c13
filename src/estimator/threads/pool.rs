//! A pool of threads with a worker for each, all of one pair.

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::estimator::pair::ViewPair;
use crate::estimator::workers::Worker;

/// Threads, and what they work with.
pub struct Threads {
    pub pool: ThreadPool,
    /// One for each thread; the first alone once the search is over.
    pub workers: Vec<Worker>,
    /// The number of the refined shape that the first worker holds.
    pub held: Option<u32>,
    /// How many threads there are.
    pub count: usize,
}

impl Threads {
    /// `None` where `count` is less than two, for one thread has nobody to share with, and where the system grants none.
    pub fn new(pair: &ViewPair, count: usize) -> Option<Self> {
        if count < 2 {
            return None;
        }
        let pool = ThreadPoolBuilder::new().num_threads(count).build().ok()?;
        let workers = (0..count).map(|_| Worker::of(pair.clone())).collect();
        Some(Self { pool, workers, held: None, count })
    }
}
