//! Where registrations from different candidates ended: which of these poses is the answer, and which are its rivals.
//!
//! Registrations that end in different poses see different points, so their objectives cannot be compared; what they
//! are worth is gain = N^(1/3) ln(spread / noise): by how much the pose explains the colours better than a constant
//! would, with a root of the number of visible points against overlaps that are tiny and thus easily explained.
//! Measured on the local optima of 300 random scenes at 96x96 (Mozart, four scanned animals, three built-in surfaces;
//! natural lights, free scale): any power from 0.1 to 0.6 puts a right pose first in all of them, none at all errs in
//! one; of two a few degrees apart, the square root favours the one that merely sees more. Rivals of right winners
//! leave 1.25 times their noise or more, so a pose that leaves nothing but the noise of the image comes before one that
//! sees more but leaves so much.

use crate::diagnosis::{Alternative, Diagnosis, Residuals};
use crate::pose::{PhotometricReport, Similarity};

/// Where a registration began.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The initial pose itself, which was evaluated and not registered.
    Initial,
    /// A pose near the initial one, tried before the search.
    Nearby,
    /// A candidate of the search, by its number.
    Candidate(usize),
}

/// Power of the number of visible points. A cube root of its own would be 1 kB of the download.
const THIRD: f64 = 1.0 / 3.0;
/// A local optimum convinces when the noise of every other one that sees as much is larger by this factor.
const CONVINCING_NOISE: f64 = 2.0;
/// Registrations that end nearer than this have found one optimum, degrees.
const SAME_OPTIMUM: f64 = 3.0;
/// An optimum reached so often needs no more support: candidates next to it are passed over.
const ENOUGH_SUPPORT: u32 = 2;
/// Candidates nearer than this to such an optimum would only reach it again, degrees.
const CATCHMENT: f64 = 15.0;
/// A rival leaves a noise of at most so many times the winner's ..
const RIVAL_NOISE: f64 = 1.25;
/// .. on at least this share of its points.
const RIVAL_VISIBLE: f64 = 0.5;
/// Rivals reported at most.
const MOST_RIVALS: usize = 5;

/// What tells one registration from another.
#[derive(Clone, Debug)]
pub struct RegisteredCandidate {
    pub pose: Similarity,
    /// Number of visible points.
    pub visible: f64,
    /// Standard deviation of what is left of log S.
    pub noise: f64,
    /// All of it, where it was made in this thread.
    pub report: Option<Box<PhotometricReport>>,
}

impl RegisteredCandidate {
    pub fn of(report: Box<PhotometricReport>) -> Self {
        Self { pose: report.pose, visible: report.visible as f64, noise: report.noise, report: Some(report) }
    }
}

/// A pose where registrations end.
#[derive(Clone)]
pub struct LocalOptimum {
    /// Of the registration that ended best here.
    pub origin: Origin,
    pub registered: RegisteredCandidate,
    gain: f64,
    /// Number of registrations that ended here.
    support: u32,
}

impl LocalOptimum {
    fn is_apart(&self, other: &Self) -> bool {
        self.registered.pose.degrees_to(&other.registered.pose) >= SAME_OPTIMUM
    }

    /// Whether it explains about as many points as `best` nearly as well: up to `factor` times the noise.
    fn rivals(&self, best: &Self, factor: f64) -> bool {
        self.registered.visible >= RIVAL_VISIBLE * best.registered.visible
            && self.registered.noise <= factor * best.registered.noise
    }
}

/// The best optimum, if it explains anything, and its rivals.
pub struct Ranking {
    pub best: Option<LocalOptimum>,
    pub rivals: Vec<Similarity>,
}

/// The choice among the local optima.
#[derive(Default)]
pub struct Choice {
    /// The best pose by a single albedo, if any could be registered; none where the initial pose is as good.
    pub best: Option<Box<PhotometricReport>>,
    /// Poses that the data cannot tell from the best, best first.
    pub rivals: Vec<Similarity>,
}

impl Choice {
    /// Of the best optimum, whose report is there.
    pub fn of(Ranking { best, rivals }: Ranking) -> Self {
        let best = best.filter(|best| best.origin != Origin::Initial).and_then(|best| best.registered.report);
        Self { best, rivals }
    }
}

/// All optima that registrations have found so far.
pub struct LocalOptima {
    optima: Vec<LocalOptimum>,
    /// Of the image: its noise and its spread.
    image: Residuals,
}

impl LocalOptima {
    /// None yet, of this image; memory for `most`.
    pub fn new(most: usize, image: Residuals) -> Self {
        Self { optima: Vec::with_capacity(most), image }
    }

    /// What an optimum leaves of the image.
    fn residuals(&self, optimum: &LocalOptimum) -> Residuals {
        Residuals { noise: optimum.registered.noise, ..self.image }
    }

    /// Enters where a registration ended: the better of two that are one.
    pub fn enter(&mut self, origin: Origin, registered: RegisteredCandidate) {
        let gain = registered.visible.powf(THIRD) * (self.image.spread / registered.noise).ln();
        if !gain.is_finite() {
            return;
        }
        let is_same = |known: &&mut LocalOptimum| known.registered.pose.degrees_to(&registered.pose) < SAME_OPTIMUM;
        match self.optima.iter_mut().find(is_same) {
            Some(known) => {
                known.support += 1;
                if gain > known.gain {
                    *known = LocalOptimum { origin, registered, gain, support: known.support };
                }
            }
            None => self.optima.push(LocalOptimum { origin, registered, gain, support: 1 }),
        }
    }

    /// The pose of the best optimum so far.
    pub fn best(&self) -> Option<Similarity> {
        self.optima.iter().max_by(|a, b| a.gain.total_cmp(&b.gain)).map(|best| best.registered.pose)
    }

    /// Whether a candidate lies next to an optimum that has support enough.
    pub fn is_known(&self, pose: &Similarity) -> bool {
        let near = |known: &LocalOptimum| {
            known.support >= ENOUGH_SUPPORT && known.registered.pose.degrees_to(pose) < CATCHMENT
        };
        self.optima.iter().any(near)
    }

    /// Whether after so many registrations the best optimum has no rival by far, and either explains nearly all or is
    /// where most registrations end, though not all.
    pub fn is_convincing(&self, tried: usize) -> bool {
        let best = self.optima.iter().max_by(|a, b| a.gain.total_cmp(&b.gain));
        best.is_some_and(|best| {
            let mut others = self.optima.iter().filter(|other| other.is_apart(best)).peekable();
            // Where all registrations end in one place, the candidates may just be alike.
            let compared = others.peek().is_some();
            let alone = !others.any(|other| other.rivals(best, CONVINCING_NOISE));
            let most = compared && 2 * best.support as usize >= tried;
            let clear = self.residuals(best).is_next_to_nothing() || most;
            best.support >= ENOUGH_SUPPORT && alone && clear
        })
    }

    /// Whether all optima leave far more than light, noise and errors of normals do on an object of one albedo.
    pub fn are_of_varying_albedo(&self) -> bool {
        let varies = |optimum| self.residuals(optimum).diagnose(Alternative::LocalContrast) == Diagnosis::VaryingAlbedo;
        self.optima.iter().all(varies)
    }

    /// The best optimum and those that the data can't tell from it, given the noise of the image.
    pub fn ranked(&mut self) -> Ranking {
        let (mut optima, noise) = (std::mem::take(&mut self.optima), self.image.image_noise);
        optima.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        // Nothing but the image's noise is left by it, and far more by the first.
        let wins = |first: &LocalOptimum, other: &LocalOptimum| {
            other.registered.noise <= noise && other.rivals(first, 1.0) && !first.rivals(other, RIVAL_NOISE)
        };
        if let Some(index) = optima.iter().position(|other| wins(&optima[0], other)) {
            optima.swap(0, index);
        }
        let mut optima = optima.into_iter();
        let Some(best) = optima.next().filter(|best| best.gain > 0.0) else {
            return Ranking { best: None, rivals: Vec::new() };
        };
        let rivals = optima
            .filter(|other| other.is_apart(&best) && other.rivals(&best, RIVAL_NOISE))
            .map(|other| other.registered.pose)
            .take(MOST_RIVALS)
            .collect();
        Ranking { best: Some(best), rivals }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::*;

    /// An optimum so many degrees about z, with what it sees and leaves.
    fn optimum(degrees: f64, visible: f64, noise: f64) -> LocalOptimum {
        let rotation = Rotation3::new(Vector3::z() * degrees.to_radians()).into_inner();
        let pose = Similarity { rotation, ..Similarity::identity() };
        let registered = RegisteredCandidate { pose, visible, noise, report: None };
        let gain = visible.powf(THIRD) * (1.0 / noise).ln();
        LocalOptimum { origin: Origin::Candidate(degrees as usize), registered, gain, support: 2 }
    }

    fn winner(optima: &[LocalOptimum], noise: f64) -> (Option<Origin>, usize) {
        let mut all = LocalOptima {
            optima: optima.to_vec(),
            image: Residuals { noise: 0.0, covariance: None, image_noise: noise, spread: 1.0 },
        };
        let Ranking { best, rivals } = all.ranked();
        (best.map(|best| best.origin), rivals.len())
    }

    #[test]
    fn what_leaves_only_the_image_s_noise_comes_before_what_sees_more() {
        let (large, exact) = (optimum(40.0, 1000.0, 0.02), optimum(0.0, 600.0, 0.0099));
        assert!(large.gain > exact.gain);
        assert_eq!(winner(&[large.clone(), exact.clone()], 0.01), (Some(Origin::Candidate(0)), 0));
        // Not where the image is so clean that there is more to explain ..
        assert_eq!(winner(&[large.clone(), exact], 0.005).0, Some(Origin::Candidate(40)));
        // .. nor where the first leaves hardly more, or the other sees little.
        assert_eq!(
            winner(&[optimum(40.0, 1000.0, 0.012), optimum(0.0, 600.0, 0.0099)], 0.01),
            (Some(Origin::Candidate(40)), 1)
        );
        assert_eq!(winner(&[large, optimum(0.0, 400.0, 0.0099)], 0.01), (Some(Origin::Candidate(40)), 0));
    }

    #[test]
    fn rivals_are_apart_and_what_explains_nothing_wins_nothing() {
        let poses = [(0.0, 900.0, 0.01), (2.0, 800.0, 0.01), (30.0, 500.0, 0.012), (60.0, 900.0, 0.02)];
        let optima = poses.map(|(degrees, visible, noise)| optimum(degrees, visible, noise));
        assert_eq!(winner(&optima, 0.0), (Some(Origin::Candidate(0)), 1));
        assert_eq!(winner(&[optimum(0.0, 900.0, 1.1)], 0.0), (None, 0));
        assert_eq!(winner(&[], 0.0), (None, 0));
    }
}
