//! The pair of Table 2A (docs/lab/protocols.md): one bare grid, seen twice without occlusion and without resampling.

use nalgebra::{Matrix3, Vector3};

use super::flaws::keep_columns;
use super::relief::Relief;
use super::sample::{DepthData, Sample, SampleDepth, SampleImage, Truth, check_overlap};
use crate::error::{Error, ErrorKind, Result};
use crate::light::Light;
use crate::pose::Similarity;
use crate::view::{Camera, Normals, Size};

/// Step between samples of the relief that are taken: 32 of 256.
const STRIDE: usize = 8;

/// Image and organised cloud from samples 0, 8, 16, .. of the relief, with heights divided by 8.
///
/// The normals are central finite differences of that same grid; samples that lack a neighbour leave both masks. The
/// cloud holds the image's own points rotated by R_g^T about their mean, with the rotated normals. `overlap` keeps the
/// middle round(overlap * n) of the object's n columns. An exact solution exists, so every error is that of the
/// estimator.
///
/// # Errors
/// [`ErrorKind::Range`] for a light, rotation or overlap out of range, [`ErrorKind::Empty`] if no sample has all its
/// neighbours.
pub fn bare_grid(relief: &Relief, light: &Light, rotation: &Matrix3<f64>, overlap: f64) -> Result<Sample> {
    light.validate("light")?;
    Similarity { rotation: *rotation, ..Similarity::identity() }.validate("pose")?;
    check_overlap(overlap)?;
    let (size, heights) = coarse_heights(relief);
    let normals: Vec<Option<Vector3<f64>>> = (0..size.len()).map(|index| normal(&heights, size, index)).collect();
    let mask: Vec<bool> = normals.iter().map(Option::is_some).collect();
    let points = points(&heights, &mask, size);
    let count = mask.iter().filter(|&&inside| inside).count();
    if count == 0 {
        return Err(Error::new(ErrorKind::Empty, "surface.heights", "no sample of the coarse grid has all neighbours"));
    }
    let inside = || (0..size.len()).filter(|&index| mask[index]);
    let centroid = inside().map(|index| points[index]).sum::<Vector3<f64>>() / count as f64;

    let mut colours = vec![0.0; 3 * size.len()];
    let mut truth = Truth {
        image_normals: Normals::missing(size.len()),
        image_depth: vec![f32::NAN; size.len()],
        depth_normals: Normals::missing(size.len()),
        depth: vec![f32::NAN; size.len()],
    };
    let mut cloud = Normals::missing(size.len());
    let mut depth_mask = mask.clone();
    keep_columns(&mut depth_mask, size, overlap);
    let inverse = rotation.transpose();
    for (index, normal) in normals.iter().enumerate().filter_map(|(index, normal)| Some((index, (*normal)?))) {
        let colour = light.shade(normal.into()).map(|log| log.exp() as f32);
        colours[3 * index..3 * index + 3].copy_from_slice(&colour);
        truth.image_normals.set(index, rounded(normal));
        truth.image_depth[index] = points[index].z as f32;
        if depth_mask[index] {
            let point = rounded(inverse * (points[index] - centroid) + centroid);
            cloud.set(index, point);
            truth.depth[index] = point[2];
            truth.depth_normals.set(index, rounded(inverse * normal));
        }
    }
    let camera = Camera::Orthographic;
    let data = DepthData::Cloud { points: cloud, normals: truth.depth_normals.clone() };
    Ok(Sample {
        image: SampleImage { size, colours, mask, camera },
        depth: SampleDepth { size, data, mask: depth_mask, camera },
        light: *light,
        pose: Similarity { scale: 1.0, rotation: *rotation, translation: centroid - rotation * centroid },
        truth,
    })
}

/// Every eighth height; NaN is background.
fn coarse_heights(relief: &Relief) -> (Size, Vec<f64>) {
    let [width, height] = [relief.size().width, relief.size().height].map(|side| side.div_ceil(STRIDE));
    let size = Size { width, height };
    let heights = (0..size.len())
        .map(|index| {
            let (column, row) = size.position(index);
            let height = f64::from(relief.heights()[relief.size().index(STRIDE * column, STRIDE * row)]);
            if height > relief.floor() { height / STRIDE as f64 } else { f64::NAN }
        })
        .collect();
    (size, heights)
}

/// Normal from central differences; `None` if one of the five samples is background or beyond the border.
fn normal(heights: &[f64], size: Size, index: usize) -> Option<Vector3<f64>> {
    let (column, row) = size.position(index);
    let at = |column: usize, row: usize| {
        let inside = column < size.width && row < size.height;
        inside.then(|| heights[size.index(column, row)]).filter(|height| !height.is_nan())
    };
    at(column, row)?;
    let slope_x = (at(column + 1, row)? - at(column.checked_sub(1)?, row)?) / 2.0;
    let slope_y = (at(column, row + 1)? - at(column, row.checked_sub(1)?)?) / 2.0;
    Some(Vector3::new(-slope_x, -slope_y, -1.0).normalize())
}

/// Grid points in the optical frame; the constant of their depth is the larger side of the grid.
fn points(heights: &[f64], mask: &[bool], size: Size) -> Vec<Vector3<f64>> {
    let constant = size.width.max(size.height) as f64;
    (0..size.len())
        .map(|index| {
            let (column, row) = size.position(index);
            let depth = if mask[index] { constant - heights[index] } else { f64::NAN };
            Camera::Orthographic.point(size, [column as f64, row as f64], depth).into()
        })
        .collect()
}

fn rounded(vector: Vector3<f64>) -> [f32; 3] {
    [vector.x as f32, vector.y as f32, vector.z as f32]
}
