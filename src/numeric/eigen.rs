//! Eigenvalues and eigenvectors of small symmetric matrices, by nalgebra.
//!
//! Limits: the error of every eigenvalue is the largest eigenvalue times the rounding of f64.

use nalgebra::allocator::Allocator;
use nalgebra::{Const, DefaultAllocator, DimDiff, DimSub, OMatrix, SymmetricEigen, U1};

/// Maximum number of iterations; a matrix takes two to three for each row.
const MOST_ROUNDS: usize = 200;

/// Eigenvalues in no particular order, and their eigenvectors as columns.
pub(crate) type Eigen<const N: usize> = SymmetricEigen<f64, Const<N>>;

/// The decomposition, or `None` where an entry is not finite.
pub(crate) fn symmetric_eigen<D: DimSub<U1>>(matrix: &OMatrix<f64, D, D>) -> Option<SymmetricEigen<f64, D>>
where
    DefaultAllocator: Allocator<D, D> + Allocator<D> + Allocator<DimDiff<D, U1>>,
{
    // On NaN the iteration would never end.
    let is_finite = matrix.iter().all(|value| value.is_finite());
    is_finite.then(|| SymmetricEigen::try_new(matrix.clone(), f64::EPSILON, MOST_ROUNDS))?
}

#[cfg(test)]
mod tests {
    use nalgebra::{SMatrix, SVector};

    use super::*;
    use crate::numeric::noise;

    /// Matrices graded over many powers of ten, with equal eigenvalues, and with all eigenvalues zero.
    #[test]
    fn products_with_eigenvectors_are_multiples() {
        let mut random = noise::white_noise(4);
        for sizes in [[1.0; 7], [1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e3, 1e6], [-1.0, 0.0, 0.0, 1.0, 1.0, 2.0, 3.0], [0.0; 7]]
        {
            let turn = SMatrix::<f64, 7, 7>::from_fn(|_, _| random()).qr().q();
            let matrix = turn * SMatrix::from_diagonal(&SVector::from(sizes)) * turn.transpose();
            let matrix = 0.5 * (matrix + matrix.transpose());
            let Eigen { eigenvalues: values, eigenvectors: vectors } = symmetric_eigen(&matrix).unwrap();
            let largest = sizes.iter().fold(0.0_f64, |most, size| most.max(size.abs()));
            let apart = matrix * vectors - vectors * SMatrix::from_diagonal(&values);
            assert!(apart.amax() <= 1e-14 * largest, "{sizes:?}: {apart}");
            assert!((vectors.transpose() * vectors - SMatrix::<f64, 7, 7>::identity()).amax() < 1e-14);
            let mut sorted = values;
            sorted.as_mut_slice().sort_by(f64::total_cmp);
            assert!((sorted - SVector::from(sizes)).amax() <= 1e-14 * largest, "{sizes:?}: {sorted}");
        }
    }

    #[test]
    fn what_is_not_finite_has_none() {
        for bad in [f64::NAN, f64::INFINITY] {
            let mut matrix = SMatrix::<f64, 3, 3>::identity();
            (matrix[(0, 1)], matrix[(1, 0)]) = (bad, bad);
            assert!(symmetric_eigen(&matrix).is_none());
            (matrix[(0, 1)], matrix[(1, 0)], matrix[(2, 2)]) = (0.0, 0.0, bad);
            assert!(symmetric_eigen(&matrix).is_none());
        }
    }
}
