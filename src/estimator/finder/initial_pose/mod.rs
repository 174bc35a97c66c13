//! How an initial pose is treated, from the option `start` to the decision (docs/method/registration.md).
//!
//! | file | what it holds |
//! |---|---|
//! | `first_pose` | the pose of iteration zero |
//! | `trust_region` | how far from the initial pose the answer may lie |
//! | `prior` | the Gaussian about it, for silhouettes and for registrations that are held near it |
//! | `registrations` | the registrations near it that precede the search |
//! | `evidence` | the decision: the first pose in the region that fits the image, or the initial pose itself |

mod evidence;
mod first_pose;
mod prior;
mod registrations;
mod trust_region;

pub use evidence::InitialEvidence;
pub use first_pose::{centred, first_pose};
pub use prior::aligned_prior;
pub use registrations::{InitialRegistrations, Progress, explains};
pub use trust_region::TrustRegion;
