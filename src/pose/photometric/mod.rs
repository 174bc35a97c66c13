//! Photometric registration: min over T, L of sum_h w_h rho(|log S(pi(T P_h)) - B(R n_h) L|^2) + sigma^2 h(L), the pose
//! directly from the image (docs/method/registration.md).
//!
//! Each depth point predicts a colour by its normal; under the right pose the image shows these colours. The unknowns
//! are the rotation, the translation, the logarithm of the scale, and the light: all 27 coefficients under the prior h
//! of natural lights, or only the exposure if the light is known. rho is the robust function of Geman and McClure of
//! the three channels together, sigma the noise of log S.
//!
//! The method runs in rounds. A round fixes the visible points (z-buffer). Points that then leave the mask count with
//! the largest rho, so that moving the object out of the picture never lowers the objective.
//! 1. Annealing: Gauss-Newton with the light eliminated (variable projection, [`equations`]) and Levenberg-Marquardt
//!    damping; a step is accepted if it lowers this objective. The robust scale shrinks from round to round, from twice
//!    the scale of the first residuals to three sigmas of the noise. Blurred images come first, with every fourth and
//!    then every second point.
//! 2. Instrumental variables: the gradient of a noisy image is noisy as well, and this noise correlates with that of
//!    the residual. Least squares, sum w J^T r = 0, is therefore biased towards half pixels, where interpolation
//!    averages noise away. The last rounds solve sum w Z^T r = 0 with instruments Z that correlate with the true
//!    gradient and hardly with the noise: the Jacobian of a slightly blurred image, whose noise is a fifth. They lose a
//!    little efficiency but do not bias the mean.
//!
//! One sigma follows from the spread of the scores over tiles of the depth map ([`covariance`]): noise, wrong normals
//! and interpolation enter with their actual size and correlation. The [`jackknife`], which leaves out one sector of the
//! object at a time, adds errors that correlate over more than a tile. Errors that leave no residual are not covered.
//!
//! T. Söderström, P. Stoica: "Instrumental Variable Methods for System Identification", Springer 1983. G. Golub, V.
//! Pereyra: "The differentiation of pseudo-inverses and nonlinear least squares problems whose variables separate",
//! SIAM J. Numer. Anal. 10, 1973.
//!
//! | file | content |
//! |---|---|
//! | `problem` | input and output |
//! | `registration` | [`Photometric`] from the initial pose to the report: rounds of `annealing`, then of `instruments` |
//! | `phase` | the next piece of work |
//! | `solver` | the state of a registration, and the operations that rounds share |
//! | `state` | pose and light, and a step of both |
//! | `points` | the depth points of a round |
//! | `residual` | r and its derivatives |
//! | `weighting` | robust scale and weight of the prior |
//! | `near` | terms of the pose alone about an initial pose: mask and prior |
//! | `relief` | albedo that follows the curvature of the depth map |
//! | `evaluation` | sums over the points: objective, equations, noise, inliers |
//! | `equations` | the linear system, the light eliminated |
//! | `normal_noise` | contribution of noisy normals to that system |
//! | `covariance`, `jackknife` | one sigma of the pose: from tiles, and from leaving out sectors |
//!
//! Limits: Lambertian surfaces with a single albedo. Initial poses more than 20 to 30 degrees off may end elsewhere.
//! Behind a pinhole image the scale is held, because it cannot be distinguished from the distance.

mod annealing;
mod covariance;
mod equations;
mod evaluation;
mod instruments;
mod jackknife;
mod near;
mod normal_noise;
mod phase;
mod points;
mod problem;
mod registration;
mod relief;
mod residual;
mod solver;
mod state;
mod weighting;

pub(crate) use problem::COARSEST_NEAR;
pub use problem::{PhotometricOptions, PhotometricProblem, PhotometricReport, PhotometricTermination};
pub use registration::Photometric;
