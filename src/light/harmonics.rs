//! log S = n^T M n with n = [n_x n_y n_z 1]: second-order spherical harmonics (Eq. 3, 5).

use crate::error::{Error, ErrorKind, Result};

/// Number of harmonics for each channel.
pub const HARMONICS: usize = 9;

const C1: f64 = 0.429_043;
const C2: f64 = 0.511_664;
const C3: f64 = 0.743_125;
const C4: f64 = 0.886_227;
const C5: f64 = 0.247_708;

/// Nine coefficients for each of R, G, B in the colour view's frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light(pub [[f64; HARMONICS]; 3]);

impl Light {
    /// From 27 numbers R1..9, G1..9, B1..9.
    ///
    /// # Errors
    /// [`ErrorKind::Size`] unless there are 27, [`ErrorKind::Range`] where one is not finite.
    pub fn from_slice(field: &'static str, values: &[f64]) -> Result<Self> {
        if values.len() != 3 * HARMONICS {
            return Err(Error::new(ErrorKind::Size, field, format!("a light has 27 numbers, not {}", values.len())));
        }
        let light = Self(std::array::from_fn(|channel| std::array::from_fn(|k| values[channel * HARMONICS + k])));
        light.validate(field)?;
        Ok(light)
    }

    /// # Errors
    /// [`ErrorKind::Range`] naming the coefficient that is not finite.
    pub fn validate(&self, field: &'static str) -> Result<()> {
        match self.flat().iter().position(|value| !value.is_finite()) {
            None => Ok(()),
            Some(index) => Err(Error::new(ErrorKind::Range, field, "must be finite").at(index)),
        }
    }

    /// R1..9, G1..9, B1..9.
    #[must_use]
    pub fn flat(&self) -> [f64; 3 * HARMONICS] {
        std::array::from_fn(|index| self.0[index / HARMONICS][index % HARMONICS])
    }

    /// log S of the three channels for one normal.
    #[must_use]
    pub fn shade(&self, normal: [f64; 3]) -> [f64; 3] {
        let basis = basis(normal);
        self.0.map(|channel| channel.iter().zip(basis).map(|(l, b)| l * b).sum())
    }
}

/// What L1..L9 multiply, so that log S = sum L_k basis_k: the quadratic form of Eq. 5 written out.
#[must_use]
pub fn basis([x, y, z]: [f64; 3]) -> [f64; HARMONICS] {
    [
        C4,
        2.0 * C2 * y,
        2.0 * C2 * z,
        2.0 * C2 * x,
        2.0 * C1 * x * y,
        2.0 * C1 * y * z,
        C3 * z * z - C5,
        2.0 * C1 * x * z,
        C1 * (x * x - y * y),
    ]
}
