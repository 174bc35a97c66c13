//! The messages of threads: tasks, findings and refinements as plain numbers, intact and damaged.

use arbitrary::{Result, Unstructured};
use bimodal_stereo::{Estimator, Finding, Status, Task, Worker};

use super::named;
use super::numbers::{number, odd, rarely};
use super::views::{Pair, pair};

/// Limit of the rounds of messages.
const MOST_ROUNDS: u8 = 24;

pub fn run(data: &[u8]) {
    let _ = attempt(&mut Unstructured::new(data));
}

fn attempt(u: &mut Unstructured<'_>) -> Result<()> {
    let Pair { image, depth, options } = pair(u)?;
    let worker = Worker::new(image.clone(), &depth, options.clone());
    let (mut estimator, mut worker) = match (Estimator::new(image, &depth, options), worker) {
        (Ok(estimator), Ok(worker)) => (estimator, worker),
        (refused, also) => {
            refused.err().into_iter().chain(also.err()).for_each(|error| named(&error));
            return Ok(());
        }
    };
    for _ in 0..u.int_in_range(5..=MOST_ROUNDS)? {
        match u.int_in_range(0..=7)? {
            0 | 1 => task(u, &mut estimator, &mut worker)?,
            2 => refinement(u, &mut estimator, &mut worker)?,
            3 => finding(u, &mut estimator)?,
            _ => {
                estimator.step_stage();
            }
        }
        if estimator.report().status != Status::Running {
            break;
        }
    }
    estimator.step();
    Ok(())
}

/// Sends a task to the worker and its finding back; numbers may be damaged on either way.
fn task(u: &mut Unstructured<'_>, estimator: &mut Estimator, worker: &mut Worker) -> Result<()> {
    let mut numbers = match estimator.take_task() {
        Some(task) => task.to_numbers(),
        None => foreign(u)?,
    };
    damage(u, &mut numbers)?;
    let Some(task) = Task::from_numbers(&numbers) else { return Ok(()) };
    match worker.perform(&task) {
        Ok(finding) => {
            let mut numbers = finding.to_numbers();
            damage(u, &mut numbers)?;
            if let Some(finding) = Finding::from_numbers(&numbers) {
                estimator.accept_finding(finding);
            }
        }
        Err(error) => named(&error),
    }
    Ok(())
}

/// A finding that no worker made.
fn finding(u: &mut Unstructured<'_>, estimator: &mut Estimator) -> Result<()> {
    if let Some(finding) = Finding::from_numbers(&foreign(u)?) {
        estimator.accept_finding(finding);
    }
    Ok(())
}

fn refinement(u: &mut Unstructured<'_>, estimator: &mut Estimator, worker: &mut Worker) -> Result<()> {
    let held = if u.arbitrary()? { Some(u.arbitrary()?) } else { None };
    let Some(task) = estimator.refinement_task(held) else { return Ok(()) };
    let (shape, mut numbers) = (task.shape, task.numbers.clone());
    let planes: Vec<Vec<f32>> = task.planes.iter().map(|plane| plane.to_vec()).collect();
    damage(u, &mut numbers)?;
    let spoiled = if rarely(u, 4)? { Some((u.int_in_range(0..=8)?, odd(u)? as f32)) } else { None };
    let refined = worker.refine(&numbers, |places| {
        for (index, (place, plane)) in places.into_iter().zip(&planes).enumerate() {
            place.copy_from_slice(plane);
            if let Some((_, value)) = spoiled.filter(|&(which, _)| which == index) {
                place.iter_mut().step_by(3).for_each(|entry| *entry = value);
            }
        }
    });
    match refined {
        Ok(made) => {
            if let Some(places) = estimator.accept_refinement(shape) {
                for (place, made) in places.into_iter().zip(made) {
                    place.copy_from_slice(made);
                }
            }
        }
        Err(error) => named(&error),
    }
    Ok(())
}

/// Numbers of a length that tasks or findings have.
fn foreign(u: &mut Unstructured<'_>) -> Result<Vec<f64>> {
    let length = *u.choose(&[15, 2, 16, 17, 28, 3, 0, 1])?;
    let mut numbers = vec![f64::from(u.int_in_range(0_u8..=3)?), f64::from(u.arbitrary::<u8>()?)];
    while numbers.len() < length {
        numbers.push(number(u, 1.0)?);
    }
    numbers.truncate(length);
    Ok(numbers)
}

fn damage(u: &mut Unstructured<'_>, numbers: &mut Vec<f64>) -> Result<()> {
    if !rarely(u, 4)? {
        return Ok(());
    }
    for _ in 0..u.int_in_range(1..=3)? {
        let Some(last) = numbers.len().checked_sub(1) else { return Ok(()) };
        let index = u.int_in_range(0..=last)?;
        numbers[index] = number(u, -numbers[index])?;
    }
    if rarely(u, 4)? {
        numbers.pop();
    }
    Ok(())
}
