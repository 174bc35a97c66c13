//! Views at half the resolution: a pixel is the mean of the known values among the 2x2 pixels that it covers.

use nalgebra::Vector3;

use super::{Camera, ColourView, DepthNoise, DepthView, Normals, Pinhole, Points, Size};

impl Size {
    /// Half as many columns and rows, rounded up.
    #[must_use]
    pub const fn halved(self) -> Self {
        Self { width: self.width.div_ceil(2), height: self.height.div_ceil(2) }
    }

    /// Calls `visit` with the index of each pixel of the halved view and the pixels that it covers.
    fn for_each_block(self, mut visit: impl FnMut(usize, &[usize])) {
        let half = self.halved();
        for coarse in 0..half.len() {
            let (column, row) = half.position(coarse);
            let (mut covered, mut count) = ([0; 4], 0);
            for row in 2 * row..(2 * row + 2).min(self.height) {
                for column in 2 * column..(2 * column + 2).min(self.width) {
                    covered[count] = self.index(column, row);
                    count += 1;
                }
            }
            visit(coarse, &covered[..count]);
        }
    }

    /// Means of the known values of `fine` over each pixel of the halved view; NaN where all are unknown.
    #[inline(never)]
    pub(crate) fn halve(self, fine: &[f32], coarse: &mut [f32]) {
        self.for_each_block(|index, covered| {
            let known = covered.iter().map(|&pixel| fine[pixel]).filter(|value| !value.is_nan());
            let (sum, count) = known.fold((0.0, 0.0), |(sum, count), value| (sum + value, count + 1.0));
            coarse[index] = if count > 0.0 { sum / count } else { f32::NAN };
        });
    }

    /// The inverse of halving: interpolates bilinearly between the pixels of the halved view that are not NaN.
    pub(crate) fn double(self, coarse: &[f32], fine: &mut [f32]) {
        let half = self.halved();
        for (index, value) in fine.iter_mut().enumerate() {
            let (column, row) = self.position(index);
            let place = [(column, half.width), (row, half.height)]
                .map(|(fine, coarse)| (0.5 * fine as f32 - 0.25).clamp(0.0, (coarse - 1) as f32));
            *value = half.bilinear_of_known(coarse, place[0], place[1]);
        }
    }
}

impl Camera {
    /// The same camera over pixels of twice the side.
    fn halved(self) -> Self {
        match self {
            Self::Orthographic => Self::Orthographic,
            Self::Pinhole(Pinhole { fx, fy, cx, cy, lens }) => {
                let [cx, cy] = [cx, cy].map(|centre| (centre + 0.5) / 2.0 - 0.5);
                Self::Pinhole(Pinhole { fx: fx / 2.0, fy: fy / 2.0, cx, cy, lens })
            }
        }
    }
}

impl ColourView {
    /// The view at half the resolution; a pixel belongs to the object if it covers any object pixel.
    #[inline(never)]
    pub(crate) fn halved(&self) -> Self {
        let size = self.size.halved();
        let log = self.log.each_ref().map(|fine| {
            let mut coarse = vec![0.0; size.len()];
            self.size.halve(fine, &mut coarse);
            coarse
        });
        // Colours are known exactly where the object is.
        let mask = log[0].iter().map(|log| !log.is_nan()).collect();
        Self::of(size, self.camera.halved(), mask, log, self.transfer)
    }
}

/// Centre of the halved raster relative to that of its view, in the view's pixels; `None` if the view's frame is not
/// measured in pixels.
fn half_origin(size: Size, unit_is_pixel: bool) -> Option<Vector3<f64>> {
    let shift = |side: usize| if side.is_multiple_of(2) { 0.0 } else { 0.5 };
    unit_is_pixel.then(|| Vector3::new(shift(size.width), shift(size.height), 0.0))
}

impl ColourView {
    /// The origin of the halved view's frame, given in this view's frame, whose unit is half as long; `None` if both
    /// frames are the same.
    pub(crate) fn half_origin(&self) -> Option<Vector3<f64>> {
        half_origin(self.size, self.camera.is_orthographic())
    }
}

impl Normals {
    /// Means of the vectors over each pixel of the halved raster.
    #[inline(never)]
    fn halved(&self, size: Size) -> Self {
        let mut coarse = Self::missing(size.halved().len());
        for (fine, coarse) in [(&self.x, &mut coarse.x), (&self.y, &mut coarse.y), (&self.z, &mut coarse.z)] {
            size.halve(fine, coarse);
        }
        coarse
    }

    /// Directions of these means.
    #[inline(never)]
    pub(crate) fn halved_directions(&self, size: Size) -> Self {
        let mut coarse = self.halved(size);
        for index in 0..coarse.len() {
            let [x, y, z] = coarse.get(index);
            let length = (x * x + y * y + z * z).sqrt();
            // Opposite vectors have no mean direction, and 0 / 0 marks it as missing.
            coarse.set(index, [x / length, y / length, z / length]);
        }
        coarse
    }
}

impl DepthView {
    /// The origin of a halved depth view, given in this view's frame. An organised cloud keeps its frame.
    pub(crate) fn half_origin(&self) -> Option<Vector3<f64>> {
        half_origin(self.size, self.camera.is_orthographic() && !self.organised)
    }

    /// The view at half the resolution, without its holes: means of the points, directions of the mean normals.
    pub(crate) fn halved(&self) -> Self {
        let size = self.size.halved();
        let mut points: Points = self.points.halved(self.size);
        if let Some(origin) = self.half_origin() {
            for (values, middle) in [&mut points.x, &mut points.y, &mut points.z].into_iter().zip(&origin) {
                values.iter_mut().for_each(|value| *value = 0.5 * (*value - *middle as f32));
            }
        }
        Self {
            size,
            camera: self.camera.halved(),
            mask: points.z.iter().map(|depth| !depth.is_nan()).collect(),
            points,
            measured_depth: Vec::new(),
            noise: DepthNoise { sigma: 0.5 * self.noise.sigma, ..self.noise },
            normals: self.normals.halved_directions(self.size),
            organised: self.organised,
            normals_given: self.normals_given,
            trimmed: 0,
            has_mask: self.has_mask,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::Lens;

    const ODD: Size = Size { width: 7, height: 5 };

    #[test]
    fn a_plane_survives_there_and_back() {
        let plane: Vec<f32> = (0..ODD.len()).map(|i| (ODD.position(i).0 + 3 * ODD.position(i).1) as f32).collect();
        let mut coarse = vec![0.0; ODD.halved().len()];
        ODD.halve(&plane, &mut coarse);
        let mut back = vec![0.0; ODD.len()];
        ODD.double(&coarse, &mut back);
        for index in 0..ODD.len() {
            let (column, row) = ODD.position(index);
            if (1..5).contains(&column) && (1..3).contains(&row) {
                assert!((back[index] - plane[index]).abs() < 1e-5, "{index}: {} {}", back[index], plane[index]);
            }
        }
    }

    #[test]
    fn what_covers_a_known_pixel_is_known_and_gives_it_a_value() {
        let mut fine = vec![f32::NAN; ODD.len()];
        fine[ODD.index(6, 4)] = 2.0;
        let mut coarse = vec![0.0; ODD.halved().len()];
        ODD.halve(&fine, &mut coarse);
        assert_eq!(coarse.iter().filter(|value| !value.is_nan()).count(), 1);
        ODD.double(&coarse, &mut fine);
        assert_eq!(fine[ODD.index(6, 4)], 2.0);
    }

    #[test]
    fn rays_stay_where_they_were() {
        let lens = Lens::brown(&[0.1, 0.0, 0.0, 0.0]).unwrap();
        let pinhole = Pinhole { fx: 80.0, fy: 90.0, cx: 3.2, cy: 2.1, lens };
        let camera = Camera::Pinhole(pinhole);
        let fine = camera.ray(ODD, [2.5, 0.5]);
        let coarse = camera.halved().ray(ODD.halved(), [1.0, 0.0]);
        assert!((0..2).all(|axis| (fine[axis] - coarse[axis]).abs() < 1e-12), "{fine:?} {coarse:?}");
    }
}
