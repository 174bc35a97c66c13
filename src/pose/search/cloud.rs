//! The depth view as a sparse cloud of small patches, each with a position, a normal and an area.
//!
//! Method: means over square blocks of pixels, which average out noise. The area of a patch is |dP/drow x dP/dcolumn|
//! between neighbouring blocks, times the share of the block that has data. This works for any camera and for organised
//! clouds. Limits: a block across a depth discontinuity floats between both sides; it is dropped if its normals cancel.

use nalgebra::Vector3;

use super::contrast::relief;
use super::values::RELIEF;
use crate::error::{Error, ErrorKind, Result};
use crate::numeric::quantile;
use crate::view::{Normals, Points, Size};

/// Maximum number of patches, about four for each cell of the grid that an object covers.
const MOST_PATCHES: usize = 1000;
/// Minimum number of patches that distinguish rotations.
const FEWEST_PATCHES: usize = 16;
/// A block whose mean unit normal is shorter than this has no direction, because its normals disagree.
const LEAST_AGREEMENT: f64 = 0.3;
/// Largest area of a patch relative to the median. Larger ones are seen at a grazing angle by the depth camera, or span
/// a discontinuity.
const LARGEST_AREA: f64 = 5.0;

/// A patch of the surface, in the depth camera's frame and unit.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    /// Relative to the centre of the cloud.
    pub position: [f32; 3],
    pub normal: [f32; 3],
    pub area: f32,
    /// Regressors of the albedo that follows the relief; zeros if they are not compared.
    pub relief: [f32; RELIEF],
}

/// The sparse cloud of the depth view.
#[derive(Clone, Debug)]
pub struct Cloud {
    pub patches: Vec<Patch>,
    pub centre: Vector3<f64>,
}

/// Sums over the pixels of one block.
#[derive(Clone, Copy, Default)]
struct Block {
    point: Vector3<f64>,
    normal: Vector3<f64>,
    relief: [f64; RELIEF],
    count: f64,
}

impl Block {
    fn mean(&self) -> Option<Vector3<f64>> {
        (self.count > 0.0).then(|| self.point / self.count)
    }
}

impl Cloud {
    /// # Errors
    /// [`ErrorKind::Empty`] if too little of the view has a normal.
    pub fn new(size: Size, points: &Points, normals: &Normals, with_relief: bool) -> Result<Self> {
        let relief = if with_relief { relief(size, normals) } else { Vec::new() };
        let usable = |&index: &usize| points.is_valid(index) && normals.is_valid(index);
        let count = (0..size.len()).filter(usable).count();
        let side = ((count as f64 / MOST_PATCHES as f64).sqrt().ceil() as usize).max(1);
        let raster = Size { width: size.width.div_ceil(side), height: size.height.div_ceil(side) };
        let mut blocks = vec![Block::default(); raster.len()];
        for index in (0..size.len()).filter(usable) {
            let (column, row) = size.position(index);
            let block = &mut blocks[raster.index(column / side, row / side)];
            block.point += Vector3::from(points.get(index).map(f64::from));
            block.normal += Vector3::from(normals.get(index).map(f64::from));
            if let Some(relief) = relief.get(index) {
                block.relief.iter_mut().zip(relief).for_each(|(sum, &value)| *sum += f64::from(value));
            }
            block.count += 1.0;
        }
        let mut cloud = Self { patches: Vec::with_capacity(count), centre: Vector3::zeros() };
        cloud.fill(&blocks, raster, (side * side) as f64);
        if cloud.patches.len() < FEWEST_PATCHES {
            return Err(Error::new(ErrorKind::Empty, "depth", "too few depth pixels have a normal")
                .value(cloud.patches.len() as f64));
        }
        Ok(cloud)
    }

    fn fill(&mut self, blocks: &[Block], raster: Size, full: f64) {
        let areas: Vec<Option<f64>> = (0..blocks.len()).map(|index| area(blocks, raster, index)).collect();
        let mut known: Vec<f32> = areas.iter().flatten().map(|&area| area as f32).collect();
        let median = if known.is_empty() { 1.0 } else { f64::from(quantile(&mut known, 0.5)) };
        let kept = |block: &Block| block.normal.norm() >= LEAST_AGREEMENT * block.count;
        let means = || blocks.iter().filter(|block| kept(block)).filter_map(Block::mean);
        self.centre = means().sum::<Vector3<f64>>() / means().count().max(1) as f64;
        for (block, area) in blocks.iter().zip(areas).filter(|(block, _)| kept(block)) {
            let Some(point) = block.mean() else { continue };
            let area = area.unwrap_or(median).min(LARGEST_AREA * median) * block.count / full;
            self.patches.push(Patch {
                position: (point - self.centre).map(|value| value as f32).into(),
                normal: block.normal.normalize().map(|value| value as f32).into(),
                area: area as f32,
                relief: block.relief.map(|sum| (sum / block.count) as f32),
            });
        }
    }
}

/// Area between neighbouring blocks; `None` if there is no neighbour along an axis.
fn area(blocks: &[Block], raster: Size, index: usize) -> Option<f64> {
    let here = blocks[index].mean()?;
    let (column, row) = raster.position(index);
    let step = |before: Option<usize>, after: Option<usize>| {
        let mean = |index: Option<usize>| index.and_then(|index| blocks[index].mean());
        match (mean(before), mean(after)) {
            (Some(before), Some(after)) => Some((after - before) / 2.0),
            (Some(before), None) => Some(here - before),
            (None, Some(after)) => Some(after - here),
            (None, None) => None,
        }
    };
    let across = step((column > 0).then(|| index - 1), (column + 1 < raster.width).then_some(index + 1))?;
    let down =
        step((row > 0).then(|| index - raster.width), (row + 1 < raster.height).then_some(index + raster.width))?;
    Some(across.cross(&down).norm())
}
