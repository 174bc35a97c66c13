//! Built-in surfaces, lights and the renderer that tests, tables and the page share (docs/lab/protocols.md).
//!
//! [`surface`] and [`Relief`] provide heights, [`Scene`] turns them into a mesh, and [`Scene::sample`] into a pair of
//! views with a known pose. [`bare_grid`] makes the pair of the paper's own synthetic test, [`rig`] the frames of a rig
//! of cameras.

mod bare_grid;
mod bound;
mod bust;
mod flaws;
pub mod lights;
mod mesh;
mod profiles;
mod relief;
mod render;
pub mod rig;
mod sample;
pub mod surfaces;

pub use bare_grid::bare_grid;
pub use bound::bound;
pub use lights::light;
pub use mesh::Mesh;
pub use relief::{LARGEST_RELIEF, Relief, SMALLEST_RELIEF};
pub use render::{View, render};
pub use sample::{
    DepthData, LARGEST_VIEW, SMALLEST_VIEW, Sample, SampleDepth, SampleImage, SampleRequest, Scene, Truth,
};
pub use surfaces::surface;
