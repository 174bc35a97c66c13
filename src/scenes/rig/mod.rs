//! Rigs with a known calibration: a colour and a depth camera, scenes of solids in front of backgrounds, and the
//! outputs of both sensors (docs/lab/protocols.md).
//!
//! [`render`] draws cameras and extrinsics at random from the seed, and a scene from seed and frame (`layout`, which
//! uses `solids`, `sheet` and `pattern`). Two z-buffers (`raster`) project the scene into both sensors (`colour`,
//! `depth`).

mod cameras;
mod colour;
mod depth;
mod frame;
mod illumination;
mod layout;
mod pair;
mod pattern;
mod raster;
mod sheet;
mod solids;
mod stage;

pub use frame::{RigFrame, RigRequest, render};
pub use layout::RigKind;
pub use pair::{PairKind, RenderedPair, render_pair};
