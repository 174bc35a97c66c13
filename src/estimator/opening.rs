//! The opening: search everywhere, register the best candidates, keep the one that explains most, remember its rivals.
//!
//! Ends of different registrations see different points, so their costs cannot be compared; what they are worth is
//! gain = N^(1/3) ln(spread / noise): by how much the pose explains the colours better than a constant would, with a
//! root of the number of visible points against overlaps that are tiny and thus easily explained. Measured on the ends
//! of 300 random scenes at 96x96 (Mozart, four scanned animals, three built-in surfaces; natural lights, free scale):
//! any power from 0.1 to 0.6 puts a right end first in all of them, none at all errs in one; of two ends a few degrees
//! apart, the square root favours the one that merely sees more. Rivals of right winners leave 1.25 times their noise or
//! more, so an end that leaves nothing but the noise of the image comes before one that sees more but leaves so much.

use crate::error::Result;
use crate::pose::{PhotometricReport, Search, Similarity, sort_down};
use crate::view::DepthView;

use super::joint::{COLLAPSE, Given, Joint};

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
#[expect(clippy::large_enum_variant, reason = "one value at a time, moved once")]
pub enum Look {
    /// Not done; the share of the work that is, and what is being done.
    Ongoing(f64, &'static str),
    /// The best pose, if any could be registered.
    Done(Option<Outcome>),
}

/// What the opening found.
pub struct Outcome {
    pub best: PhotometricReport,
    /// Poses that the data can't tell from the best, best first.
    pub rivals: Vec<Similarity>,
}

#[derive(Clone)]
struct End {
    report: PhotometricReport,
    gain: f64,
    witnesses: u32,
}

impl End {
    fn is_apart(&self, other: &Self) -> bool {
        self.report.pose.degrees_to(&other.report.pose) >= SAME_END
    }

    /// Whether it explains about as many points as `best` nearly as well: up to `factor` times the noise.
    fn rivals(&self, best: &Self, factor: f64) -> bool {
        self.report.visible as f64 >= RIVAL_VISIBLE * best.report.visible as f64
            && self.report.noise <= factor * best.report.noise
    }
}

/// The opening in slices; owns its memory.
pub struct Opening {
    search: Search,
    /// Standard deviation of log S over the mask.
    spread: f64,
    /// Standard deviation of the noise of log S.
    noise: f64,
    searching: bool,
    /// The next candidate, and whether its registration has begun.
    next: usize,
    begun: bool,
    tried: usize,
    ends: Vec<End>,
}

impl Opening {
    /// `depth` is the view whose normals are searched by.
    ///
    /// # Errors
    /// Those of [`Search::new`].
    pub fn new(given: &Given<'_>, depth: &DepthView, scale: Option<f64>, unit_scale: f64, seed: u64) -> Result<Self> {
        Ok(Self {
            search: Search::new(given.image, depth, given.light, scale, unit_scale, seed)?,
            spread: given.image.log_spread(),
            noise: given.image.log_noise(),
            searching: true,
            next: 0,
            begun: false,
            tried: 0,
            ends: Vec::with_capacity(MOST_TRIED),
        })
    }

    /// One slice: a part of the search, or a step of a registration.
    pub fn advance(&mut self, joint: &mut Joint, given: &Given<'_>) -> Look {
        if self.searching {
            let share = self.search.advance().share;
            self.searching = share < 1.0;
            return Look::Ongoing(SEARCH_SHARE * share, "comparing rotations, translations and scales");
        }
        self.skip_known();
        let candidates = self.search.candidates();
        let enough = self.tried >= MOST_TRIED || (self.tried >= FEW_TRIED && self.is_convincing());
        if self.next >= candidates.len() || enough {
            return Look::Done(self.outcome());
        }
        // A candidate that cannot be registered is no error of the pair.
        let outcome = match self.begun {
            false => joint.begin(given, &candidates[self.next].pose).map(|()| None),
            true => joint.advance(given),
        };
        self.begun = matches!(outcome, Ok(None));
        if !self.begun {
            let start = candidates[self.next].pose;
            let found = outcome.ok().flatten().filter(|report| report.pose.growth_from(&start) < COLLAPSE);
            (self.next, self.tried) = (self.next + 1, self.tried + 1);
            if let Some(report) = found {
                self.enter(report);
            }
        }
        Look::Ongoing(registered_share(self.tried), "registering the best candidates")
    }

    /// Passes over candidates next to an end that has witnesses enough.
    fn skip_known(&mut self) {
        let candidates = self.search.candidates();
        let known = |pose: &Similarity| {
            let near = |end: &End| end.witnesses >= WITNESSES && end.report.pose.degrees_to(pose) < CATCHMENT;
            self.ends.iter().any(near)
        };
        while !self.begun && candidates.get(self.next).is_some_and(|candidate| known(&candidate.pose)) {
            self.next += 1;
        }
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
            let clear = best.report.noise < UNEXPLAINED * self.spread || most;
            best.witnesses >= WITNESSES && alone && clear
        })
    }

    /// Remembers where a registration ended: the better of two that are one.
    fn enter(&mut self, report: PhotometricReport) {
        let gain = (report.visible as f64).cbrt() * (self.spread / report.noise).ln();
        if !gain.is_finite() {
            return;
        }
        match self.ends.iter_mut().find(|end| end.report.pose.degrees_to(&report.pose) < SAME_END) {
            Some(end) => {
                end.witnesses += 1;
                if gain > end.gain {
                    (end.report, end.gain) = (report, gain);
                }
            }
            None => self.ends.push(End { report, gain, witnesses: 1 }),
        }
    }

    fn outcome(&mut self) -> Option<Outcome> {
        sort_down(&mut self.ends, |end| end.gain);
        // Nothing but the image's noise is left by it, and far more by the first.
        let wins = |first: &End, end: &End| {
            end.report.noise <= self.noise && end.rivals(first, 1.0) && !first.rivals(end, RIVAL_NOISE)
        };
        if let Some(index) = self.ends.iter().position(|end| wins(&self.ends[0], end)) {
            self.ends.swap(0, index);
        }
        let mut ends = self.ends.drain(..);
        let best = ends.next().filter(|best| best.gain > 0.0)?;
        let rivals = ends
            .filter(|end| end.is_apart(&best) && end.rivals(&best, RIVAL_NOISE))
            .map(|end| end.report.pose)
            .take(MOST_RIVALS)
            .collect();
        Some(Outcome { best: best.report, rivals })
    }
}

/// Share of the opening that is done after so many registrations.
fn registered_share(tried: usize) -> f64 {
    let few = tried.min(FEW_TRIED);
    let more = (tried - few) as f64 / (MOST_TRIED - FEW_TRIED) as f64;
    SEARCH_SHARE + FEW_SHARE * few as f64 / FEW_TRIED as f64 + (1.0 - SEARCH_SHARE - FEW_SHARE) * more
}
