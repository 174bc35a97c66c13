//! The data of a surface, and limits of the work on it.

use nalgebra::Matrix3;

use crate::light::Light;
use crate::shape::integration::Anchors;

/// Robust scales of successive solves from a distant start, log residuals. They decrease, so that no pixel is discarded
/// before the surface is close. The last one is three times the noise of an image with 2 % noise.
pub const COLOUR_SCALES: [f32; 3] = [0.5, 0.2, LAST_SCALE];
/// The robust scale of solves that continue an earlier one, log residuals.
pub const LAST_SCALE: f32 = 0.06;

/// Confidence, squared log residual per squared slope, at which the smoothness has half its weight. A light whose
/// colours change by 0.1 for a slope of one gives this confidence.
pub const HALVING_CONFIDENCE: f32 = 0.01;

/// The data of one surface; all fields are rasters of the view, NaN where unknown.
#[derive(Clone, Copy)]
pub struct HeightProblem<'a> {
    /// log S of R, G, B.
    pub log: [&'a [f32]; 3],
    /// The light, with exposure.
    pub light: &'a Light,
    /// Rotates this view's normals into the light's frame.
    pub rotation: &'a Matrix3<f64>,
    /// Slopes p, q of the pixels' own normals, in pixels of height per pixel. Their weight depends on how well the
    /// colours of a single pixel determine its normal.
    pub slopes: [&'a [f32]; 2],
    /// Weight of each pixel's own normal beyond that of its colours, in squared log residual: lambda_2 for pixels with
    /// a prior normal. `None`: no such weight.
    pub normal_weight: Option<&'a [f32]>,
    /// Heights towards which the surface is drawn.
    pub anchors: Option<Anchors<'a>>,
    /// Resistance of the surface to bending, in addition to that of the solver.
    pub bending: Bending,
    /// Scale of the robust function: the log residual at which a pixel keeps a quarter of its weight.
    pub colour_scale: f32,
    /// Limits of the work.
    pub effort: Effort,
}

/// Prior of a surface's second differences: weight rho(d^2 z), Geman-McClure, linearised at the initial heights of a
/// solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bending {
    /// Squared log residual per squared second difference.
    pub weight: f32,
    /// Scale of rho in pixels; a larger second difference is a crease.
    pub scale: f32,
    /// Confidence of a pixel's colours at which the bending has half its weight.
    pub halving: f32,
}

impl Bending {
    /// Heights bend freely, without a prior.
    pub const FREE: Self = Self { weight: 0.0, scale: 1.0, halving: 1.0 };
}

/// Limits of the work of a solve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Effort {
    /// Gauss-Newton steps.
    pub steps: u32,
    /// Conjugate-gradient iterations of each step. A few settle fine detail; many settle shapes that span the whole
    /// object.
    pub iterations: u32,
    /// Relative residual at which the conjugate gradients end. A step is only a direction, so more digits would be
    /// wasted.
    pub tolerance: f64,
    /// Damping of the first step, relative to the mean stiffness of the terms.
    pub damping: f32,
}

/// Damping of the first step from a start that may be far away.
pub const FAR_DAMPING: f32 = 0.1;
