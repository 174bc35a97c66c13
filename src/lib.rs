//! Shape, light and camera pose from one colour image and one depth map of the same object, taken from different
//! places.
//!
//! The method of Zhang, Liu, Wu, Zhang and Wang, "Bimodal Stereo: Joint Shape and Pose Estimation from Color-Depth
//! Image Pair" (Machine Vision and Applications), stage by stage. Data flows one way; a later room may look into an
//! earlier one, never the other way round:
//!
//! | room | what it holds | the paper |
//! |---|---|---|
//! | [`view`](ColourView) | what comes in: sizes, masks, cameras, log colours, points, normals | input of Algorithm 1 |
//! | [`light`](Light) | the image model, the natural lights, the fit of a light | Eq. 2, 3, 5 |
//! | `shape/shading` ([`ShadingSolver`]) | a normal for each pixel, with a prior; `exposure` its one global unknown | Eq. 6 to 9 |
//! | `shape/surface` ([`Integrator`]) | heights from normals on a mask; `poisson`, `cosine` its solvers | Harker and O'Leary's step |
//! | `shape/relief` | the image surface's heights as a whole, for light that a pixel alone cannot read | beyond the paper |
//! | `shape/refine` ([`Refiner`]) | the depth view's own normals and depth, through `heights` | Eq. 17 to 19 |
//! | `pose/search` ([`Search`]) | where to start when nothing is known: all rotations, translations and scales, coarsely | before Algorithm 1 |
//! | `pose/photometric` ([`Photometric`]) | the pose straight from the colours, the light projected out | beyond the paper |
//! | `pose/icp`, `pose/ransac` ([`Icp`], [`ransac`]) | the pose from both surfaces | Eq. 12 to 14 |
//! | `pose/similarity`, `pose/angles` ([`Similarity`], [`Angles`]) | s, R, t and the angles, in closed form; the least-squares fit of Eq. 16 is a test, `tests/pose_angles.rs` | Eq. 15, 16, 20 |
//! | `pose/correspondence` ([`Correspondences`]) | which depth point is which pixel | the 1-pixel rule |
//! | `estimator` ([`Estimator`]) | one iteration, its merit, its end; `opening` (search, candidates, rivals) before it, parts of it done by a [`Helper`] elsewhere | Eq. 1, Algorithm 1 |
//! | [`scenes`] | surfaces, lights and a renderer with a known answer | the experiments |
//! | `wasm` | bindings without mathematics, wasm32 only | |
//!
//! One frame everywhere: x right, y down, z forward, normals face the camera (n_z < 0), depth along z. Without
//! intrinsics a view is orthographic and its unit is the pixel; with them it is metric. A pose:
//! P_colour = s R P_depth + t.
//!
//! Where we read the paper differently: it writes the two prior terms of Eq. 6 without a square and lambda_3 linear; a
//! least-squares solver squares them, so do we. The norm of Eq. 20 is not named; its tables fit the spectral norm.
//! Refined normals explain any colour under any pose, so the merit of an iteration asks the measured ones.

/// The README's Rust examples, compiled and run with the documentation's.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod error;
mod estimator;
mod light;
mod options;
mod pose;
mod report;
pub mod scenes;
mod shape;
mod text;
mod view;
#[cfg(target_arch = "wasm32")]
mod wasm;

pub use error::{Error, ErrorKind, Result};
pub use estimator::{Estimator, Finding, Helper, RefinementTask, Surface, Task};
pub use light::{COEFFICIENTS, CoefficientMatrix, Light, LightFit, LightFitter, LightPrior};
pub use options::{LightSource, Options, Registration, Shading, Start, Weights};
pub use pose::{
    Angles, Candidate, CorrespondenceProblem, Correspondences, Icp, IcpOptions, IcpProblem, IcpReport, IcpTermination,
    Information, Metric, Neighbour, Neighbours, Pair, Photometric, PhotometricOptions, PhotometricProblem,
    PhotometricReport, PhotometricTermination, Progress, RansacOptions, RansacReport, Search, Similarity, ransac,
};
pub use report::{Energy, Stage, Status, StepReport, Uncertainty};
pub use shape::{
    AnchorWeight, Anchors, HeightDomain, HeightProblem, HeightReport, HeightSolver, IntegrationOptions,
    IntegrationReport, Integrator, RefinementProblem, RefinementTerms, Refiner, Robust, ShadingProblem, ShadingSolver,
    ShadingWeights, Termination, Terminations, Workbench, exposure_step, first_exposure, gradients,
};
pub use view::{
    Camera, ColourImage, ColourSamples, ColourView, DepthMap, DepthSamples, DepthView, Normals, Pinhole, Points, Size,
    Transfer, cubic_normals, normals,
};
