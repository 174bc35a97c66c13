//! Exchange of work between an estimator and its workers. Whether they succeed or fail, the outcome is the same to the
//! bit.

use crate::estimator::{Estimator, Parts, RefinementTask, Run, memory};
use crate::report::{Stage, Status};
use crate::view::Normals;

use crate::estimator::finder::task::{Finding, Task};

impl Estimator {
    /// Number of [`Worker`](crate::Worker)s that fit in memory beside this estimator.
    #[must_use]
    pub fn workers_afforded(&self) -> u32 {
        memory::workers_afforded(self.pair.image.size, self.pair.depth.size)
    }

    /// A task of the search for a [`Worker`](crate::Worker); `None` if none is ready.
    pub fn take_task(&mut self) -> Option<Task> {
        match &mut self.run {
            Run::Searching(finder) => finder.take(),
            _ => None,
        }
    }

    /// Takes in a worker's finding, and ignores it if it is no longer needed.
    pub fn accept_finding(&mut self, finding: Finding) {
        if let Run::Searching(finder) = &mut self.run {
            finder.accept(&self.pair, finding);
        }
    }

    /// The next refinement, for a worker that holds the shape numbered `held`; `None` if its input is not known yet.
    #[must_use]
    pub fn refinement_task(&self, held: Option<u32>) -> Option<RefinementTask<'_>> {
        self.stages.refinement.task(&self.accepted, &self.solution.depth, held)
    }

    /// Whether stages remain before a refinement that a worker may run.
    #[must_use]
    pub fn precedes_refinement(&self) -> bool {
        matches!(self.run, Run::Iterating(stage) if stage != Stage::Refinement)
            && self.stages.refinement.can_be_shared()
    }

    /// Where to put a worker's refinement of the shape numbered `shape`: refined depth and normals (x, y, z). `None`
    /// unless the next stage needs it.
    pub fn accept_refinement(&mut self, shape: u32) -> Option<[&mut [f32]; 4]> {
        if !matches!(self.run, Run::Iterating(Stage::Refinement)) || !self.stages.refinement.accept(shape) {
            return None;
        }
        let depth = &mut self.solution.depth;
        let Normals { x, y, z } = &mut depth.normals;
        Some([&mut depth.points.z, x, y, z])
    }

    /// Keeps the input of the next refinement if it is known, so that a worker may run it beside the other stages.
    pub(in crate::estimator) fn prepare_next_refinement(&mut self) {
        // The worker's image still contains the albedo.
        let is_known = self.report.status == Status::Running
            && !self.settling.keeps_depth()
            && self.stages.albedo.found().is_none()
            && self.stages.registration.keeps(&self.pair, &self.solution.pose);
        if is_known {
            let Parts { inputs, refinement, solution, .. } = self.parts();
            refinement.prepare_next(inputs, solution);
        } else {
            self.stages.refinement.discard_prepared();
        }
    }
}
