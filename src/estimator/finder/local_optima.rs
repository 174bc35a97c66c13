//! Local optima, where registrations of the candidates end: chooses the answer and its rivals.
//!
//! Registrations that end in different poses see different points, so their objectives cannot be compared. They are
//! ranked by gain = N^(1/3) ln(spread / noise). The logarithm is how much better the pose explains the image than a
//! constant would. The root of the number N of visible points penalises tiny overlaps, which are easy to explain. Other
//! powers were compared on local optima of random scenes (docs/lab/thresholds.md): without this factor, tiny overlaps
//! win; the square root prefers, of two poses a few degrees apart, the one that merely sees more. A pose that leaves
//! only the image noise ranks above one that sees more but leaves over 1.25 times as much.

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

/// Exponent of the number of visible points in the gain. `powf` serves, because a separate `cbrt` would add 1 kB to the download.
const THIRD: f64 = 1.0 / 3.0;
/// A local optimum is convincing if every other optimum with as many visible points has at least this many times its
/// noise.
const CONVINCING_NOISE: f64 = 2.0;
/// Largest angle, in degrees, between registrations that have found the same optimum.
const SAME_OPTIMUM: f64 = 3.0;
/// An optimum reached this often needs no more support; candidates near it are skipped.
const ENOUGH_SUPPORT: u32 = 2;
/// Candidates within this angle of such an optimum would only reach it again, degrees.
const CATCHMENT: f64 = 15.0;
/// Largest noise of a rival, as a multiple of the winner's.
const RIVAL_NOISE: f64 = 1.25;
/// Smallest number of visible points of a rival, as a share of the winner's.
const RIVAL_VISIBLE: f64 = 0.5;
/// Largest number of rivals in a report.
const MOST_RIVALS: usize = 5;

/// Gain of a pose that sees this many points and leaves this noise, in an image of this spread.
pub fn gain(spread: f64, visible: f64, noise: f64) -> f64 {
    visible.powf(THIRD) * (spread / noise).ln()
}

/// What distinguishes one registration from another.
#[derive(Clone, Debug)]
pub struct RegisteredCandidate {
    pub pose: Similarity,
    /// Number of visible points.
    pub visible: f64,
    /// Standard deviation of the residuals of log S.
    pub noise: f64,
    /// The whole report, if it was made in this thread.
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
    /// Where the best registration that ended here began.
    pub origin: Origin,
    pub registered: RegisteredCandidate,
    /// Gain and score.
    pub gain: f64,
    /// Number of registrations that ended here.
    support: u32,
    /// The end of each registration, and its noise.
    ends: Vec<(Similarity, f64)>,
}

impl LocalOptimum {
    /// Ends of registrations that fit the image as well as the best one, which is among them.
    fn equal_ends(&self) -> Vec<Similarity> {
        let most = RIVAL_NOISE * self.registered.noise;
        self.ends.iter().filter(|(_, noise)| *noise <= most).map(|(pose, _)| *pose).collect()
    }

    fn is_apart(&self, other: &Self) -> bool {
        self.registered.pose.degrees_to(&other.registered.pose) >= SAME_OPTIMUM
    }

    /// Whether it explains about as many points as `best` nearly as well: with at most `factor` times the noise.
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
    /// The best pose under a single albedo; `None` if nothing could be registered or the initial pose is as good.
    pub best: Option<Box<PhotometricReport>>,
    /// Poses that the data cannot distinguish from the best, best first.
    pub rivals: Vec<Similarity>,
    /// Where registrations of the same optimum ended. Their spread adds to the sigmas of the best pose once the method is
    /// chosen.
    pub ends: Vec<Similarity>,
}

impl Choice {
    /// The choice of a ranking whose best optimum has its report.
    pub fn of(Ranking { best, rivals }: Ranking) -> Self {
        let Some(best) = best.filter(|best| best.origin != Origin::Initial) else {
            return Self { best: None, rivals, ends: Vec::new() };
        };
        let ends = best.equal_ends();
        Self { best: best.registered.report, rivals, ends }
    }
}

/// All optima that registrations have found so far.
pub struct LocalOptima {
    optima: Vec<LocalOptimum>,
    /// Noise and spread of the image.
    image: Residuals,
}

impl LocalOptima {
    /// An empty list for this image, with capacity for `most`.
    pub fn new(most: usize, image: Residuals) -> Self {
        Self { optima: Vec::with_capacity(most), image }
    }

    /// The residuals of an optimum.
    fn residuals(&self, optimum: &LocalOptimum) -> Residuals {
        Residuals { noise: optimum.registered.noise, ..self.image }
    }

    /// Enters the end of a registration; if two end at the same optimum, the better one stays.
    pub fn enter(&mut self, origin: Origin, registered: RegisteredCandidate) {
        self.enter_scored(origin, registered, 0.0);
    }

    /// Enters the end of a registration, to whose gain a score is added.
    pub fn enter_scored(&mut self, origin: Origin, registered: RegisteredCandidate, score: f64) {
        let gain = gain(self.image.spread, registered.visible, registered.noise) + score;
        if !gain.is_finite() {
            return;
        }
        let is_same = |known: &&mut LocalOptimum| known.registered.pose.degrees_to(&registered.pose) < SAME_OPTIMUM;
        match self.optima.iter_mut().find(is_same) {
            Some(known) => {
                known.support += 1;
                known.ends.push((registered.pose, registered.noise));
                if gain > known.gain {
                    (known.origin, known.registered, known.gain) = (origin, registered, gain);
                }
            }
            None => {
                let ends = vec![(registered.pose, registered.noise)];
                self.optima.push(LocalOptimum { origin, registered, gain, support: 1, ends });
            }
        }
    }

    /// The pose of the best optimum so far.
    pub fn best(&self) -> Option<Similarity> {
        self.optima.iter().max_by(|a, b| a.gain.total_cmp(&b.gain)).map(|best| best.registered.pose)
    }

    /// The poses of the best optima, best first.
    pub fn best_poses(mut self, most: usize) -> Vec<Similarity> {
        self.optima.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        self.optima.iter().take(most).map(|optimum| optimum.registered.pose).collect()
    }

    /// Whether a candidate lies near an optimum with enough support.
    pub fn is_known(&self, pose: &Similarity) -> bool {
        let near = |known: &LocalOptimum| {
            known.support >= ENOUGH_SUPPORT && known.registered.pose.degrees_to(pose) < CATCHMENT
        };
        self.optima.iter().any(near)
    }

    /// Whether the best optimum after this many registrations has no close rival, and either explains nearly everything
    /// or attracts most registrations, though not all.
    pub fn is_convincing(&self, tried: usize) -> bool {
        let best = self.optima.iter().max_by(|a, b| a.gain.total_cmp(&b.gain));
        best.is_some_and(|best| {
            let mut others = self.optima.iter().filter(|other| other.is_apart(best)).peekable();
            // If all registrations end at one optimum, the candidates may simply be alike.
            let compared = others.peek().is_some();
            let alone = !others.any(|other| other.rivals(best, CONVINCING_NOISE));
            let most = compared && 2 * best.support as usize >= tried;
            let clear = self.residuals(best).is_next_to_nothing() || most;
            best.support >= ENOUGH_SUPPORT && alone && clear
        })
    }

    /// Whether all optima leave far larger residuals than light, noise and errors of normals cause on an object with a
    /// single albedo.
    pub fn are_of_varying_albedo(&self) -> bool {
        let varies = |optimum| self.residuals(optimum).diagnose(Alternative::LocalContrast) == Diagnosis::VaryingAlbedo;
        self.optima.iter().all(varies)
    }

    /// The best optimum, and those that the data cannot distinguish from it, given the noise of the image.
    pub fn ranked(&mut self) -> Ranking {
        let (mut optima, noise) = (std::mem::take(&mut self.optima), self.image.image_noise);
        optima.sort_by(|a, b| b.gain.total_cmp(&a.gain));
        // The second optimum leaves only the image's noise, and the first far more.
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
    use crate::pose::{Direction, Uncertainty};

    /// An optimum at this angle about z, with its visible points and its noise.
    fn optimum(degrees: f64, visible: f64, noise: f64) -> LocalOptimum {
        let rotation = Rotation3::new(Vector3::z() * degrees.to_radians()).into_inner();
        let pose = Similarity { rotation, ..Similarity::identity() };
        let registered = RegisteredCandidate { pose, visible, noise, report: None };
        let gain = visible.powf(THIRD) * (1.0 / noise).ln();
        LocalOptimum { origin: Origin::Candidate(degrees as usize), registered, gain, support: 2, ends: Vec::new() }
    }

    fn winner(optima: &[LocalOptimum], noise: f64) -> (Option<Origin>, usize) {
        let mut all = LocalOptima {
            optima: optima.to_vec(),
            image: Residuals { noise: 0.0, spatial_covariance: None, image_noise: noise, spread: 1.0 },
        };
        let Ranking { best, rivals } = all.ranked();
        (best.map(|best| best.origin), rivals.len())
    }

    #[test]
    fn what_leaves_only_the_image_s_noise_comes_before_what_sees_more() {
        let (large, exact) = (optimum(40.0, 1000.0, 0.02), optimum(0.0, 600.0, 0.0099));
        assert!(large.gain > exact.gain);
        assert_eq!(winner(&[large.clone(), exact.clone()], 0.01), (Some(Origin::Candidate(0)), 0));
        // The exact optimum does not win if the image is so clean that it leaves more than the image's noise, too.
        assert_eq!(winner(&[large.clone(), exact], 0.005).0, Some(Origin::Candidate(40)));
        // The exact optimum also does not win if the other leaves hardly more noise, or if it has few visible points.
        assert_eq!(
            winner(&[optimum(40.0, 1000.0, 0.012), optimum(0.0, 600.0, 0.0099)], 0.01),
            (Some(Origin::Candidate(40)), 1)
        );
        assert_eq!(winner(&[large, optimum(0.0, 400.0, 0.0099)], 0.01), (Some(Origin::Candidate(40)), 0));
    }

    #[test]
    fn registrations_that_end_apart_at_one_optimum_widen_its_sigmas() {
        let mut all =
            LocalOptima::new(4, Residuals { noise: 0.0, spatial_covariance: None, image_noise: 0.0, spread: 1.0 });
        let mut enter = |degrees: f64, noise: f64| {
            let registered = optimum(degrees, 900.0, noise).registered;
            all.enter(Origin::Candidate(0), registered);
        };
        // The last end fits worse and does not count.
        for (degrees, noise) in [(0.0, 0.01), (1.0, 0.011), (-1.0, 0.012), (2.0, 0.02)] {
            enter(degrees, noise);
        }
        let Ranking { best, .. } = all.ranked();
        let ends = best.expect("an optimum").equal_ends();
        assert_eq!(ends.len(), 3);
        let mut uncertainty = Uncertainty {
            rotation_degrees: [0.1; 3],
            translation: [Some(0.1), Some(0.1), None],
            scale: None,
            weakest: Direction { first: None, second: None },
        };
        uncertainty.add_spread(&ends[0], &ends);
        let expected = (0.01 + 2.0 / 3.0_f64).sqrt();
        let [x, y, z] = uncertainty.rotation_degrees;
        assert!(x == 0.1 && y == 0.1 && (z - expected).abs() < 1e-9, "{x} {y} {z}");
        assert_eq!(uncertainty.translation, [Some(0.1), Some(0.1), None]);
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
