//! The frame to take next: the additional frame that would best determine the least certain unknown.
//!
//! Objective: the sigma of this unknown after one more frame. Method: the frame with the largest share of the evidence
//! is moved as a whole in front of the rig. Its depth edges keep their offsets from the image edges, and thus the slope
//! and the curvature of their log likelihoods along the normal; the derivatives of their pixels are those of the new
//! place. The tiles of this frame join those of all others, and the covariance follows as that of a check. Limits:
//! newly visible parts are unknown, occlusions stay as they are, and the cues over surfaces keep their present
//! contribution.

use std::fmt;

use nalgebra::{Rotation3, Vector3};

use super::cue::Cue;
use super::discontinuities::Discontinuity;
use super::distribution::{PoseMatrix, VARIANCE};
use super::edges::EdgeField;
use super::evidence::{Evidence, Tiles};
use super::frame::{Frame, Projection};
use super::patches::Sight;
use super::planes::Planes;
use super::registration::{Findings, Round, Scene};
use super::unknowns::{BIAS, POSE, SIDES, State, Units, Vector};
use super::verdict::{ORDER, UNSEEN_DEGREES, UNSEEN_METRES};
use crate::numeric::quantile;
use crate::pose::{Similarity, Unknown};
use crate::text::Fixed;

/// Share of the image's width by which a scene moves aside, up or down. The middle of the scene stays on the image.
const ASIDE: f64 = 0.25;
/// Share of the distance of the nearest tenth of the edges by which a scene comes nearer.
const NEARER: f64 = 0.35;
/// Least distance of the nearest tenth of the edges, metres, because depth cameras measure nothing nearer.
const NEAREST: f64 = 0.4;

/// How to move the scene in front of the rig for the next frame, starting from its place in one frame of the check.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum NextMotion {
    /// Nearer to both cameras.
    Nearer,
    /// To the left by a quarter of the image's width.
    Left,
    /// To the right by as much.
    Right,
    /// Up by as much.
    Up,
    /// Down by as much.
    Down,
    /// Rotated by 90 degrees about the line of sight, as when the rig is held upright.
    Turned,
}

/// The frame that would best determine the least certain unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct NextFrame {
    /// The least certain unknown, about the scene's middle, in the colour camera's frame.
    pub axis: Unknown,
    /// Its present sigma, degrees or millimetres.
    pub sigma: f64,
    /// Name of the frame that was moved.
    pub frame: String,
    /// How it was moved.
    pub motion: NextMotion,
    /// The motion of the scene as a pose in the colour camera's frame, metres.
    pub pose: Similarity,
    /// Sigma with this frame added to those of the check, degrees or millimetres.
    pub expected: f64,
}

impl fmt::Display for NextFrame {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unit = if matches!(self.axis, Unknown::Rotation(_)) { "degrees" } else { "mm" };
        let [sigma, expected] = [self.sigma, self.expected].map(|value| Fixed(value, if unit == "mm" { 1 } else { 2 }));
        write!(
            f,
            "The {} is the least certain ({sigma} {unit}, one sigma). One more frame with the scene ",
            self.axis
        )?;
        match self.motion {
            NextMotion::Nearer => write!(f, "{} m nearer", Fixed(-self.pose.translation.z, 1))?,
            NextMotion::Left => f.write_str("a quarter of the image further left")?,
            NextMotion::Right => f.write_str("a quarter of the image further right")?,
            NextMotion::Up => f.write_str("a quarter of the image further up")?,
            NextMotion::Down => f.write_str("a quarter of the image further down")?,
            NextMotion::Turned => f.write_str("rotated by 90 degrees in the image")?,
        }
        write!(f, " would reduce this to about {expected} {unit}.")
    }
}

/// The proposal at the end of a check; `None` without edges, if no frame would help, or if the colour camera is a guess.
pub(super) fn next(
    scene: &Scene,
    round: &Round,
    findings: &Findings,
    planes: &[Planes],
    covariance: &PoseMatrix,
) -> Option<NextFrame> {
    if scene.focal_is_free {
        return None;
    }
    let Findings { units, prior, total, .. } = findings;
    let (axis, sigma) = weakest(covariance);
    let hypothesis = Hypothesis::of(scene, round, findings, planes)?;
    let expected = |(motion, pose): (NextMotion, Similarity)| {
        let covariance = VARIANCE * hypothesis.total(total, &pose)?.covariance(prior)?;
        Some((displayed(axis, covariance[(axis, axis)].sqrt() * units.of[axis]), motion, pose))
    };
    let all = hypothesis.motions().into_iter().filter_map(expected).filter(|one| one.0 < sigma);
    let (expected, motion, pose) = all.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let frame = hypothesis.frame.name.clone();
    Some(NextFrame { axis: ORDER[axis], sigma, frame, motion, pose, expected })
}

/// Converts radians to degrees, and metres to millimetres.
fn displayed(axis: usize, sigma: f64) -> f64 {
    if axis < 3 { sigma.to_degrees() } else { 1000.0 * sigma }
}

/// The least certain unknown of the pose, and its sigma, degrees or millimetres.
fn weakest(covariance: &PoseMatrix) -> (usize, f64) {
    let unseen = |axis: usize| if axis < 3 { UNSEEN_DEGREES } else { 1000.0 * UNSEEN_METRES };
    let all = (0..POSE).map(|axis| (axis, displayed(axis, covariance[(axis, axis)].sqrt())));
    all.max_by(|a, b| (a.1 / unseen(a.0)).total_cmp(&(b.1 / unseen(b.0)))).unwrap_or((0, 0.0))
}

/// One of the frames, which is seen once more from another place.
struct Hypothesis<'a> {
    frame: &'a Frame,
    round: &'a Round,
    units: &'a Units,
    field: EdgeField,
    /// Weight of the edges.
    weight: f64,
    /// Evidence of the other cues, weighted.
    others: Evidence,
}

impl<'a> Hypothesis<'a> {
    /// The frame with the largest share of the evidence.
    fn of(scene: &'a Scene, round: &'a Round, findings: &'a Findings, planes: &[Planes]) -> Option<Self> {
        let mut first = 0;
        let mut best = (0.0, 0, 0..0);
        for (index, frame) in scene.frames.iter().enumerate() {
            let range = first..first + Tiles::new(frame.planes.size).count();
            first = range.end;
            let trace: f64 = findings.total.shares.get(range.clone())?.iter().map(|one| one.curvature.trace()).sum();
            if trace > best.0 {
                best = (trace, index, range);
            }
        }
        let (_, index, range) = best;
        let (frame, mut others, mut weight) = (&scene.frames[index], Evidence::default(), 0.0);
        for (cue, evidence, of_cue) in &findings.cues {
            if *cue == Cue::Edges {
                weight = *of_cue;
            } else {
                Evidence { shares: evidence.shares[range.clone()].to_vec() }.add_to(&mut others, *of_cue);
            }
        }
        let discontinuities =
            EdgeField::discontinuities(frame, &Projection::new(frame, &round.seen_from), scene.most_discontinuities());
        let discontinuities = EdgeField::moved(frame, &discontinuities, &round.seen_from, &round.state);
        let sight = Sight { frame, planes: planes.get(index)? };
        let field = EdgeField::new(sight, &discontinuities, &round.state, &findings.units, round.sigma);
        let is_told = weight > 0.0 && field.len() > 0;
        is_told.then_some(Self { frame, round, units: &findings.units, field, weight, others })
    }

    fn motions(&self) -> Vec<(NextMotion, Similarity)> {
        let camera = self.round.state.camera(&self.frame.camera);
        let angle = (ASIDE * self.frame.planes.size.width as f64 / camera.fx).atan();
        let about = |axis: Vector3<f64>, angle: f64| Similarity {
            rotation: Rotation3::new(axis * angle).into_inner(),
            ..Similarity::identity()
        };
        let mut motions =
            vec![(NextMotion::Left, about(Vector3::y(), -angle)), (NextMotion::Right, about(Vector3::y(), angle))];
        // A scanner is often mounted on a vehicle, which cannot tilt or roll.
        if !self.frame.is_cloud {
            motions.push((NextMotion::Up, about(Vector3::x(), angle)));
            motions.push((NextMotion::Down, about(Vector3::x(), -angle)));
            motions.push((NextMotion::Turned, about(Vector3::z(), std::f64::consts::FRAC_PI_2)));
        }
        let mut depths: Vec<f32> =
            self.field.all().filter_map(|discontinuity| Some(self.place(discontinuity)?.z as f32)).collect();
        let distance = f64::from(quantile(&mut depths, 0.1));
        if (1.0 - NEARER) * distance >= NEAREST {
            let translation = Vector3::new(0.0, 0.0, -NEARER * distance);
            motions.push((NextMotion::Nearer, Similarity { translation, ..Similarity::identity() }));
        }
        motions
    }

    /// Position of a depth edge in the colour camera's frame.
    fn place(&self, discontinuity: &Discontinuity) -> Option<Vector3<f64>> {
        Some(self.round.state.pose.apply(self.frame.point(discontinuity.index)?))
    }

    /// All evidence with that of the frame after a motion of its scene.
    fn total(&self, total: &Evidence, motion: &Similarity) -> Option<Evidence> {
        let shares = self.field.carried(|discontinuity| self.row(discontinuity, motion)).shares();
        let mut moved = self.others.clone();
        Evidence { shares }.add_to(&mut moved, self.weight);
        let mut all = total.clone();
        all.shares.extend(moved.shares);
        Some(all)
    }

    /// Derivative of the position of a depth edge after a motion, times the root of the edge's relative length on the
    /// image: twice the length has twice the curvature, and twice the variance of the slope. `None` off the image.
    fn row(&self, discontinuity: &Discontinuity, motion: &Similarity) -> Option<Vector> {
        let camera = self.round.state.camera(&self.frame.camera);
        let point = self.place(discontinuity)?;
        let [x, y] = discontinuity.normal;
        let along = Vector3::new(-y / camera.fx, x / camera.fy, 0.0) * point.z;
        let ([left, top], rows) = self.units.rows(&motion.apply(point), &camera)?;
        let size = self.frame.planes.size;
        if left < 0.0 || top < 0.0 || left > (size.width - 1) as f64 || top > (size.height - 1) as f64 {
            return None;
        }
        let [right, bottom] = camera.project(motion.apply(point + along).into())?;
        let length = (right - left).hypot(bottom - top);
        let normal = [(bottom - top) / length, (left - right) / length];
        let mut row = rows[0] * normal[0] + rows[1] * normal[1];
        row.fixed_rows_mut::<SIDES>(BIAS).copy_from_slice(&State::sides(normal));
        Some(row * length.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::calibration::simulated;
    use crate::calibration::unknowns::Matrix;
    use crate::view::Size;

    /// A bright square at 0.8 m in front of a dark wall at twice this distance.
    fn square() -> Scene {
        let is_near = |[column, row]: [usize; 2]| (38..58).contains(&column) && (26..46).contains(&row);
        let depth = |place| if is_near(place) { 0.8 } else { 1.6 };
        let grey = |place| if is_near(place) { 0.9 } else { 0.1 };
        simulated::scene(Size { width: 96, height: 72 }, 80.0, depth, grey, &[Cue::Edges])
    }

    /// The curvature of the evidence before a motion, and what the moved frame adds to it.
    fn before_and_added(motion: &Similarity) -> [Matrix; 2] {
        let scene = square();
        let state = State::at(Similarity::identity());
        let round = Round { sigma: 1.3, ..Round::from(state, state) };
        let planes = scene.planes(round.sigma);
        let findings = scene.findings(&round, &planes);
        let hypothesis = Hypothesis::of(&scene, &round, &findings, &planes).unwrap();
        let before = findings.total.curvature();
        [before, hypothesis.total(&findings.total, motion).unwrap().curvature() - before]
    }

    #[test]
    fn a_frame_that_did_not_move_adds_what_it_has() {
        let [before, added] = before_and_added(&Similarity::identity());
        assert!(before.trace() > 0.0 && (added - before).norm() < 1e-3 * before.norm(), "{before} {added}");
    }

    /// At half the distance a shift moves edges twice as far, and they are twice as long.
    #[test]
    fn a_scene_at_half_the_distance_adds_eight_times_as_much_about_shifts() {
        let translation = Vector3::new(0.0, 0.0, -0.4);
        let [before, added] = before_and_added(&Similarity { translation, ..Similarity::identity() });
        for axis in [3, 4] {
            let ratio = added[(axis, axis)] / before[(axis, axis)];
            assert!((ratio - 8.0).abs() < 0.5, "{axis}: {ratio}");
        }
    }

    #[test]
    fn a_rotation_in_the_image_exchanges_the_axes_and_edges_off_the_image_add_nothing() {
        let about = |axis: Vector3<f64>, angle: f64| Similarity {
            rotation: Rotation3::new(axis * angle).into_inner(),
            ..Similarity::identity()
        };
        let [before, added] = before_and_added(&about(Vector3::z(), std::f64::consts::FRAC_PI_2));
        assert!((added[(3, 3)] / before[(4, 4)] - 1.0).abs() < 0.05, "{added} {before}");
        let [_, added] = before_and_added(&about(Vector3::y(), 1.0));
        assert_eq!(added, Matrix::zeros());
    }
}
