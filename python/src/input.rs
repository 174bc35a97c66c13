//! From the dictionaries of the package to the views of the crate.

use bimodal_stereo::nalgebra::{Matrix3, Matrix4, Vector3};
use bimodal_stereo::{Angles, ColourImage, ColourSamples, DepthMap, DepthSamples, Pinhole, Similarity, Transfer};
use pyo3::prelude::*;

use crate::error::failure;
use crate::members::Members;

const IMAGE: [&str; 6] = ["width", "height", "data", "mask", "camera", "transfer"];
const DEPTH: [&str; 8] = ["width", "height", "data", "points", "mask", "camera", "unit", "normals"];

/// What image and depth map have in common, with a camera of one kind or another.
pub struct Raster<'py> {
    pub members: Members<'py>,
    pub size: [usize; 2],
    pub mask: Option<Vec<u8>>,
}

impl<'py> Raster<'py> {
    pub fn image(value: &Bound<'py, PyAny>, path: &str) -> PyResult<Self> {
        Self::new(Members::new(value, path, &IMAGE)?)
    }

    pub fn depth(value: &Bound<'py, PyAny>, path: &str) -> PyResult<Self> {
        Self::new(Members::new(value, path, &DEPTH)?)
    }

    fn new(members: Members<'py>) -> PyResult<Self> {
        let side = |name| members.needed(name, members.whole(name)?);
        Ok(Self { size: [side("width")?, side("height")?], mask: members.array("mask")?, members })
    }

    pub fn colours(&self) -> PyResult<ColourSamples> {
        let Self { members, .. } = self;
        if let Some(data) = members.array("data")? {
            return Ok(ColourSamples::Rgba8(data));
        }
        if let Some(data) = members.array("data")? {
            return Ok(ColourSamples::Rgba16(data));
        }
        members.needed("data", members.array("data")?.map(ColourSamples::RgbLinear))
    }

    pub fn depths(&self) -> PyResult<DepthSamples> {
        let Self { members, .. } = self;
        if let Some(points) = members.array("points")? {
            return Ok(DepthSamples::Cloud(points));
        }
        if let Some(data) = members.array("data")? {
            return Ok(DepthSamples::Integer(data));
        }
        members.needed("data", members.array("data")?.map(DepthSamples::Float))
    }

    pub fn transfer(&self) -> PyResult<Option<Transfer>> {
        self.members.word("transfer", &[("srgb", Transfer::Srgb), ("linear", Transfer::Linear)])
    }
}

pub fn image(value: &Bound<'_, PyAny>) -> PyResult<ColourImage> {
    let raster = Raster::image(value, "image")?;
    Ok(ColourImage {
        width: raster.size[0],
        height: raster.size[1],
        samples: raster.colours()?,
        transfer: raster.transfer()?,
        camera: pinhole(&raster.members)?,
        mask: raster.mask,
    })
}

pub fn depth(value: &Bound<'_, PyAny>) -> PyResult<DepthMap> {
    let raster = Raster::depth(value, "depth")?;
    Ok(DepthMap {
        width: raster.size[0],
        height: raster.size[1],
        samples: raster.depths()?,
        unit: raster.members.number("unit")?,
        camera: pinhole(&raster.members)?,
        normals: raster.members.array("normals")?,
        mask: raster.mask,
    })
}

/// fx, fy, cx, cy.
pub fn intrinsics(camera: &Members<'_>) -> PyResult<[f64; 4]> {
    let number = |name| camera.needed(name, camera.number(name)?);
    Ok([number("fx")?, number("fy")?, number("cx")?, number("cy")?])
}

fn pinhole(raster: &Members<'_>) -> PyResult<Option<Pinhole>> {
    let Some(camera) = raster.below("camera", &["fx", "fy", "cx", "cy", "distortion"])? else { return Ok(None) };
    let [fx, fy, cx, cy] = intrinsics(&camera)?;
    let distortion = camera.numbers("distortion")?.unwrap_or_default();
    Ok(Some(Pinhole { fx, fy, cx, cy, distortion }))
}

pub const POSE: [&str; 5] = ["scale", "rotation", "translation", "angles", "matrix"];

/// The 4x4 matrix of a pose.
fn matrix(pose: &Members<'_>) -> PyResult<Option<Matrix4<f64>>> {
    Ok(pose.numbers::<16>("matrix")?.map(|rows| Matrix4::from_row_slice(&rows)))
}

/// The scale of a pose, by itself or in its matrix.
pub fn scale(pose: &Members<'_>) -> PyResult<Option<f64>> {
    let of_matrix = |matrix: Matrix4<f64>| matrix.fixed_view::<3, 3>(0, 0).determinant().cbrt();
    Ok(pose.number("scale")?.or(matrix(pose)?.map(of_matrix)))
}

/// The rotation of a pose, by itself, in its matrix, or by its angles; `None` without any.
pub fn rotation(pose: &Members<'_>) -> PyResult<Option<Matrix3<f64>>> {
    if let Some(rows) = pose.numbers::<9>("rotation")? {
        return Ok(Some(Matrix3::from_row_slice(&rows)));
    }
    match matrix(pose)? {
        Some(matrix) => {
            let scaled: Matrix3<f64> = matrix.fixed_view::<3, 3>(0, 0).into();
            Ok(Some(scaled / scaled.determinant().cbrt()))
        }
        None => Ok(angles(pose)?.map(|angles| angles.rotation())),
    }
}

/// The translation of a pose, by itself or in its matrix.
pub fn translation(pose: &Members<'_>) -> PyResult<Option<Vector3<f64>>> {
    let given = pose.numbers::<3>("translation")?.map(Vector3::from);
    Ok(given.or(matrix(pose)?.map(|matrix| matrix.fixed_view::<3, 1>(0, 3).into())))
}

/// More is a mistake, no turn; far beyond, a sine means nothing.
const FULL_TURN: f64 = 360.0;

/// Missing angles are zero.
pub fn angles(parent: &Members<'_>) -> PyResult<Option<Angles>> {
    let Some(given) = parent.below("angles", &["alpha", "beta", "gamma"])? else { return Ok(None) };
    let angle = |name| {
        let value = given.number(name)?.unwrap_or_default();
        if value.abs() <= FULL_TURN {
            return Ok(value);
        }
        Err(failure("range", &given.at(name), &format!("must be a number from -360 to 360 deg (got {value})")))
    };
    Ok(Some(Angles { alpha: angle("alpha")?, beta: angle("beta")?, gamma: angle("gamma")? }))
}

/// Of a candidate for extrinsics, whose scale is one.
pub fn extrinsics(value: &Bound<'_, PyAny>, path: &str) -> PyResult<Similarity> {
    /// What a product of rotations with rounding leaves of a scale of one.
    const SCALE_TOLERANCE: f64 = 0.01;
    let pose = Members::new(value, path, &POSE)?;
    let scale = scale(&pose)?.unwrap_or(1.0);
    if (scale - 1.0).abs() > SCALE_TOLERANCE {
        let message = format!("must be 1: extrinsics do not change sizes (got {scale})");
        return Err(failure("range", &pose.at("scale"), &message));
    }
    Ok(Similarity {
        scale: 1.0,
        rotation: pose.needed("rotation", rotation(&pose)?)?,
        translation: pose.needed("translation", translation(&pose)?)?,
    })
}
