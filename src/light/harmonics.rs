//! log S = n^T M n with n = [n_x n_y n_z 1]: second-order spherical harmonics (Eq. 3, 5; docs/method/image-model.md).

use nalgebra::{Matrix3, Vector3};

use crate::error::{Error, ErrorKind, Result};
use crate::numeric::Real;
use crate::text::Brief;

/// Number of harmonics for each channel.
pub const HARMONICS: usize = 9;

/// Largest coefficient of a log light: e^100 is a ratio of intensities that no camera records, and the square of 100 is
/// far from the limits of f32.
const LARGEST_COEFFICIENT: f64 = 100.0;

// The constants of Ramamoorthi and Hanrahan ("An efficient representation for irradiance environment maps", 2001).
const C1: f64 = 0.429_043;
const C2: f64 = 0.511_664;
const C3: f64 = 0.743_125;
const C4: f64 = 0.886_227;
const C5: f64 = 0.247_708;

/// Nine coefficients for each of R, G, B in the colour view's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(into = "Vec<f64>"))]
pub struct Light(pub [[f64; HARMONICS]; 3]);

impl Light {
    /// A light from 27 numbers R1..9, G1..9, B1..9.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] unless there are 27 numbers, [`ErrorKind::Range`] if one is not finite or exceeds 100 in
    /// magnitude.
    pub fn from_slice(field: &'static str, values: &[f64]) -> Result<Self> {
        if values.len() != 3 * HARMONICS {
            return Err(Error::new(ErrorKind::Size, field, format!("a light has 27 numbers, not {}", values.len())));
        }
        let light = Self(std::array::from_fn(|channel| std::array::from_fn(|k| values[channel * HARMONICS + k])));
        light.validate(field)?;
        Ok(light)
    }

    /// # Errors
    /// [`ErrorKind::Range`] with the index of a coefficient that is not finite or larger than that of any real light.
    pub fn validate(&self, field: &'static str) -> Result<()> {
        let flat = self.flat();
        match flat.iter().position(|value| !value.is_finite() || value.abs() > LARGEST_COEFFICIENT) {
            None => Ok(()),
            Some(index) => {
                let message = format!("must be a number from -{0} to {0}", Brief(LARGEST_COEFFICIENT));
                Err(Error::new(ErrorKind::Range, field, message).at(index).value(flat[index]))
            }
        }
    }

    /// R1..9, G1..9, B1..9.
    #[must_use]
    pub fn flat(&self) -> [f64; 3 * HARMONICS] {
        std::array::from_fn(|index| self.0[index / HARMONICS][index % HARMONICS])
    }

    /// The same light at another exposure: log S grows by `offset` everywhere.
    #[must_use]
    pub fn exposed(self, offset: f64) -> Self {
        self.tinted([offset; 3])
    }

    /// The same light in another colour: log S of R, G and B grows by the `offsets` everywhere.
    #[must_use]
    pub fn tinted(mut self, offsets: [f64; 3]) -> Self {
        for (channel, offset) in self.0.iter_mut().zip(offsets) {
            channel[0] += offset / C4;
        }
        self
    }

    /// The light after a rotation of its lamps, under which a rotated normal has the colour that the normal has under
    /// this light.
    #[must_use]
    pub fn turned(&self, rotation: &Matrix3<f64>) -> Self {
        Self(self.0.map(|l| {
            // The quadratic form of the normal without the constant. The unit length of the normal moves a part of the
            // zz entry to the constant.
            let (xx, zz) = (C1 * l[8], C3 * l[6]);
            #[rustfmt::skip]
            let form = Matrix3::new(
                xx, C1 * l[4], C1 * l[7],
                C1 * l[4], -xx, C1 * l[5],
                C1 * l[7], C1 * l[5], zz,
            );
            let form = rotation * form * rotation.transpose();
            let linear = rotation * Vector3::new(l[3], l[1], l[2]);
            // On unit normals x^2 + y^2 = 1 - z^2, so the mean of the xx and yy terms is a constant minus the same
            // multiple of z^2.
            let mean = (form[(0, 0)] + form[(1, 1)]) / 2.0;
            let zz = (form[(2, 2)] - mean) / C3;
            let one = (C4 * l[0] - C5 * l[6] + mean + C5 * zz) / C4;
            let [xy, yz, xz] = [(0, 1), (1, 2), (0, 2)].map(|place| form[place] / C1);
            [one, linear.y, linear.z, linear.x, xy, yz, zz, xz, (form[(0, 0)] - mean) / C1]
        }))
    }

    /// The growth of log S of R, G and B from `other`, a light that differs only in colour.
    #[must_use]
    pub fn offsets_to(&self, other: &Self) -> [f64; 3] {
        std::array::from_fn(|channel| C4 * (self.0[channel][0] - other.0[channel][0]))
    }

    /// log S of the three channels for one normal.
    #[must_use]
    pub fn shade(&self, normal: [f64; 3]) -> [f64; 3] {
        self.of_basis(&basis(normal))
    }

    /// log S of a normal, given its harmonics.
    #[must_use]
    pub(crate) fn of_basis(&self, basis: &[f64; HARMONICS]) -> [f64; 3] {
        self.0.map(|channel| channel.iter().zip(basis).map(|(l, b)| l * b).sum())
    }
}

/// R1..9, G1..9, B1..9.
#[cfg(feature = "serde")]
impl From<Light> for Vec<f64> {
    fn from(light: Light) -> Self {
        light.flat().to_vec()
    }
}

/// Factors of L1..L9 in log S = sum L_k basis_k: the quadratic form of Eq. 5 written out.
#[inline(always)]
#[must_use]
pub(crate) fn basis<T: Real>([x, y, z]: [T; 3]) -> [T; HARMONICS] {
    let times = |constant: f64, value: T| T::constant(constant) * value;
    [
        T::constant(C4),
        times(2.0 * C2, y),
        times(2.0 * C2, z),
        times(2.0 * C2, x),
        times(2.0 * C1, x * y),
        times(2.0 * C1, y * z),
        times(C3, z * z) - T::constant(C5),
        times(2.0 * C1, x * z),
        times(C1, x * x - y * y),
    ]
}

/// d basis / d normal.
#[inline]
#[must_use]
pub(crate) fn basis_gradient<T: Real>([x, y, z]: [T; 3]) -> [[T; 3]; HARMONICS] {
    let [zero, linear, quadratic] = [0.0, 2.0 * C2, 2.0 * C1].map(T::constant);
    [
        [zero; 3],
        [zero, linear, zero],
        [zero, zero, linear],
        [linear, zero, zero],
        [quadratic * y, quadratic * x, zero],
        [zero, quadratic * z, quadratic * y],
        [zero, zero, T::constant(2.0 * C3) * z],
        [quadratic * z, zero, quadratic * x],
        [quadratic * x, T::constant(-2.0 * C1) * y, zero],
    ]
}

/// Decrease of one channel's log S per radian as normals turn about x, y and z: the coefficients of grad log S x n. The
/// coefficients exist because a rotation maps the harmonics of each order into each other.
pub(crate) fn falling_by_turns(l: &[f64; HARMONICS]) -> [[f64; HARMONICS]; 3] {
    // C3 / C1.
    let root = 3.0_f64.sqrt();
    [
        [0.0, -l[2], l[1], 0.0, -l[7], -l[8] - root * l[6], root * l[5], l[4], l[5]],
        [0.0, 0.0, -l[3], l[2], l[5], -l[4], -root * l[7], root * l[6] - l[8], l[7]],
        [0.0, l[3], 0.0, -l[1], 2.0 * l[8], l[7], 0.0, -l[5], -2.0 * l[4]],
    ]
}

/// One channel of a light as a polynomial of the normal, for loops over pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Polynomial<S = f32> {
    one: S,
    linear: [S; 3],
    xy: S,
    yz: S,
    zz: S,
    xz: S,
    xx_yy: S,
}

impl<S: Real<Scalar = S>> Polynomial<S> {
    /// The polynomials of R, G, B.
    #[must_use]
    pub fn of(light: &Light) -> [Self; 3] {
        light.0.map(|l| Self {
            one: S::constant(C4 * l[0] - C5 * l[6]),
            linear: [2.0 * C2 * l[3], 2.0 * C2 * l[1], 2.0 * C2 * l[2]].map(S::constant),
            xy: S::constant(2.0 * C1 * l[4]),
            yz: S::constant(2.0 * C1 * l[5]),
            zz: S::constant(C3 * l[6]),
            xz: S::constant(2.0 * C1 * l[7]),
            xx_yy: S::constant(C1 * l[8]),
        })
    }

    /// log S (Eq. 3) of one normal or of several.
    #[inline(always)]
    #[must_use]
    pub fn shade<T: Real<Scalar = S>>(&self, [x, y, z]: [T; 3]) -> T {
        let [by_x, by_y, by_z] = self.linear;
        T::splat(self.one)
            + x * (T::splat(by_x) + T::splat(self.xy) * y + T::splat(self.xz) * z + T::splat(self.xx_yy) * x)
            + y * (T::splat(by_y) + T::splat(self.yz) * z - T::splat(self.xx_yy) * y)
            + z * (T::splat(by_z) + T::splat(self.zz) * z)
    }

    /// [`shade`](Self::shade) and [`gradient`](Self::gradient) together. A quadratic equals its constant plus half the
    /// sum of two slopes along the normal: the slope at the normal and that at zero.
    #[inline(always)]
    #[must_use]
    pub fn expand<T: Real<Scalar = S>>(&self, [x, y, z]: [T; 3]) -> (T, [T; 3]) {
        let [by_x, by_y, by_z] = self.linear;
        let slope = self.gradient([x, y, z]);
        let along = x * (slope[0] + T::splat(by_x)) + y * (slope[1] + T::splat(by_y)) + z * (slope[2] + T::splat(by_z));
        (T::splat(self.one) + T::constant(0.5) * along, slope)
    }

    /// d log S / d n.
    #[inline(always)]
    #[must_use]
    pub fn gradient<T: Real<Scalar = S>>(&self, [x, y, z]: [T; 3]) -> [T; 3] {
        let [by_x, by_y, by_z] = self.linear;
        let (xy, yz, xz) = (T::splat(self.xy), T::splat(self.yz), T::splat(self.xz));
        let (twice_zz, twice_xx_yy) = (T::splat(self.zz + self.zz), T::splat(self.xx_yy + self.xx_yy));
        [
            T::splat(by_x) + xy * y + xz * z + twice_xx_yy * x,
            T::splat(by_y) + xy * x + yz * z - twice_xx_yy * y,
            T::splat(by_z) + yz * y + xz * x + twice_zz * z,
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::Lanes;
    use nalgebra::{Matrix4, Rotation3, Vector4};

    fn light() -> Light {
        Light([
            [-1.2, 0.1, -0.9, 0.7, 0.1, 0.2, 0.15, -0.2, -0.1],
            [-1.1, 0.8, -0.7, -0.3, -0.2, -0.15, -0.1, -0.1, 0.2],
            [-1.3, -0.6, -0.8, -0.5, 0.15, -0.1, 0.1, 0.25, 0.1],
        ])
    }

    /// The constants follow from the harmonics' own factors and from the clamped cosine's share of each degree: pi, 2 pi / 3 and
    /// pi / 4 (Ramamoorthi and Hanrahan 2001, who give six digits).
    #[test]
    fn the_constants_are_those_of_the_clamped_cosine() {
        use std::f64::consts::PI;
        let share = [PI, 2.0 * PI / 3.0, PI / 4.0];
        let factor = |square: f64| (square / PI).sqrt();
        let expected = [
            share[2] * factor(15.0 / 16.0),
            0.5 * share[1] * factor(3.0 / 4.0),
            3.0 * share[2] * factor(5.0 / 16.0),
            share[0] * factor(1.0 / 4.0),
            share[2] * factor(5.0 / 16.0),
        ];
        for (constant, expected) in [C1, C2, C3, C4, C5].into_iter().zip(expected) {
            assert!((constant - expected).abs() < 2e-6, "{constant} instead of {expected}");
        }
    }

    #[test]
    fn the_basis_is_the_quadratic_form_of_eq_5() {
        let normal = [0.36, -0.48, -0.8];
        let n = Vector4::new(normal[0], normal[1], normal[2], 1.0);
        for (l, shade) in light().0.iter().zip(light().shade(normal)) {
            #[rustfmt::skip]
            let m = Matrix4::new(
                C1 * l[8], C1 * l[4], C1 * l[7], C2 * l[3],
                C1 * l[4], -C1 * l[8], C1 * l[5], C2 * l[1],
                C1 * l[7], C1 * l[5], C3 * l[6], C2 * l[2],
                C2 * l[3], C2 * l[1], C2 * l[2], C4 * l[0] - C5 * l[6],
            );
            assert!(((n.transpose() * m * n)[0] - shade).abs() < 1e-12);
        }
    }

    #[test]
    fn the_polynomial_is_the_light_and_its_gradient_the_difference_quotient() {
        let normal = [0.36_f32, -0.48, -0.8];
        for (polynomial, expected) in Polynomial::of(&light()).iter().zip(light().shade(normal.map(f64::from))) {
            assert!((f64::from(polynomial.shade(normal)) - expected).abs() < 1e-6);
            let (shade, slope) = polynomial.expand(normal);
            assert!((f64::from(shade) - expected).abs() < 1e-6 && slope == polynomial.gradient(normal));
            for axis in 0..3 {
                let (mut up, mut down) = (normal, normal);
                up[axis] += 0.01;
                down[axis] -= 0.01;
                let difference = (polynomial.shade(up) - polynomial.shade(down)) / 0.02;
                assert!((polynomial.gradient(normal)[axis] - difference).abs() < 2e-5);
            }
        }
    }

    #[test]
    fn four_normals_have_the_same_basis() {
        let normal = [0.36, -0.48, -0.8];
        let four = basis(normal.map(|value| Lanes::splat(value as f32)));
        assert!(basis(normal).into_iter().zip(four).all(|(one, four)| (one - f64::from(four.array()[2])).abs() < 1e-6));
    }

    #[test]
    fn the_gradient_of_the_basis_is_the_difference_quotient() {
        let normal = [0.36_f64, -0.48, -0.8];
        let gradient = basis_gradient(normal);
        for axis in 0..3 {
            let (mut up, mut down) = (normal, normal);
            up[axis] += 1e-5;
            down[axis] -= 1e-5;
            for (k, (up, down)) in basis(up).into_iter().zip(basis(down)).enumerate() {
                assert!((gradient[k][axis] - (up - down) / 2e-5).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn turns_of_harmonics_are_harmonics() {
        for normal in [[0.36, -0.48, -0.8], [0.6, 0.64, 0.48], [0.0, -0.6, -0.8]] {
            for (l, polynomial) in light().0.iter().zip(Polynomial::<f64>::of(&light())) {
                let slope = Vector3::from(polynomial.gradient(normal)).cross(&Vector3::from(normal));
                for (axis, turned) in falling_by_turns(l).iter().enumerate() {
                    let found: f64 = turned.iter().zip(basis(normal)).map(|(l, b)| l * b).sum();
                    assert!((found - slope[axis]).abs() < 1e-5, "{axis}: {found} {}", slope[axis]);
                }
            }
        }
    }

    #[test]
    fn a_turned_light_shades_turned_normals_alike() {
        let rotation = Rotation3::from_euler_angles(0.4, -0.9, 2.1).into_inner();
        for normal in [[0.36, -0.48, -0.8], [0.6, 0.64, 0.48], [0.0, -0.6, -0.8], [1.0, 0.0, 0.0]] {
            let turned = rotation * Vector3::from(normal);
            let (before, after) = (light().shade(normal), light().turned(&rotation).shade(turned.into()));
            assert!(before.iter().zip(after).all(|(before, after)| (before - after).abs() < 1e-12));
        }
    }

    #[test]
    fn exposure_shifts_the_logarithm_alike_everywhere() {
        let normal = [0.6, 0.0, -0.8];
        for (plain, exposed) in light().shade(normal).iter().zip(light().exposed(0.7).shade(normal)) {
            assert!((exposed - plain - 0.7).abs() < 1e-12);
        }
    }
}
