//! How sure a pose is: cov = M^-1 (sum over tiles of g g^T) M^-T.
//!
//! M is the matrix of the equations that the pose solves, g the sum of the scores of a tile of the depth map once the
//! light has followed (Huber's sandwich over clusters). Noise, wrong normals and interpolation enter with the size and
//! the correlation that they have, so nothing is assumed about them but that tiles are independent. What leaves no
//! residual is allowed for by a factor that was measured.
//!
//! M itself is feigned in part: slopes of a noisy image are noise as well, and noise squared passes for information. A
//! ball, whose colours tell nothing of its rotation, has just as much of it as F = sum w s^2 k D^T D with s the noise of
//! the image, D = d pixel / d unknowns and k the covariance of the two slopes of white noise. So the eigenvalues of M
//! over F (one where there is nothing but noise, 12 to 900 on the built-in surfaces) say what the colours tell, and
//! sigmas grow by lambda / (lambda - 1) along each of their directions.

use nalgebra::SymmetricEigen;

use super::equations::{Reduced, add_product, folded, hold, no_sums, scaled};
use super::points::Robust;
use super::problem::{PhotometricProblem, PhotometricReport, PhotometricTermination};
use super::residual::Scene;
use super::{Phase, Photometric};
use crate::error::Result;
use crate::numeric::{Doubles, Real};
use crate::pose::increment::{Frame, Row, Square, UNKNOWNS};
use crate::pose::uncertainty::{describe, in_words};
use crate::view::Size;

/// Side of the tiles of the depth map whose scores count as one observation, pixels: twice the reach of normals and
/// splines.
const TILE: usize = 8;
/// Errors that leave no residual, such as normals that lean all one way, over those that do: measured on 116 random
/// scenes of eight surfaces under natural lights (96x96), where one sigma from the residuals alone holds 44 % and three
/// hold 85 %; at 1.9 three held all axes of 94.6 % of the 298 found poses of `npm run tables`.
const UNSEEN: f64 = 2.1;
/// Residuals so many times larger than the noise of the image itself are errors of the model: shadows, print, a lamp
/// too sharp for nine harmonics. Made scenes leave 0.75 to 1 times that noise, photographs with shadows and paint 0.7
/// to 5 times.
const MODEL_NOISE: f64 = 2.0;
/// One sigma where all residuals are the model's, over what tiles tell: such errors reach across tiles. Photographs in
/// one lamp's light that leave more than twice their noise end 4 to 17 such sigmas off, the others 1 to 3.
const MODEL_SIGMA: f64 = 2.0;
/// k: covariance of the slopes of white noise of variance one, once of the image's spline and once of the slightly
/// blurred one's, mean over the positions in a cell (by quadrature over both splines' responses to one pixel).
const SLOPE_COVARIANCE: f64 = 0.144;
/// Least lambda - 1: chance puts lambda of a ball to 0.85 .. 1.15, and a sigma a thousand times as large is unknown.
const LEAST_SIGNAL: f64 = 1e-3;
/// Sigma of a direction that nothing is known about, radians or object sizes.
const UNKNOWN: f64 = 1e3;
/// Cap on the rounds of the eigenvalue iteration, which ends after about 20.
const MOST_EIGEN_ROUNDS: usize = 500;

/// Number of tiles of a depth map.
pub(super) fn tiles(size: Size) -> usize {
    size.width.div_ceil(TILE) * size.height.div_ceil(TILE)
}

impl Photometric {
    /// What was found so far.
    ///
    /// # Errors
    /// [`ErrorKind::Degenerate`] where the visible points determine nothing.
    pub fn report(&mut self, problem: &PhotometricProblem<'_>) -> Result<PhotometricReport> {
        let frame = self.look(problem, 0, self.most_points)?;
        self.measure(problem, 0);
        self.robust = Robust { scale: self.final_scale(), prior: self.prior(problem) };
        let held = problem.held();
        let reduced = self.reduced(problem, 0, &frame, true)?;
        let covariance = self.covariance(problem, &frame, &reduced);
        let scene = Scene::new(&self.levels[0], None, &problem.image.camera, &self.state.exposed());
        let without_prior = Robust { prior: 0.0, ..self.robust };
        let full = self.robust.scale * self.robust.scale * self.points.weight();
        let mut information = 0.5 * (reduced.matrix + reduced.matrix.transpose()) / (self.noise * self.noise);
        (0..UNKNOWNS).filter(|&k| held[k]).for_each(|k| {
            information.row_mut(k).fill(0.0);
            information.column_mut(k).fill(0.0);
        });
        let weakest = SymmetricEigen::try_new(covariance, f64::EPSILON, MOST_EIGEN_ROUNDS).map_or_else(
            || "unknown".to_owned(),
            |eigen| in_words(&eigen.eigenvectors.column(eigen.eigenvalues.imax()).into_owned()),
        );
        Ok(PhotometricReport {
            pose: self.state.pose,
            light: self.state.light,
            exposure: self.state.exposure,
            cost: self.points.cost(problem, &scene, &self.state, without_prior) / full,
            noise: self.noise,
            visible: self.points.len(),
            sampled: self.points.are_sampled(),
            inliers: self.points.inliers(problem, &scene, &self.state, self.robust),
            iterations: self.iterations,
            termination: match self.phase {
                Phase::Done(termination) => termination,
                _ => PhotometricTermination::MostRounds,
            },
            information,
            covariance,
            uncertainty: describe(&covariance, &frame, &self.state.pose, [held[5], held[6]], weakest),
        })
    }

    /// Factor of one sigma for what the residuals of the tiles do not tell.
    fn unseen(&self) -> f64 {
        let of_image = MODEL_NOISE * self.image_noise / self.noise;
        let of_model = (1.0 - of_image * of_image).max(0.0);
        UNSEEN * (1.0 + (MODEL_SIGMA * MODEL_SIGMA - 1.0) * of_model).sqrt()
    }

    /// M^-1 (sum over tiles of g g^T) M^-T with g the sum of a tile's scores.
    fn covariance(&mut self, problem: &PhotometricProblem<'_>, frame: &Frame, reduced: &Reduced) -> Square {
        let scene = Scene::new(&self.levels[0], Some(&self.slopes), &problem.image.camera, &self.state.exposed());
        let slope_variance = 3.0 * SLOPE_COVARIANCE * self.image_noise.powi(2);
        let mut feigned = no_sums();
        self.tiles.fill(Row::zeros());
        let across = problem.depth.size.width.div_ceil(TILE);
        let tiles = &mut self.tiles;
        self.points.each(problem, &scene, &self.state, self.robust, frame, |indices, point, weight| {
            let score = scaled(&reduced.score(point), weight).map(Doubles::array);
            for (lane, &index) in indices.iter().enumerate() {
                let (column, row) = problem.depth.size.position(index as usize);
                tiles[row / TILE * across + column / TILE] += Row::from(score.map(|score| score[lane]));
            }
            for row in &point.motion {
                add_product(&mut feigned, &scaled(row, weight * Doubles::splat(slope_variance)), row);
            }
        });
        let mut feigned = folded(&feigned);
        let (mut spread, mut count) = (Square::zeros(), 0.0);
        for score in tiles.iter().filter(|score| score.norm() > 0.0) {
            spread.ger(1.0, score, score, 1.0);
            count += 1.0;
        }
        let held = problem.held();
        let free = held.iter().filter(|&&held| !held).count() as f64;
        let mut matrix = reduced.matrix;
        hold(&mut matrix, &held);
        hold(&mut feigned, &held);
        let mut covariance = match matrix.try_inverse().zip(growth(&matrix, &feigned)) {
            // Fewer tiles than unknowns say nothing about the spread.
            Some((inverse, growth)) if count > free => {
                let listening = product(&growth, &inverse);
                product(&product(&listening, &spread), &listening.transpose())
                    * (self.unseen().powi(2) * count / (count - free))
            }
            _ => Square::identity() * UNKNOWN.powi(2),
        };
        if !covariance.norm().is_finite() {
            covariance = Square::identity() * UNKNOWN.powi(2);
        }
        for k in (0..UNKNOWNS).filter(|&k| held[k]) {
            covariance.row_mut(k).fill(0.0);
            covariance.column_mut(k).fill(0.0);
        }
        covariance
    }
}

/// The map of steps that stretches each eigenvector of `matrix` over `feigned` by lambda / (lambda - 1); `None` where
/// the points do not move in every direction.
fn growth(matrix: &Square, feigned: &Square) -> Option<Square> {
    let root = feigned.cholesky()?.l();
    let inverse = root.try_inverse()?;
    let symmetric = 0.5 * (matrix + matrix.transpose());
    let whitened = product(&product(&inverse, &symmetric), &inverse.transpose());
    let SymmetricEigen { eigenvalues, eigenvectors } =
        SymmetricEigen::try_new(whitened, f64::EPSILON, MOST_EIGEN_ROUNDS)?;
    let mut along = product(&root, &eigenvectors).transpose();
    for (mut row, value) in along.row_iter_mut().zip(&eigenvalues) {
        row *= value.max(1.0) / (value - 1.0).max(LEAST_SIGNAL);
    }
    Some(product(&product(&inverse.transpose(), &eigenvectors), &along))
}

/// One copy of a product that would be unrolled wherever it is written: visitors download each.
#[inline(never)]
fn product(left: &Square, right: &Square) -> Square {
    left * right
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::noise;
    use crate::pose::photometric::SLOPE_BLUR;
    use crate::pose::photometric::image::SplineImage;
    use crate::view::{ColourImage, ColourSamples, ColourView};

    #[test]
    fn the_slopes_of_white_noise_vary_together_by_the_constant() {
        let side = 96;
        let mut dice = noise::white_noise(3);
        let samples = ColourSamples::RgbLinear((0..3 * side * side).map(|_| dice().exp() as f32).collect());
        let image = ColourImage { width: side, height: side, samples, transfer: None, mask: None, camera: None };
        let view = ColourView::new(image).unwrap();
        let [sharp, blurred] = [0.0, SLOPE_BLUR].map(|blur| SplineImage::new(&view, blur));
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
        assert!((sum / count / SLOPE_COVARIANCE - 1.0).abs() < 0.06, "{}", sum / count);
    }
}
