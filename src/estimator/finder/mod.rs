//! The finder: one pose, found everywhere or near an initial one, and decided here (docs/method.md, section 10).
//!
//! ```text
//!            scope
//!     everywhere |  near an initial pose
//!                |  |
//!                |  from the initial pose -- explained ------------------+
//!                |  from silhouettes ------- explained ---------------+  |
//!                |  shifted to the mask ---- explained ------------+  |  |
//!                v  v                                              |  |  |
//!     search: rotations x sizes x shifts (pose/search)             |  |  |
//!     photometric registration of its candidates                   |  |  |
//!                |                                                 |  |  |
//!                +-> choice among the local optima <---------------+--+  |
//!                        |                                               |
//!                    diagnosis: does a single albedo explain the image?  |
//!                        | yes          | no: local contrast (orthographic image)
//!                        |              |     or silhouettes (pinhole)   |
//!                        v              v                                |
//!                    decision: pose, method, rivals <--------------------+
//! ```
//!
//! Everything falls into slices, and those of search and registration into tasks that depend on nothing but the pair and themselves, so that
//! threads may do some of them ([`Worker`](super::Worker)). What they find counts in the order of the tasks, however it comes in: the
//! outcome is the same to the bit.
//!
//! | file | what it holds |
//! |---|---|
//! | `scope` | where a pose is looked for, and the trust region of an initial one |
//! | `nearby` | what is tried before the search where there is an initial pose |
//! | `candidates` | the search, and the registration of its candidates |
//! | `local_optima` | where registrations ended; the best of these poses, and its rivals |
//! | `local_contrast`, `silhouettes` | what decides where the albedo varies |
//! | `opening` | the halved pair that large views are searched by |
//! | `decision` | what comes out |

mod candidates;
mod decision;
mod local_contrast;
mod local_optima;
mod nearby;
mod opening;
mod scope;
mod silhouettes;

use nalgebra::Matrix3;

use crate::error::Result;
use crate::pose::{ContrastSearch, ImageGrid, OutlineReport, PhotometricReport, Similarity};
use crate::reason::Activity;

use super::pair::ViewPair;
use super::stages::ColourRegistration;
use super::workers::task::{Finding, Task};
use candidates::{Candidates, EVERYWHERE};
use local_contrast::{CleanedImage, Conclusion};
use local_optima::{Choice, LocalOptima};
use nearby::{Nearby, Progress};
use silhouettes::Anywhere;

pub use candidates::search;
pub use decision::{Decision, Method};
pub use local_optima::RegisteredCandidate;
pub use nearby::explains;
pub use opening::Opening;
pub use scope::TrustRegion;

/// Share of the work that comes before local contrast.
const BEFORE_CONTRAST: f64 = 0.75;

/// How the finder stands.
pub enum Advance {
    /// Not done; the share of the work that is, and what is being done.
    Ongoing(f64, Activity),
    Done(Decision),
}

/// Where the pose is looked for.
enum Scope {
    /// The halved pair stands in for the views where these are large.
    Everywhere(Option<Box<Opening>>),
    /// `noisy`: where the registration from the initial pose left no more than the image's own noise.
    Near { region: Box<TrustRegion>, noisy: Option<Similarity>, silhouettes: Option<Box<OutlineReport>> },
}

/// What is being done.
enum Phase {
    Nearby(Box<Nearby>),
    Candidates(Box<Candidates>),
    Contrast(Box<ByContrast>),
    Silhouettes(Box<Anywhere>),
}

/// The search by local contrast.
struct ByContrast {
    cleaned: CleanedImage,
    search: ContrastSearch,
}

/// Finds a pose in slices; owns its memory.
pub struct Finder {
    scope: Scope,
    phase: Phase,
    chosen: Choice,
}

impl Finder {
    /// Of a pair of which nothing is known, or of its opening; `grid` is that of its image.
    ///
    /// # Errors
    /// Those of the search, where the views allow none.
    pub fn everywhere(
        pair: &ViewPair,
        memory: &mut Option<ColourRegistration>,
        opening: Option<Box<Opening>>,
        grid: ImageGrid,
    ) -> Result<Self> {
        let (pair, colours) = match &opening {
            Some(opening) => (&opening.pair, &opening.colours),
            None => (pair, &*ColourRegistration::prepared(memory, pair)),
        };
        let optima = LocalOptima::new(EVERYWHERE.most, pair.residuals_of_noise(0.0));
        let may_vary = local_contrast::may_be_called_for(pair, colours);
        let candidates = Candidates::new(search(pair, grid, colours)?, optima, EVERYWHERE, may_vary);
        let phase = Phase::Candidates(Box::new(candidates));
        Ok(Self { scope: Scope::Everywhere(opening), phase, chosen: Choice::default() })
    }

    /// Around an initial pose, from which a registration did not explain the image; `plain` is what it found, within the region or not.
    pub fn near(pair: &ViewPair, region: TrustRegion, plain: Option<PhotometricReport>) -> Self {
        let plain = plain.map(Box::new).filter(|found| region.holds(pair, &found.pose));
        let noisy = plain.as_deref().filter(|found| pair.residuals(found).is_noise()).map(|found| found.pose);
        let nearby = Nearby::new(pair, plain);
        Self {
            scope: Scope::Near { region: Box::new(region), noisy, silhouettes: None },
            phase: Phase::Nearby(Box::new(nearby)),
            chosen: Choice::default(),
        }
    }

    /// Whether it looks near an initial pose.
    pub const fn is_near(&self) -> bool {
        matches!(self.scope, Scope::Near { .. })
    }

    /// The best pose so far: that of a registration, or else of the search.
    pub fn best_pose(&self) -> Option<Similarity> {
        let best = match &self.phase {
            Phase::Candidates(candidates) => candidates.best_pose(),
            Phase::Nearby(_) => None,
            _ => return self.chosen.best.as_ref().map(|best| best.pose),
        };
        match &self.scope {
            Scope::Everywhere(Some(opening)) => best.map(|best| opening.pose_out(&best)),
            _ => best,
        }
    }

    /// Each rotation that was tried so far, and its score.
    pub fn scores(&self) -> Vec<(Matrix3<f64>, f64)> {
        match &self.phase {
            Phase::Candidates(candidates) => candidates.scores(),
            _ => Vec::new(),
        }
    }

    /// A task for a worker; `None` while none can be begun.
    pub fn take(&mut self) -> Option<Task> {
        match &mut self.phase {
            Phase::Candidates(candidates) => candidates.take(),
            _ => None,
        }
    }

    /// What a worker has found.
    pub fn accept(&mut self, pair: &ViewPair, finding: Finding) {
        let region = self.scope.region();
        if let Phase::Candidates(candidates) = &mut self.phase {
            candidates.accept(finding, |pose| region.is_none_or(|region| region.holds(pair, pose)));
        }
    }

    /// How far the search and the registrations have come.
    #[cfg(feature = "rayon")]
    pub fn progress(&self) -> Option<(f64, Activity)> {
        match &self.phase {
            Phase::Candidates(candidates) => Some(candidates.progress()),
            _ => None,
        }
    }

    /// One slice.
    ///
    /// # Errors
    /// Those of the search near an initial pose, where the views allow none.
    pub fn advance(&mut self, pair: &ViewPair, memory: &mut Option<ColourRegistration>) -> Result<Advance> {
        match &mut self.phase {
            Phase::Nearby(_) => self.look_nearby(pair, memory),
            Phase::Candidates(_) => self.register_candidates(pair, memory),
            Phase::Contrast(_) => self.compare_contrast(pair, memory),
            Phase::Silhouettes(anywhere) => {
                if anywhere.advance(pair, ColourRegistration::prepared(memory, pair).normals()) {
                    let found = anywhere.best();
                    return Ok(Advance::Done(self.everywhere_by(found)));
                }
                Ok(Advance::Ongoing(BEFORE_CONTRAST, Activity::ComparingSilhouettes))
            }
        }
    }

    /// What is tried first around an initial pose.
    fn look_nearby(&mut self, pair: &ViewPair, memory: &mut Option<ColourRegistration>) -> Result<Advance> {
        let (Scope::Near { region, silhouettes, .. }, Phase::Nearby(nearby)) = (&mut self.scope, &mut self.phase)
        else {
            return Ok(Advance::Done(Decision::of(Method::Nothing)));
        };
        let progress = nearby.advance(pair, ColourRegistration::prepared(memory, pair), region)?;
        let activity = Activity::Registering;
        match progress {
            Progress::Ongoing => Ok(Advance::Ongoing(0.0, activity)),
            Progress::Explained(choice) => {
                *silhouettes = nearby.silhouettes();
                self.diagnose(pair, memory, choice, Vec::new())
            }
            Progress::Unexplained(candidates) => {
                *silhouettes = nearby.silhouettes();
                self.phase = Phase::Candidates(candidates);
                Ok(Advance::Ongoing(0.0, activity))
            }
        }
    }

    /// A slice of the search, or of the registration of a candidate.
    fn register_candidates(&mut self, pair: &ViewPair, memory: &mut Option<ColourRegistration>) -> Result<Advance> {
        let Self { scope, phase: Phase::Candidates(candidates), .. } = self else {
            return Ok(Advance::Done(Decision::of(Method::Nothing)));
        };
        let choice = match scope {
            Scope::Everywhere(Some(opening)) => candidates.advance(&opening.pair, &mut opening.colours, |_| true),
            Scope::Everywhere(None) => candidates.advance(pair, ColourRegistration::prepared(memory, pair), |_| true),
            Scope::Near { region, .. } => {
                let colours = ColourRegistration::prepared(memory, pair);
                candidates.advance(pair, colours, |pose| region.holds(pair, pose))
            }
        };
        let Some(mut choice) = choice else {
            let (share, activity) = candidates.progress();
            return Ok(Advance::Ongoing(share, activity));
        };
        let mut looked_at = candidates.poses();
        if let Scope::Everywhere(Some(opening)) = scope {
            looked_at.iter_mut().chain(&mut choice.rivals).for_each(|pose| *pose = opening.pose_out(pose));
            choice.best = choice.best.map(|best| opening.report_out(best));
        }
        self.diagnose(pair, memory, choice, looked_at)
    }

    /// Goes on with local contrast where the albedo varies; `looked_at` is where the search was.
    fn diagnose(
        &mut self,
        pair: &ViewPair,
        memory: &mut Option<ColourRegistration>,
        choice: Choice,
        mut looked_at: Vec<Similarity>,
    ) -> Result<Advance> {
        self.chosen = choice;
        let colours = &*ColourRegistration::prepared(memory, pair);
        let Some(cleaned) = local_contrast::cleaned(pair, colours, self.chosen.best.as_deref()) else {
            return self.decide(pair, memory, None);
        };
        let starts = match &self.scope {
            Scope::Everywhere(_) => {
                let Choice { best, rivals } = &self.chosen;
                looked_at.extend(best.iter().map(|best| best.pose).chain(rivals.iter().copied()));
                local_contrast::of_all_sizes(pair, &looked_at)
            }
            Scope::Near { region, .. } => local_contrast::around(pair, &region.initial),
        };
        let search = ContrastSearch::new(&colours.contrast_problem(pair, cleaned.image(pair)), starts);
        self.phase = Phase::Contrast(Box::new(ByContrast { cleaned, search }));
        Ok(Advance::Ongoing(BEFORE_CONTRAST, Activity::ComparingContrast))
    }

    /// A slice of the search by local contrast.
    fn compare_contrast(&mut self, pair: &ViewPair, memory: &mut Option<ColourRegistration>) -> Result<Advance> {
        let Phase::Contrast(contrast) = &mut self.phase else {
            return Ok(Advance::Done(Decision::of(Method::Nothing)));
        };
        let ByContrast { cleaned, search } = &mut **contrast;
        let colours = &*ColourRegistration::prepared(memory, pair);
        if !search.advance(&colours.contrast_problem(pair, cleaned.image(pair))) {
            let share = BEFORE_CONTRAST + (1.0 - BEFORE_CONTRAST) * search.share();
            return Ok(Advance::Ongoing(share, Activity::ComparingContrast));
        }
        let conclusion = local_contrast::conclude(pair, colours, cleaned, search);
        self.decide(pair, memory, conclusion)
    }

    fn decide(
        &mut self,
        pair: &ViewPair,
        memory: &mut Option<ColourRegistration>,
        found: Option<Conclusion>,
    ) -> Result<Advance> {
        if self.is_near() {
            return self.decide_near(pair, memory, found).map(Advance::Done);
        }
        Ok(Advance::Done(match found {
            Some(Conclusion::ByColours(best)) => Decision { by: Method::Image(best), rivals: Some(Vec::new()) },
            Some(Conclusion::ByContrast(found)) => {
                Decision { by: Method::Contrast(Box::new(found.best)), rivals: Some(found.rivals) }
            }
            None if silhouettes::are_called_for(pair, self.chosen.best.as_deref()) => {
                let normals = ColourRegistration::prepared(memory, pair).normals();
                let Some(anywhere) = Anywhere::new(pair, normals) else {
                    return Ok(Advance::Done(self.everywhere_by(None)));
                };
                self.phase = Phase::Silhouettes(Box::new(anywhere));
                return Ok(Advance::Ongoing(BEFORE_CONTRAST, Activity::ComparingSilhouettes));
            }
            None => self.everywhere_by(None),
        }))
    }

    /// By silhouettes, or else by the best registration.
    fn everywhere_by(&mut self, silhouettes: Option<OutlineReport>) -> Decision {
        let Choice { best, rivals } = std::mem::take(&mut self.chosen);
        match (silhouettes, best) {
            (Some(found), _) => Decision { by: Method::Silhouettes(Box::new(found)), rivals: Some(Vec::new()) },
            (None, Some(best)) => Decision { by: Method::Image(best), rivals: Some(rivals) },
            (None, None) => Decision { by: Method::Nothing, rivals: Some(rivals) },
        }
    }

    /// What lies within the trust region: by local contrast, by the image, by silhouettes; or else the initial pose.
    fn decide_near(
        &mut self,
        pair: &ViewPair,
        memory: &mut Option<ColourRegistration>,
        found: Option<Conclusion>,
    ) -> Result<Decision> {
        let Scope::Near { region, noisy, silhouettes } = &mut self.scope else {
            return Ok(Decision::of(Method::Nothing));
        };
        match found {
            Some(Conclusion::ByColours(found)) if region.holds(pair, &found.pose) => {
                return Ok(Decision::of(Method::Image(found)));
            }
            Some(Conclusion::ByContrast(mut found)) if region.holds(pair, &found.best.pose) => {
                // What leaves no more than the image's own noise is a rival, however much of it neighbours share.
                local_contrast::rival(&mut found, *noisy);
                return Ok(Decision { by: Method::Contrast(Box::new(found.best)), rivals: Some(found.rivals) });
            }
            _ => {}
        }
        let (best, silhouettes) = (self.chosen.best.take(), silhouettes.take());
        Ok(Decision::of(match (best, silhouettes) {
            (Some(best), silhouettes) if silhouettes.is_none() || !silhouettes::is_painted(pair, &best) => {
                // All points follow the sample that candidates are registered by.
                let found = ColourRegistration::prepared(memory, pair).register_all(pair, *best)?;
                match region.holds(pair, &found.pose) {
                    true => Method::Image(Box::new(found)),
                    false => Method::Initial,
                }
            }
            (_, Some(found)) => Method::Silhouettes(found),
            (..) => Method::Initial,
        }))
    }
}

impl Scope {
    fn region(&self) -> Option<&TrustRegion> {
        match self {
            Self::Near { region, .. } => Some(region),
            Self::Everywhere(_) => None,
        }
    }
}
