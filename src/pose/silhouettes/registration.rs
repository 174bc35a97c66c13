//! The rounds of a registration from silhouettes.

use nalgebra::{Matrix3, Vector3};

use super::discontinuities::Discontinuities;
use super::edges::{Edge, Edges, LEVELS};
use super::problem::{SilhouetteProblem, SilhouetteReport};
use crate::numeric::eigen::symmetric_eigen;
use crate::numeric::{quantile, robust};
use crate::pose::increment::{
    Frame, PoseMatrix, PoseVector, SCALE, UNKNOWN, UNKNOWNS, clear_unknowns, damped_step, inverse,
};
use crate::pose::silhouette::{OUTSIDE_WEIGHT, SLACK, Silhouette};
use crate::pose::similarity::Similarity;
use crate::pose::sums::Sums;
use crate::pose::uncertainty::{Direction, describe};
use crate::view::extent;

/// Weight of the distance between depth discontinuities and silhouette.
const DISCONTINUITY_WEIGHT: f64 = 1.0;
/// Weight of silhouette pixels without a depth point.
const BARE_WEIGHT: f64 = 0.3;
/// Weight of the distance between depth discontinuities and edges of the image, which may be print (docs/lab/thresholds.md).
const EDGE_WEIGHT: f64 = 0.4;
/// Weight of the prior.
const PRIOR_WEIGHT: f64 = 0.1;
/// One sigma of the edge bias, pixels.
const EDGE_BIAS_SIGMA: f64 = 2.0;
/// Robust scales of the rounds in turn, pixels.
const SCALES: [f64; 4] = [40.0, 14.0, 7.0, 3.5];
/// Number of rounds at each robust scale.
const ROUNDS: usize = 6;
/// Number of steps of a round.
const STEPS: usize = 3;
/// Damping as a share of the diagonal.
const DAMPING: f64 = 1e-3;
/// Maximum number of points that are tested against the mask, and of border pixels and discontinuities.
const MOST_POINTS: usize = 4000;
const MOST_BORDER: usize = 1000;
/// The last robust scale.
const FINEST: f64 = SCALES[SCALES.len() - 1];
/// Length of silhouette, in pixels, whose errors count as one error.
const CORRELATED_LENGTH: f64 = 8.0;
/// Factor by which errors exceed the residuals, because errors of masks, of the sensors' registration and of the edge
/// bias all have the same sign.
const SIGMA_INFLATION: f64 = 3.0;
/// Smallest noise of the discontinuities, pixels.
const LEAST_NOISE: f64 = 0.3;
/// Variance of a rotation, as a share of the prior's, above which the silhouettes do not constrain it.
const UNSEEN: f64 = 0.8;

/// Index of the edge bias, which takes the place of the scale among the unknowns.
const EDGE_BIAS: usize = SCALE;

/// Registers from silhouettes; owns its memory.
pub struct SilhouetteRegistration {
    /// The image's silhouette, if the image has a mask.
    silhouette: Option<Silhouette>,
    edges: Edges,
    /// The edge beside each discontinuity, if there is one.
    matches: Vec<Option<([f64; 2], Edge)>>,
    /// Pixels of the mask next to a pixel off it.
    border: Vec<[f64; 2]>,
    discontinuities: Discontinuities,
    /// Image positions of the depth points.
    pixels: Vec<[f32; 2]>,
    /// Points that are tested against the mask.
    sample: Vec<u32>,
    /// Uncovered border pixels, and the discontinuity nearest to each.
    bare: Vec<([f64; 2], u32)>,
    middle: Vector3<f64>,
    size: f64,
}

impl SilhouetteRegistration {
    pub fn new(problem: &SilhouetteProblem<'_>) -> Self {
        let (image, depth) = (problem.image, problem.depth);
        let object = &image.whole.object;
        let is_masked = object.contains(&false);
        let is_border = |index: usize| object[index] && image.size.neighbours(index).any(|beside| !object[beside]);
        let all: Vec<usize> = (0..image.size.len()).filter(|&index| is_border(index)).collect();
        let every = all.len().div_ceil(MOST_BORDER).max(1);
        let place = |index: usize| {
            let (column, row) = image.size.position(index);
            [column as f64, row as f64]
        };
        let valid: Vec<u32> =
            (0..depth.size.len()).filter(|&index| depth.points.is_valid(index)).map(|index| index as u32).collect();
        let thinned = valid.len().div_ceil(MOST_POINTS).max(1);
        let (middle, size) = extent(depth.points.valid());
        Self {
            silhouette: is_masked.then(|| Silhouette::new(image.size, object)),
            edges: Edges::new(image.size, &image.whole.grey),
            matches: Vec::new(),
            border: all.into_iter().step_by(every).map(place).collect(),
            discontinuities: Discontinuities::new(problem),
            pixels: vec![[f32::NAN; 2]; depth.size.len()],
            sample: valid.into_iter().step_by(thinned).collect(),
            bare: Vec::new(),
            middle,
            size,
        }
    }

    /// Registers from the pose `start`.
    pub fn register(&mut self, problem: &SilhouetteProblem<'_>, start: &Similarity) -> SilhouetteReport {
        let (mut pose, mut bias) = (*start, 0.0);
        for (stage, scale) in SCALES.into_iter().enumerate() {
            for _ in 0..ROUNDS {
                self.freeze(problem, &pose);
                self.match_edges(stage.checked_sub(SCALES.len() - LEVELS.len()), bias);
                for _ in 0..STEPS {
                    let frame = self.frame(&pose);
                    let sums = self.sums(problem, &pose, bias, scale);
                    let Some(step) = damped_step(sums.symmetric(), sums.gradient, DAMPING, &[false; UNKNOWNS]) else {
                        break;
                    };
                    bias += step[EDGE_BIAS];
                    let mut change = step;
                    change[SCALE] = 0.0;
                    pose = frame.change(&change).after(&pose).orthonormal();
                }
            }
        }
        self.report(problem, pose, bias)
    }

    fn frame(&self, pose: &Similarity) -> Frame {
        Frame { centre: pose.apply(self.middle), length: pose.scale * self.size }
    }

    /// Finds the image positions of the points, the discontinuities, and the uncovered border pixels.
    fn freeze(&mut self, problem: &SilhouetteProblem<'_>, pose: &Similarity) {
        let image = problem.image;
        for index in 0..self.pixels.len() {
            let place = if problem.depth.points.is_valid(index) {
                image.camera.project(image.size, pose.apply(problem.point(index)).into())
            } else {
                None
            };
            self.pixels[index] = place.map_or([f32::NAN; 2], |place| place.map(|at| at as f32));
        }
        self.discontinuities.update(problem, pose, &self.pixels);
        self.bare.clear();
        let every = self.discontinuities.found.len().div_ceil(MOST_BORDER).max(1);
        for &place in self.border.iter().filter(|place| !self.discontinuities.covers(**place)) {
            let distance = |index: u32| {
                let [column, row] = self.pixels[index as usize];
                (f64::from(column) - place[0]).powi(2) + (f64::from(row) - place[1]).powi(2)
            };
            let discontinuities =
                self.discontinuities.found.iter().step_by(every).map(|discontinuity| discontinuity.index);
            if let Some(nearest) = discontinuities.min_by(|&a, &b| distance(a).total_cmp(&distance(b))) {
                self.bare.push((place, nearest));
            }
        }
    }

    /// Matches the discontinuities to edges on a level of the image; clears the matches without a level.
    fn match_edges(&mut self, level: Option<usize>, bias: f64) {
        self.matches.clear();
        let Some(level) = level else { return };
        let Self { discontinuities, pixels, edges, matches, .. } = self;
        matches.extend(discontinuities.found.iter().map(|discontinuity| {
            let [column, row] = pixels[discontinuity.index as usize].map(f64::from);
            let place = [column + bias * discontinuity.normal[0], row + bias * discontinuity.normal[1]];
            let edge = edges.nearest(level, place, discontinuity.normal)?;
            let at = [0, 1].map(|axis| place[axis] + edge.offset * discontinuity.normal[axis]);
            Some((at, edge))
        }));
    }

    /// Derivatives of a point's image position by the unknowns.
    fn rows(
        &self,
        problem: &SilhouetteProblem<'_>,
        pose: &Similarity,
        index: usize,
    ) -> Option<([f64; 2], [PoseVector; 2])> {
        let frame = self.frame(pose);
        let point = pose.apply(problem.point(index));
        let (pixel, slopes) = problem.image.camera.project_with_gradient(problem.image.size, point.into())?;
        let row = |slope: [f64; 3]| {
            let mut row = frame.row(&point, &slope.into());
            row[EDGE_BIAS] = 0.0;
            row
        };
        Some((pixel, slopes.map(row)))
    }

    /// Residual of a point against the silhouette.
    fn against_mask(
        &self,
        problem: &SilhouetteProblem<'_>,
        pose: &Similarity,
        bias: f64,
        index: usize,
    ) -> Option<(f64, PoseVector)> {
        let (pixel, [across, down]) = self.rows(problem, pose, index)?;
        let (distance, [right, low]) = self.silhouette.as_ref()?.smoothly_signed_at(pixel);
        let mut row = right * across + low * down;
        row[EDGE_BIAS] = 1.0;
        Some((distance + bias, row))
    }

    fn sums(&self, problem: &SilhouetteProblem<'_>, pose: &Similarity, bias: f64, scale: f64) -> Sums {
        let mut sums = Sums::new();
        let share = OUTSIDE_WEIGHT / self.sample.len().max(1) as f64;
        for &index in &self.sample {
            if let Some((residual, row)) = self.against_mask(problem, pose, bias, index as usize)
                && residual > SLACK
            {
                sums.add(&row, residual - SLACK, share, scale);
            }
        }
        self.add_edges(problem, pose, bias, scale, &mut sums);
        self.add_discontinuities(problem, pose, bias, scale, &mut sums);
        let share = BARE_WEIGHT / self.border.len().max(1) as f64;
        for &(place, index) in &self.bare {
            let Some((pixel, [across, down])) = self.rows(problem, pose, index as usize) else { continue };
            let offset = [pixel[0] - place[0], pixel[1] - place[1]];
            let distance = offset[0].hypot(offset[1]);
            let residual = distance - SLACK - bias;
            if residual > 0.0 {
                let mut row = (offset[0] * across + offset[1] * down) / distance;
                row[EDGE_BIAS] = -1.0;
                sums.add(&row, residual, share, scale);
            }
        }
        self.add_prior(problem, pose, bias, &mut sums);
        sums
    }

    fn add_discontinuities(
        &self,
        problem: &SilhouetteProblem<'_>,
        pose: &Similarity,
        bias: f64,
        scale: f64,
        sums: &mut Sums,
    ) {
        let discontinuities = || self.discontinuities.found.iter().filter(|discontinuity| discontinuity.is_outer);
        let total: f64 = discontinuities().map(|discontinuity| discontinuity.weight).sum();
        for discontinuity in discontinuities() {
            if let Some((residual, row)) = self.against_mask(problem, pose, bias, discontinuity.index as usize) {
                sums.add(&row, residual, DISCONTINUITY_WEIGHT * discontinuity.weight / total, scale);
            }
        }
    }

    fn add_edges(&self, problem: &SilhouetteProblem<'_>, pose: &Similarity, bias: f64, scale: f64, sums: &mut Sums) {
        let total: f64 = self.discontinuities.found.iter().map(|discontinuity| discontinuity.weight).sum();
        for (discontinuity, found) in self.discontinuities.found.iter().zip(&self.matches) {
            if let Some((at, edge)) = found
                && let Some((pixel, [across, down])) = self.rows(problem, pose, discontinuity.index as usize)
            {
                let [right, low] = discontinuity.normal;
                let mut row = right * across + low * down;
                row[EDGE_BIAS] = 1.0;
                let residual = right * (pixel[0] - at[0]) + low * (pixel[1] - at[1]) + bias;
                sums.add(&row, residual, EDGE_WEIGHT * discontinuity.weight * edge.strength / total, scale);
            }
        }
    }

    fn add_prior(&self, problem: &SilhouetteProblem<'_>, pose: &Similarity, bias: f64, sums: &mut Sums) {
        problem.prior.for_each(self.middle, pose, &self.frame(pose), |row, residual| {
            sums.add(row, residual, PRIOR_WEIGHT, f64::INFINITY);
        });
        let mut row = PoseVector::zeros();
        row[EDGE_BIAS] = 1.0 / EDGE_BIAS_SIGMA;
        sums.add(&row, bias / EDGE_BIAS_SIGMA, PRIOR_WEIGHT, f64::INFINITY);
    }

    /// The report on a pose and its edge bias.
    fn report(&mut self, problem: &SilhouetteProblem<'_>, pose: Similarity, bias: f64) -> SilhouetteReport {
        self.freeze(problem, &pose);
        self.match_edges(Some(LEVELS.len() - 1), bias);
        let noise = self.noise(problem, &pose, bias);
        let mut data = Sums::new();
        self.add_discontinuities(problem, &pose, bias, FINEST, &mut data);
        self.add_edges(problem, &pose, bias, FINEST, &mut data);
        let independent = self.discontinuities.found.len() as f64 * self.discontinuities.cell() / CORRELATED_LENGTH;
        let mut information =
            data.matrix * (independent / ((DISCONTINUITY_WEIGHT + EDGE_WEIGHT) * (SIGMA_INFLATION * noise).powi(2)));
        let mut prior = Sums::new();
        self.add_prior(problem, &pose, bias, &mut prior);
        information += prior.matrix / PRIOR_WEIGHT;
        information.fill_upper_triangle_with_lower_triangle();
        let frame = self.frame(&pose);
        let mut covariance = inverse(&information).unwrap_or_else(|| PoseMatrix::identity() * UNKNOWN.powi(2));
        clear_unknowns(&mut covariance, &std::array::from_fn(|k| k == EDGE_BIAS));
        let (weakest, share) = weakest_turn(&covariance, problem.prior.rotation);
        SilhouetteReport {
            uncertainty: describe(&covariance, &frame, &pose, [false, true], weakest),
            unseen: share > UNSEEN,
            cost: self.sums(problem, &pose, bias, FINEST).cost,
            discontinuities: self.discontinuities.found.len(),
            independent,
            pose,
            noise,
        }
    }

    /// The report on a given pose, without an edge bias.
    pub fn judge(&mut self, problem: &SilhouetteProblem<'_>, pose: &Similarity) -> SilhouetteReport {
        self.report(problem, *pose, 0.0)
    }

    /// Robust standard deviation of the discontinuities about silhouette and edges.
    fn noise(&self, problem: &SilhouetteProblem<'_>, pose: &Similarity, bias: f64) -> f64 {
        let discontinuities = self.discontinuities.found.iter().filter(|discontinuity| discontinuity.is_outer);
        let against_mask = discontinuities
            .filter_map(|discontinuity| self.against_mask(problem, pose, bias, discontinuity.index as usize));
        let mut residuals: Vec<f32> = against_mask.map(|(residual, _)| residual.abs() as f32).collect();
        residuals.extend(self.matches.iter().flatten().map(|(_, edge)| edge.offset.abs() as f32));
        if residuals.is_empty() {
            return f64::INFINITY;
        }
        (robust::SIGMA_OF_MEDIAN * f64::from(quantile(&mut residuals, 0.5))).max(LEAST_NOISE)
    }
}

/// The least determined rotation, and its variance as a share of the prior's.
fn weakest_turn(covariance: &PoseMatrix, prior: f64) -> (Direction, f64) {
    let turns: Matrix3<f64> = covariance.fixed_view::<3, 3>(0, 0).into();
    let Some(eigen) = symmetric_eigen(&turns) else {
        return (Direction::default(), 1.0);
    };
    let weakest = eigen.eigenvalues.imax();
    let mut direction = PoseVector::zeros();
    direction.fixed_rows_mut::<3>(0).copy_from(&eigen.eigenvectors.column(weakest));
    (Direction::of(&direction), eigen.eigenvalues[weakest] / (prior * prior))
}
