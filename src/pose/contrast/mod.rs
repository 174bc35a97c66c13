//! Registration by local contrast: the pose of an object with varying albedo, whose colours do not follow from light
//! and shape alone (docs/method/registration.md).
//!
//! E = sum w rho(|H(v - B L)|^2) / sum w + 3 mean rho(off mask) + sum rho(off silhouette) / border + 5 ln^2(growth)
//!
//! - v = log(I + 0.1 median I) at the image position of a sample. H is the difference from the weighted mean around the
//!   sample on the depth view. It removes most of the albedo and whatever a light of nine harmonics cannot represent.
//! - B are the harmonics of the depth view's own normals. Orders up to two are closed under rotation, so under a free
//!   light L no pose changes their span, and the pose enters through positions in the image alone.
//! - Samples off the mask cost more the farther they are from it. Where the surface turns away from the image's camera
//!   (the occluding contour), points have to lie on the silhouette, neither outside nor inside it; the sum over them is
//!   divided by the length of the mask's border.
//! - A registration holds the apparent size near that of the initial pose. Comparisons of poses hold it near the size
//!   that follows from the units.
//!
//! Method: rounds of damped Gauss-Newton with the light eliminated. A round fixes the visible samples and the weights
//! within H, because weights that moved with the pose would reward sliding to places of low weight. The robust scale
//! shrinks from six sigmas of the residuals to three. The last rounds use instrumental variables: the gradient of the
//! predicted shading replaces that of the image, whose shadows and albedo would bias the pose. [`ContrastSearch`]
//! registers from many initial poses, coarse to fine.
//!
//! | file | content |
//! |---|---|
//! | `problem` | input and output |
//! | `search` | many initial poses, coarse to fine; one pose and its rivals |
//! | `registration` | the rounds |
//! | `objective` | E, its gradient, and the quantities that a round fixes |
//! | `prediction` | the predicted shading and its gradient, instruments of the last rounds |
//! | `samples` | the depth view on a grid, with its harmonics |
//! | `seen` | visible samples and the occluding contour |
//! | `local_means` | H |
//! | `equations` | the linear system, the light eliminated |
//! | `uncertainty`, `jackknife` | one sigma of the pose |
//!
//! Limits: the image is orthographic, so that the apparent size is the scale, and it requires a mask. An object without
//! relief (a printed bag) or with a symmetry (a cylinder) has no distinct minimum.

mod equations;
mod jackknife;
mod local_means;
pub(super) use local_means::LocalMeans;
mod objective;
pub(super) use objective::by_pose;
mod prediction;
mod problem;
mod registration;
mod samples;
pub(super) use samples::Samples;
mod search;
mod seen;
pub(super) use seen::Seen;
#[cfg(test)]
pub(super) mod test_scene;
mod uncertainty;

pub use problem::{ContrastProblem, ContrastReport};
pub use search::{ContrastOutcome, ContrastSearch, register_again};
