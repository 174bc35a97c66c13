//! The poses at which the posterior has a maximum, ranked.
//!
//! A few poses survive the search, which compares edges alone. Each of them is refined with all cues, and so is each
//! candidate that lies elsewhere. Their posteriors are compared with one set of weights of the cues, those of the best
//! pose.

use super::planes::Planes;
use super::readings::Reading;
use super::registration::{Findings, Round, Scene};
use super::unknowns::POSE;

/// Two poses count as the same if the scene moves by less than this between them, pixels of an image 640 wide.
pub(super) const SAME_START: f64 = 1.5;

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
    let mut optima = vec![];
    rounds.iter().for_each(|round| add(&mut optima, scene, Optimum::at(scene, *round, None, planes)));
    rank(&mut optima);
    optima
}

/// Adds an optimum unless another one is at the same place: of rounds that meet the first stands, and rounding decides nothing.
pub(super) fn add(optima: &mut Vec<Optimum>, scene: &Scene, optimum: Optimum) {
    let is_same = |other: &Optimum| {
        let apart = other.findings.units.between(&other.round.state, &optimum.round.state);
        apart.fixed_rows::<POSE>(0).norm() <= SAME_START * scene.scale
    };
    if !optima.iter().any(is_same) {
        optima.push(optimum);
    }
}

impl Optimum {
    pub fn at(scene: &Scene, round: Round, reading: Option<Reading>, planes: &[Planes]) -> Self {
        Self { round, findings: scene.findings(&round, planes), reading, behind: 0.0 }
    }

    fn weights(&self) -> Vec<f64> {
        self.findings.cues.iter().map(|cue| cue.2).collect()
    }

    /// Weighted log likelihood of the cues and log prior.
    fn posterior(&self, weights: &[f64]) -> f64 {
        let Findings { cues, back, prior, .. } = &self.findings;
        let likelihood: f64 = cues.iter().zip(weights).map(|((_, cue, _), weight)| weight * cue.value()).sum();
        likelihood - 0.5 * back.dot(&(prior * back))
    }
}

/// Sorts by posterior, each with its own weights, and then all with those of the best: a pose that puts nothing onto the
/// image has no weights that could compare others.
pub(super) fn rank(optima: &mut [Optimum]) {
    let own = |optimum: &Optimum| optimum.posterior(&optimum.weights());
    optima.sort_by(|a, b| own(b).total_cmp(&own(a)));
    let Some(weights) = optima.first().map(Optimum::weights) else { return };
    let posteriors: Vec<f64> = optima.iter().map(|optimum| optimum.posterior(&weights)).collect();
    let best = posteriors.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    optima.iter_mut().zip(posteriors).for_each(|(optimum, posterior)| optimum.behind = best - posterior);
    optima.sort_by(|a, b| a.behind.total_cmp(&b.behind));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::cue::Cue;
    use crate::calibration::evidence::{Evidence, Share};
    use crate::calibration::unknowns::{Matrix, State, Units, Vector};
    use crate::pose::Similarity;
    use crate::view::{Lens, Pinhole};
    use nalgebra::Vector3;

    /// An optimum at a pose so many sigmas from the prior's, with a log likelihood of its edges and their weight.
    fn optimum(sigmas: f64, value: f64, weight: f64) -> Optimum {
        let camera = Pinhole { fx: 500.0, fy: 500.0, cx: 320.0, cy: 240.0, lens: Lens::None };
        let cloud = [[-0.3, -0.2, 1.0], [0.3, -0.2, 1.2], [0.0, 0.3, 0.9]].map(Vector3::from);
        let units = Units::new(&cloud, &camera);
        let told = State::at(Similarity::identity());
        let mut back = Vector::zeros();
        back[0] = sigmas;
        let round = Round { state: units.step(&told, &back), told, sigma: 1.0 };
        let evidence = Evidence { shares: vec![Share { value, ..Share::none() }] };
        let cues = vec![(Cue::Edges, evidence.clone(), weight)];
        let findings = Findings { units, prior: Matrix::identity(), cues, total: evidence, back };
        Optimum { round, findings, reading: None, behind: 0.0 }
    }

    #[test]
    fn the_weights_of_the_best_rank_all_and_the_prior_counts() {
        // The first fits best, but five sigmas of the prior cost more than it gains.
        let mut optima = vec![optimum(5.0, 12.0, 0.5), optimum(0.0, 8.0, 0.1), optimum(1.0, 10.0, 0.5)];
        rank(&mut optima);
        let behind: Vec<f64> = optima.iter().map(|optimum| optimum.behind).collect();
        let sigmas: Vec<f64> = optima.iter().map(|optimum| optimum.findings.back[0]).collect();
        // Posteriors with the weight 0.5: 4.5, 4 and -6.5.
        assert_eq!((sigmas, behind), (vec![1.0, 0.0, 5.0], vec![0.0, 0.5, 11.0]));
    }
}
