//! Options of the caller, with their defaults and limits.

#[cfg(feature = "serde")]
mod serialised;

use nalgebra::{Matrix3, Vector3};

use crate::check::{not_negative, positive};
use crate::error::{Error, ErrorKind, Result};
use crate::light::{Light, LightGaussian, LightPrior};
use crate::pose::Similarity;

/// Source of the light.
#[expect(clippy::large_enum_variant, reason = "one value for each loop; a box would only complicate it")]
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "serialised::GivenLight", into = "serialised::GivenLight")
)]
pub enum LightSource {
    /// Fitted to the data under the Gaussian prior of Eq. 2.
    Estimate,
    /// Known up to the exposure, which is always estimated.
    Known(Light),
}

/// Initial pose.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(from = "serialised::GivenStart", into = "serialised::GivenStart")
)]
pub enum Start {
    /// Searched everywhere.
    Search,
    /// Both views coincide.
    Identity,
    /// A pose given by the caller, which may be partial.
    Pose {
        /// R.
        rotation: Matrix3<f64>,
        /// s; `None`: the ratio of the units of both views. It is not used if [`Options::scale`] is given or the view
        /// has a pinhole, where s is that scale or 1.
        scale: Option<f64>,
        /// t; `None`: the centroid of the depth points projects onto the centre of the image's mask.
        translation: Option<Vector3<f64>>,
    },
}

/// The region around a given initial pose in which the answer may lie.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct StartTolerance {
    /// Rotation in degrees.
    pub degrees: f64,
    /// Distance of the object's centre in units of the colour view; `None`: about the object's own width. Any distance
    /// is allowed if no translation was given.
    pub distance: Option<f64>,
}

impl Default for StartTolerance {
    fn default() -> Self {
        // Registrations converge from initial poses with this error.
        Self { degrees: 30.0, distance: None }
    }
}

/// How the pose is refined in each iteration.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Registration {
    /// Photometric registration: pose and light together, with the light projected out.
    Joint,
    /// The paper's stage: ICP, RANSAC on the linear model, similarity.
    Icp,
    /// The initial pose is kept.
    Fixed,
}

/// How the shape of the colour view is found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "kebab-case"))]
pub enum Shading {
    /// One normal for each pixel (Eq. 6), then integration.
    Pixel,
    /// As [`Pixel`](Self::Pixel), then the heights themselves: the surface determines what a poor light leaves
    /// undetermined in single pixels.
    Surface,
}

/// Weights of the terms of the objective. Brightness residuals are differences of natural logarithms; normals are
/// dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(default, deny_unknown_fields))]
pub struct Weights {
    /// lambda_2 of Eq. 6: the weight of the other view's normal.
    pub prior: f64,
    /// lambda_3 of Eq. 6: the weight of the unit length of a normal.
    pub unit: f64,
    /// lambda_L of Eq. 2: the weight of the prior over lights.
    pub light: f64,
    /// lambda_g2 of Eq. 17: the shape prior of the refinement.
    pub refinement: f64,
}

impl Default for Weights {
    fn default() -> Self {
        // For the light, 1e-6 admits colourful lights that occur in no landscape. It is noise^2 / pixels at 64x64.
        Self { prior: 0.05, unit: 1.0, light: 1e-6, refinement: 0.01 }
    }
}

/// Configuration of the estimator. `Options::default()` is a sensible starting point.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(
    feature = "serde",
    derive(serde::Serialize, serde::Deserialize),
    serde(rename_all = "camelCase", default, deny_unknown_fields)
)]
pub struct Options {
    /// Known or estimated light.
    pub light: LightSource,
    /// Prior over lights if the light is estimated; `None`: natural lights.
    #[cfg_attr(feature = "serde", serde(skip_serializing_if = "Option::is_none"))]
    pub prior: Option<LightGaussian>,
    /// Initial pose.
    pub start: Start,
    /// The region around a given initial pose in which the photometric registration may end.
    pub start_tolerance: StartTolerance,
    /// Scale of the pose: `None` is free, `Some(s)` is held.
    #[cfg_attr(feature = "serde", serde(with = "serialised::free_or_held"))]
    pub scale: Option<f64>,
    /// Method of the registration stage.
    pub registration: Registration,
    /// Method of the shading and surface stages.
    pub shading: Shading,
    /// Weights of the terms of the objective.
    #[cfg_attr(feature = "serde", serde(rename = "lambda"))]
    pub weights: Weights,
    /// The loop converges when the rotation changes by less than this, in degrees.
    pub stop_degrees: f64,
    /// The largest sigma of the rotation about any axis at which a run ends "converged", in degrees; above it, the run
    /// ends "ambiguous". A pose from the image or local contrast with a sigma above 5 degrees is "lost", whatever the
    /// tolerance. ICP reports sigmas, but its runs end regardless of them.
    pub tolerance: f64,
    /// Largest distance of a correspondence in image pixels; `None` adapts to the data (never below one pixel, the
    /// paper's value).
    pub correspondence_distance: Option<f64>,
    /// Largest number of iterations.
    pub max_iterations: u32,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Whether the photometric registration anneals its robust scale from wide to narrow; `false` is for ablation.
    pub annealing: bool,
    /// Whether flying pixels and background inside the mask are removed.
    pub trim: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            light: LightSource::Estimate,
            prior: None,
            start: Start::Search,
            start_tolerance: StartTolerance::default(),
            scale: None,
            registration: Registration::Joint,
            shading: Shading::Surface,
            weights: Weights::default(),
            stop_degrees: 0.01,
            tolerance: 1.5,
            correspondence_distance: None,
            max_iterations: 60,
            seed: 1,
            annealing: true,
            trim: true,
        }
    }
}

/// Largest weight of a term: at a million times the weight of the colours, a 32-bit sum keeps hardly a digit of the
/// colours.
const LARGEST_WEIGHT: f64 = 1e6;
/// Largest number of iterations, more than anyone would wait for, to catch typing errors.
const MOST_ITERATIONS: u32 = 100_000;

impl Options {
    /// The paper's loop: from the identity, with ICP and consensus for the pose, and one normal for each pixel.
    #[must_use]
    pub fn paper() -> Self {
        Self { start: Start::Identity, registration: Registration::Icp, shading: Shading::Pixel, ..Self::default() }
    }

    /// The prior over lights of these options.
    ///
    /// # Errors
    /// The errors of [`LightPrior::from_slices`], below `options.prior`.
    pub(crate) fn light_prior(&self) -> Result<LightPrior> {
        match &self.prior {
            None => Ok(LightPrior::natural()),
            Some(LightGaussian { mean, covariance }) => {
                LightPrior::from_slices(mean, covariance).map_err(|error| error.below("options"))
            }
        }
    }

    /// Checks every number against its range.
    ///
    /// # Errors
    /// [`ErrorKind::Range`] with the name of the first option out of range.
    pub fn validate(&self) -> Result<()> {
        if let LightSource::Known(light) = &self.light {
            light.validate("options.light")?;
        }
        if self.prior.is_some() {
            self.light_prior()?;
        }
        if let Start::Pose { rotation, scale, translation } = self.start {
            let scale = scale.unwrap_or(1.0);
            let translation = translation.unwrap_or_else(Vector3::zeros);
            Similarity { scale, rotation, translation }.validate("options.start")?;
        }
        let StartTolerance { degrees, distance } = self.start_tolerance;
        for (field, value) in [("degrees", degrees), ("distance", distance.unwrap_or(1.0))] {
            positive(field, value).map_err(|error| error.below("options.startTolerance"))?;
        }
        if let Some(scale) = self.scale {
            positive("options.scale", scale)?;
        }
        for (field, weight) in [
            ("options.lambda.prior", self.weights.prior),
            ("options.lambda.unit", self.weights.unit),
            ("options.lambda.light", self.weights.light),
            ("options.lambda.refinement", self.weights.refinement),
        ] {
            not_negative(field, weight)?;
            if weight > LARGEST_WEIGHT {
                return Err(Error::new(ErrorKind::Range, field, "must be at most a million").value(weight));
            }
        }
        positive("options.stopDegrees", self.stop_degrees)?;
        positive("options.tolerance", self.tolerance)?;
        if let Some(distance) = self.correspondence_distance {
            positive("options.correspondenceDistance", distance)?;
        }
        if self.max_iterations == 0 || self.max_iterations > MOST_ITERATIONS {
            return Err(Error::new(
                ErrorKind::Range,
                "options.maxIterations",
                format!("must lie between 1 and {MOST_ITERATIONS}"),
            )
            .value(f64::from(self.max_iterations)));
        }
        Ok(())
    }
}

#[cfg(all(test, feature = "serde"))]
mod tests {
    use nalgebra::Matrix3;
    use serde_json::json;

    use super::*;

    #[test]
    fn options_read_back_as_they_were_written() {
        let rotation = crate::pose::Angles { alpha: 3.0, beta: -20.0, gamma: 7.0 }.rotation();
        let options = Options {
            light: LightSource::Known(Light([[0.25; 9]; 3])),
            prior: Some(LightGaussian { mean: vec![0.5], covariance: vec![0.25, 2.0] }),
            start: Start::Pose { rotation, scale: None, translation: Some(Vector3::new(1.0, 2.0, 3.0)) },
            start_tolerance: StartTolerance { degrees: 5.0, distance: Some(2.0) },
            scale: Some(1.5),
            registration: Registration::Icp,
            shading: Shading::Pixel,
            weights: Weights { prior: 1.0, unit: 2.0, light: 3.0, refinement: 4.0 },
            stop_degrees: 0.5,
            tolerance: 0.7,
            correspondence_distance: Some(2.0),
            max_iterations: 7,
            seed: 9,
            annealing: false,
            trim: false,
        };
        for options in [options, Options::default(), Options::paper()] {
            // The options do not pass through text, because reading text rounds the last digit.
            let plain = serde_json::to_value(&options).unwrap();
            assert_eq!(serde_json::from_value::<Options>(plain).unwrap(), options);
        }
    }

    #[test]
    fn options_come_in_the_shapes_of_the_contract() {
        let given = json!({
            "light": "estimate", "start": { "angles": { "beta": 90.0 }, "scale": 2.0 }, "scale": "free",
            "startTolerance": { "degrees": 3.0 }, "lambda": { "prior": 0.5 }, "maxIterations": 4,
        });
        let found: Options = serde_json::from_value(given).unwrap();
        let Start::Pose { rotation, scale: Some(2.0), translation: None } = found.start else { panic!("{found:?}") };
        assert!((rotation - Matrix3::new(0.0, 0.0, 1.0, 0.0, 1.0, 0.0, -1.0, 0.0, 0.0)).abs().max() < 1e-12);
        let expected = Options {
            start: found.start,
            start_tolerance: StartTolerance { degrees: 3.0, distance: None },
            weights: Weights { prior: 0.5, ..Weights::default() },
            max_iterations: 4,
            ..Options::default()
        };
        assert_eq!(found, expected);
        let prior = json!({ "prior": { "mean": [1.0], "covariance": [[1.0, 2.0], [3.0, 4.0]] } });
        let prior = serde_json::from_value::<Options>(prior).unwrap().prior.unwrap();
        assert_eq!(prior, LightGaussian { mean: vec![1.0], covariance: vec![1.0, 2.0, 3.0, 4.0] });
        assert!(serde_json::from_value::<Options>(json!({ "light": [1.0, 2.0] })).is_err());
        let bright: Options = serde_json::from_value(json!({ "light": vec![1e300; 27] })).unwrap();
        assert_eq!(bright.validate().unwrap_err().field(), "options.light");
        assert!(serde_json::from_value::<Options>(json!({ "registration": "best" })).is_err());
    }

    #[test]
    fn a_start_is_a_matrix_or_a_reported_pose() {
        let rows = json!([[0.0, -2.0, 0.0, 1.0], [2.0, 0.0, 0.0, 2.0], [0.0, 0.0, 2.0, 3.0], [0.0, 0.0, 0.0, 1.0]]);
        let turn = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0);
        let translation = Vector3::new(1.0, 2.0, 3.0);
        let pose = crate::pose::Similarity { scale: 2.0, rotation: turn, translation };
        for given in [rows.clone(), json!({ "matrix": rows }), serde_json::to_value(pose).unwrap()] {
            let found: Options = serde_json::from_value(json!({ "start": given })).unwrap();
            let Start::Pose { rotation, scale, translation: shift } = &found.start else { panic!("{found:?}") };
            assert!((rotation - turn).abs().max() < 1e-12 && (scale.unwrap() - 2.0).abs() < 1e-12, "{found:?}");
            assert_eq!(*shift, Some(translation));
        }
        let mirrored = json!({ "start": [[-1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]] });
        assert!(serde_json::from_value::<Options>(mirrored).is_err());
    }

    /// Threads are not an option here; use `Estimator::with_threads`.
    #[test]
    fn a_member_that_there_is_not_is_an_error_with_its_name() {
        for (path, given) in [
            ("regstration", json!({ "regstration": "icp" })),
            ("workers", json!({ "workers": 2 })),
            ("lambda.priors", json!({ "lambda": { "priors": 1.0 } })),
            ("startTolerance.degree", json!({ "startTolerance": { "degree": 1.0 } })),
            ("start.scal", json!({ "start": { "scal": 1.0 } })),
            ("start.angles.delta", json!({ "start": { "angles": { "delta": 1.0 } } })),
            ("prior.sigma", json!({ "prior": { "mean": [], "covariance": [], "sigma": 1.0 } })),
        ] {
            let error = serde_path_to_error::deserialize::<_, Options>(given).unwrap_err();
            assert_eq!(error.path().to_string(), path);
            let name = path.rsplit('.').next().unwrap();
            assert!(error.to_string().contains(&format!("unknown field `{name}`")), "{error}");
        }
    }

    #[test]
    fn a_wrong_member_of_a_pose_is_named() {
        for (path, given) in [
            ("start.rotation", json!({ "start": { "rotation": [1.0] } })),
            ("start.angles.beta", json!({ "start": { "angles": { "beta": "20" } } })),
            ("start", json!({ "start": "serch" })),
            ("start", json!({ "start": 5 })),
        ] {
            let error = serde_path_to_error::deserialize::<_, Options>(given).unwrap_err();
            assert!(error.path().to_string().starts_with(path), "{path}: {error}");
        }
    }
}
