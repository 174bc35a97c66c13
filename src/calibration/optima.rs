//! Poses at which the likelihood of a frame has a maximum, and how far each is behind the best.
//!
//! A few starts survive the search by their edges. Each is settled with all cues, and so is each candidate that lies
//! elsewhere. Their log likelihoods are compared with one set of weights, those of the best.

use super::planes::Planes;
use super::registration::{Findings, Round, Scene};

/// A settled round.
pub(super) struct Optimum {
    pub round: Round,
    pub findings: Findings,
    /// Log posterior of the best optimum over that of this one.
    pub behind: f64,
}

/// The settled rounds, best first.
pub(super) fn ranked(scene: &Scene, rounds: &[Round], planes: &[Planes]) -> Vec<Optimum> {
    let optimum = |round: &Round| Optimum { round: *round, findings: scene.findings(round, planes), behind: 0.0 };
    let mut optima: Vec<Optimum> = rounds.iter().map(optimum).collect();
    rank(&mut optima);
    // Once more, because the weights are now those of the best.
    rank(&mut optima);
    optima
}

/// Sorts by the posterior with the weights of the first.
fn rank(optima: &mut [Optimum]) {
    let Some(first) = optima.first() else { return };
    let weights: Vec<f64> = first.findings.cues.iter().map(|cue| cue.2).collect();
    let posterior = |Optimum { findings, .. }: &Optimum| {
        let likelihood: f64 = findings.cues.iter().zip(&weights).map(|((_, cue, _), weight)| weight * cue.value()).sum();
        likelihood - 0.5 * findings.back.dot(&(findings.prior * findings.back))
    };
    let posteriors: Vec<f64> = optima.iter().map(posterior).collect();
    let best = posteriors.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    optima.iter_mut().zip(posteriors).for_each(|(optimum, posterior)| optimum.behind = best - posterior);
    optima.sort_by(|a, b| a.behind.total_cmp(&b.behind));
}
