//! Shape, light and camera pose from one colour image and one depth map of the same object.

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
mod view;
#[cfg(target_arch = "wasm32")]
mod wasm;

pub use error::{Error, ErrorKind, Result};
pub use estimator::{Estimator, Surface};
pub use light::{COEFFICIENTS, CoefficientMatrix, Light, LightFit, LightFitter, LightPrior};
pub use options::{LightSource, Options, Registration, Shading, Start, Weights};
pub use pose::{
    Angles, AnglesFit, CorrespondenceProblem, Correspondences, Icp, IcpOptions, IcpProblem, IcpReport, IcpTermination,
    Information, Metric, Neighbour, Neighbours, Pair, Photometric, PhotometricOptions, PhotometricProblem,
    PhotometricReport, PhotometricTermination, RansacOptions, RansacReport, Similarity, ransac,
};
pub use report::{Energy, Stage, Status, StepReport, Uncertainty};
pub use shape::{
    AnchorWeight, Anchors, HeightProblem, HeightReport, HeightSolver, IntegrationOptions, IntegrationReport,
    Integrator, RefinementProblem, Refiner, Robust, ShadingProblem, ShadingSolver, ShadingWeights, Termination,
    Terminations, exposure_step, first_exposure, gradients,
};
pub use view::{
    Camera, ColourImage, ColourSamples, ColourView, DepthMap, DepthSamples, DepthView, Normals, Pinhole, Points, Size,
    Transfer, cubic_normals, normals,
};
