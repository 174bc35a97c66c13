//! The search over other readings of a candidate that does not pass.
//!
//! Each reading is registered from its own pose with a prior about that pose, level by level, and the worst drop out. The
//! best is adopted only if the frames exclude every pose found near the candidate itself.

use super::optima::{self, Optimum};
use super::planes::Planes;
use super::readings::Reading;
use super::registration::{ARRIVED, MOST_SETTLING, Round, SIGMAS, Scene, Start};
use super::unknowns::State;
use super::verdict::TOLERANCE;
use crate::numeric::sort_descending;
use crate::pose::Similarity;

/// Number of readings that proceed after each level, the best by score.
const SURVIVORS: [usize; 4] = [6, 3, 2, 1];

/// The poses of a candidate in all conventions. A reading that shrinks the rotation or translation below the tolerance is left out: if
/// both cameras have nearly the same pose, it would fit whatever is wrong with the candidate.
pub(super) fn readings_of(scene: &Scene, pose: &Similarity) -> Vec<(Reading, Similarity)> {
    let mut readings = vec![];
    for reading in Reading::POSES {
        for read in reading.of(pose) {
            let differs = |limit| {
                let (read, limit) = (State::at(read), State::at(limit));
                scene.units(&read).between(&read, &limit).norm() > TOLERANCE * scene.scale
            };
            if reading.limit(&read).is_none_or(differs) {
                readings.push((reading, read));
            }
        }
    }
    readings
}

/// The readings under way.
pub(super) struct Rereading {
    /// Poses found near the candidate itself.
    optima: Vec<Optimum>,
    starts: Vec<(Reading, Start)>,
    level: usize,
    /// Index of the next reading to register.
    index: usize,
    /// The images at this level.
    planes: Vec<Planes>,
}

impl Rereading {
    /// The readings of a candidate that put points onto the image.
    pub fn new(scene: &Scene, candidate: &State, mut optima: Vec<Optimum>) -> Self {
        // Nothing contradicts a pose that puts no points onto the image, so it does not compete.
        optima.retain(|optimum| scene.is_seen(&optimum.round.state));
        let start = |(reading, pose)| {
            let state = State::at(pose);
            let round = Round::from(state, state);
            scene.is_seen(&state).then(|| (reading, Start::at(round)))
        };
        let starts = readings_of(scene, &candidate.pose).into_iter().filter_map(start).collect();
        Self { optima, starts, level: 0, index: 0, planes: scene.planes(SIGMAS[0] * scene.scale) }
    }

    /// Registers one reading at one level. After the last level, registers the best reading with all cues on the finest
    /// images. Returns whether the search is over.
    pub fn step(&mut self, scene: &Scene, finest: &[Planes]) -> bool {
        if self.level == SIGMAS.len() {
            if let Some((_, start)) = self.starts.first_mut() {
                // Ends early if a step is short.
                let mut kept = None;
                let _ = (0..MOST_SETTLING).any(|_| scene.settle(&mut start.round, &mut kept, finest) < ARRIVED);
            }
            return true;
        }
        if let Some((_, start)) = self.starts.get_mut(self.index) {
            scene.find_anew(start);
            scene.approach(start, SIGMAS[self.level] * scene.scale, &self.planes);
            self.index += 1;
            return false;
        }
        sort_descending(&mut self.starts, |(_, start)| start.score);
        self.starts.truncate(SURVIVORS[self.level]);
        self.level += 1;
        self.index = 0;
        if let Some(sigma) = SIGMAS.get(self.level) {
            self.planes = scene.planes(sigma * scene.scale);
        }
        false
    }

    /// All optima, best first.
    pub fn end(self, scene: &Scene, planes: &[Planes]) -> Vec<Optimum> {
        let Self { mut optima, starts, .. } = self;
        for (reading, start) in starts {
            // The prior of a reading is centred on its own pose, so the reading replaces an optimum at the same place.
            let found = Optimum::at(scene, start.round, Some(reading), planes);
            optima.retain(|other| !other.is_near(&found.round.state, scene));
            optima.push(found);
        }
        optima::rank(&mut optima);
        optima
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::*;
    use crate::calibration::cue::Cue;
    use crate::calibration::simulated;
    use crate::view::Size;

    /// Read in a smaller unit, an error of the rotation or translation would vanish with it.
    #[test]
    fn a_reading_that_shrinks_a_pose_to_nothing_is_not_tried() {
        // A wall.
        let scene = simulated::scene(Size { width: 64, height: 48 }, 600.0, |_| 1.0, |_| 0.5, &[Cue::Edges]);
        let count = |radians: f64, metres: f64, reading: Reading| {
            let rotation = Rotation3::new(Vector3::x() * radians).into_inner();
            let pose = Similarity { scale: 1.0, rotation, translation: Vector3::x() * metres };
            readings_of(&scene, &pose).iter().filter(|(found, _)| *found == reading).count()
        };
        // Two degrees that were read as two radians, with up to four whole turns, and 50 mm that were read as 50 m.
        assert_eq!((count(2.0, 0.05, Reading::Degrees), count(0.09, 50.0, Reading::Millimetres)), (9, 1));
        // A rotation of five degrees, and 50 mm.
        assert_eq!((count(0.09, 0.05, Reading::Degrees), count(0.09, 0.05, Reading::Millimetres)), (8, 0));
    }
}
