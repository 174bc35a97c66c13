//! Somebody who works for an estimator elsewhere: another thread's part in the opening and in the loop.

use super::anywhere::{given, search};
use super::joint::{Attempt, Joint};
use super::partner::Partner;
use super::task::{Finding, Found, Registered, Task, Work};
use crate::error::Result;
use crate::light::LightPrior;
use crate::options::Options;
use crate::pose::{ImageGrid, Search};
use crate::view::{ColourImage, ColourView, DepthMap, DepthView};

/// Does tasks of the opening, and later refinements, for an [`Estimator`](super::Estimator) of the same pair and options.
/// What it finds does not depend on what it did before, but for the shape that its last refinement has left.
pub struct Helper {
    image: ColourView,
    depth: DepthView,
    options: Options,
    prior: LightPrior,
    /// What the opening needs, and what refinements do: one gives way to the other.
    scout: Option<(Joint, Search)>,
    partner: Option<Partner>,
}

impl Helper {
    /// A helper for one pair.
    ///
    /// # Errors
    /// Those of [`Estimator::new`](super::Estimator::new).
    pub fn new(image: ColourImage, depth: &DepthMap, options: Options) -> Result<Self> {
        let (image, depth) = super::views(image, depth, &options)?;
        Ok(Self { image, depth, options, prior: LightPrior::natural(), scout: None, partner: None })
    }

    /// Does one task of the opening, however long it takes.
    ///
    /// # Errors
    /// Those of the search.
    pub fn perform(&mut self, task: &Task) -> Result<Finding> {
        let Self { image, depth, options, prior, scout, partner } = self;
        *partner = None;
        let given = given(image, depth, prior, options);
        let (joint, search) = match scout {
            Some(scout) => scout,
            nobody => {
                let joint = Joint::new(&given);
                let search = search(&given, ImageGrid::new(given.image)?, options, &joint)?;
                nobody.insert((joint, search))
            }
        };
        Ok(Finding(match &task.0 {
            Work::Search(task) => Found::Search(search.perform(task)),
            Work::Register(index, start) => {
                let mut attempt = joint.attempt(&given, start, true);
                let report = loop {
                    match attempt {
                        Attempt::Ongoing => attempt = joint.attempt(&given, start, false),
                        Attempt::Ended(report) => break report,
                    }
                };
                Found::Registered(*index, report.map(Registered::of))
            }
        }))
    }

    /// Makes a refinement: `load` puts the planes of its [`RefinementTask`](super::RefinementTask) in their places, of which
    /// those of the shape hold what the last one has left. Refined depth and normals (x, y, z).
    ///
    /// # Errors
    /// [`ErrorKind::Size`](crate::ErrorKind::Size) where `numbers` are not those of a task.
    pub fn refine(&mut self, numbers: &[f64], load: impl FnOnce([&mut [f32]; 9])) -> Result<[&[f32]; 4]> {
        let Self { image, depth, scout, partner, .. } = self;
        *scout = None;
        let partner = match partner {
            Some(partner) => partner,
            nobody => nobody.insert(Partner::new(image, depth)?),
        };
        load(partner.planes());
        partner.refine(image, depth, numbers)
    }
}
