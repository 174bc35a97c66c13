//! Somebody who looks where an estimator elsewhere tells it to: another thread's part in the opening.

use super::anywhere::{given, search};
use super::joint::{Attempt, Joint};
use super::task::{Finding, Found, Registered, Task, Work};
use crate::error::Result;
use crate::light::LightPrior;
use crate::options::Options;
use crate::pose::Search;
use crate::view::{ColourImage, ColourView, DepthMap, DepthView};

/// Does tasks of the opening of an [`Estimator`](super::Estimator) of the same pair and options. What it finds does not
/// depend on what it did before.
pub struct Scout {
    image: ColourView,
    depth: DepthView,
    options: Options,
    prior: LightPrior,
    joint: Joint,
    search: Search,
}

impl Scout {
    /// A scout for one pair.
    ///
    /// # Errors
    /// Those of [`Estimator::new`](super::Estimator::new) and of its search.
    pub fn new(image: ColourImage, depth: &DepthMap, options: Options) -> Result<Self> {
        let (image, depth) = super::views(image, depth, &options)?;
        let prior = LightPrior::natural();
        let given = given(&image, &depth, &prior, &options);
        let joint = Joint::new(&given);
        let search = search(&given, &options, &joint)?;
        Ok(Self { image, depth, options, prior, joint, search })
    }

    /// Does one task, however long it takes.
    pub fn perform(&mut self, task: &Task) -> Finding {
        Finding(match &task.0 {
            Work::Search(task) => Found::Search(self.search.perform(task)),
            Work::Register(index, start) => {
                let given = given(&self.image, &self.depth, &self.prior, &self.options);
                let mut attempt = self.joint.attempt(&given, start, true);
                let report = loop {
                    match attempt {
                        Attempt::Ongoing => attempt = self.joint.attempt(&given, start, false),
                        Attempt::Ended(report) => break report,
                    }
                };
                Found::Registered(*index, report.map(Registered::of))
            }
        })
    }
}
