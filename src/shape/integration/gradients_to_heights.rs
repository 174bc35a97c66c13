//! min over z of sum_e w_e (z_j - z_i - (g_i + g_j)/2)^2 + sum_i a_i (z_i - anchor_i)^2: a surface from its gradients
//! (Eq. 11; docs/method/normals.md; the paper's "integration", which follows Harker & O'Leary).
//!
//! Method: an edge e joins neighbours i and j (right or below) inside the mask. The trapezoidal rule on the gradients
//! g = p (along a row) or q (down a column) predicts its height difference, exactly for quadratics and otherwise with
//! an error of z'''/12. Harker & O'Leary minimise the same functional on the full rectangle with wider differences, as a
//! Sylvester equation. On a mask their equation is not separable, so this solver iterates (see `poisson`). Robust
//! weights (iteratively reweighted least squares after Geman & McClure, w = (1 + (r/s)^2)^-2) cut the edges that cross
//! a discontinuity. The scale s follows the noise, estimated from the gradients' curl, and is never below a share of
//! the mean gradient, so that discretisation errors of smooth data are not outliers. A cold start approaches this scale
//! by halves.
//!
//! Perspective views pass gradients of log Z (see [`gradients`](super::gradients())) and take exp of the result.
//!
//! Limits: gradients do not determine levels, so each connected component without anchors has mean zero. A pixel that
//! has no edge (unknown gradient) and no anchor is undetermined and comes out NaN. With robust weights the problem is
//! not convex: the surface depends on the start (least squares when cold, the previous surface when that was robust),
//! and a discontinuity is smeared if its edges outnumber the good ones that hold it. Gradients that are not integrable
//! at large scale (rather than by noise or jumps) converge slowly; `max_rounds` bounds the time.

use super::components::Components;
use super::poisson::{IntegrationTermination, Poisson, PoissonReport};
use super::terms::{AnchorWeight, Anchors, Edges};
use crate::check::positive;
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::{quantile, robust};
use crate::view::Size;

/// Gradients beyond this (height per pixel) count as unknown, because next to heights of 1e6 an f32 has no digits left
/// for a shape.
const LARGEST_GRADIENT: f32 = 1e6;
/// sigma of one edge's noise in medians of |curl|. A curl sums four edges, which doubles sigma.
const SIGMA_OF_CURL: f64 = robust::SIGMA_OF_MEDIAN / 2.0;
/// Least s as a share of the mean |gradient|, a few times the trapezoidal error of a well-sampled surface.
const LEAST_SCALE: f64 = 0.05;
/// Least weight of an edge, which keeps pixels attached to their neighbours if all their edges are outliers.
const LEAST_WEIGHT: f32 = 1e-4;
/// Reweighting ends when the mean change of the weights is below this, the change if three edges in a thousand become
/// outliers.
const SMALLEST_CHANGE: f64 = 3e-3;
/// Relative error of the solves between two reweightings, well below the least robust scale; the last solve is exact.
const ROUND_TOLERANCE: f64 = 1e-3;
/// Factor on the scale between rounds of a cold start, which begins at the root mean square residual. Least squares
/// smears a jump over its neighbours, and a small scale would cut these as well.
const ANNEALING: f64 = 0.5;
/// Largest number of cells in the median, evenly spread. The error of the median is then below one percent.
const MOST_SAMPLES: usize = 1 << 15;

/// Treatment of outliers among the gradients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Robustness {
    /// Plain least squares.
    Off,
    /// Geman-McClure weights, scale from the gradients' curl.
    Estimated,
    /// Geman-McClure weights with this scale in height per pixel.
    Scale(f64),
}

/// Options of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegrationOptions {
    /// Treatment of outliers among the gradients.
    pub robustness: Robustness,
    /// Relative error at which a solve ends, in the norm that is minimised.
    pub tolerance: f64,
    /// Largest number of conjugate-gradient iterations in all rounds together.
    pub max_iterations: u32,
    /// Largest number of reweighting rounds.
    pub max_rounds: u32,
}

impl Default for IntegrationOptions {
    /// Least squares to 1e-5 in at most 400 iterations; at most 10 rounds if `robustness` is switched on.
    fn default() -> Self {
        Self { robustness: Robustness::Off, ..Self::ROBUST }
    }
}

impl IntegrationOptions {
    /// Robust weights with the scale estimated from the gradients.
    pub(in crate::shape) const ROBUST: Self =
        Self { robustness: Robustness::Estimated, tolerance: 1e-5, max_iterations: 400, max_rounds: 10 };

    fn validate(&self) -> Result<()> {
        positive("integration.tolerance", self.tolerance)?;
        match self.robustness {
            Robustness::Scale(scale) => positive("integration.robustness", scale),
            Robustness::Off | Robustness::Estimated => Ok(()),
        }
    }
}

/// Report of an integration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IntegrationReport {
    /// Conjugate-gradient iterations of all rounds.
    pub iterations: u32,
    /// Rounds of reweighting.
    pub rounds: u32,
    /// Estimated relative error of the last solve, in the norm that is minimised.
    pub residual: f64,
    /// Scale s of the robust weights in height per pixel.
    pub scale: Option<f64>,
    /// Connected components of the pixels that edges join.
    pub components: usize,
    /// Mask pixels determined by neither an edge nor an anchor.
    pub undetermined: usize,
    /// Why it ended.
    pub termination: IntegrationTermination,
}

/// Integrates gradients over one mask repeatedly; owns all memory, and starts from its previous surface.
pub struct Integrator {
    size: Size,
    /// Left column and top row of the mask's bounding box.
    corner: [usize; 2],
    /// Columns and rows of that box.
    sides: [usize; 2],
    /// The mask over the system's raster (the bounding box, widened to a fast length).
    inside: Vec<bool>,
    pixels: usize,
    system: Poisson,
    components: Components,
    samples: Vec<f32>,
    /// Mean of the anchors, subtracted before solving so that f32 keeps its digits for the shape.
    level: f64,
    /// Whether the heights come from robust weights, so that their residuals reveal outliers at once.
    robust: bool,
}

impl Integrator {
    /// An integrator for the pixels of `mask` (row-major, as long as the raster).
    ///
    /// # Errors
    /// [`ErrorKind::Size`] if the mask is not as long as the raster, [`ErrorKind::Empty`] if it holds no pixel.
    pub fn new(size: Size, mask: &[bool]) -> Result<Self> {
        same_length("mask", size, mask.len())?;
        let Some(([left, top], [right, bottom])) = bounding_box(size, mask) else {
            return Err(Error::new(ErrorKind::Empty, "mask", "holds no pixel"));
        };
        let sides @ [columns, rows] = [right - left + 1, bottom - top + 1];
        let system = Poisson::new(columns, rows);
        let mut inside = vec![false; system.z.len()];
        for (row, inside) in inside.chunks_exact_mut(system.width).enumerate() {
            let first = size.index(left, top + row);
            inside[..columns].copy_from_slice(&mask[first..first + columns]);
        }
        let pixels = inside.iter().filter(|&&inside| inside).count();
        Ok(Self {
            size,
            corner: [left, top],
            sides,
            components: Components::new(inside.len()),
            samples: Vec::with_capacity(MOST_SAMPLES),
            level: 0.0,
            robust: false,
            pixels,
            inside,
            system,
        })
    }

    /// Forgets the previous surface: the next integration starts flat, like the first one.
    pub fn reset(&mut self) {
        self.system.z.fill(0.0);
        self.robust = false;
    }

    /// Finds the heights `z` whose differences follow `p` = dz/dcolumn and `q` = dz/drow, and the anchors.
    ///
    /// All slices are row-major over the raster; gradients in height per pixel, NaN where unknown. `z` is NaN off the
    /// mask and where nothing determines it; without anchors, each connected component has mean zero. Allocates
    /// nothing.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] if a slice is not as long as the raster, [`ErrorKind::Range`] for invalid options. A solver
    /// failure is not an error, but an [`IntegrationTermination`] in the report.
    pub fn integrate(
        &mut self,
        p: &[f32],
        q: &[f32],
        anchors: Option<Anchors<'_>>,
        options: &IntegrationOptions,
        z: &mut [f32],
    ) -> Result<IntegrationReport> {
        options.validate()?;
        let per_pixel = anchors.map(|anchors| match anchors.weight {
            AnchorWeight::Uniform(_) => anchors.height.len(),
            AnchorWeight::PerPixel(weights) => weights.len(),
        });
        let fields = [
            ("p", Some(p.len())),
            ("q", Some(q.len())),
            ("z", Some(z.len())),
            ("anchors.height", anchors.map(|anchors| anchors.height.len())),
            ("anchors.weight", per_pixel),
        ];
        for (field, length) in fields {
            same_length(field, self.size, length.unwrap_or(self.size.len()))?;
        }
        if self.load_gradients(p, q) {
            self.components.label(self.system.width, &self.system.right, &self.system.down);
        }
        self.load_anchors(anchors);
        let mut report = self.solve(options);
        self.components.level(&mut self.system.z, &self.system.anchor_weight);
        if report.termination == IntegrationTermination::Breakdown {
            self.reset();
        }
        report.undetermined = self.store(anchors, z);
        Ok(report)
    }

    /// Pixels of the mask's bounding box: their indices in the system and in the raster.
    fn window(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let ([left, top], [columns, rows], width, size) = (self.corner, self.sides, self.system.width, self.size);
        (0..rows).flat_map(move |row| {
            let (first, source) = (row * width, size.index(left, top + row));
            (0..columns).map(move |column| (first + column, source + column))
        })
    }

    /// Sets edges of weight one between mask pixels of known gradient; returns whether they differ from the last ones.
    fn load_gradients(&mut self, p: &[f32], q: &[f32]) -> bool {
        let mut changed = false;
        let width = self.system.width;
        for (index, source) in self.window() {
            let here = self.inside[index];
            // The pixel to the right of the last column is padding or the first pixel of another row.
            let has_right = here && (index + 1) % width != 0 && self.inside[index + 1];
            let has_below = here && self.inside.get(index + width).is_some_and(|&below| below);
            let right = if has_right { (p[source] + p[source + 1]) / 2.0 } else { f32::NAN };
            let down = if has_below { (q[source] + q[source + self.size.width]) / 2.0 } else { f32::NAN };
            changed |= set_edge(&mut self.system.right, index, right);
            changed |= set_edge(&mut self.system.down, index, down);
        }
        changed
    }

    /// Loads the anchors relative to their mean. Anchors of pixels without edges stay out of the system.
    fn load_anchors(&mut self, anchors: Option<Anchors<'_>>) {
        self.system.anchor.fill(0.0);
        self.system.anchor_weight.fill(0.0);
        self.level = 0.0;
        let Some(anchors) = anchors else { return };
        let (mut sum, mut weights) = (0.0, 0.0);
        for (index, source) in self.window() {
            if self.inside[index] && self.components.is_joined(index) {
                let (height, weight) = anchors.get(source);
                self.system.anchor[index] = height;
                self.system.anchor_weight[index] = weight;
                sum += f64::from(weight) * f64::from(height);
                weights += f64::from(weight);
            }
        }
        if weights > 0.0 {
            self.level = sum / weights;
            self.system.anchor.iter_mut().for_each(|height| *height = (f64::from(*height) - self.level) as f32);
        }
    }

    /// Least squares, preceded by rounds of reweighting if the options require them.
    fn solve(&mut self, options: &IntegrationOptions) -> IntegrationReport {
        let mut report = IntegrationReport {
            iterations: 0,
            rounds: 0,
            residual: 0.0,
            scale: None,
            components: self.components.count(),
            undetermined: 0,
            termination: IntegrationTermination::Empty,
        };
        if self.components.count() == 0 {
            return report;
        }
        if options.robustness != Robustness::Off {
            self.reweigh_in_rounds(options, &mut report);
        }
        self.solve_weighted(options.tolerance, options.max_iterations, &mut report);
        self.robust = options.robustness != Robustness::Off;
        report
    }

    /// Alternates robust weights and coarse solves until the weights hardly change.
    fn reweigh_in_rounds(&mut self, options: &IntegrationOptions, report: &mut IntegrationReport) {
        let tolerance = options.tolerance.max(ROUND_TOLERANCE);
        if !self.robust {
            self.solve_weighted(tolerance, options.max_iterations, report);
        }
        let aim = match options.robustness {
            Robustness::Scale(scale) => scale,
            Robustness::Off | Robustness::Estimated => self.noise_scale().max(LEAST_SCALE * self.mean_gradient()),
        };
        let mut start = if self.robust { 0.0 } else { robust::SCALE_IN_SIGMAS * self.residual_rms() };
        while report.rounds < options.max_rounds && report.termination != IntegrationTermination::Breakdown {
            let scale = start.max(aim);
            start *= ANNEALING;
            report.scale = Some(scale);
            report.rounds += 1;
            if self.reweigh(scale) < SMALLEST_CHANGE && report.rounds > 1 && scale == aim {
                break;
            }
            self.solve_weighted(tolerance, options.max_iterations, report);
        }
    }

    fn solve_weighted(&mut self, tolerance: f64, cap: u32, report: &mut IntegrationReport) {
        self.system.precondition(self.pixels);
        let PoissonReport { iterations, residual, termination } =
            self.system.solve(tolerance, cap.saturating_sub(report.iterations));
        report.iterations += iterations;
        report.residual = residual;
        report.termination = termination;
    }

    /// Both kinds of edges, with the index distance of the pixels that they join.
    fn edges(&self) -> [(&Edges, usize); 2] {
        [(&self.system.right, 1), (&self.system.down, self.system.width)]
    }

    fn mean_gradient(&self) -> f64 {
        let (mut sum, mut count) = (0.0, 0usize);
        for (edges, _) in self.edges() {
            for (gradient, _) in edges.gradient.iter().zip(&edges.weight).filter(|(_, weight)| **weight > 0.0) {
                sum += f64::from(gradient.abs());
                count += 1;
            }
        }
        sum / count.max(1) as f64
    }

    /// Root mean square of the edges' residuals.
    fn residual_rms(&self) -> f64 {
        let (mut sum, mut count) = (0.0, 0usize);
        for (edges, offset) in self.edges() {
            for index in (0..self.inside.len()).filter(|&index| edges.weight[index] > 0.0) {
                sum += f64::from(residual(edges, offset, &self.system.z, index)).powi(2);
                count += 1;
            }
        }
        (sum / count.max(1) as f64).sqrt()
    }

    /// Three sigma of the edges' noise, from the sums of the gradients around each cell of four pixels. They are zero
    /// for integrable gradients and independent of the surface found so far, so that reweighting can't narrow the
    /// scale.
    fn noise_scale(&mut self) -> f64 {
        let (right, down, width) = (&self.system.right, &self.system.down, self.system.width);
        let samples = &mut self.samples;
        samples.clear();
        let whole = |&index: &usize| {
            let (opposite, beside) = (right.weight.get(index + width), down.weight.get(index + 1));
            let edges = [right.weight.get(index), down.weight.get(index), opposite, beside];
            edges.iter().all(|weight| weight.is_some_and(|&weight| weight > 0.0))
        };
        let cells = (0..self.inside.len()).filter(whole).step_by(self.pixels.div_ceil(MOST_SAMPLES));
        samples.extend(cells.take(MOST_SAMPLES).map(|index| {
            let (over, under) = (right.gradient[index], right.gradient[index + width]);
            (over + down.gradient[index + 1] - under - down.gradient[index]).abs()
        }));
        if samples.is_empty() {
            return 0.0;
        }
        robust::SCALE_IN_SIGMAS * SIGMA_OF_CURL * f64::from(quantile(samples, 0.5))
    }

    /// Sets the weights for the current heights; returns their mean change.
    fn reweigh(&mut self, scale: f64) -> f64 {
        let per_scale = (1.0 / scale) as f32;
        let width = self.system.width;
        let (mut change, mut count) = (0.0, 0usize);
        for (edges, offset) in [(&mut self.system.right, 1), (&mut self.system.down, width)] {
            for index in 0..edges.weight.len() {
                let old = edges.weight[index];
                if old > 0.0 {
                    let ratio = residual(edges, offset, &self.system.z, index) * per_scale;
                    // NaN is 0/0: a flat surface with scale zero.
                    let new = if ratio.is_nan() { 1.0 } else { robust::weight(ratio * ratio).max(LEAST_WEIGHT) };
                    edges.weight[index] = new;
                    change += f64::from((new - old).abs());
                    count += 1;
                }
            }
        }
        change / count.max(1) as f64
    }

    /// Writes the raster; returns the number of undetermined mask pixels.
    fn store(&self, anchors: Option<Anchors<'_>>, z: &mut [f32]) -> usize {
        z.fill(f32::NAN);
        let mut undetermined = 0;
        for (index, source) in self.window().filter(|&(index, _)| self.inside[index]) {
            if self.components.is_joined(index) {
                z[source] = (f64::from(self.system.z[index]) + self.level) as f32;
                continue;
            }
            match anchors.map(|anchors| anchors.get(source)) {
                Some((height, weight)) if weight > 0.0 => z[source] = height,
                _ => undetermined += 1,
            }
        }
        undetermined
    }
}

/// z_j - z_i - g of an existing edge.
fn residual(edges: &Edges, offset: usize, z: &[f32], index: usize) -> f32 {
    z[index + offset] - z[index] - edges.gradient[index]
}

/// Sets an edge to weight one, or to zero if its gradient is unknown; returns whether that is a change.
fn set_edge(edges: &mut Edges, index: usize, gradient: f32) -> bool {
    let known = gradient.abs() <= LARGEST_GRADIENT;
    let news = known != (edges.weight[index] > 0.0);
    edges.weight[index] = if known { 1.0 } else { 0.0 };
    edges.gradient[index] = if known { gradient } else { 0.0 };
    news
}

fn same_length(field: &'static str, size: Size, length: usize) -> Result<()> {
    if length == size.len() {
        return Ok(());
    }
    let Size { width, height } = size;
    Err(Error::new(ErrorKind::Size, field, format!("{width}x{height} pixels need as many values, not {length}")))
}

/// First and last column and row of the mask, inclusive; `None` if it is empty.
fn bounding_box(size: Size, mask: &[bool]) -> Option<([usize; 2], [usize; 2])> {
    let mut inside = mask.iter().enumerate().filter(|(_, inside)| **inside).map(|(index, _)| size.position(index));
    let (column, row) = inside.next()?;
    Some(inside.fold(([column, row], [column, row]), |([left, top], [right, bottom]), (column, row)| {
        ([left.min(column), top.min(row)], [right.max(column), bottom.max(row)])
    }))
}
