//! Iterative closest points with scale (Eq. 12): registers the depth view's points to the image surface.
//!
//! See docs/method/surfaces.md. Each iteration transforms the depth points by the present pose, finds their nearest
//! points on the image surface, and takes one damped Gauss-Newton step of the seven unknowns (six if the scale is
//! held). Some pairs are left out: those whose normals disagree, those on the border of the image surface (where every
//! point without a counterpart ends), those farther apart than a distance that shrinks with each iteration, and the
//! farthest of the rest. The others are weighted by Geman and McClure's function of the residual.
//!
//! Point-to-plane distances hold a smooth object of free scale in place; with only point-to-point distances it slides.
//! A share of point-to-point distances that fades with the pairing distance widens the basin a little
//! (docs/lab/experiments.md).
//!
//! Limits: from the identity, ICP registers a face that is rotated by up to 60 degrees, a nearly bare ellipsoid only up
//! to 30. Beyond that it ends in a wrong rotation. [`Information`] flags many such ends, but not all. They are local
//! optima, which only another initial pose reveals.

use nalgebra::Vector3;

use super::increment::{Increment, NormalEquations, PoseMatrix, SCALE, clear_unknowns};
use super::neighbours::Neighbours;
use super::similarity::{FEWEST_PAIRS, Similarity};
use super::uncertainty::Information;
use crate::check::positive;
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::{quantile, robust};
use crate::view::{Normals, Points, Size, extent};

/// Smallest cosine between the normals of a pair: they must agree to 60 degrees (docs/lab/thresholds.md).
const LEAST_COSINE: f64 = 0.5;
/// Share of the pairs that is kept, nearest first (docs/lab/thresholds.md).
const KEPT_SHARE: f64 = 0.9;
/// Factor by which the pairing distance shrinks from one iteration to the next.
const SHRINKING: f64 = 0.9;
/// Weight of point-to-point against point-to-plane distances at the first pairing distance; it falls to zero with the
/// logarithm of that distance.
const FIRST_POINT_WEIGHT: f64 = 1.0;
/// Damping as a share of the total weight (docs/lab/thresholds.md).
const DAMPING: f64 = 1e-3;
/// Smallest robust scale as a share of the final distance; smaller residuals are rounding.
const LEAST_SCALE: f64 = 0.02;
/// The pose has settled if a step rotates by less (radians; 0.0006 degrees), moves by less (object sizes) and grows by
/// less.
const SETTLED: f64 = 1e-5;
/// The scale has diverged if it differs from the initial scale by more than this factor.
const LARGEST_GROWTH: f64 = 4.0;
/// Largest correlation of neighbouring residuals, at which 40000 pixels count as one.
const LARGEST_CORRELATION: f64 = 0.99;
/// Maximum number of depth points, evenly spread: more of them take time but do not improve the accuracy.
const MOST_POINTS: usize = 5_000;

/// The two surfaces and the initial pose. Points and normals are NaN where missing; normals are unit vectors.
#[derive(Clone, Copy)]
pub struct IcpProblem<'a> {
    /// Points of the depth view, in its own frame and unit.
    pub depth_points: &'a Points,
    /// Normals of the depth points.
    pub depth_normals: &'a Normals,
    /// Points of the image surface on its raster, in the colour view's frame.
    pub image_points: &'a Points,
    /// Normals of the image points.
    pub image_normals: &'a Normals,
    /// Raster of the image surface.
    pub image_size: Size,
    /// The initial pose; its scale is held, or is the initial value s0.
    pub start: Similarity,
}

/// The distance that is minimised.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metric {
    /// |q - p|, the distance of Eq. 12.
    PointToPoint,
    /// n . (q - p) with the normal n of the image surface.
    PointToPlane,
}

/// Options of the registration. Distances are in units of the colour view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IcpOptions {
    /// The distance that is minimised.
    pub metric: Metric,
    /// Whether s keeps its initial value.
    pub scale_is_held: bool,
    /// Initial pairing distance; `None` is the size of the object, which suits an unknown pose.
    pub first_distance: Option<f64>,
    /// Final pairing distance.
    pub final_distance: f64,
    /// Maximum number of iterations.
    pub most_iterations: u32,
}

impl Default for IcpOptions {
    fn default() -> Self {
        Self {
            metric: Metric::PointToPlane,
            scale_is_held: false,
            first_distance: None,
            final_distance: 2.0,
            most_iterations: 100,
        }
    }
}

/// Why ICP ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum IcpTermination {
    /// The pose has settled at the final distance.
    Settled,
    /// The maximum number of iterations came first, usually because a few pairs alternate.
    MostIterations,
}

/// Result of ICP.
#[derive(Clone, Debug, PartialEq)]
pub struct IcpReport {
    /// The pose.
    pub pose: Similarity,
    /// Weighted root mean square of n . (q - p) over the pairs, in units of the colour view.
    pub rms: f64,
    /// Number of pairs in the last iteration.
    pub pairs: usize,
    /// Iterations.
    pub iterations: u32,
    /// Why it ended.
    pub termination: IcpTermination,
    /// The information of the pairs about the pose; if it [is degenerate](Information::is_degenerate), they do not
    /// determine the pose.
    pub information: Information,
}

/// A depth point and its nearest point on the image surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pair {
    /// Index of the depth point.
    pub depth: u32,
    /// Index of the image point.
    pub image: u32,
    /// Distance in units of the colour view.
    pub distance: f32,
}

/// ICP with its memory; allocates nothing between iterations.
#[derive(Default)]
pub struct Icp {
    neighbours: Neighbours,
    sources: Vec<u32>,
    pairs: Vec<Pair>,
    /// Scratch for quantiles.
    distances: Vec<f32>,
}

impl Icp {
    /// ICP without allocated memory.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// The pairs of the last registration, in the order of the depth points.
    #[must_use]
    pub fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    /// Stores the points of the last registration's pairs side by side: the correspondences that
    /// [`ransac`](super::ransac) requires, at most `most` of them, evenly spread.
    pub fn paired_points(
        &self,
        problem: &IcpProblem<'_>,
        depth: &mut Vec<Vector3<f64>>,
        image: &mut Vec<Vector3<f64>>,
        most: usize,
    ) {
        depth.clear();
        image.clear();
        let pairs = || self.pairs.iter().step_by(self.pairs.len().div_ceil(most.max(1)).max(1));
        depth.extend(pairs().map(|pair| vector(problem.depth_points, pair.depth)));
        image.extend(pairs().map(|pair| vector(problem.image_points, pair.image)));
    }

    /// The pose that registers the depth points to the image surface, from a roughly correct initial pose.
    ///
    /// A plane, a sphere or another surface that slides onto itself gives a report whose information
    /// [is degenerate](Information::is_degenerate) and whose uncertainty is wide.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] if lengths disagree, [`ErrorKind::Range`] if the initial pose or a distance is invalid,
    /// [`ErrorKind::Degenerate`] if fewer than four pairs are left or the scale diverges.
    pub fn register(&mut self, problem: &IcpProblem<'_>, options: &IcpOptions) -> Result<IcpReport> {
        check(problem, options)?;
        self.prepare(problem)?;
        let (mut pose, mut iterations) = (problem.start, 0);
        let mut distances = Distances::new(options, extent(problem.image_points.valid()).1);
        let mut termination = IcpTermination::MostIterations;
        for _ in 0..options.most_iterations.max(1) {
            iterations += 1;
            self.pair(problem, &pose, distances.present)?;
            let point_weight = match options.metric {
                Metric::PointToPoint => 1.0,
                Metric::PointToPlane => FIRST_POINT_WEIGHT * distances.share(),
            };
            let increment = self.step(problem, &pose, options, point_weight)?;
            pose = increment.change.after(&pose).orthonormal();
            if pose.growth_from(&problem.start) > LARGEST_GROWTH.ln() {
                return Err(degenerate("the scale diverges").value(pose.scale));
            }
            if distances.present <= distances.last && increment.size < SETTLED {
                termination = IcpTermination::Settled;
                break;
            }
            distances.shrink();
        }
        self.pair(problem, &pose, distances.last)?;
        let (rms, information) = self.information(problem, &pose, options);
        Ok(IcpReport { pose, rms, pairs: self.pairs.len(), iterations, termination, information })
    }

    /// Builds the tree of the image surface without its border, and selects the depth points.
    fn prepare(&mut self, problem: &IcpProblem<'_>) -> Result<()> {
        self.neighbours.rebuild(problem.image_points, |index| {
            problem.image_normals.is_valid(index) && !is_border(problem.image_points, problem.image_size, index)
        });
        let valid = |&index: &u32| {
            problem.depth_points.is_valid(index as usize) && problem.depth_normals.is_valid(index as usize)
        };
        let all = 0..problem.depth_points.len() as u32;
        let stride = all.clone().filter(valid).count().div_ceil(MOST_POINTS).max(1);
        self.sources.clear();
        self.sources.extend(all.filter(valid).step_by(stride));
        if self.neighbours.len() < FEWEST_PAIRS || self.sources.len() < FEWEST_PAIRS {
            return Err(degenerate("fewer than four points with normals on one of the surfaces"));
        }
        Ok(())
    }

    /// Finds the nearest points within `distance` whose normals agree, and drops the farthest.
    fn pair(&mut self, problem: &IcpProblem<'_>, pose: &Similarity, distance: f64) -> Result<()> {
        self.pairs.clear();
        for &depth in &self.sources {
            let point = pose.apply(vector(problem.depth_points, depth));
            let normal = pose.rotation * vector(problem.depth_normals, depth);
            let query = [point.x as f32, point.y as f32, point.z as f32];
            let Some(found) = self.neighbours.nearest(query, distance as f32) else { continue };
            let image = found.index as u32;
            if vector(problem.image_normals, image).dot(&normal) > LEAST_COSINE {
                self.pairs.push(Pair { depth, image, distance: found.distance });
            }
        }
        if self.pairs.len() < FEWEST_PAIRS {
            return Err(degenerate("fewer than four pairs").value(self.pairs.len() as f64));
        }
        let count = self.pairs.len();
        let kept = ((KEPT_SHARE * count as f64).ceil() as usize).clamp(FEWEST_PAIRS, count);
        self.distances.clear();
        self.distances.extend(self.pairs.iter().map(|pair| pair.distance));
        let farthest = quantile(&mut self.distances, (kept - 1) as f64 / (count - 1) as f64);
        self.pairs.retain(|pair| pair.distance <= farthest);
        Ok(())
    }

    /// One Gauss-Newton step over the pairs.
    fn step(
        &mut self,
        problem: &IcpProblem<'_>,
        pose: &Similarity,
        options: &IcpOptions,
        point_weight: f64,
    ) -> Result<Increment> {
        let scale = self.robust_scale(problem, pose, options);
        let (centre, length) = self.frame(problem, pose);
        let mut equations = NormalEquations::new(centre, length);
        for pair in &self.pairs {
            let Match { point, difference, normal, .. } = Match::new(problem, pose, pair);
            let residual = residual(options.metric, &difference, &normal);
            let weight = robust::weight_of_square((residual / scale).powi(2));
            if options.metric == Metric::PointToPlane {
                equations.add(&point, &normal, residual, weight);
            }
            if point_weight > 0.0 {
                for axis in [Vector3::x(), Vector3::y(), Vector3::z()] {
                    equations.add(&point, &axis, difference.dot(&axis), weight * point_weight);
                }
            }
        }
        equations.solve(DAMPING, options.scale_is_held).ok_or_else(|| degenerate("the pairs do not determine a step"))
    }

    /// Scale of the robust function.
    fn robust_scale(&mut self, problem: &IcpProblem<'_>, pose: &Similarity, options: &IcpOptions) -> f64 {
        self.distances.clear();
        self.distances.extend(self.pairs.iter().map(|pair| {
            let found = Match::new(problem, pose, pair);
            residual(options.metric, &found.difference, &found.normal).abs() as f32
        }));
        let median = quantile(&mut self.distances, 0.5);
        (robust::SCALE_IN_SIGMAS * robust::SIGMA_OF_MEDIAN * f64::from(median))
            .max(LEAST_SCALE * options.final_distance)
    }

    /// Centroid of the transformed points of the pairs, and their root mean square distance from it.
    fn frame(&self, problem: &IcpProblem<'_>, pose: &Similarity) -> (Vector3<f64>, f64) {
        let (centre, length) =
            extent(self.pairs.iter().map(|pair| pose.apply(vector(problem.depth_points, pair.depth))));
        // Equal points have no extent. Any length keeps the equations finite, and they contain no information.
        (centre, if length > 0.0 { length } else { 1.0 })
    }

    /// Root mean square of the point-to-plane distances, and their information about the pose.
    fn information(&mut self, problem: &IcpProblem<'_>, pose: &Similarity, options: &IcpOptions) -> (f64, Information) {
        let options = IcpOptions { metric: Metric::PointToPlane, ..*options };
        let scale = self.robust_scale(problem, pose, &options);
        let (centre, length) = self.frame(problem, pose);
        let equations = NormalEquations::new(centre, length);
        let (mut matrix, mut weights, mut squares, mut noise) = (PoseMatrix::zeros(), 0.0, 0.0, 0.0);
        let (mut before, mut products) = (0.0, 0.0);
        for pair in &self.pairs {
            let Match { point, difference, normal, depth_normal } = Match::new(problem, pose, pair);
            let residual = difference.dot(&normal);
            let weight = robust::weight_of_square((residual / scale).powi(2));
            let (row, other) = (equations.row(&point, &normal), equations.row(&point, &depth_normal));
            matrix.ger(0.5 * weight, &row, &other, 1.0);
            matrix.ger(0.5 * weight, &other, &row, 1.0);
            weights += weight;
            squares += weight * residual * residual;
            products += before * weight.sqrt() * residual;
            before = weight.sqrt() * residual;
            noise += weight * (normal - depth_normal).norm_squared();
        }
        if options.scale_is_held {
            clear_unknowns(&mut matrix, &std::array::from_fn(|k| k == SCALE));
        }
        let information = Information {
            matrix,
            weight: weights,
            centre,
            length,
            normal_noise: (noise / weights).sqrt(),
            pairs: self.pairs.len(),
            independent: independent_share(products / squares),
            scale_is_held: options.scale_is_held,
        };
        ((squares / weights).sqrt(), information)
    }
}

/// One pair under a pose, colour view's frame.
struct Match {
    /// The transformed depth point.
    point: Vector3<f64>,
    /// Vector from the depth point to the image point.
    difference: Vector3<f64>,
    /// Normal of the image surface.
    normal: Vector3<f64>,
    /// Rotated normal of the depth view.
    depth_normal: Vector3<f64>,
}

impl Match {
    fn new(problem: &IcpProblem<'_>, pose: &Similarity, pair: &Pair) -> Self {
        let point = pose.apply(vector(problem.depth_points, pair.depth));
        Self {
            point,
            difference: vector(problem.image_points, pair.image) - point,
            normal: vector(problem.image_normals, pair.image),
            depth_normal: pose.rotation * vector(problem.depth_normals, pair.depth),
        }
    }
}

fn residual(metric: Metric, difference: &Vector3<f64>, normal: &Vector3<f64>) -> f64 {
    match metric {
        Metric::PointToPoint => difference.norm(),
        Metric::PointToPlane => difference.dot(normal),
    }
}

/// Share of samples on a plane that are independent if neighbours correlate by `correlation`: ((1-r)/(1+r))^2, for a
/// first-order autoregression along either axis.
fn independent_share(correlation: f64) -> f64 {
    // Residuals that are all zero have no correlation. Negative correlations would overstate the information.
    let correlation = if correlation.is_nan() { 0.0 } else { correlation.clamp(0.0, LARGEST_CORRELATION) };
    ((1.0 - correlation) / (1.0 + correlation)).powi(2)
}

/// The pairing distance on its way from first to last.
struct Distances {
    first: f64,
    present: f64,
    last: f64,
}

impl Distances {
    fn new(options: &IcpOptions, object_size: f64) -> Self {
        let last = options.final_distance;
        let first = options.first_distance.unwrap_or(object_size).max(last);
        Self { first, present: first, last }
    }

    fn shrink(&mut self) {
        self.present = (SHRINKING * self.present).max(self.last);
    }

    /// One at the first distance, zero at the last, linear in the logarithm.
    fn share(&self) -> f64 {
        if self.present <= self.last { 0.0 } else { (self.present / self.last).ln() / (self.first / self.last).ln() }
    }
}

fn vector(points: &Points, index: u32) -> Vector3<f64> {
    points.get(index as usize).map(f64::from).into()
}

/// Whether a point lacks one of its four neighbours.
fn is_border(points: &Points, size: Size, index: usize) -> bool {
    let (column, row) = size.position(index);
    if column == 0 || row == 0 || column + 1 == size.width || row + 1 == size.height {
        return true;
    }
    [index - 1, index + 1, index - size.width, index + size.width].into_iter().any(|near| !points.is_valid(near))
}

fn check(problem: &IcpProblem<'_>, options: &IcpOptions) -> Result<()> {
    let same = |points: &Points, normals: &Normals, length: usize| {
        [points.x.len(), points.y.len(), points.z.len(), normals.x.len(), normals.y.len(), normals.z.len()]
            == [length; 6]
    };
    if !same(problem.depth_points, problem.depth_normals, problem.depth_points.len()) {
        return Err(Error::new(ErrorKind::Size, "depth", "must have as many normals as points"));
    }
    if !same(problem.image_points, problem.image_normals, problem.image_size.len()) {
        return Err(Error::new(ErrorKind::Size, "image", "must have a point and a normal for each pixel"));
    }
    problem.start.validate("start")?;
    positive("options.finalDistance", options.final_distance)?;
    options.first_distance.map_or(Ok(()), |distance| positive("options.firstDistance", distance))
}

fn degenerate(message: &'static str) -> Error {
    Error::new(ErrorKind::Degenerate, "registration", message)
}
