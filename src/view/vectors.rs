//! Vector fields over a raster, normals and points, as structure-of-arrays.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};

use crate::numeric::Lanes;

/// Unit normals over a raster, NaN where missing. They face the camera: z < 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Normals {
    /// x components (right).
    pub x: Vec<f32>,
    /// y components (down).
    pub y: Vec<f32>,
    /// z components (forward).
    pub z: Vec<f32>,
}

/// Points over a raster, NaN where missing.
pub type Points = Normals;

impl Normals {
    /// `length` missing vectors.
    #[must_use]
    #[inline(never)]
    pub fn missing(length: usize) -> Self {
        Self { x: vec![f32::NAN; length], y: vec![f32::NAN; length], z: vec![f32::NAN; length] }
    }

    /// Number of vectors.
    #[must_use]
    pub fn len(&self) -> usize {
        self.z.len()
    }

    /// Whether there is no vector at all.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.z.is_empty()
    }

    /// The vector at `index`, NaN where missing.
    #[inline(always)]
    #[must_use]
    pub fn get(&self, index: usize) -> [f32; 3] {
        [self.x[index], self.y[index], self.z[index]]
    }

    /// The four vectors that begin at `index`; NaN beyond the last one.
    pub(crate) fn lanes(&self, index: usize) -> [Lanes; 3] {
        let start = index as isize;
        [Lanes::load(&self.x, start), Lanes::load(&self.y, start), Lanes::load(&self.z, start)]
    }

    /// Replaces the vector at `index`.
    #[inline(always)]
    pub fn set(&mut self, index: usize, vector: [f32; 3]) {
        [self.x[index], self.y[index], self.z[index]] = vector;
    }

    /// Whether there is a vector at `index`.
    #[inline(always)]
    #[must_use]
    pub fn is_valid(&self, index: usize) -> bool {
        // One test suffices, because a sum is NaN if a member is NaN.
        !self.get(index).iter().sum::<f32>().is_nan()
    }

    /// Copies other vectors; allocates if there are more than ever before.
    pub(crate) fn copy_from(&mut self, other: &Self) {
        self.x.clone_from(&other.x);
        self.y.clone_from(&other.y);
        self.z.clone_from(&other.z);
    }

    /// Changes the number of vectors; new ones are missing.
    pub(crate) fn resize(&mut self, length: usize) {
        [&mut self.x, &mut self.y, &mut self.z].into_iter().for_each(|axis| axis.resize(length, f32::NAN));
    }

    /// Copies a range of other vectors into this field, starting at `start`.
    pub(crate) fn copy_range(&mut self, start: usize, other: &Self, range: &Range<usize>) {
        let [x, y, z] = [&other.x, &other.y, &other.z].map(|axis| &axis[range.clone()]);
        for (mine, theirs) in [(&mut self.x, x), (&mut self.y, y), (&mut self.z, z)] {
            mine[start..start + theirs.len()].copy_from_slice(theirs);
        }
    }

    /// Rotates a range of the vectors and writes them into `rotated`, starting at `start`.
    pub(crate) fn rotate(&self, range: &Range<usize>, rotation: &Matrix3<f64>, rotated: &mut Self, start: usize) {
        let [x, y, z] = [&self.x, &self.y, &self.z].map(|axis| &axis[range.clone()]);
        for (axis, out) in [&mut rotated.x, &mut rotated.y, &mut rotated.z].into_iter().enumerate() {
            let [a, b, c] = [0, 1, 2].map(|column: usize| rotation[(axis, column)] as f32);
            for (((out, x), y), z) in out[start..].iter_mut().zip(x).zip(y).zip(z) {
                *out = a * x + b * y + c * z;
            }
        }
    }

    /// The vectors that are not missing.
    pub fn valid(&self) -> impl Iterator<Item = Vector3<f64>> + Clone {
        (0..self.len()).filter(|&index| self.is_valid(index)).map(|index| self.get(index).map(f64::from).into())
    }

    /// Mean of the vectors that are not missing; zero if all are.
    #[must_use]
    pub fn centroid(&self) -> Vector3<f64> {
        extent(self.valid()).0
    }

    /// The vectors interleaved: x, y, z, x, y, z, ...
    #[must_use]
    pub fn interleaved(&self) -> Vec<f32> {
        (0..self.len()).flat_map(|index| self.get(index)).collect()
    }
}

/// Centroid of points and their root mean square distance from it; zero if there are no points.
pub(crate) fn extent(points: impl Iterator<Item = Vector3<f64>> + Clone) -> (Vector3<f64>, f64) {
    let (mut sum, mut count) = (Vector3::zeros(), 0.0);
    for point in points.clone() {
        sum += point;
        count += 1.0;
    }
    let count = f64::max(count, 1.0);
    let centre = sum / count;
    (centre, (points.map(|point| (point - centre).norm_squared()).sum::<f64>() / count).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vector_with_a_missing_member_is_missing() {
        let mut points = Points::missing(1);
        points.set(0, [1.0; 3]);
        assert!(points.is_valid(0));
        for axis in 0..3 {
            let point = [0, 1, 2].map(|other| if other == axis { f32::NAN } else { 1.0 });
            points.set(0, point);
            assert!(!points.is_valid(0), "{point:?}");
        }
    }
}
