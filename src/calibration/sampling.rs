//! Sparse depth maps: gathers their samples into a coarser raster, whose cells are about as wide as the spacing of the
//! samples.
//!
//! The cues compare neighbours on the raster. In a sparse map, whether its samples are scattered or lie on the rings of a
//! scanner, the nearest samples are several pixels apart. The cells grow until most neighbours of a cell with a sample
//! hold one too. A cell keeps the sample nearest to its centre as measured: samples are never averaged or interpolated.

use crate::view::Size;

/// Cells grow along an axis until at least this share of the neighbours of cells with a sample hold a sample too.
const COVERED: f64 = 0.6;
/// Longest side of a cell, pixels; 16 rings in a map of 480 rows are 30 pixels apart.
const LARGEST_CELL: usize = 32;

/// Whether each cell of a raster holds a sample.
struct Occupied {
    size: Size,
    is_sample: Vec<bool>,
}

impl Occupied {
    /// Cells of this many columns and rows.
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
        let can_grow = |&axis: &usize| coverage[axis] < COVERED && cell[axis] < LARGEST_CELL;
        // If both axes have few neighbours, the shorter side grows, so that cells stay square.
        let Some(axis) = [0, 1].into_iter().filter(can_grow).min_by_key(|&axis| cell[axis]) else { return cell };
        cell[axis] += 1;
    }
}

/// The raster of the check, and the sample in each of its cells.
pub(super) struct Gathered {
    pub grid: Size,
    /// Columns and rows of the depth map in a cell.
    pub cell: [usize; 2],
    /// NaN where a cell holds no sample.
    pub points: Vec<[f32; 3]>,
    /// Index in the depth map of each cell's sample; empty if every pixel is a cell.
    pub sources: Vec<usize>,
}

/// A raster on which most samples have neighbours.
pub(super) fn gathered(grid: Size, points: Vec<[f32; 3]>) -> Gathered {
    let [columns, rows] = cell(grid, &points);
    if columns * rows == 1 {
        return Gathered { grid, cell: [1, 1], points, sources: vec![] };
    }
    let size = Size { width: grid.width.div_ceil(columns), height: grid.height.div_ceil(rows) };
    let mut nearest = vec![(usize::MAX, 0, [f32::NAN; 3]); size.len()];
    for (index, point) in points.iter().enumerate().filter(|(_, point)| !point[2].is_nan()) {
        let (column, row) = grid.position(index);
        // The square of twice the distance from the centre of the cell, which is a whole number.
        let off = |at: usize, side: usize| (2 * (at % side) + 1).abs_diff(side).pow(2);
        let distance = off(column, columns) + off(row, rows);
        let kept = &mut nearest[size.index(column / columns, row / rows)];
        if distance < kept.0 {
            *kept = (distance, index, *point);
        }
    }
    let (sources, points) = nearest.into_iter().map(|(_, index, point)| (index, point)).unzip();
    Gathered { grid: size, cell: [columns, rows], points, sources }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numeric::random::Random;

    const GRID: Size = Size { width: 120, height: 90 };

    /// The points of a plane, of which some pixels are kept.
    fn plane(is_kept: impl FnMut(usize) -> bool) -> Vec<[f32; 3]> {
        let mut is_kept = is_kept;
        let point = |index: usize| {
            let (column, row) = GRID.position(index);
            if is_kept(index) { [column as f32, row as f32, 1.0] } else { [f32::NAN; 3] }
        };
        (0..GRID.len()).map(point).collect()
    }

    #[test]
    fn a_dense_map_with_a_hole_stays_as_it_is() {
        let points = plane(|index| GRID.position(index).0 < 50);
        assert_eq!(cell(GRID, &points), [1, 1]);
        assert_eq!(gathered(GRID, points).grid, GRID);
    }

    #[test]
    fn rings_are_gathered_along_columns_alone() {
        let [columns, rows] = cell(GRID, &plane(|index| GRID.position(index).1 % 9 == 4));
        // If cells have seven rows, the next cell of two cells in three also has a ring.
        assert!(columns == 1 && (6..=9).contains(&rows), "{columns} {rows}");
    }

    #[test]
    fn scattered_samples_are_gathered_into_nearly_square_cells_and_kept_as_measured() {
        let mut random = Random::new(1, 0);
        let points = plane(|_| random.uniform() < 0.05);
        let [columns, rows] = cell(GRID, &points);
        assert!(columns.abs_diff(rows) <= 1 && (3..=6).contains(&rows), "{columns} {rows}");
        let Gathered { grid: size, points: kept, sources, .. } = gathered(GRID, points.clone());
        assert_eq!(size, Size { width: GRID.width.div_ceil(columns), height: GRID.height.div_ceil(rows) });
        let valid: Vec<_> = kept.iter().enumerate().filter(|(_, point)| !point[2].is_nan()).collect();
        assert!(2 * valid.len() > size.len());
        for (index, point) in valid {
            let (column, row) = size.position(index);
            assert_eq!(*point, points[sources[index]]);
            assert_eq!([point[0] as usize / columns, point[1] as usize / rows], [column, row]);
        }
    }
}
