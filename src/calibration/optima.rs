//! The poses at which the posterior has a maximum, ranked.
//!
//! A few poses survive the search, which compares edges alone. Each of them is refined with all cues, and so is each
//! candidate that lies elsewhere. Their posteriors are compared with one set of weights of the cues, those of the best
//! pose.

use super::planes::Planes;
use super::readings::Reading;
use super::registration::{Findings, Round, Scene};

/// A pose refined with all cues, and the findings there.
pub(super) struct Optimum {
    pub round: Round,
    pub findings: Findings,
    /// Reading of the first candidate from which the registration began; `None` if it began elsewhere.
    pub reading: Option<Reading>,
    /// How far the log posterior lies below that of the best optimum.
    pub behind: f64,
}

/// The optima of the refined rounds, best first.
pub(super) fn ranked(scene: &Scene, rounds: &[Round], planes: &[Planes]) -> Vec<Optimum> {
    let mut optima: Vec<Optimum> = rounds.iter().map(|round| Optimum::at(scene, *round, None, planes)).collect();
    rank(&mut optima);
    optima
}

impl Optimum {
    pub fn at(scene: &Scene, round: Round, reading: Option<Reading>, planes: &[Planes]) -> Self {
        Self { round, findings: scene.findings(&round, planes), reading, behind: 0.0 }
    }
}

/// Sorts by posterior, with the weights of the first optimum and then again with those of the best.
pub(super) fn rank(optima: &mut [Optimum]) {
    rank_as_first(optima);
    rank_as_first(optima);
}

/// Sorts by posterior with the weights of the first optimum.
fn rank_as_first(optima: &mut [Optimum]) {
    let Some(first) = optima.first() else { return };
    let weights: Vec<f64> = first.findings.cues.iter().map(|cue| cue.2).collect();
    let posterior = |Optimum { findings, .. }: &Optimum| {
        let likelihood: f64 =
            findings.cues.iter().zip(&weights).map(|((_, cue, _), weight)| weight * cue.value()).sum();
        likelihood - 0.5 * findings.back.dot(&(findings.prior * findings.back))
    };
    let posteriors: Vec<f64> = optima.iter().map(posterior).collect();
    let best = posteriors.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    optima.iter_mut().zip(posteriors).for_each(|(optimum, posterior)| optimum.behind = best - posterior);
    optima.sort_by(|a, b| a.behind.total_cmp(&b.behind));
}
