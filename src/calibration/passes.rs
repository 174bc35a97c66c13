//! The passes of the search for optima.
//!
//! The first pass looks about the first candidate, as far as the prior suggests. If the frames contradict that candidate, the prior says
//! less about where the optimum lies: its sigmas are twice as large in all further passes, and the second pass looks twice as far. The next
//! ones begin at the estimate, until it stays. Every pass registers the optima of the last one anew, through all levels, because where a
//! registration ends also depends on where it began. The prior stays centred on the first candidate.

use super::optima::{Optimum, SAME_START};
use super::registration::{Round, Scene, Start};
use super::search;
use super::unknowns::{State, Units};
use crate::numeric::sort_descending;

/// Distance to which the first two passes look, sigmas of the prior.
const REACH: f64 = 1.5;
/// Factor on the sigmas of the prior once the frames contradict the candidate: errors of ten degrees are 2.5 sigmas of the first prior.
const WIDER: f64 = 2.0;
/// Share of a pass in the work that is left, by which progress grows.
const OF_PASS: f64 = 0.7;
/// Maximum number of passes.
const MOST: usize = 5;

/// The current pass.
pub(super) struct Passes {
    /// Number of passes before the current one.
    done: usize,
    /// Whether the current pass is planned, but has not begun.
    is_due: bool,
    /// The pose on which the prior is centred.
    initial: State,
    /// The pose about which initial poses are searched.
    centre: State,
    /// Poses that are registered besides those: the candidates, and after the first pass the optima of the last one.
    known: Vec<State>,
    /// The poses under registration. They are sorted by score after each level, best first.
    pub starts: Vec<Start>,
}

impl Passes {
    /// The first pass.
    pub fn new(initial: State, candidates: Vec<State>) -> Self {
        Self { done: 0, is_due: false, initial, centre: initial, known: candidates, starts: vec![] }
    }

    /// Share of all passes that is done. Most checks need only the first.
    pub fn progress(&self, share: f64) -> f64 {
        let left = (0..self.done).fold(1.0, |left, _| left * (1.0 - OF_PASS));
        1.0 - left * (1.0 - OF_PASS * share)
    }

    /// Factor on the sigmas of the prior in the current pass.
    pub const fn prior_width(&self) -> f64 {
        if self.done == 0 { 1.0 } else { WIDER }
    }

    /// Finds the initial poses: those of the coarse search, the poses that are known, and the inverse of the first candidate.
    pub fn find_starts(&mut self, scene: &Scene) {
        self.is_due = false;
        let reach = if self.done > 1 { REACH / WIDER } else { REACH };
        let (discontinuities, states) = search::starts(scene, &self.centre, reach);
        let start = |state| Start {
            round: Round { seen_from: self.centre, ..Round::from(state, self.initial) },
            discontinuities: discontinuities.clone(),
            score: 0.0,
        };
        self.starts = states.into_iter().map(start).collect();
        let inverse = State::at(self.initial.pose.inverse());
        for state in self.known.iter().chain([&inverse]) {
            if !self.is_started(scene, state) {
                self.starts.push(scene.start(*state, self.initial));
            }
        }
    }

    /// Starts from the known poses once more at a late level. On texture, the wide windows of the early levels would lead poses away that
    /// are nearly right.
    pub fn enter(&mut self, scene: &Scene) {
        self.starts.extend(self.known.iter().map(|state| scene.start(*state, self.initial)));
    }

    /// Keeps the best poses that differ from each other, at most `most`.
    pub fn keep_apart(&mut self, scene: &Scene, most: usize) {
        sort_descending(&mut self.starts, |start| start.score);
        for start in std::mem::take(&mut self.starts) {
            if self.starts.len() < most && !self.is_started(scene, &start.round.state) {
                self.starts.push(start);
            }
        }
    }

    /// The poses to refine with all cues: those that are left, and the known ones.
    pub fn rounds(&self, scene: &Scene) -> Vec<Round> {
        let mut rounds: Vec<Round> = self.starts.iter().map(|start| start.round).collect();
        let Round { state: at, initial, sigma, .. } = rounds[0];
        let units = scene.units(&at);
        for state in &self.known {
            if !rounds.iter().any(|other| is_same(scene, &units, &other.state, state)) {
                rounds.push(Round { sigma, ..Round::from(*state, initial) });
            }
        }
        rounds
    }

    /// Whether an initial pose is at the same place as a state.
    fn is_started(&self, scene: &Scene, state: &State) -> bool {
        let units = scene.units(&self.initial);
        self.starts.iter().any(|start| is_same(scene, &units, &start.round.state, state))
    }

    /// Whether this is the first pass.
    pub const fn is_first(&self) -> bool {
        self.done == 0 || self.done == 1 && self.is_due
    }

    /// Whether another pass is planned.
    pub const fn is_due(&self) -> bool {
        self.is_due
    }

    /// Plans another pass from these optima, best first, if the estimate contradicts the centre of the last one, as `is_off` tells.
    pub fn plan(&mut self, optima: &[Optimum], is_off: impl Fn(&State) -> bool) {
        if self.done + 1 == MOST || !is_off(&self.centre) {
            return;
        }
        self.done += 1;
        self.is_due = true;
        let possible = optima.iter().filter(|optimum| optimum.is_possible());
        self.known = possible.map(|optimum| State::at(optimum.round.state.pose)).collect();
        if self.done > 1 {
            self.centre = self.known[0];
        }
    }
}

/// Whether two states are at the same place.
#[inline(never)]
fn is_same(scene: &Scene, units: &Units, a: &State, b: &State) -> bool {
    units.between(a, b).norm() <= SAME_START * scene.scale
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::cue::Cue;
    use crate::calibration::evidence::{Evidence, Share};
    use crate::calibration::registration::Findings;
    use crate::calibration::simulated;
    use crate::calibration::unknowns::{Matrix, POSE, Units, Vector};
    use crate::pose::Similarity;
    use crate::view::{Lens, Pinhole, Size};
    use nalgebra::Vector3;

    fn at(x: f64) -> State {
        State::at(Similarity { translation: Vector3::x() * x, ..Similarity::identity() })
    }

    /// An optimum whose log posterior is `behind` that of the best, by about as much in all tiles.
    fn optimum(x: f64, behind: f64) -> Optimum {
        let camera = Pinhole { fx: 500.0, fy: 500.0, cx: 320.0, cy: 240.0, lens: Lens::None };
        let units = Units::new(&[Vector3::z()], &camera);
        let evidence = Evidence { shares: vec![Share::none()] };
        let cues = vec![(Cue::Edges, evidence.clone(), 1.0)];
        let findings = Findings {
            units,
            prior: Matrix::identity(),
            cues,
            total: evidence,
            traces: Default::default(),
            back: Vector::zeros(),
        };
        Optimum { round: Round::from(at(x), at(0.0)), findings, reading: None, behind, scatter: 0.0 }
    }

    #[test]
    fn passes_look_about_the_candidate_then_about_the_estimate_until_it_stays() {
        let mut passes = Passes::new(at(0.0), vec![at(0.0)]);
        let is_off = |from: f64| move |state: &State| (state.pose.translation.x - from).abs() > 0.1;
        passes.plan(&[optimum(0.05, 0.0)], is_off(0.05));
        assert!(passes.is_first() && !passes.is_due() && passes.prior_width() == 1.0, "the candidate may be right");
        // The third optimum is excluded.
        passes.plan(&[optimum(0.3, 0.0), optimum(0.1, 5.0), optimum(0.0, 90.0)], is_off(0.3));
        let known: Vec<f64> = passes.known.iter().map(|state| state.pose.translation.x).collect();
        assert!(passes.is_first() && passes.is_due() && passes.prior_width() == WIDER);
        assert_eq!((known, passes.centre.pose.translation.x), (vec![0.3, 0.1], 0.0));
        passes.is_due = false;
        passes.plan(&[optimum(0.5, 0.0)], is_off(0.5));
        assert_eq!((passes.is_first(), passes.is_due(), passes.centre.pose.translation.x), (false, true, 0.5));
        passes.is_due = false;
        passes.plan(&[optimum(0.55, 0.0)], is_off(0.55));
        assert!(!passes.is_due(), "the estimate stays");
        // An estimate that never stays ends the search after the last pass.
        for x in 1..9 {
            passes.plan(&[optimum(f64::from(x), 0.0)], |_| true);
        }
        assert_eq!(passes.done, MOST - 1);
    }

    #[test]
    fn progress_grows_from_pass_to_pass() {
        let mut passes = Passes::new(at(0.0), vec![]);
        let mut last = -1.0;
        for done in 0..MOST {
            passes.done = done;
            for share in [0.0, 0.5, 1.0] {
                let progress = passes.progress(share);
                assert!(progress >= last && progress <= 1.0, "{done} {share}: {progress} after {last}");
                last = progress;
            }
        }
    }

    #[test]
    fn the_prior_about_a_contradicted_candidate_is_wider_for_its_pose_alone() {
        let mut scene = simulated::scene(Size { width: 64, height: 48 }, 60.0, |_| 1.0, |_| 0.5, &[Cue::Edges]);
        let units = scene.units(&at(0.0));
        let first = scene.prior(&units);
        scene.prior_width = WIDER;
        let second = scene.prior(&units);
        let (pose, others) = ((0, 0), (POSE, POSE));
        let of_pose = |prior: &Matrix| prior.fixed_view::<POSE, POSE>(0, 0).into_owned();
        assert!((of_pose(&first) - of_pose(&second) * WIDER.powi(2)).norm() < 1e-9 * first[pose]);
        assert_eq!(first[others], second[others]);
    }
}
