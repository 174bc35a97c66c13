//! Whether a calibration between a colour camera and a depth camera is right (docs/method/check.md).
//!
//! Frames of a rig and some candidates for its extrinsics go in; an estimate with its covariance and a verdict on each
//! candidate come out. Whole frames are looked at, because what stands before a background carries most of the answer.
//!
//! | file | what it holds |
//! |---|---|
//! | `cue` | names of the cues |
//! | `input`, `frame`, `planes` | what comes in, guards, the colour camera's view of the depth points |
//! | `ahead` | the viewing direction of a cloud's scanner |
//! | `unseen` | leaves out the points that the colour camera cannot see |
//! | `rims`, `edges` | depth edges, and their log likelihood on image edges |
//! | `surface`, `patches` | samples of the depth map with normals, grouped |
//! | `information`, `shading`, `silhouette`, `differences` | cues over samples, derivatives by differences |
//! | `unknowns`, `evidence` | the unknowns in pixels; log likelihoods by tiles, weights, covariance |
//! | `search`, `registration` | starts, rounds |
//! | `distortion`, `guessed` | whether a lens was left out; what a guessed camera leaves open |
//! | `sensitivity`, `verdict`, `reason`, `check` | curves, verdicts, their reasons, and the order of it all |
//! | `report`, `serialised` | what a check found; its shapes for serde |
//! | `overlay` | a frame as a pose lays it over its image |

mod ahead;
mod check;
mod conclusion;
mod cue;
mod differences;
mod distortion;
mod edges;
mod evidence;
mod frame;
mod guessed;
mod health;
mod information;
mod input;
mod optima;
mod overlay;
mod patches;
mod planes;
mod readings;
mod reason;
mod registration;
mod report;
mod rims;
mod sampling;
mod search;
mod sensitivity;
#[cfg(feature = "serde")]
mod serialised;
mod shading;
mod silhouette;
mod surface;
mod unknowns;
mod unseen;
mod verdict;

pub use check::CalibrationCheck;
pub use cue::Cue;
pub use health::Health;
pub use input::RigView;
pub use overlay::{Overlay, overlay};
pub use readings::Reading;
pub use reason::{CheckReason, Margin, Offset, Warning, WarningKind};
pub use report::{CheckReport, CueReport, FrameReport};
pub use sensitivity::Sensitivity;
pub use verdict::{CandidateReport, CheckVerdict};
