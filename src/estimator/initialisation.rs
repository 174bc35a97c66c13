//! The initialisation, where nothing is known of the pose: search everywhere, register the best candidates by their
//! colours, keep the pose that explains most, remember its rivals.
//!
//! All of it falls into tasks that depend on nothing but the pair and themselves, so that threads may do some of them
//! ([`Worker`](super::Worker)). What they find counts in the order of the tasks, however it comes in: the outcome is
//! the same to the bit.

use nalgebra::Matrix3;

use crate::error::Result;
use crate::pose::{ContrastSearch, ImageGrid, Search, SearchProblem, Similarity, TaskResults};
use crate::reason::Activity;

use super::gauge;
use super::local_optima::{Decision, LocalOptima};
use super::opening::Opening;
use super::pair::ViewPair;
use super::stages::painted::{self, CleanedImage, Conclusion};
use super::stages::{Attempt, ColourRegistration, Outcome, RegistrationStage};
use super::workers::task::{Finding, Found, RegisteredCandidate, Task, Work};

/// Registrations after which an optimum that convinces is believed, and registrations at most.
const FEW_TRIED: usize = 10;
const MOST_TRIED: usize = 40;
/// Share of the progress that the search itself takes ..
const SEARCH_SHARE: f64 = 0.4;
/// .. the first few registrations: what comes after them may be spared, and then progress leaps to its end ..
const FEW_SHARE: f64 = 0.2;
/// .. and local contrast, where the colours are painted.
const CONTRAST_SHARE: f64 = 0.25;

/// How the initialisation stands.
pub enum Advance {
    /// Not done; the share of the work that is, and what is being done.
    Ongoing(f64, Activity),
    /// What was found.
    Done(Outcome),
}

/// The initialisation in slices; owns its memory.
pub struct Initialisation {
    /// The pair that is searched, and whose candidates are registered, in place of the views where these are large.
    opening: Option<Box<Opening>>,
    search: Search,
    /// What became of each candidate; `None` where it could not be registered.
    registrations: TaskResults<Option<RegisteredCandidate>>,
    /// The next candidate to count, and how many have been counted.
    next: usize,
    tried: usize,
    optima: LocalOptima,
    /// The candidate whose registration is under way here.
    begun: Option<usize>,
    /// Whether local contrast can be asked where colours explain nothing.
    may_be_painted: bool,
    decision: Option<Decision>,
    /// Once the colours have spoken and are painted: the search by contrast.
    contrast: Option<ByContrast>,
}

/// The search by local contrast.
struct ByContrast {
    /// What the colours said.
    colours: Outcome,
    cleaned: CleanedImage,
    search: Box<ContrastSearch>,
}

/// The search of a pair, by the normals that registrations go by.
#[inline(never)]
pub fn search(pair: &ViewPair, grid: ImageGrid, colours: &ColourRegistration) -> Result<Search> {
    let problem = SearchProblem {
        image: &pair.image,
        depth: &pair.depth,
        normals: colours.normals(),
        light: pair.known_light(),
        scale: gauge::held_scale(pair),
        unit_scale: gauge::unit_scale(pair),
        seed: pair.options.seed,
    };
    Search::with_grid(&problem, grid)
}

impl Initialisation {
    /// Of a pair and the registration by its colours; or of its opening.
    pub fn new(
        pair: &ViewPair,
        registration: &mut RegistrationStage,
        opening: Option<Box<Opening>>,
        grid: ImageGrid,
    ) -> Result<Self> {
        let (pair, colours) = match &opening {
            Some(opening) => (&opening.pair, &opening.colours),
            None => (pair, &*registration.prepare(pair)),
        };
        Ok(Self {
            search: search(pair, grid, colours)?,
            registrations: TaskResults::new(0),
            next: 0,
            tried: 0,
            optima: LocalOptima::new(MOST_TRIED, pair.residuals_of_noise(0.0)),
            begun: None,
            may_be_painted: painted::is_called_for(pair, colours),
            decision: None,
            contrast: None,
            opening,
        })
    }

    /// The best pose so far: that of a registration, or else of the search.
    pub fn best_pose(&self) -> Option<Similarity> {
        let best = self.optima.best().or_else(|| self.search.best().map(|best| best.pose))?;
        Some(self.opening.as_ref().map_or(best, |opening| opening.pose_out(&best)))
    }

    /// Each rotation that was tried so far, and its score.
    pub fn scores(&self) -> Vec<(Matrix3<f64>, f64)> {
        self.search.scores()
    }

    /// A task for a worker; `None` while none can be begun.
    pub fn take(&mut self) -> Option<Task> {
        if let Some(task) = self.search.take() {
            return Some(Task(Work::Search(task)));
        }
        if self.has_decided() {
            return None;
        }
        let Self { registrations, search, optima, next, begun, .. } = self;
        let candidates = search.candidates();
        let is_wanted = |index| index >= *next && Some(index) != *begun && !optima.is_known(&candidates[index].pose);
        let index = registrations.take(is_wanted)?;
        Some(Task(Work::Register(index, candidates[index].pose)))
    }

    /// What a worker has found.
    pub fn accept(&mut self, finding: Finding) {
        match finding.0 {
            Found::Search(finding) => self.search.accept(finding),
            Found::Registered(index, registered) => self.registrations.put(index, registered),
        }
        self.count();
    }

    /// One slice: a part of the search, or a step of a registration.
    pub fn advance(&mut self, pair: &ViewPair, registration: &mut RegistrationStage) -> Advance {
        if self.contrast.is_some() {
            return self.search_by_contrast(pair, registration.prepare(pair));
        }
        let mut opening = self.opening.take();
        let step = match &mut opening {
            Some(opening) => self.advance_in(&opening.pair, &mut opening.colours),
            None => self.advance_in(pair, registration.prepare(pair)),
        };
        match step {
            Advance::Done(outcome) => self.finish(pair, registration.prepare(pair), outcome, opening.as_deref()),
            ongoing => {
                self.opening = opening;
                ongoing
            }
        }
    }

    /// A slice of the search by colours of the pair that it goes by.
    #[inline(never)]
    fn advance_in(&mut self, pair: &ViewPair, colours: &mut ColourRegistration) -> Advance {
        if self.is_searching() {
            self.search.advance();
            self.count();
        } else if let Some(decision) = self.decision.take() {
            return self.conclude(pair, colours, decision);
        } else {
            self.register(pair, colours);
            self.count();
        }
        self.progress()
    }

    fn is_searching(&self) -> bool {
        !self.search.is_done()
    }

    fn has_decided(&self) -> bool {
        self.decision.is_some() || self.contrast.is_some()
    }

    /// How far the search by colours has come.
    pub fn progress(&self) -> Advance {
        if self.is_searching() {
            let share = self.search.progress().share;
            return Advance::Ongoing(SEARCH_SHARE * share, Activity::Comparing);
        }
        Advance::Ongoing(registered_share(self.tried), Activity::Registering)
    }

    /// A step of the registration that is under way here, or the beginning of the next one.
    fn register(&mut self, pair: &ViewPair, colours: &mut ColourRegistration) {
        let candidates = self.search.candidates();
        let is_wanted = |index: usize| index >= self.next && !self.optima.is_known(&candidates[index].pose);
        let begun = self.begun.filter(|&index| is_wanted(index) && self.registrations.get(index).is_none());
        let Some(index) = begun.or_else(|| self.registrations.next(is_wanted)) else { return };
        if let Attempt::Ended(report) = self.step_candidate(pair, colours, index) {
            self.registrations.put(index, report.map(RegisteredCandidate::of));
        }
    }

    /// A step of one registration; another one that was under way here is dropped.
    fn step_candidate(&mut self, pair: &ViewPair, colours: &mut ColourRegistration, candidate: usize) -> Attempt {
        let start = self.search.candidates()[candidate].pose;
        let progress = colours.step_candidate(pair, &start, self.begun != Some(candidate));
        self.begun = matches!(progress, Attempt::Ongoing).then_some(candidate);
        progress
    }

    /// Counts what has become of the candidates, in their order, up to the first that is still open.
    fn count(&mut self) {
        if self.is_searching() || self.has_decided() {
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
            if let Some(registered) = registered.clone() {
                self.optima.enter(self.next - 1, registered);
            }
        }
        self.decision = Some(self.optima.decide());
    }

    /// Whether no further candidate counts.
    fn is_exhausted(&self) -> bool {
        let is_clear = || self.optima.is_convincing(self.tried) || (self.may_be_painted && self.optima.is_painted());
        let enough = self.tried >= MOST_TRIED || (self.tried >= FEW_TRIED && is_clear());
        self.next >= self.search.candidates().len() || enough
    }

    /// The outcome, once the best one's whole report is here: a worker brings only what tells one optimum from another.
    fn conclude(&mut self, pair: &ViewPair, colours: &mut ColourRegistration, decision: Decision) -> Advance {
        let Decision { best: Some(mut best), rivals } = decision else {
            return Advance::Done(Outcome::default());
        };
        if best.registered.report.is_none() {
            match self.step_candidate(pair, colours, best.candidate) {
                Attempt::Ended(report) => best.registered.report = report,
                Attempt::Ongoing => {
                    self.decision = Some(Decision { best: Some(best), rivals });
                    return self.progress();
                }
            }
        }
        Advance::Done(Outcome { best: best.registered.report, rivals, contrast: None })
    }

    /// The outcome for the views, or the search by contrast where the colours are painted: from all that was looked at so
    /// far.
    fn finish(
        &mut self,
        pair: &ViewPair,
        colours: &ColourRegistration,
        mut outcome: Outcome,
        opening: Option<&Opening>,
    ) -> Advance {
        let pose_out = |pose: &Similarity| opening.map_or(*pose, |opening| opening.pose_out(pose));
        outcome.rivals.iter_mut().for_each(|rival| *rival = pose_out(rival));
        outcome.best = match opening {
            Some(opening) => outcome.best.map(|best| opening.report_out(best)),
            None => outcome.best,
        };
        let Some(cleaned) = painted::cleaned(pair, colours, outcome.best.as_deref()) else {
            return Advance::Done(outcome);
        };
        let mut poses = self.search.swept_poses();
        poses.extend(self.search.candidates().iter().map(|candidate| candidate.pose));
        poses.iter_mut().for_each(|pose| *pose = pose_out(pose));
        poses.extend(outcome.best.iter().map(|best| best.pose).chain(outcome.rivals.iter().copied()));
        let search = Box::new(painted::search(pair, colours, &cleaned, &poses));
        self.contrast = Some(ByContrast { colours: outcome, cleaned, search });
        Advance::Ongoing(1.0 - CONTRAST_SHARE, Activity::ComparingContrast)
    }

    /// A slice of the search by contrast.
    fn search_by_contrast(&mut self, pair: &ViewPair, colours: &ColourRegistration) -> Advance {
        let Some(ByContrast { colours: outcome, cleaned, search }) = &mut self.contrast else {
            return Advance::Done(Outcome::default());
        };
        if !search.advance(&colours.contrast_problem(pair, cleaned.image(pair))) {
            return Advance::Ongoing(1.0 - CONTRAST_SHARE * (1.0 - search.share()), Activity::ComparingContrast);
        }
        Advance::Done(match painted::conclude(pair, colours, cleaned, search) {
            Some(Conclusion::ByColours(best)) => Outcome { best: Some(best), ..Outcome::default() },
            Some(Conclusion::ByContrast(contrast)) => Outcome { contrast: Some(contrast), ..std::mem::take(outcome) },
            None => std::mem::take(outcome),
        })
    }
}

/// Share of the initialisation that is done after so many registrations.
fn registered_share(tried: usize) -> f64 {
    let few = tried.min(FEW_TRIED);
    let more = (tried - few) as f64 / (MOST_TRIED - FEW_TRIED) as f64;
    SEARCH_SHARE + FEW_SHARE * few as f64 / FEW_TRIED as f64 + (1.0 - SEARCH_SHARE - FEW_SHARE - CONTRAST_SHARE) * more
}
