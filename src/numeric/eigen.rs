//! Eigenvalues and eigenvectors of small symmetric matrices.
//!
//! Method: Jacobi's rotations, sweep by sweep (Golub and Van Loan, Matrix Computations, section 8.5): each makes one pair of
//! entries zero, and small eigenvalues of positive definite matrices come out to as many digits as large ones. One copy
//! serves every size.

use nalgebra::{SMatrix, SVector};

/// Sweeps at most: matrices of ten rows need six to eight, as convergence is quadratic.
const MOST_SWEEPS: usize = 40;

/// Eigenvalues in no order, and their eigenvectors as columns.
pub(crate) struct Eigen<const N: usize> {
    pub values: SVector<f64, N>,
    pub vectors: SMatrix<f64, N, N>,
}

/// `None` where an entry is not finite.
pub(crate) fn symmetric_eigen<const N: usize>(matrix: &SMatrix<f64, N, N>) -> Option<Eigen<N>> {
    let (mut matrix, mut vectors) = (*matrix, SMatrix::<f64, N, N>::identity());
    is_diagonalised(N, matrix.as_mut_slice(), vectors.as_mut_slice())
        .then(|| Eigen { values: matrix.diagonal(), vectors })
}

/// Rotates `matrix`, n columns of n numbers, until it is diagonal, and the columns of `vectors` with it.
#[inline(never)]
fn is_diagonalised(n: usize, matrix: &mut [f64], vectors: &mut [f64]) -> bool {
    let size: f64 = matrix.iter().map(|value| value * value).sum();
    if !size.is_finite() {
        return false;
    }
    for _ in 0..MOST_SWEEPS {
        let mut rest = 0.0;
        for q in 1..n {
            for p in 0..q {
                let off = matrix[q * n + p];
                rest += off * off;
                if off == 0.0 {
                    continue;
                }
                // The smaller of both angles: t = tan, with t^2 + 2 t theta = 1.
                let theta = (matrix[q * n + q] - matrix[p * n + p]) / (2.0 * off);
                let t = 1.0_f64.copysign(theta) / (theta.abs() + (theta * theta + 1.0).sqrt());
                let cosine = 1.0 / (t * t + 1.0).sqrt();
                let turn = [cosine, t * cosine];
                rotate(matrix, turn, [p * n, q * n], 1, n);
                rotate(matrix, turn, [p, q], n, n);
                rotate(vectors, turn, [p * n, q * n], 1, n);
            }
        }
        if rest <= f64::EPSILON * f64::EPSILON * size {
            return true;
        }
    }
    false
}

/// Turns two rows or columns, `count` numbers from each start on at this distance, by an angle of this cosine and sine.
#[inline(never)]
fn rotate(values: &mut [f64], [cosine, sine]: [f64; 2], [p, q]: [usize; 2], distance: usize, count: usize) {
    for k in (0..count).map(|k| k * distance) {
        let [a, b] = [values[p + k], values[q + k]];
        (values[p + k], values[q + k]) = (cosine * a - sine * b, sine * a + cosine * b);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::noise;

    /// Graded over many powers of ten, with equal eigenvalues and with none but zero.
    #[test]
    fn products_with_eigenvectors_are_multiples() {
        let mut random = noise::white_noise(4);
        for sizes in [[1.0; 7], [1e-9, 1e-6, 1e-3, 1.0, 1e3, 1e3, 1e6], [-1.0, 0.0, 0.0, 1.0, 1.0, 2.0, 3.0], [0.0; 7]]
        {
            let turn = SMatrix::<f64, 7, 7>::from_fn(|_, _| random()).qr().q();
            let matrix = turn * SMatrix::from_diagonal(&SVector::from(sizes)) * turn.transpose();
            let matrix = 0.5 * (matrix + matrix.transpose());
            let Eigen { values, vectors } = symmetric_eigen(&matrix).unwrap();
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
