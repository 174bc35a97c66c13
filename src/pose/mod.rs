//! The pose between both views (Eq. 12 to 16).

mod angles;
mod correspondence;
mod icp;
mod increment;
mod neighbours;
mod photometric;
mod ransac;
mod search;
mod similarity;
mod uncertainty;
mod visibility;

pub use angles::{Angles, AnglesFit};
pub use correspondence::{CorrespondenceProblem, Correspondences};
pub use icp::{Icp, IcpOptions, IcpProblem, IcpReport, IcpTermination, Metric, Pair};
pub use neighbours::{Neighbour, Neighbours};
pub use photometric::{Photometric, PhotometricOptions, PhotometricProblem, PhotometricReport, PhotometricTermination};
pub use ransac::{RansacOptions, RansacReport, ransac};
pub use search::{Candidate, Progress, Search, SearchProblem};
pub(crate) use search::{Hypothesis, ImageGrid, SearchFinding, SearchTask, TaskResults};
pub use similarity::Similarity;
pub use uncertainty::{Information, Uncertainty};
