//! The poses at which the posterior has a maximum, ranked.
//!
//! A few poses survive the search, which compares edges alone. Each of them is refined with all cues, and so is each
//! candidate that lies elsewhere. Their posteriors are compared with one set of weights of the cues, those of the best
//! pose.
//!
//! The difference of two optima has to be clear and significant. The tiles of the images are independent, so
//! their scatter gives the standard deviation of the difference (Vuong 1989): few tiles that disagree, as in a sparse map,
//! decide nothing, however large their sum.

use super::planes::Planes;
use super::readings::Reading;
use super::registration::{Findings, Round, Scene};
use super::unknowns::{POSE, State};
use super::verdict::Judge;

/// Two poses count as the same if the scene moves by less than this between them, pixels of an image 640 wide.
pub(super) const SAME_START: f64 = 1.5;

/// A difference of this many standard deviations is significant: 95 % of a normal distribution lie within it.
const SIGNIFICANT: f64 = 1.96;

/// A pose refined with all cues, and the findings there.
pub(super) struct Optimum {
    pub round: Round,
    pub findings: Findings,
    /// Reading of the first candidate from which the registration began; `None` if it began elsewhere.
    pub reading: Option<Reading>,
    /// How far the log posterior lies below that of the best optimum.
    pub behind: f64,
    /// Standard deviation of `behind`.
    pub scatter: f64,
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
        Self { round, findings: scene.findings(&round, planes), reading, behind: 0.0, scatter: 0.0 }
    }

    /// Whether this optimum fits about as well as the best one.
    pub fn is_equal(&self) -> bool {
        self.behind <= Judge::ALTERNATIVE
    }

    /// Whether the frames do not exclude this optimum: it fits about as well, or the difference is not significant.
    pub fn is_possible(&self) -> bool {
        self.is_equal() || self.behind <= SIGNIFICANT * self.scatter
    }

    /// Probability that the best optimum fits this much better by chance, one if it is the best.
    pub fn weight(&self) -> f64 {
        if self.behind <= 0.0 { 1.0 } else { libm::erfc(self.behind / self.scatter * std::f64::consts::FRAC_1_SQRT_2) }
    }

    /// Whether the frames exclude another pose: it fits worse, clearly and significantly.
    pub fn excludes(&self, scene: &Scene, state: State, planes: &[Planes]) -> bool {
        let round = Round { state, seen_from: state, ..self.round };
        let mut other = Self::at(scene, round, None, planes);
        let weights = self.weights();
        other.behind = self.posterior(&weights) - other.posterior(&weights);
        other.scatter = scatter(&self.by_tile(&weights), &other.by_tile(&weights));
        !other.is_possible()
    }

    fn weights(&self) -> Vec<f64> {
        self.findings.cues.iter().map(|cue| cue.2).collect()
    }

    /// Weighted log likelihood of the cues in each tile.
    fn by_tile(&self, weights: &[f64]) -> Vec<f64> {
        let mut tiles = vec![0.0; self.findings.total.shares.len()];
        for ((_, cue, _), weight) in self.findings.cues.iter().zip(weights) {
            tiles.iter_mut().zip(&cue.shares).for_each(|(sum, share)| *sum += weight * share.value);
        }
        tiles
    }

    /// Weighted log likelihood of the cues and log prior.
    fn posterior(&self, weights: &[f64]) -> f64 {
        let Findings { back, prior, .. } = &self.findings;
        self.by_tile(weights).iter().sum::<f64>() - 0.5 * back.dot(&(prior * back))
    }
}

/// Standard deviation of the sum of differences between independent tiles; those that show nothing do not count.
fn scatter(one: &[f64], other: &[f64]) -> f64 {
    let differences: Vec<f64> = one.iter().zip(other).map(|(a, b)| a - b).filter(|value| *value != 0.0).collect();
    let mean = differences.iter().sum::<f64>() / differences.len().max(1) as f64;
    differences.iter().map(|value| (value - mean).powi(2)).sum::<f64>().sqrt()
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
    let best = optima[0].by_tile(&weights);
    optima.iter_mut().for_each(|optimum| optimum.scatter = scatter(&best, &optimum.by_tile(&weights)));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::cue::Cue;
    use crate::calibration::evidence::{Evidence, Share};
    use crate::calibration::unknowns::{Matrix, Units, Vector};
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
        let round = Round::from(units.step(&told, &back), told);
        let evidence = Evidence { shares: vec![Share { value, ..Share::none() }] };
        let cues = vec![(Cue::Edges, evidence.clone(), weight)];
        let findings =
            Findings { units, prior: Matrix::identity(), cues, total: evidence, traces: Default::default(), back };
        Optimum { round, findings, reading: None, behind: 0.0, scatter: 0.0 }
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

    /// An optimum whose edges fit by these log likelihoods, tile by tile.
    fn tiled(values: &[f64]) -> Optimum {
        let mut optimum = optimum(0.0, 0.0, 1.0);
        let evidence = Evidence { shares: values.iter().map(|&value| Share { value, ..Share::none() }).collect() };
        optimum.findings.cues[0].1 = evidence.clone();
        optimum.findings.total = evidence;
        optimum
    }

    #[test]
    fn a_difference_that_few_tiles_make_tells_no_optima_apart() {
        let mut steady = [tiled(&[3.0; 10]), tiled(&[0.0; 10])];
        rank(&mut steady);
        assert!(steady[1].behind > 29.9 && steady[1].scatter < 1e-9 && !steady[1].is_possible());
        let mut lone = [tiled(&[30.0, 0.5, 0.0, 0.5, 0.0]), tiled(&[0.0, 0.0, 0.5, 0.0, 0.5])];
        rank(&mut lone);
        assert!(
            lone[1].behind > 29.0 && !lone[1].is_equal() && lone[1].is_possible(),
            "{} {}",
            lone[1].behind,
            lone[1].scatter
        );
    }
}
