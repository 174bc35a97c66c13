//! Sparse depth maps: gathers their samples into a coarser raster, whose cells are about as wide as the spacing of the
//! samples.
//!
//! The cues compare neighbours on the raster. In a sparse map, whether its samples are scattered or lie on the rings of a
//! scanner, the nearest samples are several pixels apart. The cells grow until most neighbours of a cell with a sample
//! hold one too. A cell keeps the sample nearest to its centre as measured: samples are never averaged or interpolated.

use crate::view::Size;

/// Share of the neighbours along an axis of cells with a sample that have to hold one too.
const COVERED: f64 = 0.6;
/// Longest side of a cell, pixels: 16 rings in a map of 480 rows are 30 pixels apart.
const LARGEST_CELL: usize = 32;

/// Whether each cell of a raster holds a sample.
struct Occupied {
    size: Size,
    is_sample: Vec<bool>,
}

impl Occupied {
    /// Cells of so many columns and rows.
    fn of(grid: Size, points: &[[f32; 3]], [columns, rows]: [usize; 2]) -> Self {
        let size = Size { width: grid.width.div_ceil(columns), height: grid.height.div_ceil(rows) };
        let mut is_sample = vec![false; size.len()];
        for (index, _) in points.iter().enumerate().filter(|(_, point)| !point[2].is_nan()) {
            let (column, row) = grid.position(index);
            is_sample[size.index(column / columns, row / rows)] = true;
        }
        Self { size, is_sample }
    }

    /// Share of the cells with a sample whose next cell along a row, and along a column, holds one too.
    fn coverage(&self) -> [f64; 2] {
        let Size { width, height } = self.size;
        let mut counts = [[0.0; 2]; 2];
        for index in (0..self.size.len()).filter(|&index| self.is_sample[index]) {
            let (column, row) = self.size.position(index);
            for (axis, next) in [(column + 1 < width).then_some(index + 1), (row + 1 < height).then_some(index + width)]
                .into_iter()
                .enumerate()
            {
                if let Some(next) = next {
                    counts[axis][0] += f64::from(u8::from(self.is_sample[next]));
                    counts[axis][1] += 1.0;
                }
            }
        }
        counts.map(|[both, all]| if all > 0.0 { both / all } else { 1.0 })
    }
}

/// Columns and rows of the smallest cells of which enough have neighbours.
fn cell(grid: Size, points: &[[f32; 3]]) -> [usize; 2] {
    let mut cell = [1, 1];
    loop {
        let coverage = Occupied::of(grid, points, cell).coverage();
        // The axis with fewer neighbours grows, and of equal ones the shorter, so that cells stay square.
        let axis = usize::from((coverage[1], cell[1]) < (coverage[0], cell[0]));
        if coverage[axis] >= COVERED || cell[axis] == LARGEST_CELL {
            return cell;
        }
        cell[axis] += 1;
    }
}

/// The raster and its points, in cells if the samples are sparse.
pub(super) fn gathered(grid: Size, points: Vec<[f32; 3]>) -> (Size, Vec<[f32; 3]>) {
    let [columns, rows] = cell(grid, &points);
    if columns * rows == 1 {
        return (grid, points);
    }
    let size = Size { width: grid.width.div_ceil(columns), height: grid.height.div_ceil(rows) };
    let mut nearest = vec![(usize::MAX, [f32::NAN; 3]); size.len()];
    for (index, point) in points.iter().enumerate().filter(|(_, point)| !point[2].is_nan()) {
        let (column, row) = grid.position(index);
        // Twice the distance from the centre of the cell, which is a whole number.
        let off = |at: usize, side: usize| (2 * (at % side) + 1).abs_diff(side).pow(2);
        let distance = off(column, columns) + off(row, rows);
        let kept = &mut nearest[size.index(column / columns, row / rows)];
        if distance < kept.0 {
            *kept = (distance, *point);
        }
    }
    (size, nearest.into_iter().map(|kept| kept.1).collect())
}
