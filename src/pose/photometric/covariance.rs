//! Covariance of the pose: the [sandwich](crate::pose::sandwich) over tiles of the depth map
//! (docs/method/uncertainty.md).
//!
//! M is the matrix of the pose's equations with the light eliminated, and the score of a tile is that of the same
//! equations. The [jackknife](super::jackknife) adds the errors that correlate over more than a tile.
//!
//! Noise contributes to M itself: gradients of a noisy image are noisy as well, and squared noise looks like
//! information. On a sphere, whose colours carry no information about its rotation, M amounts to F = sum w s^2 k D^T D
//! with the noise s of the image, D = d pixel / d unknowns, and the covariance k of the two gradients of white noise.
//! The eigenvalues lambda of M over F therefore measure the information of the colours: they are 1 for pure noise, and
//! 12 to 900 on the built-in surfaces. Sigmas grow by lambda / (lambda - 1) along each eigenvector.

use super::equations::{ReducedSystem, SquareSums, add_product, folded, no_sums, scaled};
use super::evaluation::Evaluation;
use crate::diagnosis::share_of_model;
use crate::numeric::eigen::{Eigen, symmetric_eigen};
use crate::numeric::{Doubles, Real, dot};
use crate::pose::increment::{Frame, PoseMatrix, PoseVector, fix_unknowns, inverse, product};
use crate::pose::sandwich::{Scores, student_growth};
use crate::view::Size;

/// Side of the tiles of the depth map whose scores count as one observation, pixels: twice the reach of normals and
/// splines.
const TILE: usize = 8;
/// Factor on the sigma from tiles where the residuals are model errors instead of noise; set on photographs under one
/// lamp (docs/lab/thresholds.md).
const MODEL_SIGMA_INFLATION: f64 = 2.0;
/// k, the covariance of two gradients of white noise with variance one: that of the image's spline and that of the
/// slightly blurred image's spline. It is the mean over the positions in a cell, by quadrature over both splines'
/// responses to one pixel.
const GRADIENT_COVARIANCE: f64 = 0.144;
/// Smallest lambda - 1, at which a sigma grows a thousandfold and its unknown counts as undetermined. On a ball, lambda
/// is 0.85 to 1.15 by chance.
const LEAST_SIGNAL: f64 = 1e-3;
/// Standard deviations per channel, log units.
#[derive(Clone, Copy)]
pub(super) struct Noise {
    /// Standard deviation of the residuals at the present pose.
    pub residuals: f64,
    /// Standard deviation of the image noise, regardless of the pose.
    pub image: f64,
}

impl Noise {
    /// Factor on sigmas for residuals above the noise of the image.
    fn sigma_inflation(&self) -> f64 {
        let of_model = share_of_model(self.residuals, self.image);
        (1.0 + (MODEL_SIGMA_INFLATION * MODEL_SIGMA_INFLATION - 1.0) * of_model).sqrt()
    }
}

/// Sums over the points of a tile.
#[derive(Clone, Copy, Default)]
struct Tile {
    score: PoseVector,
    /// Sums of the weighted residuals of the three channels and of the weights.
    shared: [f64; 4],
}

/// The tiles of a depth map; owns its memory.
#[derive(Default)]
pub(super) struct Tiles {
    tiles: Vec<Tile>,
    /// Log units, see [`Tiles::spatial_covariance`].
    spatial_covariance: f64,
}

impl Tiles {
    /// Allocates the tiles of a depth map.
    pub fn new(depth: Size) -> Self {
        let count = depth.width.div_ceil(TILE) * depth.height.div_ceil(TILE);
        Self { tiles: vec![Tile::default(); count], spatial_covariance: 0.0 }
    }

    /// Covariance of the pose's unknowns; held ones have none.
    pub fn covariance(
        &mut self,
        evaluation: &Evaluation<'_>,
        frame: &Frame,
        reduced: &ReducedSystem,
        noise: Noise,
    ) -> PoseMatrix {
        let mut noise_information = folded(&self.sum_scores(evaluation, frame, reduced, noise));
        let scores = Scores::of(self.tiles.iter().map(|tile| &tile.score));
        let held = evaluation.problem.held();
        let mut matrix = reduced.matrix;
        fix_unknowns(&mut matrix, &held);
        fix_unknowns(&mut noise_information, &held);
        let gain = inverse(&matrix)
            .zip(sigma_growth(&matrix, &noise_information))
            .map(|(inverse, growth)| product(&growth, &inverse));
        let growth = scores.degrees_of_freedom(&held).map_or(1.0, student_growth);
        scores.covariance(gain.as_ref(), noise.sigma_inflation() * growth, &held)
    }

    /// Spatial covariance: root of the mean covariance of residuals within tiles from the last sums, log units. Errors of
    /// the model extend over neighbours, white noise does not.
    pub const fn spatial_covariance(&self) -> f64 {
        self.spatial_covariance
    }

    /// Sums the scores and residuals of each tile. Returns F.
    fn sum_scores(
        &mut self,
        evaluation: &Evaluation<'_>,
        frame: &Frame,
        reduced: &ReducedSystem,
        noise: Noise,
    ) -> SquareSums {
        // For three channels.
        let gradient_variance = 3.0 * GRADIENT_COVARIANCE * noise.image.powi(2);
        let mut noise_information = no_sums();
        let size = evaluation.problem.depth_size;
        let across = size.width.div_ceil(TILE);
        self.tiles.fill(Tile::default());
        // Products of the residuals, and of the weights, of each point with itself, which are not pairs.
        let mut own = [Doubles::splat(0.0); 2];
        evaluation.for_each_linearised(frame, |indices, points, weight| {
            let score = scaled(&reduced.score(points), weight).map(Doubles::array);
            let residual = points.residual.map(|residual| weight * residual);
            own = [own[0] + dot(residual, residual), own[1] + weight * weight];
            let shared = [residual[0], residual[1], residual[2], weight].map(Doubles::array);
            for (lane, &index) in indices.iter().enumerate() {
                let (column, row) = size.position(index as usize);
                let tile = &mut self.tiles[row / TILE * across + column / TILE];
                tile.score += PoseVector::from(score.map(|score| score[lane]));
                tile.shared.iter_mut().zip(&shared).for_each(|(sum, numbers)| *sum += numbers[lane]);
            }
            for row in &points.pixel_derivatives {
                let row_variance = scaled(row, weight * Doubles::splat(gradient_variance));
                add_product(&mut noise_information, &row_variance, row);
            }
        });
        let [mut residuals, mut weights] = own.map(|own| -own.sum());
        for Tile { shared: [red, green, blue, weight], .. } in &self.tiles {
            residuals += red * red + green * green + blue * blue;
            weights += weight * weight;
        }
        // The quotient is 0 / 0 if no tile has a pair.
        self.spatial_covariance = (residuals / (3.0 * weights)).max(0.0).sqrt();
        noise_information
    }
}

/// The map of steps that stretches each eigenvector of `matrix` over `noise_information` by lambda / (lambda - 1);
/// `None` if the points do not move in every direction.
fn sigma_growth(matrix: &PoseMatrix, noise_information: &PoseMatrix) -> Option<PoseMatrix> {
    let root = noise_information.cholesky()?.l();
    let inverse = inverse(&root)?;
    let symmetric = 0.5 * (matrix + matrix.transpose());
    let whitened = product(&product(&inverse, &symmetric), &inverse.transpose());
    let Eigen { eigenvalues: values, eigenvectors: vectors } = symmetric_eigen(&whitened)?;
    let mut along = product(&root, &vectors).transpose();
    for (mut row, value) in along.row_iter_mut().zip(&values) {
        row *= value.max(1.0) / (value - 1.0).max(LEAST_SIGNAL);
    }
    Some(product(&product(&inverse.transpose(), &vectors), &along))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::noise;
    use crate::pose::photometric::solver::INSTRUMENT_BLUR;
    use crate::pose::spline_image::SplineImage;
    use crate::view::{ColourImage, ColourSamples, ColourView};

    #[test]
    fn sigmas_grow_with_model_errors() {
        let inflation = |residuals| Noise { residuals, image: 0.01 }.sigma_inflation();
        assert_eq!(inflation(0.02), 1.0);
        assert!((inflation(1e9) / MODEL_SIGMA_INFLATION - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_gradients_of_white_noise_vary_together_by_the_constant() {
        let side = 96;
        let mut dice = noise::white_noise(3);
        let samples = ColourSamples::RgbLinear((0..3 * side * side).map(|_| dice().exp() as f32).collect());
        let image = ColourImage { width: side, height: side, samples, transfer: None, mask: None, camera: None };
        let view = ColourView::new(image).unwrap();
        let [sharp, blurred] = [0.0, INSTRUMENT_BLUR].map(|blur| SplineImage::new(&view, blur));
        let (mut sum, mut count) = (0.0, 0.0);
        for row in 8..side - 8 {
            for column in 8..side - 8 {
                // All positions within a cell, one after the other.
                let within = [0.618 * row as f64, 0.755 * column as f64].map(f64::fract);
                let place = [column as f64 + within[0], row as f64 + within[1]];
                let [first, second] = [&sharp, &blurred].map(|image| image.at(place).unwrap().gradient);
                for (a, b) in first.as_flattened().iter().zip(second.as_flattened()) {
                    sum += a * b;
                    count += 1.0;
                }
            }
        }
        assert!((sum / count / GRADIENT_COVARIANCE - 1.0).abs() < 0.06, "{}", sum / count);
    }
}
