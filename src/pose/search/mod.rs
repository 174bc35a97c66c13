//! Search over all poses: candidates without an initial pose, under a known or an unknown light
//! (docs/method/search.md).
//!
//! The objective, maximised over R, s and tau, is N (N / V) ln( det T / det E ) / 3, see [`score`]. It measures how
//! much better the rotated depth normals explain the image's log colours than a constant does.
//!
//! Method: depth map and image are put on a coarse grid. First comes a sweep. For rotations spread evenly, and several
//! scales if the scale is free, the visible part of the rotated cloud is drawn on the grid. FFT correlates all
//! translations at once, and the best few are scored exactly. Then the best rotations, no two of them similar, ascend
//! to their local maxima with halved steps. Their ends without duplicates, sorted by score, are the candidates.
//! Harmonics of order two are closed under rotation. Under an unknown light every rotation of the same normals
//! therefore explains the same colours, and only the positions of the normals in the image support a pose.
//!
//! | file | content |
//! |---|---|
//! | `problem` | input and output |
//! | `coarse_search` | [`Search`]: its slices, and the results that are kept |
//! | `sweep`, `rotations` | the rotations and sizes of the sweep |
//! | `ascent` | from a hypothesis to its local maximum |
//! | `matcher` | the score of a hypothesis, the best translation of a rotation |
//! | `cloud`, `template` | the depth view as patches, and their appearance to the colour camera |
//! | `target` | the colour view on the grid |
//! | `values` | the values of a cell of the grid |
//! | `contrast` | local contrast in place of colours, for varying albedo |
//! | `score`, `correlate` | fit of a template to a target: at one translation exactly, at all translations at once |
//! | `geometry` | from hypotheses to poses |
//! | `task_results` | results that may come in any order |
//!
//! Limits: tilt up to 100 degrees with roll up to 32, or any rotation up to 76 degrees. Candidates end a few degrees
//! from the truth. The search misses tilts beyond 60 degrees if the depth map shows half of the object, where the views
//! share too little, and overlaps below 0.15. It does not model shadows.

mod ascent;
mod cloud;
mod coarse_search;
mod contrast;
mod correlate;
mod geometry;
mod hypothesis;
mod matcher;
mod problem;
mod rotations;
mod score;
mod sweep;
mod target;
mod task_results;
mod template;
mod values;

pub use coarse_search::Search;
pub(crate) use coarse_search::{SearchFinding, SearchTask};
pub(crate) use hypothesis::Hypothesis;
pub(crate) use matcher::ImageGrid;
pub use problem::{Candidate, Progress, SearchProblem};
pub(crate) use task_results::TaskResults;
