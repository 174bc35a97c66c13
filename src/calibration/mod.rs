//! Checks a calibration between a colour camera and a depth camera (docs/method/check.md).
//!
//! The check takes frames of a rig and some candidates for its extrinsics. It returns an estimate with its covariance and
//! a verdict on each candidate. It uses whole frames, because objects in front of a background carry most of the
//! information.
//!
//! | file | contents |
//! |---|---|
//! | `cue` | names of the cues |
//! | `input`, `frame`, `planes` | input, plausibility checks, the colour camera's view of the depth points |
//! | `ahead` | the viewing direction of a cloud's scanner |
//! | `unseen` | leaves out the points that the colour camera cannot see |
//! | `sampling` | gathers sparse depth maps into cells |
//! | `discontinuities`, `edges` | depth edges, and their log likelihood on image edges |
//! | `surface`, `patches` | samples of the depth map with normals, in groups |
//! | `intensity` | intensities of a scanner's returns as levels of equal count |
//! | `information`, `shading`, `silhouette`, `differences` | cues over samples, finite differences |
//! | `unknowns`, `evidence` | the unknowns in pixels; log likelihoods by tiles, weights, covariance |
//! | `search`, `registration`, `lattice` | initial poses, rounds of the registration, states that rounding does not move |
//! | `passes` | where each pass of the search begins, until the estimate stays |
//! | `optima` | the optima and their ranking |
//! | `readings`, `rereading` | other conventions of a candidate, and the search over them |
//! | `reframed`, `reviewing` | frames in other conventions of their views, and the search over them |
//! | `distortion`, `guessed` | whether a lens was left out; the uncertainty of a guessed camera |
//! | `conclusion`, `verdict`, `reason`, `health` | from the optima to verdicts, their reasons and errors |
//! | `check`, `sensitivity`, `next` | the order of all stages; curves of the cues; the frame to take next |
//! | `report`, `serialised` | the result of a check, and its forms for serde |
//! | `overlay` | a frame with the points and depth edges of a pose |
//! | `simulated` | scenes for tests |

mod ahead;
mod check;
mod conclusion;
mod cue;
mod differences;
mod discontinuities;
mod distortion;
mod distribution;
mod edges;
mod evidence;
mod frame;
mod guessed;
mod health;
mod information;
mod input;
mod intensity;
mod lattice;
mod next;
mod optima;
mod overlay;
mod passes;
mod patches;
mod planes;
mod readings;
mod reason;
mod reframed;
mod registration;
mod report;
mod rereading;
mod reviewing;
mod sampling;
mod search;
mod sensitivity;
#[cfg(feature = "serde")]
mod serialised;
mod shading;
mod silhouette;
#[cfg(test)]
mod simulated;
mod surface;
mod surfaces;
mod unknowns;
mod unseen;
mod verdict;

pub use check::CalibrationCheck;
pub use cue::Cue;
pub use health::Health;
pub use input::RigView;
pub use next::{NextFrame, NextMotion};
pub use overlay::{Overlay, overlay};
pub use readings::Reading;
pub use reason::{CheckReason, Margin, Offset, Warning, WarningKind};
pub use report::{CheckReport, CueReport, FrameReport};
pub use sensitivity::Sensitivity;
pub use verdict::{CandidateReport, CheckVerdict};
