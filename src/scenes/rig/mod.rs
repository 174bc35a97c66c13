//! Rigs with a known calibration: a colour and a depth camera, scenes of solids in front of backgrounds, and the
//! outputs of both sensors (docs/lab/protocols.md).
//!
//! [`render`] draws cameras and extrinsics from the seed and a scene from seed and frame (`layout`, of `solids` and
//! `sheet`, with `pattern`), and passes the scene through two z-buffers (`raster`) to both sensors (`colour`, `depth`).

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
