//! One distant lamp and a matte surface: Lambert's law, the changes of shape that leave the image the same, and the approximation of the
//! law by harmonics of second order. For lessons (www/learn); the estimate itself uses [`Light`](crate::Light).
//!
//! Limits: only attached shadows are included. Cast shadows, and light from other parts of the surface, are left out.

use nalgebra::Vector3;

/// A distant lamp: its direction as seen from the surface, times its strength. Toward the camera is -z.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lamp(pub Vector3<f64>);

impl Lamp {
    /// Intensity of a surface of albedo 1 with this unit normal: the cosine of the angle to the lamp times its strength,
    /// zero where the surface faces away.
    #[must_use]
    pub fn shade(&self, normal: [f32; 3]) -> f32 {
        let cosine = Vector3::from(normal.map(f64::from)).dot(&self.0);
        if cosine.is_nan() { f32::NAN } else { cosine.max(0.0) as f32 }
    }
}

/// The depth z becomes `stretch` z + `slopes` . (x, y): a generalised bas-relief transformation (Belhumeur, Kriegman
/// and Yuille, 1999). A negative stretch turns a bump into a dent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BasRelief {
    /// Factor of the depth, not zero.
    pub stretch: f64,
    /// Plane that is added to the depth: its slopes along x and y.
    pub slopes: [f64; 2],
}

impl BasRelief {
    /// The unit normal of the new surface, and the factor of the albedo with which it keeps its intensity.
    #[must_use]
    pub fn normal(&self, [x, y, z]: [f32; 3]) -> ([f32; 3], f32) {
        let [x, y, z] = [x, y, z].map(f64::from);
        let [along_x, along_y] = self.slopes;
        // (p, q, -1) becomes (stretch p + slope, stretch q + slope, -1).
        let changed = Vector3::new(self.stretch * x - along_x * z, self.stretch * y - along_y * z, z);
        let length = changed.norm();
        ((changed / length).map(|part| part as f32).into(), length as f32)
    }

    /// The lamp under which the new surface looks like the old one.
    #[must_use]
    pub fn lamp(&self, Lamp(old): Lamp) -> Lamp {
        let [along_x, along_y] = self.slopes;
        let [x, y] = [old.x / self.stretch, old.y / self.stretch];
        Lamp(Vector3::new(x, y, old.z + along_x * x + along_y * y))
    }
}

/// The least-squares approximation over the sphere, by the harmonics of orders 0 to 2, of an intensity that depends on one
/// component of the normal only. Values and result belong to the middles of equal intervals of that component, from -1
/// to 1.
#[must_use]
pub fn second_order(values: &[f32]) -> Vec<f32> {
    let count = values.len() as f64;
    let component = |index: usize| 2.0 * (index as f64 + 0.5) / count - 1.0;
    let legendre = |c: f64| [1.0, c, 1.5 * c * c - 0.5];
    let mut weights = [0.0; 3];
    for (index, &value) in values.iter().enumerate() {
        for (order, polynomial) in legendre(component(index)).into_iter().enumerate() {
            weights[order] += (2 * order + 1) as f64 * polynomial * f64::from(value) / count;
        }
    }
    let predicted = |index| legendre(component(index)).iter().zip(weights).map(|(p, w)| p * w).sum::<f64>() as f32;
    (0..values.len()).map(predicted).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    const NORMALS: [[f32; 3]; 4] = [[0.0, 0.0, -1.0], [0.6, 0.0, -0.8], [-0.48, 0.64, -0.6], [0.36, -0.48, -0.8]];

    #[test]
    fn a_matte_surface_shows_the_cosine() {
        let lamp = Lamp(Vector3::new(0.0, 0.0, -2.0));
        assert_eq!(NORMALS.map(|normal| lamp.shade(normal)), [2.0, 1.6, 1.2, 1.6]);
        assert_eq!(lamp.shade([0.0, 0.0, 1.0]), 0.0);
        assert!(lamp.shade([f32::NAN; 3]).is_nan());
    }

    #[test]
    fn a_bas_relief_looks_the_same() {
        let lamp = Lamp(Vector3::new(0.5, -0.3, -0.8));
        for (stretch, slopes) in [(1.0, [0.0, 0.0]), (0.4, [0.2, -0.1]), (-1.0, [0.0, 0.0]), (-0.7, [0.3, 0.5])] {
            let relief = BasRelief { stretch, slopes };
            for old in NORMALS {
                let (new, albedo) = relief.normal(old);
                assert!((albedo * relief.lamp(lamp).shade(new) - lamp.shade(old)).abs() < 1e-6, "{stretch} {old:?}");
                // The slopes -n_x / n_z and -n_y / n_z are those of the new depth.
                for axis in [0, 1] {
                    let slope = |n: [f32; 3]| f64::from(-n[axis] / n[2]);
                    assert!((slope(new) - (stretch * slope(old) + slopes[axis])).abs() < 1e-5);
                }
            }
        }
        // Without a plane, a dent is lit from the opposite side, and needs no other albedo.
        let dent = BasRelief { stretch: -1.0, slopes: [0.0, 0.0] };
        assert_eq!(dent.lamp(lamp).0, Vector3::new(-0.5, 0.3, -0.8));
        assert!(NORMALS.iter().all(|&normal| (dent.normal(normal).1 - 1.0).abs() < 1e-6));
    }

    #[test]
    fn the_clamped_cosine_has_its_known_coefficients() {
        let count = 4000;
        let component = |index: usize| 2.0 * (index as f32 + 0.5) / count as f32 - 1.0;
        let values: Vec<f32> = (0..count).map(|index| component(index).max(0.0)).collect();
        for (index, found) in second_order(&values).into_iter().enumerate() {
            let c = component(index);
            // Ramamoorthi and Hanrahan, 2001, divided by pi.
            let expected = 0.25 + 0.5 * c + 5.0 / 16.0 * (1.5 * c * c - 0.5);
            assert!((found - expected).abs() < 1e-5, "{c}: {found} {expected}");
        }
        assert!(second_order(&[]).is_empty());
    }
}
