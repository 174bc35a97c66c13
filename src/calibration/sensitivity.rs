//! How each cue falls as the calibration is moved away from the estimate, axis by axis.

use super::cue::Cue;
use super::edges::EdgeField;
use super::evidence::{Share, Tiles};
use super::frame::Projection;
use super::information::Information;
use super::patches::{Patches, Sight};
use super::planes::Planes;
use super::registration::{Round, Scene};
use super::shading::Shading;
use super::silhouette::Silhouette;
use super::unknowns::{POSE, State, Units, Vector};

/// Offsets to each side: degrees about an axis, millimetres along one.
const FARTHEST_DEGREES: f64 = 5.0;
const FARTHEST_MILLIMETRES: f64 = 50.0;
/// Offsets to each side.
const OFFSETS: i32 = 8;
/// Rims of a frame whose edges are looked at.
const MOST_RIMS: usize = 400;

/// Names of the axes in the order of the unknowns.
pub(super) const AXES: [&str; POSE] = ["rx", "ry", "rz", "tx", "ty", "tz"];

/// One curve.
#[derive(Clone, Debug, PartialEq)]
pub struct Sensitivity {
    /// Which cue.
    pub cue: Cue,
    /// rx, ry, rz about the scene's middle, tx, ty, tz; colour camera's frame.
    pub axis: &'static str,
    /// Degrees or millimetres from the estimate.
    pub offsets: Vec<f64>,
    /// Log likelihood, its weight applied, less that at the estimate.
    pub values: Vec<f64>,
}

/// The curves of one cue along one axis.
pub(super) fn curve(
    scene: &Scene,
    round: &Round,
    units: &Units,
    planes: &[Planes],
    (cue, weight): (Cue, f64),
    axis: usize,
) -> Sensitivity {
    let (farthest, unit) =
        if axis < 3 { (FARTHEST_DEGREES, 1.0_f64.to_radians()) } else { (FARTHEST_MILLIMETRES, 1e-3) };
    // Evenly spread in the square root: a minimum is narrow.
    let offsets: Vec<f64> =
        (-OFFSETS..=OFFSETS).map(|k| f64::from(k * k.abs()) / f64::from(OFFSETS * OFFSETS) * farthest).collect();
    let states: Vec<State> = offsets
        .iter()
        .map(|offset| {
            let mut step = Vector::zeros();
            step[axis] = offset * unit / units.of[axis];
            units.step(&round.state, &step)
        })
        .collect();
    let mut values = vec![0.0; offsets.len()];
    for frame in 0..scene.frames.len() {
        let of_frame = along(scene, round, units, &planes[frame], cue, frame, &states);
        values.iter_mut().zip(of_frame).for_each(|(value, more)| *value += weight * more);
    }
    let middle = values[OFFSETS as usize];
    values.iter_mut().for_each(|value| *value -= middle);
    Sensitivity { cue, axis: AXES[axis], offsets, values }
}

/// The log likelihood of one frame at some states.
fn along(
    scene: &Scene,
    round: &Round,
    units: &Units,
    planes: &Planes,
    cue: Cue,
    index: usize,
    states: &[State],
) -> Vec<f64> {
    let frame = &scene.frames[index];
    if cue == Cue::Edges {
        let rims = EdgeField::rims(frame, &Projection::new(frame, &round.state), MOST_RIMS);
        let value = |state: &State| {
            let moved = EdgeField::moved(frame, &rims, &round.state, state);
            let field = EdgeField::new(
                frame,
                planes,
                &moved,
                state,
                units,
                round.sigma,
                super::registration::blur(round.sigma),
            );
            let mut shares = vec![Share::none(); Tiles::new(planes.size).count()];
            field.evidence(round.sigma, &mut shares);
            shares.iter().map(|share| share.value).sum::<f64>() * rims.len() as f64 / field.len().max(1) as f64
        };
        return states.iter().map(value).collect();
    }
    let sight = Sight { frame, planes: &scene.surface_planes[index] };
    let patches = Patches::new(&scene.samples[index], &Projection::new(frame, &round.state), frame);
    let mut out = vec![0.0; Tiles::new(planes.size).count()];
    let shading = (cue == Cue::Shading).then(|| Shading::new(&patches, &sight, &round.state));
    let silhouette = if cue == Cue::Silhouette { Silhouette::new(&patches, &sight) } else { None };
    let mut value = |state: &State| {
        out.fill(0.0);
        if let Some(shading) = &shading {
            shading.evaluate(&sight, state, &mut out);
        } else if let Some(silhouette) = &silhouette {
            silhouette.evaluate(&sight, state, &mut out);
        } else if cue == Cue::Information {
            Information(&patches).evaluate(&sight, state, &mut out);
        }
        out.iter().sum::<f64>()
    };
    states.iter().map(&mut value).collect()
}
