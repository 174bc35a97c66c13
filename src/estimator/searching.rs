//! The initialisation as a part of the run: its slices, the reason given meanwhile, and the loop's start from what it finds.

use nalgebra::Matrix3;

use super::Estimator;
use super::gauge;
use super::initialisation::{Advance, Initialisation};
use super::opening::Opening;
use super::run::Run;
use super::stages::Outcome;
use crate::error::Result;
use crate::pose::{Angles, ImageGrid};
use crate::reason::{Activity, FoundBy, Reason};
use crate::report::Stage;
use crate::view::is_hollow;

impl Estimator {
    /// What the search needs of one of the views.
    pub(super) fn prepare_search(&mut self) -> Result<()> {
        self.report.stage = Stage::Search;
        self.report.reason = Some(Reason::Searching { percent: 0.0, activity: Activity::Preparing });
        let Run::Preparing(prepared) = std::mem::replace(&mut self.run, Run::Preparing(None)) else { return Ok(()) };
        self.run = match prepared {
            None => {
                let depth = &self.pair.depth;
                self.history.is_hollow = is_hollow(depth.size, &depth.points.z, &depth.normals);
                let opening = Opening::of(&self.pair).map(Box::new);
                let image = opening.as_ref().map_or(&self.pair.image, |opening| &opening.pair.image);
                Run::Preparing(Some(Box::new((ImageGrid::new(image)?, opening))))
            }
            Some(prepared) => {
                let (grid, opening) = *prepared;
                let initialisation = Initialisation::new(&self.pair, &mut self.registration, opening, grid)?;
                Run::Searching(Box::new(initialisation))
            }
        };
        Ok(())
    }

    /// A slice of the initialisation.
    pub(super) fn search(&mut self) -> std::result::Result<(), Reason> {
        let Run::Searching(initialisation) = &mut self.run else { return Ok(()) };
        match initialisation.advance(&self.pair, &mut self.registration) {
            Advance::Ongoing(share, activity) => {
                self.report_search(share, activity);
                Ok(())
            }
            Advance::Done(outcome) => {
                self.run = Run::Iterating(Stage::Light);
                self.report.pose = self.solution.pose;
                self.start_from(outcome)
            }
        }
    }

    /// What the search has come to, and the best pose so far.
    fn report_search(&mut self, share: f64, activity: Activity) {
        let Run::Searching(initialisation) = &self.run else { return };
        self.report.reason = Some(Reason::Searching { percent: 100.0 * share, activity });
        self.report.pose = initialisation.best_pose().unwrap_or(self.report.pose);
    }

    /// The report of a search that others have advanced.
    #[cfg(feature = "rayon")]
    pub(super) fn show_search(&mut self) {
        let Run::Searching(initialisation) = &self.run else { return };
        if let Advance::Ongoing(share, activity) = initialisation.progress() {
            self.report_search(share, activity);
            self.translate_report();
        }
    }

    /// What the search has tried so far: alpha, beta, gamma in degrees of each rotation, and its score: the gain of log likelihood over
    /// a constant colour, in cells of the search's grid, at the best translation and size. Empty before and after the search.
    #[must_use]
    pub fn search_scores(&self) -> Vec<[f32; 4]> {
        let Run::Searching(initialisation) = &self.run else { return vec![] };
        let row = |(rotation, score): (Matrix3<f64>, f64)| {
            let Angles { alpha, beta, gamma } = Angles::of(&rotation);
            [alpha, beta, gamma, score].map(|value| value as f32)
        };
        initialisation.scores().into_iter().filter(|(_, score)| score.is_finite()).map(row).collect()
    }

    /// Starts the loop from what the initialisation found.
    fn start_from(&mut self, outcome: Outcome) -> std::result::Result<(), Reason> {
        let registered = self.registration.adopt(&self.pair, outcome, &self.solution.pose);
        self.adopt(registered.ok_or(Reason::NoPose { scale_is_held: gauge::held_scale(&self.pair).is_some() })?);
        let by = if self.registration.found_by_outlines().is_some() {
            FoundBy::Silhouettes
        } else if self.registration.found_by_contrast().is_some() {
            FoundBy::Contrast
        } else {
            FoundBy::Image
        };
        self.report.reason = Some(Reason::SearchDone { by, rivals: self.report.rivals.len() as u32 });
        self.report.pose = self.solution.pose;
        self.find_correspondences();
        self.accepted.accept(&self.solution);
        self.measure();
        Ok(())
    }
}
