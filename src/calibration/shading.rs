//! Shading: log colours within a patch follow the harmonics of the normal up to degree 2 (Eq. 3).
//!
//! Under light of order 2, log S is a quadratic of the normal, whatever the pose; the light is unknown and fitted. Albedo
//! and shadow are assumed constant on a patch, so the means over patches are removed from colours and harmonics alike.
//! The log likelihood is that of residuals with Cauchy's density, whose scale is measured at the first pose at which the
//! cue is evaluated. Limit: texture within a patch acts as noise.

use nalgebra::{SMatrix, SVector, Vector3};

use super::patches::{PATCHES, Patches};

/// Number of harmonics of degrees 1 and 2; that of degree 0 is the mean of a patch.
const HARMONICS: usize = 8;
type Harmonics = SVector<f64, HARMONICS>;
type Squares = SMatrix<f64, HARMONICS, HARMONICS>;

/// Number that is added to intensities before the logarithm, the noise of a dark pixel of 8 bits.
const DARKEST: f32 = 0.02;
/// Ridge of the fit of the light, as a share of its mean term, because a few planes do not determine the light.
const RIDGE: f64 = 1e-3;
/// Least scale of the residuals, log units. The scale is their median, as for Cauchy's density.
const LEAST_SCALE: f64 = 0.005;

/// The cue over the patches of one frame.
pub(super) struct Shading<'a> {
    patches: &'a Patches,
    harmonics: Vec<Harmonics>,
    /// Sum of the squares of all harmonics.
    squares: Squares,
    scale: f64,
}

impl<'a> Shading<'a> {
    /// `colours` are those of the first pose.
    pub fn new(patches: &'a Patches, colours: &[[f32; 3]]) -> Self {
        let mut harmonics: Vec<Harmonics> = patches.normals.iter().map(basis).collect();
        remove_means(&patches.patches, &mut harmonics);
        let mut squares = Squares::zeros();
        harmonics.iter().for_each(|harmonics| add_square(&mut squares, harmonics, 1.0));
        let mut cue = Self { patches, harmonics, squares, scale: 1.0 };
        let residuals = cue.residuals(colours);
        let mut sizes: Vec<f32> = residuals.iter().map(|r| r.norm() as f32).filter(|size| !size.is_nan()).collect();
        if !sizes.is_empty() {
            cue.scale = f64::from(crate::numeric::quantile(&mut sizes, 0.5)).max(LEAST_SCALE);
        }
        cue
    }

    /// Adds the log likelihood of the samples' colours, tile by tile.
    pub fn evaluate(&self, colours: &[[f32; 3]], out: &mut [f64]) {
        let scale = 1.0 / (self.scale * self.scale);
        for (residual, &tile) in self.residuals(colours).iter().zip(&self.patches.tiles) {
            let square = residual.norm_squared() * scale;
            // A point off the image counts like the median, so that a pose gains nothing by losing points.
            out[tile as usize] -= (1.0 + if square.is_nan() { 1.0 } else { square }).ln();
        }
    }

    /// Log colours less the means of their patches and the fitted light; NaN where there is no colour.
    fn residuals(&self, colours: &[[f32; 3]]) -> Vec<Vector3<f64>> {
        let log = |colour: &[f32; 3]| Vector3::from(colour.map(|value| f64::from((value + DARKEST).ln())));
        let mut logs: Vec<Vector3<f64>> = colours.iter().map(log).collect();
        remove_means(&self.patches.patches, &mut logs);
        // Nearly all samples have colours, so those without are subtracted from the sum over all.
        let mut matrix = self.squares;
        let mut sums = SMatrix::<f64, HARMONICS, 3>::zeros();
        for (harmonics, log) in self.harmonics.iter().zip(&logs) {
            if log.x.is_nan() {
                add_square(&mut matrix, harmonics, -1.0);
            } else {
                (0..3).for_each(|k| sums.column_mut(k).axpy(log[k], harmonics, 1.0));
            }
        }
        let ridge = RIDGE * matrix.trace() / HARMONICS as f64 + f64::MIN_POSITIVE;
        (0..HARMONICS).for_each(|k| matrix[(k, k)] += ridge);
        let light = matrix.cholesky().map_or(SMatrix::zeros(), |c| c.solve(&sums));
        for (log, harmonics) in logs.iter_mut().zip(&self.harmonics) {
            (0..3).for_each(|k| log[k] -= light.column(k).dot(harmonics));
        }
        logs
    }
}

/// Adds a vector's square. Only the lower half is filled; the factorisation reads no more.
fn add_square(squares: &mut Squares, harmonics: &Harmonics, weight: f64) {
    for column in 0..HARMONICS {
        (column..HARMONICS).for_each(|row| squares[(row, column)] += weight * harmonics[row] * harmonics[column]);
    }
}

/// Harmonics of a normal. The squares of each degree add to one, so that a rotation of the depth camera's axes rotates their
/// coefficients: the ridge prefers no axis, and the fit does not depend on the axes.
fn basis(n: &Vector3<f64>) -> Harmonics {
    let root = 3.0_f64.sqrt();
    Harmonics::from([
        n.x,
        n.y,
        n.z,
        root * n.x * n.y,
        root * n.x * n.z,
        root * n.y * n.z,
        0.5 * root * (n.x * n.x - n.y * n.y),
        1.5 * n.z * n.z - 0.5,
    ])
}

/// Subtracts from each value the mean over its patch; NaN counts nowhere.
fn remove_means<const N: usize>(patches: &[u8], values: &mut [SVector<f64, N>]) {
    let mut sums = [(SVector::<f64, N>::zeros(), 0.0); PATCHES];
    for (value, &patch) in values.iter().zip(patches).filter(|(value, _)| !value[0].is_nan()) {
        let (sum, count) = &mut sums[patch as usize];
        *sum += value;
        *count += 1.0;
    }
    for (value, &patch) in values.iter_mut().zip(patches) {
        let (sum, count) = &sums[patch as usize];
        *value -= sum / f64::max(*count, 1.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Rotation3;

    /// The fit with a ridge depends on the normals only by the products of their harmonics.
    #[test]
    fn products_of_harmonics_do_not_depend_on_the_axes() {
        let normals = [[0.0, 0.0, -1.0], [0.6, 0.0, -0.8], [-0.2, 0.9, -0.4], [0.5, -0.5, 0.7]].map(Vector3::from);
        let normals = normals.map(|normal| normal.normalize());
        // The axes are swapped, and turned by an arbitrary angle.
        let quarter = std::f64::consts::FRAC_PI_2;
        for turn in [[quarter, 0.0, 0.0], [0.0, quarter, 0.0], [0.3, -1.1, 0.8]] {
            let turn = Rotation3::new(Vector3::from(turn));
            for (one, other) in normals.iter().flat_map(|one| normals.iter().map(move |other| (one, other))) {
                let off = basis(&(turn * one)).dot(&basis(&(turn * other))) - basis(one).dot(&basis(other));
                assert!(off.abs() < 1e-12, "{one:?} {other:?}: {off}");
            }
        }
    }
}
