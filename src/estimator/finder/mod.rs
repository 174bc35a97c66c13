//! The finder: finds one pose, everywhere or near an initial one, and decides on it (docs/method/README.md).
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
//!                        | yes          | no: local contrast (orthographic image); behind a pinhole silhouettes and a
//!                        |              |     second search or, near an initial pose, all of it again, held near it
//!                        v              v                                |
//!                    decision: pose, method, rivals <--------------------+
//! ```
//!
//! The work is cut into slices; near an initial pose, a slice may be a whole registration. Slices of search and registration are tasks that
//! depend only on the pair and themselves, so threads may take some of them ([`Worker`](super::Worker)). Results count in the order of the
//! tasks, not of their arrival, so the outcome is the same to the bit.
//!
//! | file | what it holds |
//! |---|---|
//! | `initial_pose/` | how an initial pose is treated: its region and prior, the registrations near it, the decision |
//! | `candidates` | the search, and the registration of its candidates |
//! | `task` | parts of the search that a worker may take, and their results |
//! | `local_optima` | ends of the registrations; the best pose and its rivals |
//! | `local_contrast`, `gradient_domain`, `silhouettes` | the methods for varying albedo |
//! | `varying_albedo`, `second_search` | behind a pinhole, if nothing is known about the pose: silhouettes and a second search |
//! | `halved_pair` | the halved pair in which large views are searched |
//!
//! The outcome is a [`Decision`].

mod candidates;
mod gradient_domain;
mod halved_pair;
pub mod initial_pose;
mod local_contrast;
pub mod local_optima;
mod second_search;
mod silhouettes;
pub mod task;
mod varying_albedo;

use nalgebra::Matrix3;

use crate::error::Result;
use crate::pose::{ContrastSearch, ImageGrid, Similarity};
use crate::reason::Activity;

use super::decision::{Decision, Method};
use super::pair::ViewPair;
use super::photometric::PhotometricRegistration;
use candidates::{Candidates, EVERYWHERE};
use gradient_domain::InGradients;
use initial_pose::{InitialEvidence, InitialRegistrations, Progress, TrustRegion, explains};
use local_contrast::{ByContrast, Conclusion};
use local_optima::{Choice, LocalOptima};
use task::{Finding, Task};
use varying_albedo::{Progressed, VaryingAlbedo};

pub use candidates::search;
pub use halved_pair::HalvedPair;

/// Share of the work that precedes local contrast.
const BEFORE_CONTRAST: f64 = 0.75;

/// Progress of the finder.
pub enum Advance {
    /// Not done: share of the work done, and the current activity.
    Ongoing(f64, Activity),
    Done(Decision),
    /// Nothing could be registered.
    Nothing,
}

/// The beginning near an initial pose.
pub enum Beginning {
    Done(Decision),
    Ongoing(Box<Finder>),
}

/// Where the pose is looked for.
enum Scope {
    /// A halved pair stands in for large views.
    Everywhere(Option<Box<HalvedPair>>),
    Near(Box<InitialEvidence>),
}

/// The current phase.
enum Phase {
    Nearby(Box<InitialRegistrations>),
    Candidates(Box<Candidates>),
    Contrast(Box<ByContrast>),
    Gradients(Box<InGradients>),
    VaryingAlbedo(Box<VaryingAlbedo>),
    Done,
}

/// Result of a slice.
enum Next {
    Phase(Phase),
    Decision(Decision),
    Nothing,
}

/// Memory of the photometric registration; the search of a halved pair needs none.
type Memory = Option<PhotometricRegistration>;

/// Finds a pose in slices; owns its memory.
pub struct Finder {
    scope: Scope,
    phase: Phase,
    chosen: Choice,
}

impl Finder {
    /// Starts with nothing known about the pose, in the pair or in its halved pair; `grid` belongs to the image that is searched.
    ///
    /// # Errors
    /// The errors of the search, if the views allow none.
    pub fn everywhere(
        pair: &ViewPair,
        memory: &mut Memory,
        halved: Option<Box<HalvedPair>>,
        grid: ImageGrid,
    ) -> Result<Self> {
        let (pair, photometric) = match &halved {
            Some(halved) => (&halved.pair, &halved.photometric),
            None => (pair, &*PhotometricRegistration::prepared(memory, pair)),
        };
        let optima = LocalOptima::new(EVERYWHERE.most, pair.residuals_of_noise(0.0));
        let may_vary = local_contrast::may_be_called_for(pair, photometric);
        let candidates = Candidates::new(search(pair, grid, photometric)?, optima, EVERYWHERE, may_vary);
        let phase = Phase::Candidates(Box::new(candidates));
        Ok(Self { scope: Scope::Everywhere(halved), phase, chosen: Choice::default() })
    }

    /// Registers from an initial pose. A result in its region that explains the image is the decision; otherwise a finder
    /// looks around the pose.
    pub fn near(pair: &ViewPair, region: &TrustRegion, photometric: &mut PhotometricRegistration) -> Beginning {
        let plain = photometric.register(pair, &region.initial).ok().map(Box::new);
        let plain = match plain.filter(|found| region.holds(pair, &found.pose)) {
            Some(found) if explains(pair, &found) => {
                return Beginning::Done(Decision::of(Method::Photometric(found)));
            }
            plain => plain,
        };
        let near = InitialEvidence::new(pair, region.clone(), plain.as_deref());
        let phase = Phase::Nearby(Box::new(InitialRegistrations::new(pair, region.clone(), plain)));
        Beginning::Ongoing(Box::new(Self { scope: Scope::Near(Box::new(near)), phase, chosen: Choice::default() }))
    }

    /// Whether it looks near an initial pose.
    pub const fn is_near(&self) -> bool {
        matches!(self.scope, Scope::Near(_))
    }

    /// The best pose so far: from a registration, or else from the search.
    pub fn best_pose(&self) -> Option<Similarity> {
        let best = match &self.phase {
            Phase::Candidates(candidates) => candidates.best_pose(),
            Phase::Nearby(_) => None,
            _ => return self.chosen.best.as_ref().map(|best| best.pose),
        };
        match &self.scope {
            Scope::Everywhere(Some(halved)) => best.map(|best| halved.pose_out(&best)),
            _ => best,
        }
    }

    /// Each rotation tried so far, with its score.
    pub fn scores(&self) -> Vec<(Matrix3<f64>, f64)> {
        match &self.phase {
            Phase::Candidates(candidates) => candidates.scores(),
            _ => Vec::new(),
        }
    }

    /// A task for a worker; `None` if none is ready.
    pub fn take(&mut self) -> Option<Task> {
        match &mut self.phase {
            Phase::Candidates(candidates) => candidates.take(),
            _ => None,
        }
    }

    /// Takes a worker's result.
    pub fn accept(&mut self, pair: &ViewPair, finding: Finding) {
        if let Phase::Candidates(candidates) = &mut self.phase {
            candidates.accept(finding, |pose| self.scope.holds(pair, pose));
        }
    }

    /// Progress of the search and the registrations.
    #[cfg(feature = "rayon")]
    pub fn progress(&self) -> Option<(f64, Activity)> {
        match &self.phase {
            Phase::Candidates(candidates) => Some(candidates.progress()),
            _ => None,
        }
    }

    /// Runs one slice.
    ///
    /// # Errors
    /// The errors of the search near an initial pose, if the views do not allow it. Nothing more can be found then.
    pub fn advance(&mut self, pair: &ViewPair, memory: &mut Memory) -> Result<Advance> {
        let next = match std::mem::replace(&mut self.phase, Phase::Done) {
            Phase::Nearby(nearby) => self.look_nearby(pair, memory, nearby)?,
            Phase::Candidates(candidates) => self.register_candidates(pair, memory, candidates)?,
            Phase::Contrast(contrast) => self.compare_contrast(pair, memory, contrast)?,
            Phase::Gradients(gradients) => self.refine(pair, memory, gradients)?,
            Phase::VaryingAlbedo(varying) => self.look_despite_albedo(pair, memory, varying),
            Phase::Done => Next::Nothing,
        };
        Ok(match next {
            Next::Decision(decision) => Advance::Done(decision),
            Next::Nothing => Advance::Nothing,
            Next::Phase(phase) => {
                let (share, activity) = phase.progress();
                self.phase = phase;
                Advance::Ongoing(share, activity)
            }
        })
    }

    /// A slice of the registrations near an initial pose.
    fn look_nearby(
        &mut self,
        pair: &ViewPair,
        memory: &mut Memory,
        mut nearby: Box<InitialRegistrations>,
    ) -> Result<Next> {
        let progress = nearby.advance(pair, PhotometricRegistration::prepared(memory, pair))?;
        match progress {
            Progress::Ongoing => Ok(Next::Phase(Phase::Nearby(nearby))),
            Progress::Explained(choice) => {
                self.scope.keep_silhouettes(&mut nearby);
                self.diagnose(pair, memory, choice, Vec::new())
            }
            Progress::Unexplained(candidates) => {
                self.scope.keep_silhouettes(&mut nearby);
                Ok(Next::Phase(Phase::Candidates(candidates)))
            }
        }
    }

    /// A slice of the search, or of the registration of a candidate.
    fn register_candidates(
        &mut self,
        pair: &ViewPair,
        memory: &mut Memory,
        mut candidates: Box<Candidates>,
    ) -> Result<Next> {
        let choice = match &mut self.scope {
            Scope::Everywhere(Some(halved)) => candidates.advance(&halved.pair, &mut halved.photometric, |_| true),
            scope => {
                let photometric = PhotometricRegistration::prepared(memory, pair);
                candidates.advance(pair, photometric, |pose| scope.holds(pair, pose))
            }
        };
        let Some(mut choice) = choice else { return Ok(Next::Phase(Phase::Candidates(candidates))) };
        let mut looked_at = candidates.poses();
        if let Scope::Everywhere(Some(halved)) = &self.scope {
            looked_at.iter_mut().for_each(|pose| *pose = halved.pose_out(pose));
            choice = halved.choice_out(choice);
        }
        self.diagnose(pair, memory, choice, looked_at)
    }

    /// Continues with local contrast if the albedo varies; `looked_at` holds the poses of the search.
    fn diagnose(
        &mut self,
        pair: &ViewPair,
        memory: &mut Memory,
        choice: Choice,
        mut looked_at: Vec<Similarity>,
    ) -> Result<Next> {
        self.chosen = choice;
        let photometric = PhotometricRegistration::prepared(memory, pair);
        let Some(cleaned) = local_contrast::cleaned(pair, photometric, self.chosen.best.as_deref()) else {
            return self.next_method(pair, memory, None);
        };
        let starts = match &self.scope {
            Scope::Everywhere(_) => {
                let Choice { best, rivals, .. } = &self.chosen;
                looked_at.extend(best.iter().map(|best| best.pose).chain(rivals.iter().copied()));
                local_contrast::of_all_sizes(pair, &looked_at)
            }
            Scope::Near(near) => local_contrast::around(pair, &near.region.initial),
        };
        let search = ContrastSearch::new(&photometric.contrast_problem(pair, cleaned.image(pair)), starts);
        Ok(Next::Phase(Phase::Contrast(Box::new(ByContrast { cleaned, search }))))
    }

    /// A slice of the search by local contrast.
    fn compare_contrast(
        &mut self,
        pair: &ViewPair,
        memory: &mut Memory,
        mut contrast: Box<ByContrast>,
    ) -> Result<Next> {
        let ByContrast { cleaned, search } = &mut *contrast;
        let photometric = &*PhotometricRegistration::prepared(memory, pair);
        if !search.advance(&photometric.contrast_problem(pair, cleaned.image(pair))) {
            return Ok(Next::Phase(Phase::Contrast(contrast)));
        }
        match local_contrast::conclude(pair, photometric, cleaned, search) {
            Some(Conclusion::Contrast(best, rivals)) => {
                let gradients = InGradients::new(pair, photometric, contrast.cleaned, (best, rivals));
                Ok(Next::Phase(Phase::Gradients(Box::new(gradients))))
            }
            Some(Conclusion::Photometric(decision)) => self.next_method(pair, memory, Some(decision)),
            None => self.next_method(pair, memory, None),
        }
    }

    /// A slice of the registration in the gradient domain.
    fn refine(&mut self, pair: &ViewPair, memory: &mut Memory, mut gradients: Box<InGradients>) -> Result<Next> {
        let photometric = &*PhotometricRegistration::prepared(memory, pair);
        if !gradients.advance(pair, photometric) {
            return Ok(Next::Phase(Phase::Gradients(gradients)));
        }
        let found = gradients.decision(pair, photometric);
        self.next_method(pair, memory, Some(found))
    }

    /// A slice of silhouettes and second search without an initial pose.
    fn look_despite_albedo(&mut self, pair: &ViewPair, memory: &mut Memory, mut varying: Box<VaryingAlbedo>) -> Next {
        let photometric = PhotometricRegistration::prepared(memory, pair);
        let halved = match &mut self.scope {
            Scope::Everywhere(halved) => halved.as_deref_mut(),
            Scope::Near(_) => None,
        };
        match varying.advance(pair, photometric, halved, self.chosen.best.as_deref()) {
            Progressed::Ongoing => Next::Phase(Phase::VaryingAlbedo(varying)),
            Progressed::Done(Some(decision)) => Next::Decision(decision),
            Progressed::Done(None) => of_single_albedo(pair, photometric, std::mem::take(&mut self.chosen)),
        }
    }

    /// The decision, or the method that comes next after local contrast, which `found` a pose or did not.
    fn next_method(&mut self, pair: &ViewPair, memory: &mut Memory, found: Option<Decision>) -> Result<Next> {
        let photometric = PhotometricRegistration::prepared(memory, pair);
        if let Scope::Near(near) = &mut self.scope {
            let choice = std::mem::take(&mut self.chosen);
            if found.is_none() && near.begins_again(pair, photometric, &choice) {
                return Ok(Next::Phase(Phase::Nearby(Box::new(near.begin_again(pair, photometric)))));
            }
            return near.conclude(pair, photometric, choice, found).map(Next::Decision);
        }
        if let Some(decision) = found {
            return Ok(Next::Decision(decision));
        }
        let are_called_for = silhouettes::are_called_for(pair, self.chosen.best.as_deref());
        Ok(match are_called_for.then(|| VaryingAlbedo::new(pair, photometric)).flatten() {
            Some(varying) => Next::Phase(Phase::VaryingAlbedo(Box::new(varying))),
            None => of_single_albedo(pair, photometric, std::mem::take(&mut self.chosen)),
        })
    }
}

/// The decision for the best registration under a single albedo.
fn of_single_albedo(pair: &ViewPair, photometric: &mut PhotometricRegistration, choice: Choice) -> Next {
    let Choice { best: Some(mut best), rivals, ends } = choice else { return Next::Nothing };
    photometric.complete_sigmas(pair, &mut best);
    best.uncertainty.add_spread(&best.pose, &ends);
    Next::Decision(Decision { rivals: Some(rivals), ends, ..Decision::of(Method::Photometric(best)) })
}

impl Scope {
    /// Keeps the pose from silhouettes for the decision.
    fn keep_silhouettes(&mut self, nearby: &mut InitialRegistrations) {
        if let Self::Near(near) = self {
            near.silhouettes = nearby.silhouettes();
        }
    }

    /// Whether a pose may be the answer.
    fn holds(&self, pair: &ViewPair, pose: &Similarity) -> bool {
        match self {
            Self::Near(near) => near.region.holds(pair, pose),
            Self::Everywhere(_) => true,
        }
    }
}

impl Phase {
    /// Share of the work done, and the current activity.
    fn progress(&self) -> (f64, Activity) {
        match self {
            Self::Nearby(_) => (0.0, Activity::Registering),
            Self::Candidates(candidates) => candidates.progress(),
            Self::Contrast(contrast) => {
                (BEFORE_CONTRAST + (1.0 - BEFORE_CONTRAST) * contrast.search.share(), Activity::ComparingContrast)
            }
            Self::Gradients(_) => (1.0, Activity::ComparingContrast),
            Self::VaryingAlbedo(varying) => {
                let (share, activity) = varying.progress();
                (BEFORE_CONTRAST + (1.0 - BEFORE_CONTRAST) * share, activity)
            }
            Self::Done => (1.0, Activity::Registering),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::{Options, Start};
    use crate::pose::Angles;
    use crate::scenes::{SampleRequest, Scene, surface};
    use crate::view::Size;

    /// So few points that the registration of a candidate already takes all of them, and none follows.
    #[test]
    fn the_sigmas_of_a_decision_are_those_of_a_registration_with_the_jackknife() {
        let request = SampleRequest {
            size: Size { width: 56, height: 56 },
            rotation: Angles { beta: 15.0, ..Angles::default() }.rotation(),
            noise: 0.01,
            ..SampleRequest::default()
        };
        let sample = Scene::new(&surface("bust").unwrap()).unwrap().sample(&request).unwrap();
        let options = Options { start: Start::Search, ..Options::default() };
        let pair = ViewPair::new(sample.colour_image(), &sample.depth_map(), options).unwrap();
        let mut memory = None;
        let grid = ImageGrid::new(&pair.image).unwrap();
        let mut finder = Finder::everywhere(&pair, &mut memory, None, grid).unwrap();
        let decision = loop {
            match finder.advance(&pair, &mut memory).unwrap() {
                Advance::Ongoing(..) => {}
                Advance::Done(decision) => break decision,
                Advance::Nothing => panic!("nothing was found"),
            }
        };
        let found = decision.photometric().expect("a photometric registration");
        assert!(!found.sampled);
        let again = PhotometricRegistration::prepared(&mut memory, &pair).register(&pair, &found.pose).unwrap();
        let ratio = found.covariance.trace() / again.covariance.trace();
        assert!((0.8..1.25).contains(&ratio), "{ratio}");
    }
}
