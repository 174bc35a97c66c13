//! A camera whose rays meet in a point: focal lengths, principal point and lens.

use super::lens::Lens;
use crate::check::positive;
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::{Lanes, Real};

/// A pinhole camera behind a lens. Units: pixels; pixel centres are whole numbers. Frame: x right, y down, z forward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pinhole {
    /// Focal length along x in pixels.
    pub fx: f64,
    /// Focal length along y in pixels.
    pub fy: f64,
    /// Column of the principal point.
    pub cx: f64,
    /// Row of the principal point.
    pub cy: f64,
    /// Lens between pinhole and pixels.
    pub lens: Lens,
}

/// Smallest depth or coordinate of a cloud that counts as missing, metres or pixels. Some formats mark a hole by their
/// largest number, and f32 cannot hold its square.
pub const FARTHEST: f64 = 1e12;
/// Message for a ray that is steeper than any in a picture; its points may overflow.
const TOO_STEEP: &str = "must be finite, and below 1e12 focal lengths";
/// Smallest pixel position or slope without a ray. The squares of larger ones overflow f64, and rounding would send
/// some to infinity and back.
const BEYOND: f64 = 1e150;

impl Pinhole {
    /// # Errors
    /// [`ErrorKind::Range`] with the path of the offending number below `field`.
    pub fn validate(&self, field: &str) -> Result<()> {
        positive("fx", self.fx).and(positive("fy", self.fy)).map_err(|error| error.below(field))?;
        for (name, value, focal_length) in [("cx", self.cx, self.fx), ("cy", self.cy, self.fy)] {
            let steepest = (1.0 + value.abs()) / focal_length;
            if steepest.is_nan() || steepest >= FARTHEST {
                return Err(Error::new(ErrorKind::Range, name, TOO_STEEP).value(value).below(field));
            }
        }
        for (index, &value) in self.lens.coefficients().iter().enumerate() {
            if !value.is_finite() {
                return Err(Error::new(ErrorKind::Range, "distortion", "must be finite")
                    .at(index)
                    .value(value)
                    .below(field));
            }
        }
        Ok(())
    }

    /// Column and row of a point; `None` behind the camera, beyond the fold of its lens, and at the camera's centre. A
    /// fisheye also sees points beside and behind it, up to the angle at which its lens folds.
    #[must_use]
    pub fn project(&self, point: [f64; 3]) -> Option<[f64; 2]> {
        let [x, y] = self.lens.project(point)?;
        Some([self.fx * x + self.cx, self.fy * y + self.cy])
    }

    /// [`project`](Self::project) with the derivatives of column and row by x, y, z of the point.
    #[must_use]
    pub fn project_with_gradient(&self, point: [f64; 3]) -> Option<([f64; 2], [[f64; 3]; 2])> {
        let ([x, y], [by_x, by_y]) = self.lens.project_with_gradient(point)?;
        let pixel = [self.fx * x + self.cx, self.fy * y + self.cy];
        Some((pixel, [by_x.map(|slope| self.fx * slope), by_y.map(|slope| self.fy * slope)]))
    }

    /// Direction of the ray through a pixel: with z = 1 if it points forward, so that depth times the direction is the
    /// point; for a fisheye, a unit vector (z below 0.01) if it points sideways or backward. `None` if the lens has no
    /// ray at this pixel, or if the square of pixel or slope overflows.
    #[must_use]
    pub fn ray(&self, [column, row]: [f64; 2]) -> Option<[f64; 3]> {
        let target = self.straight([column, row]);
        if ![column, row, target[0], target[1]].iter().all(|number| number.abs() < BEYOND) {
            return None;
        }
        self.lens.ray(target, [self.fx, self.fy])
    }

    /// The slopes of the ray through a pixel without a lens.
    pub(super) fn straight(&self, [column, row]: [f64; 2]) -> [f64; 2] {
        [(column - self.cx) / self.fx, (row - self.cy) / self.fy]
    }

    /// Columns and rows of four points; NaN behind the camera and beyond the fold of its lens.
    #[inline(always)]
    pub(super) fn project_lanes(&self, [x, y, z]: [Lanes; 3]) -> [Lanes; 2] {
        let splat = |value: f64| Lanes::splat(value as f32);
        let inverse = splat(0.0).less(z).select(splat(1.0) / z, splat(f64::NAN));
        let ray = self.lens.distort_lanes([x * inverse, y * inverse]);
        [splat(self.fx) * ray[0] + splat(self.cx), splat(self.fy) * ray[1] + splat(self.cy)]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Accuracy of a ray, pixels.
    const RETURN_DISTANCE: f64 = 1e-7;
    const MIDDLE: [f64; 4] = [520.0, 515.0, 322.5, 236.5];

    fn camera(lens: Lens) -> Pinhole {
        let [fx, fy, cx, cy] = MIDDLE;
        Pinhole { fx, fy, cx, cy, lens }
    }

    /// Usual lenses, among them those of an action camera, and of a depth sensor whose eight coefficients nearly
    /// cancel.
    fn lenses() -> impl Strategy<Value = Lens> {
        let plain = (-0.3..0.3, -0.1..0.1, -0.005..0.005, -0.005..0.005, -0.05..0.05);
        let rational = (0.0..1.0_f64, -0.1..0.1);
        prop_oneof![
            Just(Lens::None),
            plain.prop_map(|(k1, k2, p1, p2, k3)| Lens::Brown([k1, k2, p1, p2, k3, 0.0, 0.0, 0.0])),
            rational.prop_map(|(k, off)| Lens::Brown([k + off, -2.0 * k, 2e-4, -1e-4, k, k, -2.0 * k, 0.9 * k])),
            (-0.1..0.1, -0.05..0.05, -0.02..0.02, -0.01..0.01)
                .prop_map(|(k1, k2, k3, k4)| Lens::Fisheye([k1, k2, k3, k4])),
        ]
    }

    fn difference(camera: &Pinhole, point: [f64; 3], axis: usize) -> Option<[f64; 2]> {
        let [up, down] = [1e-6, -1e-6].map(|step| {
            let mut moved = point;
            moved[axis] += step;
            camera.project(moved)
        });
        let (up, down) = (up?, down?);
        Some([0, 1].map(|k| (up[k] - down[k]) / 2e-6))
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 512, failure_persistence: None, ..ProptestConfig::default() })]

        #[test]
        fn a_ray_returns_to_its_pixel(lens in lenses(), column in 0.0..639.0, row in 0.0..479.0) {
            let camera = camera(lens);
            let ray = camera.ray([column, row]);
            // A few of these lenses fold within the picture; pixels beyond the fold have no ray.
            prop_assume!(ray.is_some());
            let [x, y, z] = ray.unwrap();
            prop_assert_eq!(z, 1.0);
            let [back, down] = camera.project([2.5 * x, 2.5 * y, 2.5]).unwrap();
            prop_assert!((back - column).hypot(down - row) < 2.0 * RETURN_DISTANCE, "{} {}", back, down);
        }

        #[test]
        fn a_point_returns_to_its_ray(lens in lenses(), x in -3.0..3.0, y in -3.0..3.0, z in -1.0..4.0) {
            let camera = camera(lens);
            if let Some(pixel) = camera.project([x, y, z]) {
                let [u, v, w] = camera.ray(pixel).unwrap();
                // Where the lens is about to fold, a millionth of a pixel may be far in space, so the distance is
                // measured in pixels.
                let back = camera.project([u, v, w]).unwrap();
                let far = pixel[0].hypot(pixel[1]);
                prop_assert!((back[0] - pixel[0]).hypot(back[1] - pixel[1]) < 2.0 * RETURN_DISTANCE + 1e-11 * far);
                prop_assert!(w > 0.0 || (u * u + v * v + w * w - 1.0).abs() < 1e-12);
                let (_, [a, b]) = camera.project_with_gradient([x, y, z]).unwrap();
                let across = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
                let squares = [a, b].map(|row| row.iter().map(|part| part * part).sum::<f64>());
                let size = across.iter().map(|part| part * part).sum::<f64>();
                if size > 1e-4 * squares[0].max(squares[1]).powi(2) {
                    let [point, ray] = [[x, y, z], [u, v, w]].map(|[x, y, z]| {
                        let length = (x * x + y * y + z * z).sqrt();
                        [x / length, y / length, z / length]
                    });
                    prop_assert!((0..3).all(|k| (point[k] - ray[k]).abs() < 1e-6), "{:?} {:?}", point, ray);
                }
            }
        }

        #[test]
        fn the_gradient_is_the_difference_quotient(lens in lenses(), x in -0.6..0.6, y in -0.5..0.5, z in -0.2..2.0) {
            let camera = camera(lens);
            let point: [f64; 3] = [x, y, z];
            prop_assume!(z > 0.3 || matches!(lens, Lens::Fisheye(_)) && x.hypot(y).hypot(z) > 0.3 && x.hypot(y) > 0.05);
            let projected = camera.project_with_gradient(point);
            prop_assert_eq!(projected.map(|(pixel, _)| pixel.map(|part| (1e9 * part).round())),
                camera.project(point).map(|pixel| pixel.map(|part| (1e9 * part).round())));
            let Some((_, gradient)) = projected else { return Ok(()) };
            for axis in 0..3 {
                let Some(slopes) = difference(&camera, point, axis) else { continue };
                for k in 0..2 {
                    let off = (gradient[k][axis] - slopes[k]).abs();
                    prop_assert!(off < 1e-4 + 1e-6 * slopes[k].abs(), "{:?}[{}][{}]: {}", gradient, k, axis, off);
                }
            }
        }
    }

    #[test]
    fn nothing_is_seen_beyond_the_fold() {
        // r - r^3 grows up to r = 0.577. r (1 - 0.5 r^2 + 0.1 r^4) falls between r = 1 and 1.41 and then grows again.
        let once = camera(Lens::Brown([-1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
        let twice = camera(Lens::Brown([-0.5, 0.1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
        for (camera, seen, unseen) in [(once, 0.57, [0.585, 3.0]), (twice, 0.99, [1.02, 1.5])] {
            for turn in [0.0_f64, 1.0, 2.0, 4.0] {
                let point = |slope: f64| [slope * turn.cos(), slope * turn.sin(), 1.0];
                let pixel = camera.project(point(seen)).unwrap();
                let [x, y, _] = camera.ray(pixel).unwrap();
                assert!((x.hypot(y) - seen).abs() < 1e-6, "{x} {y}");
                assert_eq!(unseen.map(|slope| camera.project(point(slope))), [None; 2]);
                assert_eq!(unseen.map(|slope| camera.project_with_gradient(point(slope))), [None; 2]);
            }
        }
        // The first shows at most 0.385 focal lengths; the second shows 0.6.
        let [fx, _, cx, cy] = MIDDLE;
        assert!(once.ray([cx + 0.384 * fx, cy]).is_some() && once.ray([cx + 0.386 * fx, cy]).is_none());
        assert!(twice.ray([cx + 0.599 * fx, cy]).is_some() && twice.ray([cx + 0.601 * fx, cy]).is_none());
        // A pole of the rational model: 1 - r^2 in the denominator.
        let pole = camera(Lens::Brown([0.0, 0.0, 0.0, 0.0, 0.0, -1.0, 0.0, 0.0]));
        assert!(pole.project([0.9, 0.0, 1.0]).is_some() && pole.project([1.1, 0.0, 1.0]).is_none());
        // theta - 0.2 theta^3 grows up to 1.29 rad.
        let fisheye = camera(Lens::Fisheye([-0.2, 0.0, 0.0, 0.0]));
        let at = |angle: f64| fisheye.project([0.0, angle.sin(), angle.cos()]);
        assert!(at(1.28).is_some() && at(1.30).is_none() && at(3.0).is_none());
    }

    #[test]
    fn a_fisheye_sees_beside_and_behind_itself_and_a_pinhole_does_not() {
        let wide = camera(Lens::Fisheye([0.01, -0.002, 0.0, 0.0]));
        for point in [[1.0, 0.5, 0.0], [1.0, -0.5, -0.4]] {
            let [u, v, w] = wide.ray(wide.project(point).unwrap()).unwrap();
            let length = point.iter().map(|part: &f64| part * part).sum::<f64>().sqrt();
            for (part, expected) in [u, v, w].into_iter().zip(point) {
                assert!((part - expected / length).abs() < 1e-9);
            }
        }
        for point in [[0.0, 0.0, -1.0], [0.0; 3]] {
            assert_eq!(wide.project(point), None);
            assert_eq!(camera(Lens::None).project(point), None);
        }
        let [_, _, cx, cy] = MIDDLE;
        assert_eq!(wide.project([0.0, 0.0, 2.0]), Some([cx, cy]));
        assert_eq!(wide.ray([cx, cy]), Some([0.0, 0.0, 1.0]));
        let (_, gradient) = wide.project_with_gradient([0.0, 0.0, 2.0]).unwrap();
        assert_eq!(gradient, [[260.0, 0.0, 0.0], [0.0, 257.5, 0.0]]);
    }

    #[test]
    fn numbers_that_are_no_camera_are_named() {
        let good = camera(Lens::Fisheye([0.1, 0.0, 0.0, 0.0]));
        assert_eq!(good.validate("camera"), Ok(()));
        let cases = [
            (Pinhole { fx: 0.0, ..good }, "camera.fx", None),
            (Pinhole { fy: f64::INFINITY, ..good }, "camera.fy", None),
            (Pinhole { cy: f64::NAN, ..good }, "camera.cy", None),
            (Pinhole { lens: Lens::Fisheye([0.0, 0.0, f64::NAN, 0.0]), ..good }, "camera.distortion", Some(2)),
        ];
        for (camera, field, index) in cases {
            let error = camera.validate("camera").unwrap_err();
            assert_eq!((error.kind(), error.field(), error.index()), (ErrorKind::Range, field, index));
        }
    }

    /// The first pose of such a camera would be infinite.
    #[test]
    fn rays_as_steep_as_no_picture_has_them_are_refused() {
        let good = Pinhole { fx: 60.0, fy: 60.0, cx: -500.0, cy: 31.5, lens: Lens::None };
        assert_eq!(good.validate("camera"), Ok(()));
        for (bad, field) in [
            (Pinhole { cx: 1e308, ..good }, "camera.cx"),
            (Pinhole { cx: f64::NAN, ..good }, "camera.cx"),
            (Pinhole { cy: -1e15, ..good }, "camera.cy"),
            (Pinhole { cx: 0.0, fx: 1e-300, ..good }, "camera.cx"),
            (Pinhole { fy: f64::INFINITY, ..good }, "camera.fy"),
        ] {
            let error = bad.validate("camera").unwrap_err();
            assert_eq!((error.kind(), error.field()), (ErrorKind::Range, field));
        }
    }
}
