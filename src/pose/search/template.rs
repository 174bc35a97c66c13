//! Appearance of the rotated cloud to the colour camera, on the search grid.
//!
//! Each patch that faces the camera and is not hidden spreads its projected area w over the four cells around it, with
//! the nine harmonics of its rotated normal: a cell holds w and w B_k(n). Coverage is at most one. With local contrast,
//! a cell also holds w times the regressors of the relief, and the local means of all values are removed.
//!
//! Limits: a patch is hidden if it lies behind the nearest patch of its cell or of the neighbouring cells by more than
//! a tolerance, so thin structures close behind each other show through. Patches off the grid are not seen.

use nalgebra::Matrix3;

use super::cloud::Cloud;
use super::contrast::GridContrast;
use super::values::{LANES, PADDED, Products, RELIEF, Sums, WITH_RELIEF, products, row_start};
use crate::light::{HARMONICS, basis};

/// Smallest cosine between a normal and the direction to the camera; more oblique patches are slivers on the grid.
const GRAZING: f32 = 0.1;
/// A patch is hidden if it lies more than this many cells behind the nearest patch of its cell. The limit allows for the
/// slope of a visible surface over a cell and its neighbours.
const HIDDEN: f32 = 2.5;

/// Projection of patches onto the grid, by a camera that looks along `ray` (x and y at z = 1) at the centre of the
/// cloud.
#[derive(Clone, Copy, Debug)]
pub struct GridProjection {
    /// Cells per unit of the depth view at the centre of the cloud.
    pub magnification: f32,
    pub ray: [f32; 2],
    /// Inverse of the distance of the centre in units of the depth view; zero for parallel rays.
    pub inverse_distance: f32,
    /// Shift of the centre from the middle of its cell, cells.
    pub offset: [f32; 2],
}

/// The rotated cloud on a square grid; the centre of the cloud lies in cell (side / 2, side / 2).
pub struct Template {
    side: usize,
    /// Sums of every cell.
    pub sums: Vec<Sums>,
    /// Indices of the cells that are not empty.
    pub cells: Vec<u32>,
    /// Products of the values in those cells, in the same order.
    pub products: Vec<Products>,
    /// Sum of the cells' coverage.
    pub visible: f32,
    /// The nearest depth in every cell, cells.
    nearest: Vec<f32>,
    /// Column, row and depth of every patch, cells.
    positions: Vec<[f32; 3]>,
    /// Local contrast, if it is compared in place of the colours.
    contrast: Option<GridContrast>,
}

impl Template {
    pub fn new(side: usize, cloud: &Cloud, by_contrast: bool) -> Self {
        Self {
            side,
            contrast: by_contrast.then(|| GridContrast::new(side)),
            sums: vec![[0.0; PADDED]; side * side],
            cells: Vec::with_capacity(side * side),
            products: Vec::with_capacity(side * side),
            visible: 0.0,
            nearest: vec![f32::INFINITY; side * side],
            positions: Vec::with_capacity(cloud.patches.len()),
        }
    }

    /// Whether local contrast is compared in place of the colours.
    pub const fn is_by_contrast(&self) -> bool {
        self.contrast.is_some()
    }

    /// Draws the cloud under `rotation`, replacing the previous drawing. Allocates nothing.
    pub fn draw(&mut self, cloud: &Cloud, rotation: &Matrix3<f64>, projection: &GridProjection) {
        let rotation = rows(rotation);
        self.clear();
        self.project(cloud, &rotation, projection);
        let length = (1.0 + projection.ray[0] * projection.ray[0] + projection.ray[1] * projection.ray[1]).sqrt();
        for index in 0..cloud.patches.len() {
            let patch = &cloud.patches[index];
            let normal = times(&rotation, patch.normal);
            let facing = -(normal[0] * projection.ray[0] + normal[1] * projection.ray[1] + normal[2]) / length;
            let Some(corner) = (facing > GRAZING).then(|| self.visible_corner(index)).flatten() else { continue };
            self.spread(
                index,
                corner,
                patch.area * projection.magnification * projection.magnification * facing,
                &values(normal, patch.relief),
            );
        }
        for &cell in &self.cells {
            let sums = &mut self.sums[cell as usize];
            let excess = sums[0].max(1.0);
            sums.iter_mut().for_each(|sum| *sum /= excess);
            self.visible += sums[0];
        }
        if let Some(contrast) = &mut self.contrast {
            contrast.apply_to_template(&mut self.sums, &self.cells);
        }
    }

    /// Multiplies the values of each cell with each other. Allocates nothing.
    pub fn multiply(&mut self) {
        self.products.clear();
        let channels = if self.is_by_contrast() { WITH_RELIEF } else { HARMONICS };
        for sums in self.cells.iter().map(|&cell| &self.sums[cell as usize]) {
            let mut products = [0.0; products(WITH_RELIEF)];
            let per_weight = 1.0 / sums[0];
            let all = sums.as_chunks::<LANES>().0;
            for row in 0..channels {
                let scaled = sums[row] * per_weight;
                let lanes = &mut products[row_start(row)..].as_chunks_mut::<LANES>().0[..=row / LANES];
                for (products, sums) in lanes.iter_mut().zip(all) {
                    (0..LANES).for_each(|k| products[k] = scaled * sums[k]);
                }
            }
            self.products.push(products);
        }
    }

    fn clear(&mut self) {
        for &cell in &self.cells {
            self.sums[cell as usize] = [0.0; PADDED];
        }
        self.cells.clear();
        self.nearest.fill(f32::INFINITY);
        self.positions.clear();
        self.visible = 0.0;
    }

    /// Computes column, row and depth of every patch in cells, and the nearest depth of every cell.
    fn project(&mut self, cloud: &Cloud, rotation: &[[f32; 3]; 3], projection: &GridProjection) {
        let middle = (self.side / 2) as f32;
        let last = (self.side - 2) as f32;
        for patch in &cloud.patches {
            let [x, y, z] = times(rotation, patch.position);
            let shrink = projection.magnification / (1.0 + z * projection.inverse_distance).max(f32::EPSILON);
            // (ray D + x) / (D + z) - ray = (x - ray z) / (D + z)
            let slant = if projection.inverse_distance > 0.0 { projection.ray } else { [0.0; 2] };
            let position = [
                (x - slant[0] * z) * shrink + middle + projection.offset[0],
                (y - slant[1] * z) * shrink + middle + projection.offset[1],
                z * projection.magnification,
            ];
            self.positions.push(position);
            let [column, row, depth] = position;
            if column >= 1.0 && row >= 1.0 && column <= last && row <= last {
                let cell = nearest(row) * self.side + nearest(column);
                for cell in [cell, cell - 1, cell + 1, cell - self.side, cell + self.side] {
                    // The minimum is written out, because `min` is a function call on some targets.
                    if depth < self.nearest[cell] {
                        self.nearest[cell] = depth;
                    }
                }
            }
        }
    }

    /// Index of the upper left of the four cells around a patch; `None` if the patch is hidden or off the grid.
    fn visible_corner(&self, index: usize) -> Option<usize> {
        let [x, y, z] = self.positions[index];
        let last = (self.side - 2) as f32;
        if x < 0.0 || y < 0.0 || x >= last || y >= last {
            return None;
        }
        let nearest = self.nearest[nearest(y) * self.side + nearest(x)];
        (z <= nearest + HIDDEN).then(|| y as usize * self.side + x as usize)
    }

    fn spread(&mut self, index: usize, corner: usize, area: f32, values: &Sums) {
        let [x, y, _] = self.positions[index];
        let (right, low) = (x - (x as usize) as f32, y - (y as usize) as f32);
        for (cell, share) in [
            (corner, (1.0 - right) * (1.0 - low)),
            (corner + 1, right * (1.0 - low)),
            (corner + self.side, (1.0 - right) * low),
            (corner + self.side + 1, right * low),
        ] {
            let weight = area * share;
            if weight <= f32::MIN_POSITIVE {
                continue;
            }
            let sums = &mut self.sums[cell];
            if sums[0] <= 0.0 {
                self.cells.push(cell as u32);
            }
            (0..PADDED).for_each(|k| sums[k] += weight * values[k]);
        }
    }
}

/// The values of a patch with weight one.
fn values(normal: [f32; 3], relief: [f32; RELIEF]) -> Sums {
    let mut values = [0.0; PADDED];
    values[..HARMONICS].copy_from_slice(&basis(normal));
    values[0] = 1.0;
    values[HARMONICS..WITH_RELIEF].copy_from_slice(&relief);
    values
}

/// The cell nearest to a nonnegative coordinate; `round` is a function call on some targets.
fn nearest(place: f32) -> usize {
    (place + 0.5) as usize
}

fn rows(rotation: &Matrix3<f64>) -> [[f32; 3]; 3] {
    std::array::from_fn(|row| std::array::from_fn(|column| rotation[(row, column)] as f32))
}

fn times(m: &[[f32; 3]; 3], [x, y, z]: [f32; 3]) -> [f32; 3] {
    // The loop is written out, because a map over an array remains a function call.
    [
        m[0][0] * x + m[0][1] * y + m[0][2] * z,
        m[1][0] * x + m[1][1] * y + m[1][2] * z,
        m[2][0] * x + m[2][1] * y + m[2][2] * z,
    ]
}
