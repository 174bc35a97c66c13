//! Camera pose, shape and light from one colour image and one depth map of the same object, taken from different places.
//!
//! The crate needs no calibration target, no matched features and no initial pose. The colours of a surface depend on its normals, and a
//! depth map has normals: under the right pose, the normals explain the colours. The method is that of Zhang, Liu, Wu, Zhang and Wang,
//! "Bimodal Stereo: Joint Shape and Pose Estimation from Color-Depth Image Pair" (Machine Vision and Applications), extended by a search, a
//! photometric registration and a verdict.
//!
//! # Example
//!
//! ```
//! use bimodal_stereo::{ColourImage, ColourSamples, DepthMap, DepthSamples, Estimator, Options, Status};
//! # use bimodal_stereo::scenes;
//! # let sample = scenes::Scene::new(&scenes::surface("bust")?)?.sample(&Default::default())?;
//! # let (width, height) = (sample.image.size.width, sample.image.size.height);
//! # let (colours, object) = (sample.image.colours.clone(), sample.image.mask.iter().map(|&it| u8::from(it)).collect());
//! # let DepthSamples::Float(depths) = sample.depth_map().samples else { unreachable!() };
//!
//! // Linear R, G, B of each pixel, row by row; 8 and 16 bits are possible as well.
//! let samples = ColourSamples::RgbLinear(colours);
//! let image = ColourImage { width, height, samples, transfer: None, mask: Some(object), camera: None };
//! // Depths along z; zero and NaN are holes.
//! let samples = DepthSamples::Float(depths);
//! let depth = DepthMap { width, height, samples, unit: None, mask: None, camera: None, normals: None };
//!
//! let mut estimator = Estimator::new(image, &depth, Options::default())?;
//! while estimator.report().status == Status::Running {
//!     estimator.step();
//! }
//!
//! let report = estimator.report();
//! assert_eq!(report.status, Status::Converged, "{:?}", report.reason);
//! println!("P_colour = M P_depth with M ={}", report.pose.matrix());
//! # assert!(report.pose.degrees_to(&sample.pose) < 1.0);
//! # Ok::<(), bimodal_stereo::Error>(())
//! ```
//!
//! # Input and output
//!
//! | input | |
//! |---|---|
//! | [`ColourImage`] | samples, and if known a mask and the intrinsics ([`Pinhole`]) |
//! | [`DepthMap`] | samples or an organised cloud, and if known a mask, the unit, the intrinsics and normals |
//! | [`Options`] | the initial pose or a search, a known light or scale, how to register, when to end; the defaults assume nothing |
//!
//! | output | |
//! |---|---|
//! | [`StepReport`] | the [pose](Similarity), its [uncertainty](Uncertainty), other poses that fit equally well, the [status](Status) and its reason |
//! | [`Estimator`] | [the light](Estimator::light), [refined depth](Estimator::refined_depth), [the image's depth](Estimator::image_depth), normals, albedo, residuals |
//!
//! A run ends with [`Status::Converged`], or reports that the data allow other poses ([`Status::Ambiguous`]) or that
//! the answer cannot be trusted ([`Status::Lost`]). An invalid input gives an [`Error`] with the field, the index and
//! the value. The same input gives the same output, to the bit.
//!
//! Further entry points: [`CalibrationCheck`] tests whether the stored calibration of a colour and depth rig still
//! holds, [`scenes`] renders views with a known answer, and each stage can be used separately ([`Search`],
//! [`Photometric`], [`Icp`], [`ransac`], [`LightFitter`], [`ShadingSolver`], [`Integrator`], [`Correspondences`]).
//!
//! # Tutorial
//!
//! The module [`tutorial`] explains the method in eight short chapters, each with its equation and a runnable example.
//! The formulas, solvers, costs and limits of each stage are in `docs/method/` of the repository.
//!
//! # Frames and units
//!
//! One frame is used everywhere: x right, y down, z forward; depth is along z, and normals face the camera (n_z < 0). A
//! view without intrinsics is orthographic and its unit is the pixel; with intrinsics it is metric, in metres. A pose
//! maps points of the depth view into the frame of the colour view,
//!
//! > P_colour = s R P_depth + t,  R = Rx(alpha) Ry(beta) Rz(gamma)
//!
//! It converts from and into nalgebra's `Isometry3`, `Similarity3` and `Matrix4` ([`Similarity`]); [`nalgebra`] is
//! re-exported, so that its version always matches.
//!
//! # Features
//!
//! | feature | adds |
//! |---|---|
//! | `image` | `TryFrom<&DynamicImage>` of the crate [image](https://docs.rs/image) for [`ColourImage`] and [`DepthMap`] |
//! | `serde` | `Serialize` of reports, `Deserialize` of [`Options`], with the names of the JavaScript contract |
//! | `rayon` | `Estimator::with_threads`: native threads share the work, with the same answer to the bit |
//! | `bindings`, `bindings-check`, `bindings-rigs` | the exports of this project's npm package, only on `wasm32-unknown-unknown`; nothing for other crates |
//!
//! All are off by default. Compiled for WebAssembly, the crate uses 128-bit SIMD if `target-feature=+simd128` is set,
//! and exports nothing.

#![deny(unsafe_code)]

/// The README's Rust examples, compiled and run with the documentation tests.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

/// Cause and remedy of every code, as JSON: by group ("runs", "checks", "warnings", "errors" ..) and code.
pub const CODES: &str = include_str!("codes.json");

// The modules of the crate. Data flows one way: a module uses only those before it, and no two files of a module import
// each other. `tests/floors` checks both, and that this table is complete and in order.
//
// | module | content | the paper |
// |---|---|---|
// | `text`, `serial`, `error`, `check` | numbers in messages, serialised forms, errors as values, checks of single numbers | |
// | `numeric` | lanes, robust weights, conjugate gradients, cosine and Fourier transforms, ranks, noise | |
// | `diagnosis` | whether a single albedo explains an image, with all thresholds for that question | |
// | `view` | the input: sizes, masks, cameras, log colours, points, normals | input of Algorithm 1 |
// | `light` | `harmonics` the image model, `prior` the natural lights, `fit` the light from known normals | Eq. 2, 3, 5 |
// | `shape/pixels` | a normal for each pixel, with a prior; the exposure, shared by all pixels | Eq. 6 to 9 |
// | `shape/integration` | the surface from gradients of normals, on a mask | Harker and O'Leary's step |
// | `shape/heights` | the surface from shading as a whole, for light under which single pixels are ambiguous | beyond the paper |
// | `shape/refinement` | the depth view's own normals and depth, through `heights` | Eq. 17 to 19 |
// | `lessons` | what only the lessons compute: one lamp, characteristic strips, the objective of one pixel | Eq. 6 |
// | `pose/search` | the initial pose if nothing is known: all rotations, translations and scales, on a coarse grid | before Algorithm 1 |
// | `pose/photometric` | the pose directly from the image, with the light projected out | beyond the paper |
// | `pose/contrast` | the pose of an object with varying albedo, by local contrast in an orthographic image | beyond the paper |
// | `pose/silhouettes` | the pose of an object with varying albedo behind a pinhole, by silhouettes | beyond the paper |
// | `pose/icp`, `pose/ransac` | the pose from both surfaces | Eq. 12 to 14 |
// | `pose/similarity`, `pose/angles` | s, R, t and the angles, in closed form; the least-squares fit of Eq. 16 is a test, `tests/library/pose_angles.rs` | Eq. 15, 16, 20 |
// | `pose/correspondence` | which depth point falls on which pixel, and what occludes it | the 1-pixel rule |
// | `calibration` | the check of a rig's calibration: estimate, covariance, verdict on each candidate | |
// | `options`, `reason`, `report` | what a run can be given, what it reports and why | |
// | `picture` | results as screen pixels | |
// | `estimator` | Algorithm 1 stage by stage, its `objective`, its `verdict`; the `finder` of a pose; workers and threads | Eq. 1, Algorithm 1 |
// | `scenes` | surfaces, lights and a renderer with a known answer; uses `view`, `light`, `pose`, `calibration` | the experiments |
// | `tutorial` | the method in eight chapters, each with a runnable example; documentation only | all of it |
// | `wasm` | bindings without mathematics, wasm32 only | |
//
// Different readings of the paper. It writes the two prior terms of Eq. 6 without a square and lambda_3 linear; a
// least-squares solver squares them, as this one does. The norm of Eq. 20 is not named; its tables fit the spectral
// norm. Refined normals explain any colour under any pose, so the objective of an iteration uses the measured ones.

mod calibration;
mod check;
mod diagnosis;
mod error;
mod estimator;
mod lessons;
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
    Margin, NextFrame, NextMotion, Offset, Overlay, Reading, RigView, Sensitivity, Warning, WarningKind, overlay,
};
pub use error::{Error, ErrorKind, Result};
pub use estimator::{Estimator, Finding, RefinementTask, Surface, Task, Worker};
/// The pictures from which this crate's views can be made.
#[cfg(feature = "image")]
pub use image;
pub use lessons::{
    BasRelief, Form, Lamp, Minimum, PixelLandscape, ShadedImage, characteristic_strips, second_order,
    surface_of_normals,
};
pub use light::{COEFFICIENTS, CoefficientMatrix, Light, LightFit, LightFitter, LightGaussian, LightPrior};
/// The linear algebra of this crate's public types, in the version that they use.
pub use nalgebra;
pub use options::{LightSource, Options, Registration, Shading, Start, StartTolerance, Weights};
pub use picture::{ColourMap, Layer};
pub use pose::{
    Angles, Axis, Candidate, CorrespondenceProblem, Correspondences, Direction, Icp, IcpOptions, IcpProblem, IcpReport,
    IcpTermination, Information, Metric, Pair, Photometric, PhotometricOptions, PhotometricProblem, PhotometricReport,
    PhotometricTermination, PosePrior, Progress, RansacOptions, RansacReport, Search, SearchProblem, Similarity,
    Uncertainty, Unknown, ransac,
};
pub use reason::{Activity, FoundBy, Reason};
pub use report::{Objective, Stage, Status, StepReport};
pub use shape::{
    AnchorWeight, Anchors, IntegrationOptions, IntegrationReport, IntegrationTermination, Integrator, Robustness,
    ShadingProblem, ShadingReport, ShadingSolver, ShadingWeights, exposure_step, first_exposure, gradients,
};
pub use view::{
    Camera, ColourImage, ColourSamples, ColourView, DepthMap, DepthNoise, DepthSamples, DepthView, Lens, Mark, Normals,
    Pinhole, Points, Segmentation, SegmentationReport, Size, Transfer, cubic_normals, normals,
};
