//! min over T, L of sum_h w_h rho(|log S(pi(T P_h)) - B(R n_h) L|^2) + sigma^2 h(L): the pose straight from the
//! colours (docs/method/registration.md).
//!
//! Each depth point predicts a colour by its own normal; the pose is right where the image shows it. Unknown are the
//! rotation, the translation, the logarithm of the scale, and the light: all 27 coefficients under the prior h of
//! natural lights, or the exposure alone where the light is known. rho is the robust function of Geman and McClure of
//! the three channels together, sigma the noise of log S.
//!
//! Method, in rounds. A round fixes the visible points (z-buffer); points that then leave the mask count with the
//! largest rho, so that moving the object out of the picture never lowers the objective.
//! 1. Annealing: Gauss-Newton with the light eliminated (variable projection, [`equations`]) and Levenberg-Marquardt
//!    damping; a step is accepted where it lowers this objective. The robust scale shrinks from round to round, from
//!    twice what the residuals ask for down to three sigmas of the noise; blurred images and every fourth, then every
//!    second point come first.
//! 2. Instrumental variables: the gradient of a noisy image is noisy as well, and this noise correlates with that of
//!    the residual, so that least squares, sum w J^T r = 0, is biased: towards half pixels, where interpolation
//!    averages noise away (0.4 degrees on Mozart at 128x128 under weak light, five times the error of the noise
//!    itself). The last rounds solve sum w Z^T r = 0 instead, with instruments Z that correlate with the true
//!    gradient and hardly with the noise: the Jacobian from a slightly blurred image. Its noise is a fifth, and what is
//!    lost is a little efficiency, never the mean.
//!
//! One sigma follows from the spread of the scores over tiles of the depth map ([`covariance`]): noise, wrong normals
//! and interpolation enter as they are, correlated or not. An error that leaves no residual is not seen by it.
//!
//! T. Söderström, P. Stoica: "Instrumental Variable Methods for System Identification", Springer 1983. G. Golub,
//! V. Pereyra: "The differentiation of pseudo-inverses and nonlinear least squares problems whose variables separate",
//! SIAM J. Numer. Anal. 10, 1973.
//!
//! | file | what it holds |
//! |---|---|
//! | `problem` | what goes in, what comes out |
//! | `registration` | [`Photometric`] from its start to its report: rounds of `annealing`, then of `instruments` |
//! | `phase` | what it does next |
//! | `solver` | what it owns, and what each round takes from it |
//! | `state` | pose and light, and a step of both |
//! | `points` | which depth points take part |
//! | `residual` | r and its derivatives |
//! | `weighting` | robust scale and weight of the prior |
//! | `near` | terms of the pose alone around an initial pose: mask and prior |
//! | `relief` | albedo that goes with the curvature of the depth map |
//! | `evaluation` | sums over the points: objective, equations, noise, inliers |
//! | `equations` | the linear system, the light eliminated |
//! | `normal_noise` | what noisy normals add to it |
//! | `covariance`, `jackknife` | one sigma of the pose: from tiles, and from leaving out sectors |
//!
//! Limits: Lambertian, one albedo; starts beyond some 20 to 30 degrees may end elsewhere; behind a pinhole image the
//! scale is held, for it cannot be told from the distance.

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
