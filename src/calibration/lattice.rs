//! Lattices of states about the initial one, so that rounding does not choose between states.
//!
//! The objective is rough: a depth discontinuity or a sample is seen or not, and an image edge appears or vanishes. In
//! a direction that is hardly determined, a round multiplies a small difference of states by ten. After each round, the
//! state therefore moves to the nearest node of a fine lattice. Visibility is computed at the nearest node of a coarse
//! one. Limit: a candidate that differs by more than rounding shifts both lattices, and the estimate may end elsewhere
//! within its covariance.

use super::registration::{Round, Scene};
use super::unknowns::{FOCAL, POSE, State, UNKNOWNS, Vector};

/// Spacing of the lattice of states at which visibility is computed, pixels of an image 640 wide.
const SPACING: f64 = 1.0;
/// Spacing of the states at which rounds end, pixels of an image 640 wide, less than a step that has converged. It is
/// an odd fraction of `SPACING`, so that no state lies halfway between two states at which visibility is computed.
const RESOLUTION: f64 = SPACING / 127.0;

impl Scene {
    /// Moves the state at which a round computes visibility if the round's own state is farther from it than the
    /// spacing. Returns whether it moved. Visibility jumps as the pose changes, but changes little within a pixel. It
    /// is therefore computed at the nearest node of a lattice about the initial state, which rounding does not move.
    pub fn look(&self, round: &mut Round) -> bool {
        let spacing = SPACING * self.scale;
        let units = self.units(&round.initial);
        let [from, to] = [round.seen_from, round.state].map(|state| units.between(&round.initial, &state));
        let moves = |k: &usize| *k < POSE || *k == FOCAL;
        // This limit lies between two states of the finer lattice, so that rounding does not decide.
        let farthest = spacing + 0.5 * RESOLUTION * self.scale;
        if (0..UNKNOWNS).filter(moves).all(|k| (to[k] - from[k]).abs() <= farthest) {
            return false;
        }
        let place = |k: usize, _| if moves(&k) { (to[k] / spacing).round() * spacing } else { 0.0 };
        round.seen_from = units.step(&round.initial, &Vector::from_fn(place));
        true
    }

    /// The nearest node of the finer lattice about the initial state. Another order of sums, other axes of the cloud or
    /// another processor change a step by rounding. Steps that differ by this little end at the same node, so the
    /// rounding of one round does not grow in the next.
    pub fn on_lattice(&self, initial: &State, state: &State) -> State {
        let units = self.units(initial);
        let spacing = RESOLUTION * self.scale;
        let place = units.between(initial, state).map(|value| (value / spacing).round() * spacing);
        units.step(initial, &place)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::cue::Cue;
    use crate::calibration::simulated;
    use crate::pose::Similarity;
    use crate::view::Size;

    fn scene() -> Scene {
        let depth = |[column, _]: [usize; 2]| if column < 32 { 1.0 } else { 2.0 };
        simulated::scene(Size { width: 64, height: 48 }, 60.0, depth, |_| 0.5, &Cue::ALL)
    }

    #[test]
    fn rounds_that_differ_by_rounding_end_at_one_state() {
        let (scene, initial) = (scene(), State::at(Similarity::identity()));
        let units = scene.units(&initial);
        // No state lies halfway between two nodes.
        let step = Vector::from_fn(|k, _| 0.73 * k as f64 - 2.83);
        let [one, other] = [0.0, 1e-6].map(|error| {
            let state = units.step(&initial, &step.add_scalar(error));
            units.between(&initial, &scene.on_lattice(&initial, &state))
        });
        assert!((one - other).amax() < 1e-9, "{}", one - other);
        assert!((one - step).amax() < 0.5 * RESOLUTION + 1e-6, "{}", one - step);
    }

    /// Rounding errors in the state of a round do not change the state at which visibility is computed.
    #[test]
    fn rounding_does_not_choose_the_state_from_which_the_scene_is_seen() {
        let (scene, initial) = (scene(), State::at(Similarity::identity()));
        let units = scene.units(&initial);
        let at = |place: f64| units.step(&initial, &Vector::from_fn(|k, _| if k == 3 { place } else { 0.0 }));
        for node in 0..5 * 127 {
            let place = f64::from(node) * RESOLUTION;
            let seen = [-1e-9, 1e-9].map(|error| {
                let mut round = Round::from(at(place + error), initial);
                scene.look(&mut round);
                units.between(&initial, &round.seen_from)[3]
            });
            assert!((seen[0] - seen[1]).abs() < 1e-6, "{place}: {seen:?}");
        }
    }
}
