//! Decrease of each cue's log likelihood as the calibration moves away from the estimate, axis by axis.

use super::cue::Cue;
use super::edges::EdgeField;
use super::frame::Projection;
use super::patches::{Patches, Sight};
use super::planes::Planes;
use super::registration::{Round, Scene};
use super::surfaces::Surfaces;
use super::unknowns::{POSE, State, Units, Vector};

/// Farthest offsets to each side: degrees about an axis, millimetres along one.
const FARTHEST_DEGREES: f64 = 5.0;
const FARTHEST_MILLIMETRES: f64 = 50.0;
/// Number of offsets to each side.
const OFFSETS: i32 = 8;
/// Maximum number of depth discontinuities of a frame.
const MOST_DISCONTINUITIES: usize = 400;

/// Names of the axes in the order of the unknowns.
pub(super) const AXES: [&str; POSE] = ["rx", "ry", "rz", "tx", "ty", "tz"];

/// The curve of one cue along one axis.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Sensitivity {
    /// The cue.
    pub cue: Cue,
    /// rx, ry, rz about the scene's middle, or tx, ty, tz, in the colour camera's frame.
    pub axis: &'static str,
    /// Degrees or millimetres from the estimate.
    pub offsets: Vec<f64>,
    /// Weighted log likelihood relative to that at the estimate.
    pub values: Vec<f64>,
}

/// The curves of one cue along all axes.
pub(super) fn curves(
    scene: &Scene,
    round: &Round,
    units: &Units,
    planes: &[Planes],
    (cue, weight): (Cue, f64),
) -> Vec<Sensitivity> {
    // Offsets are evenly spaced in their square roots, because a maximum is narrow.
    let shares = (-OFFSETS..=OFFSETS).map(|k| f64::from(k * k.abs()) / f64::from(OFFSETS * OFFSETS));
    let shares: Vec<f64> = shares.collect();
    let states: Vec<State> = (0..POSE)
        .flat_map(|axis| shares.iter().map(move |share| (axis, share)))
        .map(|(axis, share)| {
            let farthest = if axis < 3 { FARTHEST_DEGREES.to_radians() } else { FARTHEST_MILLIMETRES * 1e-3 };
            let mut step = Vector::zeros();
            step[axis] = share * farthest / units.of[axis];
            units.step(&round.state, &step)
        })
        .collect();
    let mut values = vec![0.0; states.len()];
    for (frame, planes) in planes.iter().enumerate() {
        let of_frame = match cue {
            Cue::Edges => edges_along(Sight { frame: &scene.frames[frame], planes }, round, units, &states),
            _ => surfaces_along(scene, round, cue, frame, &states),
        };
        values.iter_mut().zip(of_frame).for_each(|(value, more)| *value += weight * more);
    }
    let curve = |(axis, values): (usize, &[f64])| {
        let farthest = if axis < 3 { FARTHEST_DEGREES } else { FARTHEST_MILLIMETRES };
        let middle = values[OFFSETS as usize];
        Sensitivity {
            cue,
            axis: AXES[axis],
            offsets: shares.iter().map(|share| share * farthest).collect(),
            values: values.iter().map(|value| value - middle).collect(),
        }
    };
    values.chunks(shares.len()).enumerate().map(curve).collect()
}

/// The log likelihood by edges of one frame at the given states.
fn edges_along(sight: Sight<'_>, round: &Round, units: &Units, states: &[State]) -> Vec<f64> {
    let Sight { frame, planes } = sight;
    let discontinuities =
        EdgeField::discontinuities(frame, &Projection::new(frame, &round.state), MOST_DISCONTINUITIES);
    let value = |state: &State| {
        let moved = EdgeField::moved(frame, &discontinuities, &round.state, state);
        let field = EdgeField::new(Sight { frame, planes }, &moved, state, units, round.sigma);
        field.shares().iter().map(|share| share.value).sum::<f64>() * discontinuities.len() as f64
            / field.len().max(1) as f64
    };
    states.iter().map(value).collect()
}

/// The log likelihood by a cue over surfaces of one frame at the given states.
fn surfaces_along(scene: &Scene, round: &Round, cue: Cue, index: usize, states: &[State]) -> Vec<f64> {
    let frame = &scene.frames[index];
    let planes = &scene.surface_planes[index];
    let sight = Sight { frame, planes };
    let patches = Patches::new(&scene.samples[index], &Projection::new(frame, &round.state), frame);
    let surfaces = Surfaces::new(&[cue], &patches, sight, &round.state);
    states.iter().map(|state| surfaces.sum(state, &[1.0])).collect()
}
