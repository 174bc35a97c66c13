//! Shape, light and camera pose from one colour image and one depth map of the same object, taken from different
//! places.
//!
//! The method of Zhang, Liu, Wu, Zhang and Wang, "Bimodal Stereo: Joint Shape and Pose Estimation from Color-Depth
//! Image Pair" (Machine Vision and Applications), stage by stage. Data flows one way: a room looks only into rooms
//! before it, and no two files of a room import each other (held by `tests/floors`).
//!
//! | room | what it holds | the paper |
//! |---|---|---|
//! | `text`, `serial`, `error`, `check` ([`Error`]) | numbers in messages, shapes for serde, errors as values, checks of single numbers | |
//! | `numeric` | lanes, robust weights, conjugate gradients, cosine and Fourier transforms, ranks, noise | |
//! | `view` ([`ColourView`], [`DepthView`]) | what comes in: sizes, masks, cameras, log colours, points, normals | input of Algorithm 1 |
//! | `light` ([`Light`]) | `harmonics` the image model, `prior` the natural lights, `fit` the light of known normals | Eq. 2, 3, 5 |
//! | `shape/pixels` ([`ShadingSolver`]) | a normal for each pixel, with a prior; the exposure, which all share | Eq. 6 to 9 |
//! | `shape/integration` ([`Integrator`]) | the surface from gradients of normals, on a mask | Harker and O'Leary's step |
//! | `shape/heights` | the surface from shading as a whole, for light that a pixel alone cannot read | beyond the paper |
//! | `shape/refinement` | the depth view's own normals and depth, through `heights` | Eq. 17 to 19 |
//! | `pose/search` ([`Search`]) | where to start when nothing is known: all rotations, translations and scales, coarsely | before Algorithm 1 |
//! | `pose/photometric` ([`Photometric`]) | the pose straight from the colours, the light projected out | beyond the paper |
//! | `pose/contrast` | the pose of a painted object, by local contrast and its outline | beyond the paper |
//! | `pose/icp`, `pose/ransac` ([`Icp`], [`ransac`]) | the pose from both surfaces | Eq. 12 to 14 |
//! | `pose/similarity`, `pose/angles` ([`Similarity`], [`Angles`]) | s, R, t and the angles, in closed form; the least-squares fit of Eq. 16 is a test, `tests/library/pose_angles.rs` | Eq. 15, 16, 20 |
//! | `pose/correspondence` ([`Correspondences`]) | which depth point is which pixel, and what hides it | the 1-pixel rule |
//! | `calibration` ([`RigCamera`]) | the cameras of a rig whose calibration is in question, and their lenses | |
//! | `options`, `reason`, `report` ([`Options`], [`Reason`], [`StepReport`]) | what the loop can be told, what it reports and why | |
//! | `picture` ([`Layer`]) | results as pixels of a screen | |
//! | `estimator` ([`Estimator`]) | Algorithm 1 stage by stage, its `objective`, its `verdict`; the `initialisation` before it; its [`Worker`]s | Eq. 1, Algorithm 1 |
//! | [`scenes`] | surfaces, lights and a renderer with a known answer; stands on `view`, `light`, `pose`, `calibration` | the experiments |
//! | `tutorial` | the method in eight chapters, each with an example that runs; documentation alone | all of it |
//! | `wasm` | bindings without mathematics, wasm32 only | |
//!
//! `docs/method.md` has the objective, unknowns, solver, cost and limits of each stage.
//!
//! One frame everywhere: x right, y down, z forward, normals face the camera (n_z < 0), depth along z. Without
//! intrinsics a view is orthographic and its unit is the pixel; with them it is metric. A pose:
//! P_colour = s R P_depth + t.
//!
//! Where we read the paper differently: it writes the two prior terms of Eq. 6 without a square and lambda_3 linear; a
//! least-squares solver squares them, so do we. The norm of Eq. 20 is not named; its tables fit the spectral norm.
//! Refined normals explain any colour under any pose, so the objective of an iteration asks the measured ones.

#![deny(unsafe_code)]

/// The README's Rust examples, compiled and run with the documentation's.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Cause and remedy of every code, as JSON: by group ("runs", "checks", "warnings", "errors") and code.
pub const CODES: &str = include_str!("codes.json");

mod calibration;
mod check;
mod error;
mod estimator;
mod light;
#[macro_use]
mod numeric;
mod options;
mod picture;
mod pose;
mod reason;
mod report;
pub mod scenes;
#[cfg(feature = "serde")]
mod serial;
mod shape;
mod text;
#[cfg(any(doc, doctest))]
pub mod tutorial;
mod view;
#[cfg(all(target_arch = "wasm32", target_os = "unknown", feature = "bindings"))]
#[allow(unsafe_code, reason = "of what wasm-bindgen generates; the files themselves have none")]
mod wasm;

pub use calibration::{
    CalibrationCheck, CandidateReport, CheckReason, CheckReport, CheckVerdict, Cue, CueReport, FrameReport, Health,
    Lens, Margin, Offset, Overlay, RigCamera, RigView, Sensitivity, Warning, WarningKind, overlay,
};
pub use error::{Error, ErrorKind, Result};
pub use estimator::{Estimator, Finding, RefinementTask, Surface, Task, Worker};
pub use light::{COEFFICIENTS, CoefficientMatrix, Light, LightFit, LightFitter, LightGaussian, LightPrior};
/// The linear algebra in this crate's public types, of the very release that they are made of.
pub use nalgebra;
pub use options::{LightSource, Options, Registration, Shading, Start, StartTolerance, Weights};
pub use picture::{ColourMap, Layer};
pub use pose::{
    Angles, Axis, Candidate, CorrespondenceProblem, Correspondences, Direction, Icp, IcpOptions, IcpProblem, IcpReport,
    IcpTermination, Information, Metric, Pair, Photometric, PhotometricOptions, PhotometricProblem, PhotometricReport,
    PhotometricTermination, Progress, RansacOptions, RansacReport, Search, SearchProblem, Similarity, Uncertainty,
    Unknown, ransac,
};
pub use reason::{Activity, FoundBy, Reason};
pub use report::{Objective, Stage, Status, StepReport};
pub use shape::{
    AnchorWeight, Anchors, IntegrationOptions, IntegrationReport, IntegrationTermination, Integrator, Minimum,
    PixelLandscape, Robustness, ShadingProblem, ShadingReport, ShadingSolver, ShadingWeights, exposure_step,
    first_exposure, gradients, surface_of_normals,
};
pub use view::{
    Camera, ColourImage, ColourSamples, ColourView, DepthMap, DepthNoise, DepthSamples, DepthView, Normals, Pinhole,
    Points, Size, Transfer, cubic_normals, normals,
};
