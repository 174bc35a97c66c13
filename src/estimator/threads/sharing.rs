//! Sharing of an estimator's work among its threads.
//!
//! The search proceeds in rounds: all threads take tasks until none are ready or the round has reached its number. In
//! the loop, one thread refines the depth view while another finds the image's surface. Results depend only on the pair
//! and the task, and count in the order of the tasks ([`Worker`]), so the outcome is the same to the bit for any number
//! of threads.

use std::sync::Mutex;

use super::pool::Threads;
use crate::estimator::{Estimator, Run, Task, Worker};
use crate::report::Status;

/// Tasks of a round for each thread: some tenths of a second, after which progress is reported.
const TASKS: usize = 32;

impl Estimator {
    /// The same estimator with this many threads to share its work: all of them in the search, two in the loop. The
    /// outcome is the same to the bit for any number. With one, the estimator works alone.
    ///
    /// Large views get fewer threads ([`workers_afforded`](Self::workers_afforded)), because each needs separate
    /// memory. If the system grants no threads, the estimator works alone. [`step`](Self::step) and
    /// [`reset`](Self::reset) keep the threads; [`step_stage`](Self::step_stage) does not use them.
    ///
    /// ```
    /// use bimodal_stereo::{Estimator, Options, Status, scenes};
    ///
    /// let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&scenes::SampleRequest::default())?;
    /// let threads = std::thread::available_parallelism().map_or(1, usize::from);
    /// let estimator = Estimator::new(sample.colour_image(), &sample.depth_map(), Options::default())?;
    /// let mut estimator = estimator.with_threads(threads);
    /// while estimator.report().status == Status::Running {
    ///     estimator.step();
    /// }
    /// # Ok::<(), bimodal_stereo::Error>(())
    /// ```
    #[must_use]
    pub fn with_threads(mut self, count: usize) -> Self {
        let afforded = self.workers_afforded() as usize;
        self.threads = Threads::new(&self.pair, count.min(afforded)).map(Box::new);
        self
    }

    /// The same estimator with as many threads as another one has.
    pub(in crate::estimator) fn with_threads_of(self, other: &Self) -> Self {
        let count = other.threads.as_ref().map_or(1, |threads| threads.count);
        self.with_threads(count)
    }

    /// Runs a step in the threads, if there are any; returns whether there are.
    pub(in crate::estimator) fn step_in_threads(&mut self) -> bool {
        let Some(mut threads) = self.threads.take() else { return false };
        if self.is_searching() {
            self.search_in(&mut threads);
        } else {
            self.iterate_in(&mut threads);
        }
        self.threads = Some(threads);
        true
    }

    /// Runs a round of the search, or a slice of work that cannot be shared.
    fn search_in(&mut self, threads: &mut Threads) {
        let most = TASKS * threads.workers.len();
        let round = Mutex::new(Round { estimator: self, left: most });
        threads.pool.scope(|scope| {
            for worker in &mut threads.workers {
                scope.spawn(|_| perform_tasks(worker, &round));
            }
        });
        let is_idle = round.into_inner().is_ok_and(|round| round.left == most);
        if is_idle {
            self.step_stage();
        } else {
            self.show_search();
        }
    }

    /// Runs an iteration.
    fn iterate_in(&mut self, threads: &mut Threads) {
        let iteration = self.report.iteration;
        while self.report.status == Status::Running && self.report.iteration == iteration {
            if matches!(self.run, Run::Searching(_)) {
                self.search_in(threads);
                continue;
            }
            if self.precedes_refinement() {
                self.refine_in(threads);
            }
            self.step_stage();
        }
    }

    /// Runs the stages before a refinement, and beside them the refinement itself if its input is known.
    fn refine_in(&mut self, threads: &mut Threads) {
        // The search around an initial pose uses all workers, and no refinement is shared before it ends.
        threads.workers.truncate(1);
        let Threads { pool, workers, held, .. } = threads;
        let (Some(worker), Some(task)) = (workers.first_mut(), self.refinement_task(held.take())) else { return };
        let (shape, numbers) = (task.shape, task.numbers);
        // Copies, because the stages overwrite the planes.
        let planes: Vec<Vec<f32>> = task.planes.into_iter().map(<[f32]>::to_vec).collect();
        let (refined, ()) = pool.join(
            || worker.refine(&numbers, |own| copy(&planes, own)),
            || {
                while self.precedes_refinement() {
                    self.step_stage();
                }
            },
        );
        if let Ok(refined) = refined
            && let Some(own) = self.accept_refinement(shape)
        {
            copy(&refined, own);
            *held = Some(shape + 1);
        }
    }
}

/// State shared by the threads of a round.
struct Round<'a> {
    estimator: &'a mut Estimator,
    /// Number of tasks that may still begin.
    left: usize,
}

/// Takes and performs tasks until none are left. A task that fails is left to the estimator itself.
fn perform_tasks(worker: &mut Worker, round: &Mutex<Round<'_>>) {
    while let Some(task) = next_task(round) {
        let Ok(finding) = worker.perform(&task) else { return };
        let Ok(mut round) = round.lock() else { return };
        round.estimator.accept_finding(finding);
    }
}

fn next_task(round: &Mutex<Round<'_>>) -> Option<Task> {
    let mut round = round.lock().ok()?;
    round.left = round.left.checked_sub(1)?;
    let task = round.estimator.take_task();
    // A task that was not begun does not count.
    round.left += usize::from(task.is_none());
    task
}

fn copy<'a>(from: impl IntoIterator<Item = &'a (impl AsRef<[f32]> + 'a)>, to: impl IntoIterator<Item = &'a mut [f32]>) {
    to.into_iter().zip(from).for_each(|(to, from)| to.copy_from_slice(from.as_ref()));
}
