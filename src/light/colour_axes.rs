//! Colour axes of a light, and the prior over lights along them (docs/method/image-model.md).
//!
//! Shading varies most along one direction of colour, which under white lamps is lightness. With that direction as the
//! first axis, errors of shading fall into the first coordinate, and chromaticity, which distinguishes albedos, into
//! the other two.

use crate::light::Light;
use crate::light::harmonics::{HARMONICS, basis_gradient};
use crate::light::prior::{COEFFICIENTS, CoefficientMatrix, Coefficients, LightPrior};

/// Orthonormal axes of colour (R, G, B); shading varies most along the first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes([[f64; 3]; 3]);

impl Axes {
    /// Axes for white lamps: lightness and two differences of colour.
    pub const WHITE: Self = Self([
        [0.577_350_269_189_625_8, 0.577_350_269_189_625_8, 0.577_350_269_189_625_8],
        [std::f64::consts::FRAC_1_SQRT_2, -std::f64::consts::FRAC_1_SQRT_2, 0.0],
        [0.408_248_290_463_863, 0.408_248_290_463_863, -0.816_496_580_927_726],
    ]);

    /// Axes of which the first is the direction in which the shading of `light` varies most with the normals.
    pub fn of_shading(light: &Light, normals: impl Iterator<Item = [f64; 3]>) -> Self {
        let mut scatter = [[0.0; 3]; 3];
        for normal in normals {
            let gradient = basis_gradient(normal);
            let slopes = light.0.map(|channel| {
                let slope: [f64; 3] =
                    std::array::from_fn(|axis| (0..HARMONICS).map(|k| channel[k] * gradient[k][axis]).sum());
                // Only slopes across the normal count, because a normal stays a unit vector.
                let along: f64 = slope.iter().zip(normal).map(|(s, n)| s * n).sum();
                [0, 1, 2].map(|axis: usize| slope[axis] - along * normal[axis])
            });
            for row in 0..3 {
                for column in 0..3 {
                    scatter[row][column] += slopes[row].iter().zip(&slopes[column]).map(|(a, b)| a * b).sum::<f64>();
                }
            }
        }
        let (first, variance) = principal_axis(&scatter);
        if variance <= 0.0 {
            return Self::WHITE;
        }
        // The second axis is any direction perpendicular to the first. The third completes the frame.
        let least = if first[0].abs() < first[1].abs() { 0 } else { 1 };
        let mut second: [f64; 3] = std::array::from_fn(|c| f64::from(c == least) - first[least] * first[c]);
        let length = second.iter().map(|value| value * value).sum::<f64>().sqrt();
        second = second.map(|value| value / length);
        let third = std::array::from_fn(|c| {
            let (a, b) = ((c + 1) % 3, (c + 2) % 3);
            first[a] * second[b] - first[b] * second[a]
        });
        Self([first, second, third])
    }

    /// The coordinates of (R, G, B) along the axes.
    #[inline(never)]
    pub fn along(&self, rgb: [f64; 3]) -> [f64; 3] {
        self.0.map(|row| row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2])
    }

    /// (R, G, B) from coordinates along the axes.
    #[inline(never)]
    pub fn back(&self, values: [f64; 3]) -> [f64; 3] {
        std::array::from_fn(|channel| (0..3).map(|row| self.0[row][channel] * values[row]).sum())
    }
}

/// The prior over lights, expressed along the axes.
pub struct AxesPrior {
    pub precision: CoefficientMatrix,
    pub target: Coefficients,
    /// Whether the light is known. A known light is subtracted from the colours beforehand, so no light is fitted.
    pub is_known: bool,
    /// lambda_L relative to the mean squared error along the first axis.
    pub weight: f64,
}

impl AxesPrior {
    /// The prior of an unknown light.
    pub fn of(prior: &LightPrior, weight: f64, Axes(axes): &Axes) -> Self {
        let turned = |row: usize, column: usize| -> f64 {
            let (i, j) = (row % HARMONICS, column % HARMONICS);
            let (first, second) = (&axes[row / HARMONICS], &axes[column / HARMONICS]);
            let term =
                |c: usize, d: usize| first[c] * second[d] * prior.precision()[(c * HARMONICS + i, d * HARMONICS + j)];
            (0..9).map(|pair| term(pair / 3, pair % 3)).sum()
        };
        let precision = CoefficientMatrix::from_fn(turned);
        let mean = |row: usize| -> f64 {
            (0..3).map(|c| axes[row / HARMONICS][c] * prior.mean_coefficients()[c * HARMONICS + row % HARMONICS]).sum()
        };
        let target = Coefficients::from_fn(|row, _| {
            (0..COEFFICIENTS).map(|column| precision[(row, column)] * mean(column)).sum()
        });
        Self { precision, target, is_known: false, weight }
    }

    /// The prior of a known light.
    pub fn known() -> Self {
        Self { precision: CoefficientMatrix::identity(), target: Coefficients::zeros(), is_known: true, weight: 1.0 }
    }
}

/// Axis of largest scatter and the scatter along it, by the power method. A few rounds suffice for a direction.
pub fn principal_axis(scatter: &[[f64; 3]; 3]) -> ([f64; 3], f64) {
    let mut axis = [0.5, 0.6, 0.62];
    let mut variance = 0.0;
    for _ in 0..12 {
        let turned = scatter.map(|row| row.iter().zip(axis).map(|(s, a)| s * a).sum::<f64>());
        let length = turned.iter().map(|value| value * value).sum::<f64>().sqrt();
        if length <= 0.0 {
            break;
        }
        axis = turned.map(|value| value / length);
        variance = length;
    }
    (axis, variance)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Directions all over the sphere.
    fn normals() -> impl Iterator<Item = [f64; 3]> {
        let of = |k: f64| {
            let (z, turn) = (k / 10.0 - 1.0, 2.4 * k);
            let across = (1.0 - z * z).sqrt();
            [across * turn.cos(), across * turn.sin(), z]
        };
        (0..20).map(move |k| of(f64::from(k) + 0.5))
    }

    fn reddish() -> Light {
        Light([0.9, 0.4, 0.2].map(|share| std::array::from_fn(|k| share * (k as f64 - 3.5))))
    }

    #[test]
    fn the_first_axis_is_that_of_the_shading_and_all_are_orthonormal() {
        let axes = Axes::of_shading(&reddish(), normals());
        let [red, green, blue] = axes.along([0.9, 0.4, 0.2]);
        assert!(red > 0.0 && green.abs() < 1e-9 && blue.abs() < 1e-9, "{axes:?}");
        for axes in [axes, Axes::WHITE] {
            for rgb in [[1.0, 0.0, 0.0], [0.2, -0.7, 0.4]] {
                let back = axes.back(axes.along(rgb));
                assert!((0..3).all(|c| (back[c] - rgb[c]).abs() < 1e-12), "{back:?}");
            }
        }
    }

    #[test]
    fn without_shading_the_axes_are_those_of_white_lamps() {
        assert_eq!(Axes::of_shading(&Light([[0.0; HARMONICS]; 3]), normals()), Axes::WHITE);
    }

    /// (L - mu)^T P (L - mu) is the same along any axes, up to terms that do not depend on L.
    #[test]
    fn the_prior_is_the_same_along_any_axes() {
        let prior = LightPrior::natural();
        let distance = |axes: &Axes, light: &Light| {
            let AxesPrior { precision, target, .. } = AxesPrior::of(&prior, 1.0, axes);
            let along = |k: usize| axes.along(light.0.map(|channel| channel[k]));
            let turned = Coefficients::from_fn(|row, _| along(row % HARMONICS)[row / HARMONICS]);
            turned.dot(&(precision * turned)) - 2.0 * turned.dot(&target)
        };
        let (own, light) = (Axes::of_shading(&reddish(), normals()), reddish());
        let (first, second) = (distance(&own, &light), distance(&Axes::WHITE, &light));
        assert!((first - second).abs() < 1e-9 * first.abs(), "{first} {second}");
    }
}
