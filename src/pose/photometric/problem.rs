//! Input and output of a photometric registration.

use nalgebra::Matrix3;

use crate::check::not_negative;
use crate::error::{Error, ErrorKind, Result};
use crate::light::{Light, LightPrior};
use crate::numeric::{DOUBLE_LANES, Doubles, Real, dot};
use crate::pose::increment::{PoseMatrix, UNKNOWNS, held_unknowns};
use crate::pose::prior::PosePrior;
use crate::pose::similarity::Similarity;
use crate::pose::uncertainty::Uncertainty;
use crate::view::{ColourView, DepthNoise, Normals, Points, Size};

/// The coarsest level of the image.
pub(super) const COARSEST: usize = 2;
/// The coarsest level of the image near an initial pose. The pose is held there, so that an unknown light does not fit a blurred image
/// under a wrong pose.
pub(crate) const COARSEST_NEAR: usize = 3;

/// Depth pixels whose points are processed side by side.
pub(super) type Indices = [u32; DOUBLE_LANES];

/// Input of the registration. Points and normals (depth view's frame) are NaN where missing.
#[derive(Clone, Copy)]
pub struct PhotometricProblem<'a> {
    /// The colour view.
    pub image: &'a ColourView,
    /// Size of the depth view.
    pub depth_size: Size,
    /// Points of the depth view, measured or refined.
    pub points: &'a Points,
    /// Normals of these points.
    pub normals: &'a Normals,
    /// One sigma of each normal in radians, see [`crate::cubic_normals`]; points with NaN are left out. `None` means
    /// that all are exact.
    pub normal_error: Option<&'a [f32]>,
    /// Noise of the depth from which the normals were computed.
    pub depth_noise: DepthNoise,
    /// The light if it is known up to its exposure.
    pub light: Option<&'a Light>,
    /// Prior of an unknown light.
    pub prior: &'a LightPrior,
    /// Weight of the prior; one is the weight of Bayes' rule.
    pub prior_weight: f64,
    /// Whether the scale keeps its initial value; behind a pinhole image it always does.
    pub scale_is_held: bool,
    /// An initial pose that is trusted to some degree. With it, points are also held on the image's mask, and the
    /// albedo may follow the curvature of the depth map.
    pub near: Option<PosePrior>,
}

impl PhotometricProblem<'_> {
    /// Points transformed into the colour view's frame.
    #[inline(always)]
    pub(super) fn points(&self, pose: &Similarity, indices: &Indices) -> [Doubles; 3] {
        let rotated = rotated(&pose.rotation, gathered(self.points, indices));
        let moved = |axis: usize| Doubles::splat(pose.scale) * rotated[axis] + Doubles::splat(pose.translation[axis]);
        [moved(0), moved(1), moved(2)]
    }

    /// Normals rotated into the colour view's frame.
    #[inline(always)]
    pub(super) fn normals(&self, pose: &Similarity, indices: &Indices) -> [Doubles; 3] {
        rotated(&pose.rotation, gathered(self.normals, indices))
    }

    /// Unknowns that keep their values.
    pub(super) fn held(&self) -> [bool; UNKNOWNS] {
        held_unknowns(&self.image.camera, self.scale_is_held)
    }

    pub(super) fn check(&self, sizes: [Size; 2]) -> Result<()> {
        if [self.image.size, self.depth_size] != sizes {
            return Err(Error::new(
                ErrorKind::Size,
                "image",
                "both views must have the sizes for which memory was allocated",
            ));
        }
        let length = self.depth_size.len();
        let errors = self.normal_error.map_or(length, <[f32]>::len);
        if [self.points.len(), self.normals.len(), errors] != [length; 3] {
            return Err(Error::new(
                ErrorKind::Size,
                "depth",
                "must have a point, a normal and an error for each pixel",
            ));
        }
        self.near.map_or(Ok(()), |near| near.validate("near"))?;
        not_negative("options.lambda.light", self.prior_weight)
    }
}

#[inline(always)]
fn gathered(vectors: &Normals, indices: &Indices) -> [Doubles; 3] {
    let gathered = |values: &[f32]| {
        let mut numbers = [0.0; DOUBLE_LANES];
        for (number, &index) in numbers.iter_mut().zip(indices) {
            *number = f64::from(values[index as usize]);
        }
        Doubles::from(numbers)
    };
    [gathered(&vectors.x), gathered(&vectors.y), gathered(&vectors.z)]
}

#[inline(always)]
fn rotated(rotation: &Matrix3<f64>, vector: [Doubles; 3]) -> [Doubles; 3] {
    let row = |row: usize| {
        let entry = |column: usize| Doubles::splat(rotation[(row, column)]);
        dot([entry(0), entry(1), entry(2)], vector)
    };
    [row(0), row(1), row(2)]
}

/// Number of points that annealing needs. With at most 33 unknowns (six of the pose, 27 of the light), 5000 points average noise to a twentieth of its size
/// or less, and more do not change where the later rounds end (docs/lab/thresholds.md).
const ENOUGH_ANNEALED: usize = 5000;

/// Options of a registration: its reach and its cost.
#[derive(Clone, Copy, Debug)]
pub struct PhotometricOptions {
    /// First level, 0 to 3, limited to the levels of a problem: the coarsest for a distant pose, 0 for a pose with an
    /// error of about a degree.
    pub first_level: usize,
    /// Maximum number of rounds.
    pub most_rounds: usize,
    /// Maximum number of points, evenly spread over the visible ones.
    pub most_points: usize,
    /// Maximum number of points of the annealing. The rounds after it, with instrumental variables, end at the same
    /// pose from any pose nearby.
    pub annealed_points: usize,
    /// Whether the robust scale shrinks from round to round. Otherwise all rounds have the final scale.
    pub annealing: bool,
    /// Whether the points of the previous registration stay, instead of those visible in each round. Several problems
    /// can then be compared on the same points, and only these need points and normals.
    pub points_stay: bool,
    /// Whether the covariance includes the jackknife over sectors; registrations that are only compared with others do
    /// not need it.
    pub jackknife: bool,
}

impl Default for PhotometricOptions {
    fn default() -> Self {
        Self {
            first_level: COARSEST_NEAR,
            most_rounds: 40,
            most_points: usize::MAX,
            annealed_points: ENOUGH_ANNEALED,
            annealing: true,
            points_stay: false,
            jackknife: true,
        }
    }
}

/// Why a registration ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhotometricTermination {
    /// Another round would change nothing.
    Settled,
    /// The last rounds, with instrumental variables, would have raised the objective, so the pose of least squares was
    /// kept. It is usable but has the bias of the noise.
    Annealed,
    /// The maximum number of rounds was reached.
    MostRounds,
}

/// Result of the registration.
#[derive(Clone, Debug)]
pub struct PhotometricReport {
    /// The pose; for an orthographic image t_z keeps its initial value.
    pub pose: Similarity,
    /// The light; a known light is given without the exposure.
    pub light: Light,
    /// Offset of log S relative to a known light; zero if the light was free.
    pub exposure: f64,
    /// Mean of rho over the visible points as a share of its largest value, 0 .. 1, at the robust scale of the noise.
    pub objective: f64,
    /// Robust standard deviation of a channel's residuals, log units.
    pub noise: f64,
    /// Spatial covariance: root of the mean covariance of residuals within tiles of the depth map, log units. Shadows,
    /// varying albedo and light from other parts of the object raise it, but white noise of any size does not.
    pub spatial_covariance: f64,
    /// Number of visible points.
    pub visible: usize,
    /// Whether these are only a sample, see [`PhotometricOptions::most_points`].
    pub sampled: bool,
    /// Share of the visible points within the robust scale.
    pub inliers: f64,
    /// Gauss-Newton steps taken.
    pub iterations: usize,
    /// Why it ended.
    pub termination: PhotometricTermination,
    /// Information of rotation (radians), translation (object sizes) and log scale after elimination of the light, over
    /// the variance of the noise: the inverse of the covariance under white noise of that size.
    pub information: PoseMatrix,
    /// Covariance of the same unknowns, from the scores of tiles and from the jackknife over sectors; held unknowns
    /// have none.
    pub covariance: PoseMatrix,
    /// One sigma of each number of the pose.
    pub uncertainty: Uncertainty,
}
