//! Registration by local contrast: the pose of a painted object.
mod equations;
mod local_means;
mod objective;
mod problem;
mod registration;
mod samples;
mod search;
mod seen;
mod uncertainty;

pub use problem::{ContrastProblem, ContrastReport};
pub use registration::{ContrastEffort, ContrastRegistration};
pub use search::{ContrastOutcome, ContrastSearch};
