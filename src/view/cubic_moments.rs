//! A cubic w(a, b) = sum c_jk a^j b^k, j + k <= 3, fitted to the neighbours of a point by weighted least squares
//! (docs/method/views.md): the sums over the neighbours, and the slopes at the point that follow from them.
//!
//! The products of a cubic's terms are powers up to the sixth, so 28 sums hold the normal equations. Two points are
//! fitted side by side.

use crate::numeric::{Doubles, Real};

/// Coefficients of a cubic in two variables.
const TERMS: usize = 10;
/// Relative damping of the normal equations, above the rounding error of their sums.
const DAMPING: f64 = 1e-9;

/// Number of powers a^j b^k with j + k up to six. The products of two terms of a cubic are among them.
const MOMENTS: usize = 28;

/// Sums over the neighbours: of the weights times a^j b^k, ordered by j + k and then by k, and of those up to the third
/// power times w.
pub struct Moments {
    count: Doubles,
    plain: [Doubles; MOMENTS],
    offset: [Doubles; TERMS],
    square: Doubles,
}

/// Adds products entry by entry in straight-line code, because the compiler does not unroll a loop of this length.
macro_rules! add {
    ($sums:expr, $($place:literal: $value:expr),*) => { $($sums[$place] = $sums[$place] + $value;)* };
}

impl Moments {
    pub fn zero() -> Self {
        let zero = Doubles::splat(0.0);
        Self { count: zero, plain: [zero; MOMENTS], offset: [zero; TERMS], square: zero }
    }

    #[inline(always)]
    pub fn add(&mut self, one: Doubles, weight: Doubles, a: Doubles, b: Doubles, w: Doubles) {
        let (x, y) = (weight * a, weight * b);
        let (xx, xy, yy) = (x * a, x * b, y * b);
        let (xxx, xxy, xyy, yyy) = (xx * a, xx * b, xy * b, yy * b);
        let [x4, x3y, x2y2, xy3, y4] = [xxx * a, xxx * b, xxy * b, xyy * b, yyy * b];
        let [x5, x4y, x3y2, x2y3, xy4, y5] = [x4 * a, x4 * b, x3y * b, x2y2 * b, xy3 * b, y4 * b];
        add!(self.plain, 0: weight, 1: x, 2: y, 3: xx, 4: xy, 5: yy, 6: xxx, 7: xxy, 8: xyy, 9: yyy);
        add!(self.plain, 10: x4, 11: x3y, 12: x2y2, 13: xy3, 14: y4);
        add!(self.plain, 15: x5, 16: x4y, 17: x3y2, 18: x2y3, 19: xy4, 20: y5);
        add!(self.plain, 21: x5 * a, 22: x5 * b, 23: x4y * b, 24: x3y2 * b, 25: x2y3 * b, 26: xy4 * b, 27: y5 * b);
        add!(self.offset, 0: weight * w, 1: x * w, 2: y * w, 3: xx * w, 4: xy * w, 5: yy * w);
        add!(self.offset, 6: xxx * w, 7: xxy * w, 8: xyy * w, 9: yyy * w);
        self.square = self.square + weight * w * w;
        self.count = self.count + one;
    }

    /// Slopes of the cubics at the points along both tangents, and their standard errors under this `noise`. The errors
    /// are NaN if the neighbours do not determine the slopes.
    ///
    /// Eliminates the normal equations with w as a last column. The remainder of w^2 is the residual; the remaining
    /// pivots of the slopes, which come last, are the inverses of their variances.
    #[inline(never)]
    pub fn slopes(&self, noise: f64) -> ([Doubles; 2], Doubles) {
        const A: usize = TERMS - 2;
        const B: usize = TERMS - 1;
        let mut rows = [[Doubles::splat(0.0); TERMS]; TERMS + 1];
        for (i, &[j, k]) in POWERS.iter().enumerate() {
            for (entry, &[other_j, other_k]) in rows[i][..=i].iter_mut().zip(&POWERS) {
                *entry = self.plain[place([j + other_j, k + other_k])];
            }
            rows[i][i] = rows[i][i] * Doubles::splat(1.0 + DAMPING);
            rows[TERMS][i] = self.offset[place([j, k])];
        }
        let (zero, one) = (Doubles::splat(0.0), Doubles::splat(1.0));
        let mut left = self.square;
        let mut good = Doubles::splat(TERMS as f64).less(self.count);
        for k in 0..TERMS {
            let pivot = rows[k][k];
            good = good & zero.less(pivot);
            let inverse = one / pivot;
            for i in k + 1..TERMS {
                let share = rows[i][k] * inverse;
                for j in k + 1..=i {
                    rows[i][j] = rows[i][j] - share * rows[j][k];
                }
                rows[TERMS][i] = rows[TERMS][i] - share * rows[TERMS][k];
            }
            left = left - rows[TERMS][k] * rows[TERMS][k] * inverse;
        }
        let share = rows[B][A] / rows[A][A];
        let along_b = rows[TERMS][B] / rows[B][B];
        let along_a = rows[TERMS][A] / rows[A][A] - share * along_b;
        let variance = one / rows[A][A] + (one + share * share) / rows[B][B];
        // Noise averages out, but a misfit of the cubic does not: its contribution to the error is at least the misfit
        // itself.
        let residual = left.raised_to(0.0) / self.plain[0];
        let noise = residual.min(Doubles::splat(noise * noise));
        let error = (noise * variance + (residual - noise) * variance.raised_to(1.0)).sqrt();
        ([along_a, along_b], good.select(error, Doubles::splat(f64::NAN)))
    }
}

/// The terms of a cubic as powers of a and b, with the slopes last.
const POWERS: [[usize; 2]; TERMS] = [[0, 0], [2, 0], [1, 1], [0, 2], [3, 0], [2, 1], [1, 2], [0, 3], [1, 0], [0, 1]];

/// Index of the sum of a^j b^k.
const fn place([j, k]: [usize; 2]) -> usize {
    (j + k) * (j + k + 1) / 2 + k
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The slopes along a and b, and their error, of a cubic through `w` on a grid of 2 `reach` + 1 points a side, with
    /// weights that fall off outwards.
    fn fitted(reach: i32, noise: f64, w: impl Fn(f64, f64) -> f64) -> ([f64; 2], f64) {
        let mut moments = Moments::zero();
        for (row, column) in (-reach..=reach).flat_map(|row| (-reach..=reach).map(move |column| (row, column))) {
            let (a, b) = (f64::from(column), f64::from(row));
            let weight = (-0.1 * (a * a + b * b)).exp();
            let [one, weight, a, b, w] = [1.0, weight, a, b, w(a, b)].map(Doubles::splat);
            moments.add(one, weight, a, b, w);
        }
        let (slopes, error) = moments.slopes(noise);
        (slopes.map(|slope| slope.array()[0]), error.array()[0])
    }

    #[test]
    fn a_cubic_gives_its_own_slopes_without_an_error() {
        let cubic =
            |a: f64, b: f64| 0.4 + 0.3 * a - 0.2 * b + 0.05 * a * b - 0.1 * b * b + 0.02 * a.powi(3) - a * b * b;
        let ([along_a, along_b], error) = fitted(2, 0.1, cubic);
        assert!((along_a - 0.3).abs() < 1e-6 && (along_b + 0.2).abs() < 1e-6, "{along_a} {along_b}");
        assert!(error < 1e-3, "{error}");
    }

    /// Residuals beyond the noise are a misfit, which does not average out.
    #[test]
    fn a_misfit_counts_more_than_noise() {
        let ripple = |a: f64, b: f64| 0.1 * (2.0 * a + 3.0 * b).sin();
        let (_, as_noise) = fitted(3, 1.0, ripple);
        let (_, as_misfit) = fitted(3, 0.0, ripple);
        assert!(0.0 < as_noise && as_noise < as_misfit, "{as_noise} {as_misfit}");
    }

    #[test]
    fn too_few_neighbours_determine_nothing() {
        let (_, error) = fitted(1, 0.1, |a, _| a);
        assert!(error.is_nan());
    }
}
