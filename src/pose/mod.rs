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
mod slots;
mod uncertainty;
mod visibility;

pub use angles::Angles;
pub use correspondence::{CorrespondenceProblem, Correspondences};
pub use icp::{Icp, IcpOptions, IcpProblem, IcpReport, IcpTermination, Metric, Pair};
pub use neighbours::{Neighbour, Neighbours};
pub use photometric::{Photometric, PhotometricOptions, PhotometricProblem, PhotometricReport, PhotometricTermination};
pub use ransac::{RansacOptions, RansacReport, ransac};
pub use search::{Candidate, Progress, Search};
pub(crate) use search::{ImageGrid, Known, Place, SearchFinding, SearchTask, sort_down};
pub use similarity::Similarity;
pub(crate) use slots::Slots;
pub use uncertainty::Information;
