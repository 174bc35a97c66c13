//! Conversion of keyword arguments to the crate's options, over its defaults.

use bimodal_stereo::{
    Light, LightGaussian, LightSource, Options, Registration, Shading, Start, StartTolerance, Weights,
};
use pyo3::prelude::*;

use crate::error::{failure, refused};
use crate::input::{POSE, pose};
use crate::members::{Members, unknown};

const NAMES: [&str; 16] = [
    "light",
    "prior",
    "start",
    "start_tolerance",
    "registration",
    "shading",
    "scale",
    "trim",
    "annealing",
    "lambda_",
    "stop_degrees",
    "tolerance",
    "max_iterations",
    "correspondence_distance",
    "seed",
    "workers",
];

/// The options in these keyword arguments; the others have their defaults.
pub fn options(keywords: &Bound<'_, PyAny>) -> PyResult<Options> {
    let given = Members::new(keywords, "", &NAMES)?;
    let default = Options::default();
    Ok(Options {
        light: light(&given)?,
        prior: prior(&given)?,
        start: start(&given)?.unwrap_or(default.start),
        start_tolerance: tolerance(&given, default.start_tolerance)?,
        scale: scale(&given)?,
        registration: given.word("registration", &REGISTRATIONS)?.unwrap_or(default.registration),
        shading: given.word("shading", &SHADINGS)?.unwrap_or(default.shading),
        weights: weights(&given, default.weights)?,
        stop_degrees: given.number("stop_degrees")?.unwrap_or(default.stop_degrees),
        tolerance: given.number("tolerance")?.unwrap_or(default.tolerance),
        correspondence_distance: given.number("correspondence_distance")?,
        max_iterations: given.whole("max_iterations")?.unwrap_or(default.max_iterations),
        seed: given.whole("seed")?.unwrap_or(default.seed),
        annealing: given.flag("annealing")?.unwrap_or(default.annealing),
        trim: given.flag("trim")?.unwrap_or(default.trim),
    })
}

/// Number of threads that share the work.
pub fn workers(keywords: &Bound<'_, PyAny>) -> PyResult<Option<usize>> {
    const MOST_WORKERS: usize = 16;
    let given = Members::new(keywords, "", &NAMES)?.whole("workers")?;
    match given {
        Some(count) if !(1..=MOST_WORKERS).contains(&count) => {
            let message = format!("must be a whole number from 1 to {MOST_WORKERS} (got {count})");
            Err(failure("range", "workers", &message))
        }
        other => Ok(other),
    }
}

const REGISTRATIONS: [(&str, Registration); 3] =
    [("joint", Registration::Joint), ("icp", Registration::Icp), ("fixed", Registration::Fixed)];
const SHADINGS: [(&str, Shading); 2] = [("surface", Shading::Surface), ("pixel", Shading::Pixel)];

/// A word in place of a value.
fn word_of(given: &Members<'_>, name: &str) -> PyResult<Option<String>> {
    Ok(given.get(name)?.and_then(|value| value.extract().ok()))
}

fn light(given: &Members<'_>) -> PyResult<LightSource> {
    match word_of(given, "light")?.as_deref() {
        Some("estimate") => return Ok(LightSource::Estimate),
        Some(word) => return Err(unknown("light", word, ["estimate", "or 27 numbers"].iter())),
        None => {}
    }
    let Some(values) = given.list("light")? else { return Ok(LightSource::Estimate) };
    Light::from_slice("light", &values).map(LightSource::Known).map_err(|error| refused(&error))
}

fn prior(given: &Members<'_>) -> PyResult<Option<LightGaussian>> {
    let Some(prior) = given.below("prior", &["mean", "covariance"])? else { return Ok(None) };
    let list = |name| prior.needed(name, prior.list(name)?);
    Ok(Some(LightGaussian { mean: list("mean")?, covariance: list("covariance")? }))
}

fn start(given: &Members<'_>) -> PyResult<Option<Start>> {
    match word_of(given, "start")?.as_deref() {
        Some("search") => return Ok(Some(Start::Search)),
        Some("identity") => return Ok(Some(Start::Identity)),
        Some(word) => return Err(unknown("start", word, ["search", "identity", "or a pose"].iter())),
        None => {}
    }
    let Some(members) = given.below("start", &POSE)? else { return Ok(None) };
    let given = pose(&members)?;
    let rotation = given.rotation.unwrap_or_else(bimodal_stereo::nalgebra::Matrix3::identity);
    Ok(Some(Start::Pose { rotation, scale: given.scale, translation: given.translation }))
}

fn tolerance(given: &Members<'_>, default: StartTolerance) -> PyResult<StartTolerance> {
    let Some(tolerance) = given.below("start_tolerance", &["degrees", "distance"])? else { return Ok(default) };
    Ok(StartTolerance {
        degrees: tolerance.number("degrees")?.unwrap_or(default.degrees),
        distance: tolerance.number("distance")?,
    })
}

fn scale(given: &Members<'_>) -> PyResult<Option<f64>> {
    match word_of(given, "scale")?.as_deref() {
        Some("free") => Ok(None),
        Some(word) => Err(unknown("scale", word, ["free", "or a number"].iter())),
        None => given.number("scale"),
    }
}

fn weights(given: &Members<'_>, default: Weights) -> PyResult<Weights> {
    let Some(lambda) = given.below("lambda_", &["prior", "unit", "light", "refinement"])? else { return Ok(default) };
    let weight = |name, default| Ok::<_, PyErr>(lambda.number(name)?.unwrap_or(default));
    Ok(Weights {
        prior: weight("prior", default.prior)?,
        unit: weight("unit", default.unit)?,
        light: weight("light", default.light)?,
        refinement: weight("refinement", default.refinement)?,
    })
}
