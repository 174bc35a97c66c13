//! One pair of frames in the form that the check uses.

use nalgebra::Vector3;

use super::ahead::Ahead;
use super::planes::Planes;
use super::unknowns::State;
use crate::numeric::quantile;
use crate::view::{Pinhole, Size, depth_noise};

/// A point is hidden if it lies behind the nearest one by more than this share of the distance: twice the depth step of
/// a Kinect at three metres.
const HIDDEN_SHARE: f64 = 0.02;
/// Smallest distance behind the nearest point, in metres, at which a point is hidden. Flying pixels and the noise of a
/// near object do not reach so far.
const HIDDEN_LEAST: f64 = 0.015;

/// Distance from which a point counts as behind another one, in sigmas of the map's noise. A depth is compared with one
/// that is extrapolated from two others, and their difference has 1.9 times the sigma of a depth. The limit is
/// therefore about three standard deviations. With five sigmas, a receding floor has discontinuities everywhere.
const NOISE_SIGMAS: f64 = 6.0;

/// Colours, points, and the known parameters of the colour camera.
#[derive(Clone, Debug)]
pub(super) struct Frame {
    pub name: String,
    pub planes: Planes,
    pub camera: Pinhole,
    /// The mask of the object in the image, if one was given.
    pub image_mask: Option<Vec<bool>>,
    /// Raster of the samples: that of the depth map unless it is sparse.
    pub grid: Size,
    /// Columns and rows of the depth map.
    pub map: Size,
    /// Intrinsics of the depth camera; a cloud has none.
    pub depth_camera: Option<Pinhole>,
    /// Columns and rows of the depth map in a cell of `grid`: one unless the map is sparse.
    pub cell: [usize; 2],
    /// Column and row of the depth map of each cell's sample; empty if every pixel of the map is a cell.
    pub places: Vec<(usize, usize)>,
    /// Points in the depth camera's frame, metres; NaN where missing or outside the mask.
    pub points: Vec<[f32; 3]>,
    /// Intensity of each sample, in the scanner's own unit, if it is known.
    pub intensity: Option<Vec<f32>>,
    pub has_depth_mask: bool,
    /// Whether points were given instead of a depth map, as by a scanner.
    pub is_cloud: bool,
    /// Whether the maker may have resampled the depth map onto the image's raster.
    pub may_be_registered: bool,
    /// Width of a pixel of `planes` in pixels of the image as given.
    pub pixel: f64,
    /// Standard deviation of 1 / z, in 1 / m. It is about the same at all depths for cameras that measure disparities.
    noise: f64,
}

/// Noise of the inverse depth of a raster of points. The inverse depth of a plane is linear, whatever its slope.
fn noise(grid: Size, points: &[[f32; 3]]) -> f64 {
    let ahead = Ahead::of(points);
    let inverses: Vec<f32> = points.iter().map(|point| 1.0 / ahead.depth(point)).collect();
    depth_noise::most(grid, &inverses)
}

impl Frame {
    /// `points` in the depth camera's frame, metres.
    pub fn new(name: String, planes: Planes, camera: Pinhole, grid: Size, points: Vec<[f32; 3]>) -> Self {
        let noise = noise(grid, &points);
        Self {
            name,
            planes,
            camera,
            image_mask: None,
            grid,
            map: grid,
            depth_camera: None,
            cell: [1, 1],
            places: vec![],
            points,
            intensity: None,
            has_depth_mask: false,
            is_cloud: false,
            may_be_registered: false,
            pixel: 1.0,
            noise,
        }
    }

    /// Measures the noise anew, after the points have changed.
    pub fn measure_noise(&mut self) {
        self.noise = noise(self.grid, &self.points);
    }

    /// Column and row of the depth map at which the sample of a cell was measured.
    pub fn place(&self, index: usize) -> (usize, usize) {
        self.places.get(index).copied().unwrap_or_else(|| self.grid.position(index))
    }

    /// Step from one sample to another on the raster, in cells.
    pub fn step(&self, from: usize, to: usize) -> [f64; 2] {
        let ((column, row), (to_column, to_row)) = (self.place(from), self.place(to));
        let [columns, rows] = self.cell.map(|side| side as f64);
        [(to_column as f64 - column as f64) / columns, (to_row as f64 - row as f64) / rows]
    }

    /// Smallest gap, in metres, at which a point counts as behind another one at `distance`.
    pub fn clear_gap(&self, distance: f64) -> f64 {
        HIDDEN_LEAST.max(HIDDEN_SHARE * distance).max(NOISE_SIGMAS * self.noise * distance * distance)
    }

    /// Halves the image and the mask, and adapts the camera; an odd last row or column is dropped.
    pub fn halve(&mut self) {
        let (from, to) = (self.planes.size, self.planes.halved());
        self.image_mask = self.image_mask.take().map(|mask| {
            (0..to.size.len())
                .map(|index| to.size.position(index))
                .map(|(column, row)| mask[from.index(2 * column, 2 * row)])
                .collect()
        });
        let Pinhole { fx, fy, cx, cy, lens } = self.camera;
        // The new centre lies between two old pixels.
        self.camera = Pinhole { fx: fx / 2.0, fy: fy / 2.0, cx: (cx - 0.5) / 2.0, cy: (cy - 0.5) / 2.0, lens };
        self.planes = to;
        self.pixel *= 2.0;
    }

    pub fn point(&self, index: usize) -> Option<Vector3<f64>> {
        let [x, y, z] = self.points[index].map(f64::from);
        (!z.is_nan()).then(|| Vector3::new(x, y, z))
    }

    /// Valid points, thinned to about `most`.
    pub fn sparse(&self, most: usize) -> Vec<Vector3<f64>> {
        let valid = self.points.iter().filter(|point| !point[2].is_nan()).count();
        let stride = valid.div_ceil(most).max(1);
        (0..self.points.len()).filter_map(|index| self.point(index)).step_by(stride).collect()
    }
}

/// The cloud in the colour camera's view: the pixel of each point, and which points are hidden.
pub(super) struct Projection {
    /// Points in the colour camera's frame; NaN where missing.
    pub positions: Vec<[f32; 3]>,
    /// Column and row of each point, possibly off the image; NaN where missing or behind the camera.
    pub pixels: Vec<[f32; 2]>,
    pub is_hidden: Vec<bool>,
}

impl Projection {
    pub fn new(frame: &Frame, state: &State) -> Self {
        let camera = state.camera(&frame.camera);
        let count = frame.points.len();
        let (mut positions, mut pixels) = (vec![[f32::NAN; 3]; count], vec![[f32::NAN; 2]; count]);
        for (index, point) in frame.points.iter().enumerate().filter(|(_, point)| !point[2].is_nan()) {
            let point = state.pose.apply(Vector3::from(point.map(f64::from)));
            positions[index] = [point.x as f32, point.y as f32, point.z as f32];
            if let Some(pixel) = camera.project([point.x, point.y, point.z]) {
                pixels[index] = pixel.map(|value| value as f32);
            }
        }
        let is_hidden = hidden(frame, &positions, &pixels);
        Self { positions, pixels, is_hidden }
    }
}

/// Which points are hidden, by a z-buffer. Its cells are so wide that the samples of a surface leave no cell empty.
fn hidden(frame: &Frame, positions: &[[f32; 3]], pixels: &[[f32; 2]]) -> Vec<bool> {
    let cell = 2.0 * spacing(frame.grid, pixels).max(1.0);
    let size = frame.planes.size;
    let (columns, rows) = ((size.width as f32 / cell).ceil() as usize, (size.height as f32 / cell).ceil() as usize);
    let place = |[column, row]: [f32; 2]| {
        let (i, j) = (((column + 0.5) / cell).floor(), ((row + 0.5) / cell).floor());
        let inside = i >= 0.0 && j >= 0.0 && (i as usize) < columns && (j as usize) < rows;
        inside.then(|| j as usize * columns + i as usize)
    };
    let mut nearest = vec![f32::INFINITY; columns * rows];
    for (position, pixel) in positions.iter().zip(pixels) {
        if let Some(at) = place(*pixel).filter(|&at| position[2] < nearest[at]) {
            nearest[at] = position[2];
        }
    }
    let is_behind = |(position, pixel): (&[f32; 3], &[f32; 2])| {
        place(*pixel).is_none_or(|at| {
            // Few points are behind the least gap.
            position[2] > nearest[at] + HIDDEN_LEAST as f32
                && position[2] > nearest[at] + frame.clear_gap(f64::from(nearest[at])) as f32
        })
    };
    positions.iter().zip(pixels).map(is_behind).collect()
}

/// Median distance of neighbouring points in the image, pixels, along rows or columns, whichever is larger.
fn spacing(grid: Size, pixels: &[[f32; 2]]) -> f32 {
    const SAMPLES: usize = 2000;
    let stride = (grid.len() / SAMPLES).max(1);
    let along = |pace: usize, is_last: &dyn Fn(usize) -> bool| {
        let mut distances: Vec<f32> = (0..grid.len() - pace)
            .step_by(stride)
            .filter(|&index| !is_last(index))
            .map(|index| [0, 1].map(|k| pixels[index + pace][k] - pixels[index][k]))
            .map(|[x, y]| x.hypot(y))
            .filter(|distance| distance.is_finite())
            .collect();
        if distances.is_empty() { 1.0 } else { quantile(&mut distances, 0.5) }
    };
    let across = along(1, &|index| index % grid.width == grid.width - 1);
    across.max(along(grid.width, &|_| false))
}
