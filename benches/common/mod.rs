//! Shared by the benches: runs a loop to its end and times each stage.

#![allow(dead_code, reason = "each bench uses a part of it")]

use std::time::Instant;

use bimodal_stereo::{ColourImage, DepthMap, Estimator, Options, Result, Shading, Similarity, Stage, Start, Status};

/// A pair of views with the pose to find.
pub struct Scene {
    pub image: ColourImage,
    pub depth: DepthMap,
    pub pose: Similarity,
}

/// One completed stage, with its wall time in milliseconds.
pub struct Timed {
    pub stage: Stage,
    /// Iterations completed before the stage.
    pub iteration: u32,
    pub milliseconds: f64,
}

/// The result of a run.
pub struct Run {
    pub stages: Vec<Timed>,
    pub status: Status,
    pub iterations: u32,
    /// Angle between the final pose and the true one, degrees.
    pub degrees: f64,
    /// From the views to the end, including the preparation, milliseconds.
    pub milliseconds: f64,
    /// From the views to the first stage, milliseconds.
    pub preparation: f64,
}

/// Starts at the true pose, where a search would end.
#[must_use]
pub fn near(scene: &Scene) -> Start {
    let Similarity { rotation, scale, translation } = scene.pose;
    Start::Pose { rotation, scale: Some(scale), translation: Some(translation) }
}

/// Runs to the end, or through `most` iterations.
///
/// # Errors
/// The errors of [`Estimator::new`].
pub fn run(scene: &Scene, start: Start, shading: Shading, most: u32) -> Result<Run> {
    let begun = Instant::now();
    // Nothing is known, except the pose where the search is skipped.
    let options = Options { start, shading, ..Options::default() };
    let mut estimator = Estimator::new(scene.image.clone(), &scene.depth, options)?;
    let preparation = milliseconds(begun);
    let mut stages = Vec::new();
    while estimator.report().status == Status::Running && estimator.report().iteration < most {
        let iteration = estimator.report().iteration;
        let start = Instant::now();
        let stage = estimator.step_stage().stage;
        stages.push(Timed { stage, iteration, milliseconds: milliseconds(start) });
    }
    let report = estimator.report();
    Ok(Run {
        stages,
        status: report.status,
        iterations: report.iteration,
        degrees: report.pose.degrees_to(&scene.pose),
        milliseconds: milliseconds(begun),
        preparation,
    })
}

/// Wall time since an instant, milliseconds.
pub fn milliseconds(since: Instant) -> f64 {
    since.elapsed().as_secs_f64() * 1e3
}
