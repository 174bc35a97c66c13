//! Serialised options: members that are either a word or a value, such as `"estimate"` or 27 numbers, `"search"`,
//! `"identity"` or a pose, `"free"` or a number. An unknown member is an error with its name.

use std::array::from_fn;
use std::fmt::Formatter;

use nalgebra::{Matrix3, Matrix4, Vector3};
use serde::de::value::{MapAccessDeserializer, SeqAccessDeserializer};
use serde::de::{Error, IntoDeserializer, MapAccess, SeqAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::{LightSource, Start};
use crate::light::Light;
use crate::pose::{Angles, Similarity};

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum LightWord {
    Estimate,
}

#[derive(Serialize, Deserialize)]
#[serde(untagged)]
#[expect(clippy::large_enum_variant, reason = "lives no longer than a conversion")]
pub enum GivenLight {
    Word(LightWord),
    Numbers([f64; 27]),
}

impl From<GivenLight> for LightSource {
    fn from(given: GivenLight) -> Self {
        match given {
            GivenLight::Word(LightWord::Estimate) => Self::Estimate,
            // `Options::validate` checks the range of the numbers, because its errors name them.
            GivenLight::Numbers(flat) => Self::Known(Light(from_fn(|channel| from_fn(|k| flat[9 * channel + k])))),
        }
    }
}

impl From<LightSource> for GivenLight {
    fn from(source: LightSource) -> Self {
        match source {
            LightSource::Estimate => Self::Word(LightWord::Estimate),
            LightSource::Known(light) => Self::Numbers(light.flat()),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum StartWord {
    Search,
    Identity,
}

/// The known parts of a pose. The rotation, row by row, takes precedence over the angles.
#[derive(Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct GivenPose {
    #[serde(skip_serializing_if = "Option::is_none")]
    scale: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rotation: Option<[f64; 9]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    translation: Option<[f64; 3]>,
    #[serde(skip_serializing)]
    angles: GivenAngles,
    /// Reported poses have this member as well as the rotation, which takes precedence.
    #[serde(skip_serializing)]
    matrix: Option<GivenMatrix>,
}

/// Four rows of four numbers.
#[derive(Deserialize)]
#[serde(try_from = "[[f64; 4]; 4]")]
struct GivenMatrix(Similarity);

impl TryFrom<[[f64; 4]; 4]> for GivenMatrix {
    type Error = crate::error::Error;

    fn try_from(rows: [[f64; 4]; 4]) -> Result<Self, Self::Error> {
        Similarity::try_from(Matrix4::from_fn(|row, column| rows[row][column])).map(Self)
    }
}

/// The members of [`Angles`], all optional, without unknown ones.
#[derive(Clone, Copy, Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct GivenAngles {
    alpha: f64,
    beta: f64,
    gamma: f64,
}

impl From<GivenAngles> for Angles {
    fn from(GivenAngles { alpha, beta, gamma }: GivenAngles) -> Self {
        Self { alpha, beta, gamma }
    }
}

#[derive(Serialize)]
#[serde(untagged)]
#[expect(clippy::large_enum_variant, reason = "lives no longer than a conversion")]
pub enum GivenStart {
    Word(StartWord),
    Pose(GivenPose),
}

/// The derived implementation would report a pose with a wrong member as matching no variant, without naming the
/// member.
impl<'de> Deserialize<'de> for GivenStart {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(WordOrPose)
    }
}

struct WordOrPose;

impl<'de> Visitor<'de> for WordOrPose {
    type Value = GivenStart;

    fn expecting(&self, formatter: &mut Formatter<'_>) -> std::fmt::Result {
        formatter.write_str("\"search\", \"identity\", a pose or a 4x4 matrix")
    }

    fn visit_str<E: Error>(self, word: &str) -> Result<GivenStart, E> {
        StartWord::deserialize(word.into_deserializer()).map(GivenStart::Word)
    }

    fn visit_map<A: MapAccess<'de>>(self, members: A) -> Result<GivenStart, A::Error> {
        GivenPose::deserialize(MapAccessDeserializer::new(members)).map(GivenStart::Pose)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, rows: A) -> Result<GivenStart, A::Error> {
        let matrix = GivenMatrix::deserialize(SeqAccessDeserializer::new(rows))?;
        Ok(GivenStart::Pose(GivenPose { matrix: Some(matrix), ..GivenPose::default() }))
    }
}

impl From<GivenStart> for Start {
    fn from(given: GivenStart) -> Self {
        match given {
            GivenStart::Word(StartWord::Search) => Self::Search,
            GivenStart::Word(StartWord::Identity) => Self::Identity,
            GivenStart::Pose(GivenPose { scale, rotation: Some(rows), translation, .. }) => Self::Pose {
                rotation: Matrix3::from_row_slice(&rows),
                scale,
                translation: translation.map(Vector3::from),
            },
            GivenStart::Pose(GivenPose { scale, matrix: Some(GivenMatrix(pose)), translation, .. }) => Self::Pose {
                rotation: pose.rotation,
                scale: scale.or(Some(pose.scale)),
                translation: translation.map(Vector3::from).or(Some(pose.translation)),
            },
            GivenStart::Pose(GivenPose { scale, translation, angles, .. }) => Self::Pose {
                rotation: Angles::from(angles).rotation(),
                scale,
                translation: translation.map(Vector3::from),
            },
        }
    }
}

impl From<Start> for GivenStart {
    fn from(start: Start) -> Self {
        match start {
            Start::Search => Self::Word(StartWord::Search),
            Start::Identity => Self::Word(StartWord::Identity),
            Start::Pose { rotation, scale, translation } => Self::Pose(GivenPose {
                scale,
                rotation: Some(from_fn(|at| rotation[(at / 3, at % 3)])),
                translation: translation.map(Into::into),
                angles: GivenAngles::default(),
                matrix: None,
            }),
        }
    }
}

pub mod free_or_held {
    use serde::{Deserialize, Deserializer, Serialize, Serializer};

    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "lowercase")]
    enum Word {
        Free,
    }

    #[derive(Serialize, Deserialize)]
    #[serde(untagged)]
    enum Given {
        Word(Word),
        Number(f64),
    }

    pub fn serialize<S: Serializer>(scale: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
        scale.map_or(Given::Word(Word::Free), Given::Number).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<f64>, D::Error> {
        Ok(match Given::deserialize(deserializer)? {
            Given::Word(Word::Free) => None,
            Given::Number(scale) => Some(scale),
        })
    }
}
