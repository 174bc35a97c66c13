//! The finder as a part of the run: its slices, the reason reported meanwhile, and the start of the loop from its
//! decision.

use nalgebra::Matrix3;

use super::Estimator;
use super::checks;
use super::decision::Decision;
use super::finder::{Advance, Finder, HalvedPair};
use super::gauge;
use super::run::Run;
use crate::error::Result;
use crate::pose::{Angles, ImageGrid};
use crate::reason::{Activity, Reason};
use crate::report::Stage;

impl Estimator {
    /// Prepares one of the views for the search.
    pub(super) fn prepare_search(&mut self) -> Result<()> {
        self.report.stage = Stage::Search;
        self.report.reason = Some(Reason::Searching { percent: 0.0, activity: Activity::Preparing });
        let Run::Preparing(prepared) = std::mem::replace(&mut self.run, Run::Preparing(None)) else { return Ok(()) };
        self.run = match prepared {
            None => {
                self.history.hollow = checks::hollow(&self.pair.depth);
                let halved = HalvedPair::of(&self.pair).map(Box::new);
                let image = halved.as_ref().map_or(&self.pair.image, |halved| &halved.pair.image);
                Run::Preparing(Some(Box::new((ImageGrid::new(image)?, halved))))
            }
            Some(prepared) => {
                let (grid, halved) = *prepared;
                let memory = &mut self.stages.registration.photometric;
                Run::Searching(Box::new(Finder::everywhere(&self.pair, memory, halved, grid)?))
            }
        };
        Ok(())
    }

    /// Runs a finder in place of a registration, which continues after the decision.
    pub(super) fn find(&mut self, finder: Box<Finder>) {
        self.report.stage = Stage::Search;
        self.report.reason = Some(Reason::Searching { percent: 0.0, activity: Activity::Registering });
        self.run = Run::Searching(finder);
    }

    /// Runs a slice of the finder.
    pub(super) fn search(&mut self) -> std::result::Result<(), Reason> {
        let Run::Searching(finder) = &mut self.run else { return Ok(()) };
        match finder.advance(&self.pair, &mut self.stages.registration.photometric)? {
            Advance::Ongoing(share, activity) => {
                self.report_search(share, activity);
                Ok(())
            }
            Advance::Done(decision) if finder.is_near() => {
                self.run = Run::Iterating(Stage::Registration.next());
                self.report.stage = Stage::Registration;
                self.report.pose = self.accepted.pose;
                let registered = self.stages.registration.adopt(&self.pair, decision, &self.solution.pose)?;
                self.finish_registration(registered);
                Ok(())
            }
            Advance::Done(decision) => {
                self.run = Run::Iterating(Stage::Light);
                self.report.pose = self.solution.pose;
                self.start_from(decision)
            }
            Advance::Nothing => {
                self.report.pose = self.solution.pose;
                Err(Reason::NoPose { scale_is_held: gauge::held_scale(&self.pair).is_some() })
            }
        }
    }

    /// Reports the progress of the search and the best pose so far.
    fn report_search(&mut self, share: f64, activity: Activity) {
        let Run::Searching(finder) = &self.run else { return };
        self.report.reason = Some(Reason::Searching { percent: 100.0 * share, activity });
        self.report.pose = finder.best_pose().unwrap_or(self.report.pose);
    }

    /// Reports a search that other threads have advanced.
    #[cfg(feature = "rayon")]
    pub(super) fn show_search(&mut self) {
        let Run::Searching(finder) = &self.run else { return };
        if let Some((share, activity)) = finder.progress() {
            self.report_search(share, activity);
            self.translate_report();
        }
    }

    /// What the search has tried so far: alpha, beta and gamma of each rotation in degrees, and its score. The score is
    /// the gain of log likelihood over a constant colour, in cells of the search's grid, at the best translation and
    /// size. Empty before and after the search.
    #[must_use]
    pub fn search_scores(&self) -> Vec<[f32; 4]> {
        let Run::Searching(finder) = &self.run else { return vec![] };
        let row = |(rotation, score): (Matrix3<f64>, f64)| {
            let Angles { alpha, beta, gamma } = Angles::of(&rotation);
            [alpha, beta, gamma, score].map(|value| value as f32)
        };
        finder.scores().into_iter().filter(|(_, score)| score.is_finite()).map(row).collect()
    }

    /// Starts the loop from the finder's decision.
    fn start_from(&mut self, decision: Decision) -> std::result::Result<(), Reason> {
        let by = decision.by.found_by();
        if let Some(registered) = self.stages.registration.adopt(&self.pair, decision, &self.solution.pose)? {
            self.adopt(registered);
        }
        self.report.reason = Some(Reason::SearchDone { by, rivals: self.report.rivals.len() as u32 });
        self.report.pose = self.solution.pose;
        self.find_correspondences();
        self.accepted.accept(&self.solution);
        self.measure();
        Ok(())
    }
}
