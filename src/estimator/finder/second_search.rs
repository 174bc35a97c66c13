//! The second search, behind a pinhole, if nothing is known about the pose and the albedo varies
//! (docs/method/registration.md).
//!
//! The first search compares colours and expects both cameras at about the same distance. This one compares local
//! contrast, and the distance follows from the mask, of which the depth map may cover only a part. Its candidates are
//! registered roughly; the best ends and the poses found before are registered with the terms of
//! `pose/photometric/near.rs` and a wide prior. Ends are ranked by the score of the search plus their gain, which is the
//! evidence of the image: the gain alone favours poses that see a part without contrast, and the score does not resolve
//! details smaller than a cell.

use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::{Attempt, CANDIDATE_POINTS, FIRST_LEVEL_NEAR, PhotometricRegistration};
use crate::pose::{PhotometricReport, Search, Similarity};
use crate::reason::Activity;

use super::candidates::problem;
use super::initial_pose::aligned_prior;
use super::local_optima::{Choice, LocalOptima, Origin, RegisteredCandidate, gain};
use super::silhouettes::ANYWHERE_DEGREES;

/// Largest number of points of the rough registrations.
const ROUGH_POINTS: usize = 400;
/// Number of their optima that are registered again, with all terms.
const MOST_REGISTERED: usize = 4;
/// An end that sees fewer than this share of the points has receded until its points hide each other, and does not count.
const LEAST_VISIBLE: f64 = 0.5;
/// Shares of the work of the search and of the rough registrations.
const SEARCH_SHARE: f64 = 0.4;
const ROUGH_SHARE: f64 = 0.6;

/// The second search in slices; owns its memory.
pub struct SecondSearch {
    search: Search,
    /// Poses found before.
    known: Vec<Similarity>,
    /// Evidence of the image for the pose from silhouettes, zero without that pose.
    evidence_for_silhouettes: f64,
    stage: Stage,
}

/// Result of the second search.
#[derive(Default)]
pub struct Found {
    pub choice: Choice,
    /// Evidence of the image for the choice, less that for the pose from silhouettes. It counts as a difference of log
    /// likelihoods.
    pub lead: f64,
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
    pub fn new(
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        silhouettes: Option<Similarity>,
        plain: Option<Similarity>,
    ) -> Option<Self> {
        let mut search = Search::for_parts(&problem(pair, photometric)).ok()?;
        let evidence_for_silhouettes = silhouettes.and_then(|pose| {
            let judged = photometric.judge(pair, &pose)?;
            evidence(pair, &mut search, &judged)
        });
        let known = silhouettes.into_iter().chain(plain).collect();
        let evidence_for_silhouettes = evidence_for_silhouettes.unwrap_or(0.0);
        Some(Self { search, known, evidence_for_silhouettes, stage: Stage::Search })
    }

    /// Runs one slice; returns the result at the end.
    pub fn advance(&mut self, pair: &ViewPair, photometric: &mut PhotometricRegistration) -> Option<Found> {
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
                        enter(ends, &mut self.search, *next, found);
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
                let Some(start) = starts.last() else { return Some(self.found()) };
                if !*is_begun {
                    photometric.keep_near(aligned_prior(pair, *start, ANYWHERE_DEGREES));
                }
                let attempt = photometric.step_from(pair, start, FIRST_LEVEL_NEAR, !*is_begun);
                *is_begun = matches!(attempt, Attempt::Ongoing);
                if let Attempt::Ended(found) = attempt {
                    starts.pop();
                    let least = LEAST_VISIBLE * pair.depth.valid().min(CANDIDATE_POINTS) as f64;
                    if let Some(found) = found.filter(|found| found.visible as f64 >= least) {
                        enter(optima, &mut self.search, starts.len(), found);
                    }
                }
            }
        }
        None
    }

    /// The choice among the ends.
    fn found(&mut self) -> Found {
        let Stage::Closely { optima, .. } = &mut self.stage else { return Found::default() };
        let ranking = optima.ranked();
        let evidence = ranking.best.as_ref().map_or(0.0, |best| best.gain);
        Found { choice: Choice::of(ranking), lead: evidence - self.evidence_for_silhouettes }
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

/// The evidence of the image for a pose, as the logarithm of a likelihood; `None` if too little overlaps there.
pub fn evidence(pair: &ViewPair, search: &mut Search, judged: &PhotometricReport) -> Option<f64> {
    Some(search.score_of(&judged.pose)? + gain(pair.image.log_spread(), judged.visible as f64, judged.noise))
}

/// Enters the end of a registration with its score.
fn enter(optima: &mut LocalOptima, search: &mut Search, origin: usize, found: Box<PhotometricReport>) {
    if let Some(score) = search.score_of(&found.pose) {
        optima.enter_scored(Origin::Candidate(origin), RegisteredCandidate::of(found), score);
    }
}
