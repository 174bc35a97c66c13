//! The second search, behind a pinhole, if nothing is known about the pose and the albedo varies
//! (docs/method/registration.md).
//!
//! The first search expects both cameras at about the same distance. Here the distance follows from the mask, of which
//! the depth map may cover only a part. Every end of its ascents is registered roughly; the best optima and the poses
//! found before are registered with the terms of `pose/photometric/near.rs` and a wide prior.
//!
//! The optima are ranked by their gain over a constant colour of the points that they see. The spread of the whole
//! image, in its place, would favour poses that see a part without contrast.

use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::{Attempt, CANDIDATE_POINTS, FIRST_LEVEL_NEAR, PhotometricRegistration};
use crate::pose::{ImageGrid, PhotometricReport, Search, Similarity};
use crate::reason::Activity;

use super::candidates::search;
use super::initial_pose::aligned_prior;
use super::local_optima::{Choice, LocalOptima, Origin, RegisteredCandidate};
use super::silhouettes::ANYWHERE_DEGREES;

/// Largest number of points of the rough registrations.
const ROUGH_POINTS: usize = 400;
/// Number of their optima that are registered again, with all terms.
const MOST_REGISTERED: usize = 8;
/// An end that sees fewer than this share of the points has receded until its points hide each other, and does not count.
const LEAST_VISIBLE: f64 = 0.5;
/// Largest noise of an end that may be the answer, as a share of the spread of the points that it sees. Set on pairs of a
/// statue and on captures (docs/lab/thresholds.md).
const LARGEST_NOISE_OF_SEEN: f64 = 0.4;
/// Shares of the work of the search and of the rough registrations.
const SEARCH_SHARE: f64 = 0.1;
const ROUGH_SHARE: f64 = 0.5;

/// The second search in slices; owns its memory.
pub struct SecondSearch {
    search: Search,
    /// Poses found before.
    known: Vec<Similarity>,
    stage: Stage,
}

enum Stage {
    Search,
    /// Rough registrations: the next candidate, and the optima so far.
    Roughly(usize, LocalOptima),
    /// Registrations with all terms: the remaining starts, the next one last, and whether its registration has begun.
    Closely {
        starts: Vec<Similarity>,
        is_begun: bool,
        optima: LocalOptima,
    },
}

impl SecondSearch {
    /// `None` if the views allow no search.
    pub fn new(pair: &ViewPair, photometric: &PhotometricRegistration, known: Vec<Similarity>) -> Option<Self> {
        let mut search = search(pair, ImageGrid::new(&pair.image).ok()?, photometric).ok()?;
        search.seek_parts();
        Some(Self { search, known, stage: Stage::Search })
    }

    /// Runs one slice; returns the choice at the end.
    pub fn advance(&mut self, pair: &ViewPair, photometric: &mut PhotometricRegistration) -> Option<Choice> {
        let optima = |most: usize| LocalOptima::new(most, pair.residuals_of_noise(0.0));
        match &mut self.stage {
            Stage::Search => {
                self.search.advance();
                if self.search.is_done() {
                    self.stage = Stage::Roughly(0, optima(self.search.candidates().len()));
                }
            }
            Stage::Roughly(next, ends) => {
                if let Some(candidate) = self.search.candidates().get(*next) {
                    if let Some(found) = photometric.register_roughly(pair, &candidate.pose, ROUGH_POINTS) {
                        ends.enter(Origin::Candidate(*next), registered(pair, photometric, found));
                    }
                    *next += 1;
                    return None;
                }
                let ends = std::mem::replace(ends, optima(0));
                let mut starts = std::mem::take(&mut self.known);
                starts.extend(ends.best_poses(MOST_REGISTERED));
                self.stage = Stage::Closely { optima: optima(starts.len()), starts, is_begun: false };
            }
            Stage::Closely { starts, is_begun, optima } => {
                let Some(start) = starts.last() else { return Some(explained(pair, optima)) };
                if !*is_begun {
                    photometric.keep_near(aligned_prior(pair, *start, ANYWHERE_DEGREES));
                }
                let attempt = photometric.step_from(pair, start, FIRST_LEVEL_NEAR, !*is_begun);
                *is_begun = matches!(attempt, Attempt::Ongoing);
                if let Attempt::Ended(found) = attempt {
                    starts.pop();
                    let least = LEAST_VISIBLE * pair.depth.valid().min(CANDIDATE_POINTS) as f64;
                    if let Some(found) = found.filter(|found| found.visible as f64 >= least) {
                        optima.enter(Origin::Candidate(starts.len()), registered(pair, photometric, found));
                    }
                }
            }
        }
        None
    }

    /// Share of the work done, and the current activity.
    pub fn progress(&self) -> (f64, Activity) {
        match &self.stage {
            Stage::Search => (SEARCH_SHARE * self.search.progress().share, Activity::Comparing),
            Stage::Roughly(next, _) => {
                let share = *next as f64 / self.search.candidates().len().max(1) as f64;
                (SEARCH_SHARE + (ROUGH_SHARE - SEARCH_SHARE) * share, Activity::Registering)
            }
            Stage::Closely { starts, .. } => {
                let left = starts.len() as f64 / (MOST_REGISTERED + 2) as f64;
                (1.0 - (1.0 - ROUGH_SHARE) * left.min(1.0), Activity::Registering)
            }
        }
    }
}

/// The choice among the ends if the best one explains the points that it sees, otherwise none.
fn explained(pair: &ViewPair, optima: &mut LocalOptima) -> Choice {
    let ranking = optima.ranked();
    let largest = LARGEST_NOISE_OF_SEEN * pair.image.log_spread();
    match ranking.best.as_ref().is_some_and(|best| best.registered.noise <= largest) {
        true => Choice::of(ranking),
        false => Choice::default(),
    }
}

/// An end for the comparison. Its noise, as a share of the spread of the points that it sees, is given in units of the
/// image's spread.
fn registered(
    pair: &ViewPair,
    photometric: &PhotometricRegistration,
    found: Box<PhotometricReport>,
) -> RegisteredCandidate {
    let noise = found.noise * pair.image.log_spread() / photometric.spread(pair);
    RegisteredCandidate { noise, ..RegisteredCandidate::of(found) }
}
