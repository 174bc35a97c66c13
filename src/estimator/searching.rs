//! The initialisation as a part of the run: its slices, what is said meanwhile, and the loop's start from what it finds.

use nalgebra::Matrix3;

use super::Estimator;
use super::initialisation::{self, Advance, Initialisation};
use super::opening::Opening;
use super::run::Run;
use super::stages::Outcome;
use crate::error::Result;
use crate::pose::{Angles, ImageGrid};
use crate::report::Stage;
use crate::text::Fixed;
use crate::view::is_hollow;

impl Estimator {
    /// What the search needs of one of the views.
    pub(super) fn prepare_search(&mut self) -> Result<()> {
        self.report.stage = Stage::Search;
        self.report.message = Some("0 %: preparing the search".into());
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
    pub(super) fn search(&mut self) -> Result<()> {
        let Run::Searching(initialisation) = &mut self.run else { return Ok(()) };
        match initialisation.advance(&self.pair, &mut self.registration) {
            Advance::Ongoing(share, what) => {
                self.report.message = Some(format!("{} %: {what}", Fixed(100.0 * share, 0)));
                self.report.pose = initialisation.best_pose().unwrap_or(self.report.pose);
                Ok(())
            }
            Advance::Done(outcome) => {
                self.run = Run::Iterating(Stage::Light);
                self.report.pose = self.solution.pose;
                self.start_from(outcome)
            }
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
    fn start_from(&mut self, outcome: Outcome) -> Result<()> {
        let registered = self.registration.adopt(&self.pair, outcome, &self.solution.pose);
        self.adopt(registered.ok_or_else(|| initialisation::nothing_found(&self.pair))?);
        self.report.message = Some(match self.report.rivals.len() {
            0 if self.registration.found_by_outlines().is_some() => {
                "100 %: one paint does not explain the colours; outlines tell the pose".into()
            }
            0 if self.registration.found_by_contrast().is_some() => {
                "100 %: one paint does not explain the colours; local contrast tells the pose".into()
            }
            0 => "100 %: one pose explains the colours best".into(),
            1 => "100 %: one other pose explains the colours as well".into(),
            count => format!("100 %: {count} other poses explain the colours as well"),
        });
        self.report.pose = self.solution.pose;
        self.find_correspondences();
        self.accepted.accept(&self.solution);
        self.measure();
        Ok(())
    }
}
