//! Registration by local contrast: the pose of a painted object, whose colours are not those of light and shape alone
//! (docs/method/registration.md).
//!
//! E = sum w rho(|H(v - B L)|^2) / sum w + 3 mean rho(off the mask) + limbs rho(off its outline) + 5 log^2(size)
//!
//! - v = log(I + 0.1 median I) where a sample falls, H what differs from the weighted mean around it on the depth view:
//!   most of paint, and what a light of nine harmonics leaves, is gone with the mean.
//! - B are the harmonics of the depth view's OWN normals: orders up to two are closed under rotation, so under a free
//!   light L no pose changes what they span, and the pose enters through places in the image alone.
//! - Samples beside the mask count by their distance to it. Where the surface turns away from the image's camera (the
//!   contour generator, "limbs"), it is seen on the outline of the mask and not beside or inside it.
//! - The apparent size is held loosely to what the units give.
//!
//! Method: rounds of damped Gauss-Newton with the light eliminated. A round fixes what is seen and the weights within H;
//! weights that move with the pose would reward sliding to where there is little weight. The robust scale shrinks from
//! twice to once three sigmas of what is left. At the end rounds of instrumental variables: the gradient of the predicted
//! shading takes the place of the image's, whose shadows and paint would bias the pose. [`ContrastSearch`] runs it from
//! many starts, coarse to fine.
//!
//! | file | what it holds |
//! |---|---|
//! | `problem` | what goes in, what comes out |
//! | `search` | many starts, coarse to fine, one pose and its rivals |
//! | `registration` | the rounds |
//! | `objective` | E, its gradient, and what a round fixes |
//! | `prediction` | the predicted shading and its gradient, instruments of the last rounds |
//! | `samples` | the depth view on a grid, with its harmonics |
//! | `seen` | visible samples and the contour generator |
//! | `local_means` | H |
//! | `equations` | the linear system, the light eliminated |
//! | `uncertainty`, `jackknife` | one sigma of the pose |
//!
//! Limits: about a degree on photographs at 96x96, which is 0.3 pixels of parallax; an object without relief (a printed
//! bag) or with a symmetry (a cylinder) has no minimum of its own. It needs a mask.

mod equations;
mod jackknife;
mod local_means;
pub(super) use local_means::LocalMeans;
mod objective;
mod prediction;
mod problem;
mod registration;
mod samples;
mod search;
mod seen;
mod uncertainty;

pub use problem::{ContrastProblem, ContrastReport};
pub use search::{ContrastOutcome, ContrastSearch, register_again};
