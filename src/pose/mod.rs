//! The pose between both views: P_colour = s R P_depth + t (docs/method/).
//!
//! | file | content | objective | unknowns | solver |
//! |---|---|---|---|---|
//! | `search/` | search before Algorithm 1: candidate poses without an initial pose | log likelihood relative to a constant colour | rotation, scale, translation in the image | sweep over all rotations, correlation by FFT, local ascent |
//! | `photometric/` | photometric registration, beyond the paper | robust residuals of log colours + prior of the light | pose and light | Gauss-Newton, the light eliminated; instrumental variables |
//! | `silhouettes/` | registration from silhouettes, beyond the paper, for varying albedo | depth discontinuities against the image's mask and edges | pose without scale, and the edge bias | Gauss-Newton |
//! | `contrast/` | registration by local contrast, for varying albedo in an orthographic image | robust residuals with local means removed, silhouette | pose and light | Gauss-Newton, the light eliminated; many initial poses |
//! | `gradient_domain/` | registration by differences of neighbouring pixels, for smoothly varying albedo | t distribution of differences, silhouette | pose and light | Gauss-Newton, the light eliminated |
//! | `icp` | Eq. 12: the depth points onto the image surface | robust point-to-plane distance | pose | nearest neighbours and Gauss-Newton, alternating |
//! | `ransac` | Eq. 13 and 14: consensus of pairs over the linear model P -> A P + t | truncated squared distance | the twelve numbers theta | samples of four pairs, then linear least squares |
//! | `similarity` | Eq. 15: the similarity nearest to A; Eq. 12 for known pairs, in closed form | least squares | s, R, t | Horn's quaternion |
//! | `transforms` | a pose as nalgebra's transformations and as a 4x4 matrix | | | |
//! | `angles` | Eq. 16: the angles of a rotation | | alpha, beta, gamma | closed form |
//! | `correspondence`, `visibility` | the 1-pixel rule: depth points and their pixels, with occlusion in both directions | | | z-buffers |
//! | `curvature` | curvature of the depth map, which the albedo often follows | | | |
//! | `prior` | a Gaussian about an initial pose | | | |
//! | `descent` | step control of damped Gauss-Newton, for `photometric/` and `contrast/` | | | |
//! | `increment` | a Gauss-Newton step of a similarity: seven unknowns | | | |
//! | `sandwich`, `jackknife` | covariance of a pose from the scores of independent clusters, and from its moves without each sector | | | |
//! | `residuals` | constants of residuals that `photometric/` and `contrast/` share | | | |
//! | `sums` | sums of a step over robust residuals | | | |
//! | `uncertainty` | one sigma of each number of a pose, from the information of matched surfaces | | | |
//! | `spline_image`, `silhouette`, `distance_transform` | log S between pixels; distance to the mask | | | |
//! | `neighbours` | nearest points | | | k-d tree |
//!
//! The error of Eq. 20, the spectral norm of R - R_g, is 2 sin(a / 2) for the angle a that [`Similarity::degrees_to`]
//! returns. `estimator` holds the loop that calls these stages.

mod angles;
mod contrast;
mod correspondence;
mod curvature;
mod descent;
mod distance_transform;
mod gradient_domain;
mod icp;
mod increment;
mod jackknife;
mod neighbours;
mod photometric;
mod prior;
mod products;
mod ransac;
mod residuals;
mod sandwich;
mod search;
mod silhouette;
mod silhouettes;
mod similarity;
mod spline_image;
mod sums;
mod transforms;
mod uncertainty;
mod visibility;

pub use angles::Angles;
pub(crate) use contrast::{ContrastOutcome, ContrastProblem, ContrastReport, ContrastSearch, register_again};
pub use correspondence::{CorrespondenceProblem, Correspondences};
pub(crate) use gradient_domain::{GradientRegistration, GradientReport, combine};
pub use icp::{Icp, IcpOptions, IcpProblem, IcpReport, IcpTermination, Metric, Pair};
pub(crate) use increment::rotation_vector;
pub(crate) use photometric::COARSEST_NEAR;
pub use photometric::{Photometric, PhotometricOptions, PhotometricProblem, PhotometricReport, PhotometricTermination};
pub use prior::PosePrior;
pub use ransac::{RansacOptions, RansacReport, ransac};
pub use search::{Candidate, Progress, Search, SearchProblem};
pub(crate) use search::{Hypothesis, ImageGrid, SearchFinding, SearchTask, TaskResults};
pub(crate) use silhouette::{SLACK, Silhouette};
pub(crate) use silhouettes::{SilhouetteProblem, SilhouetteRegistration, SilhouetteReport};
pub use similarity::Similarity;
pub use uncertainty::{Axis, Direction, Information, Uncertainty, Unknown};
