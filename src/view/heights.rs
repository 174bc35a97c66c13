//! Heights, the coordinate in which surfaces are solved (docs/method/heights.md): depth itself for an orthographic
//! camera, f ln Z for a pinhole camera of focal length f. Both are in pixels, so their slopes are pixels of height per
//! pixel. Normals behind a pinhole give gradients of ln Z, which become slopes of height when multiplied by f.

use super::Camera;

impl Camera {
    /// Converts depths to heights in place; NaN stays NaN.
    pub(crate) fn heights_from_depth(&self, field: &mut [f32]) {
        let Some(focal_length) = self.focal_length() else { return };
        for value in field {
            *value = (focal_length * f64::from(*value).ln()) as f32;
        }
    }

    /// Converts heights to depths in place.
    pub(crate) fn depth_from_heights(&self, field: &mut [f32]) {
        let Some(focal_length) = self.focal_length() else { return };
        for value in field {
            *value = (f64::from(*value) / focal_length).exp() as f32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::{Lens, Pinhole};

    #[test]
    fn depths_come_back_and_their_slopes_are_in_pixels() {
        let depth = [0.8, 1.0, 1.001, f32::NAN];
        let pinhole = Pinhole { fx: 500.0, fy: 500.0, cx: 0.0, cy: 0.0, lens: Lens::None };
        for (camera, slope) in [(Camera::Orthographic, 0.001), (Camera::Pinhole(pinhole), 0.5)] {
            let mut field = depth;
            camera.heights_from_depth(&mut field);
            // d (f ln Z) = f dZ / Z.
            assert!((field[2] - field[1] - slope).abs() < 1e-3 * slope, "{field:?}");
            camera.depth_from_heights(&mut field);
            assert!(field.iter().zip(depth).all(|(a, b)| (a - b).abs() < 1e-6 || a.is_nan() && b.is_nan()));
        }
    }
}
