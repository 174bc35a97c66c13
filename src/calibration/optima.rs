//! The poses at which the posterior has a maximum, ranked.
//!
//! A few poses survive the search, which compares only edges. Each of them is refined with all cues, and so is each
//! candidate that lies elsewhere. Their posteriors are compared with one set of weights of the cues, those of the best
//! pose.
//!
//! The difference of two optima has to be clear and significant. The tiles of the images are independent, so their
//! scatter gives the standard deviation of the difference (Vuong 1989). A few tiles that disagree, as in a sparse map,
//! decide nothing, however large their sum is.

use super::planes::Planes;
use super::readings::Reading;
use super::registration::{Findings, Round, Scene};
use super::unknowns::{POSE, State};
use super::verdict::Judge;
use crate::numeric::sort_descending;

/// Two poses count as the same if the scene moves by less than this between them, pixels of an image 640 wide.
pub(super) const SAME_START: f64 = 1.5;

/// Standard deviations from which a difference is significant: 95 % of a normal distribution lie within them.
pub(super) const SIGNIFICANT: f64 = 1.96;

/// A pose refined with all cues, and the evidence at this pose.
pub(super) struct Optimum {
    pub round: Round,
    pub findings: Findings,
    /// Reading of the first candidate from which the registration began; `None` if it began elsewhere.
    pub reading: Option<Reading>,
    /// Difference of the log posterior from that of the best optimum.
    pub behind: f64,
    /// Standard deviation of `behind`.
    pub scatter: f64,
}

/// The optima of the refined rounds, best first.
pub(super) fn ranked(scene: &Scene, rounds: &[Round], planes: &[Planes]) -> Vec<Optimum> {
    let mut optima: Vec<Optimum> = vec![];
    // If several rounds end at one place, the first one stays, so that rounding decides nothing.
    for round in rounds {
        if !optima.iter().any(|other| other.is_near(&round.state, scene)) {
            optima.push(Optimum::at(scene, *round, None, planes));
        }
    }
    rank(&mut optima);
    optima
}

impl Optimum {
    pub fn at(scene: &Scene, round: Round, reading: Option<Reading>, planes: &[Planes]) -> Self {
        Self { round, findings: scene.findings(&round, planes), reading, behind: 0.0, scatter: 0.0 }
    }

    /// Whether another optimum at this state would be at the same place.
    pub fn is_near(&self, state: &State, scene: &Scene) -> bool {
        let apart = self.findings.units.between(&self.round.state, state);
        apart.fixed_rows::<POSE>(0).norm() <= SAME_START * scene.scale
    }

    /// Whether this optimum fits about as well as the best one.
    pub fn is_equal(&self) -> bool {
        self.behind <= Judge::ALTERNATIVE
    }

    /// Whether the frames do not exclude this optimum: it fits about as well, or the difference is not significant.
    pub fn is_possible(&self) -> bool {
        self.is_equal() || self.behind <= SIGNIFICANT * self.scatter
    }

    /// Sets the difference of this optimum from the best one, with the weights of the cues at the best one.
    fn compare(&mut self, best: &Fit, weights: &[f64]) {
        let own = Fit::of(&self.findings, weights);
        self.behind = best.posterior - own.posterior;
        self.scatter = scatter(&best.by_tile, &own.by_tile);
    }

    /// Probability that the best optimum fits this much better by chance, one if it is the best.
    pub fn weight(&self) -> f64 {
        if self.behind <= 0.0 { 1.0 } else { libm::erfc(self.behind / self.scatter * std::f64::consts::FRAC_1_SQRT_2) }
    }

    /// Whether the frames exclude another pose: it fits worse, clearly and significantly.
    pub fn excludes(&self, scene: &Scene, state: State, planes: &[Planes]) -> bool {
        let round = Round { state, seen_from: state, ..self.round };
        let findings = scene.values(&round, planes);
        let mut other = Self { round, findings, reading: None, behind: 0.0, scatter: 0.0 };
        let weights = self.findings.weights();
        other.compare(&Fit::of(&self.findings, &weights), &weights);
        !other.is_possible()
    }
}

/// The fit of a pose under given weights of the cues.
struct Fit {
    /// Weighted log likelihood of the cues in each tile.
    by_tile: Vec<f64>,
    /// Log posterior: the sum over the tiles plus the log prior.
    posterior: f64,
}

impl Fit {
    fn of(findings: &Findings, weights: &[f64]) -> Self {
        let Findings { cues, total, back, prior, .. } = findings;
        let mut by_tile = vec![0.0; total.shares.len()];
        for ((_, cue, _), weight) in cues.iter().zip(weights) {
            by_tile.iter_mut().zip(&cue.shares).for_each(|(sum, share)| *sum += weight * share.value);
        }
        let posterior = by_tile.iter().sum::<f64>() - 0.5 * back.dot(&(prior * back));
        Self { by_tile, posterior }
    }
}

/// Standard deviation of the difference of two sums over independent tiles. Tiles that show nothing do not count.
pub(super) fn scatter(some: &[f64], others: &[f64]) -> f64 {
    let pairs = some.iter().zip(others);
    let differences: Vec<f64> = pairs.map(|(a, b)| a - b).filter(|value| *value != 0.0).collect();
    let mean = differences.iter().sum::<f64>() / differences.len().max(1) as f64;
    differences.iter().map(|value| (value - mean).powi(2)).sum::<f64>().sqrt()
}

/// Sorts by posterior. All posteriors have the weights of one optimum, which is the best one with its own weights. A
/// pose that puts no points onto the image has no weights with which others could be compared.
pub(super) fn rank(optima: &mut [Optimum]) {
    let own = |optimum: &Optimum| Fit::of(&optimum.findings, &optimum.findings.weights()).posterior;
    let Some(first) = optima.iter().min_by(|a, b| own(b).total_cmp(&own(a))) else { return };
    let weights = first.findings.weights();
    let fit = |optimum: &Optimum| Fit::of(&optimum.findings, &weights);
    sort_descending(optima, |optimum| fit(optimum).posterior);
    let best = fit(&optima[0]);
    optima.iter_mut().for_each(|optimum| optimum.compare(&best, &weights));
}

/// Whether the best optimum is a reading, and the frames exclude all other optima.
pub(super) fn is_reading_ahead(optima: &[Optimum]) -> bool {
    optima.first().is_some_and(|best| best.reading.is_some()) && !optima[1..].iter().any(Optimum::is_possible)
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

    /// An optimum that is `sigmas` of the prior away from the prior's mean. Its edges have the log likelihood `value`
    /// and the weight `weight`.
    fn optimum(sigmas: f64, value: f64, weight: f64) -> Optimum {
        let camera = Pinhole { fx: 500.0, fy: 500.0, cx: 320.0, cy: 240.0, lens: Lens::None };
        let cloud = [[-0.3, -0.2, 1.0], [0.3, -0.2, 1.2], [0.0, 0.3, 0.9]].map(Vector3::from);
        let units = Units::new(&cloud, &camera);
        let initial = State::at(Similarity::identity());
        let mut back = Vector::zeros();
        back[0] = sigmas;
        let round = Round::from(units.step(&initial, &back), initial);
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

    /// An optimum whose edges have these log likelihoods, one for each tile.
    fn tiled(values: &[f64]) -> Optimum {
        let mut optimum = optimum(0.0, 0.0, 1.0);
        let evidence = Evidence { shares: values.iter().map(|&value| Share { value, ..Share::none() }).collect() };
        optimum.findings.cues[0].1 = evidence.clone();
        optimum.findings.total = evidence;
        optimum
    }

    #[test]
    fn the_difference_of_two_fits_is_their_sum_over_tiles_and_its_standard_deviation() {
        let (best, mut other) = (tiled(&[4.0, 2.0, 0.0, 3.0]), tiled(&[1.0, 1.0, 0.0, 1.0]));
        other.compare(&Fit::of(&best.findings, &[0.5]), &[0.5]);
        // Differences 1.5, .5 and 1 about their mean of 1; the third tile shows nothing.
        assert_eq!((other.behind, other.scatter), (3.0, 0.5_f64.sqrt()));
        // In the other direction the difference is negative, and nothing is excluded.
        let mut best = best;
        best.compare(&Fit::of(&other.findings, &[0.5]), &[0.5]);
        assert!(best.behind == -3.0 && best.is_possible());
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
        // Nor do they tell a reading from the candidate.
        let read = |mut optima: [Optimum; 2]| {
            optima[0].reading = Some(Reading::Inverse);
            is_reading_ahead(&optima)
        };
        assert!(!is_reading_ahead(&steady) && read(steady) && !read(lone));
    }
}
