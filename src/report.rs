//! The report of the loop after each step.

use crate::pose::{Similarity, Uncertainty};
use crate::reason::Reason;

/// Stages of one iteration, in the order in which they run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Stage {
    /// A slice of the finder: over all poses before the first iteration, or around an initial pose within it.
    Search,
    /// Fit of an unknown light (Eq. 2).
    Light,
    /// Normals of the colour view (Eq. 6 to 9).
    Shading,
    /// Heights from these normals.
    Surface,
    /// Pose, photometric or between both surfaces (Eq. 12 to 16).
    Registration,
    /// Normals and depth of the depth view (Eq. 17 to 19).
    Refinement,
}

impl Stage {
    /// The stage after this one; the last is followed by the first of the next iteration.
    #[must_use]
    pub const fn next(self) -> Self {
        match self {
            Self::Search => Self::Light,
            Self::Light => Self::Shading,
            Self::Shading => Self::Surface,
            Self::Surface => Self::Registration,
            Self::Registration => Self::Refinement,
            Self::Refinement => Self::Light,
        }
    }

    /// The stages of an iteration in order; the search precedes the first iteration.
    pub const ALL: [Self; 5] = [Self::Light, Self::Shading, Self::Surface, Self::Registration, Self::Refinement];

    /// Lower-case name, as in JavaScript.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Search => "search",
            Self::Light => "light",
            Self::Shading => "shading",
            Self::Surface => "surface",
            Self::Registration => "registration",
            Self::Refinement => "refinement",
        }
    }
}

/// State of the loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
pub enum Status {
    /// More steps will change the result.
    Running,
    /// The rotation has settled.
    Converged,
    /// The maximum number of iterations was reached first.
    MaxIterations,
    /// The data allow other poses as well.
    Ambiguous,
    /// The answer cannot be trusted.
    Lost,
}

impl Status {
    /// Lower-case name, as in JavaScript.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Running => "running",
            Self::Converged => "converged",
            Self::MaxIterations => "max-iterations",
            Self::Ambiguous => "ambiguous",
            Self::Lost => "lost",
        }
    }
}

/// The terms of Eq. 1, each a robust mean, so that they do not depend on the image's size.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(into = "serialised::Energy"))]
pub struct Objective {
    /// Brightness term l_1 of the colour view (Eq. 8).
    pub shading: f64,
    /// Shape prior l_2 of the colour view (Eq. 9).
    pub prior: f64,
    /// Distance f of both surfaces (Eq. 12).
    pub registration: f64,
    /// Term g of the depth view (Eq. 17).
    pub refinement: f64,
}

impl Objective {
    /// Sum of all terms, by which an iteration is accepted or rejected.
    #[must_use]
    pub fn total(&self) -> f64 {
        self.shading + self.prior + self.registration + self.refinement
    }
}

/// State of the loop after a step or a stage.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "camelCase"))]
pub struct StepReport {
    /// Completed iterations.
    pub iteration: u32,
    /// The stage that ran last.
    pub stage: Stage,
    /// Current pose.
    pub pose: Similarity,
    /// Change of the rotation in the last iteration, degrees.
    pub rotation_change: f64,
    /// Terms of the objective over the evaluation points.
    #[cfg_attr(feature = "serde", serde(rename = "energy"))]
    pub objective: Objective,
    /// Share of the valid depth pixels that have a correspondence.
    pub overlap: f64,
    /// Share of the visible depth points that lie within three medians of the image surface; points too far away to
    /// correspond count as visible.
    pub inliers: f64,
    /// Robust mean of the log-colour residual.
    pub residual: f64,
    /// State of the loop.
    pub status: Status,
    /// The reason for the status, if there is one.
    #[cfg_attr(feature = "serde", serde(flatten, serialize_with = "serialised::with_message"))]
    pub reason: Option<Reason>,
    /// Other poses that the data cannot distinguish from this one, best first.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Vec::is_empty"))]
    pub rivals: Vec<Similarity>,
    /// One sigma of the pose, if it could be computed.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub uncertainty: Option<Uncertainty>,
}

/// Poses within this many sigmas of each other are the same answer.
const NEAR_SIGMAS: f64 = 3.0;

impl StepReport {
    /// The report of iteration zero.
    pub(crate) fn at(pose: Similarity) -> Self {
        Self {
            iteration: 0,
            stage: Stage::Light,
            pose,
            rotation_change: 0.0,
            objective: Objective::default(),
            overlap: 0.0,
            inliers: 0.0,
            residual: 0.0,
            status: Status::Running,
            reason: None,
            rivals: Vec::new(),
            uncertainty: None,
        }
    }

    /// Drops the rivals within three sigmas of the pose, unless its own sigma exceeds the tolerance, in degrees.
    pub(crate) fn drop_near_rivals(&mut self, tolerance: f64) {
        if let Some(uncertainty) = &self.uncertainty {
            let (pose, sigma) = (self.pose, uncertainty.largest_rotation());
            self.rivals.retain(|rival| sigma > tolerance || rival.degrees_to(&pose) > NEAR_SIGMAS * sigma);
        }
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{Rotation3, Vector3};

    use super::*;
    use crate::pose::Direction;

    #[test]
    fn rivals_within_three_sigmas_are_dropped() {
        let turned = |degrees: f64| Similarity {
            rotation: Rotation3::new(Vector3::y() * degrees.to_radians()).into_inner(),
            ..Similarity::identity()
        };
        let mut report = StepReport::at(turned(0.0));
        report.rivals = vec![turned(20.0), turned(4.0), turned(7.0)];
        report.drop_near_rivals(2.5);
        assert_eq!(report.rivals.len(), 3, "the sigma is unknown");
        let rotation_degrees = [0.3, 2.0, 0.1];
        let weakest = Direction::default();
        report.uncertainty = Some(Uncertainty { rotation_degrees, translation: [None; 3], scale: None, weakest });
        report.drop_near_rivals(1.5);
        assert_eq!(report.rivals.len(), 3, "the pose itself is uncertain");
        report.drop_near_rivals(2.5);
        assert_eq!(report.rivals, [turned(20.0), turned(7.0)]);
    }
}

/// Members of the contract that are computed when a report leaves the crate: sums and messages.
#[cfg(feature = "serde")]
mod serialised {
    use serde::{Serialize, Serializer};

    use super::{Objective, Reason};

    #[derive(Serialize)]
    pub struct Energy {
        shading: f64,
        prior: f64,
        registration: f64,
        refinement: f64,
        total: f64,
    }

    impl From<Objective> for Energy {
        fn from(terms: Objective) -> Self {
            let Objective { shading, prior, registration, refinement } = terms;
            Self { shading, prior, registration, refinement, total: terms.total() }
        }
    }

    pub fn with_message<S: Serializer>(reason: &Option<Reason>, serializer: S) -> Result<S::Ok, S::Error> {
        #[derive(Serialize)]
        struct Explained<'a> {
            #[serde(skip_serializing_if = "Option::is_none")]
            message: Option<String>,
            #[serde(skip_serializing_if = "Option::is_none")]
            reason: &'a Option<Reason>,
        }
        Explained { message: reason.as_ref().map(Reason::to_string), reason }.serialize(serializer)
    }
}
