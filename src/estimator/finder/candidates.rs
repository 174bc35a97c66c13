//! The search, and the photometric registration of its candidates.
//!
//! Each task depends only on the pair and itself, so threads may take some of them. Results count in the order of the
//! candidates.

use nalgebra::Matrix3;

use crate::error::Result;
use crate::estimator::gauge;
use crate::estimator::pair::ViewPair;
use crate::estimator::photometric::{Attempt, PhotometricRegistration};
use crate::pose::{ImageGrid, Search, SearchProblem, Similarity, TaskResults};
use crate::reason::Activity;

use super::initial_pose::TrustRegion;
use super::local_optima::{Choice, LocalOptima, Origin, Ranking, RegisteredCandidate};
use super::task::{Finding, Found, Task, Work};

/// Numbers of candidates to register.
#[derive(Clone, Copy)]
pub struct Effort {
    /// After this many, a convincing optimum is trusted.
    pub few: usize,
    pub most: usize,
}

/// Effort if nothing is known about the pose.
pub const EVERYWHERE: Effort = Effort { few: 10, most: 40 };
/// Effort near an initial pose: all candidates are registered and compared with it.
pub const NEARBY: Effort = Effort { few: 12, most: 12 };
/// Share of the progress that the search takes.
const SEARCH_SHARE: f64 = 0.4;
/// Share of the first few registrations. The later ones may be skipped, and then progress jumps to its end.
const FEW_SHARE: f64 = 0.2;
/// Share of the later registrations.
const MORE_SHARE: f64 = 0.15;

/// The search of a pair, with the normals of photometric registration. Near an initial pose it covers the rotations
/// within tolerance.
///
/// # Errors
/// The errors of [`Search`], if the views allow no search.
#[inline(never)]
pub fn search(pair: &ViewPair, grid: ImageGrid, photometric: &PhotometricRegistration) -> Result<Search> {
    let region = TrustRegion::of(pair);
    let problem = problem(pair, photometric);
    let unit_scale = region.as_ref().map_or(problem.unit_scale, |region| region.initial.scale);
    let mut search = Search::with_grid(&SearchProblem { unit_scale, ..problem }, grid)?;
    if let Some(region) = region {
        search.narrow(&region.initial, region.degrees);
    }
    Ok(search)
}

/// The problem of a search without an initial pose.
pub fn problem<'a>(pair: &'a ViewPair, photometric: &'a PhotometricRegistration) -> SearchProblem<'a> {
    SearchProblem {
        image: &pair.image,
        depth: &pair.depth,
        normals: photometric.normals(),
        light: pair.known_light(),
        scale: gauge::held_scale(pair),
        unit_scale: gauge::unit_scale(pair),
        seed: pair.options.seed,
    }
}

/// The candidates of a search up to the choice; owns its memory.
pub struct Candidates {
    search: Search,
    /// The result for each candidate; `None` if it could not be registered.
    registrations: TaskResults<Option<RegisteredCandidate>>,
    effort: Effort,
    /// The next candidate to count, and the number already counted.
    next: usize,
    tried: usize,
    optima: LocalOptima,
    /// The candidate whose registration is in progress in this thread.
    begun: Option<usize>,
    /// Whether another method takes over if a single albedo does not explain the image.
    may_vary: bool,
    /// Whether registrations are kept near the initial pose.
    is_near: bool,
    chosen: Option<Ranking>,
}

impl Candidates {
    /// Starts from a search and from the optima already known.
    pub fn new(search: Search, optima: LocalOptima, effort: Effort, may_vary: bool) -> Self {
        let registrations = TaskResults::new(0);
        Self {
            search,
            registrations,
            effort,
            next: 0,
            tried: 0,
            optima,
            begun: None,
            may_vary,
            is_near: false,
            chosen: None,
        }
    }

    /// Keeps the registrations near the initial pose.
    pub fn near(self) -> Self {
        Self { is_near: true, ..self }
    }

    /// The best pose so far: from a registration, or else from the search.
    pub fn best_pose(&self) -> Option<Similarity> {
        self.optima.best().or_else(|| self.search.best().map(|best| best.pose))
    }

    /// Each rotation tried so far, with its score.
    pub fn scores(&self) -> Vec<(Matrix3<f64>, f64)> {
        self.search.scores()
    }

    /// Where the search looked: every rotation of its sweep, and its candidates.
    pub fn poses(&self) -> Vec<Similarity> {
        let mut poses = self.search.swept_poses();
        poses.extend(self.search.candidates().iter().map(|candidate| candidate.pose));
        poses
    }

    /// A task for a worker; `None` if none is ready.
    pub fn take(&mut self) -> Option<Task> {
        if let Some(task) = self.search.take() {
            return Some(Task(Work::Search(task)));
        }
        if self.chosen.is_some() {
            return None;
        }
        let Self { registrations, search, optima, next, begun, is_near, .. } = self;
        let candidates = search.candidates();
        let is_wanted = |index| index >= *next && Some(index) != *begun && !optima.is_known(&candidates[index].pose);
        let index = registrations.take(is_wanted)?;
        Some(Task(Work::Register(index, candidates[index].pose, *is_near)))
    }

    /// Takes a worker's result.
    pub fn accept(&mut self, finding: Finding, is_allowed: impl Fn(&Similarity) -> bool) {
        match finding.0 {
            Found::Search(finding) => self.search.accept(finding),
            Found::Registered(index, registered) => self.registrations.put(index, registered),
        }
        self.count(is_allowed);
    }

    /// Runs one slice: a part of the search, or a step of a registration. Returns the choice at the end. Registrations
    /// that end at a pose that is not `is_allowed` do not count.
    #[inline(never)]
    pub fn advance(
        &mut self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        is_allowed: impl Fn(&Similarity) -> bool,
    ) -> Option<Choice> {
        if self.is_searching() {
            self.search.advance();
        } else if let Some(chosen) = self.chosen.take() {
            return self.conclude(pair, photometric, chosen);
        } else {
            self.register(pair, photometric);
        }
        self.count(is_allowed);
        None
    }

    fn is_searching(&self) -> bool {
        !self.search.is_done()
    }

    /// Share of the work done, and the current activity.
    pub fn progress(&self) -> (f64, Activity) {
        if self.is_searching() {
            return (SEARCH_SHARE * self.search.progress().share, Activity::Comparing);
        }
        let Effort { few, most } = self.effort;
        let first = self.tried.min(few);
        let more = (self.tried - first) as f64 / (most - few).max(1) as f64;
        (SEARCH_SHARE + FEW_SHARE * first as f64 / few as f64 + MORE_SHARE * more, Activity::Registering)
    }

    /// Advances the registration in progress here by a step, or begins the next one.
    fn register(&mut self, pair: &ViewPair, photometric: &mut PhotometricRegistration) {
        let candidates = self.search.candidates();
        let is_wanted = |index: usize| index >= self.next && !self.optima.is_known(&candidates[index].pose);
        let begun = self.begun.filter(|&index| is_wanted(index) && self.registrations.get(index).is_none());
        let Some(index) = begun.or_else(|| self.registrations.next(is_wanted)) else { return };
        if let Attempt::Ended(report) = self.step_candidate(pair, photometric, index) {
            self.registrations.put(index, report.map(RegisteredCandidate::of));
        }
    }

    /// One step of a registration. Drops another one in progress here.
    fn step_candidate(
        &mut self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        candidate: usize,
    ) -> Attempt {
        let start = self.search.candidates()[candidate].pose;
        let progress = photometric.step_candidate(pair, &start, self.begun != Some(candidate));
        self.begun = matches!(progress, Attempt::Ongoing).then_some(candidate);
        progress
    }

    /// Counts the results in the order of the candidates, up to the first that is still open.
    fn count(&mut self, is_allowed: impl Fn(&Similarity) -> bool) {
        if self.is_searching() || self.chosen.is_some() {
            return;
        }
        let count = self.search.candidates().len();
        if self.registrations.len() != count {
            self.registrations = TaskResults::new(count);
        }
        while !self.is_exhausted() {
            if self.optima.is_known(&self.search.candidates()[self.next].pose) {
                self.next += 1;
                continue;
            }
            let Some(registered) = self.registrations.get(self.next) else { return };
            (self.next, self.tried) = (self.next + 1, self.tried + 1);
            if let Some(registered) = registered.clone().filter(|registered| is_allowed(&registered.pose)) {
                self.optima.enter(Origin::Candidate(self.next - 1), registered);
            }
        }
        self.chosen = Some(self.optima.ranked());
    }

    /// Whether no further candidate counts.
    fn is_exhausted(&self) -> bool {
        let is_clear =
            || self.optima.is_convincing(self.tried) || (self.may_vary && self.optima.are_of_varying_albedo());
        let enough = self.tried >= self.effort.most || (self.tried >= self.effort.few && is_clear());
        self.next >= self.search.candidates().len() || enough
    }

    /// Chooses once the full report of the best optimum is here. A worker returns only the figures by which optima are
    /// compared.
    fn conclude(
        &mut self,
        pair: &ViewPair,
        photometric: &mut PhotometricRegistration,
        chosen: Ranking,
    ) -> Option<Choice> {
        let Ranking { best, rivals } = chosen;
        let Some(mut best) = best else { return Some(Choice::default()) };
        if let (Origin::Candidate(candidate), None) = (best.origin, &best.registered.report) {
            match self.step_candidate(pair, photometric, candidate) {
                Attempt::Ended(report) => best.registered.report = report,
                Attempt::Ongoing => {
                    self.chosen = Some(Ranking { best: Some(best), rivals });
                    return None;
                }
            }
        }
        Some(Choice::of(Ranking { best: Some(best), rivals }))
    }
}
