//! Consensus of correspondences over the linear model of Eq. 14, an affine map P -> A P + t with twelve parameters
//! theta (docs/method/surfaces.md).
//!
//! Four pairs determine theta. Least squares on its inliers refines the sample with the lowest objective, sum
//! min(|r|^2, threshold^2). Eq. 15 refuses an A that is near no similarity. A similarity is then fitted to the inliers of A, and fitted
//! again to its own inliers until they no longer change. Scale and rotation of Eq. 15 are not used.
//!
//! The linear model shears and stretches, so on nearly flat parts it follows noise where a similarity would not. It
//! therefore only selects the pairs to which the similarity is first fitted.

use nalgebra::{Matrix3, Vector3};

use super::similarity::{FEWEST_PAIRS, Similarity};
use crate::check::positive;
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::eigen::symmetric_eigen;
use crate::numeric::random::Random;

/// Number of pairs that determine the twelve parameters.
const SAMPLE: usize = 4;
/// Sampling ends when the probability of having missed a sample without outliers falls below this.
const MISSED: f64 = 1e-3;
/// A sample is flat, and skipped, if its volume over the product of its three edges is below this. A ratio of 0.01
/// amplifies noise at most a hundredfold.
const LEAST_VOLUME: f64 = 1e-2;
/// Ratio of the smallest to the largest variance of points below which they are flat, a relief of 1 %. One column of A
/// is then not determined.
const LEAST_THICKNESS: f64 = 1e-4;
/// Maximum number of alternations of least squares and new inliers; two or three suffice.
const MOST_REFITS: usize = 10;

/// Options of the sampling.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RansacOptions {
    /// A pair within this distance is an inlier, units of the colour view.
    pub threshold: f64,
    /// Scale to hold; `None` leaves it free.
    pub scale: Option<f64>,
    /// Maximum number of samples.
    pub most_iterations: u32,
    /// Equal seeds give equal results.
    pub seed: u64,
}

impl Default for RansacOptions {
    fn default() -> Self {
        // Even if 70 % of the pairs are outliers, 1000 samples contain one without outliers with probability 0.9997
        // (0.3^4 = 0.0081).
        Self { threshold: 1.0, scale: None, most_iterations: 1000, seed: 1 }
    }
}

/// The consensus.
#[derive(Clone, Debug, PartialEq)]
pub struct RansacReport {
    /// The similarity fitted to its own inliers.
    pub pose: Similarity,
    /// A of Eq. 14, fitted to the inliers of the linear model; [`Similarity::nearest`] extracts scale and rotation from it.
    pub matrix: Matrix3<f64>,
    /// Indices of the pairs within the threshold of the similarity, ascending.
    pub inliers: Vec<u32>,
    /// Samples drawn.
    pub iterations: u32,
}

/// The linear model of Eq. 14.
#[derive(Clone, Copy)]
struct AffineModel {
    matrix: Matrix3<f64>,
    translation: Vector3<f64>,
}

/// Points of both views side by side.
struct Pairs<'a> {
    depth: &'a [Vector3<f64>],
    image: &'a [Vector3<f64>],
    /// Squared distance below which a pair is an inlier.
    threshold: f64,
}

impl Pairs<'_> {
    /// Indices of the inliers of a model.
    fn inliers(&self, model: impl Fn(&Vector3<f64>) -> Vector3<f64>) -> Vec<u32> {
        let residual = |k: usize| self.image[k] - model(&self.depth[k]);
        let is_inlier = |&k: &u32| residual(k as usize).norm_squared() < self.threshold;
        (0..self.depth.len() as u32).filter(is_inlier).collect()
    }
}

/// The pose on which most of the pairs `depth[i]`, `image[i]` agree. Units: those of the two views.
///
/// # Errors
/// [`ErrorKind::Size`] if lengths differ, [`ErrorKind::Range`] if a point or the threshold is invalid,
/// [`ErrorKind::Degenerate`] for fewer than four pairs, for points on a plane or line, and if no four pairs agree.
pub fn ransac(depth: &[Vector3<f64>], image: &[Vector3<f64>], options: &RansacOptions) -> Result<RansacReport> {
    check(depth, image, options)?;
    let pairs = Pairs { depth, image, threshold: options.threshold * options.threshold };
    let (affine, iterations) = best_of_samples(&pairs, options)?;
    let (affine, inliers) = refine_affine(affine, &pairs)?;
    let (pose, inliers) = refine_similarity(&affine, inliers, &pairs, options.scale)?;
    Ok(RansacReport { pose, matrix: affine.matrix, inliers, iterations })
}

/// The model of the best sample, and the number of samples drawn.
fn best_of_samples(pairs: &Pairs<'_>, options: &RansacOptions) -> Result<(AffineModel, u32)> {
    let Pairs { depth, image, threshold } = *pairs;
    let mut generator = Random::new(options.seed, 0);
    let mut best: Option<(f64, AffineModel)> = None;
    let (mut iterations, mut needed) = (0, options.most_iterations.max(1));
    while iterations < needed {
        iterations += 1;
        let sample = draw(&mut generator, depth.len() as u32);
        let Some(affine) = AffineModel::through(sample.map(|k| depth[k]), sample.map(|k| image[k])) else { continue };
        let (mut objective, mut count) = (0.0, 0_u32);
        for (p, q) in depth.iter().zip(image) {
            let squared = (q - affine.apply(p)).norm_squared();
            objective += squared.min(threshold);
            count += u32::from(squared < threshold);
        }
        if best.as_ref().is_none_or(|(least, _)| objective < *least) {
            best = Some((objective, affine));
            let share = f64::from(count) / depth.len() as f64;
            needed = needed.min(samples_needed(share));
        }
    }
    let (_, affine) = best.ok_or_else(|| degenerate("every sample is flat"))?;
    Ok((affine, iterations))
}

impl AffineModel {
    /// The model through four pairs; `None` if the depth points are flat.
    fn through(p: [Vector3<f64>; SAMPLE], q: [Vector3<f64>; SAMPLE]) -> Option<Self> {
        let from = Matrix3::from_columns(&[p[1] - p[0], p[2] - p[0], p[3] - p[0]]);
        let edges: f64 = from.column_iter().map(|edge| edge.norm()).product();
        let volume = from.determinant().abs();
        // This comparison also treats NaN as flat.
        if !matches!(volume.partial_cmp(&(LEAST_VOLUME * edges)), Some(std::cmp::Ordering::Greater)) {
            return None;
        }
        let to = Matrix3::from_columns(&[q[1] - q[0], q[2] - q[0], q[3] - q[0]]);
        let matrix = to * from.try_inverse()?;
        Some(Self { matrix, translation: q[0] - matrix * p[0] })
    }

    /// Least squares of Eq. 14 over the pairs with these indices.
    fn fit(all: &Pairs<'_>, indices: &[u32]) -> Option<Self> {
        let count = indices.len() as f64;
        let pairs = || indices.iter().map(|&index| (all.depth[index as usize], all.image[index as usize]));
        let from = pairs().map(|(p, _)| p).sum::<Vector3<f64>>() / count;
        let to = pairs().map(|(_, q)| q).sum::<Vector3<f64>>() / count;
        let (mut across, mut within) = (Matrix3::zeros(), Matrix3::zeros());
        for (p, q) in pairs() {
            across += (q - to) * (p - from).transpose();
            within += (p - from) * (p - from).transpose();
        }
        if indices.len() < FEWEST_PAIRS || thickness(&within) < LEAST_THICKNESS {
            return None;
        }
        let matrix = across * within.try_inverse()?;
        Some(Self { matrix, translation: to - matrix * from })
    }

    fn apply(&self, point: &Vector3<f64>) -> Vector3<f64> {
        self.matrix * point + self.translation
    }
}

/// Alternates least squares on the inliers with new inliers; ends with a round that loses inliers.
fn refine_affine(mut affine: AffineModel, pairs: &Pairs<'_>) -> Result<(AffineModel, Vec<u32>)> {
    let mut inliers = pairs.inliers(|point| affine.apply(point));
    for _ in 0..MOST_REFITS {
        let Some(refit) = AffineModel::fit(pairs, &inliers) else { break };
        let found = pairs.inliers(|point| refit.apply(point));
        if found.len() < inliers.len() {
            break;
        }
        let settled = found == inliers;
        (affine, inliers) = (refit, found);
        if settled {
            return Ok((affine, inliers));
        }
    }
    if inliers.len() < FEWEST_PAIRS {
        return Err(degenerate("fewer than four pairs agree").value(inliers.len() as f64));
    }
    Ok((affine, inliers))
}

/// The similarity fitted to the inliers of the linear model, then to its own. An error if A is near no similarity (Eq. 15).
fn refine_similarity(
    affine: &AffineModel,
    affine_inliers: Vec<u32>,
    pairs: &Pairs<'_>,
    scale: Option<f64>,
) -> Result<(Similarity, Vec<u32>)> {
    Similarity::nearest(&affine.matrix, affine.translation)?;
    let (mut inliers, mut fits) = (affine_inliers, 0);
    let pose = loop {
        let select = |points: &[Vector3<f64>]| -> Vec<_> { inliers.iter().map(|&k| points[k as usize]).collect() };
        let pose = Similarity::fit(&select(pairs.depth), &select(pairs.image), None, scale)?;
        let found = pairs.inliers(|point| pose.apply(*point));
        fits += 1;
        let ends = found == inliers || fits == MOST_REFITS;
        inliers = found;
        if ends {
            break pose;
        }
    };
    if inliers.len() < FEWEST_PAIRS {
        return Err(degenerate("fewer than four pairs agree on a similarity").value(inliers.len() as f64));
    }
    Ok((pose, inliers))
}

/// Draws four different numbers below `count`, which is at least four.
fn draw(generator: &mut Random, count: u32) -> [usize; SAMPLE] {
    let mut sample = [0; SAMPLE];
    for k in 0..SAMPLE {
        // Draw among the numbers not yet taken: skip past those taken, which are in ascending order.
        let mut number = generator.word() % (count - k as u32);
        let mut place = 0;
        while place < k && number >= sample[place] {
            number += 1;
            place += 1;
        }
        sample.copy_within(place..k, place + 1);
        sample[place] = number;
    }
    sample.map(|number| number as usize)
}

/// Number of samples to draw, so that with probability 1 - [`MISSED`] at least one of them has no outliers.
fn samples_needed(share: f64) -> u32 {
    let good = share.powi(SAMPLE as i32);
    // ln_1p keeps the sign of zero, so that a share of zero requires infinitely many samples.
    let needed = MISSED.ln() / (-good).ln_1p();
    (needed.ceil() as u32).max(1)
}

/// Ratio of the smallest to the largest eigenvalue of a covariance.
fn thickness(covariance: &Matrix3<f64>) -> f64 {
    match symmetric_eigen(covariance) {
        Some(eigen) if eigen.eigenvalues.max() > 0.0 => eigen.eigenvalues.min() / eigen.eigenvalues.max(),
        _ => 0.0,
    }
}

fn check(depth: &[Vector3<f64>], image: &[Vector3<f64>], options: &RansacOptions) -> Result<()> {
    positive("options.threshold", options.threshold)?;
    if depth.len() != image.len() || u32::try_from(depth.len()).is_err() {
        return Err(Error::new(ErrorKind::Size, "pairs", "must have the same number of points on both sides"));
    }
    let missing = |point: &Vector3<f64>| !point.iter().all(|value| value.is_finite());
    if let Some(index) = depth.iter().zip(image).position(|(p, q)| missing(p) || missing(q)) {
        return Err(Error::new(ErrorKind::Range, "pairs", "must be finite").at(index));
    }
    if depth.len() < FEWEST_PAIRS {
        return Err(degenerate("fewer than four pairs").value(depth.len() as f64));
    }
    let centre = depth.iter().sum::<Vector3<f64>>() / depth.len() as f64;
    let covariance = depth.iter().map(|point| (point - centre) * (point - centre).transpose()).sum();
    if thickness(&covariance) < LEAST_THICKNESS {
        return Err(degenerate("the points lie in a plane, on a line or at one place"));
    }
    Ok(())
}

fn degenerate(message: &'static str) -> Error {
    Error::new(ErrorKind::Degenerate, "pairs", message)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn samples_are_four_different_numbers() {
        let mut generator = Random::new(3, 0);
        let mut seen = [0; 5];
        for _ in 0..2000 {
            let sample = draw(&mut generator, 5);
            for (k, &number) in sample.iter().enumerate() {
                assert!(number < 5 && !sample[..k].contains(&number));
                seen[number] += 1;
            }
        }
        // Each of five numbers is in four of five samples.
        assert!(seen.iter().all(|&count: &i32| (count - 1600).abs() < 100), "{seen:?}");
    }

    #[test]
    fn a_mirrored_relief_is_refused_although_a_similarity_fits_within_the_threshold() {
        let mut generator = Random::new(5, 0);
        let mut coordinate = |extent: f64| extent * (f64::from(generator.word()) / f64::from(u32::MAX) - 0.5);
        let depth: Vec<_> = (0..50).map(|_| Vector3::new(coordinate(10.0), coordinate(9.0), coordinate(3.0))).collect();
        let mirrored: Vec<_> = depth.iter().map(|point| Vector3::new(point.x, point.y, -point.z)).collect();
        let options = RansacOptions { threshold: 4.0, ..RansacOptions::default() };
        assert_eq!(ransac(&depth, &depth, &options).unwrap().inliers.len(), depth.len());
        assert_eq!(ransac(&depth, &mirrored, &options).unwrap_err().kind(), ErrorKind::Degenerate);
    }

    #[test]
    fn more_outliers_need_more_samples() {
        assert_eq!(samples_needed(1.0), 1);
        assert_eq!(samples_needed(0.5), 108);
        assert_eq!(samples_needed(0.0), u32::MAX);
    }
}
