//! Rotations spread evenly over those that are possible between two views of one object.
//!
//! Method: the super-Fibonacci spiral (Alexa, CVPR 2022) of unit quaternions q_i = (sqrt t sin a, sqrt t cos a,
//! sqrt(1-t) sin b, sqrt(1-t) cos b) with t = (i + 1/2) / n, a = 2 pi (i + 1/2) / phi and b = 2 pi (i + 1/2) / psi. A
//! rotation drawn from the seed rotates all of them, which does not change their spacing; those inside the domain are
//! kept.
//!
//! Limits: the spacing is the edge of the cube that each rotation represents. The rotation farthest from all members is
//! about 0.9 spacings away from the nearest one.

use std::f64::consts::{PI, SQRT_2, TAU};

use nalgebra::{Matrix3, Quaternion, UnitQuaternion, Vector3};

use crate::numeric::random::Random;

/// Largest tilt between both lines of sight, degrees. Beyond a right angle, views of a relief share almost nothing.
const LARGEST_TILT: f64 = 100.0;
/// Largest roll about the line of sight in degrees at any tilt, because most cameras are held upright.
const LARGEST_ROLL: f64 = 32.0;
/// Every rotation by less than this many degrees about any axis belongs to the domain.
const LARGEST_ANGLE: f64 = 76.0;
/// Constants of the spiral: phi = sqrt 2, and psi, the positive root of psi^4 = psi + 4.
const PSI: f64 = 1.533_751_168_755_204_3;

/// The rotations of the domain, about `spacing` degrees apart.
pub fn spread(spacing: f64, seed: u64) -> Vec<Matrix3<f64>> {
    let mut random = Random::new(seed, 0);
    let mut uniform = || random.uniform();
    // Shoemake's uniform rotation has the form of the spiral's members.
    let drawn = member(uniform(), TAU * uniform(), TAU * uniform());
    // The volume of all rotations is 8 pi^2 cubic radians.
    let count = (8.0 * PI.powi(2) / spacing.to_radians().powi(3)).ceil() as usize;
    let along = |index: usize| {
        let i = index as f64 + 0.5;
        drawn * member(i / count as f64, TAU * i / SQRT_2, TAU * i / PSI)
    };
    (0..count).map(along).filter(in_domain).map(|rotation| rotation.to_rotation_matrix().into_inner()).collect()
}

fn member(t: f64, a: f64, b: f64) -> UnitQuaternion<f64> {
    let (near, far) = (t.sqrt(), (1.0 - t).sqrt());
    UnitQuaternion::from_quaternion(Quaternion::new(near * a.sin(), near * a.cos(), far * b.sin(), far * b.cos()))
}

fn in_domain(rotation: &UnitQuaternion<f64>) -> bool {
    let tilt = (rotation * Vector3::z()).angle(&Vector3::z()).to_degrees();
    // atan of the ratio, not atan2, because a quaternion and its negative are the same rotation.
    let roll = 2.0 * (rotation.k / rotation.w).atan().to_degrees();
    (tilt <= LARGEST_TILT && roll.abs() <= LARGEST_ROLL) || rotation.angle().to_degrees() <= LARGEST_ANGLE
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Rotation3, Unit};

    const SPACING: f64 = 16.0;

    fn nearest(all: &[Matrix3<f64>], wanted: &Matrix3<f64>) -> f64 {
        let degrees = |r: &Matrix3<f64>| Rotation3::from_matrix_unchecked(r.transpose() * wanted).angle().to_degrees();
        all.iter().map(degrees).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn no_rotation_of_the_domain_is_far_from_a_member() {
        for seed in 0..4 {
            let all = spread(SPACING, seed);
            for k in 0..200 {
                let (azimuth, tilt, roll) = (0.7 * f64::from(k), f64::from(k % 90), f64::from(k % 57) - 28.0);
                let axis = Unit::new_normalize(Vector3::new(azimuth.cos(), azimuth.sin(), 0.0));
                let rotation = Rotation3::from_axis_angle(&axis, tilt.to_radians())
                    * Rotation3::from_axis_angle(&Vector3::z_axis(), roll.to_radians());
                let off = nearest(&all, rotation.matrix());
                assert!(off < 0.95 * SPACING, "seed {seed}: {off} degrees");
            }
        }
    }

    #[test]
    fn members_are_rotations_and_the_same_for_a_seed() {
        let all = spread(SPACING, 7);
        assert_eq!(all, spread(SPACING, 7));
        assert_ne!(all, spread(SPACING, 8));
        assert!(all.iter().all(|r| (r.transpose() * r - Matrix3::identity()).norm() < 1e-12 && r.determinant() > 0.0));
    }
}
