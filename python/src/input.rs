//! Conversion of the package's dictionaries to the crate's views.

use bimodal_stereo::nalgebra::{Matrix3, Matrix4, Vector3};
use bimodal_stereo::{Angles, ColourImage, ColourSamples, DepthMap, DepthSamples, Similarity, Transfer};
use pyo3::prelude::*;

use crate::cameras::pinhole;
use crate::error::{failure, refused_at};
use crate::members::Members;

const IMAGE: [&str; 6] = ["width", "height", "data", "mask", "camera", "transfer"];
const DEPTH: [&str; 9] = ["width", "height", "data", "points", "mask", "camera", "unit", "normals", "intensity"];

/// The common part of images and depth maps, with either kind of camera.
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

pub const POSE: [&str; 5] = ["scale", "rotation", "translation", "angles", "matrix"];

/// The parts of a pose that are given.
pub struct GivenPose {
    pub scale: Option<f64>,
    pub rotation: Option<Matrix3<f64>>,
    pub translation: Option<Vector3<f64>>,
}

/// A pose from its members. Without a rotation, a 4x4 matrix gives all members. If the matrix is also missing, angles
/// give the rotation.
pub fn pose(pose: &Members<'_>) -> PyResult<GivenPose> {
    let rows = pose.numbers::<9>("rotation")?;
    if let (None, Some(entries)) = (rows, pose.numbers::<16>("matrix")?) {
        let whole = Similarity::try_from(Matrix4::from_row_slice(&entries));
        let Similarity { scale, rotation, translation } =
            whole.map_err(|error| refused_at(pose.at(error.field()), &error))?;
        return Ok(GivenPose { scale: Some(scale), rotation: Some(rotation), translation: Some(translation) });
    }
    let turned = angles(pose)?.map(|angles| angles.rotation());
    Ok(GivenPose {
        scale: pose.number("scale")?,
        rotation: rows.map(|rows| Matrix3::from_row_slice(&rows)).or(turned),
        translation: pose.numbers::<3>("translation")?.map(Vector3::from),
    })
}

/// A larger angle is a mistake, and far beyond this a sine is meaningless.
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

/// A candidate for extrinsics, whose scale is one.
pub fn extrinsics(value: &Bound<'_, PyAny>, path: &str) -> PyResult<Similarity> {
    /// Deviation from a scale of one that rounding leaves in a product of rotations.
    const SCALE_TOLERANCE: f64 = 0.01;
    let members = Members::new(value, path, &POSE)?;
    let given = pose(&members)?;
    let scale = given.scale.unwrap_or(1.0);
    if (scale - 1.0).abs() > SCALE_TOLERANCE {
        let message = format!("must be 1: extrinsics do not change sizes (got {scale})");
        return Err(failure("range", &members.at("scale"), &message));
    }
    Ok(Similarity {
        scale: 1.0,
        rotation: members.needed("rotation", given.rotation)?,
        translation: members.needed("translation", given.translation)?,
    })
}
