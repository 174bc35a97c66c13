//! Rigs with a known answer: a colour and a depth camera, seen scenes of solids before their backgrounds, and what
//! both sensors make of them (docs/lab/protocols.md).
//!
//! [`render`] draws cameras and extrinsics from the seed, a scene from seed and frame (`layout`, of `solids` and
//! `sheet`, with `paint`), and passes it through two z-buffers (`raster`) to both sensors (`colour`, `depth`).

mod cameras;
mod colour;
mod depth;
mod frame;
mod illumination;
mod layout;
mod paint;
mod raster;
mod sheet;
mod solids;
mod stage;

pub use frame::{RigFrame, RigRequest, render};
pub use layout::RigKind;
