//! What an estimator gives to workers and takes from them. Whatever they do or fail to do, the outcome is the same to
//! the bit.

use crate::estimator::stages::Inputs;
use crate::estimator::{Estimator, RefinementTask, Run, memory};
use crate::report::{Stage, Status};
use crate::view::Normals;

use super::task::{Finding, Task};

impl Estimator {
    /// How many [`Worker`](crate::Worker)s may work beside this estimator within the memory of a pair.
    #[must_use]
    pub fn workers_afforded(&self) -> u32 {
        memory::workers_afforded(self.pair.image.size, self.pair.depth.size)
    }

    /// A part of the initialisation for a [`Worker`](crate::Worker); `None` while there is none to give away.
    pub fn take_task(&mut self) -> Option<Task> {
        match &mut self.run {
            Run::Searching(finder) => finder.take(),
            _ => None,
        }
    }

    /// Takes in what a worker has found. What is no longer needed is passed over.
    pub fn accept_finding(&mut self, finding: Finding) {
        if let Run::Searching(finder) = &mut self.run {
            finder.accept(&self.pair, finding);
        }
    }

    /// The next refinement, for a worker that holds the shape of number `held`; `None` where it depends on what is
    /// still to be found.
    #[must_use]
    pub fn refinement_task(&self, held: Option<u32>) -> Option<RefinementTask<'_>> {
        self.stages.refinement.task(&self.accepted, &self.solution.depth, held)
    }

    /// Whether there are stages left before a refinement that a worker may be making.
    #[must_use]
    pub fn precedes_refinement(&self) -> bool {
        matches!(self.run, Run::Iterating(stage) if stage != Stage::Refinement)
            && self.stages.refinement.can_be_shared()
    }

    /// Where to put the shape that a worker has made of the one with number `shape`: refined depth and normals (x, y,
    /// z). `None` unless the next stage asks for it.
    pub fn accept_refinement(&mut self, shape: u32) -> Option<[&mut [f32]; 4]> {
        if !matches!(self.run, Run::Iterating(Stage::Refinement)) || !self.stages.refinement.accept(shape) {
            return None;
        }
        let depth = &mut self.solution.depth;
        let Normals { x, y, z } = &mut depth.normals;
        Some([&mut depth.points.z, x, y, z])
    }

    /// What the next refinement looks at, where that is known: then a worker may make it while the other stages run.
    pub(in crate::estimator) fn prepare_next_refinement(&mut self) {
        // A worker has the image with its paint.
        let is_known = self.report.status == Status::Running
            && !self.settling.keeps_depth()
            && self.stages.paint.found().is_none()
            && self.stages.registration.keeps(&self.pair, &self.solution.pose);
        if is_known {
            let inputs = Inputs::of(
                &self.pair,
                &self.stages.paint,
                &self.stages.light,
                &self.correspondences,
                self.report.iteration,
            );
            self.stages.refinement.prepare_next(inputs, &self.solution);
        } else {
            self.stages.refinement.discard_prepared();
        }
    }
}
