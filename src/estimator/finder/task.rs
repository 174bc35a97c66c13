//! Tasks of the search that a worker may perform, their findings, and both as plain numbers, the only form in which
//! threads without shared memory can exchange them. An f64 holds every number here to the bit.

use nalgebra::{Matrix3, Vector3};

use super::local_optima::RegisteredCandidate;
use crate::pose::{Candidate, Hypothesis, SearchFinding, SearchTask, Similarity};

/// A part of the search. It depends only on the pair, the options and itself, so every worker gets the same result.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Task(pub(in crate::estimator) Work);

#[derive(Clone, Copy, Debug, PartialEq)]
pub(in crate::estimator) enum Work {
    Search(SearchTask),
    /// Registration of a candidate, given by its number and pose, and whether it is held near the initial pose.
    Register(usize, Similarity, bool),
}

/// The result of a [`Task`].
#[derive(Clone, Debug)]
pub struct Finding(pub(in crate::estimator) Found);

#[derive(Clone, Debug)]
pub(in crate::estimator) enum Found {
    Search(SearchFinding),
    /// `None` if the candidate could not be registered.
    Registered(usize, Option<RegisteredCandidate>),
}

/// The first number identifies the kind of task or finding.
const SWEEP: f64 = 0.0;
const ASCEND: f64 = 1.0;
const REGISTER: f64 = 2.0;
const REGISTER_NEAR: f64 = 3.0;

impl Task {
    /// As plain numbers.
    #[must_use]
    pub fn to_numbers(&self) -> Vec<f64> {
        match &self.0 {
            Work::Search(SearchTask::Sweep(slice)) => list(SWEEP, *slice, &[]),
            Work::Search(SearchTask::Ascend(index, hypothesis)) => {
                list(ASCEND, *index, &hypothesis_numbers(hypothesis))
            }
            Work::Register(index, pose, is_near) => {
                list(if *is_near { REGISTER_NEAR } else { REGISTER }, *index, &pose_numbers(pose))
            }
        }
    }

    /// Inverse of [`to_numbers`](Self::to_numbers); `None` for any other numbers.
    #[must_use]
    pub fn from_numbers(numbers: &[f64]) -> Option<Self> {
        let (&[kind, index], rest) = numbers.split_first_chunk()?;
        let index = index as usize;
        Some(Self(match kind {
            SWEEP if rest.is_empty() => Work::Search(SearchTask::Sweep(index)),
            ASCEND => Work::Search(SearchTask::Ascend(index, hypothesis(rest.try_into().ok()?))),
            REGISTER | REGISTER_NEAR => Work::Register(index, pose(rest.try_into().ok()?), kind == REGISTER_NEAR),
            _ => return None,
        }))
    }
}

impl Finding {
    /// As plain numbers.
    #[must_use]
    pub fn to_numbers(&self) -> Vec<f64> {
        let (mut numbers, rest) = match &self.0 {
            Found::Search(SearchFinding::Swept(slice, hypotheses)) => {
                let hypotheses: Vec<_> = hypotheses.iter().map(hypothesis_numbers).collect();
                return list(SWEEP, *slice, hypotheses.as_flattened());
            }
            Found::Registered(index, None) => return list(REGISTER, *index, &[]),
            Found::Search(SearchFinding::Ascended(index, candidate)) => {
                (list(ASCEND, *index, &pose_numbers(&candidate.pose)), &[candidate.score][..])
            }
            Found::Registered(index, Some(end)) => {
                (list(REGISTER, *index, &pose_numbers(&end.pose)), &[end.visible, end.noise][..])
            }
        };
        numbers.extend_from_slice(rest);
        numbers
    }

    /// Inverse of [`to_numbers`](Self::to_numbers); `None` for any other numbers.
    #[must_use]
    pub fn from_numbers(numbers: &[f64]) -> Option<Self> {
        let (&[kind, index], rest) = numbers.split_first_chunk()?;
        let index = index as usize;
        Some(Self(match kind {
            SWEEP => {
                let (hypotheses, surplus) = rest.as_chunks();
                if !surplus.is_empty() {
                    return None;
                }
                Found::Search(SearchFinding::Swept(index, hypotheses.iter().map(hypothesis).collect()))
            }
            ASCEND => {
                let (start, &[score]) = rest.split_first_chunk()? else { return None };
                Found::Search(SearchFinding::Ascended(index, Candidate { pose: pose(start), score }))
            }
            REGISTER if rest.is_empty() => Found::Registered(index, None),
            REGISTER => {
                let (end, &[visible, noise]) = rest.split_first_chunk()? else { return None };
                Found::Registered(index, Some(RegisteredCandidate { pose: pose(end), visible, noise, report: None }))
            }
            _ => return None,
        }))
    }
}

fn list(kind: f64, index: usize, rest: &[f64]) -> Vec<f64> {
    [&[kind, index as f64], rest].concat()
}

/// Scale, rotation, translation.
fn pose_numbers(pose: &Similarity) -> [f64; 13] {
    let mut numbers = [pose.scale; 13];
    numbers[1..10].copy_from_slice(pose.rotation.as_slice());
    numbers[10..].copy_from_slice(pose.translation.as_slice());
    numbers
}

fn pose(numbers: &[f64; 13]) -> Similarity {
    let [scale, rotation @ .., x, y, z] = *numbers;
    Similarity { scale, rotation: Matrix3::from_column_slice(&rotation), translation: Vector3::new(x, y, z) }
}

/// Size, rotation, shift, score.
fn hypothesis_numbers(hypothesis: &Hypothesis) -> [f64; 13] {
    let mut numbers = [hypothesis.size; 13];
    numbers[1..10].copy_from_slice(hypothesis.rotation.as_slice());
    numbers[10..].copy_from_slice(&[f64::from(hypothesis.shift[0]), f64::from(hypothesis.shift[1]), hypothesis.score]);
    numbers
}

fn hypothesis(numbers: &[f64; 13]) -> Hypothesis {
    let [size, rotation @ .., column, row, score] = *numbers;
    Hypothesis { rotation: Matrix3::from_column_slice(&rotation), size, shift: [column as i32, row as i32], score }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_come_back_as_they_went() {
        let hypothesis =
            Hypothesis { rotation: Matrix3::from_fn(|i, j| (i + 3 * j) as f64), size: 0.9, shift: [-3, 4], score: 0.1 };
        let pose = Similarity { translation: Vector3::new(0.1, 0.2, 0.3), ..Similarity::identity() };
        for work in [
            Work::Search(SearchTask::Sweep(7)),
            Work::Search(SearchTask::Ascend(3, hypothesis)),
            Work::Register(5, pose, false),
            Work::Register(6, pose, true),
        ] {
            assert_eq!(Task::from_numbers(&Task(work).to_numbers()), Some(Task(work)));
        }
        let registered = RegisteredCandidate { pose, visible: 9.0, noise: 0.1, report: None };
        for found in [
            Found::Search(SearchFinding::Swept(2, vec![hypothesis; 2])),
            Found::Search(SearchFinding::Swept(2, Vec::new())),
            Found::Search(SearchFinding::Ascended(1, Candidate { pose, score: -1.5 })),
            Found::Registered(4, Some(registered)),
            Found::Registered(4, None),
        ] {
            let numbers = Finding(found).to_numbers();
            assert_eq!(Finding::from_numbers(&numbers).map(|finding| finding.to_numbers()), Some(numbers));
        }
    }

    #[test]
    fn other_numbers_are_refused() {
        for numbers in [&[][..], &[0.0], &[3.0, 0.0], &[4.0, 0.0], &[1.0, 0.0, 1.0], &[f64::NAN, 0.0]] {
            assert!(Task::from_numbers(numbers).is_none());
            assert!(Finding::from_numbers(numbers).is_none());
        }
        assert!(Finding::from_numbers(&[0.0, 0.0, 1.0]).is_none());
    }
}
