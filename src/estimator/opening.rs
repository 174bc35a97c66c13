//! The opening: search everywhere, register the best candidates, keep the one that explains most, remember its rivals.
//!
//! Ends of different registrations see different points, so their costs cannot be compared; what they are worth is
//! gain = N^(1/3) ln(spread / noise): by how much the pose explains the colours better than a constant would, with a
//! root of the number of visible points against overlaps that are tiny and thus easily explained. Measured on the ends
//! of 300 random scenes at 96x96 (Mozart, four scanned animals, three built-in surfaces; natural lights, free scale):
//! any power from 0.1 to 0.6 puts a right end first in all of them, none at all errs in one; of two ends a few degrees
//! apart, the square root favours the one that merely sees more. Rivals of right winners leave 1.25 times their noise or
//! more, so an end that leaves nothing but the noise of the image comes before one that sees more but leaves so much.
//!
//! All of it falls into tasks that depend on nothing but the pair and themselves, so that others may do some of them
//! ([`Helper`](super::Helper)). What they find counts in the order of the tasks, however it comes in: the outcome is the
//! same to the bit.

use crate::numeric::sort_descending;
use crate::pose::{PhotometricReport, Search, Similarity, TaskResults};

use super::joint::{Attempt, Given, Joint};
use super::task::{Finding, Found, Registered, Task, Work};

/// Power of the number of visible points. A cube root of its own would be 1 kB of the download.
const THIRD: f64 = 1.0 / 3.0;
/// Registrations after which an end that convinces is believed, and registrations at most.
const FEW_TRIED: usize = 10;
const MOST_TRIED: usize = 40;
/// An end convinces when the noise of every other one that sees as much is larger by this factor.
const CONVINCING_NOISE: f64 = 2.0;
/// Share of the colours' spread that is nearly nothing: noise of 1 % under lights of good contrast.
const UNEXPLAINED: f64 = 0.05;
/// Ends nearer than this are one end, degrees.
const SAME_END: f64 = 3.0;
/// An end reached so often needs no more witnesses: candidates next to it are passed over.
const WITNESSES: u32 = 2;
/// Candidates nearer than this to such an end would only reach it again, degrees.
const CATCHMENT: f64 = 15.0;
/// A rival leaves a noise of at most so many times the winner's ..
const RIVAL_NOISE: f64 = 1.25;
/// .. on at least this share of its points.
const RIVAL_VISIBLE: f64 = 0.5;
/// Rivals reported at most.
const MOST_RIVALS: usize = 5;
/// Share of the opening's progress that the search itself takes ..
const SEARCH_SHARE: f64 = 0.5;
/// .. and the first few registrations: what comes after them may be spared, and then progress leaps to its end.
const FEW_SHARE: f64 = 0.25;

/// Where the opening stands.
pub enum Look {
    /// Not done; the share of the work that is, and what is being done.
    Ongoing(f64, &'static str),
    /// The best pose, if any could be registered.
    Done(Option<Outcome>),
}

/// What the opening found.
pub struct Outcome {
    pub best: Box<PhotometricReport>,
    /// Poses that the data can't tell from the best, best first.
    pub rivals: Vec<Similarity>,
}

/// Where registrations end.
#[derive(Clone)]
struct End {
    /// The candidate that ended best here.
    candidate: usize,
    registered: Registered,
    gain: f64,
    witnesses: u32,
}

impl End {
    fn is_apart(&self, other: &Self) -> bool {
        self.registered.pose.degrees_to(&other.registered.pose) >= SAME_END
    }

    /// Whether it explains about as many points as `best` nearly as well: up to `factor` times the noise.
    fn rivals(&self, best: &Self, factor: f64) -> bool {
        self.registered.visible >= RIVAL_VISIBLE * best.registered.visible
            && self.registered.noise <= factor * best.registered.noise
    }
}

/// The opening in slices; owns its memory.
pub struct Opening {
    search: Search,
    /// Standard deviation of log S over the mask.
    spread: f64,
    /// Standard deviation of the noise of log S.
    noise: f64,
    /// What became of each candidate; `None` where it could not be registered.
    registrations: TaskResults<Option<Registered>>,
    /// The next candidate to count, and how many have been counted.
    next: usize,
    tried: usize,
    ends: Vec<End>,
    /// The candidate whose registration is under way here.
    begun: Option<usize>,
    decision: Option<Decision>,
}

/// The best end, if any is worth something, and its rivals.
struct Decision {
    best: Option<End>,
    rivals: Vec<Similarity>,
}

impl Opening {
    pub fn new(given: &Given<'_>, search: Search) -> Self {
        Self {
            search,
            spread: given.image.log_spread(),
            noise: given.image.log_noise(),
            registrations: TaskResults::new(0),
            next: 0,
            tried: 0,
            ends: Vec::with_capacity(MOST_TRIED),
            begun: None,
            decision: None,
        }
    }

    /// A task for somebody else; `None` while none can be begun.
    pub fn take(&mut self) -> Option<Task> {
        if let Some(task) = self.search.take() {
            return Some(Task(Work::Search(task)));
        }
        if self.decision.is_some() {
            return None;
        }
        let Self { registrations, search, ends, next, begun, .. } = self;
        let candidates = search.candidates();
        let wanted = |index| index >= *next && Some(index) != *begun && !is_known(ends, &candidates[index].pose);
        let index = registrations.take(wanted)?;
        Some(Task(Work::Register(index, candidates[index].pose)))
    }

    /// What somebody else has found.
    pub fn accept(&mut self, finding: Finding) {
        match finding.0 {
            Found::Search(finding) => self.search.accept(finding),
            Found::Registered(index, registered) => self.registrations.put(index, registered),
        }
        self.count();
    }

    /// One slice: a part of the search, or a step of a registration.
    pub fn advance(&mut self, joint: &mut Joint, given: &Given<'_>) -> Look {
        if self.is_searching() {
            self.search.advance();
            self.count();
        } else if let Some(decision) = self.decision.take() {
            return self.conclude(joint, given, decision);
        } else {
            self.register(joint, given);
            self.count();
        }
        self.look()
    }

    fn is_searching(&self) -> bool {
        !self.search.is_done()
    }

    fn look(&self) -> Look {
        if self.is_searching() {
            let share = self.search.progress().share;
            return Look::Ongoing(SEARCH_SHARE * share, "comparing rotations, translations and scales");
        }
        Look::Ongoing(registered_share(self.tried), "registering the best candidates")
    }

    /// A step of the registration that is under way here, or the beginning of the next one.
    fn register(&mut self, joint: &mut Joint, given: &Given<'_>) {
        let candidates = self.search.candidates();
        let wanted = |index: usize| index >= self.next && !is_known(&self.ends, &candidates[index].pose);
        let begun = self.begun.filter(|&index| wanted(index) && self.registrations.get(index).is_none());
        let Some(index) = begun.or_else(|| self.registrations.next(wanted)) else { return };
        if let Attempt::Ended(report) = self.attempt(index, joint, given) {
            self.registrations.put(index, report.map(Registered::of));
        }
    }

    /// A step of one registration; another one that was under way here is dropped.
    fn attempt(&mut self, candidate: usize, joint: &mut Joint, given: &Given<'_>) -> Attempt {
        let start = self.search.candidates()[candidate].pose;
        let attempt = joint.attempt(given, &start, self.begun != Some(candidate));
        self.begun = matches!(attempt, Attempt::Ongoing).then_some(candidate);
        attempt
    }

    /// Counts what has become of the candidates, in their order, up to the first that is still open.
    fn count(&mut self) {
        if self.is_searching() || self.decision.is_some() {
            return;
        }
        let count = self.search.candidates().len();
        if self.registrations.len() != count {
            self.registrations = TaskResults::new(count);
        }
        while !self.is_exhausted() {
            if is_known(&self.ends, &self.search.candidates()[self.next].pose) {
                self.next += 1;
                continue;
            }
            let Some(registered) = self.registrations.get(self.next) else { return };
            (self.next, self.tried) = (self.next + 1, self.tried + 1);
            if let Some(registered) = registered.clone() {
                self.enter(self.next - 1, registered);
            }
        }
        self.decision = Some(decide(std::mem::take(&mut self.ends), self.noise));
    }

    /// Whether no further candidate counts.
    fn is_exhausted(&self) -> bool {
        let enough = self.tried >= MOST_TRIED || (self.tried >= FEW_TRIED && self.is_convincing());
        self.next >= self.search.candidates().len() || enough
    }

    /// Whether the best end has no rival by far, and either explains nearly all or is where most registrations end,
    /// though not all.
    fn is_convincing(&self) -> bool {
        let best = self.ends.iter().max_by(|a, b| a.gain.total_cmp(&b.gain));
        best.is_some_and(|best| {
            let mut others = self.ends.iter().filter(|end| end.is_apart(best)).peekable();
            // Where all registrations end in one place, the candidates may just be alike.
            let compared = others.peek().is_some();
            let alone = !others.any(|end| end.rivals(best, CONVINCING_NOISE));
            let most = compared && 2 * best.witnesses as usize >= self.tried;
            let clear = best.registered.noise < UNEXPLAINED * self.spread || most;
            best.witnesses >= WITNESSES && alone && clear
        })
    }

    /// Remembers where a registration ended: the better of two that are one.
    fn enter(&mut self, candidate: usize, registered: Registered) {
        let gain = registered.visible.powf(THIRD) * (self.spread / registered.noise).ln();
        if !gain.is_finite() {
            return;
        }
        match self.ends.iter_mut().find(|end| end.registered.pose.degrees_to(&registered.pose) < SAME_END) {
            Some(end) => {
                end.witnesses += 1;
                if gain > end.gain {
                    *end = End { candidate, registered, gain, witnesses: end.witnesses };
                }
            }
            None => self.ends.push(End { candidate, registered, gain, witnesses: 1 }),
        }
    }

    /// The outcome, once the best one's whole report is here: a scout brings only what tells one end from another.
    fn conclude(&mut self, joint: &mut Joint, given: &Given<'_>, decision: Decision) -> Look {
        let Decision { best: Some(mut best), rivals } = decision else { return Look::Done(None) };
        if best.registered.report.is_none() {
            match self.attempt(best.candidate, joint, given) {
                Attempt::Ended(report) => best.registered.report = report,
                Attempt::Ongoing => {
                    self.decision = Some(Decision { best: Some(best), rivals });
                    return self.look();
                }
            }
        }
        Look::Done(best.registered.report.map(|best| Outcome { best, rivals }))
    }
}

/// The best of the ends and those that the data can't tell from it, where the image has so much noise.
fn decide(mut ends: Vec<End>, image_noise: f64) -> Decision {
    sort_descending(&mut ends, |end| end.gain);
    // Nothing but the image's noise is left by it, and far more by the first.
    let wins = |first: &End, end: &End| {
        end.registered.noise <= image_noise && end.rivals(first, 1.0) && !first.rivals(end, RIVAL_NOISE)
    };
    if let Some(index) = ends.iter().position(|end| wins(&ends[0], end)) {
        ends.swap(0, index);
    }
    let mut ends = ends.into_iter();
    let Some(best) = ends.next().filter(|best| best.gain > 0.0) else {
        return Decision { best: None, rivals: Vec::new() };
    };
    let rivals = ends
        .filter(|end| end.is_apart(&best) && end.rivals(&best, RIVAL_NOISE))
        .map(|end| end.registered.pose)
        .take(MOST_RIVALS)
        .collect();
    Decision { best: Some(best), rivals }
}

/// Whether a candidate lies next to an end that has witnesses enough.
fn is_known(ends: &[End], pose: &Similarity) -> bool {
    let near = |end: &End| end.witnesses >= WITNESSES && end.registered.pose.degrees_to(pose) < CATCHMENT;
    ends.iter().any(near)
}

/// Share of the opening that is done after so many registrations.
fn registered_share(tried: usize) -> f64 {
    let few = tried.min(FEW_TRIED);
    let more = (tried - few) as f64 / (MOST_TRIED - FEW_TRIED) as f64;
    SEARCH_SHARE + FEW_SHARE * few as f64 / FEW_TRIED as f64 + (1.0 - SEARCH_SHARE - FEW_SHARE) * more
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::*;

    /// An end so many degrees about z, with what it sees and leaves.
    fn end(degrees: f64, visible: f64, noise: f64) -> End {
        let rotation = Rotation3::new(Vector3::z() * degrees.to_radians()).into_inner();
        let pose = Similarity { rotation, ..Similarity::identity() };
        let registered = Registered { pose, visible, noise, report: None };
        End { candidate: degrees as usize, registered, gain: visible.powf(THIRD) * (1.0 / noise).ln(), witnesses: 2 }
    }

    fn winner(ends: &[End], image_noise: f64) -> (Option<usize>, usize) {
        let Decision { best, rivals } = decide(ends.to_vec(), image_noise);
        (best.map(|best| best.candidate), rivals.len())
    }

    #[test]
    fn what_leaves_only_the_image_s_noise_comes_before_what_sees_more() {
        let (large, exact) = (end(40.0, 1000.0, 0.02), end(0.0, 600.0, 0.0099));
        assert!(large.gain > exact.gain);
        assert_eq!(winner(&[large.clone(), exact.clone()], 0.01), (Some(0), 0));
        // Not where the image is so clean that there is more to explain ..
        assert_eq!(winner(&[large.clone(), exact], 0.005).0, Some(40));
        // .. nor where the first leaves hardly more, or the other sees little.
        assert_eq!(winner(&[end(40.0, 1000.0, 0.012), end(0.0, 600.0, 0.0099)], 0.01), (Some(40), 1));
        assert_eq!(winner(&[large, end(0.0, 400.0, 0.0099)], 0.01), (Some(40), 0));
    }

    #[test]
    fn rivals_are_apart_and_ends_that_explain_nothing_win_nothing() {
        let ends = [end(0.0, 900.0, 0.01), end(2.0, 800.0, 0.01), end(30.0, 500.0, 0.012), end(60.0, 900.0, 0.02)];
        assert_eq!(winner(&ends, 0.0), (Some(0), 1));
        assert_eq!(winner(&[end(0.0, 900.0, 1.1)], 0.0), (None, 0));
        assert_eq!(winner(&[], 0.0), (None, 0));
    }
}
